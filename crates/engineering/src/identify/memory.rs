//! Memory of the spool at the beginning of a test.
//!
//! ```text
//! z = s h + (z_0 - s h) exp(-|dU|/(2 h))        slow spool:  dz/dz_0 = exp(-S/(2 h)),  S the path of the command since the first row
//! ```
//!
//! A test that begins after other cycles begins with their memory z_0, between -h and h. It is
//! found for each test separately, where the loss of its first residuals is least, and the
//! coefficients are fitted anew with it, until it no longer changes.

use phea_dynamics::least_squares::{Settings, loss};
use phea_dynamics::minimum::golden_section;
use phea_dynamics::portable;
use phea_dynamics::watch::Watch;
use phea_hydraulics::servovalve::TestInput;

use super::channels::Channel;
use super::evidence::{DECISIVE, criteria, independent_fraction};
use super::fit::{self, Depth, Fit};
use super::recording::Recording;
use crate::identify_error::IdentifyError;

/// Largest number of fits with other memories.
const PASSES: usize = 6;

/// Change of a memory, relative to the width of the hysteresis, that is negligible.
const SETTLED: f64 = 2e-3;

/// Number of memories that are evaluated between both ends, and number of golden-section steps that
/// follow.
const CANDIDATES: i32 = 16;
const SECTIONS: usize = 24;

/// Fraction of the first memory that must remain at a row for it to count.
const FORGOTTEN: f64 = 1e-3;

/// Recordings with the initial memories of their tests, and the end of their fit.
pub(super) struct WithMemories {
    recordings: Vec<Recording>,
    /// Variables at the end of the fit.
    start: Vec<f64>,
}

impl WithMemories {
    /// Fit of these recordings.
    ///
    /// # Errors
    /// The errors of a fit.
    pub(super) fn fitted<'a>(&'a self, first: &Fit<'_>, watch: Watch<'_>) -> Result<Fit<'a>, IdentifyError> {
        fit::from_near(&self.recordings, first, &self.start, Depth::ToTheEnd, watch)
    }
}

/// Memories of the recordings that a fit explains; `None` if no test needs one. `width` is the
/// initial estimate of the hysteresis, V.
///
/// A fit with a wrong memory may end far from the correct one: if a misfit remains, tests that
/// continue their earlier motion are evaluated too.
///
/// # Errors
/// The errors of a fit.
pub(super) fn remembered(
    first: &Fit<'_>,
    width: f64,
    watch: Watch<'_>,
) -> Result<Option<WithMemories>, IdentifyError> {
    if first.has_misfit() {
        let mut continued = first.together.recordings.to_vec();
        continued.iter_mut().for_each(|recording| continues(recording, width));
        let start = first.together.variables.start();
        let other = fit::from_near(&continued, first, &start, Depth::ToCompare, watch)?;
        let [before, after] = criteria([first, &other]);
        if before - after > DECISIVE {
            return settled(&other, vec![true; continued.len()], watch).map(Some);
        }
    }
    let needed: Vec<bool> = memories(first).iter().map(is_needed).collect();
    if !needed.contains(&true) {
        return Ok(None);
    }
    settled(first, needed, watch).map(Some)
}

/// Sets the memory of a test that continues the motion before it was recorded: its spool lags by
/// half the width.
fn continues(recording: &mut Recording, width: f64) {
    let rises = recording.branches().first().is_some_and(|branch| branch.rises);
    let memory = if rises { 0.5 * width } else { -0.5 * width };
    recording.inputs.iter_mut().take(1).for_each(|input| input.memory = memory);
}

/// Memories at which they and the coefficients no longer change.
fn settled(first: &Fit<'_>, mut needed: Vec<bool>, watch: Watch<'_>) -> Result<WithMemories, IdentifyError> {
    let mut found = memories(first);
    let mut recordings = first.together.recordings.to_vec();
    let mut start = first.minimum.variables.clone();
    for _ in 0..PASSES {
        let width = first.together.variables.coefficients(&start).hysteresis_width;
        let mut most = 0.0_f64;
        let all = recordings.iter_mut().zip(&found).zip(&needed).filter(|(_, needed)| **needed);
        for ((recording, found), _) in all {
            let (Some(found), Some(input)) = (found, recording.inputs.first_mut()) else { continue };
            most = most.max((input.memory - found.memory).abs());
            input.memory = found.memory;
        }
        if most < SETTLED * width {
            break;
        }
        let again = fit::from_near(&recordings, first, &start, Depth::ToTheEnd, watch)?;
        start.clone_from(&again.minimum.variables);
        found = memories(&again);
        needed.iter_mut().zip(&found).for_each(|(needed, found)| *needed |= is_needed(found));
    }
    Ok(WithMemories { recordings, start })
}

/// Initial memory of a test, V, and its decrease of the criterion.
#[derive(Clone, Copy, Debug)]
struct FirstMemory {
    memory: f64,
    gain: f64,
}

/// True if the recording needs a memory.
fn is_needed(found: &Option<FirstMemory>) -> bool {
    found.is_some_and(|one| one.gain > DECISIVE)
}

/// Memory at the beginning of each recording; `None` if no row shows it.
fn memories(fit: &Fit<'_>) -> Vec<Option<FirstMemory>> {
    let signals = fit.signals();
    let half = 0.5 * fit.coefficients().hysteresis_width;
    let of = |(index, recording): (usize, &Recording)| {
        let begun = Begun::new(fit, index, recording);
        let own = signals.iter().filter(|signal| signal.recording == index);
        let fraction = independent_fraction(own.map(|signal| signal.correlation).fold(0.0, f64::max));
        let at = |place: i32| half * f64::from(place) / f64::from(CANDIDATES / 2);
        let candidates = (-CANDIDATES / 2..=CANDIDATES / 2).map(|place| (place, begun.loss(at(place))));
        let (place, _) = candidates.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let near = [at(place - 1).max(-half), at(place + 1).min(half)];
        let memory = golden_section(near, SECTIONS, |memory| begun.loss(memory));
        let rows = begun.inputs.len() as f64;
        let gain = 2.0 * fraction * (begun.loss(0.0) - begun.loss(memory)) - portable::ln(rows.max(1.0));
        (rows > 0.0).then_some(FirstMemory { memory, gain })
    };
    fit.together.recordings.iter().enumerate().map(of).collect()
}

/// Rows of a test that the first memory affects.
struct Begun<'f> {
    fit: &'f Fit<'f>,
    recording: &'f Recording,
    index: usize,
    inputs: Vec<TestInput>,
}

impl<'f> Begun<'f> {
    fn new(fit: &'f Fit<'f>, index: usize, recording: &'f Recording) -> Begun<'f> {
        let width = fit.coefficients().hysteresis_width;
        let mut before = recording.inputs.first().map_or(0.0, |input| input.followed_command);
        let mut way = 0.0;
        let remembers = |input: &&TestInput| {
            let turn = input.turn.unwrap_or(before);
            way += (turn - before).abs() + (input.followed_command - turn).abs();
            before = input.followed_command;
            portable::exp(-way / width) > FORGOTTEN
        };
        let inputs = recording.inputs.iter().take_while(remembers).copied().collect();
        Begun { fit, recording, index, inputs }
    }

    /// Loss of the residuals with this memory, V.
    fn loss(&self, memory: f64) -> f64 {
        let together = &self.fit.together;
        let beyond = Settings::default().robust_beyond;
        let mut inputs = self.inputs.clone();
        inputs.iter_mut().take(1).for_each(|input| input.memory = memory);
        let outputs = together.tested.outputs(&self.fit.coefficients(), self.recording.circuit, &inputs);
        let of_channel = |channel: &Channel| -> f64 {
            let Some(signal) = self.recording.signals.get(channel.signal) else { return 0.0 };
            let read = outputs.iter().zip(&signal.values).filter(|(_, value)| value.is_some());
            let residuals = read
                .zip(together.scales(channel))
                .map(|((output, value), scale)| (signal.kind.shown(output) - value.unwrap_or(0.0)) / scale);
            residuals.map(|residual| loss(residual, beyond)).sum()
        };
        together.channels.iter().filter(|channel| channel.recording == self.index).map(of_channel).sum()
    }
}
