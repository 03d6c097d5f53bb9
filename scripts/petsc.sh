#!/bin/sh
# Builds the command with PETSc and MPI, and tests it with several processes. Where Debian's packages are not there they are
# installed, if apt can. Where they cannot be had it says so and ends well: nothing else needs them. With `--all` the command, too,
# is built and run by several processes, which takes several minutes more.
set -eu
cd "$(dirname "$0")/.."
packages="libpetsc-real-dev libopenmpi-dev openmpi-bin pkg-config"
has_petsc() {
    command -v mpirun >/dev/null && { pkg-config --exists PETSc || pkg-config --exists petsc; } 2>/dev/null
}
missing() {
    echo "petsc.sh: left out, $1. Runs of several processes are not tested." >&2
    exit 0
}
if ! has_petsc; then
    command -v apt-get >/dev/null || missing "pkg-config finds no PETSc, and there is no apt-get"
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        sudo -n true 2>/dev/null || missing "pkg-config finds no PETSc, and installing it needs root"
        as_root="sudo -n"
    fi
    # shellcheck disable=SC2086
    if ! { timeout 60 $as_root apt-get -qq update && timeout 180 $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get -qq install --no-install-recommends $packages; } >/dev/null 2>&1; then
        missing "apt-get cannot install $packages"
    fi
    has_petsc || missing "pkg-config finds no PETSc after its installation"
fi
cargo test --locked -p signorini-petsc --features petsc
if [ "${1:-}" = --all ]; then
    cargo test --locked -p signorini-cli --features petsc --test command processes
fi
