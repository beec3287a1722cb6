//! The columns of a scenario's table; the guide states their signs and units.

use phea_hydraulics::machine::{HEAT_SIGNALS, SIGNALS};

use super::parts::SignalParts;
use super::record::{Look, Record};
use phea_quantity::ZERO_CELSIUS;

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
pub(super) const VIRTUAL_FORCE: &str = "virtual_force_n";

/// Temperatures of the gas at chambers A and B, where it exchanges heat and the project states the
/// temperature of its wall.
pub const GAS_TEMPERATURES: [&str; 2] = ["gas_temperature_a_degC", "gas_temperature_b_degC"];

/// The source of the numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// degC: place of its [`HEAT_SIGNALS`] in [`SIGNALS`], and the temperature of its wall.
    GasTemperature(usize, f64),
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
pub(super) const EXTERNAL_FORCE: &str = "external_force_n";
pub(super) const EXTERNAL_TORQUE: &str = "external_torque_n_m";

/// The columns of a table and the sources of their numbers.
pub(super) struct Columns(Vec<(&'static str, ColumnSource)>);

impl Columns {
    /// The fixed ones, then those added later, and last the force from outside, each only where the
    /// rig has the part that it is of.
    pub(super) fn new(parts: &SignalParts) -> Columns {
        let machine = SIGNALS.iter().filter(|name| !FIRST.contains(name));
        let later = machine.chain(&GAS_TEMPERATURES).chain(&LOOP_SIGNALS);
        let all = FIRST.iter().chain(later).chain(&[EXTERNAL_FORCE, EXTERNAL_TORQUE]);
        Columns(all.filter_map(|name| Some((*name, source(name, parts)?))).collect())
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
    /// Of a column of a rig with these parts; `None` for a name that is unknown, or of another
    /// part.
    pub(super) fn named(name: &str, parts: &SignalParts) -> Option<ColumnSource> {
        source(name, parts)
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
            ColumnSource::GasTemperature(place, wall) => gas_temperature(look.signals[place], wall),
        }
    }
}

/// degC, of gas at this ratio of its absolute temperature to that of its wall, which is stated in
/// degC: T = theta T_w.
fn gas_temperature(ratio: f64, wall: f64) -> f64 {
    // exact where the gas has the temperature of its wall
    wall + (ratio - 1.0) * (wall + ZERO_CELSIUS)
}

/// A column over time; empty for an unknown name, and for one of a part that the rig lacks.
pub(super) fn signal(record: &Record, name: &str) -> Vec<f64> {
    match source(name, &record.parts) {
        Some(ColumnSource::Time) => record.times_s.clone(),
        Some(ColumnSource::Reference) => record.reference_n.clone(),
        Some(ColumnSource::Control) => record.control_v.clone(),
        Some(ColumnSource::FilteredReference) => record.filtered_reference_n.clone(),
        Some(ColumnSource::ExternalForce) => record.external_force_n.clone(),
        Some(ColumnSource::Machine(place)) => record.signals.iter().map(|signals| signals[place]).collect(),
        Some(ColumnSource::Loop(place)) => record.of_loop.iter().map(|signals| signals[place]).collect(),
        Some(ColumnSource::GasTemperature(place, wall)) => {
            record.signals.iter().map(|signals| gas_temperature(signals[place], wall)).collect()
        }
        None => Vec::new(),
    }
}

fn source(name: &str, parts: &SignalParts) -> Option<ColumnSource> {
    if !parts.have(name) {
        return None;
    }
    let of_gas = || {
        let side = GAS_TEMPERATURES.iter().position(|of| *of == name)?;
        let place = SIGNALS.iter().position(|of| *of == HEAT_SIGNALS[side])?;
        Some(ColumnSource::GasTemperature(place, parts.gas_wall_celsius[side]?))
    };
    let place = |names: &[&str]| names.iter().position(|known| *known == name);
    match name {
        "time_s" => Some(ColumnSource::Time),
        "reference_n" => Some(ColumnSource::Reference),
        "control_v" => Some(ColumnSource::Control),
        "filtered_reference_n" => Some(ColumnSource::FilteredReference),
        EXTERNAL_FORCE | EXTERNAL_TORQUE => Some(ColumnSource::ExternalForce),
        _ => place(&SIGNALS)
            .map(ColumnSource::Machine)
            .or_else(|| place(&LOOP_SIGNALS).map(ColumnSource::Loop))
            .or_else(of_gas),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rig with every part.
    fn everything() -> SignalParts {
        SignalParts {
            external_force: true,
            series: true,
            transmission: true,
            linkage: true,
            impedance: true,
            adjustment: true,
            gas_pressure: [true; 2],
            heated_gas: [true; 2],
            gas_wall_celsius: [Some(40.0); 2],
        }
    }

    /// The columns that can be measured: all except time.
    #[test]
    fn every_column_can_be_measured() {
        let mut columns = Columns::new(&everything()).names();
        columns.remove(0);
        columns.push(EXTERNAL_FORCE);
        let mut measurable: Vec<&str> = phea_project::MEASURABLE.iter().map(|(name, _)| *name).collect();
        columns.sort_unstable();
        measurable.sort_unstable();
        assert_eq!(columns, measurable);
    }

    #[test]
    fn every_signal_has_one_column() {
        let names = Columns::new(&everything()).names();
        assert_eq!(names[..FIRST.len()], FIRST);
        for name in SIGNALS.iter().chain(&LOOP_SIGNALS).chain(&GAS_TEMPERATURES) {
            assert_eq!(names.iter().filter(|known| known == &name).count(), 1, "{name}");
        }
        assert_eq!(names.last(), Some(&EXTERNAL_TORQUE));
    }

    /// A rig without such parts has the columns of every rig, and one with a part at B those of B.
    #[test]
    fn a_part_that_is_missing_has_no_column() {
        let plain = Columns::new(&SignalParts::default()).names();
        let gas_at_b = SignalParts {
            gas_pressure: [false, true],
            heated_gas: [false, true],
            gas_wall_celsius: [None, Some(40.0)],
            ..SignalParts::default()
        };
        let more = Columns::new(&gas_at_b).names();
        let added: Vec<&str> = more.into_iter().filter(|name| !plain.contains(name)).collect();
        assert_eq!(added, ["gas_pressure_b_pa", "gas_temperature_b_ratio", "gas_temperature_b_degC"]);
    }

    /// Ten percent above an absolute 300 K is 330 K; gas as warm as its wall has its temperature.
    #[test]
    fn the_temperature_of_gas_is_absolute() {
        assert!((gas_temperature(1.1, 300.0 - ZERO_CELSIUS) - (330.0 - ZERO_CELSIUS)).abs() < 1e-12);
        assert_eq!(gas_temperature(1.0, 37.3), 37.3);
    }
}
