//! Checks of a part: conditions between its keys, in addition to the range of each.

use phea_quantity::MotionKind;

/// Keys of a file that are checked: which of them are written, and where errors and warnings about
/// them are reported. Paths are dotted: `cylinder.stroke`.
pub trait TableCheck {
    /// Motion of the rig.
    fn motion(&self) -> MotionKind;
    /// True if a path was written in the project or set.
    fn declared(&self, path: &str) -> bool;
    /// True if the value of a path was already rejected, so that nothing follows from it.
    fn refused(&self, path: &str) -> bool;
    /// Reports a contradiction at the value of a path.
    fn report(&mut self, path: &str, found: TableFinding);
    /// Reports a value missing from a table, perhaps because it was rejected.
    fn report_missing(&mut self, table: &str, name: &str, message: String);
    /// Checks that two numbers of one table are in order, each with its path.
    fn in_order(&mut self, paths: [&str; 2], numbers: [f64; 2]);
    /// Checks that minimum, nominal and maximum of a table are in order.
    fn bounds(&mut self, path: &str, numbers: [f64; 3]);
}

/// Contradiction between keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFinding {
    /// True if nothing is computed with it.
    pub is_error: bool,
    /// Contradiction.
    pub message: String,
    /// Remedy, if one is known.
    pub help: Option<String>,
}

impl dyn TableCheck + '_ {
    /// Reports an error at the value of a path.
    pub fn error(&mut self, path: &str, message: impl Into<String>) {
        self.report(path, TableFinding { is_error: true, message: message.into(), help: None });
    }

    /// Reports an error with its remedy.
    pub fn error_with_help(&mut self, path: &str, message: impl Into<String>, help: impl Into<String>) {
        let help = Some(help.into());
        self.report(path, TableFinding { is_error: true, message: message.into(), help });
    }

    /// Reports a warning at the value of a path.
    pub fn warning(&mut self, path: &str, message: impl Into<String>) {
        self.report(path, TableFinding { is_error: false, message: message.into(), help: None });
    }

    /// Reports a warning with its remedy.
    pub fn warning_with_help(&mut self, path: &str, message: impl Into<String>, help: impl Into<String>) {
        let help = Some(help.into());
        self.report(path, TableFinding { is_error: false, message: message.into(), help });
    }

    /// Reports a value missing from a table.
    pub fn missing(&mut self, table: &str, name: &str, message: impl Into<String>) {
        self.report_missing(table, name, message.into());
    }

    /// First of these paths that is written; otherwise the last.
    pub fn written_path(&self, own: String, other: &str) -> String {
        if self.declared(&own) { own } else { other.to_string() }
    }
}
