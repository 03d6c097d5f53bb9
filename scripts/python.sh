#!/bin/sh
# Installs the Python package into a fresh environment and runs its tests.
# With --wheel FILE that wheel is installed; nothing is built then. With --profile dev the build takes less time.
set -eu
cd "$(dirname "$0")/.."
package=./python
case "${1:-}" in
    --wheel) package="$2" ;;
    --profile) export MATURIN_PEP517_ARGS="--profile $2" ;;
esac
environment=$(mktemp -d)
trap 'rm -rf "$environment"' EXIT
"${PYTHON:-python3}" -m venv "$environment"
# The folder of the workspace keeps what is built.
CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}" \
    "$environment/bin/pip" --disable-pip-version-check --quiet install "${package}[test]" || {
    echo "The Python package could not be built, or what it needs could not be fetched from PyPI: see the lines above." >&2
    exit 1
}
"$environment/bin/python" -m pytest python -p no:cacheprovider
