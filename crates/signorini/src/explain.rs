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
pub const WORDS: [Word; 34] = [
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
    word(
        "exit status",
        "command",
        "0 done; 1 the input is wrong; 2 not converged, results so far are on disk; 3 a fault of ours; 130 interrupted.",
    ),
    word(
        "expressions",
        "command",
        "Numbers, + - * / ^ and parentheses; sin cos tan asin acos atan atan2 exp log sqrt abs min max hypot if(condition, a, b) sign; pi; x, y, z, t; names of `constants` and `functions`.",
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
}
