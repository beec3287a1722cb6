//! The signals of a rig under control: the columns of a simulation's table, and what recordings of
//! a rig are compared with.

use phea_quantity::{
    ANGLE, ANGULAR_VELOCITY, Dimension, FLOW, FORCE, LENGTH, MotionKind, POWER, PRESSURE, QuantityName,
    RATIO, TEMPERATURE, TIME, TORQUE, VELOCITY, VOLTAGE,
};

/// The part of a rig that has a signal; a rig without that part lacks the signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalPart {
    /// Every rig.
    Rig,
    /// A spring or a transmission between rod and load.
    SeriesElement,
    /// A hydrostatic transmission.
    Transmission,
    /// A linkage: its load turns.
    Linkage,
    /// A virtual impedance of the controller.
    VirtualImpedance,
    /// Accumulators that are adjusted.
    Adjustment,
    /// Gas behind a neck or a valve, at chamber A (0) or B (1).
    GasPressure(usize),
    /// Gas that exchanges heat, at chamber A or B.
    HeatedGas(usize),
    /// Such gas with a wall whose temperature is stated.
    GasTemperature(usize),
    /// A force from outside on a load that slides.
    ExternalForce,
    /// A torque from outside on a load that turns behind a linkage.
    ExternalTorque,
}

/// Declares the signals: one row each, in the order of a table's columns.
macro_rules! signals {
    ($($(#[$attribute:meta])* $signal:ident = $stem:literal $unit:literal, $dimension:ident, $part:expr;)*) => {
        /// A signal of a rig with its controller. Forces, positions and velocities are positive
        /// towards the B end, flows are positive from the valve into the line, pressures are gauge.
        /// A rig with a motor has torques in N m in place of forces, and angles in rad in place of
        /// positions.
        ///
        /// # Example
        /// ```
        /// use phea_hydraulics::signal::Signal;
        /// assert_eq!(Signal::PressureA.name(), "pressure_a_pa");
        /// assert_eq!(Signal::PressureA.dimension().si, "Pa");
        /// assert_eq!(Signal::named("load_force_n"), Some(Signal::LoadForce));
        /// ```
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum Signal {
            $($(#[$attribute])* $signal,)*
        }

        impl Signal {
            /// All signals in the order of a table's columns.
            pub const ALL: &[Signal] = &[$(Signal::$signal),*];

            /// Its name in project files, which ends in its SI unit in linear motion.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Signal::$signal => concat!($stem, "_", $unit),)*
                }
            }

            /// Name without the unit.
            const fn stem(self) -> &'static str {
                match self {
                    $(Signal::$signal => $stem,)*
                }
            }

            /// Its dimension.
            pub const fn dimension(self) -> &'static Dimension {
                match self {
                    $(Signal::$signal => &$dimension,)*
                }
            }

            /// The part of the rig that it belongs to.
            pub const fn part(self) -> SignalPart {
                match self {
                    $(Signal::$signal => $part,)*
                }
            }
        }
    };
}

signals! {
    /// Time since the scenario began.
    #[default]
    Time = "time" "s", TIME, SignalPart::Rig;
    /// Reference force; at a step, the value from then on.
    Reference = "reference" "n", FORCE, SignalPart::Rig;
    /// Force of the rod on the load; with a series element the force that its sensor measures.
    Force = "force" "n", FORCE, SignalPart::Rig;
    /// Command that the controller puts out, or the command of an open loop.
    Control = "control" "v", VOLTAGE, SignalPart::Rig;
    /// Position of the spool.
    Spool = "spool" "v", VOLTAGE, SignalPart::Rig;
    /// Pressure of chamber A.
    PressureA = "pressure_a" "pa", PRESSURE, SignalPart::Rig;
    /// Pressure of chamber B.
    PressureB = "pressure_b" "pa", PRESSURE, SignalPart::Rig;
    /// Position of the piston from the A end.
    Position = "position" "m", LENGTH, SignalPart::Rig;
    /// Velocity of the piston.
    Velocity = "velocity" "m_per_s", VELOCITY, SignalPart::Rig;
    /// Supply pressure at the valve.
    SupplyPressure = "supply_pressure" "pa", PRESSURE, SignalPart::Rig;
    /// Deflection of the force sensor.
    Deflection = "deflection" "m", LENGTH, SignalPart::Rig;
    /// Friction of the piston.
    Friction = "friction" "n", FORCE, SignalPart::Rig;
    /// Force of the end stops on the piston.
    EndStops = "end_stops" "n", FORCE, SignalPart::Rig;
    /// Flow from the valve into the line to chamber A.
    FlowA = "flow_a" "m3_per_s", FLOW, SignalPart::Rig;
    /// Flow from the valve into the line to chamber B.
    FlowB = "flow_b" "m3_per_s", FLOW, SignalPart::Rig;
    /// Flow that the valve takes from the supply.
    SupplyFlow = "supply_flow" "m3_per_s", FLOW, SignalPart::Rig;
    /// Position of the load; behind a linkage that of the rod's end.
    LoadPosition = "load_position" "m", LENGTH, SignalPart::Rig;
    /// Velocity of the load; behind a linkage that of the rod's end.
    LoadVelocity = "load_velocity" "m_per_s", VELOCITY, SignalPart::Rig;
    /// Pressure of line A at the valve.
    PortPressureA = "port_pressure_a" "pa", PRESSURE, SignalPart::Rig;
    /// Pressure of line B at the valve.
    PortPressureB = "port_pressure_b" "pa", PRESSURE, SignalPart::Rig;
    /// Force of the chambers on the piston.
    HydraulicForce = "hydraulic_force" "n", FORCE, SignalPart::Rig;
    /// Reference force after the prefilter.
    FilteredReference = "filtered_reference" "n", FORCE, SignalPart::Rig;
    /// Opening of the valve's edges: the spool less null bias and magnetic lag.
    Opening = "opening" "v", VOLTAGE, SignalPart::Rig;
    /// Compression of the series spring, or of the oil of a transmission.
    SeriesDeflection = "series_deflection" "m", LENGTH, SignalPart::SeriesElement;
    /// Force on the load behind a series element.
    LoadForce = "load_force" "n", FORCE, SignalPart::SeriesElement;
    /// Angle of the joint.
    JointAngle = "joint_angle" "rad", ANGLE, SignalPart::Linkage;
    /// Angular velocity of the joint.
    JointVelocity = "joint_velocity" "rad_per_s", ANGULAR_VELOCITY, SignalPart::Linkage;
    /// Torque of the rod on the joint.
    JointTorque = "joint_torque" "n_m", TORQUE, SignalPart::Linkage;
    /// Pressure of the gas behind a neck at chamber A.
    GasPressureA = "gas_pressure_a" "pa", PRESSURE, SignalPart::GasPressure(0);
    /// Pressure of the gas behind a neck at chamber B.
    GasPressureB = "gas_pressure_b" "pa", PRESSURE, SignalPart::GasPressure(1);
    /// Absolute temperature of the gas at chamber A over that of its wall.
    GasTemperatureRatioA = "gas_temperature_a" "ratio", RATIO, SignalPart::HeatedGas(0);
    /// Absolute temperature of the gas at chamber B over that of its wall.
    GasTemperatureRatioB = "gas_temperature_b" "ratio", RATIO, SignalPart::HeatedGas(1);
    /// Setting of the accumulator at chamber A.
    SettingA = "setting_a" "ratio", RATIO, SignalPart::Adjustment;
    /// Setting of the accumulator at chamber B.
    SettingB = "setting_b" "ratio", RATIO, SignalPart::Adjustment;
    /// Power of the adjustment of the accumulators.
    AdjustmentPower = "adjustment_power" "w", POWER, SignalPart::Adjustment;
    /// Pressure of the transmission's oil at the piston on the rod.
    TransmissionPressureRod = "transmission_pressure_rod" "pa", PRESSURE, SignalPart::Transmission;
    /// Pressure of the transmission's oil at the piston on the load.
    TransmissionPressureLoad = "transmission_pressure_load" "pa", PRESSURE, SignalPart::Transmission;
    /// Temperature of the gas at chamber A.
    GasTemperatureA = "gas_temperature_a" "degC", TEMPERATURE, SignalPart::GasTemperature(0);
    /// Temperature of the gas at chamber B.
    GasTemperatureB = "gas_temperature_b" "degC", TEMPERATURE, SignalPart::GasTemperature(1);
    /// Command as it reaches the valve, after the delay of the loop.
    Command = "command" "v", VOLTAGE, SignalPart::Rig;
    /// Command that the controller would put out without its limit.
    UnlimitedControl = "unlimited_control" "v", VOLTAGE, SignalPart::Rig;
    /// Part of the command that the controller's integral part holds.
    Integral = "integral" "v", VOLTAGE, SignalPart::Rig;
    /// Force as the controller measures it, after the sensor, with what a virtual impedance adds.
    Measurement = "measurement" "n", FORCE, SignalPart::Rig;
    /// Force that a virtual impedance adds before the sensor: the reference yields by it.
    VirtualForce = "virtual_force" "n", FORCE, SignalPart::VirtualImpedance;
    /// Force from outside on the load.
    ExternalForce = "external_force" "n", FORCE, SignalPart::ExternalForce;
    /// Torque from outside on a load that turns behind a linkage.
    ExternalTorque = "external_torque" "n_m", TORQUE, SignalPart::ExternalTorque;
}

impl Signal {
    /// Name of its column in a table.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::signal::Signal;
    /// use phea_quantity::MotionKind;
    /// assert_eq!(Signal::Force.quantity().text(MotionKind::Rotary), "torque_n_m");
    /// assert_eq!(Signal::Spool.quantity().text(MotionKind::Rotary), "spool_v");
    /// assert_eq!(Signal::LoadForce.words(MotionKind::Rotary), "load torque");
    /// ```
    pub const fn quantity(self) -> QuantityName {
        let rotary = match self {
            Signal::Reference => "reference",
            Signal::Force => "torque",
            Signal::Position => "angle",
            Signal::Velocity => "velocity",
            Signal::Deflection => "deflection",
            Signal::Friction => "friction",
            Signal::EndStops => "end_stops",
            Signal::LoadPosition => "load_angle",
            Signal::LoadVelocity => "load_velocity",
            Signal::HydraulicForce => "hydraulic_torque",
            Signal::FilteredReference => "filtered_reference",
            Signal::SeriesDeflection => "series_deflection",
            Signal::LoadForce => "load_torque",
            Signal::Measurement => "measurement",
            Signal::VirtualForce => "virtual_torque",
            Signal::ExternalForce => "external_torque",
            other => return QuantityName::Fixed(other.name()),
        };
        QuantityName::OfMotion([self.stem(), rotary], self.dimension())
    }

    /// Its name in words, without the unit, for a rig of this motion: `load force`.
    pub fn words(self, motion: MotionKind) -> String {
        let stem = match self.quantity() {
            QuantityName::OfMotion([_, rotary], _) if motion.is_rotary() => rotary,
            _ => self.stem(),
        };
        stem.replace('_', " ")
    }

    /// The signal with this name.
    pub fn named(name: &str) -> Option<Signal> {
        Signal::ALL.iter().copied().find(|signal| signal.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::{FORCE, LENGTH, MotionKind, QuantityName, Signal, VELOCITY};

    #[test]
    fn quantities_of_the_motion_are_those_in_its_dimensions() {
        for signal in Signal::ALL {
            let moves = [&FORCE, &LENGTH, &VELOCITY].contains(&signal.dimension());
            assert_eq!(matches!(signal.quantity(), QuantityName::OfMotion(..)), moves, "{signal:?}");
            assert_eq!(signal.quantity().text(MotionKind::Linear), signal.name());
            assert_eq!(signal.name(), format!("{}_{}", signal.stem(), signal.dimension().suffix()));
        }
    }
}
