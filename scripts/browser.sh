#!/bin/sh
# Tests reports in a headless Chromium (package `chromium`, or $CHROMIUM) with Node.js.
# With names of gallery cases, those are run and reported; without, a few of every kind. With --reports DIR, the pages in DIR.
# With --site DIR, the site that scripts/site.sh has made there (target/book).
set -eu
cd "$(dirname "$0")/.."
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
(cd browser-tests && npm ci --silent --no-audit --no-fund)
if [ "${1:-}" = "--site" ]; then
    BOOK=$(cd "$2" && pwd)
    cd browser-tests
    BOOK="$BOOK" node --test --test-concurrency=1 site.test.mjs
    exit
fi
if [ "${1:-}" = "--reports" ]; then
    REPORTS=$(cd "$2" && pwd)
else
    REPORTS="$made"
    [ $# -gt 0 ] || set -- snap_in cosine_disc die belt tendon swords
    cargo build --release --locked -p signorini-cli
    signorini="${CARGO_TARGET_DIR:-target}/release/signorini"
    for name; do
        "$signorini" gallery run "$name" -o "$made/$name" > "$made/$name.log"
        "$signorini" report "$made/$name" -o "$made/$name.html"
    done
fi
cd browser-tests
REPORTS="$REPORTS" node --test --test-concurrency=1 report.test.mjs
