use phea_dynamics::scalar::Scalar;

/// The numbers of a project at their paths: as they are declared, but for those that are open.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers<'a, S = f64> {
    names: &'a [String],
    values: &'a [S],
    /// `a` or `b` inside of a line, whose keys are then without their table.
    side: Option<&'static str>,
}

impl Numbers<'_, f64> {
    /// All as declared.
    pub(crate) fn declared() -> Numbers<'static, f64> {
        Numbers { names: &[], values: &[], side: None }
    }
}

impl<'a, S: Scalar> Numbers<'a, S> {
    /// These numbers open, in their order.
    pub(crate) fn open(names: &'a [String], values: &'a [S]) -> Numbers<'a, S> {
        Numbers { names, values, side: None }
    }

    /// Inside of the line to chamber `a` or `b`: a number of one line goes before the same of both.
    pub(super) fn of_line(&self, side: &'static str) -> Numbers<'a, S> {
        Numbers { side: Some(side), ..*self }
    }

    /// The value of an open number.
    pub(crate) fn get(&self, path: &str) -> Option<S> {
        if self.names.is_empty() {
            return None;
        }
        let named = |path: &str| {
            self.names.iter().zip(self.values).find(|(name, _)| *name == path).map(|(_, value)| *value)
        };
        match self.side {
            None => named(path),
            Some(side) => named(&format!("line.{side}.{path}")).or_else(|| named(&format!("line.{path}"))),
        }
    }

    pub(super) fn is_open(&self, path: &str) -> bool {
        self.get(path).is_some()
    }

    /// The number at a path, its declared value known.
    pub(crate) fn at(&self, path: &str, declared: f64) -> S {
        self.get(path).unwrap_or_else(|| S::from(declared))
    }
}
