//! Virtual static tests of the servovalve: internal leakage, metering and pressure gain (ISO
//! 10770-1), as instruments would record them.
//!
//! ```text
//! command -> opening (hysteresis, null bias) -> test stand (pump, meter) -> instruments (noise, conversion) -> rows
//! ```
//!
//! The spool is assumed to be at rest at each row: its lag of a few milliseconds is negligible
//! compared with the hysteresis in a cycle of minutes.

mod instrument;

use phea_dynamics::portable;
use phea_dynamics::random::stream;
use phea_dynamics::watch::{Stopped, Watch, tell};
use phea_hydraulics::servovalve::{SlowSpool, SpoolImperfection, TestStand};

use self::instrument::Instruments;
pub use crate::project::StaticTest;
use crate::project::{Bench, BenchWaveform, DeclaredActuator, SupplyModel};
use crate::rig::RigError;
use crate::setup::Setup;

/// The readings of the instruments at one time. Units: s, V, Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchRow {
    /// Time from the beginning.
    pub time: f64,
    /// Command U_C.
    pub command: f64,
    /// p_S.
    pub supply_pressure: f64,
    /// p_A.
    pub pressure_a: f64,
    /// p_B.
    pub pressure_b: f64,
    /// Flow from the supply in the leakage test, tare flow included.
    pub leak_flow: f64,
    /// Flow between the ports in the metering test.
    pub flow: f64,
}

/// A test as it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchRun {
    /// Which.
    pub test: StaticTest,
    /// Rows in the order of time.
    pub rows: Vec<BenchRow>,
    /// Lowest supply pressure during the test, without noise, in Pa.
    pub lowest_supply_pressure: f64,
}

/// Why there are no tests.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BenchError {
    /// The valve cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A test would have more rows than can be recorded.
    #[error("[bench] asks for {rows} rows a test: at most {most} are recorded")]
    TooManyRows {
        /// Of one test.
        rows: f64,
        /// How many there may be.
        most: usize,
    },
    /// Stopped by the watch.
    #[error("stopped")]
    Stopped,
}

impl From<Stopped> for BenchError {
    fn from(_: Stopped) -> BenchError {
        BenchError::Stopped
    }
}

/// Most rows of a test.
const MOST_ROWS: usize = 1_000_000;

/// All static tests of the project's valve.
///
/// # Errors
/// [`BenchError`] for a project without an actuator, an impossible one, or too many rows.
pub fn bench(setup: &Setup<'_>, watch: Watch<'_>) -> Result<Vec<BenchRun>, BenchError> {
    let declared = setup.project.actuator.as_ref().ok_or(RigError::NoActuator)?;
    let rig = setup.rig()?;
    let components = rig.actuator.components();
    let settings = &setup.project.bench;
    let rows = (settings.duration / settings.sample_time).floor() + 1.0;
    if rows > MOST_ROWS as f64 {
        return Err(BenchError::TooManyRows { rows, most: MOST_ROWS });
    }
    let meter = settings.flow_meter;
    let stand = TestStand {
        valve: components.valve,
        supply: components.supply,
        tare_reference_drop: declared.valve.tare_drop(&declared.supply),
        pump: pump(declared, settings),
        meter_coefficient: if meter.pressure_drop > 0.0 {
            meter.range / meter.pressure_drop.sqrt()
        } else {
            f64::INFINITY
        },
    };
    let spool = SpoolImperfection {
        null_bias: declared.valve.null_bias,
        hysteresis_width: declared.valve.hysteresis,
        threshold: declared.valve.threshold,
        rate_limit: None,
    };
    let mut runs = Vec::with_capacity(StaticTest::ALL.len());
    for test in StaticTest::ALL {
        runs.push(record(test, (&stand, &spool), settings, rows as usize, watch)?);
    }
    Ok(runs)
}

/// Flow of the pump and the override of its relief valve, where the supply is limited.
fn pump(declared: &DeclaredActuator, settings: &Bench) -> Option<[f64; 2]> {
    // a relief valve that opens within 1 % of the pressure, where none is described
    let sharp = 0.01 * (declared.supply.pressure - declared.supply.tank_pressure);
    match (&declared.supply.model, settings.pump_flow) {
        (SupplyModel::PumpLimited(pump), flow) => Some([flow.unwrap_or(pump.flow), pump.relief_override]),
        (SupplyModel::Constant { .. }, flow) => flow.map(|flow| [flow, sharp]),
    }
}

/// One test from its first row to its last; the spool starts without memory.
fn record(
    test: StaticTest,
    (stand, spool): (&TestStand, &SpoolImperfection),
    settings: &Bench,
    rows: usize,
    watch: Watch<'_>,
) -> Result<BenchRun, BenchError> {
    let mut instruments = Instruments::new(settings, stand.valve.nominal_voltage);
    let mut noise = stream(u64::from(settings.seed), test as u64);
    let mut memory = SlowSpool::at(0.0);
    let mut run = BenchRun { test, rows: Vec::with_capacity(rows), lowest_supply_pressure: f64::INFINITY };
    let share =
        if test == StaticTest::PressureGain { settings.pressure_gain_amplitude } else { settings.amplitude };
    for index in 0..rows {
        if index % 64 == 0 {
            tell(watch, test.name(), index, rows)?;
        }
        let time = index as f64 * settings.sample_time;
        let cycles = time / settings.duration * f64::from(settings.cycles);
        let wanted = share * stand.valve.nominal_voltage * wave(settings.waveform, cycles);
        let command = instruments.command(wanted);
        let opening = spool.slow_opening(&mut memory, command);
        let found = stand.settled(test.circuit(), opening);
        run.lowest_supply_pressure = run.lowest_supply_pressure.min(found.supply_pressure);
        let mut pressure = |value| instruments.pressure(value, &mut noise);
        let [supply_pressure, pressure_a, pressure_b] =
            [found.supply_pressure, found.ports.pressure_a, found.ports.pressure_b].map(&mut pressure);
        let leak_flow =
            instruments.flow(&settings.leak_meter, found.ports.supply_flow + found.tare_flow, &mut noise);
        let flow = instruments.flow(&settings.flow_meter, found.ports.port_flow, &mut noise);
        run.rows.push(BenchRow { time, command, supply_pressure, pressure_a, pressure_b, leak_flow, flow });
    }
    Ok(run)
}

/// The command over its amplitude after a number of cycles: first rising from zero.
fn wave(waveform: BenchWaveform, cycles: f64) -> f64 {
    let phase = cycles - cycles.floor();
    match waveform {
        BenchWaveform::Sine => portable::sin(2.0 * std::f64::consts::PI * phase),
        BenchWaveform::Triangle if phase < 0.25 => 4.0 * phase,
        BenchWaveform::Triangle if phase < 0.75 => 2.0 - 4.0 * phase,
        BenchWaveform::Triangle => 4.0 * phase - 4.0,
    }
}
