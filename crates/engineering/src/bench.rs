//! Virtual static tests of the servovalve: internal leakage, metering and pressure gain (ISO
//! 10770-1), as instruments would record them.
//!
//! ```text
//! command -> opening (hysteresis, null bias) -> test stand (pump, meter) -> instruments (noise, conversion) -> rows
//! ```
//!
//! The spool is assumed to be at rest at each row: its lag of a few milliseconds is negligible
//! compared with the hysteresis in a cycle of minutes.

mod command_path;
mod friction;
mod instrument;
mod reversals;

pub use friction::{FrictionRow, FrictionRun, FrictionSeries, friction_runs};
pub use reversals::ReversalReading;

use phea_dynamics::random::stream;
use phea_dynamics::simulation::{ProfileError, SimulationError};
use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_hydraulics::line::LineError;
use phea_hydraulics::servovalve::{OilLaw, SlowSpool, TestStand, WarmOil, ramp_delay};

use self::command_path::CommandPath;
pub(crate) use self::instrument::Instruments;
use crate::followed::{followed, roughness};
use crate::identify_error::KnownLineError;
pub use crate::project::StaticTest;
use crate::project::{Bench, DeclaredActuator, FlowMeter, OilTemperature, SupplyModel};
use crate::quantity::{DisplayUnit, TIME, display};
use crate::rig::RigError;
use crate::setup::Setup;

/// Readings of the instruments at one time. Units: s, V, Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchRow {
    /// Time from the beginning.
    pub time: f64,
    /// Command U_C.
    pub command: f64,
    /// Supply pressure p_S.
    pub supply_pressure: f64,
    /// Pressure p_A.
    pub pressure_a: f64,
    /// Pressure p_B.
    pub pressure_b: f64,
    /// Flow from the supply in the leakage test, including the tare flow.
    pub leak_flow: f64,
    /// Flow between the ports in the metering test.
    pub flow: f64,
    /// Temperature of the oil, degC, if it is stated.
    pub oil_temperature: Option<f64>,
}

/// Kind of a continuous recording. There may be two metering tests, one for each meter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchSeries {
    /// Internal leakage.
    Leakage,
    /// Metering.
    Metering,
    /// Pressure gain.
    PressureGain,
    /// Metering with the meter of small flows.
    LowFlowMetering,
    /// Hysteresis and threshold: metering over small reversals of the command.
    Reversals,
}

impl BenchSeries {
    /// Name in file names.
    pub fn name(self) -> &'static str {
        match self {
            BenchSeries::LowFlowMetering => "metering_low_flow",
            BenchSeries::Reversals => "reversals",
            series => series.test().name(),
        }
    }

    /// Kind of the test that determines ports and columns.
    pub fn test(self) -> StaticTest {
        match self {
            BenchSeries::Leakage => StaticTest::Leakage,
            BenchSeries::PressureGain => StaticTest::PressureGain,
            BenchSeries::Metering | BenchSeries::LowFlowMetering | BenchSeries::Reversals => {
                StaticTest::Metering
            }
        }
    }
}

/// A recorded test.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchRun {
    /// Kind of the recording.
    pub series: BenchSeries,
    /// Rows in the order of time.
    pub rows: Vec<BenchRow>,
    /// Lowest supply pressure during the test, without noise, Pa.
    pub lowest_supply_pressure: f64,
    /// Hysteresis and threshold from the rows of the test.
    pub reversals: Option<ReversalReading>,
}

/// Reason why there are no tests.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BenchError {
    /// The valve cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A test would have more rows than can be recorded.
    #[error("[bench] asks for {rows} rows a test: at most {most} are recorded")]
    TooManyRows {
        /// Number of rows of one test.
        rows: f64,
        /// Largest permitted number.
        most: usize,
    },
    /// The tests of a line cannot be made.
    #[error("[bench.line]: {0}")]
    Line(#[from] BenchLineError),
    /// The friction has no bristles.
    #[error(
        "[bench.friction] needs `model = \"lugre\"` in [cylinder.friction]: no other friction breaks away"
    )]
    NoBristles,
    /// A run would leave the cylinder.
    #[error(
        "[bench.friction]: {:.4} m at the fastest velocity are too far in a stroke of {stroke} m, from its middle",
        travel
    )]
    BeyondStroke {
        /// Travel from one reversal to the next, m.
        travel: f64,
        /// Stroke of the cylinder, m.
        stroke: f64,
    },
    /// A piston is shaken too quickly for its rows.
    #[error(
        "[bench.friction.shaken]: {} is too fast for its `sample_time`: a period needs four rows or more, so at most {}",
        hertz(highest),
        display(*sample_time, &TIME, 3)
    )]
    ShakenTooFast {
        /// Highest frequency, rad/s.
        highest: f64,
        /// Longest sample time, s.
        sample_time: f64,
    },
    /// No frequency remains to shake a piston with.
    #[error(
        "[bench.friction.shaken]: no multiple of {} lies from {} to {}: choose a longer `period` or other `frequencies`",
        hertz(spacing),
        hertz(&frequencies[0]),
        hertz(&frequencies[1])
    )]
    NothingShaken {
        /// Ends of the range of frequencies, rad/s.
        frequencies: [f64; 2],
        /// Frequency of the period, rad/s.
        spacing: f64,
    },
    /// The progress callback cancelled the tests.
    #[error("stopped")]
    Stopped,
}

/// Reason why there are no tests of a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BenchLineError {
    /// The project has no line to test.
    #[error(transparent)]
    Known(#[from] KnownLineError),
    /// The line cannot be simulated.
    #[error(transparent)]
    Line(#[from] LineError),
    /// The flow is not a function of time.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The simulation does not start.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Fewer than three lines of the period are excited.
    #[error("`bench.line.frequencies` has fewer than three lines of `bench.line.period`")]
    FewFrequencies,
    /// The simulation ended early.
    #[error("the simulation of the line does not come to its end: state shorter tests")]
    Unfinished,
}

/// Display text of a frequency, rad/s.
fn hertz(frequency: &f64) -> String {
    DisplayUnit::HERTZ.text(*frequency, 4)
}

impl From<Stopped> for BenchError {
    fn from(_: Stopped) -> BenchError {
        BenchError::Stopped
    }
}

/// Largest number of rows of a test.
pub(crate) const MOST_ROWS: usize = 1_000_000;

/// All static tests of the project's valve.
///
/// # Errors
/// [`BenchError`] for a project without an actuator, for an invalid actuator, or for too many rows.
pub fn bench(setup: &Setup<'_>, watch: Watch<'_>) -> Result<Vec<BenchRun>, BenchError> {
    let declared = setup.project.actuator.as_ref().ok_or(RigError::NoActuator)?;
    let rig = setup.rig()?;
    let components = rig.actuator.components();
    let settings = &setup.project.bench;
    let rows = (settings.duration / settings.sample_time).floor() + 1.0;
    if rows > MOST_ROWS as f64 {
        return Err(BenchError::TooManyRows { rows, most: MOST_ROWS });
    }
    let stand = TestStand {
        valve: components.valve,
        supply: components.supply,
        pump: pump(declared, settings),
        meter_coefficient: f64::INFINITY,
    };
    let series = wanted(settings);
    let mut runs = Vec::with_capacity(series.len());
    for series in series {
        runs.push(record(series, &stand, settings, rows as usize, watch)?);
    }
    Ok(runs)
}

/// The three usual tests, and the further ones that are declared.
fn wanted(settings: &Bench) -> Vec<BenchSeries> {
    let mut series = vec![BenchSeries::Leakage, BenchSeries::Metering, BenchSeries::PressureGain];
    series.extend(settings.low_flow_meter.map(|_| BenchSeries::LowFlowMetering));
    series.extend(settings.reversals.map(|_| BenchSeries::Reversals));
    series
}

/// Meter between the ports: small flows and reversals are measured by the small one, if there is
/// one.
fn meter_of(series: BenchSeries, settings: &Bench) -> FlowMeter {
    let small = matches!(series, BenchSeries::LowFlowMetering | BenchSeries::Reversals);
    let small = settings.low_flow_meter.filter(|_| small);
    small.map_or(settings.flow_meter, |small| small.meter)
}

/// Flow at a pressure drop of 1 Pa.
fn meter_coefficient(meter: &FlowMeter) -> f64 {
    if meter.pressure_drop > 0.0 { meter.range / meter.pressure_drop.sqrt() } else { f64::INFINITY }
}

/// The oil after a fraction of the test, relative to the oil for which the valve is stated.
fn oil_at(oil: &OilTemperature, fraction: f64) -> (f64, WarmOil) {
    let law = OilLaw { viscosity_slope: oil.viscosity_slope, density_slope: oil.density_slope };
    let temperature = oil.start + (oil.end - oil.start) * fraction;
    (temperature, law.warmer(temperature - oil.reference.unwrap_or(oil.start)))
}

/// Flow of the pump and the override of its relief valve, if the supply is limited.
fn pump(declared: &DeclaredActuator, settings: &Bench) -> Option<[f64; 2]> {
    // a relief valve that opens within 1 % of the pressure, if none is described
    let sharp = 0.01 * (declared.supply.pressure - declared.supply.tank_pressure);
    match (&declared.supply.model, settings.pump_flow) {
        (SupplyModel::PumpLimited(pump), flow) => Some([flow.unwrap_or(pump.flow), pump.relief_override]),
        (SupplyModel::Constant { .. }, flow) => flow.map(|flow| [flow, sharp]),
    }
}

/// One test from its first row to its last; the spool starts without memory.
fn record(
    series: BenchSeries,
    stand: &TestStand,
    settings: &Bench,
    rows: usize,
    watch: Watch<'_>,
) -> Result<BenchRun, BenchError> {
    let nominal_voltage = stand.valve.nominal_voltage;
    let mut instruments = Instruments::new(settings, nominal_voltage);
    let mut noise = stream(u64::from(settings.seed), series as u64);
    let mut memory = SlowSpool::at(0.0);
    let mut found = BenchRun {
        series,
        rows: Vec::with_capacity(rows),
        lowest_supply_pressure: f64::INFINITY,
        reversals: None,
    };
    let path = CommandPath::of(series, settings);
    let meter = meter_of(series, settings);
    let circuit = series.test().circuit();
    let stand = TestStand { meter_coefficient: meter_coefficient(&meter), ..*stand };
    let delay = ramp_delay(stand.valve.natural_frequency, stand.valve.damping_ratio);
    let mut before = 0.0;
    for index in 0..rows {
        if index % 64 == 0 {
            report_progress(watch, series.name(), index, rows)?;
        }
        let time = index as f64 * settings.sample_time;
        let command = instruments.command(nominal_voltage * path.at(time / settings.duration));
        let lag = delay * (command - before) / settings.sample_time;
        before = command;
        let opening = stand.valve.spool.slow_opening(&mut memory, command) - lag;
        let oil = settings.oil_temperature.map(|oil| oil_at(&oil, time / settings.duration));
        let warm = oil.map_or(stand, |(_, oil)| TestStand {
            valve: oil.valve(&stand.valve),
            meter_coefficient: stand.meter_coefficient * oil.turbulent_ratio(),
            ..stand
        });
        let viscosity_ratio = oil.map_or(1.0, |(_, oil)| oil.kinematic_viscosity_ratio());
        let state = warm.settled(circuit, opening);
        found.lowest_supply_pressure = found.lowest_supply_pressure.min(state.supply_pressure);
        let mut pressure = |value| instruments.pressure(value, &mut noise);
        let [supply_pressure, pressure_a, pressure_b] =
            [state.supply_pressure, state.ports.pressure_a, state.ports.pressure_b].map(&mut pressure);
        let leakage = state.ports.supply_flow + state.tare_flow;
        let leak_flow = instruments.flow(&settings.leak_meter, leakage, viscosity_ratio, &mut noise);
        let flow = instruments.flow(&meter, state.ports.port_flow, viscosity_ratio, &mut noise);
        let command = instruments.recorded_command(command, &mut noise);
        let oil_temperature = oil.map(|(temperature, _)| temperature);
        found.rows.push(BenchRow {
            time,
            command,
            supply_pressure,
            pressure_a,
            pressure_b,
            leak_flow,
            flow,
            oil_temperature,
        });
    }
    if let Some(reversals) = settings.reversals.filter(|_| series == BenchSeries::Reversals) {
        let rows = opened(&found.rows, delay / settings.sample_time);
        found.reversals = reversals::read(&rows, &reversals, nominal_voltage, watch)?;
    }
    Ok(found)
}

/// Position of the spool on its path, without the noise of the command's record, and flow, for each
/// row; the spool is this many rows late.
fn opened(rows: &[BenchRow], late: f64) -> Vec<(f64, f64)> {
    let recorded: Vec<f64> = rows.iter().map(|row| row.command).collect();
    let mut before = 0.0;
    let followed = followed(&recorded, roughness(&recorded)).into_iter().map(|command| {
        let position = command - late * (command - before);
        before = command;
        position
    });
    followed.zip(rows).map(|(position, row)| (position, row.flow.abs())).collect()
}
