//! The columns of a scenario's table; the guide states their signs and units.

use phea_hydraulics::machine::{LINKAGE_SIGNALS, SERIES_SIGNALS, SIGNALS};

use super::record::{Look, Record};

/// Names of the signals of the control loop other than reference and command, in the order of
/// [`Record::of_loop`].
///
/// `command_v` is the command as it reaches the valve, after the delay of the loop;
/// `unlimited_control_v` what the controller would give out without its limit; `integral_v` the
/// part of the command that the controller's integral part holds; `measurement_n` the force as the
/// controller measures it, after the sensor, with what a virtual impedance adds; `virtual_force_n`
/// that part before the sensor, by which the reference gives way.
pub const LOOP_SIGNALS: [&str; 5] =
    ["command_v", "unlimited_control_v", "integral_v", "measurement_n", VIRTUAL_FORCE];

/// What a virtual impedance makes of the position of the load.
const VIRTUAL_FORCE: &str = "virtual_force_n";

/// The source of the numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColumnSource {
    Time,
    Reference,
    Control,
    FilteredReference,
    /// Place in [`SIGNALS`].
    Machine(usize),
    /// Place in [`LOOP_SIGNALS`].
    Loop(usize),
    ExternalForce,
}

/// Columns whose positions never change: other programs read some of them by position.
const FIRST: [&str; 22] = [
    "time_s",
    "reference_n",
    "force_n",
    "control_v",
    "spool_v",
    "pressure_a_pa",
    "pressure_b_pa",
    "position_m",
    "velocity_m_per_s",
    "supply_pressure_pa",
    "deflection_m",
    "friction_n",
    "end_stops_n",
    "flow_a_m3_per_s",
    "flow_b_m3_per_s",
    "supply_flow_m3_per_s",
    "load_position_m",
    "load_velocity_m_per_s",
    "port_pressure_a_pa",
    "port_pressure_b_pa",
    "hydraulic_force_n",
    "filtered_reference_n",
];

/// The force on the load from outside, and the torque on one that turns behind a linkage.
const EXTERNAL_FORCE: &str = "external_force_n";
const EXTERNAL_TORQUE: &str = "external_torque_n_m";

/// The columns of a table and the sources of their numbers.
pub(super) struct Columns(Vec<(&'static str, ColumnSource)>);

impl Columns {
    /// The fixed ones, then those added later, and last the external force if the load is `pushed`;
    /// those of a series element only if the load is `sprung`, those of a linkage only if it `turns`,
    /// and that of a virtual impedance only if the reference `gives_way`.
    pub(super) fn new(pushed: bool, [sprung, turns]: [bool; 2], gives_way: bool) -> Columns {
        let there = |name: &&&str| {
            (sprung || !SERIES_SIGNALS.contains(name))
                && (turns || !LINKAGE_SIGNALS.contains(name))
                && (gives_way || **name != VIRTUAL_FORCE)
        };
        let later = SIGNALS.iter().chain(&LOOP_SIGNALS).filter(there).filter(|name| !FIRST.contains(name));
        let pushed = pushed.then_some(if turns { &EXTERNAL_TORQUE } else { &EXTERNAL_FORCE });
        let all = FIRST.iter().chain(later).chain(pushed);
        Columns(all.filter_map(|name| Some((*name, source(name)?))).collect())
    }

    pub(super) fn names(&self) -> Vec<&'static str> {
        self.0.iter().map(|(name, _)| *name).collect()
    }

    /// Replaces the numbers of the previous row; signals that an open loop lacks are NaN.
    pub(super) fn read(&self, look: &Look, values: &mut Vec<f64>) {
        values.clear();
        values.extend(self.0.iter().map(|(_, source)| source.of(look)));
    }
}

impl ColumnSource {
    /// Of a column; `None` for an unknown name.
    pub(super) fn named(name: &str) -> Option<ColumnSource> {
        source(name)
    }

    pub(super) fn of(self, look: &Look) -> f64 {
        match self {
            ColumnSource::Time => look.time_s,
            ColumnSource::Reference => look.reference_n.unwrap_or(f64::NAN),
            ColumnSource::Control => look.control_v,
            ColumnSource::FilteredReference => look.filtered_reference_n.unwrap_or(f64::NAN),
            ColumnSource::ExternalForce => look.external_force_n.unwrap_or(f64::NAN),
            ColumnSource::Machine(place) => look.signals[place],
            ColumnSource::Loop(place) => look.of_loop[place],
        }
    }
}

/// A column over time; empty for an unknown name.
pub(super) fn signal(record: &Record, name: &str) -> Vec<f64> {
    match source(name) {
        Some(ColumnSource::Time) => record.times_s.clone(),
        Some(ColumnSource::Reference) => record.reference_n.clone(),
        Some(ColumnSource::Control) => record.control_v.clone(),
        Some(ColumnSource::FilteredReference) => record.filtered_reference_n.clone(),
        Some(ColumnSource::ExternalForce) => record.external_force_n.clone(),
        Some(ColumnSource::Machine(place)) => record.signals.iter().map(|signals| signals[place]).collect(),
        Some(ColumnSource::Loop(place)) => record.of_loop.iter().map(|signals| signals[place]).collect(),
        None => Vec::new(),
    }
}

fn source(name: &str) -> Option<ColumnSource> {
    let place = |names: &[&str]| names.iter().position(|known| *known == name);
    match name {
        "time_s" => Some(ColumnSource::Time),
        "reference_n" => Some(ColumnSource::Reference),
        "control_v" => Some(ColumnSource::Control),
        "filtered_reference_n" => Some(ColumnSource::FilteredReference),
        EXTERNAL_FORCE | EXTERNAL_TORQUE => Some(ColumnSource::ExternalForce),
        _ => place(&SIGNALS)
            .map(ColumnSource::Machine)
            .or_else(|| place(&LOOP_SIGNALS).map(ColumnSource::Loop)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns that can be measured: all except time.
    #[test]
    fn every_column_can_be_measured() {
        let mut columns = Columns::new(true, [true, false], true).names();
        columns.remove(0);
        columns.extend(LINKAGE_SIGNALS);
        columns.push(EXTERNAL_TORQUE);
        let mut measurable: Vec<&str> = phea_project::MEASURABLE.iter().map(|(name, _)| *name).collect();
        columns.sort_unstable();
        measurable.sort_unstable();
        assert_eq!(columns, measurable);
    }

    #[test]
    fn every_signal_has_one_column() {
        let names = Columns::new(true, [true; 2], true).names();
        let later = SERIES_SIGNALS.len() + LINKAGE_SIGNALS.len() + LOOP_SIGNALS.len();
        assert_eq!(names.len(), FIRST.len() + 1 + later + 1);
        assert_eq!(names[..FIRST.len()], FIRST);
        for name in SIGNALS.iter().chain(&LOOP_SIGNALS) {
            assert_eq!(names.iter().filter(|known| known == &name).count(), 1, "{name}");
        }
    }
}
