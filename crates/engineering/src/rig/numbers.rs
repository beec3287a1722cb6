use phea_dynamics::scalar::Scalar;

/// The numbers of a project by their paths: as declared, except those that are uncertain. Every
/// plant of a family needs all of them, so paths are compared part by part and never assembled.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<'a, S = f64> {
    names: &'a [String],
    values: &'a [S],
    /// `a` or `b` inside a line, whose keys are then without their table.
    side: Option<&'static str>,
    /// The nested tables of a key; empty names are ignored.
    tables: [&'static str; 3],
}

impl Numbers<'_, f64> {
    /// All as declared.
    pub fn declared() -> Numbers<'static, f64> {
        Numbers::open(&[], &[])
    }
}

impl<'a, S: Scalar> Numbers<'a, S> {
    /// These numbers uncertain, in their order.
    pub fn open(names: &'a [String], values: &'a [S]) -> Numbers<'a, S> {
        Numbers { names, values, side: None, tables: [""; 3] }
    }

    /// Inside the line to chamber `a` or `b`: a number for one line takes precedence over the same
    /// for both.
    pub(super) fn of_line(&self, side: &'static str) -> Numbers<'a, S> {
        Numbers { side: Some(side), ..*self }
    }

    /// Inside a table, and up to two tables in it.
    pub(super) fn within(&self, table: &'static str) -> Numbers<'a, S> {
        let tables = match self.tables {
            ["", ..] => [table, "", ""],
            [first, "", _] => [first, table, ""],
            [first, second, _] => [first, second, table],
        };
        Numbers { tables, ..*self }
    }

    /// The value of an uncertain number.
    pub fn get(&self, path: &str) -> Option<S> {
        let found = |is_named: &dyn Fn(&str) -> Option<bool>| {
            let mut numbers = self.names.iter().zip(self.values);
            numbers.find(|(name, _)| is_named(name) == Some(true)).map(|(_, value)| *value)
        };
        let rest = |name: &str| self.within_tables(name).map(|key| key == path);
        let Some(side) = self.side else { return found(&rest) };
        let of_side = |name: &str| rest(inside(inside(name, "line")?, side)?);
        found(&of_side).or_else(|| found(&|name| rest(inside(name, "line")?)))
    }

    /// The rest of a path inside the tables.
    fn within_tables<'n>(&self, name: &'n str) -> Option<&'n str> {
        let mut tables = self.tables.iter().filter(|table| !table.is_empty());
        tables.try_fold(name, |name, table| inside(name, table))
    }

    pub(super) fn is_open(&self, path: &str) -> bool {
        self.get(path).is_some()
    }

    /// The number at a path, its declared value known.
    pub fn at(&self, path: &str, declared: f64) -> S {
        self.get(path).unwrap_or_else(|| S::from(declared))
    }
}

/// The rest of a path inside a table.
fn inside<'n>(name: &'n str, table: &str) -> Option<&'n str> {
    name.strip_prefix(table)?.strip_prefix('.')
}
