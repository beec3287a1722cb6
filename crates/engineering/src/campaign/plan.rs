//! Data common to all runs of a campaign.

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::random;
use phea_dynamics::scalar::Dependence;
use phea_dynamics::simulation::Plant;
use phea_machine::{Control, FedMotion};
use sha2::{Digest, Sha256};

use super::CampaignError;
use super::range::VariedRange;
use super::row::CampaignColumns;
use super::varied::ranges;
use crate::project::{InputSignal, Loaded, MotionShape, Project, Scenario, print};
use crate::quantity::{MotionKind, Units};
use crate::rig::with_controller_of;
use crate::setup::Setup;
use crate::simulate::{
    ControlledMachine, LineWatch, ScenarioDrive, SimulateError, TimeRequirement, Window, driven,
    time_requirements,
};
use crate::source::Source;

/// Largest number of times at which the bands of the force are given over the whole scenario, and
/// of additional times after the starts of its windows.
const BAND_TIMES: usize = 125;
/// Time after the start of a window during which the force is recorded more often, s.
const EVENT_S: f64 = 0.5;
/// Number of letters of the mark that identifies the rows of a campaign.
const MARK_LENGTH: usize = 16;
/// Number of seeds, from 0, that are compared with the mark of a row of another campaign.
const COMPARED_SEEDS: u32 = 1000;
/// Range of the seeds of the measurement noise of a sampled controller, which are drawn too.
const SEEDS: f64 = 4e9;

/// A Monte Carlo campaign of the nonlinear model: a scenario of a project, and the numbers that
/// are drawn for each run.
///
/// # Example
/// Seed and index determine every run.
/// ```
/// use phea_engineering::campaign::Plan;
/// use phea_project as project;
/// use phea_project::source::Memory;
/// let text = include_str!("../../../../examples/benchmark/campaign.toml");
/// let source = Memory::default().with("campaign.toml", text);
/// let loaded = project::read(&source, "campaign.toml", &[], &[])?;
/// let plan = Plan::new(&source, &loaded, 1)?;
/// let draw = plan.draw(7);
/// assert_eq!(draw, Plan::new(&source, &loaded, 1)?.draw(7));
/// assert!(draw.values != plan.draw(8).values);
/// for (range, value) in plan.ranges().iter().zip(&draw.values) {
///     assert!((range.minimum..range.maximum).contains(value));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Plan {
    pub(super) project: Project,
    /// Simulated scenario.
    pub(super) scenario: Scenario,
    /// Index of the scenario in the project.
    place: usize,
    /// Machine and controller as declared.
    pub(super) bench: ControlledMachine,
    /// Sensor H.
    pub(super) sensor: TransferFunction,
    /// Controller with its feedforward of the load's motion; `None` in an open loop.
    pub(super) law: Option<(Controller, FedMotion)>,
    pub(super) driven: ScenarioDrive,
    pub(super) columns: CampaignColumns,
    /// Time of every sample, s.
    pub times_s: Vec<f64>,
    /// Reference at every recorded time, N; at a step, the value after it. Zero in an open loop.
    pub reference_n: Vec<f64>,
    /// Indices of the recorded times of the bands.
    pub(super) band_samples: Vec<usize>,
    /// Indices of the states on which force and command depend.
    pub(super) look: Vec<usize>,
    /// Requirements in time.
    pub(super) requirements: Vec<TimeRequirement>,
    ranges: Vec<VariedRange>,
    seed: u32,
    marks: Marks,
}

/// The drawn numbers of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Index of the run.
    pub run: u64,
    /// Values, SI, in the order of [`Plan::ranges`].
    pub values: Vec<f64>,
    /// Seed of the measurement noise of a sampled controller, if there is noise.
    pub(super) noise_seed: Option<u32>,
}

/// The numbers over which the box of a family ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FamilyBox {
    /// The box is absent.
    None,
    /// Parameters of the linear model.
    LinearParameters,
    /// Numbers of the rig.
    Numbers,
}

/// A number that is drawn beyond the box for which the controller is judged.
#[derive(Clone, Copy, Debug)]
pub struct BeyondBox<'a> {
    /// Range of the draws; for a normal distribution, two standard deviations to both sides.
    pub range: &'a VariedRange,
    /// Range of the number in the box; `None` if it is not in the box.
    pub designed_for: Option<[f64; 2]>,
}

/// Fraction of the box by which a drawn range may exceed it through rounding.
const SAME: f64 = 1e-9;

impl Plan {
    /// Rows as a Parquet table.
    ///
    /// # Errors
    /// The error message of the Parquet writer.
    pub fn parquet(&self, rows: &[super::Row]) -> Result<Vec<u8>, String> {
        super::parquet::table(&self.columns, rows)
    }

    /// Campaign that a project declares, with the random numbers of a seed.
    ///
    /// # Errors
    /// [`CampaignError`] if it declares none, or one that cannot be simulated.
    pub fn new(source: &dyn Source, loaded: &Loaded, seed: u32) -> Result<Plan, CampaignError> {
        let project = loaded.project.clone();
        let campaign = project.campaign.as_ref().ok_or(CampaignError::Absent)?;
        let place = match &campaign.scenario {
            None => 0,
            Some(name) => project
                .scenarios
                .iter()
                .position(|scenario| scenario.name == *name)
                .ok_or_else(|| CampaignError::NoSuchScenario { name: name.clone() })?,
        };
        let scenario = project.scenarios.get(place).ok_or(CampaignError::NoScenario)?.clone();
        let ranges = ranges(&project, campaign, &scenario)?;
        let setup = Setup::new(&project).map_err(SimulateError::from)?;
        let bench = ControlledMachine::of_scenario(&setup, &scenario)?;
        let fed = FedMotion {
            gain: bench.feed_forward,
            sensor: setup.velocity_sensor,
            impedance: setup.virtual_impedance.unwrap_or_default(),
        };
        let law = setup.controller.filter(|_| !scenario.is_open_loop()).map(|given| (given, fed));
        let sensor = setup.sensor;
        let driven = driven(source, &project, &bench, &scenario)?;
        let looks = (scenario.duration / scenario.output_step * (1.0 + 4.0 * f64::EPSILON)) as usize + 1;
        let times_s: Vec<f64> = (0..looks).map(|look| look as f64 * scenario.output_step).collect();
        let reference_n = times_s.iter().map(|time_s| driven.reference.value(*time_s)).collect();
        let windows = driven.windows.clone();
        let band_samples = band_samples(&times_s, &windows);
        let marks = Marks::new(source, &project, &scenario);
        let columns = CampaignColumns {
            mark: marks.of_seed(seed),
            paths: ranges.iter().map(|range| range.path.clone()).collect(),
            times_s: band_samples
                .iter()
                .filter_map(|look| times_s.get(*look))
                .map(|time_s| plain(*time_s))
                .collect(),
            windows,
            open_loop: scenario.is_open_loop(),
            units: project.units,
        };
        let look = look(&bench);
        Ok(Plan {
            requirements: time_requirements(&project)?,
            project,
            scenario,
            place,
            bench,
            sensor,
            law,
            driven,
            columns,
            times_s,
            reference_n,
            band_samples,
            look,
            ranges,
            seed,
            marks,
        })
    }

    /// Varied numbers, in file order.
    pub fn ranges(&self) -> &[VariedRange] {
        &self.ranges
    }

    /// Name of the scenario.
    pub fn scenario(&self) -> &str {
        &self.scenario.name
    }

    /// Names of the other scenarios of the project.
    pub fn other_scenarios(&self) -> Vec<&str> {
        let others = self.project.scenarios.iter().enumerate().filter(|(place, _)| *place != self.place);
        others.map(|(_, scenario)| scenario.name.as_str()).collect()
    }

    /// Settling band, percent of a step.
    pub fn settling_band_percent(&self) -> f64 {
        self.scenario.settling_band_percent
    }

    /// Windows that are evaluated in each run.
    pub fn windows(&self) -> &[Window] {
        &self.columns.windows
    }

    /// True if a stated command drives the valve instead of a controller.
    pub fn is_open_loop(&self) -> bool {
        self.columns.open_loop
    }

    /// Motion of the rig.
    pub fn motion(&self) -> MotionKind {
        self.columns.units.motion
    }

    /// Units of display.
    pub fn units(&self) -> Units {
        self.columns.units
    }

    /// Seed of the random numbers.
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// Seed with which this campaign has these marks, if it is one of the first.
    pub(super) fn seed_of_mark(&self, mark: &str) -> Option<u32> {
        (0..COMPARED_SEEDS).find(|seed| self.marks.of_seed(*seed) == mark)
    }

    /// Bounds of an uncertain parameter of the linear model, if the project states them.
    pub fn bounds(&self, parameter: &str) -> Option<[f64; 2]> {
        let uncertain = self.project.uncertainty.iter().find(|uncertain| uncertain.name == parameter)?;
        Some([uncertain.minimum, uncertain.maximum])
    }

    /// Kind of the numbers over which the box of the family ranges.
    pub fn box_of_family(&self) -> FamilyBox {
        let uncertain = &self.project.uncertainty;
        if uncertain.iter().any(|one| one.name.contains('.')) {
            FamilyBox::Numbers
        } else if uncertain.is_empty() {
            FamilyBox::None
        } else {
            FamilyBox::LinearParameters
        }
    }

    /// Drawn numbers of the rig that leave the box for which the controller is judged; empty if the
    /// box has no numbers of the rig.
    pub fn beyond_box(&self) -> Vec<BeyondBox<'_>> {
        if self.box_of_family() != FamilyBox::Numbers {
            return vec![];
        }
        let region = self.project.family.as_ref().and_then(|family| family.operating_region.as_ref());
        let beyond = |range: &VariedRange| {
            let designed_for = self.bounds(&range.path);
            let is_direction = self.project.directions.iter().any(|direction| direction.name == range.path);
            let is_visited = range.path.starts_with("operating_point.") && region.is_some();
            let is_start = range.path.starts_with("start.");
            let is_within = designed_for.is_some_and(|[low, high]| {
                let room = SAME * (high - low).abs();
                range.minimum >= low - room && range.maximum <= high + room
            });
            !(is_direction || is_visited || is_start || is_within)
        };
        let beyond = self.ranges.iter().filter(|range| beyond(range));
        beyond.map(|range| BeyondBox { range, designed_for: self.bounds(&range.path) }).collect()
    }

    /// Numbers that are drawn for a run.
    pub fn draw(&self, run: u64) -> Draw {
        let mut stream = random::stream(u64::from(self.seed), run);
        let values = self.ranges.iter().map(|range| range.draw(&mut stream)).collect();
        let noisy = match &self.bench.control {
            Control::Sampled(sampled) => {
                let velocity = sampled.velocity_noise > 0.0 && sampled.deployed.feed_forward != 0.0;
                let pressure = sampled.pressure_noise > 0.0 && sampled.deployed.controller.reads_inner();
                sampled.noise > 0.0 || velocity || pressure
            }
            Control::Continuous(_) | Control::Open(_) => false,
        };
        let noise_seed = noisy.then(|| (random::uniform(&mut stream) * SEEDS) as u32);
        Draw { run, values, noise_seed }
    }

    /// A run as `path=value` settings of the project: `simulate` with them simulates the identical
    /// machine.
    pub fn settings(&self, draw: &Draw) -> Vec<String> {
        let drawn = self.drawn(draw);
        let mut settings: Vec<String> = Vec::new();
        for (path, value) in self.ranges.iter().zip(&draw.values).flat_map(|one| self.stated(one, &drawn)) {
            let path = match (path.strip_prefix("start."), path.rsplit_once('.')) {
                (Some(state), _) => format!("scenario.{}.start.{state}", self.place),
                // a table that may be written as an array: either form is replaced by an array
                (None, Some((table, _))) if EDGES.contains(&table) => {
                    let all = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"].map(|edge| {
                        drawn.as_ref().and_then(|project| project.number(&format!("{table}.{edge}")))
                    });
                    let texts =
                        all.map(|value| value.map_or("nan".to_string(), |value| format!("{value:e}")));
                    let setting = format!("{table}=[{}]", texts.join(", "));
                    if !settings.contains(&setting) {
                        settings.push(setting);
                    }
                    continue;
                }
                (None, _) => path,
            };
            let setting = format!("{path}={value:e}");
            if !settings.contains(&setting) {
                settings.push(setting);
            }
        }
        if let Some(seed) = draw.noise_seed {
            settings.push(format!("simulation.seed={seed}"));
        }
        settings.extend(self.feed_forward());
        settings
    }

    /// Numbers of the project that a drawn value determines: one number, or all that its direction
    /// moves.
    fn stated(&self, (range, value): (&VariedRange, &f64), drawn: &Option<Project>) -> Vec<(String, f64)> {
        let direction = self.project.directions.iter().find(|direction| direction.name == range.path);
        let Some(direction) = direction else { return vec![(range.path.clone(), *value)] };
        let value = |path: &str| drawn.as_ref().and_then(|drawn| drawn.number(path)).unwrap_or(f64::NAN);
        direction.changes.numbers.iter().map(|(path, _)| (path.clone(), value(path))).collect()
    }

    /// Gain of a feedforward that the project does not state: it is fixed beforehand, so that the
    /// drawn machine does not change the controller.
    fn feed_forward(&self) -> Option<String> {
        if self.is_open_loop() {
            return None;
        }
        let declared = self.project.controller.as_ref()?.load_velocity_feed_forward.as_ref()?;
        let gain = self.bench.feed_forward;
        declared.gain.is_none().then(|| format!("controller.load_velocity_feed_forward.gain={gain:e}"))
    }

    /// The project with the drawn numbers; those of the start are in the scenario.
    pub(super) fn drawn(&self, draw: &Draw) -> Option<Project> {
        let numbers: Vec<(&str, f64)> = self
            .ranges
            .iter()
            .zip(&draw.values)
            .filter(|(range, _)| !range.path.starts_with("start."))
            .map(|(range, value)| (range.path.as_str(), *value))
            .collect();
        with_controller_of(self.project.clone(), &self.bench.rig).with_numbers(&numbers)
    }

    /// The scenario with the drawn start.
    pub(super) fn drawn_scenario(&self, draw: &Draw) -> Scenario {
        let mut scenario = self.scenario.clone();
        for (range, value) in self.ranges.iter().zip(&draw.values) {
            if let (Some(state), Some(start)) = (range.path.strip_prefix("start."), &mut scenario.start) {
                start.set_number(state, *value);
            }
        }
        scenario
    }
}

/// Indices of recorded times, evenly over the scenario, and denser after the start of a window.
fn band_samples(times_s: &[f64], windows: &[Window]) -> Vec<usize> {
    let mut looks: Vec<usize> = (0..times_s.len()).step_by(times_s.len().div_ceil(BAND_TIMES)).collect();
    let each = (BAND_TIMES / windows.len().max(1)).max(1);
    for window in windows {
        let from = times_s.partition_point(|time_s| *time_s < window.start_s);
        let until = times_s.partition_point(|time_s| *time_s < window.end_s.min(window.start_s + EVENT_S));
        looks.extend((from..until).step_by((until.max(from + 1) - from).div_ceil(each)));
    }
    looks.push(times_s.len().saturating_sub(1));
    looks.sort_unstable();
    looks.dedup();
    looks
}

/// A time without the rounding error of its step, to twelve digits.
fn plain(time_s: f64) -> f64 {
    phea_dynamics::portable::rounded(time_s, 12)
}

/// Tables of the project that may be written as arrays.
const EDGES: [&str; 2] = ["valve.flow_coefficients", "valve.leakage_coefficients"];

/// Marks of everything that determines the rows: project with settings and catalogue, the files it
/// names, seed, and version.
#[derive(Clone, Debug)]
struct Marks {
    /// Hash of what precedes the seed.
    before: Sha256,
    /// Bytes of the files.
    files: Vec<Vec<u8>>,
}

impl Marks {
    fn new(source: &dyn Source, project: &Project, scenario: &Scenario) -> Marks {
        let mut before = Sha256::new();
        before.update(print(project));
        before.update(env!("CARGO_PKG_VERSION"));
        let files = files_of(scenario).map(|name| project.path_of(name));
        Marks { before, files: files.filter_map(|path| source.read(&path).ok()).collect() }
    }

    /// Mark of the rows with this seed.
    fn of_seed(&self, seed: u32) -> String {
        let mut hash = self.before.clone();
        hash.update(seed.to_le_bytes());
        self.files.iter().for_each(|bytes| hash.update(bytes));
        let text: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        text.chars().take(MARK_LENGTH).collect()
    }
}

/// Files that a scenario names: of the motion, the signals and the start.
fn files_of(scenario: &Scenario) -> impl Iterator<Item = &String> {
    let motion = scenario.load_motion.iter().filter_map(|motion| match &motion.shape {
        MotionShape::File { file } => Some(file),
        _ => None,
    });
    let signals = scenario.reference.iter().chain(&scenario.command).chain(&scenario.external_force);
    let signals = signals.chain(&scenario.setting_change);
    let signals = signals.filter_map(|signal| match signal {
        InputSignal::File { file, .. } => Some(file),
        _ => None,
    });
    motion.chain(signals).chain(scenario.start.iter().filter_map(|start| start.file.as_ref()))
}

/// Indices of the states on which force, command and limits of lines depend: only these are
/// observed.
fn look(bench: &ControlledMachine) -> Vec<usize> {
    let control = &bench.control;
    let variables =
        |count: usize, from: usize| -> Vec<Dependence> { (from..from + count).map(Dependence::on).collect() };
    let [states, inputs] = control.size();
    let (state, input) = (variables(states, 0), variables(inputs, states));
    let needed = match control {
        Control::Continuous(closed) => {
            let force = closed.plant().plant().measurement(&state, &input[1..]);
            [force, closed.signals::<f64, Dependence>(&state, &input).command]
        }
        Control::Sampled(sampled) => {
            let force = sampled.held.plant().plant().measurement(&state, &input[2..]);
            [force, Dependence::from(0.0)]
        }
        Control::Open(held) => {
            let force = held.plant().plant().measurement(&state, &input[2..]);
            [force, Dependence::from(0.0)]
        }
    };
    let of_lines = LineWatch::states(bench);
    (0..states).filter(|index| includes(&needed, *index) || of_lines.contains(index)).collect()
}

fn includes(needed: &[Dependence], index: usize) -> bool {
    needed.iter().any(|one| one.includes(index))
}
