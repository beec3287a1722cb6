//! Signals of a rig under control: the columns of a simulation's table, and the quantities compared
//! with recordings of a rig.

use phea_quantity::{
    ANGLE, ANGULAR_VELOCITY, Dimension, FLOW, FORCE, LENGTH, POWER, PRESSURE, RATIO, TEMPERATURE, TIME,
    TORQUE, VELOCITY, VOLTAGE,
};

/// Part of a rig that has a signal; a rig without that part lacks the signal.
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
    /// Heat-exchanging gas with a wall whose temperature is stated.
    GasTemperature(usize),
    /// External force on a load that slides.
    ExternalForce,
    /// External torque on a load that turns behind a linkage.
    ExternalTorque,
}

/// Declares the signals: one row each, in the order of a table's columns.
macro_rules! signals {
    ($($(#[$attribute:meta])* $signal:ident = $name:literal, $dimension:ident, $part:expr;)*) => {
        /// Signal of a rig with its controller. Forces, positions and velocities are positive
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

            /// Name of its column, which ends in its SI unit.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Signal::$signal => $name,)*
                }
            }

            /// Dimension of the signal.
            pub const fn dimension(self) -> &'static Dimension {
                match self {
                    $(Signal::$signal => &$dimension,)*
                }
            }

            /// Part of the rig to which it belongs.
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
    Time = "time_s", TIME, SignalPart::Rig;
    /// Reference force; at a step, the value from then on.
    Reference = "reference_n", FORCE, SignalPart::Rig;
    /// Force of the rod on the load; with a series element the force that its sensor measures.
    Force = "force_n", FORCE, SignalPart::Rig;
    /// Output command of the controller, or the command of an open loop.
    Control = "control_v", VOLTAGE, SignalPart::Rig;
    /// Position of the spool.
    Spool = "spool_v", VOLTAGE, SignalPart::Rig;
    /// Pressure of chamber A.
    PressureA = "pressure_a_pa", PRESSURE, SignalPart::Rig;
    /// Pressure of chamber B.
    PressureB = "pressure_b_pa", PRESSURE, SignalPart::Rig;
    /// Position of the piston from the A end.
    Position = "position_m", LENGTH, SignalPart::Rig;
    /// Velocity of the piston.
    Velocity = "velocity_m_per_s", VELOCITY, SignalPart::Rig;
    /// Supply pressure at the valve.
    SupplyPressure = "supply_pressure_pa", PRESSURE, SignalPart::Rig;
    /// Deflection of the force sensor.
    Deflection = "deflection_m", LENGTH, SignalPart::Rig;
    /// Friction of the piston.
    Friction = "friction_n", FORCE, SignalPart::Rig;
    /// Force of the end stops on the piston.
    EndStops = "end_stops_n", FORCE, SignalPart::Rig;
    /// Flow from the valve into the line to chamber A.
    FlowA = "flow_a_m3_per_s", FLOW, SignalPart::Rig;
    /// Flow from the valve into the line to chamber B.
    FlowB = "flow_b_m3_per_s", FLOW, SignalPart::Rig;
    /// Flow that the valve takes from the supply.
    SupplyFlow = "supply_flow_m3_per_s", FLOW, SignalPart::Rig;
    /// Position of the load; behind a linkage that of the rod's end.
    LoadPosition = "load_position_m", LENGTH, SignalPart::Rig;
    /// Velocity of the load; behind a linkage that of the rod's end.
    LoadVelocity = "load_velocity_m_per_s", VELOCITY, SignalPart::Rig;
    /// Pressure of line A at the valve.
    PortPressureA = "port_pressure_a_pa", PRESSURE, SignalPart::Rig;
    /// Pressure of line B at the valve.
    PortPressureB = "port_pressure_b_pa", PRESSURE, SignalPart::Rig;
    /// Force of the chambers on the piston.
    HydraulicForce = "hydraulic_force_n", FORCE, SignalPart::Rig;
    /// Reference force after the prefilter.
    FilteredReference = "filtered_reference_n", FORCE, SignalPart::Rig;
    /// Opening of the valve's edges: the spool less null bias and magnetic lag.
    Opening = "opening_v", VOLTAGE, SignalPart::Rig;
    /// Compression of the series spring, or of the oil of a transmission.
    SeriesDeflection = "series_deflection_m", LENGTH, SignalPart::SeriesElement;
    /// Force on the load behind a series element.
    LoadForce = "load_force_n", FORCE, SignalPart::SeriesElement;
    /// Angle of the joint.
    JointAngle = "joint_angle_rad", ANGLE, SignalPart::Linkage;
    /// Angular velocity of the joint.
    JointVelocity = "joint_velocity_rad_per_s", ANGULAR_VELOCITY, SignalPart::Linkage;
    /// Torque of the rod on the joint.
    JointTorque = "joint_torque_n_m", TORQUE, SignalPart::Linkage;
    /// Pressure of the gas behind a neck at chamber A.
    GasPressureA = "gas_pressure_a_pa", PRESSURE, SignalPart::GasPressure(0);
    /// Pressure of the gas behind a neck at chamber B.
    GasPressureB = "gas_pressure_b_pa", PRESSURE, SignalPart::GasPressure(1);
    /// Absolute temperature of the gas at chamber A over that of its wall.
    GasTemperatureRatioA = "gas_temperature_a_ratio", RATIO, SignalPart::HeatedGas(0);
    /// Absolute temperature of the gas at chamber B over that of its wall.
    GasTemperatureRatioB = "gas_temperature_b_ratio", RATIO, SignalPart::HeatedGas(1);
    /// Setting of the accumulator at chamber A.
    SettingA = "setting_a_ratio", RATIO, SignalPart::Adjustment;
    /// Setting of the accumulator at chamber B.
    SettingB = "setting_b_ratio", RATIO, SignalPart::Adjustment;
    /// Power of the adjustment of the accumulators.
    AdjustmentPower = "adjustment_power_w", POWER, SignalPart::Adjustment;
    /// Pressure of the transmission's oil at the piston on the rod.
    TransmissionPressureRod = "transmission_pressure_rod_pa", PRESSURE, SignalPart::Transmission;
    /// Pressure of the transmission's oil at the piston on the load.
    TransmissionPressureLoad = "transmission_pressure_load_pa", PRESSURE, SignalPart::Transmission;
    /// Temperature of the gas at chamber A.
    GasTemperatureA = "gas_temperature_a_degC", TEMPERATURE, SignalPart::GasTemperature(0);
    /// Temperature of the gas at chamber B.
    GasTemperatureB = "gas_temperature_b_degC", TEMPERATURE, SignalPart::GasTemperature(1);
    /// Command on arrival at the valve, after the delay of the loop.
    Command = "command_v", VOLTAGE, SignalPart::Rig;
    /// Command of the controller without its limit.
    UnlimitedControl = "unlimited_control_v", VOLTAGE, SignalPart::Rig;
    /// Part of the command held by the controller's integral part.
    Integral = "integral_v", VOLTAGE, SignalPart::Rig;
    /// Force measured by the controller, after the sensor, including the force of a virtual
    /// impedance.
    Measurement = "measurement_n", FORCE, SignalPart::Rig;
    /// Force that a virtual impedance adds before the sensor: the reference yields by it.
    VirtualForce = "virtual_force_n", FORCE, SignalPart::VirtualImpedance;
    /// External force on the load.
    ExternalForce = "external_force_n", FORCE, SignalPart::ExternalForce;
    /// External torque on a load that turns behind a linkage.
    ExternalTorque = "external_torque_n_m", TORQUE, SignalPart::ExternalTorque;
}

impl Signal {
    /// Signal with this name.
    pub fn named(name: &str) -> Option<Signal> {
        Signal::ALL.iter().copied().find(|signal| signal.name() == name)
    }
}
