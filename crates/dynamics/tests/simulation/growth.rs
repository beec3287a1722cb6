//! Growing modes are detected, however small they are and however loose the tolerance.

use phea_dynamics::portable;
use phea_dynamics::random;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    Input, Method, Profile, Sampler, SimulationSettings, Sliding, Status, System,
};

use super::laws::{Law, Lawful, schedule, settings, simulate};

/// Two equal masses between three equal springs, each with negative damping; positions x_1, x_2 and
/// velocities over omega.
///
/// ```text
/// x_1'' = omega^2 (x_2 - 2 x_1) + 2 alpha x_1',    x_2'' = omega^2 (x_1 - 2 x_2) + 2 alpha x_2'
/// modes x_1 + x_2 and x_1 - x_2:    lambda = alpha +- i sqrt(omega^2 - alpha^2),  alpha +- i sqrt(3 omega^2 - alpha^2)
/// ```
#[derive(Clone)]
struct TwoMasses {
    omega: f64,
    alpha: f64,
}

impl Law for TwoMasses {
    const STATES: usize = 4;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        let (omega, growth) = (T::from(self.omega), T::from(2.0 * self.alpha));
        let two = T::from(2.0);
        rates[0] = omega * y[2];
        rates[1] = omega * y[3];
        rates[2] = omega * (y[1] - two * y[0]) + growth * y[2];
        rates[3] = omega * (y[0] - two * y[1]) + growth * y[3];
    }
}

impl TwoMasses {
    /// Logarithms of both modes' amplitudes, each of which grows by alpha per second.
    fn amplitudes(&self, y: &[f64]) -> [f64; 2] {
        [(1.0, 1.0), (-1.0, 3.0)].map(|(sign, square)| {
            let (position, velocity) = (y[0] + sign * y[1], self.omega * (y[2] + sign * y[3]));
            let turning = (square * self.omega * self.omega - self.alpha * self.alpha).sqrt();
            portable::ln(portable::hypot(position, (velocity - self.alpha * position) / turning))
        })
    }
}

/// Negative damping from 1e-9 to a tenth of the critical value, below the tolerance and above it.
#[test]
fn two_masses_grow_at_their_rate() {
    for (place, zeta) in [1e-9, 1e-7, 1e-5, 1e-3, 1e-2, 1e-1].into_iter().enumerate() {
        for (tolerance, method) in [
            (1e-3, Method::Rosenbrock),
            (1e-5, Method::Rosenbrock),
            (1e-7, Method::Rosenbrock),
            (1e-3, Method::DormandPrince),
        ] {
            for start in [1e-9, 1e-3] {
                let omega = 300.0 * (1.0 + place as f64);
                let law = TwoMasses { omega, alpha: zeta * omega };
                let duration_s = (30.0 / omega).max(2.0 / law.alpha.max(1.0)).min(300.0 / omega);
                let begin = [start, -0.3 * start, 0.2 * start, 0.1 * start];
                let system = Lawful(law.clone(), 1.0);
                let settings = settings(tolerance, method);
                let schedule = schedule(duration_s, duration_s, vec![]);
                let run = simulate(&system, &begin, &schedule, None, &settings, &mut |_| true).unwrap();
                assert_eq!(run.outcome.status, Status::Completed);
                let grown = run.outcome.amplification.unwrap();
                let expected = law.alpha * (grown.until_s - grown.from_s);
                assert!((grown.logarithm / expected - 1.0).abs() < 1e-3 && grown.from_s == 0.0, "{grown:?}");
                assert!(grown.until_s > 0.5 * duration_s, "{grown:?} of {duration_s} s");
                let (before, after) = (law.amplitudes(&begin), law.amplitudes(&run.outcome.end));
                for (before, after) in before.into_iter().zip(after) {
                    let rate = (after - before) / duration_s;
                    assert!(
                        (rate / law.alpha - 1.0).abs() < 0.05,
                        "{zeta:e} of critical at {tolerance:e}: {rate} instead of {} 1/s",
                        law.alpha
                    );
                }
            }
        }
    }
}

/// A mass on a spring whose friction feeds it increasingly with time; a command has no effect on
/// its speed here.
///
/// ```text
/// x' = omega y,   y' = -omega x + 2 a s y + w,   s' = 1        amplitude A exp(a (s^2 - s_0^2)/2), to the order of a/omega^2
/// ```
#[derive(Clone)]
struct Drifting {
    omega: f64,
    rate: f64,
}

impl System<f64> for Drifting {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; 3]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = T::from(self.omega) * y[1];
        rates[1] = T::from(2.0 * self.rate) * y[2] * y[1] - T::from(self.omega) * y[0] + w[0];
        rates[2] = T::from(1.0);
    }
    fn sliding(&self) -> Option<Sliding> {
        Some(Sliding { velocity: 1, memory: None })
    }
}

impl Drifting {
    /// Logarithm of the amplitude and s, after a given time.
    fn after(&self, duration_s: f64, from: f64, sample_time_s: Option<f64>) -> [f64; 2] {
        let sampler = sample_time_s.map(|period| Box::new(Nothing(period)) as Box<dyn Sampler>);
        let input = if sampler.is_some() { Input::Command } else { Input::Value(Profile::constant(0.0)) };
        let schedule = schedule(duration_s, duration_s, vec![input]);
        let settings = settings(1e-4, Method::Rosenbrock);
        let run = simulate(self, &[1e-9, 0.0, from], &schedule, sampler, &settings, &mut |_| true).unwrap();
        assert_eq!(run.outcome.status, Status::Completed);
        let [x, y, reached] = run.outcome.end[..] else { panic!("three states") };
        [portable::ln(portable::hypot(x, y)), reached]
    }

    /// Growth of the logarithm of the amplitude from one time to two seconds, over the expected
    /// growth.
    fn relative_growth(&self, since_s: f64, from: f64, sample_time_s: Option<f64>) -> f64 {
        let [before, after] = [since_s, 2.0].map(|time_s| self.after(time_s, from, sample_time_s));
        let expected = 0.5 * self.rate * (after[1] * after[1] - before[1] * before[1]);
        (after[0] - before[0]) / expected
    }
}

/// Sampler with a zero command.
struct Nothing(f64);

impl Sampler for Nothing {
    fn sample_time_s(&self) -> f64 {
        self.0
    }
    fn delay_s(&self) -> f64 {
        0.0
    }
    fn command(&mut self, _: f64, _: &[f64], _: &[f64]) -> f64 {
        0.0
    }
}

#[test]
fn friction_that_feeds_more_and_more_is_followed() {
    let system = Drifting { omega: 1300.0, rate: 8.0 };
    let grown = system.relative_growth(0.1, 0.02, None);
    assert!((grown - 1.0).abs() < 0.02, "{grown}");
}

/// Sampled machines use precomputed matrices from sample to sample: these are computed again when
/// friction has changed, so that a mode that decayed at first is seen to grow, for any angle of the
/// mode within a sample. (The first sample uses the method, which may damp the decaying mode.)
#[test]
fn samples_do_not_hide_growth() {
    for angle in [0.3, 1.3, 2.6, 6.5, 13.0, 39.0] {
        let system = Drifting { omega: 1300.0, rate: 8.0 };
        let grown = system.relative_growth(0.1, -0.3, Some(angle / system.omega));
        assert!((grown - 1.0).abs() < 0.05, "{angle} rad a sample: {grown}");
    }
}

/// A simulation too long for the oscillation that would have to be resolved ends, and identifies
/// the mode.
#[test]
fn unresolvable_growth_is_reported() {
    let law = TwoMasses { omega: 1e4, alpha: 20.0 };
    let settings = SimulationSettings { maximum_steps: 2_000, ..settings(1e-3, Method::Rosenbrock) };
    let schedule = schedule(1e3, 1e3, vec![]);
    let start = [1e-12, 0.0, 0.0, 0.0];
    let run = simulate(&Lawful(law, 1e6), &start, &schedule, None, &settings, &mut |_| true).unwrap();
    let Status::UnresolvedOscillation { time_s, frequency_rad_per_s, growth_per_s } = run.outcome.status
    else {
        panic!("{:?}", run.outcome.status)
    };
    assert!(time_s > 0.0 && time_s < 1.0);
    // the faster mode requires the shorter steps
    assert!((frequency_rad_per_s / (1e4 * 3.0_f64.sqrt()) - 1.0).abs() < 1e-6);
    assert!((growth_per_s / 20.0 - 1.0).abs() < 1e-6);
}

/// A decaying oscillation, a fast decay and an integrator of both, in randomly rotated coordinates:
/// one eigenvalue is zero within rounding, and none grows.
#[derive(Clone)]
struct Turned([[f64; 4]; 4]);

impl Turned {
    fn drawn(number: u64) -> Turned {
        let mut chance = random::stream(91, number);
        let mut draw = |most: f64| most * (2.0 * random::uniform(&mut chance) - 1.0);
        let (turning, decay) = (2e4 + draw(1e4), 300.0 + draw(200.0));
        let mut matrix = [[0.0; 4]; 4];
        (matrix[0][1], matrix[1][0], matrix[1][1]) = (turning, -turning, -decay);
        matrix[2][2] = -1e5 + draw(5e4);
        matrix[3][..3].fill_with(|| draw(1e3));
        for (one, other) in [(0, 3), (1, 3), (2, 3), (0, 2), (1, 2), (0, 1)] {
            let angle = draw(3.0);
            let [cosine, sine] = [portable::cos(angle), portable::sin(angle)];
            for row in &mut matrix {
                (row[one], row[other]) =
                    (cosine * row[one] - sine * row[other], sine * row[one] + cosine * row[other]);
            }
            let [first, second] = [matrix[one], matrix[other]];
            let turned =
                |by: [f64; 2]| [0, 1, 2, 3].map(|column| by[0] * first[column] + by[1] * second[column]);
            (matrix[one], matrix[other]) = (turned([cosine, -sine]), turned([sine, cosine]));
        }
        Turned(matrix)
    }
}

impl Law for Turned {
    const STATES: usize = 4;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        for (rate, row) in rates.iter_mut().zip(&self.0) {
            *rate = row.iter().zip(y).fold(T::from(0.0), |sum, (entry, value)| sum + value.times(*entry));
        }
    }
}

/// A run with too many steps and without growth has only that status.
#[test]
fn an_integrator_does_not_grow() {
    for number in 0..64 {
        let settings = SimulationSettings { maximum_steps: 6, ..settings(1e-9, Method::Rosenbrock) };
        let law = Lawful(Turned::drawn(number), 1.0);
        let schedule = schedule(10.0, 10.0, vec![]);
        let run = simulate(&law, &[1.0, -0.5, 0.3, 0.2], &schedule, None, &settings, &mut |_| true).unwrap();
        assert!(matches!(run.outcome.status, Status::TooManySteps { .. }), "{number}: {:?}", run.outcome);
    }
}

/// A mass that creeps against friction far above critical, without oscillation, until friction
/// decreases: the oscillation that then arises is resolved from its beginning.
///
/// ```text
/// x' = omega y,   y' = -omega x - d(s) y + w,   s' = 1,   d = 1e5 (1 - s) before s = 1 and -400 (s - 1) after it
/// ```
#[derive(Clone)]
struct Loosening;

impl System<f64> for Loosening {
    fn states(&self) -> usize {
        3
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0; 3]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        let left = T::from(1.0) - y[2];
        let damping = T::select(T::from(0.0).less_than(left), left.times(1e5), left.times(400.0));
        rates[0] = y[1].times(1300.0);
        rates[1] = w[0] - y[0].times(1300.0) - damping * y[1];
        rates[2] = T::from(1.0);
    }
    fn sliding(&self) -> Option<Sliding> {
        Some(Sliding { velocity: 1, memory: None })
    }
}

#[test]
fn an_oscillation_that_begins_late_is_detected() {
    let motion = Profile::sine(0.0, 1e-3, 7.0).unwrap();
    let schedule = schedule(2.0, 2.0, vec![Input::Value(motion)]);
    let begin = [0.0; 3];
    for tolerance in [1e-4, 1e-9] {
        let settings = settings(tolerance, Method::Rosenbrock);
        let run = simulate(&Loosening, &begin, &schedule, None, &settings, &mut |_| true).unwrap();
        assert_eq!(run.outcome.status, Status::Completed);
        let [x, y, _] = run.outcome.end[..] else { panic!("three states") };
        // growth by e^100, from the little that friction and rounding leave; the motion without
        // growth gives 1e-6
        let amplitude = portable::ln(portable::hypot(x, y));
        assert!(amplitude > 30.0, "{tolerance:e}: {amplitude}");
    }
}
