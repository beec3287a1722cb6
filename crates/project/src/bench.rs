//! Table `[bench]`: the virtual tests of the servovalve, and of the cylinder's friction.

mod friction;

pub use friction::{FrictionBench, ShakenFriction};

mod line;

pub use line::{LineBench, LineSide};

use phea_quantity::{FLOW, PRESSURE, RATIO, TEMPERATURE, TEMPERATURE_COEFFICIENT, TIME, VOLTAGE};
use phea_table::Visitor;
use phea_table::{Key, key, plain};

/// Waveform of the command over a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BenchWaveform {
    /// Sine from zero.
    #[default]
    Sine,
    /// Triangle from zero.
    Triangle,
}

/// Tests of the servovalve, and their instruments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bench {
    /// Duration of one test, s.
    pub duration: f64,
    /// Cycles of the command in a test.
    pub cycles: u32,
    /// Waveform of the command over a cycle.
    pub waveform: BenchWaveform,
    /// Amplitude of the command in the leakage and metering tests, as a fraction of the nominal
    /// voltage.
    pub amplitude: f64,
    /// Amplitude for the pressure gain test.
    pub pressure_gain_amplitude: f64,
    /// Time between two rows, s.
    pub sample_time: f64,
    /// Flow of the pump, m³/s; if absent, that of a pump-limited supply, otherwise unlimited.
    pub pump_flow: Option<f64>,
    /// Meter of the leakage.
    pub leak_meter: FlowMeter,
    /// Meter between the ports.
    pub flow_meter: FlowMeter,
    /// Second meter for small flows, with a metering test of its own.
    pub low_flow_meter: Option<LowFlowMeter>,
    /// Test of hysteresis and threshold, if requested.
    pub reversals: Option<Reversals>,
    /// Temperature of the oil during each test; constant if absent.
    pub oil_temperature: Option<OilTemperature>,
    /// Tests of a line, if requested.
    pub line: Option<LineBench>,
    /// Runs of the cylinder for its friction, if requested.
    pub friction: Option<FrictionBench>,
    /// Root mean square of the noise of every pressure, Pa.
    pub pressure_noise: f64,
    /// Root mean square of the noise of the recorded command, V.
    pub command_noise: f64,
    /// Range of every pressure transducer, from zero, Pa.
    pub pressure_range: f64,
    /// Bits of the converters of all signals; zero for no conversion.
    pub converter_bits: u32,
    /// Seed of the noise.
    pub seed: u32,
}

/// Meter for small flows, and the amplitude of the command with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowFlowMeter {
    /// Flow meter.
    pub meter: FlowMeter,
    /// Amplitude of the command over the nominal voltage.
    pub amplitude: f64,
}

/// Test of hysteresis and threshold: a cycle of the command with small reversals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reversals {
    /// Greatest command over the nominal voltage.
    pub amplitude: f64,
    /// Size of each reversal of the command, over the nominal voltage.
    pub size: f64,
}

/// Linear change of the oil temperature during a test. Units: degC, 1/degC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilTemperature {
    /// Temperature at the beginning of each test.
    pub start: f64,
    /// Temperature at the end of each test.
    pub end: f64,
    /// Temperature for which `[valve]` and `[fluid]` are stated; if absent, that of the beginning.
    pub reference: Option<f64>,
    /// Relative decrease of the dynamic viscosity per degree.
    pub viscosity_slope: f64,
    /// Relative decrease of the density per degree.
    pub density_slope: f64,
}

/// Flow meter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowMeter {
    /// Highest flow, m³/s.
    pub range: f64,
    /// Flow below which the meter does not move, m³/s.
    pub minimum: f64,
    /// Root mean square of its noise, m³/s.
    pub noise: f64,
    /// Pressure drop at the highest flow, Pa.
    pub pressure_drop: f64,
    /// True if it indicates the direction.
    pub signed: bool,
}

/// Flow of one litre per minute, m³/s.
const LITRE_PER_MINUTE: f64 = 1.0 / 60_000.0;

/// Default meter of the leakage.
const LEAK_METER: FlowMeter = FlowMeter {
    range: 5.0 * LITRE_PER_MINUTE,
    minimum: 0.0,
    noise: 0.005 * LITRE_PER_MINUTE,
    pressure_drop: 0.0,
    signed: false,
};

/// Default meter between the ports.
const FLOW_METER: FlowMeter = FlowMeter {
    range: 60.0 * LITRE_PER_MINUTE,
    minimum: LITRE_PER_MINUTE,
    noise: 0.05 * LITRE_PER_MINUTE,
    pressure_drop: 2e5,
    signed: false,
};

/// Default meter for small flows.
const SMALL_METER: FlowMeter = FlowMeter {
    range: 5.0 * LITRE_PER_MINUTE,
    minimum: 0.1 * LITRE_PER_MINUTE,
    noise: 0.005 * LITRE_PER_MINUTE,
    pressure_drop: 5e5,
    signed: false,
};

impl Default for LowFlowMeter {
    fn default() -> LowFlowMeter {
        LowFlowMeter { meter: SMALL_METER, amplitude: 0.13 }
    }
}

impl Default for Reversals {
    fn default() -> Reversals {
        Reversals { amplitude: 0.12, size: 0.02 }
    }
}

impl Default for OilTemperature {
    fn default() -> OilTemperature {
        // viscosity of an ISO VG 46 oil near 40 degC, and density of mineral oil
        let [viscosity_slope, density_slope] = [0.045, 7e-4];
        OilTemperature { start: 37.0, end: 37.0, reference: None, viscosity_slope, density_slope }
    }
}

impl Default for Bench {
    fn default() -> Bench {
        Bench {
            duration: 240.0,
            cycles: 1,
            waveform: BenchWaveform::Sine,
            amplitude: 0.3,
            pressure_gain_amplitude: 0.05,
            sample_time: 0.1,
            pump_flow: None,
            leak_meter: LEAK_METER,
            flow_meter: FLOW_METER,
            low_flow_meter: None,
            reversals: None,
            oil_temperature: None,
            line: None,
            friction: None,
            pressure_noise: 5e3,
            command_noise: 0.0,
            pressure_range: 100e5,
            converter_bits: 16,
            seed: 1,
        }
    }
}

impl Bench {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("duration", &TIME, "Duration of each test.").positive().at_most(1e6).or(240.0);
        v.quantity(k, &mut self.duration);
        let k = key("cycles", &RATIO, "Cycles of the command in a test.").at_least(1.0).at_most(1e3).or(1.0);
        v.count(k, &mut self.cycles);
        let words = &[("sine", BenchWaveform::Sine), ("triangle", BenchWaveform::Triangle)];
        let k = plain("waveform", "How the command runs through its cycle, from zero.");
        v.choice(k, words, &mut self.waveform, false);
        let k = key("amplitude", &RATIO, "Amplitude of the command over the nominal voltage.");
        v.quantity(k.positive().at_most(1.0).or(0.3), &mut self.amplitude);
        let k = key("pressure_gain_amplitude", &RATIO, "The same for the pressure gain test.");
        v.quantity(k.positive().at_most(1.0).or(0.05), &mut self.pressure_gain_amplitude);
        let k = key("sample_time", &TIME, "Time between two rows.").at_least(1e-4).at_most(1e4).or(0.1);
        v.quantity(k, &mut self.sample_time);
        let k =
            key("pump_flow", &FLOW, "Flow of the pump; absent: that of a pump-limited supply, or no limit.");
        v.optional(k.positive(), &mut self.pump_flow);
        let k = plain("leak_meter", "Meter of the leakage.");
        meter(k, &mut self.leak_meter, LEAK_METER, v);
        let k = plain("flow_meter", "Meter between the ports.");
        meter(k, &mut self.flow_meter, FLOW_METER, v);
        let k =
            plain("low_flow_meter", "A second one for small flows: a second metering test is made with it.");
        v.table(k, &mut self.low_flow_meter, LowFlowMeter::visit);
        let k =
            plain("reversals", "Test of hysteresis and threshold: a cycle with small reversals on its way.");
        v.table(k, &mut self.reversals, Reversals::visit);
        let k = plain("oil_temperature", "How the oil warms during each test; absent: it does not.");
        v.table(k, &mut self.oil_temperature, OilTemperature::visit);
        let k = plain("line", "Tests of a line whose far end is blocked.");
        v.table(k, &mut self.line, LineBench::visit);
        let k = plain("friction", "Runs of the cylinder that its friction is identified from.");
        v.table(k, &mut self.friction, FrictionBench::visit);
        let k = key("pressure_noise", &PRESSURE, "Root mean square of the noise of every pressure.");
        v.quantity(k.not_negative().or(5e3), &mut self.pressure_noise);
        let k = key("command_noise", &VOLTAGE, "Root mean square of the noise of the recorded command.");
        v.quantity(k.not_negative().or(0.0), &mut self.command_noise);
        let k = key("pressure_range", &PRESSURE, "Range of every pressure transducer, from zero.");
        v.quantity(k.positive().or(100e5), &mut self.pressure_range);
        let k = key("converter_bits", &RATIO, "Bits of the converters of all signals; 0: no conversion.");
        v.count(k.not_negative().at_most(32.0).or(16.0), &mut self.converter_bits);
        let k = key("seed", &RATIO, "Seed of the noise.").not_negative().at_most(4e9).or(1.0);
        v.count(k, &mut self.seed);
    }
}

impl LowFlowMeter {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.meter.visit(SMALL_METER, v);
        let k =
            key("amplitude", &RATIO, "Amplitude of the command over the nominal voltage, with this meter.");
        v.quantity(k.positive().at_most(1.0).or(0.13), &mut self.amplitude);
    }
}

impl Reversals {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("amplitude", &RATIO, "Greatest command over the nominal voltage.");
        v.quantity(k.positive().at_most(1.0).or(0.12), &mut self.amplitude);
        let k = key("size", &RATIO, "How far the command goes back at a reversal, over the nominal voltage.");
        v.quantity(k.positive().at_most(0.5).or(0.02), &mut self.size);
    }
}

impl OilTemperature {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let within = |k: Key| k.above(-50.0).at_most(150.0);
        let k = key("start", &TEMPERATURE, "Temperature at the beginning of each test.");
        v.quantity(within(k).or(37.0), &mut self.start);
        let k = key("end", &TEMPERATURE, "Temperature at the end of each test.");
        v.quantity(within(k).or(37.0), &mut self.end);
        let k = key(
            "reference",
            &TEMPERATURE,
            "Temperature that the valve is stated at; absent: that of the beginning.",
        );
        v.optional(within(k), &mut self.reference);
        let doc = "Share by which the dynamic viscosity falls with each degree.";
        let k = key("viscosity_slope", &TEMPERATURE_COEFFICIENT, doc).not_negative().at_most(0.2).or(0.045);
        v.quantity(k, &mut self.viscosity_slope);
        let doc = "Share by which the density falls with each degree.";
        let k = key("density_slope", &TEMPERATURE_COEFFICIENT, doc).not_negative().at_most(0.004).or(7e-4);
        v.quantity(k, &mut self.density_slope);
    }
}

/// Visits a meter, with its own defaults for an absent table or key.
fn meter<V: Visitor>(key: Key, field: &mut FlowMeter, absent: FlowMeter, v: &mut V) {
    let mut declared = (*field != absent).then_some(Declared(*field));
    v.table(key, &mut declared, |declared, v| declared.0.visit(absent, v));
    *field = declared.map_or(absent, |declared| declared.0);
}

/// Meter while it is read.
struct Declared(FlowMeter);

impl Default for Declared {
    fn default() -> Declared {
        Declared(FLOW_METER)
    }
}

impl FlowMeter {
    fn visit<V: Visitor>(&mut self, absent: FlowMeter, v: &mut V) {
        let k = key("range", &FLOW, "The highest flow it measures.").positive().or(absent.range);
        v.quantity(k, &mut self.range);
        let k = key("minimum", &FLOW, "Flow below which it reads zero.").not_negative().or(absent.minimum);
        v.quantity(k, &mut self.minimum);
        let k = key("noise", &FLOW, "Root mean square of its noise.").not_negative().or(absent.noise);
        v.quantity(k, &mut self.noise);
        // the leakage flows to the valve through a meter whose drop the regulated supply
        // compensates
        if absent.pressure_drop > 0.0 {
            let k = key("pressure_drop", &PRESSURE, "Its pressure drop at the highest flow.").not_negative();
            v.quantity(k.or(absent.pressure_drop), &mut self.pressure_drop);
        }
        v.flag(
            plain("signed", "Whether it indicates the direction of the flow; absent: false."),
            &mut self.signed,
        );
    }
}
