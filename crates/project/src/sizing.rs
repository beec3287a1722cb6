//! Tables `[sizing]` and `[sizing.other_means]`.

use super::SpringCoil;
use phea_quantity::{
    FLOW_GAIN, FLOW_PRESSURE_COEFFICIENT, FORCE, LENGTH, PERCENT, RATIO, STIFFNESS, TIME, VELOCITY,
    VOLTAGE_PER_FORCE,
};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Requirements on the compliant component.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSizing {
    /// Required speed of the closed loop.
    pub speed: Speed,
    /// Flow gain K_qU, m³/(s·V); if absent, derived from the valve at null.
    pub flow_gain: Option<f64>,
    /// Flow-pressure coefficient K_c, m³/(s·Pa); if absent, derived from the valve at null.
    pub flow_pressure_coefficient: Option<f64>,
    /// Range of the oil velocity, m/s: a velocity above it rejects a bore, one below it causes a
    /// warning.
    pub oil_velocity: Option<[f64; 2]>,
    /// Lower end of the search over the proportional gain, V/N.
    pub minimum_gain: Option<f64>,
    /// Starting value of the search over the proportional gain, V/N.
    pub maximum_gain: Option<f64>,
    /// Length available for both hoses together, m.
    pub stock_length: Option<f64>,
    /// Acceptable length of one hose, m.
    pub hose_length: Option<[f64; 2]>,
    /// Increment of hose lengths, m; any length if absent.
    pub length_increment: Option<f64>,
    /// Other components to be sized for the stiffness of the hose; none if absent.
    pub other_means: Option<OtherMeansRequirement>,
}

/// Requirements on alternatives with the softness of the hose.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherMeansRequirement {
    /// Stiffness K_H, N/m; if absent, that of the accepted hose.
    pub stiffness: Option<f64>,
    /// Range of forces at standstill over which gas must be in use, N; if absent, no gas is sized.
    pub force_range: Option<[f64; 2]>,
    /// Ratio of the precharge to the lowest pressure of a chamber between these forces, both
    /// absolute.
    pub precharge_share: f64,
    /// Polytropic exponent of the gas.
    pub polytropic_exponent: f64,
    /// Damping ratio of the mode of the load cell; if absent, no valve between the chambers is
    /// sized.
    pub damping_ratio: Option<f64>,
    /// Winding of a spring on the rod; if absent, only its stiffness and travel are found.
    pub coil: Option<SpringCoil>,
}

/// Common ratio of an accumulator's precharge to its lowest working pressure.
const PRECHARGE_SHARE: f64 = 0.9;
/// Polytropic exponent of nitrogen without heat exchange.
const ADIABATIC: f64 = 1.4;

impl Default for OtherMeansRequirement {
    fn default() -> Self {
        OtherMeansRequirement {
            stiffness: None,
            force_range: None,
            precharge_share: PRECHARGE_SHARE,
            polytropic_exponent: ADIABATIC,
            damping_ratio: None,
            coil: None,
        }
    }
}

impl OtherMeansRequirement {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("stiffness", &STIFFNESS, "K_H of the other means; absent: that of the accepted hose.");
        v.optional(k.positive(), &mut self.stiffness);
        let k = key("force_range", &FORCE, "Forces at standstill between which gas is to be in use.");
        v.pair(k, &mut self.force_range);
        let k = key("precharge_share", &RATIO, "Precharge over the lowest pressure of a chamber, absolute.");
        v.quantity(k.positive().at_most(1.0).or(PRECHARGE_SHARE), &mut self.precharge_share);
        let k = key("polytropic_exponent", &RATIO, "Of the gas: 1 isothermal, 1.4 without heat.");
        v.quantity(k.at_least(1.0).at_most(2.0).or(ADIABATIC), &mut self.polytropic_exponent);
        let k = key("damping_ratio", &RATIO, "Of the load cell's mode, by a valve between the chambers.");
        v.optional(k.positive().below(1.0), &mut self.damping_ratio);
        let k = plain("coil", "What a spring on the rod is wound from.");
        v.table(k, &mut self.coil, SpringCoil::visit);
    }
}

/// Required speed of a closed loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Time constant, s.
    TimeConstant(f64),
    /// Settling time.
    Settling(SettlingTime),
}

/// Settling time and its band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SettlingTime {
    /// Settling time, s.
    pub time: f64,
    /// Band, percent of the step.
    pub band_percent: f64,
}

impl Default for Speed {
    fn default() -> Self {
        Speed::Settling(SettlingTime::default())
    }
}

impl Speed {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let (mut constant, mut settling) = match *self {
            Speed::TimeConstant(time) => (Some(time), None),
            Speed::Settling(settling) => (None, Some(settling)),
        };
        let k = key("time_constant", &TIME, "Time constant of the closed loop; or `settling_time`.");
        v.optional(k.positive(), &mut constant);
        v.way(&["settling_time"], &mut settling, SettlingTime::visit);
        v.one_of(&["time_constant", "settling_time"], true);
        *self = constant.map_or(Speed::Settling(settling.unwrap_or_default()), Speed::TimeConstant);
    }
}

impl SettlingTime {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("settling_time", &TIME, "Settling time, with `settling_band_percent`.").positive();
        v.quantity(k, &mut self.time);
        let k = key("settling_band_percent", &PERCENT, "Band of the settling time, in percent of the step.");
        v.quantity(k.positive().below(100.0), &mut self.band_percent);
    }
}

impl DeclaredSizing {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.speed.visit(v);
        let k = key("flow_gain", &FLOW_GAIN, "K_qU; absent: derived from the valve at null.").positive();
        v.optional(k, &mut self.flow_gain);
        let k = key("flow_pressure_coefficient", &FLOW_PRESSURE_COEFFICIENT, "K_c; absent: derived.");
        v.optional(k.not_negative(), &mut self.flow_pressure_coefficient);
        let k = key("oil_velocity", &VELOCITY, "Range of the oil velocity: above rejects, below warns.");
        v.pair(k.positive(), &mut self.oil_velocity);
        let k = key("minimum_gain", &VOLTAGE_PER_FORCE, "Floor of the search over the proportional gain.");
        v.optional(k.positive(), &mut self.minimum_gain);
        let k = key("maximum_gain", &VOLTAGE_PER_FORCE, "Start of the search over the proportional gain.");
        v.optional(k.positive(), &mut self.maximum_gain);
        let k = key("stock_length", &LENGTH, "Available hose, for both lines together.").positive();
        v.optional(k, &mut self.stock_length);
        let k = key("hose_length", &LENGTH, "Acceptable range of the length of one hose.").positive();
        v.pair(k, &mut self.hose_length);
        let k = key("length_increment", &LENGTH, "Hoses are cut to multiples of this.").positive();
        v.optional(k, &mut self.length_increment);
        let k = plain("other_means", "Sizes gas, a spring, a pipe and a valve between the chambers too.");
        v.table(k, &mut self.other_means, OtherMeansRequirement::visit);
    }
}
