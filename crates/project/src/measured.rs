//! `[[scenario.measured]]`: measurements on the rig, to be compared with the simulation.

use super::key::{key, plain};
use super::visitor::Visitor;
use phea_quantity::{
    ANGLE, ANGULAR_VELOCITY, Dimension, FLOW, FORCE, LENGTH, POWER, PRESSURE, RATIO, TEMPERATURE, TIME,
    TORQUE, VELOCITY, VOLTAGE,
};

/// A file with measured signals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredFile {
    /// A CSV file, relative to the project.
    pub file: String,
    /// Name of its column of times; absent: `time_s` or `time_ms`.
    pub time_column: Option<String>,
    /// Unit of that column; absent: s.
    pub time_unit: Option<String>,
    /// s, added to the file's times.
    pub offset: f64,
    /// Which column is which signal.
    pub signals: Vec<MeasuredSignal>,
}

/// A column of a measurement, and the corresponding signal of the simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredSignal {
    /// By the name of the column of the simulation's table.
    pub signal: &'static str,
    /// Name of the file's column; absent: that of the signal.
    pub column: Option<String>,
    /// Unit of the file's column; absent: the SI unit in the name of the signal.
    pub unit: Option<String>,
}

/// A signal that can be measured.
const fn signal(name: &'static str) -> (&'static str, &'static str) {
    (name, name)
}

/// The signals that can be measured, each as a project names it and as the column of a simulation's
/// table is called: every column but time.
pub static MEASURABLE: [(&str, &str); 45] = [
    signal("force_n"),
    signal("reference_n"),
    signal("control_v"),
    signal("spool_v"),
    signal("pressure_a_pa"),
    signal("pressure_b_pa"),
    signal("position_m"),
    signal("velocity_m_per_s"),
    signal("supply_pressure_pa"),
    signal("deflection_m"),
    signal("friction_n"),
    signal("end_stops_n"),
    signal("flow_a_m3_per_s"),
    signal("flow_b_m3_per_s"),
    signal("supply_flow_m3_per_s"),
    signal("load_position_m"),
    signal("load_velocity_m_per_s"),
    signal("port_pressure_a_pa"),
    signal("port_pressure_b_pa"),
    signal("hydraulic_force_n"),
    signal("filtered_reference_n"),
    signal("opening_v"),
    signal("command_v"),
    signal("unlimited_control_v"),
    signal("integral_v"),
    signal("measurement_n"),
    signal("virtual_force_n"),
    signal("external_force_n"),
    signal("series_deflection_m"),
    signal("load_force_n"),
    signal("joint_angle_rad"),
    signal("joint_velocity_rad_per_s"),
    signal("joint_torque_n_m"),
    signal("external_torque_n_m"),
    signal("gas_pressure_a_pa"),
    signal("gas_pressure_b_pa"),
    signal("gas_temperature_a_ratio"),
    signal("gas_temperature_b_ratio"),
    signal("gas_temperature_a_degC"),
    signal("gas_temperature_b_degC"),
    signal("setting_a_ratio"),
    signal("setting_b_ratio"),
    signal("adjustment_power_w"),
    signal("transmission_pressure_rod_pa"),
    signal("transmission_pressure_load_pa"),
];

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
        self.column.as_deref().unwrap_or(self.signal)
    }

    /// Unit of the file's column.
    pub fn unit(&self) -> &str {
        self.unit.as_deref().unwrap_or(self.dimension().si)
    }

    /// The dimension of the signal, by the unit in its name.
    pub fn dimension(&self) -> &'static Dimension {
        let by_ending: [(&str, &'static Dimension); 12] = [
            ("_degC", &TEMPERATURE),
            ("_ratio", &RATIO),
            ("_w", &POWER),
            ("_n_m", &TORQUE),
            ("_rad_per_s", &ANGULAR_VELOCITY),
            ("_rad", &ANGLE),
            ("_m3_per_s", &FLOW),
            ("_m_per_s", &VELOCITY),
            ("_pa", &PRESSURE),
            ("_n", &FORCE),
            ("_m", &LENGTH),
            ("_v", &VOLTAGE),
        ];
        let found = by_ending.into_iter().find(|(ending, _)| self.signal.ends_with(ending));
        found.map_or(&FORCE, |(_, dimension)| dimension)
    }
}
