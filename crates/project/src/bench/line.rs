//! Table `[bench.line]`: the tests of a line whose far end is blocked.

use phea_quantity::{ANGULAR_FREQUENCY, FLOW, PRESSURE, RATIO, TIME, VOLUME};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Line to one chamber.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineSide {
    /// Line to chamber A.
    #[default]
    A,
    /// Line to chamber B.
    B,
}

/// Line on a test stand: a slow rise of the pressure, and a flow of many frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineBench {
    /// Tested line.
    pub side: LineSide,
    /// Pressures between which the pressure rises and falls, Pa.
    pub pressures: [f64; 2],
    /// Duration of the rise, s.
    pub rise_time: f64,
    /// Time without flow before the rise, above and after the fall, s.
    pub standstill: f64,
    /// Time between rows of the rise, s.
    pub rise_sample_time: f64,
    /// Mean pressure of the flow test, Pa; if absent, midway between supply and tank.
    pub pressure: Option<f64>,
    /// Lowest and highest frequency, rad/s.
    pub frequencies: [f64; 2],
    /// Largest number of frequencies.
    pub lines: u32,
    /// Root mean square of the pressure oscillation, Pa.
    pub swing: f64,
    /// Period of the flow, s.
    pub period: f64,
    /// Number of periods.
    pub periods: u32,
    /// Time between rows, s.
    pub sample_time: f64,
    /// Root mean square of the noise of the flow, m³/s.
    pub flow_noise: f64,
    /// Root mean square of the noise of the volume, m³.
    pub volume_noise: f64,
}

/// Flow of one litre per minute, m³/s.
const LITRE_PER_MINUTE: f64 = 1.0 / 60_000.0;
/// Frequency of one hertz, rad/s.
const HERTZ: f64 = 2.0 * std::f64::consts::PI;

impl Default for LineBench {
    fn default() -> LineBench {
        LineBench {
            side: LineSide::A,
            pressures: [10e5, 60e5],
            rise_time: 20.0,
            standstill: 5.0,
            rise_sample_time: 0.02,
            pressure: None,
            frequencies: [HERTZ, 200.0 * HERTZ],
            lines: 24,
            swing: 3e5,
            period: 2.0,
            periods: 6,
            sample_time: 1e-3,
            flow_noise: 0.02 * LITRE_PER_MINUTE,
            volume_noise: 1e-8,
        }
    }
}

impl LineBench {
    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let usual = LineBench::default();
        let k = plain("side", "The line that is tested: to chamber A, or to chamber B.");
        v.choice(k, &[("a", LineSide::A), ("b", LineSide::B)], &mut self.side, false);
        self.visit_rise(&usual, v);
        let k =
            key("pressure", &PRESSURE, "Mean pressure of the shaken line; absent: that of an idle chamber.");
        v.optional(k.not_negative(), &mut self.pressure);
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Lowest and highest frequency of the shaken flow.");
        let mut ends = Some(self.frequencies).filter(|ends| *ends != usual.frequencies);
        v.pair(k.positive(), &mut ends);
        self.frequencies = ends.unwrap_or(usual.frequencies);
        let k = key("lines", &RATIO, "How many frequencies, at most, evenly spaced in the logarithm.");
        v.count(k.at_least(3.0).at_most(200.0).or(f64::from(usual.lines)), &mut self.lines);
        let doc = "Root mean square of the swing of the pressure, if the line had neither waves nor creep.";
        v.quantity(key("swing", &PRESSURE, doc).positive().or(usual.swing), &mut self.swing);
        let k = key("period", &TIME, "Time after which the shaken flow repeats.").positive().at_most(1e4);
        v.quantity(k.or(usual.period), &mut self.period);
        let k = key("periods", &RATIO, "How often it repeats; the first is not used.").at_least(3.0);
        v.count(k.at_most(1e4).or(f64::from(usual.periods)), &mut self.periods);
        let k = key("sample_time", &TIME, "Time between two rows of the shaken line.").at_least(1e-5);
        v.quantity(k.at_most(1.0).or(usual.sample_time), &mut self.sample_time);
        let k = key("flow_noise", &FLOW, "Root mean square of the noise of the flow.").not_negative();
        v.quantity(k.or(usual.flow_noise), &mut self.flow_noise);
        let k = key("volume_noise", &VOLUME, "Root mean square of the noise of the displaced volume.");
        v.quantity(k.not_negative().or(usual.volume_noise), &mut self.volume_noise);
    }

    fn visit_rise<V: Visitor>(&mut self, usual: &LineBench, v: &mut V) {
        let k = key("pressures", &PRESSURE, "Pressures between which the slow test rises and falls.");
        let mut ends = Some(self.pressures).filter(|ends| *ends != usual.pressures);
        v.pair(k.not_negative(), &mut ends);
        self.pressures = ends.unwrap_or(usual.pressures);
        let k = key("rise_time", &TIME, "Duration of the rise, and of the fall.").positive().at_most(1e5);
        v.quantity(k.or(usual.rise_time), &mut self.rise_time);
        let k = key("standstill", &TIME, "Time without flow before the rise, above, and after the fall.");
        v.quantity(k.positive().at_most(1e5).or(usual.standstill), &mut self.standstill);
        let k = key("rise_sample_time", &TIME, "Time between two rows of the rise.").at_least(1e-4);
        v.quantity(k.at_most(1e3).or(usual.rise_sample_time), &mut self.rise_sample_time);
    }
}
