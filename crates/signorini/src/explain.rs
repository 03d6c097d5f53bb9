//! Words that results are told in, and what to do about them.

use crate::case::{CaseError, schema, suggestion};

/// A word of the results: a reason, an event, a figure.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    pub word: &'static str,
    pub kind: &'static str,
    pub about: &'static str,
}

const fn word(word: &'static str, kind: &'static str, about: &'static str) -> Word {
    Word { word, kind, about }
}

/// Everything that `explain` knows besides the keys of the case file.
pub const WORDS: &[Word] = &[
    word("converged", "reason", "All conditions hold within the tolerances that the problem's own scales give."),
    word("no_contact", "reason", "In equilibrium, and nothing touches."),
    word(
        "iteration_limit",
        "reason",
        "The fronts did not come to rest. Try more cells, or refine = { fronts = 2 } in the mesh, where zones are small or close to each other; smaller increments; a lower degree. method.active_set = {} shows a coarse picture of the zones.",
    ),
    word(
        "no_such_state",
        "reason",
        "No equilibrium with contact near `initial_zone`: at this load adhesion may hold none. Try another zone, or a load at which the contact exists.",
    ),
    word(
        "path_lost",
        "reason",
        "A path by arc length or area could not be followed further; the last warning says where. Try smaller increments, or more cells.",
    ),
    word(
        "linear_solver",
        "reason",
        "The equations could not be solved: is the body held, and are its data of one scale? The warning tells which unknown.",
    ),
    word(
        "interrupted",
        "reason",
        "Stopped by Ctrl-C; the increments done are on disk. Go on with signorini run CASE --resume.",
    ),
    word(
        "input",
        "reason",
        "A value became invalid along the way, for example a tension that is not positive at some time.",
    ),
    word(
        "free_body",
        "reason",
        "A body can move without resistance in the way that is named, or its load pulls it away: hold it, or press it into contact.",
    ),
    word("newton", "reason", "The iteration on large sliding did not end. Try smaller increments."),
    word(
        "contact",
        "reason",
        "The state of contact alternates at the places that are named. Try smaller increments or finer cells there.",
    ),
    word("nucleation", "event", "A zone of contact appears."),
    word("release", "event", "A zone of contact vanishes."),
    word("merge", "event", "Two zones become one."),
    word("split", "event", "A zone becomes two."),
    word("hole_opened", "event", "A hole appears in a zone."),
    word("hole_closed", "event", "A hole in a zone vanishes."),
    word(
        "snap_in",
        "event",
        "Adhesion draws the membrane into contact at once; `energy_released` is what is lost in the jump.",
    ),
    word("pull_off", "event", "The contact jumps open; `energy_released` is what is lost in the jump."),
    word("area", "result", "Area of contact; a length for a string."),
    word("force", "result", "Force of the floor on the membrane; for a round membrane, of the whole of it."),
    word("zones", "result", "Number of connected zones of contact."),
    word("holes", "result", "Number of holes in the zones."),
    word(
        "error_estimate",
        "result",
        "What the discretisation leaves uncertain, estimated with functions of one degree more: `front`, the root mean square of the distance by which fronts are off; `area`; `force`. Told for the last increment of a step. For solids `force`, `area` and `max_pressure` of the last increment, with small sliding and where functions of one degree more exist and are not too many.",
    ),
    word("equilibrium_residual", "result", "Sum of all forces, relative to the largest: round-off where all is well."),
    word(
        "line_force",
        "result",
        "Part of the contact force along the fronts; it vanishes with the slope jump, and is what adhesion holds.",
    ),
    word("max_penetration", "result", "How deep the membrane lies in the floor at worst, next to the fronts."),
    word("min_gap_outside", "result", "Least gap further than half a cell from the fronts."),
    word(
        "lowest_eigenvalue",
        "result",
        "Of the second variation of the energy: the state is stable where it is positive.",
    ),
    word("other_states", "result", "Other equilibria at the same load: area, energy, and whether they are stable."),
    word("residual_history", "result", "Residual of each solve, relative to its tolerance."),
    word("t", "result", "Time, as in the tables of the terminal: the end of the increment."),
    word("time", "result", "The end of the increment, in the time of the case."),
    word("index", "result", "Number of the increment, from 0."),
    word("solves", "result", "Equilibrium solves of an increment: `iterations` and `iterations_before` together."),
    word(
        "iterations",
        "result",
        "Equilibrium solves on the cells of the state; for solids the steps of the active set or of Newton's method.",
    ),
    word("iterations_before", "result", "Equilibrium solves on larger cells, and on the way to the state."),
    word(
        "balance",
        "result",
        "`equilibrium_residual` in the tables of the terminal: the sum of all forces, relative to the largest.",
    ),
    word("contacts", "result", "Results by the name of the contact."),
    word("max_pressure", "result", "Largest contact pressure."),
    word("min_pressure", "result", "Least contact pressure within the zones; negative only by round-off."),
    word("energy", "result", "Elastic energy less the work of the load."),
    word("energy_total", "result", "`energy` less what adhesion gives back."),
    word("adhesion_energy", "result", "What adhesion gives back: the integral of its energy over the zones."),
    word("volume", "result", "Integral of the deflection of a membrane."),
    word("max_slope", "result", "Steepest slope of the membrane: the theory is linear, for slopes well below 1."),
    word("support_forces", "result", "Force of each support on the body, by its name."),
    word("load_forces", "result", "Resultant of each load, by its name."),
    word("probes", "result", "Values at the probes of `output.probes`, by their names; null outside the body."),
    word("displacement", "result", "How far a point has moved: along z for a membrane, a vector for a solid."),
    word("in_contact", "result", "Whether the point is within a zone of contact."),
    word("pressure", "result", "Contact pressure at a point."),
    word("at", "result", "Where: coordinates of the place."),
    word("von_mises", "result", "Equivalent stress of von Mises."),
    word("components", "result", "The connected zones of a contact one by one."),
    word("centroid", "result", "Middle of a zone, weighted by area."),
    word("boundary_length", "result", "Length of the fronts together."),
    word("radius", "result", "Radius of a zone that is a disc; half the length of one that is an interval."),
    word("stable", "result", "Whether the second variation of the energy is positive."),
    word("stick_area", "result", "Area that sticks by friction; null, as friction is not available."),
    word("slip_area", "result", "Area that slips; null, as friction is not available."),
    word("max_friction_utilisation", "result", "Share of the friction limit; null, as friction is not available."),
    word(
        "front",
        "result",
        "In `error_estimate`: root mean square of the distance by which fronts are off. In files of outlines: number of the front.",
    ),
    word("case", "result", "The title of the case, or the name of its file."),
    word("schema", "result", "Version of the keys of the summary."),
    word("reason", "result", "Why the run or the increment ended as it did: a word of its own, which `explain` knows."),
    word("verdict", "result", "The result in a sentence."),
    word("method", "result", "How the contact was found; as in `contacts.NAME.method`."),
    word("unknowns", "result", "Number of unknowns that were solved for, at most."),
    word("warnings", "result", "What looked wrong before or during the run."),
    word("interpreted", "result", "What the values with units were taken for: line, text, value, unit and factor."),
    word("line", "result", "Line of the case file; null for what `--set` says."),
    word("text", "result", "The value as it is written."),
    word("value", "result", "The value in the base unit; null where it depends on position or time."),
    word("unit", "result", "The base unit of the case."),
    word("factor", "result", "How many base units make one of the stated unit."),
    word("steps", "result", "One entry for each increment."),
    word("solver", "result", "`direct` by factorisation, or `multigrid`."),
    word("events", "result", "Changes of topology, in steps that ask for `events`."),
    word("environment", "result", "Where and when it ran: all that differs between two runs of one case."),
    word("version", "result", "Version of the program."),
    word("threads", "result", "Number of threads; results do not depend on it."),
    word("wall_seconds", "result", "Time that the run took."),
    word("cpu_seconds", "result", "Processor time that the run took, over all threads."),
    word("peak_memory", "result", "Most memory in use, in bytes."),
    word("input_hash", "result", "Fingerprint of the text of the case."),
    word(
        "kind",
        "result",
        "Of an event: nucleation, release, merge, split, hole_opened, hole_closed, snap_in or pull_off. Of a pair of bodies: what its closest points lie on.",
    ),
    word("above", "result", "Whether what the zone touches lies above the membrane."),
    word("within", "result", "Length of the interval of time that holds the event."),
    word("by", "result", "How an event was found: `bisection`, or `extrapolation` from both sides."),
    word("bisection", "result", "Way in which an event was located: the increment was halved."),
    word(
        "extrapolation",
        "result",
        "Way in which a merger was located: from how the distance before it and the neck after it vanish.",
    ),
    word("zones_before", "result", "Zones before the event."),
    word("zones_after", "result", "Zones after the event."),
    word("holes_before", "result", "Holes before the event."),
    word("holes_after", "result", "Holes after the event."),
    word("area_before", "result", "Area of contact before the event."),
    word("area_after", "result", "Area of contact after the event."),
    word("force_before", "result", "Contact force before the event."),
    word("force_after", "result", "Contact force after the event."),
    word(
        "energy_released",
        "result",
        "Energy that a jump of an adhesive contact sets free; told once where one jump is several events.",
    ),
    word("gap", "result", "Distance between the surfaces; negative where they penetrate."),
    word("contact_pressure", "result", "Pressure of the contact, zero outside the zones."),
    word("contact_status", "result", "1 within a zone of contact, 0 outside."),
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
    word(
        "increment",
        "reason",
        "The first increment brings bodies far too deep into each other. Try more increments, or a smaller motion.",
    ),
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

/// Explains a key of the case file or a word of the results.
///
/// # Errors
/// A word that nothing is known of, with the nearest one that is.
pub fn explain(asked: &str) -> Result<String, CaseError> {
    let mut text = String::new();
    let plain = asked.trim().to_lowercase().replace([' ', '-'], "_");
    for w in WORDS.iter().filter(|w| w.word.replace(' ', "_") == plain) {
        text += &format!("{} ({})\n  {}\n", w.word, w.kind, w.about);
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
    let mut known: Vec<String> =
        keys.iter().map(|k| last(&k.path)).chain(WORDS.iter().map(|w| w.word.into())).collect();
    known.sort();
    known.dedup();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let word = asked.trim().rsplit('.').next().unwrap_or_default();
    Err(CaseError::new(format!("nothing is known of `{asked}`")).help(suggestion(word, &known)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_words_are_explained() {
        assert!(explain("iteration_limit").expect("known").contains("more cells"));
        assert!(explain("bodies.film.membrane.tension").expect("known").contains("Force per length"));
        assert!(explain("domain").expect("known").contains("with disc, "));
        assert!(explain("exit status").expect("known").contains("130"));
        let wrong = explain("tensoin").expect_err("unknown");
        assert!(wrong.help.expect("help").contains("tension"));
        assert!(explain("").is_err());
    }

    #[test]
    fn every_function_is_explained() {
        let all = explain("expressions").expect("known");
        for name in crate::expression::function_names() {
            assert!(explain(name).expect(name).contains(&format!("{name} (function)")), "{name}");
            assert!(all.split([' ', ';', '(']).any(|w| w == name), "{name}");
        }
    }
}
