//! Words that results are told in, and what to do about them.

use crate::case::{renamed, schema};
use crate::problem::{CaseError, suggestion};
use crate::report::words;

/// A word of the results: a reason, an event, a quantity.
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
    word("force", "result", "Contact force on the membrane; for axisymmetric membranes that of the whole disc."),
    word("t", "result", "Time at the end of the increment, in tables on the screen."),
    word("solves", "result", "Number of equilibrium solves of an increment: `iterations` plus `iterations_before`."),
    word(
        "balance",
        "result",
        "`equilibrium_residual` in tables on the screen: the sum of all forces, relative to the largest one.",
    ),
    word(
        "front",
        "result",
        "In `error_estimate`: root mean square error of the front position. In files of outlines: number of the \
         front.",
    ),
    word(
        "kind",
        "result",
        "Of an event: nucleation, release, merge, split, hole_opened, hole_closed, snap_in or pull_off. Of a contact \
         pair: the features that contain the closest points.",
    ),
    word("gap", "result", "Gap between the surfaces; negative for penetration."),
    word("contact_pressure", "result", "Contact pressure; zero outside the contact zones."),
    word("contact_status", "result", "Contact status: 1 in a contact zone, 0 outside."),
    word("found", "result", "In `check`: contents of images, and properties of bodies of finite cells."),
    word(
        "normal_curvature",
        "result",
        "Of a rope: curvature along the surface normal; negative where the rope is pressed on.",
    ),
    word("geodesic_curvature", "result", "Of a rope: curvature in the tangent plane of the surface."),
    word(
        "tan_alpha",
        "result",
        "Of a rope: ratio of geodesic to normal curvature. Friction across the rope must be at least as large.",
    ),
    word("pulling_traction", "result", "Friction traction along a rope."),
    word("dragging_traction", "result", "Friction traction across a rope."),
    word("tau", "result", "Of a path or rope: unit tangent, in the direction of increasing arc length."),
    word("g", "result", "Of a path or rope: `tau` × `n`, the direction across the path in the tangent plane."),
    word("n", "result", "Of a path or rope: outward normal of the surface."),
    word("k_n", "result", "Normal curvature of a path; negative where it is pressed on."),
    word("k_g", "result", "Geodesic curvature of a path, along `g`."),
    word("s", "result", "Arc length of a path or rope, from its start."),
    word("normal_force", "result", "Contact force per length of a path, -k_n T; for unit tension if none is given."),
    word(
        "along",
        "result",
        "Of a rope on a given curve: friction force per length along the rope, which is the derivative of the \
         tension.",
    ),
    word("across", "result", "Of a rope on a given curve: friction force per length across the rope, -k_g T."),
    word("utilisation", "result", "Ratio of the required friction to the friction limit. From 1 on the path slips."),
    word(
        "tension_limits",
        "result",
        "Smallest and largest end tension of a rope that friction admits for the given start tension.",
    ),
    word("slips", "result", "Whether the given tensions exceed the friction limit."),
    word(
        "sideways",
        "result",
        "Of a shortest path, for each contact: largest deviation from the geodesic that friction admits.",
    ),
    word("drift", "result", "In `sideways`: largest distance of the end of the contact from the geodesic."),
    word(
        "rotation",
        "result",
        "In `sideways`: largest angle between the path and the geodesic at the end of the contact, in radians.",
    ),
    word(
        "moment_arms",
        "result",
        "For each body: derivative of the length of the path with respect to a motion of the body, -∂L. It is the \
         work of a unit tension.",
    ),
    word("shift", "result", "In `moment_arms`: derivative for a displacement of the body along x, y, z."),
    word(
        "turn",
        "result",
        "In `moment_arms`: derivative for a rotation of the body about axes along x, y, z through `about`.",
    ),
    word("about", "result", "In `moment_arms`: centre of rotation of the body."),
    word("length_rate", "result", "Derivative of the length of a path with respect to time."),
    word("frame", "result", "Number of the time at which a path was computed, from 0; `frames` in the case."),
    word("condition", "result", "Of a violation: `lifts_off` or `slides_sideways`."),
    word("lifts_off", "condition", "The rope lifts off: its normal curvature is not negative there."),
    word(
        "slides_sideways",
        "condition",
        "The rope slides sideways: the required friction across it exceeds the limit, |tan α| > μ_g.",
    ),
    word("touchdown", "event", "A path comes into contact with a body."),
    word("lift_off", "event", "A path leaves a body."),
    word("axial_force", "result", "Of a beam: axial force, positive in tension."),
    word("shear_force", "result", "Of a beam: shear forces along the directors of its section."),
    word("torque", "result", "Of a beam: torque, the moment about its axis."),
    word("bending_moment", "result", "Of a beam: bending moments about the directors of its section."),
    word("element", "result", "Number of the element of a rope or beam."),
    word("piece", "result", "Number of the connected part of an outline, from 0."),
    word("weight", "result", "Of a contact point: its weight, an area or length."),
    word("tangent", "result", "Of a contact point: the direction of the first coefficient of friction."),
    word("friction_status", "result", "Friction status: 0 open, 1 stick, 2 slip."),
    word("friction_traction", "result", "Friction traction on the slave, force per area."),
    word("friction_utilisation", "result", "Ratio of the friction traction to the friction limit; 1 in slip."),
    word("slip", "result", "Slip since first contact: relative tangential displacement of the slave to the master."),
    word("status", "result", "`done` if an analysis of paths has finished."),
    word("stress_xx_yy_zz_xy_yz_xz", "result", "Components of the stress, in this order."),
    word("plastic_strain", "result", "Equivalent plastic strain of elastic-plastic solids."),
    word("temperature", "result", "Temperature of solids with `thermal`."),
    word("body", "result", "Number of the body that a cell belongs to."),
    word("x", "result", "Coordinate; the radius in axisymmetric cases."),
    word("y", "result", "Coordinate; in axisymmetric cases of solids the axial coordinate."),
    word("z", "result", "Coordinate; for membranes the height."),
    word("cells", "result", "Number of cells."),
    word("cell_size", "result", "Size of a cell."),
    word("degree", "result", "Polynomial degree of the functions."),
    word("unknowns_at_most", "result", "Number of unknowns without divided cells, at most."),
    word("memory_at_most", "result", "Memory of the solver, at most."),
    word(
        "memory_about",
        "result",
        "Estimated memory of factor, matrices and results of solids, from the structure of the factor.",
    ),
    word(
        "factorisation_about",
        "result",
        "Estimated time of one factorisation on one core, from its number of operations.",
    ),
    word("area_error", "result", "± of the contact area, as in `error_estimate`."),
    word("force_error", "result", "± of the force, as in `error_estimate`."),
    word(
        "points_tested",
        "result",
        "Number of points of a system at which contact is tested: nodes or quadrature points.",
    ),
    word("max_pressure_error", "result", "± of the largest pressure, as in `error_estimate`."),
    word("increments", "result", "Number of increments."),
    word("supports", "result", "Number of supports."),
    word("loads", "result", "Number of loads."),
    word("bodies", "result", "Number of bodies."),
    word("free", "result", "Rigid motions that only contact restrains."),
    word("least_gap_before_load", "result", "Smallest distance to a body before loading, and its position."),
    word("time_about", "result", "Estimated time of a run."),
    word("steepest_slope_without_contact", "result", "Largest slope under the last load without contact."),
    word("iteration", "result", "Number of the solve within its increment."),
    word("residual", "result", "Residual after an iteration, relative to its tolerance."),
    word(
        "nodes_changed",
        "result",
        "Number of nodes that changed their contact status in an iteration of the active set method.",
    ),
    word("action", "result", "Action of the solver."),
    word("event", "result", "Kind of an entry of log.jsonl."),
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
    word("exp", "function", "Exponential function."),
    word("log", "function", "Natural logarithm; the same as `ln`."),
    word("ln", "function", "Natural logarithm."),
    word("log10", "function", "Logarithm to the base 10."),
    word("sqrt", "function", "Square root."),
    word("abs", "function", "Absolute value."),
    word("sign", "function", "Sign: -1, 0 or 1."),
    word("floor", "function", "Largest integer not above the argument."),
    word("ceil", "function", "Smallest integer not below the argument."),
    word("min", "function", "Smallest of two or more arguments."),
    word("max", "function", "Largest of two or more arguments."),
    word("atan2", "function", "atan2(y, x): the angle of the point (x, y) in radians, between -pi and pi."),
    word("hypot", "function", "hypot(a, b): square root of a^2 + b^2."),
    word("pow", "function", "pow(a, b): a^b."),
    word(
        "if",
        "function",
        "if(condition, a, b): a where the condition holds, else b; conditions with < <= > >= == != && || and !.",
    ),
    word("pi", "function", "Ratio of the circumference of a circle to its diameter."),
    word("e", "function", "Base of the natural logarithm."),
    word("distance", "answer", "Distance of two shapes. No pair of points is closer."),
    word("a", "answer", "Parameters of the closest point on the first shape; see the table in docs/closest-points.md."),
    word("b", "answer", "Parameters of the closest point on the second shape."),
    word("xa", "answer", "The closest point of the first shape."),
    word("xb", "answer", "The closest point of the second shape."),
    word("normal", "answer", "Unit vector from `xb` to `xa`; none if they coincide."),
    word(
        "feature_a",
        "answer",
        "Feature of the first shape that contains the closest point: `interior`, `edge`, `vertex` or `point`.",
    ),
    word(
        "feature_b",
        "answer",
        "Feature of the second shape that contains the closest point: `interior`, `edge`, `vertex` or `point`.",
    ),
    word(
        "entity_a",
        "answer",
        "Name of the side, corner, crease or pole of the first shape, such as `u0`, `u0+v1`, `start`, `pole`.",
    ),
    word("entity_b", "answer", "Name of the side, corner, crease or pole of the second shape."),
    word("triangle_a", "answer", "Number of the triangle of the first shape, a mesh, from 0."),
    word("triangle_b", "answer", "Number of the triangle of the second shape, a mesh, from 0."),
    word("unique", "answer", "Whether exactly one pair of points is closest."),
    word("uniqueness", "answer", "`unique`, `multiple`, `continuum` or `near-continuum`."),
    word("multiple", "answer", "Several separate pairs of points are equally close; all are reported."),
    word(
        "continuum",
        "answer",
        "A curve or surface of pairs is equally close, as for coaxial cylinders; `others` contains samples.",
    ),
    word(
        "near-continuum",
        "answer",
        "One pair of points is closest, in a valley of the distance that is flat to round-off.",
    ),
    word(
        "continuum_dim",
        "answer",
        "Dimension of a continuum of closest points: 1 for a curve, 2 for a surface; otherwise 0.",
    ),
    word("others", "answer", "Further closest points; in a table their number."),
    word(
        "lambda_min",
        "answer",
        "Smallest eigenvalue of the Hessian of half the squared distance: 1 - d κ for a point and a surface, 0 on a focal set.",
    ),
    word("certified", "answer", "Whether it is proved that no pair of points is closer. If not, the exit status is 2."),
    word("certified_to", "answer", "No pair of points is closer than the distance minus this value."),
    word("id", "answer", "Name of a query; for points from a file the number of the row, from 0."),
    word("error", "answer", "Error of a query. The other queries are answered, and the exit status is 1."),
    word(
        "to",
        "option of closest",
        "signorini closest points.npy --to part.stl -o answers.npy: the shape on which the points of a file are \
         projected. Points are an array of NumPy of shape (n, 3), or text with three numbers per line or columns \
         named x, y, z.",
    ),
    word("output", "option of closest", "File for the answers; .json, .csv and .npy determine the format."),
    word("local_minima", "option of closest", "Every local minimum of the distance is also reported in `others`."),
    word(
        "shapes",
        "queries of closest",
        "Shapes that are given once, before the cases: \"shapes\": {\"part\": {…}}; a query refers to one by its \
         name, \"b\": \"part\".",
    ),
    word("cases", "queries of closest", "The queries: [{\"id\": …, \"a\": SHAPE, \"b\": SHAPE}, …]."),
    word(
        "exit status",
        "command",
        "0 done; 1 wrong input; 2 not converged, results so far are on disk; 3 a fault of the program; 130 \
         interrupted.",
    ),
    word(
        "expressions",
        "command",
        "Numbers, + - * / ^ and parentheses; conditions with < <= > >= == != && || !; sin cos tan asin acos atan sinh cosh tanh exp log ln log10 sqrt abs sign floor ceil min max atan2 hypot pow if(condition, a, b); pi, e; x, y, z, t; names of `constants` and `functions`.",
    ),
    word(
        "units",
        "command",
        "Without `units` numbers are in any consistent units. With units = \"mm-N-MPa\" numbers without unit are in \
         these units, and \"0.1 um\" is converted.",
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
        "# Reference of the case file\n\nGenerated by `signorini schema --markdown` from the types of the program. \
         `NAME` stands for a name of your own. Keys marked * are required in their table. `signorini explain KEY` \
         prints the same texts.\n\n{}\n# Reference of the summary\n\nThe keys of summary.json. They are the same for \
         all models; a quantity that a model does not have is null. Numbers are in the base units of the case. \
         Vectors have three entries.\n\n{}\n## Words in the summary\n\n| word | where | meaning |\n|---|---|---|\n",
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
        let needed = if key.required { ", required" } else { "" };
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
    let help = match renamed::present_word(word) {
        Some(present) => format!("`{word}` is now `{present}`"),
        None => suggestion(word, &known),
    };
    Err(CaseError::new(format!("`{asked}` is not known")).help(help))
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
