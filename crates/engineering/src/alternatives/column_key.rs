//! The table of columns by which alternatives can be compared.

use super::comparison::ColumnSense;
use crate::quantity::{DAMPING, FORCE, MASS, QuantityName, STIFFNESS, VOLTAGE_PER_FORCE};

/// A column by which alternatives can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKey {
    /// Relaxation of every limit that makes the specifications satisfiable.
    Relaxation,
    /// Order of the controller.
    Order,
    /// Order of the prefilter.
    PrefilterOrder,
    /// Relative degree of the controller.
    RelativeDegree,
    /// High-frequency gain of the controller.
    HighFrequencyGain,
    /// Modulus margin of the designed loop.
    ModulusMargin,
    /// Delay margin of the designed loop.
    DelayMargin,
    /// Least margin of a specification.
    WorstMargin,
    /// Least hydraulic stiffness over the stroke.
    StiffnessMinimum,
    /// Greatest hydraulic stiffness over the stroke.
    StiffnessMaximum,
    /// Stiffness of oil and force sensor in series at the operating point.
    EquivalentStiffness,
    /// Retracted length of the actuator.
    ActuatorLength,
    /// Length of both lines.
    LinesLength,
    /// Moving mass; for a motor the inertia.
    MovingMass,
    /// Volume of both lines.
    LinesVolume,
    /// Volume of all oil.
    OilVolume,
    /// Mass of that oil.
    OilMass,
    /// Volume of the gas at the chambers.
    GasVolume,
    /// Power that the rig takes at rest.
    PowerAtRest,
    /// Price of its parts.
    PartsPrice,
    /// Mass of its parts and of the oil in its lines.
    PartsMass,
    /// Length of the lines by `[sizing]`.
    SizedLength,
    /// Proportional gain by `[sizing]`.
    SizedGain,
    /// Impedance at the load with the command held.
    ImpedanceOpen,
    /// Impedance at the load under the designed controller.
    ImpedanceClosed,
    /// Impedance of the required virtual impedance.
    ImpedanceRequired,
    /// Overshoot in a scenario.
    Overshoot,
    /// Settling time in a scenario.
    SettlingTime,
    /// Disturbance peak in a scenario.
    DisturbancePeak,
    /// Largest command in a scenario.
    ControlPeak,
    /// Root mean square of the command in a scenario.
    ControlRms,
    /// Energy from the supply in a scenario.
    EnergyFromSupply,
    /// Swept number of a front.
    Swept,
}

impl ColumnKey {
    /// All columns in the order of the output.
    pub const ALL: [ColumnKey; 33] = {
        use ColumnKey::*;
        [
            Relaxation,
            Order,
            PrefilterOrder,
            RelativeDegree,
            HighFrequencyGain,
            ModulusMargin,
            DelayMargin,
            WorstMargin,
            StiffnessMinimum,
            StiffnessMaximum,
            EquivalentStiffness,
            ActuatorLength,
            LinesLength,
            MovingMass,
            LinesVolume,
            OilVolume,
            OilMass,
            GasVolume,
            PowerAtRest,
            PartsPrice,
            PartsMass,
            SizedLength,
            SizedGain,
            ImpedanceOpen,
            ImpedanceClosed,
            ImpedanceRequired,
            Overshoot,
            SettlingTime,
            DisturbancePeak,
            ControlPeak,
            ControlRms,
            EnergyFromSupply,
            Swept,
        ]
    };

    /// Name in output for programs.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::alternatives::ColumnKey;
    /// use phea_quantity::MotionKind;
    /// let text = |key: ColumnKey| key.quantity().text(MotionKind::Rotary);
    /// assert_eq!(text(ColumnKey::MovingMass), "moving_inertia_kg_m2");
    /// assert_eq!(text(ColumnKey::OilMass), "oil_mass_kg");
    /// ```
    pub const fn quantity(self) -> QuantityName {
        use QuantityName::{Fixed, OfMotion};
        match self {
            ColumnKey::Relaxation => Fixed("relaxation_db"),
            ColumnKey::Order => Fixed("order"),
            ColumnKey::PrefilterOrder => Fixed("prefilter_order"),
            ColumnKey::RelativeDegree => Fixed("relative_degree"),
            ColumnKey::HighFrequencyGain => Fixed("high_frequency_gain_db"),
            ColumnKey::ModulusMargin => Fixed("modulus_margin"),
            ColumnKey::DelayMargin => Fixed("delay_margin_s"),
            ColumnKey::WorstMargin => Fixed("worst_margin_db"),
            ColumnKey::StiffnessMinimum => OfMotion(["stiffness_minimum"; 2], &STIFFNESS),
            ColumnKey::StiffnessMaximum => OfMotion(["stiffness_maximum"; 2], &STIFFNESS),
            ColumnKey::EquivalentStiffness => OfMotion(["equivalent_stiffness"; 2], &STIFFNESS),
            ColumnKey::ActuatorLength => Fixed("actuator_length_m"),
            ColumnKey::LinesLength => Fixed("lines_length_m"),
            ColumnKey::MovingMass => OfMotion(["moving_mass", "moving_inertia"], &MASS),
            ColumnKey::LinesVolume => Fixed("lines_volume_m3"),
            ColumnKey::OilVolume => Fixed("oil_volume_m3"),
            ColumnKey::OilMass => Fixed("oil_mass_kg"),
            ColumnKey::GasVolume => Fixed("gas_volume_m3"),
            ColumnKey::PowerAtRest => Fixed("power_at_rest_w"),
            ColumnKey::PartsPrice => Fixed("parts_price"),
            ColumnKey::PartsMass => Fixed("parts_mass_kg"),
            ColumnKey::SizedLength => Fixed("sized_length_m"),
            ColumnKey::SizedGain => OfMotion(["sized_gain"; 2], &VOLTAGE_PER_FORCE),
            ColumnKey::ImpedanceOpen => OfMotion(["impedance_open"; 2], &DAMPING),
            ColumnKey::ImpedanceClosed => OfMotion(["impedance_closed"; 2], &DAMPING),
            ColumnKey::ImpedanceRequired => OfMotion(["impedance_required"; 2], &DAMPING),
            ColumnKey::Overshoot => Fixed("overshoot_percent"),
            ColumnKey::SettlingTime => Fixed("settling_time_s"),
            ColumnKey::DisturbancePeak => OfMotion(["disturbance_peak"; 2], &FORCE),
            ColumnKey::ControlPeak => Fixed("control_peak_v"),
            ColumnKey::ControlRms => Fixed("control_rms_v"),
            ColumnKey::EnergyFromSupply => Fixed("energy_from_supply_j"),
            ColumnKey::Swept => Fixed("swept"),
        }
    }

    /// Sense in which values are better, unless a front requests another sense.
    pub const fn sense(self) -> ColumnSense {
        match self {
            ColumnKey::RelativeDegree
            | ColumnKey::ModulusMargin
            | ColumnKey::DelayMargin
            | ColumnKey::WorstMargin
            | ColumnKey::SizedGain => ColumnSense::More,
            _ => ColumnSense::Less,
        }
    }
}
