//! Names of a case: letters, digits, underscores and hyphens, each of them once.

use std::collections::BTreeSet;

/// Names that are given already.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    /// A name like the wanted one that is not given yet.
    pub(crate) fn take(&mut self, wanted: &str) -> String {
        let plain: String = wanted
            .trim()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() || c == '_' || c == '-' { c } else { '_' })
            .collect();
        let plain = if plain.is_empty() { "unnamed".to_string() } else { plain };
        let name = (1..)
            .map(|k| if k == 1 { plain.clone() } else { format!("{plain}_{k}") })
            .find(|name| !self.0.contains(name))
            .unwrap_or_default();
        self.0.insert(name.clone());
        name
    }
}
