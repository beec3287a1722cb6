//! Table `[[alternative]]`: the project with other values, for comparison.

use phea_table::Visitor;
use phea_table::plain;

/// Name under which the project itself is judged among its alternatives.
pub const AS_DECLARED: &str = "as declared";

/// Named settings of the project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Alternative {
    /// Name, unique within a project.
    pub name: String,
    /// Settings in file order: the path, as for `--set`, and the value in TOML.
    pub set: Vec<(String, String)>,
    /// True if `[sizing]` sizes its hose before the design.
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

    /// Settings, as for `--set`.
    pub fn settings(&self) -> impl Iterator<Item = String> {
        self.set.iter().map(|(path, value)| format!("{path}={value}"))
    }
}
