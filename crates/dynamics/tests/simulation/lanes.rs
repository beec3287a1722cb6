//! Machines in parallel lanes: each result is bit-identical to that of the machine simulated
//! separately.

use phea_dynamics::scalar::{Dependence, Dual, LANES, Lanes, Scalar};
use phea_dynamics::simulation::{
    Event, Input, InputSchedule, Lane, Method, Observer, Outcome, Profile, Queue, Sampler, SimulationError,
    SimulationSettings, Sliding, Status, System, Task, drive,
};

use super::laws::settings;

/// A stiff pair, a stop, a limit, a command and, optionally, a late wave: states x, v, z; inputs w,
/// u and the wave of x.
///
/// ```text
/// x' = v,   v' = -k x - k (x - 1/20)+ + f v/(1 + v^2) - |v| v + w + u,   z' = r (x - z) + sqrt(|w| + 1/10) - x(t - T)/2
/// ```
#[derive(Clone)]
struct Machine<S> {
    stiffness: S,
    rate: S,
    delay_s: S,
    /// Force f that a falling friction feeds.
    feeding: S,
    waves: usize,
}

impl<S: Lane> System<S> for Machine<S> {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        2 + self.waves
    }
    fn scales(&self) -> Vec<S> {
        vec![S::from(1.0), self.stiffness.sqrt(), S::from(1.0)]
    }
    fn rates<T: Scalar + From<S>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        let fed = T::from(self.feeding) * y[1] / (T::from(1.0) + y[1].squared());
        let stopped = y[0] + (y[0] - T::from(0.05)).maximum(T::from(0.0));
        rates[1] = fed - T::from(self.stiffness) * stopped - y[1].abs() * y[1] + w[0] + w[1];
        rates[2] = T::from(self.rate) * (y[0] - y[2]) + (w[0].abs() + T::from(0.1)).sqrt();
        for wave in &w[2..] {
            rates[2] = rates[2] - wave.times(0.5);
        }
    }
    fn delays(&self) -> Vec<S> {
        vec![self.delay_s; self.waves]
    }
    fn outgoing<T: Scalar + From<S>>(&self, y: &[T], _: &[T], waves: &mut [T]) {
        waves.fill(y[0]);
    }
    fn sliding(&self) -> Option<Sliding> {
        Some(Sliding { velocity: 1, memory: None })
    }
    fn indicators(&self) -> usize {
        1
    }
    fn indicate<T: Scalar + From<S>>(&self, y: &[T], _: &[T], indicators: &mut [T]) {
        indicators[0] = y[0] - T::from(0.05);
    }
    fn kinks(&self) -> usize {
        2
    }
    fn mark<T: Scalar + From<S>>(&self, y: &[T], _: &[T], marks: &mut [T]) {
        marks.copy_from_slice(&[y[1], y[0] - T::from(0.05)]);
    }
}

#[derive(Clone)]
struct Case {
    parameters: [f64; 4],
    start: [f64; 3],
    schedule: InputSchedule,
    sample_time_s: Option<f64>,
    /// Largest addition to each command.
    noise: f64,
}

/// Command, disturbed by a pseudo-random sequence.
struct Holding {
    sample_time_s: f64,
    noise: f64,
    number: f64,
}

impl Sampler for Holding {
    fn sample_time_s(&self) -> f64 {
        self.sample_time_s
    }
    fn delay_s(&self) -> f64 {
        0.4 * self.sample_time_s
    }
    fn command(&mut self, _: f64, state: &[f64], _: &[f64]) -> f64 {
        self.number = 3.9 * self.number * (1.0 - self.number);
        self.noise * (2.0 * self.number - 1.0) - 3.0 * state[0]
    }
}

/// Status, events, work and the bits of the last state.
type DrivenOutcome = (Status, Vec<Event>, [u64; 3], Vec<u64>);

/// Observations, to the bit.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    bits: Vec<u64>,
    outcome: Option<DrivenOutcome>,
}

struct Notes(Seen, &'static [usize]);

impl Observer for Notes {
    fn wanted(&self) -> &[usize] {
        self.1
    }
    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        self.0.bits.extend([time_s].iter().chain(states).chain(inputs).map(|value| value.to_bits()));
    }
}

/// Cases in some order; each result is returned to its position.
struct Line<'a> {
    cases: &'a [Case],
    order: Vec<usize>,
    in_lane: Vec<usize>,
    results: Vec<Seen>,
}

impl<'a, S: Lane> Queue<'a, Machine<S>> for Line<'a> {
    type Observer = Notes;

    fn next(&mut self, machine: &mut Machine<S>, lane: usize) -> Option<Task<'a, Notes>> {
        let index = self.order.pop()?;
        let case = &self.cases[index];
        let [stiffness, rate, delay_s, feeding] = case.parameters;
        machine.stiffness.set_lane(lane, stiffness);
        machine.rate.set_lane(lane, rate);
        machine.delay_s.set_lane(lane, delay_s);
        machine.feeding.set_lane(lane, feeding);
        self.in_lane[lane] = index;
        let sampler = case.sample_time_s.map(|sample_time_s| {
            Box::new(Holding { sample_time_s, noise: case.noise, number: 0.4 }) as Box<dyn Sampler>
        });
        let (start, schedule) = (case.start.to_vec(), &case.schedule);
        Some(Task { start, schedule, sampler, observer: Notes(Seen::default(), &[0, 2, 1]) })
    }

    fn done(&mut self, lane: usize, outcome: Outcome, observer: Notes) {
        let work = [outcome.work.steps, outcome.work.rejected, outcome.work.evaluations];
        let end = outcome.end.iter().map(|value| value.to_bits()).collect();
        let index = self.in_lane[lane];
        assert!(self.results[index].outcome.is_none(), "done twice");
        self.results[index] =
            Seen { outcome: Some((outcome.status, outcome.events, work, end)), ..observer.0 };
    }

    fn continues(&mut self, _: usize, _: f64) -> bool {
        true
    }
}

fn cases() -> Vec<Case> {
    let motions = [
        Profile::constant(0.3),
        Profile::sine(0.2, 1.0, 9.0).unwrap(),
        Profile::smooth_step(0.5, 0.2, 2.0).unwrap(),
        Profile::steps(0.0, &[(0.25, 1.0), (0.75, -1.0)]).unwrap(),
        Profile::first_order(0.1, 0.05, 1.0).unwrap(),
        Profile::constant(0.0),
    ];
    (0..11)
        .map(|index: usize| {
            let part = index as f64;
            Case {
                parameters: [
                    4.0 + 7.0 * part,
                    10.0 * (1.0 + part * part * part),
                    0.03 + 0.01 * part,
                    [0.0, 3.0][index / 2 % 2],
                ],
                start: [0.1 * (part - 5.0), 0.0, if index % 4 == 3 { 1e3 } else { 0.0 }],
                schedule: InputSchedule {
                    duration_s: 1.0 + 0.1 * part,
                    output_step_s: 0.05,
                    inputs: vec![Input::Value(motions[index % 6].clone()), Input::Command],
                },
                sample_time_s: (index % 3 == 1).then_some(0.02),
                noise: 0.0,
            }
        })
        .collect()
}

fn driven<S>(cases: &[Case], waves: usize, order: Vec<usize>, settings: &SimulationSettings) -> Vec<Seen>
where
    S: Lane,
    Dependence: From<S>,
    Dual<6, S>: From<f64> + From<S>,
{
    let one = S::from(1.0);
    let mut machine = Machine { stiffness: one, rate: one, delay_s: one, feeding: one, waves };
    let mut line =
        Line { cases, order, in_lane: vec![0; S::COUNT], results: vec![Seen::default(); cases.len()] };
    drive(&mut machine, &mut line, settings).unwrap();
    line.results
}

#[test]
fn neighbours_make_no_difference() {
    neighbours(&cases(), 1);
}

/// Samples are connected by precomputed matrices if there are no waves and few rows.
#[test]
fn neighbours_make_no_difference_from_sample_to_sample() {
    let mut cases = cases();
    for case in &mut cases {
        case.sample_time_s = Some(0.002);
        case.schedule.output_step_s = 0.5;
        case.schedule.duration_s += 1.0;
    }
    neighbours(&cases, 0);
}

/// Precomputed matrices are sometimes rejected if commands jump at every sample, while neighbours
/// repeat steps.
#[test]
fn neighbours_make_no_difference_where_commands_jump() {
    let mut cases = cases();
    for (index, case) in cases.iter_mut().enumerate() {
        case.sample_time_s = Some([0.02, 0.015, 0.03][index % 3]);
        case.noise = [30.0, 3.0, 300.0, 0.3][index % 4];
        case.schedule.output_step_s = 0.5;
        case.schedule.duration_s += 1.0;
    }
    neighbours(&cases, 0);
}

fn neighbours(cases: &[Case], waves: usize) {
    let order: Vec<usize> = (0..cases.len()).collect();
    let other: Vec<usize> = (0..cases.len()).map(|index| (4 * index + 3) % cases.len()).collect();
    for method in [Method::Rosenbrock, Method::DormandPrince] {
        let settings = settings(1e-6, method);
        let mut separate = vec![Seen::default(); cases.len()];
        for (index, place) in separate.iter_mut().enumerate() {
            *place = driven::<f64>(cases, waves, vec![index], &settings)[index].clone();
            let outcome = place.outcome.as_ref().unwrap();
            assert_eq!(outcome.0, Status::Completed);
            assert!(place.bits.len() >= 6 * 4 && !outcome.3.is_empty());
        }
        assert!(
            separate.iter().any(|seen| seen.outcome.as_ref().is_some_and(|outcome| !outcome.1.is_empty()))
        );
        for order in [order.clone(), other.clone()] {
            let together = [
                driven::<f64>(cases, waves, order.clone(), &settings),
                driven::<Lanes>(cases, waves, order, &settings),
            ];
            for (results, lanes) in together.iter().zip([1, LANES]) {
                for (index, (seen, separate)) in results.iter().zip(&separate).enumerate() {
                    assert!(seen == separate, "{method:?}, {lanes} lanes, case {index}");
                }
            }
        }
    }
}

/// A neighbour that becomes infinite does not affect the others.
#[test]
fn a_failing_neighbour_does_not_affect_the_others() {
    let mut cases = cases();
    let good = cases.clone();
    for index in [1, 4, 9] {
        cases[index].parameters[1] = -2e3;
    }
    let order: Vec<usize> = (0..cases.len()).collect();
    let settings = SimulationSettings { maximum_steps: 5_000, ..SimulationSettings::default() };
    let mixed = driven::<Lanes>(&cases, 1, order.clone(), &settings);
    let separate = driven::<f64>(&good, 1, order, &settings);
    for (index, (seen, separate)) in mixed.iter().zip(&separate).enumerate() {
        let status = seen.outcome.as_ref().unwrap().0;
        if [1, 4, 9].contains(&index) {
            assert!(status != Status::Completed, "{index}: {status:?}");
        } else {
            assert!(seen == separate, "{index}");
        }
    }
}

/// Equation y' = sqrt(w), whose derivative at w = 0 is infinite: harmless while w does not change,
/// whatever its neighbours do.
#[derive(Clone)]
struct Root;

impl<S: Lane> System<S> for Root {
    fn states(&self) -> usize {
        1
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<S> {
        vec![S::from(1.0)]
    }
    fn rates<T: Scalar + From<S>>(&self, _: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0].sqrt();
    }
}

/// Input schedules in order, and the status of each.
struct Ends<'a>(Vec<&'a InputSchedule>, Vec<Status>, &'static [usize]);

impl<'a, E> Queue<'a, E> for Ends<'a> {
    type Observer = Notes;

    fn next(&mut self, _: &mut E, _: usize) -> Option<Task<'a, Notes>> {
        let schedule = self.0.pop()?;
        Some(Task { start: vec![0.0], schedule, sampler: None, observer: Notes(Seen::default(), self.2) })
    }
    fn done(&mut self, _: usize, outcome: Outcome, _: Notes) {
        self.1.push(outcome.status);
    }
    fn continues(&mut self, _: usize, _: f64) -> bool {
        true
    }
}

#[test]
fn a_lane_at_rest_is_not_moved_by_a_neighbour() {
    let schedule =
        |profile| InputSchedule { duration_s: 1.0, output_step_s: 1.0, inputs: vec![Input::Value(profile)] };
    let (still, moving) =
        (schedule(Profile::constant(0.0)), schedule(Profile::table(&[0.0, 1.0], &[1.0, 4.0]).unwrap()));
    let mut ends = Ends(vec![&still, &moving], Vec::new(), &[0]);
    drive::<Lanes, _, _>(&mut Root, &mut ends, &SimulationSettings::default()).unwrap();
    assert_eq!(ends.1, [Status::Completed; 2]);
}

#[test]
fn an_absent_state_is_not_evaluated() {
    let schedule = InputSchedule {
        duration_s: 1.0,
        output_step_s: 1.0,
        inputs: vec![Input::Value(Profile::constant(1.0))],
    };
    let mut ends = Ends(vec![&schedule], Vec::new(), &[0, 1]);
    let result = drive::<f64, _, _>(&mut Root, &mut ends, &SimulationSettings::default());
    assert!(matches!(result, Err(SimulationError::Count { found: 2, expected: 1, .. })), "{result:?}");
}

/// A stop request stops all lanes: no further machine begins, and each running one is returned.
#[test]
fn stopping_stops_all() {
    struct Stopped<'a>(Line<'a>, usize);
    impl<'a> Queue<'a, Machine<Lanes>> for Stopped<'a> {
        type Observer = Notes;
        fn next(&mut self, machine: &mut Machine<Lanes>, lane: usize) -> Option<Task<'a, Notes>> {
            self.0.next(machine, lane)
        }
        fn done(&mut self, lane: usize, outcome: Outcome, observer: Notes) {
            Queue::<Machine<Lanes>>::done(&mut self.0, lane, outcome, observer);
        }
        fn continues(&mut self, _: usize, _: f64) -> bool {
            self.1 += 1;
            self.1 < 30
        }
    }
    let cases = cases();
    let order = (0..cases.len()).collect();
    let line =
        Line { cases: &cases, order, in_lane: vec![0; LANES], results: vec![Seen::default(); cases.len()] };
    let one = Lanes::from(1.0);
    let mut machine = Machine { stiffness: one, rate: one, delay_s: one, feeding: one, waves: 1 };
    let mut queue = Stopped(line, 0);
    drive(&mut machine, &mut queue, &SimulationSettings::default()).unwrap();
    let statuses: Vec<Status> =
        queue.0.results.iter().filter_map(|seen| seen.outcome.as_ref()).map(|outcome| outcome.0).collect();
    assert_eq!(statuses.len(), LANES);
    assert!(statuses.iter().all(|status| matches!(status, Status::Cancelled { time_s } if *time_s < 1.0)));
    assert_eq!(queue.0.order.len(), 7);
}
