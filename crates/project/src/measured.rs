//! Table `[[scenario.measured]]`: measurements on the rig, for comparison with the simulation.

use phea_hydraulics::signal::Signal;
use phea_quantity::TIME;
use phea_table::Visitor;
use phea_table::{key, plain};

/// File with measured signals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredFile {
    /// CSV file, relative to the project.
    pub file: String,
    /// Name of its time column; if absent, `time_s` or `time_ms`.
    pub time_column: Option<String>,
    /// Unit of that column; if absent, s.
    pub time_unit: Option<String>,
    /// Offset added to the file's times, s.
    pub offset: f64,
    /// Columns and their signals.
    pub signals: Vec<MeasuredSignal>,
}

/// Column of a measurement, and the corresponding signal of the simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredSignal {
    /// Simulated signal.
    pub signal: Signal,
    /// Name of the file's column; if absent, that of the signal.
    pub column: Option<String>,
    /// Unit of the file's column; if absent, the SI unit in the name of the signal.
    pub unit: Option<String>,
}

/// Signals that can be measured: every column of a simulation's table but time.
pub static MEASURABLE: [(&str, Signal); Signal::ALL.len() - 1] = {
    let mut all = [("", Signal::Time); Signal::ALL.len() - 1];
    let mut place = 0;
    while place < all.len() {
        let signal = Signal::ALL[place + 1];
        all[place] = (signal.name(), signal);
        place += 1;
    }
    all
};
const _: () = assert!(matches!(Signal::ALL[0], Signal::Time));

impl MeasuredFile {
    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut file = Some(std::mem::take(&mut self.file));
        v.text(plain("file", "A CSV file, relative to this one."), &mut file, true);
        self.file = file.unwrap_or_default();
        let k = plain("time_column", "Name of the column of times; absent: `time_s` or `time_ms`.");
        v.text(k, &mut self.time_column, false);
        v.text(plain("time_unit", "Unit of `time_column`; absent: s."), &mut self.time_unit, false);
        v.quantity(key("offset", &TIME, "Added to the file's times.").or(0.0), &mut self.offset);
        v.tables(plain("signals", "Which column is which signal."), &mut self.signals, MeasuredSignal::visit);
    }
}

impl MeasuredSignal {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("signal", "By the name of the column of the simulation's table.");
        v.choice(k, &MEASURABLE, &mut self.signal, true);
        v.text(
            plain("column", "Name of the file's column; absent: that of the signal."),
            &mut self.column,
            false,
        );
        let k = plain("unit", "Unit of the file's column; absent: SI, as the signal's name says.");
        v.text(k, &mut self.unit, false);
    }

    /// Name of the file's column.
    pub fn column(&self) -> &str {
        self.column.as_deref().unwrap_or(self.signal.name())
    }

    /// Unit of the file's column.
    pub fn unit(&self) -> &str {
        self.unit.as_deref().unwrap_or(self.signal.dimension().si)
    }
}
