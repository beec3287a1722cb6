//! Table `[[load_case]]`: other values under which the project and its alternatives are judged
//! again, such as another load.

use phea_table::Visitor;
use phea_table::plain;

/// Named settings of the project and of every alternative.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadCase {
    /// Name, unique within a project.
    pub name: String,
    /// Settings in file order: the path, as for `--set`, and the value in TOML.
    pub set: Vec<(String, String)>,
}

impl LoadCase {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut name = (!self.name.is_empty()).then(|| std::mem::take(&mut self.name));
        v.text(plain("name", "What it is called, such as `on a spring`."), &mut name, true);
        self.name = name.unwrap_or_default();
        let k = plain(
            "set",
            "What it sets before an alternative sets its own values: quoted paths as `--set` takes them, such as \"load\" = { model = \"wall\", ... }; an inline table replaces a whole table.",
        );
        v.overrides(k, &mut self.set);
    }

    /// Settings, as for `--set`.
    pub fn settings(&self) -> impl Iterator<Item = String> {
        self.set.iter().map(|(path, value)| format!("{path}={value}"))
    }
}
