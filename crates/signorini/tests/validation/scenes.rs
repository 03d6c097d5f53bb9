//! Scenes: the swords of the gallery, and scenes that are wrong.

use serde_json::Value;
use signorini::gallery::SCENES;
use signorini::run::Silent;
use signorini::scene::{KINDS, Scene, run};
use std::path::Path;

#[test]
fn the_swords_meet_in_all_six_ways() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::parse("swords.toml", SCENES[0].case, Path::new("")).unwrap();
    let summary = run(&scene, &folder.path().join("out"), &mut Silent).unwrap();
    let expected: Value = serde_json::from_str(include_str!("../../../../gallery/swords/expected.json")).unwrap();
    assert_eq!(summary["frames"], expected["frames"]);
    let kinds: Vec<&str> = summary["contact_pair_kinds"].as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(Value::from(kinds), expected["contact_pair_kinds"]);
    let gap = summary["closest"]["gap"].as_f64().unwrap();
    let value = expected["closest_gap"]["value"].as_f64().unwrap();
    assert!((gap / value - 1.0).abs() < expected["closest_gap"]["relative_tolerance"].as_f64().unwrap(), "{gap}");
    let table = std::fs::read_to_string(folder.path().join("out/pairs.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 6 * 151);
    let columns = table.lines().next().unwrap().split(',').count();
    assert!(table.lines().all(|l| l.split(',').count() == columns));
    for name in ["pictures/scene.png", "pictures/kinds.png", "bodies.pvd", "frames/pairs_0150.vtp", "summary.json"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
}

/// Rigid motion keeps what is inside: the gap of a kind is never less than that of a kind with higher features.
#[test]
fn faces_are_never_farther_than_their_edges_and_points() {
    let scene = Scene::parse("swords.toml", SCENES[0].case, Path::new("")).unwrap();
    for &time in scene.times.iter().step_by(15) {
        let frame = scene.at(time).unwrap();
        let gap = |name: &str| {
            let kind = KINDS.iter().position(|k| k.1 == name).unwrap();
            frame.pairs.iter().find(|p| p.kind == kind).unwrap().pair.distance
        };
        for (less, more) in [
            ("surface-surface", "curve-surface"),
            ("curve-surface", "point-surface"),
            ("curve-surface", "curve-curve"),
            ("curve-curve", "point-curve"),
            ("point-curve", "point-point"),
        ] {
            assert!(gap(less) <= gap(more) + 1e-12, "t = {time}: {less} {} > {more} {}", gap(less), gap(more));
        }
    }
}

#[test]
fn wrong_scenes_say_what_is_wrong() {
    let good = SCENES[0].case;
    for (from, to, word) in [
        ("frames = 151", "frames = 1", "frames"),
        ("time = [0, 10]", "time = [1, 0]", "time"),
        ("up = [0, 0, 1]", "up = [0.5, -1.0, 0.8]", "camera"),
        (
            "[bodies.longsword]",
            "[bodies.third]\nparts = [{type = \"point\", p = [0,0,0]}]\n[bodies.longsword]",
            "3 bodies",
        ),
        ("type = \"bezier\"", "type = \"bezzier\"", "bezzier"),
        ("displacement = [", "displacment = [", "displacment"),
        ("min(t, 1)", "min(q, 1)", "q"),
        ("frames = 151", "frames = 151\ncolour = 3", "colour"),
    ] {
        assert!(good.contains(from), "{from}");
        let error = Scene::parse("swords.toml", &good.replace(from, to), Path::new("")).err().unwrap();
        let text = format!("{error:?}{error}");
        assert!(text.contains(word), "{to}: {text}");
    }
}
