//! Limits on the step length that resolve growing modes.
//!
//! An L-stable method damps the modes that are fast compared with its step. This does no harm to a
//! decaying mode, but it would suppress a growing one, and no error estimate detects this while the
//! amplitude is small. So each step is limited by the modes of its own Jacobian.

mod amplifying;

pub(super) use amplifying::Amplifying;

use nalgebra::DMatrix;

use super::frozen::FrozenMode;
use super::rosenbrock::Rosenbrock;
use super::{Amplification, Lane};
use crate::linear::working_eigenvalues;
use crate::portable;

/// Place where friction acts: the one part of the damping that may change its sign from one step to
/// the next.
///
/// ```text
/// d(omega) = -df/dv - Re((df/dz) (dg/dv)/(i omega - dg/dz)),    f = dv/dt, g = dz/dt          v velocity, z its memory
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sliding {
    /// Index of the state that is a velocity.
    pub velocity: usize,
    /// Index of the state that remembers the motion, as bristles do.
    pub memory: Option<usize>,
}

/// Growing mode, and the longest step that resolves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GrowingMode {
    pub(super) step_s: f64,
    /// Magnitude of its eigenvalue, in rad/s.
    pub(super) frequency_rad_per_s: f64,
    /// Real part of its eigenvalue, in 1/s.
    pub(super) growth_per_s: f64,
}

/// Numerical damping of an undamped mode in a step of angle theta.
///
/// ```text
/// ln |R(i theta)| = -c theta^p
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct AmplitudeLost {
    /// Factor c.
    pub(super) factor: f64,
    /// Exponent p.
    pub(super) power: u32,
}

/// Allowed relative error of the growth of a resolved mode.
const GROWTH_ERROR: f64 = 0.02;
/// Largest angle of a growing mode in a step, in rad: beyond it, the numerical damping does not
/// follow a power law.
const LARGEST_ANGLE: f64 = 2.0;
/// Multiple of the previous step that no step exceeds while a mode grows; limits beyond it are not
/// computed.
const FAR: f64 = 2.0;
/// Fraction of the fastest magnitude above which modes count as fast.
const FAST: f64 = 0.25;
/// Growth relative to the frequency below which it is rounding.
const LEAST_GROWTH: f64 = 1e-10;
/// Fraction of the largest eigenvalue of a block that rounding may make of a zero eigenvalue, as
/// that of an integrator.
const ZERO: f64 = 1e-12;
/// Angle of a step in rad below which no mode's growth is off by more than 3e-6 of its frequency,
/// for any damping.
const SMALL_ANGLE: f64 = 0.8;
/// Ratio up to which a longer step is shortened to the small angle instead of evaluating the modes:
/// this costs less.
const NEARLY: f64 = 1.25;
/// Fraction of its last value below which the damping of friction requires a new evaluation of the
/// modes.
const FALLEN: f64 = 0.02;
/// Decay of a mode relative to its frequency below which delayed waves may make it grow, since the
/// Jacobian does not include them, and the growth that is then assumed.
const UNTOLD: [f64; 2] = [0.05, 1e-3];
/// Logarithm of a growth that leads beyond any linear mode.
const MOST_GROWN: f64 = 20.0;
/// Least decay that is followed, relative to the frequency.
const LEAST_FOLLOWED: f64 = 1e-3;
/// Steps between two evaluations of the modes of a small system: together they cost one or two
/// hundredths of its steps.
const LEAST_INTERVAL: u64 = 256;
/// Fraction of this interval while a mode grows.
const WHILE_GROWING: u64 = 8;
/// Fraction of a change of the growth that a step with older matrices misses, over the square of
/// the angle of the step in rad.
const MISSED: f64 = 0.08;
/// Error of the growth, in 1/s, below which no new matrices are required.
const LEAST_CHANGE: f64 = 0.1;
/// Fractions of its growth, or its decay, to which the least stable mode may fall before the modes
/// are evaluated again.
const LEFT: [f64; 2] = [0.25, 0.5];

#[derive(Clone, Copy, Debug)]
struct Mode {
    magnitude: f64,
    growth: f64,
}

impl Mode {
    /// Longest step that resolves this mode, with this growth, to [`GROWTH_ERROR`], or [`FAR`]
    /// times the present step if that is shorter; `None` if the mode does not grow.
    ///
    /// ```text
    /// c theta^p <= e zeta theta,        theta = h |lambda|, zeta = Re lambda/|lambda|
    /// ```
    fn bound(&self, growth: f64, lost: AmplitudeLost, taken_s: f64) -> Option<GrowingMode> {
        if growth.is_nan() || growth <= LEAST_GROWTH * self.magnitude {
            return None;
        }
        let growing =
            |step_s| GrowingMode { step_s, frequency_rad_per_s: self.magnitude, growth_per_s: growth };
        let far = FAR * taken_s * self.magnitude;
        let most = GROWTH_ERROR * growth / (lost.factor * self.magnitude);
        if far <= LARGEST_ANGLE && (1..lost.power).fold(1.0, |power, _| power * far) <= most {
            return Some(growing(FAR * taken_s));
        }
        let angle = portable::exp(portable::ln(most) / f64::from(lost.power - 1));
        Some(growing(angle.min(LARGEST_ANGLE) / self.magnitude))
    }
}

/// Known modes of the machine in one lane.
///
/// Eigenvalues cost several steps, so they are computed only when they may have changed: at fixed
/// numbers of steps for slow changes, and when the damping of friction changes its sign, falls to a
/// fraction of its value, or may have turned growth into decay. Between evaluations every mode is
/// shifted by half the change in friction damping, which is exact for a mode whose kinetic energy
/// is all in the velocity.
#[derive(Clone, Debug, Default)]
pub(super) struct GrowthWatch {
    /// Sets of states that influence each other: their modes are found separately.
    blocks: Vec<Vec<usize>>,
    /// Positions in the Jacobian of df/dv, and of df/dz, dg/dv, dg/dz.
    own: Option<usize>,
    memory: Option<[usize; 3]>,
    /// Amplitude lost to the method that takes the steps.
    lost: AmplitudeLost,
    /// True if waves return with a delay.
    delayed: bool,
    /// Modes that oscillate or grow.
    modes: Vec<Mode>,
    /// Largest growth of these modes, in 1/s.
    most: f64,
    /// Largest magnitude of these modes, in rad/s.
    fastest: f64,
    /// Step in which the fastest mode turns by the small angle, in s; zero if no mode oscillates,
    /// so that no step counts as small.
    small_s: f64,
    /// Largest growth of the fast modes, in 1/s.
    growth: f64,
    /// Least stable of the slower modes.
    slow: Option<FrozenMode>,
    /// Damping d at the last evaluation of the modes.
    damping: f64,
    /// Time of the last estimate of growth, and its value.
    before: Option<(f64, f64)>,
    /// Logarithm of the growth of the least stable mode that has not decayed since.
    grown: f64,
    /// Growth of the least stable fast mode by its eigenvalue, in 1/s.
    eigenvalue: f64,
    /// Growth of the present mode, and the largest so far.
    growing: Amplifying,
    /// Steps since the last evaluation of the modes; `None` before the first.
    age: Option<u64>,
    interval: u64,
}

impl GrowthWatch {
    pub(super) fn new<S: Lane>(
        sliding: Option<Sliding>,
        method: &Rosenbrock<S>,
        lost: AmplitudeLost,
        delayed: bool,
    ) -> GrowthWatch {
        let blocks = method.blocks();
        let watch = GrowthWatch { blocks, lost, delayed, interval: 1, ..GrowthWatch::default() };
        let Some(Sliding { velocity, memory }) = sliding else { return watch };
        let place = |row, column| method.place(row, column);
        let memory = memory.and_then(|memory| {
            Some([place(velocity, memory)?, place(memory, velocity)?, place(memory, memory)?])
        });
        let largest = watch.blocks.iter().map(Vec::len).max().unwrap_or_default() as u64;
        let interval = LEAST_INTERVAL.max(largest * largest);
        GrowthWatch { own: place(velocity, velocity), memory, interval, ..watch }
    }

    /// Resets all values for another machine in the lane.
    pub(super) fn forget(&mut self) {
        self.age = None;
        (self.before, self.grown) = (None, 0.0);
        self.growing = Amplifying::default();
    }

    /// Mode that limits a step of this length, from the Jacobian at its start, `steps` steps after
    /// the last call; `None` if none does.
    pub(super) fn bound<S: Lane>(
        &mut self,
        time_s: f64,
        step_s: f64,
        steps: u64,
        method: &Rosenbrock<S>,
        lane: usize,
    ) -> Option<GrowingMode> {
        let age = self.age.map_or(u64::MAX, |age| age.saturating_add(steps));
        self.age = Some(age);
        let damping = self.friction(method, lane);
        let interval =
            if self.growth_at(damping) > 0.0 { self.interval / WHILE_GROWING } else { self.interval };
        let nearly = step_s <= self.small_s || (damping < 0.0 && step_s <= NEARLY * self.small_s);
        if age >= interval || !(nearly || self.is_known_at(damping)) {
            self.sample(method, lane);
        }
        let growth_per_s = self.growth_at(damping);
        self.follow(time_s, growth_per_s);
        let eigenvalue = self.eigenvalue + 0.5 * (self.damping - damping);
        self.growing.advance(time_s, eigenvalue, self.fastest);
        if !self.is_known_at(damping) {
            let (small_s, frequency_rad_per_s) = (self.small_s, self.fastest);
            let small = GrowingMode { step_s: small_s, frequency_rad_per_s, growth_per_s };
            return (small_s > 0.0 && step_s > small_s).then_some(small);
        }
        let followed = (self.grown > 0.0).then(|| self.followed(growth_per_s, step_s)).flatten();
        let growing = self.shortest(0.5 * (self.damping.min(0.0) - damping.min(0.0)), step_s);
        let bounds = [growing, followed].into_iter().flatten();
        bounds.min_by(|one, other| one.step_s.total_cmp(&other.step_s))
    }

    /// Records how the least stable mode has grown since the last call: a growth counts until it
    /// has decayed by an equal amount.
    fn follow(&mut self, time_s: f64, growth_per_s: f64) {
        let (before_s, before) = self.before.replace((time_s, growth_per_s)).unwrap_or((time_s, 0.0));
        if time_s > before_s {
            let grown = self.grown + 0.5 * (before + growth_per_s) * (time_s - before_s);
            self.grown = grown.clamp(0.0, MOST_GROWN);
        }
    }

    /// Least stable of the slower modes, if the last call evaluated the modes; `Some(None)` if
    /// there is none.
    pub(super) fn slow_modes(&self) -> Option<Option<FrozenMode>> {
        (self.age == Some(0)).then_some(self.slow)
    }

    /// Frequency in rad/s below which modes are slower than those whose growth is followed.
    pub(super) fn slower(&self) -> f64 {
        if self.fastest > 0.0 { FAST * self.fastest } else { f64::INFINITY }
    }

    /// Largest amplification.
    pub(super) fn amplification(&self) -> Option<Amplification> {
        self.growing.largest()
    }

    /// Longest step that resolves the decay of an earlier growth.
    fn followed(&self, growth_per_s: f64, taken_s: f64) -> Option<GrowingMode> {
        let mode = Mode { magnitude: self.fastest, growth: growth_per_s };
        let bound = mode.bound(growth_per_s.abs().max(LEAST_FOLLOWED * self.fastest), self.lost, taken_s)?;
        Some(GrowingMode { growth_per_s, ..bound })
    }

    /// Growth of the least stable mode, in 1/s, under this damping of friction.
    fn growth_at(&self, damping: f64) -> f64 {
        self.growth + 0.5 * (self.damping - damping)
    }

    /// True if the modes at the last evaluation represent those under this damping of friction.
    fn is_known_at(&self, damping: f64) -> bool {
        let [growth, decay] = LEFT.map(|left| left * self.growth);
        let now = self.growth_at(damping);
        match (self.damping < 0.0, damping < 0.0) {
            (false, false) => damping >= FALLEN * self.damping,
            (false, true) => false,
            (true, false) => now < 0.0,
            (true, true) if self.growth > 0.0 => now >= growth,
            (true, true) => now <= decay,
        }
    }

    /// True if friction's damping has changed so far that a step of this length by older matrices
    /// is inaccurate: it misses a fraction of the additional growth that increases with the angle
    /// of the step.
    pub(super) fn has_left<S: Lane>(
        &self,
        other: f64,
        step_s: f64,
        method: &Rosenbrock<S>,
        lane: usize,
    ) -> bool {
        let angle = self.fastest * step_s;
        let missed = (MISSED * angle * angle).min(1.0);
        let change = 0.5 * (self.friction(method, lane) - other).abs();
        missed * change > (GROWTH_ERROR * self.growth.abs()).max(LEAST_CHANGE)
    }

    /// Damping d at the fastest mode.
    pub(super) fn friction<S: Lane>(&self, method: &Rosenbrock<S>, lane: usize) -> f64 {
        let value = |place: usize| method.jacobian_at(place, lane);
        let own = self.own.map_or(0.0, value);
        let memory = self.memory.map_or(0.0, |[there, back, own]| {
            let own = value(own);
            let squares = own * own + self.fastest * self.fastest;
            if squares > 0.0 { value(there) * value(back) * own / squares } else { 0.0 }
        });
        memory - own
    }

    /// Finds the modes anew.
    #[cold]
    fn sample<S: Lane>(&mut self, method: &Rosenbrock<S>, lane: usize) {
        let states = method.end.len();
        let mut jacobian = DMatrix::zeros(states, states);
        for (row, column, value) in method.jacobian_entries() {
            jacobian[(row, column)] = value.lane(lane);
        }
        self.age = Some(0);
        self.modes.clear();
        (self.fastest, self.most) = (0.0, f64::NEG_INFINITY);
        let mut eigenvalues: Vec<Mode> = Vec::new();
        let mut all: Vec<FrozenMode> = Vec::new();
        for block in &self.blocks {
            let order = block.len();
            let matrix = DMatrix::from_fn(order, order, |row, column| jacobian[(block[row], block[column])]);
            let values = working_eigenvalues(matrix).unwrap_or_default();
            let zero = ZERO * values.iter().map(|value| portable::magnitude(*value)).fold(0.0, f64::max);
            for value in values {
                let mode = Mode { magnitude: portable::magnitude(value), growth: value.re };
                all.push(FrozenMode { growth_per_s: mode.growth, frequency_rad_per_s: mode.magnitude });
                if mode.magnitude > zero && (value.im > 0.0 || (value.im == 0.0 && value.re > 0.0)) {
                    eigenvalues.push(mode);
                    let mode = self.told(mode, value.im);
                    self.fastest = self.fastest.max(mode.magnitude);
                    self.most = self.most.max(mode.growth);
                    self.modes.push(mode);
                }
            }
        }
        let growth = |modes: &[Mode]| {
            let fast = modes.iter().filter(|mode| mode.magnitude > FAST * self.fastest);
            fast.fold(f64::NEG_INFINITY, |most, mode| most.max(mode.growth))
        };
        (self.growth, self.eigenvalue) = (growth(&self.modes), growth(&eigenvalues));
        self.slow = FrozenMode::least_stable(&all, self.slower());
        self.small_s = if self.fastest > 0.0 { SMALL_ANGLE / self.fastest } else { 0.0 };
        self.damping = self.friction(method, lane);
    }

    /// Mode with the growth that is assumed for delayed waves.
    fn told(&self, mode: Mode, frequency: f64) -> Mode {
        let [decay, growth] = UNTOLD.map(|part| part * mode.magnitude);
        let unsure = self.delayed && frequency > 0.0 && mode.growth > -decay;
        Mode { growth: if unsure { mode.growth.max(growth) } else { mode.growth }, ..mode }
    }

    /// Mode that requires the shortest step, if friction has added this much to the growth of each.
    fn shortest(&self, added: f64, taken_s: f64) -> Option<GrowingMode> {
        if self.most + added <= 0.0 {
            return None;
        }
        let bounds = self.modes.iter().filter_map(|mode| mode.bound(mode.growth + added, self.lost, taken_s));
        bounds.min_by(|one, other| one.step_s.total_cmp(&other.step_s))
    }
}
