//! `[[alternative]]`: the same project with other values, to be compared with it.

use super::key::plain;
use super::visitor::Visitor;

/// The name under which the project itself is judged among its alternatives.
pub const AS_DECLARED: &str = "as declared";

/// Settings of the project under a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Alternative {
    /// Its name; those of one project differ.
    pub name: String,
    /// What it sets, in file order: the path, as `--set` takes it, and the value in TOML.
    pub set: Vec<(String, String)>,
    /// True if its hose is sized by `[sizing]` before anything is designed.
    pub size: bool,
    /// True if the ranges of `[uncertainty]` move with the parameters of the linear model that it
    /// changes.
    pub recentre: bool,
}

impl Alternative {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut name = (!self.name.is_empty()).then(|| std::mem::take(&mut self.name));
        v.text(plain("name", "What it is called; its files are named after it."), &mut name, true);
        self.name = name.unwrap_or_default();
        let k = plain(
            "set",
            "What it sets: quoted paths as `--set` takes them, such as \"line.length\" = \"3 m\"; an inline table replaces a whole table.",
        );
        v.overrides(k, &mut self.set);
        let k = plain(
            "size",
            "Whether its hose and length, or its gas, spring, pipe or valve, are those that [sizing] finds.",
        );
        v.flag(k, &mut self.size);
        let k = plain(
            "recentre",
            "Whether the ranges of [uncertainty] move with the parameters of the linear model that it changes.",
        );
        v.flag(k, &mut self.recentre);
    }

    /// What it sets, as `--set` takes it.
    pub fn settings(&self) -> impl Iterator<Item = String> {
        self.set.iter().map(|(path, value)| format!("{path}={value}"))
    }
}
