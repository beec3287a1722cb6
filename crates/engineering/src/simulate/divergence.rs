//! Detection of runs that leave the range in which their loop can control, and do not return.

use phea_dynamics::simulation::Profile;

use super::Window;

/// Divergence of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Divergence {
    /// The command is at the end of the valve's range, or beyond, from a time on: over at least
    /// half of the last window.
    CommandBeyondRange {
        /// Start of this time, s.
        since_s: f64,
        /// Range of the command, V.
        range_v: f64,
    },
    /// The command swings from one end of the valve's range to the other and back while no input
    /// moves.
    CommandSwings {
        /// Start of the swings, s.
        since_s: f64,
        /// Range of the command, V.
        range_v: f64,
        /// Number of swings from one end to the other, until the end of the run.
        swings: u32,
    },
    /// The force at the end of the run is more than ten times the largest reference, and nothing
    /// else moves the load.
    ForceBeyondReference {
        /// Time of the largest force, s.
        since_s: f64,
        /// Force, N.
        force_n: f64,
        /// Largest reference, N.
        reference_n: f64,
    },
}

impl Divergence {
    /// True if the command swings.
    pub fn swings(&self) -> bool {
        matches!(self, Divergence::CommandSwings { .. })
    }

    /// Time at which the divergence begins or becomes visible, s.
    pub fn since_s(&self) -> f64 {
        match self {
            Divergence::CommandBeyondRange { since_s, .. }
            | Divergence::CommandSwings { since_s, .. }
            | Divergence::ForceBeyondReference { since_s, .. } => *since_s,
        }
    }
}

/// Fraction of the last window over which a command at its end counts as permanent.
const FOR_GOOD: f64 = 0.5;
/// Fraction of the last window, at its end, over which swings are counted.
const LATE: f64 = 0.25;
/// Number of swings from one end to the other that are no transient.
const SWINGS: u32 = 4;
/// Fraction of that time which a swinging command spends at its ends.
const AT_ENDS: f64 = 0.05;
/// Fraction of the run, at its end, over which the force is compared.
const LAST: f64 = 0.1;
/// Ratio of force to largest reference from which a run diverges.
const BEYOND: f64 = 10.0;

/// Inputs that act on the machine in addition to the controller.
pub(crate) struct OtherInputs<'a> {
    /// Reference, N.
    pub(crate) reference: &'a Profile,
    /// Inputs of the load: its ground, the external force, the setting of its accumulators.
    pub(crate) of_load: Vec<&'a Profile>,
}

/// Monitor for a divergence.
#[derive(Clone, Debug)]
pub(super) struct DivergenceWatch {
    range_v: f64,
    end_s: f64,
    last_window_s: f64,
    before_s: f64,
    /// Time since which the command is at an end of its range, s.
    since_s: Option<f64>,
    /// End of the range at which the command last was, in the last part of the run, and number of
    /// changes.
    side: Option<bool>,
    swings: u32,
    first_swing_s: f64,
    at_ends_s: f64,
    /// Largest magnitudes at the end of the run: of the force with its time, and of the reference.
    force: [f64; 2],
    reference_n: f64,
}

impl DivergenceWatch {
    /// Monitor for a run of this length under a command within a range, V.
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

    /// Beginning of a part of the last window at its end, s.
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

    /// Divergence of the run, if it diverges.
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

/// True if a function of time is constant between two times.
fn rests(profile: &Profile, from_s: f64, until_s: f64) -> bool {
    let breaks = profile.breaks().into_iter().any(|time_s| from_s < time_s && time_s < until_s);
    !breaks && profile.piece(0.5 * (from_s + until_s)).constant().is_some()
}
