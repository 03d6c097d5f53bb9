//! Of `case::renamed`.

use signorini_problem::case::{read, renamed::modernised};

const EARLIER: &str = r#"space = "3d" # moves nothing
constants.uniform = 2
[bodies.turn.rigid] # a name of its own
lies = 'above'
shape.stl = { file = "move.stl", turn = [0, 0, 1], move = [1, 2, 3] }
[bodies.rope.rope]
stiffness = 1
path.file = { file = "path.csv", "turn" = [0, 0, 1] }
winch = { at = "end", paid_out = "t" }
[supports.within]
on = "rope:start"
uniform = true
[contacts.a]
within = "rope"
method.discrete_cell.radius = 0.1
[contacts.a.method.discrete_cell.penalty]
wanted_penetration = 0.1
[contacts.b]
all = true
method = "discrete_cell"
[[steps]]
to = 1
"#;

#[test]
fn keys_of_earlier_versions_get_their_present_names_and_nothing_else_changes() {
    let (text, renamed) = modernised(EARLIER);
    let present = EARLIER
        .replace("lies", "side")
        .replace("turn = [", "rotate = [")
        .replace("\"turn\" =", "rotate =")
        .replace(" move = [", " translate = [")
        .replace("paid_out", "length")
        .replace("uniform = true", "tied = true")
        .replace("within = \"rope", "self_contact = \"rope")
        .replace("discrete_cell", "discs")
        .replace("wanted_penetration", "penetration");
    assert_eq!(text, present);
    let of_line = |line: usize| renamed.iter().filter(|key| key.line == line).count();
    assert_eq!((4..=20).map(of_line).collect::<Vec<_>>(), [1, 2, 0, 0, 1, 1, 0, 0, 1, 0, 1, 1, 1, 1, 0, 0, 1]);
    assert_eq!(modernised(&text), (text.clone(), Vec::new()));
    assert_eq!(modernised("lies = ").0, "lies = ");
    // A key by both names is one too many.
    let both = "space = \"plane\"\n[bodies.b.rigid]\nlies = \"above\"\nside = \"above\"\nshape.height = 0\n";
    let told = read("case.toml", both, &[]).expect_err("two names").one_line();
    assert!(told.contains("case.toml:3") && told.contains("`lies`"), "{told}");
}

#[test]
fn places_and_settings_of_renamed_keys_are_those_of_the_file() {
    let case = "space = \"plane\"\n[bodies.a.rigid]\nlies = \"above\"\nshape.height = 0\n\
        [bodies.b.rigid]\nshape.heigt = 0\n";
    let told = read("case.toml", case, &[]).expect_err("a misspelt key").one_line();
    assert!(told.contains("case.toml:6:7"), "{told}");
    let case = case.replace("heigt", "height");
    let problem = read("case.toml", &case, &["bodies.b.rigid.lies=below".into()]).expect("a case");
    let told = problem.source.renamed_keys().expect("two renamed keys");
    assert!(told.contains("`lies` is now `side` (line 3)") && told.contains("migrate case.toml"), "{told}");
    let sides = problem.bodies.values().map(|body| serde_json::to_value(body).unwrap()["rigid"]["side"].clone());
    assert_eq!(sides.collect::<Vec<_>>(), ["above", "below"]);
    let told = read("case.toml", &case, &["bodies.b.rigid.lies=besides".into()]).expect_err("a word").one_line();
    assert!(told.contains("--set") && told.contains("besides"), "{told}");
}
