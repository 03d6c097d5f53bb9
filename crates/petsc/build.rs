//! Compiles the shim over PETSc and MPI, where the feature asks for it.

#[cfg(not(feature = "petsc"))]
fn main() {
    println!("cargo:rerun-if-changed=build.rs");
}

#[cfg(feature = "petsc")]
fn main() {
    println!("cargo:rerun-if-changed=src/shim.c");
    let find = |names: &[&str], what: &str| {
        let found = names.iter().find_map(|name| pkg_config::Config::new().probe(name).ok());
        found.unwrap_or_else(|| {
            panic!(
                "the feature `petsc` needs {what}, and pkg-config finds no {}: install it (on Debian: apt-get install \
                 libpetsc-real-dev), or name its folder of .pc files in PKG_CONFIG_PATH",
                names.join(" or ")
            )
        })
    };
    let petsc = find(&["PETSc", "petsc"], "PETSc");
    let mpi = find(&["mpi-c", "ompi-c", "mpich", "mpi"], "MPI");
    let mut shim = cc::Build::new();
    shim.file("src/shim.c").warnings(true);
    // Warnings of PETSc's own headers are not ours.
    for path in petsc.include_paths.iter().chain(&mpi.include_paths) {
        shim.flag(format!("-isystem{}", path.display()));
    }
    shim.compile("signorini_petsc_shim");
}
