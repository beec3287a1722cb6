//! One rig by phea and by CVODE.

use std::cell::Cell;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use phea_dynamics::controller::{Compensator, Controller, ControllerState, Element, SampledController};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    ClosedLoop, Course, HeldPlant, Input, Plant, Sampler, Settings, Status, System, Work, simulate,
};
use phea_hydraulics::machine::Machine;
use sundials::{CvodeError, Method, follow};

use crate::rig::{Control, DURATION_S, OUTPUT_STEP_S, Rig};

/// Of both references.
const EXACT: f64 = 1e-11;
/// Of phea's first run.
const FIRST_TOLERANCE: f64 = 1e-6;
/// Part of the peak by which the two references may differ before they count as separated.
const SEPARATED: f64 = 1e-5;
/// Evaluations after which CVODE is told that a rate is not a number.
const PATIENCE: u64 = 20_000_000;

/// What became of a rig.
#[derive(Default)]
pub(crate) struct Compared {
    /// Why CVODE has no reference, if it has none.
    pub(crate) without_reference: Option<String>,
    /// Rows that are compared, and whether that is not all because the references separate.
    pub(crate) rows: usize,
    pub(crate) separates: bool,
    /// Largest magnitude of the force over those rows, N.
    pub(crate) peak: f64,
    /// Whether the force still swings to and fro at the end, long after the last thing that happened.
    pub(crate) hunts: bool,
    /// How phea ended at each of its tolerances, with the largest error of the force as a part of the peak.
    pub(crate) ours: Vec<Ours>,
    /// The same model in C: largest difference as a part of the peak.
    pub(crate) twin: Option<f64>,
    /// Where phea was run again: error of CVODE at phea's first tolerance as a part of the peak.
    pub(crate) error_of_cvode: Option<f64>,
    /// Seconds of CVODE, with its stability limit, at the error of phea's first run.
    pub(crate) seconds_of_cvode: Option<f64>,
}

/// A run of phea.
#[derive(Clone, Copy)]
pub(crate) struct Ours {
    pub(crate) tolerance: f64,
    pub(crate) status: Status,
    pub(crate) error: f64,
    pub(crate) work: Work,
    pub(crate) seconds: f64,
}

/// A controller in its computer, its prefilter before the converter.
struct Digital<'a> {
    held: &'a HeldPlant<Machine>,
    controller: SampledController,
    state: ControllerState,
    delay_s: f64,
}

impl Sampler for Digital<'_> {
    fn sample_time_s(&self) -> f64 {
        self.controller.sample_time_s()
    }

    fn delay_s(&self) -> f64 {
        self.delay_s
    }

    fn command(&mut self, _time_s: f64, state: &[f64], inputs: &[f64]) -> f64 {
        let [reference, measurement] = self.held.sampled(state, inputs);
        self.controller.step(&mut self.state, reference, measurement).command
    }
}

/// A system whose rates cease to be numbers after so many evaluations: how a run on CVODE is ended.
struct Patient<'a, E> {
    system: &'a E,
    left: Cell<u64>,
}

impl<E: System<f64>> System<f64> for Patient<'_, E> {
    fn states(&self) -> usize {
        self.system.states()
    }

    fn inputs(&self) -> usize {
        self.system.inputs()
    }

    fn scales(&self) -> Vec<f64> {
        self.system.scales()
    }

    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        self.system.rates(state, inputs, rates);
        self.left.set(self.left.get().saturating_sub(1));
        if self.left.get() == 0 {
            rates.fill(T::from(f64::NAN));
        }
    }
}

impl Compared {
    /// How far the references are one, and what the force does there.
    fn look_at(&mut self, reference: &[f64], other: &[f64]) {
        let peak = |force: &[f64]| force.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let whole = peak(reference);
        let apart_at = reference.iter().zip(other).position(|(a, b)| (a - b).abs() > SEPARATED * whole);
        self.rows = apart_at.unwrap_or(reference.len());
        self.separates = apart_at.is_some();
        self.peak = peak(&reference[..self.rows]);
        self.hunts = hunts(reference, whole);
    }

    /// Largest error over the rows that are compared as a part of the peak; infinite if some are missing.
    fn part_of_peak(&self, reference: &[f64], found: &[f64]) -> f64 {
        if found.len() < self.rows {
            return f64::INFINITY;
        }
        apart(reference, found, self.rows) / self.peak
    }
}

/// Runs a rig both ways. `timed` asks for CVODE at the same error too, which takes longer.
pub(crate) fn compare(rig: &Rig, number: u64, program: &Path, timed: bool) -> Compared {
    let controller = controller(&rig.control);
    let [value, rate] = [Input::Value, Input::Rate].map(|input| input(rig.ground.clone()));
    let reference = Input::Value(rig.reference.clone());
    let course = |inputs| Course { duration_s: DURATION_S, output_step_s: OUTPUT_STEP_S, inputs };
    let mut compared = match rig.control.sample_time_s {
        None => {
            let closed = ClosedLoop::new(rig.machine, &controller, 0.0).expect("a proper controller");
            let sampler = || None::<Box<dyn Sampler>>;
            judge(rig, &closed, &course(vec![reference, value, rate]), &sampler, timed)
        }
        Some(sample_time_s) => {
            let prefilter = controller.prefilter.transfer_function().expect("a prefilter");
            let held = HeldPlant::new(rig.machine, &prefilter).expect("a proper prefilter");
            let digital = Controller { prefilter: Compensator::default(), ..controller };
            let digital = digital.sampled(sample_time_s).expect("a controller that can be sampled");
            let sampler = || {
                let (controller, state) = (digital.clone(), digital.at_rest());
                let delay_s = rig.control.delay_s;
                let sampler: Box<dyn Sampler + '_> =
                    Box::new(Digital { held: &held, controller, state, delay_s });
                Some(sampler)
            };
            judge(rig, &held, &course(vec![Input::Command, reference, value, rate]), &sampler, false)
        }
    };
    if let (Some(parameters), None) = (&rig.twin, &compared.0.without_reference) {
        let rows = compared.0.rows;
        compared.0.twin = Some(match twin(program, number, parameters) {
            Ok(force) => apart(&compared.1, &force, rows) / compared.0.peak,
            Err(problem) => {
                eprintln!("closed_loop.h: {problem}");
                f64::INFINITY
            }
        });
    }
    compared.0
}

fn controller(control: &Control) -> Controller {
    let integral = Element::ProportionalIntegral {
        proportional_gain: control.proportional,
        integral_gain: control.integral,
    };
    let filter = Element::ComplexPoles {
        natural_frequency: control.prefilter_frequency,
        damping_ratio: control.prefilter_damping,
    };
    Controller {
        feedback: Compensator::new(vec![integral]),
        prefilter: Compensator::new(vec![filter]),
        command_limit: Some(control.limit),
        anti_windup: control.anti_windup,
        ..Controller::default()
    }
}

type NewSampler<'a> = dyn Fn() -> Option<Box<dyn Sampler + 'a>> + 'a;

/// The comparison, and the force that CVODE finds.
fn judge<'a, E: System<f64> + Clone>(
    rig: &Rig,
    system: &'a E,
    course: &Course,
    sampler: &NewSampler<'a>,
    timed: bool,
) -> (Compared, Vec<f64>) {
    let mut start = rig.start.clone();
    start.resize(system.states(), 0.0);
    let force = |states: &[Vec<f64>]| -> Vec<f64> {
        let machine_states = Plant::<f64>::states(&rig.machine);
        states.iter().map(|state| rig.machine.measurement(&state[..machine_states], &[0.0; 2])).collect()
    };
    let by_cvode = |tolerance: f64, method: Method| {
        let patient = Patient { system, left: Cell::new(PATIENCE) };
        let mut sampler = sampler();
        let sampler = sampler.as_deref_mut().map(|sampler| -> &mut dyn Sampler { sampler });
        follow(&patient, &start, course, sampler, tolerance, method).map(|states| force(&states))
    };
    let references = [Method::BackwardDifferentiation, Method::Adams].map(|method| by_cvode(EXACT, method));
    let mut compared = Compared::default();
    let ours = |compared: &mut Compared, reference: &[f64], tolerance: f64| {
        let settings = Settings { tolerance, maximum_steps: 2_000_000, ..Settings::default() };
        let begun = Instant::now();
        let run = simulate(system, &start, course, sampler(), &settings, &mut |_| true);
        let seconds = begun.elapsed().as_secs_f64();
        let run = run.expect("a course that fits");
        let found = force(&run.trajectory.states);
        let error = compared.part_of_peak(reference, &found);
        compared.ours.push(Ours {
            tolerance,
            status: run.outcome.status,
            error,
            work: run.outcome.work,
            seconds,
        });
        error
    };
    let [reference, other] = match references {
        [Ok(first), Ok(second)] => [first, second],
        [Err(problem), _] | [_, Err(problem)] => {
            compared.without_reference = Some(problem.to_string());
            ours(&mut compared, &[], FIRST_TOLERANCE);
            return (compared, Vec::new());
        }
    };
    compared.look_at(&reference, &other);
    for tolerance in [FIRST_TOLERANCE, 1e-8, 1e-10] {
        if ours(&mut compared, &reference, tolerance) < crate::LARGEST_ERROR {
            break;
        }
    }
    beside_cvode(&mut compared, &reference, timed, &by_cvode);
    (compared, reference)
}

/// CVODE at phea's first tolerance where that was not enough, and its time at phea's error.
fn beside_cvode(
    compared: &mut Compared,
    reference: &[f64],
    timed: bool,
    by_cvode: &dyn Fn(f64, Method) -> Result<Vec<f64>, CvodeError>,
) {
    if compared.ours.len() > 1 {
        let found = by_cvode(FIRST_TOLERANCE, Method::StabilityLimit).ok();
        compared.error_of_cvode = found.map(|found| compared.part_of_peak(reference, &found));
    }
    if let (true, Some(first)) = (timed, compared.ours.first()) {
        compared.seconds_of_cvode = seconds_at(first.error, &mut |tolerance| {
            let begun = Instant::now();
            let found = by_cvode(tolerance, Method::StabilityLimit).ok()?;
            let seconds = begun.elapsed().as_secs_f64();
            Some((compared.part_of_peak(reference, &found), seconds))
        });
    }
}

/// Over the last fifth of its rows the force crosses the middle of its range at least four times, and the range is a twentieth of the
/// peak or more.
fn hunts(force: &[f64], peak: f64) -> bool {
    let last = &force[force.len() * 4 / 5..];
    let least = last.iter().copied().fold(f64::INFINITY, f64::min);
    let most = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let above = |force: &f64| *force > 0.5 * (least + most);
    let crossings = last.windows(2).filter(|pair| above(&pair[0]) != above(&pair[1])).count();
    crossings >= 4 && most - least >= 0.05 * peak
}

/// Seconds at an error, on a straight line between two runs in a plane of logarithms.
fn seconds_at(error: f64, run: &mut dyn FnMut(f64) -> Option<(f64, f64)>) -> Option<f64> {
    let mut before = None;
    for exponent in [-3.0, -4.0, -5.0, -6.0, -7.0, -8.0, -9.0] {
        let (found, seconds) = run(10.0_f64.powf(exponent))?;
        if found <= error {
            let (worse, fewer): (f64, f64) = before?;
            let part = (worse / error).ln() / (worse / found).ln();
            return Some(fewer * (seconds / fewer).powf(part));
        }
        before = Some((found, seconds));
    }
    None
}

/// Largest difference over the first rows.
fn apart(one: &[f64], other: &[f64], rows: usize) -> f64 {
    one.iter().zip(other).take(rows).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// The force of the same rig in C, by CVODE's Adams method at 1e-11.
fn twin(program: &Path, number: u64, parameters: &[String]) -> Result<Vec<f64>, String> {
    let output = program.with_extension(format!("{number}.csv"));
    let file = format!("output={}", output.display());
    let run = Command::new(program).args(["adams", "1e-11", &file]).args(parameters).output();
    let run = run.map_err(|error| error.to_string())?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let text = std::fs::read_to_string(&output).map_err(|error| error.to_string())?;
    std::fs::remove_file(&output).map_err(|error| error.to_string())?;
    let force = |line: &str| line.split(',').nth(1).and_then(|number| number.parse().ok());
    text.lines().skip(1).map(|line| force(line).ok_or_else(|| line.to_string())).collect()
}
