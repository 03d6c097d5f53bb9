//! Several processes started together, by `mpirun` where the command is built with PETSc.

use assert_cmd::Command;
use std::path::Path;

fn signorini(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("signorini").expect("the command");
    command.current_dir(folder);
    command
}

/// Without MPI in the program four processes would do the same four times: one of them says so, and all of them stop.
#[cfg(not(feature = "petsc"))]
#[test]
fn processes_that_cannot_be_connected_are_told_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |rank: &str| {
        let mut command = signorini(folder.path());
        command.args(["gallery", "run", "patch_test", "-o", "out"]);
        command.env("OMPI_COMM_WORLD_SIZE", "4").env("OMPI_COMM_WORLD_RANK", rank);
        let output = command.assert().code(1).get_output().clone();
        assert!(output.stdout.is_empty() && !folder.path().join("out").exists());
        String::from_utf8(output.stderr).expect("text")
    };
    let told = of("0");
    assert!(told.contains("4 processes were started together") && told.contains("--features petsc"), "{told}");
    assert_eq!(of("3"), "");
    let asked = ["gallery", "run", "patch_test", "--set", "method.linear={petsc=\"\"}"];
    let output = signorini(folder.path()).args(asked).assert().code(1).get_output().clone();
    let told = String::from_utf8(output.stderr).expect("text");
    assert!(told.contains("built without PETSc"), "{told}");
}

#[cfg(feature = "petsc")]
mod with_petsc {
    use super::*;
    use serde_json::Value;
    use std::process::Output;

    fn mpirun(folder: &Path) -> Command {
        let mut command = Command::new("mpirun");
        command.args(["--oversubscribe", "--mca", "mpi_yield_when_idle", "1"]).current_dir(folder);
        command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
        command
    }

    /// Runs a case of the gallery by so many processes; none are started together for 0.
    fn run(folder: &Path, processes: usize, case: &str, more: &[&str]) -> (Output, Value) {
        let out = format!("out{processes}");
        let arguments = ["gallery", "run", case, "-o", &out, "--set", "output.pictures=false"];
        let mut command = match processes {
            0 => signorini(folder),
            n => {
                let mut command = mpirun(folder);
                command.args(["-n", &n.to_string()]).arg(assert_cmd::cargo::cargo_bin("signorini"));
                command
            }
        };
        let output = command.args(arguments).args(more).output().expect("a run");
        let summary = std::fs::read_to_string(folder.join(out).join("summary.json")).unwrap_or("null".into());
        (output, serde_json::from_str(&summary).expect("JSON"))
    }

    fn error(output: &Output) -> String {
        String::from_utf8_lossy(&output.stderr).into_owned()
    }

    /// Forces and pressures of the last state to 1e-10, with the same iterations of Newton's method by factors, and at most one more by
    /// iterations.
    #[test]
    fn processes_find_what_one_finds() {
        let folder = tempfile::tempdir().expect("a folder");
        for (case, contact) in [("hertz", "touch"), ("incline", "foot"), ("rubber_tube", "crush")] {
            let (_, one) = run(folder.path(), 0, case, &[]);
            let ways = [(2, &[][..]), (3, &[]), (2, &["--set", "method.linear={petsc=\"-pc_type gamg\"}"])];
            // All ways of the smaller one.
            for (processes, more) in ways.into_iter().take(if case == "incline" { 3 } else { 1 }) {
                let (output, found) = run(folder.path(), processes, case, more);
                assert!(output.status.success(), "{case}: {}", error(&output));
                let iterations = |s: &Value| -> Vec<u64> {
                    let steps = s["steps"].as_array().expect("steps").iter();
                    steps.map(|s| s["iterations"].as_u64().expect("a number")).collect()
                };
                // Where linear equations are solved to 1e-10 of their right-hand side a step may lack the last digits of Newton's.
                let most = u64::from(!more.is_empty());
                let (taken, alone) = (iterations(&found), iterations(&one));
                let is_as_many = alone.iter().zip(&taken).all(|(a, b)| (*a..=a + most).contains(b));
                assert!(is_as_many && alone.len() == taken.len(), "{case} {processes} {more:?}: {taken:?} {alone:?}");
                let last = |s: &Value| s["steps"].as_array().and_then(|s| s.last().cloned()).expect("a step");
                let (found, one) = (last(&found), last(&one));
                assert_eq!(found["solver"], "petsc");
                let numbers = |s: &Value| -> Vec<f64> {
                    let contact = &s["contacts"].as_object().expect("contacts").get(contact).expect("the contact");
                    let force = contact["force"].as_array().expect("a force").clone();
                    let all = force.iter().chain([&contact["max_pressure"], &contact["area"]]);
                    all.map(|v| v.as_f64().expect("a number")).collect()
                };
                let largest = numbers(&one).iter().fold(0.0f64, |m, v| m.max(v.abs()));
                for (a, b) in numbers(&found).iter().zip(numbers(&one)) {
                    assert!((a - b).abs() <= 1e-10 * largest, "{case}, {processes}: {a} {b}");
                }
            }
        }
    }

    /// What several processes cannot do, or cannot share, is told once and before anything is written.
    #[test]
    fn what_processes_cannot_do_is_told_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let told = |processes, case: &str, more: &[&str], expected: &str| {
            let (output, summary) = run(folder.path(), processes, case, more);
            assert_eq!((output.status.code(), summary), (Some(1), Value::Null), "{case}: {}", error(&output));
            assert_eq!(error(&output).matches(expected).count(), 1, "{case}: {}", error(&output));
        };
        told(2, "string", &[], "cannot be solved by several processes");
        told(2, "impact", &[], "motion with inertia cannot be solved by several processes");
        told(2, "belt", &[], "cannot be solved by several processes");
        told(2, "nothing", &[], "the gallery has no case");
        let few = ["--set", "bodies.block.solid.mesh.box.cells=[1,1,1]"];
        told(3, "incline", &few, "processes have only");
        let (output, summary) = run(folder.path(), 2, "incline", &["--set", "method.linear={petsc=\"-no_such 1\"}"]);
        assert!(output.status.success(), "{}", error(&output));
        assert!(summary["warnings"].to_string().contains("did not use the options `-no_such`"), "{summary}");
    }

    /// An image that one process cannot read, or that is another one there, ends all of them with a word.
    #[test]
    fn an_image_is_the_same_for_all_processes() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = "[bodies.block.cells]\ngeometry.image = { file = \"image.npy\", spacing = [1, 1, 1], threshold = 0.5 }\n\
                    mesh.grid = { cells = [2, 2, 2] }\nmaterial.linear_elastic = { youngs_modulus = 1, poissons_ratio = 0.3 }\n\
                    [supports.base]\non = \"block:bottom\"\ndisplacement = [0, 0, 0]\n[[steps]]\nto = 1\n";
        let image = |value: u8| {
            let head = format!("{:<117}\n", "{'descr': '|u1', 'fortran_order': False, 'shape': (4, 4, 4), }");
            [&b"\x93NUMPY\x01\x00\x76\x00"[..], head.as_bytes(), &[1; 32], &[value; 32]].concat()
        };
        let told = |other: Option<u8>, expected: &str| {
            for (name, image) in [("first", Some(image(0))), ("second", other.map(image))] {
                let own = folder.path().join(name);
                std::fs::create_dir_all(&own).expect("a folder");
                std::fs::write(own.join("case.toml"), case).expect("a file");
                image.into_iter().for_each(|image| std::fs::write(own.join("image.npy"), image).expect("a file"));
            }
            let program = assert_cmd::cargo::cargo_bin("signorini").display().to_string();
            let mut command = mpirun(folder.path());
            for (name, end) in [("first", Some(":")), ("second", None)] {
                command.args(["-n", "1", "--wdir"]).arg(folder.path().join(name));
                command.args([&program, "run", "case.toml", "-o", "out"]).args(end);
            }
            let output = command.output().expect("a run");
            assert_eq!(error(&output).matches(expected).count(), 1, "{}", error(&output));
            assert!(!output.status.success() && !folder.path().join("first/out").exists());
        };
        told(None, "cannot be read");
        told(Some(2), "is not the same for all processes");
    }
}
