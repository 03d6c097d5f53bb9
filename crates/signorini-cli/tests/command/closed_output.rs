//! Commands whose standard output or standard error takes nothing: closed, as by `head`, or full, as on a full disk.
#![cfg(unix)]

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};

const CASE: &str = include_str!("../../../../gallery/string/case.toml");
const QUERIES: &str = r#"{"format": "cpp-corpus-1", "cases": [
    {"id": "first", "a": {"type": "point", "p": [0, 0, 2]}, "b": {"type": "point", "p": [0, 0, 0]}}]}"#;

/// Quick arguments for a command, and its exit status when nobody reads its output; `None` for an unknown command.
fn arguments(command: &str) -> Option<(&'static [&'static str], i32)> {
    Some(match command {
        "run" => (&["run", "case.toml", "-o", "out", "--set", "output.pictures=false"], 0),
        "sweep" => (
            &[
                "sweep",
                "case.toml",
                "--vary",
                "bodies.film.membrane.degree=3,4",
                "-o",
                "swept",
                "--set",
                "output.pictures=false",
            ],
            0,
        ),
        "check" => (&["check", "case.toml"], 0),
        "fit" => (&["fit", "case.toml", "--json"], 1),
        "closest" => (&["closest", "queries.json", "-o", "answers.json"], 0),
        "report" => (&["report", "nothing", "--json"], 1),
        "draw" => (&["draw", "nothing", "--json"], 1),
        "view" => (&["view", "nothing", "--json"], 1),
        "new" => (&["new", "string", "begun"], 0),
        "import" => (&["import", "nothing.inp", "--json"], 1),
        "migrate" => (&["migrate", "case.toml"], 0),
        "explain" => (&["explain"], 0),
        "schema" => (&["schema"], 0),
        // It ends with its output, before all problems are verified.
        "verify" => (&["verify"], 130),
        "reproduce" => (&["reproduce"], 0),
        "completions" => (&["completions", "bash"], 0),
        "man" => (&["man", "pages"], 0),
        "gallery" => (&["gallery"], 0),
        "gallery run" => (&["gallery", "run", "string", "-o", "example", "--set", "output.pictures=false"], 0),
        "gallery show" => (&["gallery", "show", "string"], 0),
        "help" | "gallery help" => (&["help"], 0),
        _ => return None,
    })
}

/// The subcommands that the help of a command lists.
fn subcommands(command: &[&str]) -> Vec<String> {
    let output = signorini(Path::new(".")).args(command).arg("--help").output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    let list = help.split_once("Commands:\n").map_or("", |(_, rest)| rest.split("\n\n").next().unwrap());
    let names = list.lines().filter_map(|l| l.strip_prefix("  ")).filter(|l| !l.starts_with(' '));
    names.map(|l| [command, &[l.split(' ').next().unwrap()]].concat().join(" ")).collect()
}

fn signorini(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_signorini"));
    command.current_dir(folder);
    command
}

/// A pipe that nobody reads.
fn closed() -> Stdio {
    std::io::pipe().unwrap().1.into()
}

fn full() -> Stdio {
    File::options().write(true).open("/dev/full").unwrap().into()
}

/// What became of a command in a folder of its own.
struct Ended {
    name: String,
    usual: i32,
    code: Option<i32>,
    told: String,
    folder: tempfile::TempDir,
}

/// Runs every command with this standard output.
fn every_command(stdout: fn() -> Stdio) -> Vec<Ended> {
    let names: Vec<String> = subcommands(&[]).into_iter().chain(subcommands(&["gallery"])).collect();
    assert!(names.len() > 10, "{names:?}");
    let run = |name: String| {
        let (arguments, usual) = arguments(&name).unwrap_or_else(|| panic!("add the command `{name}` to this test"));
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("case.toml"), CASE).unwrap();
        std::fs::write(folder.path().join("queries.json"), QUERIES).unwrap();
        let output = signorini(folder.path()).args(arguments).stdout(stdout()).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        Ended { name, usual, code: output.status.code(), told, folder }
    };
    names.into_iter().map(run).collect()
}

#[test]
fn a_reader_that_goes_away_ends_the_printing_and_nothing_else() {
    for Ended { name, usual, code, told, folder } in every_command(closed) {
        assert_eq!((code, &*told), (Some(usual), ""), "{name}");
        let written = match &*name {
            "run" => "out/summary.json",
            "sweep" => "swept/sweep.csv",
            "gallery run" => "example/summary.json",
            "closest" => "answers.json",
            "new" => "begun/case.toml",
            "man" => "pages/signorini-gallery-run.1",
            _ => continue,
        };
        assert!(folder.path().join(written).is_file(), "{name}: {written}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn full_output_is_told() {
    for Ended { name, usual, code, told, .. } in every_command(full) {
        assert_eq!(code, Some(usual.max(1)), "{name}: {told}");
        assert!(told.contains("cannot write to standard output: No space left"), "{name}: {told}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn errors_that_cannot_be_told_leave_the_exit_status() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in
        [&["check", "none.toml"][..], &["closest", "none.json", "-o", "a.json"], &["reproduce", "none"], &[]]
    {
        for stderr in [closed, full] {
            let status = signorini(folder.path()).args(arguments).stderr(stderr()).stdout(Stdio::null()).status();
            assert_eq!(status.unwrap().code(), Some(1), "{arguments:?}");
        }
    }
}
