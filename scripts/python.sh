#!/bin/sh
# Installs the Python package into a fresh environment and runs its tests.
# With --wheel FILE that wheel is installed; nothing is built then.
set -eu
cd "$(dirname "$0")/.."
environment=$(mktemp -d)
trap 'rm -rf "$environment"' EXIT
"${PYTHON:-python3}" -m venv "$environment"
pip="$environment/bin/pip --disable-pip-version-check --quiet"
if [ "${1:-}" = "--wheel" ]; then
    $pip install "$2"
else
    # The folder of the workspace keeps what is built.
    CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}" $pip install ./python
fi
$pip install pytest meshio pyvista tqdm
"$environment/bin/python" -m pytest python -p no:cacheprovider
