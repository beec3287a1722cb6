use super::{Derived, Stated};

/// A growing list of derived quantities; each chapter names its group once.
pub(super) struct List {
    entries: Vec<Derived>,
    group: &'static str,
}

impl List {
    pub(super) fn new() -> List {
        List { entries: Vec::new(), group: "" }
    }

    pub(super) fn group(&mut self, group: &'static str) {
        self.group = group;
    }

    pub(super) fn add(
        &mut self,
        name: impl Into<String>,
        symbol: &'static str,
        value: f64,
        unit: &'static str,
        equation: &'static str,
    ) {
        self.push(name.into(), symbol, Ok(value), unit, equation);
    }

    fn push(
        &mut self,
        name: String,
        symbol: &'static str,
        value: Result<f64, &'static str>,
        unit: &'static str,
        equation: &'static str,
    ) {
        self.entries.push(Derived { group: self.group, name, symbol, value, unit, equation, stated: None });
    }

    /// Adds to the last quantity the value that the project states for it.
    pub(super) fn stated(&mut self, value: f64, place: &'static str, bounds: Option<[f64; 2]>) {
        if let Some(last) = self.entries.last_mut() {
            last.stated = Some(Stated { value, place, bounds });
        }
    }

    /// A quantity that does not exist here, and why.
    pub(super) fn absent(
        &mut self,
        name: impl Into<String>,
        symbol: &'static str,
        unit: &'static str,
        equation: &'static str,
        reason: &'static str,
    ) {
        self.push(name.into(), symbol, Err(reason), unit, equation);
    }

    pub(super) fn into_entries(self) -> Vec<Derived> {
        self.entries
    }
}
