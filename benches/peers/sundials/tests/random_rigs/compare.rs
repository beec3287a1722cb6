//! A rig simulated by phea and by CVODE.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use phea_dynamics::controller::{Compensator, Controller, ControllerState, Element, SampledController};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{
    Amplification, CommandedPlant, Input, InputSchedule, Observer, Outcome, Plant, Sampler, Sensed, Status,
    StepCounts,
};
use phea_engineering::simulate::PassPlan;
use phea_hydraulics::machine::INDICATORS;
use phea_machine::{Commanded, Control as Loop};
use sundials::{CvodeError, Following, Kicks, Method, follow};

use crate::limited::Limited;
use crate::repeated::{Judged, Made, made};
use crate::rig::{Control, OUTPUT_STEP_S, Rig};
use crate::roughness::{Roughness, is_rough, roughest};

/// Tolerance of CVODE's runs.
const EXACT: f64 = 1e-11;
/// Tolerance of one more run, made if phea differs from them.
const FINEST: f64 = 1e-13;
/// Default tolerance of a project; the size of the errors that are allowed.
pub(crate) const TOLERANCE: f64 = 1e-6;
/// Tolerance of phea's run that is judged, unless another one is requested.
pub(crate) const JUDGED: f64 = 1e-7;
/// Errors added to the other reference, every hundredth of a second.
const KICKS: Kicks = Kicks { period_s: 1e-2, size: 1e-8, seed: 1 };
/// Allowed error of a solver between two kicks, in units of the tolerance.
pub(crate) const ERRORS: f64 = 10.0;
/// Growth of kicks at which the largest allowed errors of a solver reach the largest error of the
/// force.
const SEPARATED: f64 = crate::LARGEST_ERROR / (ERRORS * TOLERANCE);
/// Tolerance of CVODE, and the fraction of the peak to which it must agree with the other reference
/// for a rig to count as well posed.
const LOOSER: f64 = 1e-9;
const WELL_POSED: f64 = 1e-5;
/// Time around the row at which CVODE reaches a chamber without fluid, s.
const NEAR_S: f64 = 1e-3;

/// Evaluations after which CVODE receives a rate that is not a number.
const EVALUATION_LIMIT: u64 = 20_000_000;

/// Comparison of a rig.
#[derive(Default)]
pub(crate) struct Compared {
    /// Reason why CVODE has no reference; `None` if it has one.
    pub(crate) without_reference: Option<String>,
    /// Growth of kicks until each row: the difference of the force over its peak, divided by the
    /// kicks' size.
    pub(crate) growth: Vec<f64>,
    /// Rows before the trajectories separate.
    pub(crate) rows: usize,
    /// Largest magnitude of the force or of its reference, N.
    pub(crate) peak: f64,
    /// True if CVODE's results at two tolerances agree.
    pub(crate) well_posed: bool,
    /// True if CVODE's force rings anywhere, above the floor of [`Roughness`].
    pub(crate) rough: bool,
    /// Largest difference between phea's runs over all rows, as a fraction of the peak: the result
    /// of a check at a tenth of the tolerance.
    pub(crate) estimate: f64,
    /// True if the force still swings at the end, long after the last event.
    pub(crate) hunts: bool,
    /// Time at which CVODE left the model because a chamber had no fluid any more, s.
    emptied_s: Option<f64>,
    /// The run of phea that is judged.
    pub(crate) ours: Option<Ours>,
    /// The run at the default tolerance of a project.
    pub(crate) by_default: Option<Ours>,
    /// The run that is repeated if its errors may be visible.
    pub(crate) repeated: Option<Judged>,
    /// Largest difference from the model in C over those rows, as a fraction of the peak.
    pub(crate) twin: Option<f64>,
    /// Cost of CVODE at phea's error: with its stability limit, and by Adams' method.
    pub(crate) costs_of_cvode: [Option<Cost>; 2],
}

/// Cost of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    pub(crate) seconds: f64,
    /// Number of evaluations of the rates, those for derivatives included.
    pub(crate) evaluations: f64,
}

/// A run of phea.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ours {
    pub(crate) status: Status,
    /// Largest error of the force before trajectories separate, as a fraction of the peak.
    pub(crate) error: f64,
    /// Largest error of the force over all rows, as a fraction of the peak.
    pub(crate) error_of_all: f64,
    /// Largest error over the growth of kicks of the tolerance, over all rows after they separate.
    pub(crate) beyond: f64,
    /// Ringing after trajectories have separated; `None` if they do not.
    pub(crate) roughness: Option<Roughness>,
    /// The largest growth of errors; `None` if none grew.
    pub(crate) amplification: Option<Amplification>,
    pub(crate) work: StepCounts,
    pub(crate) seconds: f64,
}

impl Ours {
    /// A run whose errors are not known yet.
    pub(crate) fn new(outcome: &Outcome, seconds: f64) -> Ours {
        let Outcome { status, work, amplification, .. } = *outcome;
        let (error, error_of_all, beyond) = (0.0, 0.0, 0.0);
        Ours { status, error, error_of_all, beyond, roughness: None, amplification, work, seconds }
    }

    /// True if the run reports that errors of [`TOLERANCE`] may be visible.
    pub(crate) fn may_show_errors(&self) -> bool {
        self.amplification.is_some_and(|grown| grown.may_show_errors(TOLERANCE))
    }

    /// Requirement that the run fails; `None` if it satisfies all.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Ours { status, .. } if *status != Status::Completed => {
                Some(format!("{status:?}, where CVODE goes on"))
            }
            Ours { error, .. } if *error >= crate::LARGEST_ERROR => {
                Some(format!("an error of {error:.1e} of the peak"))
            }
            Ours { beyond, .. } if *beyond >= ERRORS => {
                Some(format!("an error {beyond:.1} times the growth of one of {TOLERANCE:e}"))
            }
            Ours { roughness, .. } => roughness.and_then(|roughness| roughness.fault()),
        }
    }
}

/// A digital controller, with its prefilter before the converter.
struct Digital<'a> {
    held: &'a Commanded,
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
        let [reference, measurement, _] = self.held.sampled(state, inputs);
        self.controller.step(&mut self.state, reference, measurement).command
    }
}

/// The states at every row.
pub(crate) struct Rows<'a> {
    pub(crate) wanted: Vec<usize>,
    pub(crate) states: &'a mut Vec<Vec<f64>>,
}

impl Observer for Rows<'_> {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn wants_inputs(&self) -> bool {
        false
    }

    fn observe(&mut self, _time_s: f64, states: &[f64], _inputs: &[f64]) {
        self.states.push(states.to_vec());
    }
}

impl Compared {
    /// Computes the growth of kicks, and the peak of force and reference.
    fn measure_growth(&mut self, final_reference: f64, reference: &[f64], kicked: &[f64]) {
        self.peak = reference.iter().fold(final_reference.abs(), |most: f64, force| most.max(force.abs()));
        let mut most = 0.0_f64;
        for (one, other) in reference.iter().zip(kicked) {
            most = most.max((one - other).abs() / self.peak / KICKS.size);
            self.growth.push(most);
        }
        self.rows = self.growth.partition_point(|growth| *growth <= SEPARATED);
        self.hunts = hunts(reference, self.peak);
        self.rough = is_rough(roughest(reference, OUTPUT_STEP_S), self.peak);
    }

    /// True if phea stopped at an emptied chamber, whose infinite pressure CVODE steps over.
    pub(crate) fn leaves_the_model(&self) -> bool {
        let end_s = self.ours.and_then(|ours| match ours.status {
            Status::StepTooSmall { time_s } | Status::NotFinite { time_s } => Some(time_s),
            _ => None,
        });
        let emptied = self.emptied_s.zip(end_s);
        emptied.is_some_and(|(emptied_s, end_s)| (end_s - emptied_s).abs() <= NEAR_S)
    }

    /// True if kicks grow so much that not all rows can be compared.
    pub(crate) fn separates(&self) -> bool {
        self.rows < self.growth.len()
    }

    /// Compares phea's runs, the judged one first, with CVODE's: the reference, the kicked one, and
    /// the one at a looser tolerance.
    fn take(&mut self, runs: &[(Ours, Vec<f64>); 2], references: &[&[f64]]) {
        let reference = references[0];
        let [judged, by_default] = runs;
        self.estimate = self.part_of_peak(&judged.1, &by_default.1, reference.len());
        let [ours, by_default] = runs.each_ref().map(|(ours, found)| Ours {
            error: self.part_of_peak(reference, found, self.rows),
            error_of_all: self.part_of_peak(reference, found, reference.len()),
            beyond: self.beyond(reference, found),
            roughness: Roughness::compared(found, references, self.rows, self.peak, OUTPUT_STEP_S),
            ..*ours
        });
        (self.ours, self.by_default) = (Some(ours), Some(by_default));
    }

    /// True if a run of phea fails a requirement.
    fn differs(&self) -> bool {
        [self.ours, self.by_default].into_iter().flatten().any(|ours| ours.fault().is_some())
    }

    /// Cost of CVODE at phea's error, for the methods of [`Compared::costs_of_cvode`].
    fn costs(&self, reference: &[f64], run: &Costing<'_>) -> [Option<Cost>; 2] {
        [Method::StabilityLimit, Method::Adams].map(|method| {
            cost_at(self.ours?.error, &|tolerance| {
                let (found, cost) = run(&Following::new(tolerance, method))?;
                Some((self.part_of_peak(reference, &found, self.rows), cost))
            })
        })
    }

    /// Largest error over the first rows as a fraction of the peak; infinite if some are missing.
    fn part_of_peak(&self, reference: &[f64], found: &[f64], rows: usize) -> f64 {
        if found.len() < rows {
            return f64::INFINITY;
        }
        apart(reference, found, rows) / self.peak
    }

    /// Largest error divided by the growth of kicks of the tolerance, over the rows after
    /// trajectories separate.
    fn beyond(&self, reference: &[f64], found: &[f64]) -> f64 {
        let rows = reference.iter().zip(found).zip(&self.growth).skip(self.rows);
        let parts = rows.map(|((one, other), growth)| (one - other).abs() / (self.peak * TOLERANCE * growth));
        parts.fold(0.0, f64::max)
    }
}

/// A run of CVODE: its force and its cost; `None` if it does not reach the end.
type Costing<'a> = dyn Fn(&Following) -> Option<(Vec<f64>, Cost)> + 'a;

/// Settings of a comparison.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    /// Tolerance of the run that is judged.
    pub(crate) judged: f64,
    /// True if CVODE is also run to an equal error, which takes longer.
    pub(crate) timed: bool,
    /// True for runs that are judged in the form of a project's, repeated if errors may be visible.
    pub(crate) repeated: bool,
}

/// Runs a rig by both methods.
pub(crate) fn compare(rig: &Rig, number: u64, program: &Path, manner: Manner) -> Compared {
    let controller = controller(&rig.control);
    let [value, rate] = [Input::Value, Input::Rate].map(|input| input(rig.ground.clone()));
    let reference = Input::Value(rig.reference.clone());
    let schedule =
        |inputs| InputSchedule { duration_s: rig.duration_s, output_step_s: OUTPUT_STEP_S, inputs };
    let sensed =
        Sensed::new(rig.machine, &TransferFunction::gain_only(1.0)).expect("a sensor without memory");
    let mut compared = match rig.control.sample_time_s {
        None => {
            let closed = CommandedPlant::in_loop(sensed, &controller, 0.0).expect("a proper controller");
            let closed = Loop::Continuous(Box::new(closed));
            let sampler = || None::<Box<dyn Sampler>>;
            judge(rig, &closed, &schedule(vec![reference, value, rate]), &sampler, manner)
        }
        Some(sample_time_s) => {
            let prefilter = controller.prefilter.transfer_function().expect("a prefilter");
            let held = CommandedPlant::on_hold(sensed, &prefilter).expect("a proper prefilter");
            let held = Loop::Open(Box::new(held));
            let digital = Controller { prefilter: Compensator::default(), ..controller };
            let digital = digital.sampled(sample_time_s).expect("a controller that can be sampled");
            let sampler = || {
                let (controller, state) = (digital.clone(), digital.at_rest());
                let delay_s = rig.control.delay_s;
                let sampler: Box<dyn Sampler + '_> =
                    Box::new(Digital { held: held.commanded(), controller, state, delay_s });
                Some(sampler)
            };
            judge(
                rig,
                &held,
                &schedule(vec![Input::Command, reference, value, rate]),
                &sampler,
                Manner { timed: false, ..manner },
            )
        }
    };
    if let (Some(parameters), None) = (&rig.twin, &compared.0.without_reference) {
        compared.0.twin = Some(match twin(program, number, parameters) {
            Ok(force) => compared.0.part_of_peak(&compared.1, &force, compared.0.rows),
            Err(problem) => {
                eprintln!("closed_loop.h: {problem}");
                f64::INFINITY
            }
        });
    }
    compared.0
}

/// The controller of a rig.
pub(crate) fn controller(control: &Control) -> Controller {
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

/// Makes a sampler for each run.
pub(crate) type NewSampler<'a> = dyn Fn() -> Option<Box<dyn Sampler + 'a>> + 'a;

/// Returns the comparison, and CVODE's force.
fn judge<'a>(
    rig: &Rig,
    system: &'a Loop,
    schedule: &InputSchedule,
    sampler: &NewSampler<'a>,
    manner: Manner,
) -> (Compared, Vec<f64>) {
    let start = rig.beginning(system.size()[0]);
    let force = |states: &[Vec<f64>]| force_of(rig, states);
    let counted = |following: &Following| {
        let limited = Limited::new(system, EVALUATION_LIMIT);
        let mut sampler = sampler();
        let sampler = sampler.as_deref_mut().map(|sampler| -> &mut dyn Sampler { sampler });
        let states = follow(&limited, &start, schedule, sampler, following)?;
        Ok::<_, CvodeError>((states, limited.cost()))
    };
    let by_cvode = |following: &Following| counted(following).map(|(states, _)| states);
    let made_by_phea = |plan: PassPlan| made(rig, system, schedule, sampler, plan);
    let by_phea = |tolerance: f64| {
        let Made { ours, force } = made_by_phea(PassPlan { tolerance, moved: false });
        (ours, force)
    };
    let runs = [manner.judged, TOLERANCE].map(by_phea);
    let mut compared = Compared::default();
    let at = |tolerance: f64| Following::new(tolerance, Method::BackwardDifferentiation);
    let kicked = Following { kicks: Some(KICKS), ..Following::new(EXACT, Method::Adams) };
    let [reference, kicked] = match (by_cvode(&at(EXACT)), by_cvode(&kicked)) {
        (Ok(states), Ok(kicked)) => {
            let (reference, kicked) = (force(&states), force(&kicked));
            compared.measure_growth(rig.reference.value(rig.duration_s), &reference, &kicked);
            compared.emptied_s = emptied(rig, &states);
            [reference, kicked]
        }
        (Err(problem), _) | (_, Err(problem)) => {
            compared.without_reference = Some(problem.to_string());
            compared.ours = Some(runs[0].0);
            return (compared, Vec::new());
        }
    };
    let forces_at = |tolerance: f64| by_cvode(&at(tolerance)).ok().map(|states| force(&states));
    let looser = forces_at(LOOSER);
    let apart = |looser: &Vec<f64>| compared.part_of_peak(&reference, looser, reference.len());
    compared.well_posed = looser.as_ref().is_some_and(|looser| apart(looser) <= WELL_POSED);
    let mut references = vec![&reference[..], &kicked, looser.as_deref().unwrap_or(&reference)];
    compared.take(&runs, &references);
    // decides if the ringing comes from CVODE's own errors
    let finest = (compared.differs() || manner.repeated).then(|| forces_at(FINEST)).flatten();
    if manner.repeated {
        let truths = [finest.as_deref().unwrap_or(&reference), &reference];
        compared.repeated = Some(Judged::of(rig, &made_by_phea, truths));
    }
    if let Some(finest) = finest.as_ref().filter(|_| compared.differs()) {
        references.push(finest);
        compared.take(&runs, &references);
    }
    if manner.timed {
        compared.costs_of_cvode = compared.costs(&reference, &|following| {
            let begun = Instant::now();
            let (states, [evaluations, _]) = counted(following).ok()?;
            let seconds = begun.elapsed().as_secs_f64();
            Some((force(&states), Cost { seconds, evaluations: evaluations as f64 }))
        });
    }
    (compared, reference)
}

/// The force in these states.
pub(crate) fn force_of(rig: &Rig, states: &[Vec<f64>]) -> Vec<f64> {
    let machine_states = Plant::<f64>::states(&rig.machine);
    states.iter().map(|state| rig.machine.measurement(&state[..machine_states], &[0.0; 2])).collect()
}

/// Time of the first row at which a chamber has no fluid.
fn emptied(rig: &Rig, states: &[Vec<f64>]) -> Option<f64> {
    let count = Plant::<f64>::states(&rig.machine);
    let empty = |row: usize, state: &[f64]| {
        let time_s = row as f64 * OUTPUT_STEP_S;
        let mut indicators = [0.0; INDICATORS.len()];
        rig.machine.indicate(state, &[rig.ground.value(time_s), rig.ground.rate(time_s)], &mut indicators);
        INDICATORS.iter().zip(indicators).any(|(name, sign)| name.starts_with("empty") && sign < 0.0)
    };
    let row = states.iter().enumerate().position(|(row, state)| empty(row, &state[..count]))?;
    Some(row as f64 * OUTPUT_STEP_S)
}

/// Hunting: over the last fifth of its rows the force crosses the middle of its range at least four
/// times, and the range is a twentieth of the peak or more.
fn hunts(force: &[f64], peak: f64) -> bool {
    let last = &force[force.len() * 4 / 5..];
    let least = last.iter().copied().fold(f64::INFINITY, f64::min);
    let most = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let above = |force: &f64| *force > 0.5 * (least + most);
    let crossings = last.windows(2).filter(|pair| above(&pair[0]) != above(&pair[1])).count();
    crossings >= 4 && most - least >= 0.05 * peak
}

/// Cost at a given error, on a straight line between two runs in logarithmic coordinates.
fn cost_at(error: f64, run: &dyn Fn(f64) -> Option<(f64, Cost)>) -> Option<Cost> {
    let mut before: Option<(f64, Cost)> = None;
    for exponent in [-3.0, -4.0, -5.0, -6.0, -7.0, -8.0, -9.0] {
        let (found, cost) = run(10.0_f64.powf(exponent))?;
        if found <= error {
            let (worse, fewer) = before?;
            let part = (worse / error).ln() / (worse / found).ln();
            let between = |fewer: f64, more: f64| fewer * (more / fewer).powf(part);
            return Some(Cost {
                seconds: between(fewer.seconds, cost.seconds),
                evaluations: between(fewer.evaluations, cost.evaluations),
            });
        }
        before = Some((found, cost));
    }
    None
}

/// Largest difference over the first rows.
fn apart(one: &[f64], other: &[f64], rows: usize) -> f64 {
    one.iter().zip(other).take(rows).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// The force of the rig's equivalent in C, by CVODE's Adams method at 1e-11.
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
