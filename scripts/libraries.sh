#!/bin/sh
# Fetches the libraries that reports contain again, in the versions that are named here, with npm.
set -eu
cd "$(dirname "$0")/../crates/report/assets/libraries"
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
npm pack --silent --pack-destination "$made" uplot@1.6.32 > /dev/null
tar -xzf "$made"/uplot-*.tgz -C "$made"
cp "$made/package/dist/uPlot.iife.min.js" "$made/package/dist/uPlot.min.css" .
cp "$made/package/LICENSE" LICENSE-uPlot
