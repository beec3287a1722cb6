//! Runs that leave what their loop can control and do not come back.

use phea_dynamics::simulation::Profile;

use super::Window;

/// How a run diverges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Divergence {
    /// The command is at the end of the valve's range, or beyond, from a time on: over half of the
    /// last window and more.
    CommandBeyondRange {
        /// s.
        since_s: f64,
        /// V.
        range_v: f64,
    },
    /// The command swings from one end of the valve's range to the other and back while no input
    /// moves.
    CommandSwings {
        /// s.
        since_s: f64,
        /// V.
        range_v: f64,
        /// From one end to the other, until the end of the run.
        swings: u32,
    },
    /// At the end of the run the force is more than ten times the largest reference, and nothing
    /// else moves the load.
    ForceBeyondReference {
        /// When it is largest, s.
        since_s: f64,
        /// N.
        force_n: f64,
        /// N.
        reference_n: f64,
    },
}

impl Divergence {
    /// Whether the command swings.
    pub fn swings(&self) -> bool {
        matches!(self, Divergence::CommandSwings { .. })
    }

    /// When it begins or shows, s.
    pub fn since_s(&self) -> f64 {
        match self {
            Divergence::CommandBeyondRange { since_s, .. }
            | Divergence::CommandSwings { since_s, .. }
            | Divergence::ForceBeyondReference { since_s, .. } => *since_s,
        }
    }
}

/// Part of the last window over which a command at its end counts as there for good.
const FOR_GOOD: f64 = 0.5;
/// Part of the last window, at its end, over which swings are counted.
const LATE: f64 = 0.25;
/// Swings from one end to the other that are no transient.
const SWINGS: u32 = 4;
/// Part of that time which a swinging command spends at its ends.
const AT_ENDS: f64 = 0.05;
/// Part of the run, at its end, over which the force is compared.
const LAST: f64 = 0.1;
/// Force over the largest reference.
const BEYOND: f64 = 10.0;

/// The inputs that move what the controller does not.
pub(crate) struct OtherInputs<'a> {
    /// In N.
    pub(crate) reference: &'a Profile,
    /// Of the load: its ground, the force from outside, the setting of its accumulators.
    pub(crate) of_load: Vec<&'a Profile>,
}

/// Watches for a divergence.
#[derive(Clone, Debug)]
pub(super) struct DivergenceWatch {
    range_v: f64,
    end_s: f64,
    last_window_s: f64,
    before_s: f64,
    /// Since when the command is at an end.
    since_s: Option<f64>,
    /// The end at which it last was, late in the run, and how often that changed.
    side: Option<bool>,
    swings: u32,
    first_swing_s: f64,
    at_ends_s: f64,
    /// Largest magnitudes of the force at the end of the run with its time, and of the reference.
    force: [f64; 2],
    reference_n: f64,
}

impl DivergenceWatch {
    /// Of a run of this length under a command within a range in V.
    pub(super) fn new(range_v: f64, end_s: f64, windows: &[Window]) -> DivergenceWatch {
        DivergenceWatch {
            range_v,
            end_s,
            last_window_s: windows.last().map_or(0.0, |window| window.start_s),
            before_s: 0.0,
            since_s: None,
            side: None,
            swings: 0,
            first_swing_s: end_s,
            at_ends_s: 0.0,
            force: [0.0; 2],
            reference_n: 0.0,
        }
    }

    /// The beginning of a part of the last window at its end, s.
    fn late_s(&self, part: f64) -> f64 {
        self.end_s - part * (self.end_s - self.last_window_s)
    }

    /// Takes the end of a step: force, reference and command.
    pub(super) fn take(&mut self, time_s: f64, [force_n, reference_n, command_v]: [f64; 3]) {
        let step_s = time_s - self.before_s;
        let at_end = command_v.abs() >= self.range_v * (1.0 - 1e-9);
        if !at_end {
            self.since_s = None;
        } else {
            self.since_s.get_or_insert(self.before_s);
        }
        if at_end && time_s > self.late_s(LATE) {
            self.at_ends_s += step_s;
            let side = command_v > 0.0;
            if self.side.replace(side).is_some_and(|before| before != side) {
                self.swings += 1;
                self.first_swing_s = self.first_swing_s.min(time_s);
            }
        }
        self.reference_n = self.reference_n.max(reference_n.abs());
        if time_s > self.end_s * (1.0 - LAST) && force_n.abs() > self.force[0] {
            self.force = [force_n.abs(), time_s];
        }
        self.before_s = time_s;
    }

    /// How the run diverges, if it does.
    pub(super) fn found(&self, inputs: &OtherInputs<'_>) -> Option<Divergence> {
        let DivergenceWatch { range_v, end_s, .. } = *self;
        if self.before_s < end_s * (1.0 - 1e-9) {
            return None;
        }
        if let Some(since_s) = self.since_s.filter(|since_s| *since_s <= self.late_s(FOR_GOOD)) {
            return Some(Divergence::CommandBeyondRange { since_s, range_v });
        }
        let loads = |from_s: f64| inputs.of_load.iter().all(|profile| rests(profile, from_s, end_s));
        let late_s = self.late_s(LATE);
        let swings = self.swings >= SWINGS && self.at_ends_s >= AT_ENDS * (end_s - late_s);
        if swings && loads(late_s) && rests(inputs.reference, late_s, end_s) {
            let (since_s, swings) = (self.first_swing_s, self.swings);
            return Some(Divergence::CommandSwings { since_s, range_v, swings });
        }
        let ([force_n, since_s], reference_n) = (self.force, self.reference_n);
        let beyond = reference_n > 0.0 && force_n > BEYOND * reference_n;
        let diverged = Divergence::ForceBeyondReference { since_s, force_n, reference_n };
        (beyond && loads(end_s * (1.0 - LAST))).then_some(diverged)
    }
}

/// Whether a function of time is constant between two times.
fn rests(profile: &Profile, from_s: f64, until_s: f64) -> bool {
    let breaks = profile.breaks().into_iter().any(|time_s| from_s < time_s && time_s < until_s);
    !breaks && profile.piece(0.5 * (from_s + until_s)).constant().is_some()
}
