#!/bin/sh
# Builds the site into target/book: the manual, a page for each case of the gallery with its picture, its report and its program
# in Python, the problems with known answers and the figures of the validation. Needs mdbook and Python 3.11. Nothing that it
# writes is kept in the repository.
#   sh scripts/site.sh              runs the gallery
#   sh scripts/site.sh --quick      takes the pictures of the repository; no runs and no reports
#   sh scripts/site.sh --new        runs the gallery again, also what an earlier call has run
# With PYTHON set, that interpreter must have the package `signorini`; otherwise a fresh environment gets it.
set -eu
cd "$(dirname "$0")/.."
target="${CARGO_TARGET_DIR:-$PWD/target}"
cargo build --release --locked -p signorini-cli
if [ -z "${PYTHON:-}" ]; then
    environment="$target/site-python"
    [ -d "$environment" ] || python3 -m venv "$environment"
    CARGO_TARGET_DIR="$target" "$environment/bin/pip" --disable-pip-version-check --quiet install ./python
    PYTHON="$environment/bin/python"
fi
"$PYTHON" scripts/site.py make "$target/site" --signorini "$target/release/signorini" "$@"
mdbook build "$target/site" --dest-dir "$target/book"
"$PYTHON" scripts/site.py check "$target/book"
