//! Words that results are told in, and what to do about them.

use crate::case::schema;
use crate::problem::{CaseError, suggestion};
use crate::report::words;

/// A word of the results: a reason, an event, a figure.
#[derive(Clone, Copy, Debug)]
struct Word {
    pub word: &'static str,
    pub kind: &'static str,
    pub about: &'static str,
}

const fn word(word: &'static str, kind: &'static str, about: &'static str) -> Word {
    Word { word, kind, about }
}

/// What `explain` knows besides the keys and words of case file and summary.
const WORDS: &[Word] = &[
    word("force", "result", "Force of the floor on the membrane; for a round membrane, of the whole of it."),
    word("t", "result", "Time, as in the tables of the terminal: the end of the increment."),
    word("solves", "result", "Equilibrium solves of an increment: `iterations` and `iterations_before` together."),
    word(
        "balance",
        "result",
        "`equilibrium_residual` in the tables of the terminal: the sum of all forces, relative to the largest.",
    ),
    word(
        "front",
        "result",
        "In `error_estimate`: root mean square of the distance by which fronts are off. In files of outlines: number of the front.",
    ),
    word(
        "kind",
        "result",
        "Of an event: nucleation, release, merge, split, hole_opened, hole_closed, snap_in or pull_off. Of a pair of bodies: what its closest points lie on.",
    ),
    word("gap", "result", "Distance between the surfaces; negative where they penetrate."),
    word("contact_pressure", "result", "Pressure of the contact, zero outside the zones."),
    word("contact_status", "result", "1 within a zone of contact, 0 outside."),
    word("found", "result", "Of `check`: what images hold, and what bodies of finite cells came to."),
    word(
        "normal_curvature",
        "result",
        "Of a rope: curvature along the normal of what it touches; negative where it is pressed on.",
    ),
    word("geodesic_curvature", "result", "Of a rope: curvature within the surface that it touches."),
    word("tan_alpha", "result", "Of a rope: geodesic over normal curvature, which friction across it must hold."),
    word("pulling_traction", "result", "Part of the friction traction along a rope."),
    word("dragging_traction", "result", "Part of the friction traction across a rope."),
    word("tau", "result", "Of a path or rope: its unit tangent, in the direction of its arc length."),
    word("g", "result", "Of a path or rope: `tau` × `n`, the direction across it within the surface."),
    word("n", "result", "Of a path or rope: the outward normal of what it lies on."),
    word("k_n", "result", "`normal_curvature` of a path; negative where it is pressed on."),
    word("k_g", "result", "`geodesic_curvature` of a path, along `g`."),
    word("s", "result", "Arc length of a path or rope, from its start."),
    word(
        "normal_force",
        "result",
        "Force per length with which a path is pressed on, -k_n T; of a tension of one where none is stated.",
    ),
    word("along", "result", "Of a rope on a given curve: friction per length along it, the slope of the tension."),
    word("across", "result", "Of a rope on a given curve: friction per length across it, -k_g T."),
    word("utilisation", "result", "Part of the friction there is that is asked for; from 1 on the path slips."),
    word(
        "tension_limits",
        "result",
        "Least and largest tension at the end of a rope that friction holds with the one at its start.",
    ),
    word("slips", "result", "Whether the tensions stated ask for more friction than there is."),
    word("sideways", "result", "Of a wrapping path, for each contact: how far friction lets it leave the geodesic."),
    word("drift", "result", "In `sideways`: the largest distance of the end of the contact from the geodesic."),
    word(
        "rotation",
        "result",
        "In `sideways`: the largest angle of the end of the contact to the geodesic, in radians.",
    ),
    word(
        "moment_arms",
        "result",
        "By body: how the length of the path follows a motion of it, -∂L: the work of a tension of one.",
    ),
    word("shift", "result", "In `moment_arms`: for a displacement of the body along x, y, z."),
    word("turn", "result", "In `moment_arms`: for a rotation of the body about axes along x, y, z through `about`."),
    word("about", "result", "In `moment_arms`: the point about which the body turns."),
    word("length_rate", "result", "Derivative of the length of a path with respect to time."),
    word("frame", "result", "Number of the time at which a path was found, from 0; `frames` in the case."),
    word("condition", "result", "Of a violation: `lifts_off` or `slides_sideways`."),
    word("lifts_off", "condition", "A rope is pulled off the surface there: its normal curvature is not negative."),
    word("slides_sideways", "condition", "A rope asks for more friction across it than there is: |tan α| > μ_g."),
    word("touchdown", "event", "A path comes to touch a body."),
    word("lift_off", "event", "A path leaves a body."),
    word("axial_force", "result", "Of a beam: force along its axis, positive where it pulls."),
    word("shear_force", "result", "Of a beam: force across its axis, on the directors of its section."),
    word("torque", "result", "Of a beam: moment about its axis."),
    word("bending_moment", "result", "Of a beam: moments about the directors of its section."),
    word("element", "result", "Number of the element of a rope or beam."),
    word("piece", "result", "Number of the connected piece of an outline, from 0."),
    word("weight", "result", "Of a point of contact: the area, or length, that it stands for."),
    word("tangent", "result", "Of a point of contact: the direction along which friction has its first coefficient."),
    word("friction_status", "result", "0 where open, 1 where it sticks, 2 where it slips."),
    word("friction_traction", "result", "Friction on the slave side, per area."),
    word("friction_utilisation", "result", "Friction as a part of what the law allows: 1 where it slips."),
    word("slip", "result", "Way along the surface since the point touched."),
    word("status", "result", "`done` of an analysis of paths that came to its end."),
    word("stress_xx_yy_zz_xy_yz_xz", "result", "Components of the stress, in this order."),
    word("body", "result", "Number of the body that a cell belongs to."),
    word("x", "result", "Coordinate; the radius in axisymmetric cases."),
    word("y", "result", "Coordinate; of axisymmetric solids the height."),
    word("z", "result", "Coordinate; for membranes the height."),
    word("cells", "result", "Number of cells."),
    word("cell_size", "result", "Length of a cell."),
    word("degree", "result", "Degree of the functions on the cells."),
    word("unknowns_at_most", "result", "Unknowns on cells that are not divided."),
    word("memory_at_most", "result", "Memory that the solver needs, about."),
    word(
        "memory_about",
        "result",
        "Memory that the factor, matrices and results of solids take, from the structure of the factor.",
    ),
    word("factorisation_about", "result", "Time of a factorisation on one core, from its number of operations."),
    word("area_error", "result", "± of the area of contact, as `error_estimate` tells it."),
    word("force_error", "result", "± of the force, as `error_estimate` tells it."),
    word("points_tested", "result", "Points of systems at which contact is tested, of nodes or of quadrature."),
    word("max_pressure_error", "result", "± of the largest pressure, as `error_estimate` tells it."),
    word("increments", "result", "Number of increments."),
    word("supports", "result", "Number of supports."),
    word("loads", "result", "Number of loads."),
    word("bodies", "result", "Number of bodies."),
    word("free", "result", "Motions that nothing but contact holds."),
    word("least_gap_before_load", "result", "Least distance to a body before any load, and where."),
    word("time_about", "result", "Time that a run takes, about."),
    word("steepest_slope_without_contact", "result", "Largest slope under the last load if nothing were in the way."),
    word("iteration", "result", "Number of the solve within its increment."),
    word("residual", "result", "What is left after a solve, relative to its tolerance."),
    word("nodes_changed", "result", "Nodes that came into contact or left it in a step of the active set."),
    word("action", "result", "What the solver did."),
    word("event", "result", "Kind of a line of log.jsonl."),
    word("step", "result", "Number of the increment, in log.jsonl."),
    word("sin", "function", "Sine of an angle in radians."),
    word("cos", "function", "Cosine of an angle in radians."),
    word("tan", "function", "Tangent of an angle in radians."),
    word("asin", "function", "Angle in radians with this sine."),
    word("acos", "function", "Angle in radians with this cosine."),
    word("atan", "function", "Angle in radians with this tangent, between -pi/2 and pi/2."),
    word("sinh", "function", "Hyperbolic sine."),
    word("cosh", "function", "Hyperbolic cosine."),
    word("tanh", "function", "Hyperbolic tangent."),
    word("exp", "function", "Power of e."),
    word("log", "function", "Natural logarithm; the same as `ln`."),
    word("ln", "function", "Natural logarithm."),
    word("log10", "function", "Logarithm to the base 10."),
    word("sqrt", "function", "Square root."),
    word("abs", "function", "Absolute value."),
    word("sign", "function", "-1, 0 or 1."),
    word("floor", "function", "Largest whole number not above."),
    word("ceil", "function", "Least whole number not below."),
    word("min", "function", "Least of two arguments or more."),
    word("max", "function", "Largest of two arguments or more."),
    word("atan2", "function", "atan2(y, x): the angle of the point (x, y) in radians, between -pi and pi."),
    word("hypot", "function", "hypot(a, b): root of a^2 + b^2."),
    word("pow", "function", "pow(a, b): a^b."),
    word(
        "if",
        "function",
        "if(condition, a, b): a where the condition holds, else b; conditions with < <= > >= == != && || and !.",
    ),
    word("pi", "function", "Ratio of the circumference of a circle to its diameter."),
    word("e", "function", "Base of the natural logarithm."),
    word("distance", "answer", "Distance of two shapes: no two points of theirs are closer."),
    word(
        "a",
        "answer",
        "Parameters of the closest point on the first shape; the table of docs/closest-points.md tells which.",
    ),
    word("b", "answer", "Parameters of the closest point on the second shape."),
    word("xa", "answer", "The closest point of the first shape."),
    word("xb", "answer", "The closest point of the second shape."),
    word("normal", "answer", "Unit vector from `xb` to `xa`; none where they coincide."),
    word("feature_a", "answer", "Where on the first shape: `interior`, `edge`, `vertex` or `point`."),
    word("feature_b", "answer", "Where on the second shape: `interior`, `edge`, `vertex` or `point`."),
    word(
        "entity_a",
        "answer",
        "Which side, corner, crease or pole of the first shape, such as `u0`, `u0+v1`, `start`, `pole`.",
    ),
    word("entity_b", "answer", "Which side, corner, crease or pole of the second shape."),
    word("triangle_a", "answer", "Triangle of the first shape, a mesh, counted from 0."),
    word("triangle_b", "answer", "Triangle of the second shape, a mesh, counted from 0."),
    word("unique", "answer", "Whether one pair of points is closer than every other."),
    word("uniqueness", "answer", "`unique`, `multiple`, `continuum` or `near-continuum`."),
    word("multiple", "answer", "Several separate pairs of points are as close; all are told."),
    word(
        "continuum",
        "answer",
        "A curve or a surface of pairs is as close, as of coaxial cylinders; `others` are samples.",
    ),
    word("near-continuum", "answer", "One pair of points is closest, in a valley that is flat to rounding."),
    word("continuum_dim", "answer", "Dimension of a continuum of closest points: 1 a curve, 2 a surface; else 0."),
    word("others", "answer", "Further closest points; in a table their number."),
    word(
        "lambda_min",
        "answer",
        "Smallest eigenvalue of the Hessian of half the squared distance: 1 - d κ for a point and a surface, 0 on a focal set.",
    ),
    word("certified", "answer", "Whether it is proved that nothing is closer; if not, the exit status is 2."),
    word("certified_to", "answer", "No two points are closer than the distance less this."),
    word("id", "answer", "Name of a query; of points from a file the number of the row, from 0."),
    word("error", "answer", "What is wrong with a query; the others are answered, and the exit status is 1."),
    word(
        "to",
        "option of closest",
        "signorini closest points.npy --to part.stl -o answers.npy: the shape to which the points of a file are projected. Points are an array of NumPy of shape (n, 3), or text with three numbers a line or columns named x, y, z.",
    ),
    word("output", "option of closest", "File for the answers; .json, .csv and .npy tell its form."),
    word("local_minima", "option of closest", "Every local minimiser is told in `others`, too."),
    word(
        "shapes",
        "queries of closest",
        "Shapes named once, before the cases: \"shapes\": {\"part\": {…}}; a query uses one by its name, \"b\": \"part\".",
    ),
    word("cases", "queries of closest", "The queries: [{\"id\": …, \"a\": SHAPE, \"b\": SHAPE}, …]."),
    word(
        "exit status",
        "command",
        "0 done; 1 the input is wrong; 2 not converged, results so far are on disk; 3 a fault of ours; 130 interrupted.",
    ),
    word(
        "expressions",
        "command",
        "Numbers, + - * / ^ and parentheses; conditions with < <= > >= == != && || !; sin cos tan asin acos atan sinh cosh tanh exp log ln log10 sqrt abs sign floor ceil min max atan2 hypot pow if(condition, a, b); pi, e; x, y, z, t; names of `constants` and `functions`.",
    ),
    word(
        "units",
        "command",
        "Without `units` numbers are in any consistent units. With units = \"mm-N-MPa\" bare numbers stand in these, and \"0.1 um\" is converted.",
    ),
];

/// All words with their kinds, those of the types first.
pub fn words() -> Vec<(String, &'static str)> {
    let of_types = words::words().into_iter().map(|w| (w.word, w.kind));
    of_types.chain(WORDS.iter().map(|w| (w.word.to_string(), w.kind))).collect()
}

/// The reference of the manual in Markdown: the keys of the case file and of the summary, and the words in it.
pub fn reference() -> String {
    // In the case file those are marked that are needed; in the summary all are there.
    let of_summary: Vec<schema::Key> =
        words::keys().into_iter().map(|key| schema::Key { required: false, ..key }).collect();
    let mut text = format!(
        "# Reference of the case file\n\n\
         Generated by `signorini schema --markdown` from the types that read case files. `NAME` stands for a name of \
         your own; keys marked * are needed in the table that they stand in. `signorini explain KEY` tells the same.\n\n\
         {}\n# Reference of the summary\n\n\
         What stands in summary.json, from the types that it is written by: the same keys for all models, null where a model \
         has no such figure. Numbers are in the base units of the case; vectors have three entries.\n\n{}\n\
         ## Words in the summary\n\n| word | where | meaning |\n|---|---|---|\n",
        schema::tables(&schema::keys()),
        schema::tables(&of_summary),
    );
    for w in words::words() {
        text += &format!("| `{}` | {} | {} |\n", w.word, w.kind, w.about);
    }
    text
}

/// Explains a key of the case file or a word of the results.
///
/// # Errors
/// A word that nothing is known of, with the nearest one that is.
pub fn explain(asked: &str) -> Result<String, CaseError> {
    let mut text = String::new();
    let as_one = |word: &str| word.replace([' ', '-'], "_");
    let plain = as_one(asked.trim().trim_start_matches("--").to_lowercase().as_str());
    if let Some(text) = column(asked.trim()) {
        return text;
    }
    for w in WORDS.iter().filter(|w| as_one(w.word) == plain) {
        text += &format!("{} ({})\n  {}\n", w.word, w.kind, w.about);
    }
    for w in words::words().iter().filter(|w| w.word == plain) {
        text += &format!("{} ({})\n  {}\n", w.word, w.kind, w.about);
    }
    // The same is told once, however many tables have it.
    let mut told = Vec::new();
    for key in words::keys().into_iter().filter(|k| k.ends_with(&plain)) {
        if !told.contains(&key.about) {
            text += &format!("{} (summary: {})\n  {}\n", key.path, key.kind, key.about);
            told.push(key.about);
        }
    }
    for key in schema::find(asked.trim()) {
        let needed = if key.required { ", needed" } else { "" };
        text += &format!("{} (key: {}{needed})\n  {}\n", key.path, key.kind, key.about);
        let within = schema::keys_in(&key.path);
        if !within.is_empty() {
            text += &format!("  with {}\n", within.join(", "));
        }
    }
    if !text.is_empty() {
        return Ok(text);
    }
    let keys = schema::keys();
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().trim_end_matches("[]").to_string();
    let of_case = keys.iter().map(|k| last(&k.path)).chain(WORDS.iter().map(|w| w.word.into()));
    let of_summary = words::keys().into_iter().map(|k| last(&k.path)).chain(words::words().into_iter().map(|w| w.word));
    let mut known: Vec<String> = of_case.chain(of_summary).collect();
    known.sort();
    known.dedup();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let word = asked.trim().rsplit('.').next().unwrap_or_default();
    Err(CaseError::new(format!("nothing is known of `{asked}`")).help(suggestion(word, &known)))
}

/// A column of a table named after something of the case, `touch:area`, or after a component, `slip_x`; none for words that
/// are known as they are.
fn column(asked: &str) -> Option<Result<String, CaseError>> {
    if let Some((_, word)) = asked.split_once(':').filter(|(of, word)| !of.is_empty() && !word.is_empty()) {
        return Some(explain(word));
    }
    let (vector, axis) = ["_x", "_y", "_z"].iter().find_map(|end| Some((asked.strip_suffix(end)?, &end[1..])))?;
    let known = |word: &str| WORDS.iter().any(|w| w.word == word) || words::keys().iter().any(|k| k.ends_with(word));
    (known(vector) && !known(asked)).then(|| explain(vector).map(|text| format!("along {axis}: {text}")))
}
