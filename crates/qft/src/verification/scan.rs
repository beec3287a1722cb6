//! Examination of every plant: the family's worst margin at each common frequency, and the peaks of
//! each plant between them.

use num_complex::Complex64;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use super::PlantPoint;
use super::evaluator::Evaluator;
use super::frequencies::Features;
use super::response::{Excess, LoopAt};
use crate::closed_loop::Member;

/// Cosine of the largest angle by which a characteristic value turns from one point to the next
/// without a resonance between them.
const TURN_COSINE: f64 = 0.5;
/// Number of times an interval is halved in search of a resonance.
pub(super) const HALVINGS: usize = 40;
/// Factor of the squared excess, 1.5 dB, by which refinement may raise a peak to the worst.
pub(super) const WORTH_POLISHING: f64 = 0.7;

/// A plant that is examined.
#[derive(Clone, Debug)]
pub(super) struct ScannedPlant {
    pub(super) point: PlantPoint,
    /// Member; `None` if it cannot be sampled.
    pub(super) member: Option<Member>,
    pub(super) features: Features,
}

/// The worst plant of the family at one frequency for one criterion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WorstPlant {
    /// Squared ratio (quantity/limit)^2, or its inverse.
    pub(super) excess: f64,
    pub(super) plant: usize,
    /// Greatest excess of a plant at every point of its disc.
    pub(super) certain: f64,
}

/// A local maximum of the excess of one plant, with its neighbouring frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Peak {
    pub(super) excess: f64,
    pub(super) plant: usize,
    pub(super) bracket: [f64; 3],
}

/// Results so far.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    grid: Vec<(f64, Option<LoopAt>)>,
    /// Worst plants by frequency and criterion; `None` without a limit, or if none is resolved.
    worst: Vec<Vec<Option<WorstPlant>>>,
    /// Peaks by criterion.
    peaks: Vec<Vec<Peak>>,
    /// Required but unavailable margin by criterion, as frequency and plant.
    unresolved: Vec<Option<(f64, usize)>>,
}

/// One plant at one frequency: an excess for each criterion, `None` without a limit, or if it is
/// not resolved.
struct PlantSample {
    frequency: f64,
    characteristic: Option<Complex64>,
    excess: Vec<Option<Excess>>,
}

impl Scan {
    pub(super) fn new(evaluator: &Evaluator<'_>, frequencies: &[f64]) -> Scan {
        let criteria = evaluator.criteria.len();
        let at = |&frequency: &f64| (frequency, loop_at(evaluator, frequency));
        Scan {
            grid: frequencies.iter().map(at).collect(),
            worst: vec![vec![None; criteria]; frequencies.len()],
            peaks: vec![Vec::new(); criteria],
            unresolved: vec![None; criteria],
        }
    }

    /// The common frequencies with the worst plant for each criterion.
    pub(super) fn envelope(&self) -> impl Iterator<Item = (f64, &[Option<WorstPlant>])> {
        self.grid.iter().map(|point| point.0).zip(self.worst.iter().map(Vec::as_slice))
    }

    pub(super) fn unresolved(&self, criterion: usize) -> Option<(f64, usize)> {
        self.unresolved.get(criterion).copied().flatten()
    }

    /// Peaks of a criterion that may be its worst, the highest first.
    pub(super) fn peaks(&self, criterion: usize) -> Vec<Peak> {
        let mut peaks = self.peaks.get(criterion).cloned().unwrap_or_default();
        let highest = peaks.iter().map(|peak| peak.excess).fold(0.0, f64::max);
        peaks.retain(|peak| peak.excess >= WORTH_POLISHING * highest);
        sort_by_number(&mut peaks, |peak| -peak.excess);
        peaks
    }

    /// Adds a frequency at which the whole family is examined.
    pub(super) fn add_frequency(
        &mut self,
        evaluator: &Evaluator<'_>,
        plants: &[ScannedPlant],
        frequency: f64,
    ) {
        let place = self.grid.partition_point(|point| point.0 < frequency);
        if self.grid.get(place).is_some_and(|point| point.0 == frequency) {
            return;
        }
        let worst = self.family_at(evaluator, plants, frequency);
        self.grid.insert(place, (frequency, loop_at(evaluator, frequency)));
        self.worst.insert(place, worst);
    }

    /// The worst plants of the family at any frequency, by criterion.
    pub(super) fn family_at(
        &mut self,
        evaluator: &Evaluator<'_>,
        plants: &[ScannedPlant],
        frequency: f64,
    ) -> Vec<Option<WorstPlant>> {
        let at = loop_at(evaluator, frequency);
        let mut worst = vec![None; evaluator.criteria.len()];
        for (index, plant) in plants.iter().enumerate() {
            let sample = self.sample(evaluator, plant, index, frequency, &at);
            for (slot, excess) in worst.iter_mut().zip(sample.excess) {
                *slot = worse(*slot, excess, index);
            }
        }
        worst
    }

    /// Examines one plant at all common frequencies and at its individual ones.
    pub(super) fn evaluate_at(&mut self, evaluator: &Evaluator<'_>, plant: &ScannedPlant, index: usize) {
        let common = std::mem::take(&mut self.grid);
        let mut samples = Vec::with_capacity(common.len() + plant.features.frequencies.len());
        for (place, (frequency, at)) in common.iter().enumerate() {
            let sample = self.sample(evaluator, plant, index, *frequency, at);
            if let Some(slots) = self.worst.get_mut(place) {
                for (slot, excess) in slots.iter_mut().zip(&sample.excess) {
                    *slot = worse(*slot, *excess, index);
                }
            }
            samples.push(sample);
        }
        let ends = common.first().zip(common.last()).map(|(first, last)| [first.0, last.0]);
        self.grid = common;
        let [from, to] = ends.unwrap_or([0.0, 0.0]);
        for &frequency in &plant.features.frequencies {
            if from < frequency && frequency < to {
                let at = loop_at(evaluator, frequency);
                samples.push(self.sample(evaluator, plant, index, frequency, &at));
            }
        }
        sort_by_number(&mut samples, |sample| sample.frequency);
        // a duplicate frequency would hide one side of a peak
        samples.dedup_by(|next, cache| next.frequency == cache.frequency);
        if !plant.features.complete {
            samples = self.with_resonances(evaluator, plant, index, samples);
        }
        self.keep_peaks(index, &samples);
    }

    fn sample(
        &mut self,
        evaluator: &Evaluator<'_>,
        plant: &ScannedPlant,
        index: usize,
        frequency: f64,
        at: &Option<LoopAt>,
    ) -> PlantSample {
        let closed = plant.member.as_ref().zip(at.as_ref());
        let closed = closed.and_then(|(member, at)| Some((at, evaluator.closed(at, member)?)));
        let mut excess = Vec::with_capacity(evaluator.criteria.len());
        for (number, criterion) in evaluator.criteria.iter().enumerate() {
            let value = match (&closed, &plant.member) {
                (Some((at, closed)), _) => at.excess(number, criterion, closed),
                (None, Some(member)) if at.is_none() => evaluator
                    .margin_db(number, member, frequency)
                    .map(|margin| portable::pow(10.0, -margin / 10.0))
                    .map(|excess| Excess { worst: excess, certain: excess }),
                (None, _) => None,
            };
            let value = value.filter(|value| !value.worst.is_nan());
            if value.is_none() && criterion.demands(frequency) {
                self.note_unresolved(number, frequency, index);
            }
            excess.push(value);
        }
        PlantSample { frequency, characteristic: closed.map(|(_, closed)| closed.characteristic), excess }
    }

    fn note_unresolved(&mut self, criterion: usize, frequency: f64, plant: usize) {
        if let Some(slot @ None) = self.unresolved.get_mut(criterion) {
            *slot = Some((frequency, plant));
        }
    }

    /// Halves each interval over which the characteristic value turns far enough to contain a
    /// resonance.
    fn with_resonances(
        &mut self,
        evaluator: &Evaluator<'_>,
        plant: &ScannedPlant,
        index: usize,
        samples: Vec<PlantSample>,
    ) -> Vec<PlantSample> {
        let mut found: Vec<PlantSample> = Vec::with_capacity(samples.len());
        for sample in samples {
            let mut ahead = vec![sample];
            let mut halvings = 0;
            while let Some(next) = ahead.pop() {
                match found.last().and_then(|behind| halved(behind, &next)) {
                    Some(frequency) if halvings < HALVINGS => {
                        halvings += 1;
                        let at = loop_at(evaluator, frequency);
                        ahead.push(next);
                        ahead.push(self.sample(evaluator, plant, index, frequency, &at));
                    }
                    _ => found.push(next),
                }
            }
        }
        found
    }

    fn keep_peaks(&mut self, plant: usize, samples: &[PlantSample]) {
        for (criterion, peaks) in self.peaks.iter_mut().enumerate() {
            let excess =
                |sample: &PlantSample| sample.excess.get(criterion).copied().flatten().map(|one| one.worst);
            let highest = peaks.iter().map(|peak| peak.excess).fold(0.0, f64::max);
            for triple in samples.windows(3) {
                let [before, here, after] = triple else { continue };
                let (Some(left), Some(excess), Some(right)) = (excess(before), excess(here), excess(after))
                else {
                    continue;
                };
                if excess >= left && excess > right && excess >= WORTH_POLISHING * highest {
                    let low = if before.frequency > 0.0 { before.frequency } else { here.frequency / 10.0 };
                    let high = after.frequency.min(here.frequency * 10.0);
                    peaks.push(Peak { excess, plant, bracket: [low, here.frequency, high] });
                }
            }
        }
    }
}

/// Responses G, F, H and limits at a frequency; `None` at the ends of the axis.
fn loop_at(evaluator: &Evaluator<'_>, frequency: f64) -> Option<LoopAt> {
    (frequency > 0.0 && frequency < f64::INFINITY).then(|| evaluator.loop_at(frequency))
}

fn worse(so_far: Option<WorstPlant>, excess: Option<Excess>, plant: usize) -> Option<WorstPlant> {
    let Some(Excess { worst, certain }) = excess else { return so_far };
    match so_far {
        Some(before) => {
            let certain = before.certain.max(certain);
            Some(if worst <= before.excess {
                WorstPlant { certain, ..before }
            } else {
                WorstPlant { excess: worst, plant, certain }
            })
        }
        None => Some(WorstPlant { excess: worst, plant, certain }),
    }
}

/// A frequency between two samples if the characteristic value turns too far between them.
fn halved(behind: &PlantSample, ahead: &PlantSample) -> Option<f64> {
    let middle = (behind.frequency * ahead.frequency).sqrt();
    let turns = turns(behind.characteristic?, ahead.characteristic?);
    (turns && behind.frequency < middle && middle < ahead.frequency).then_some(middle)
}

/// True if a value turns far enough from one point to the next for a resonance between them.
pub(super) fn turns(from: Complex64, to: Complex64) -> bool {
    let (from, to) = (from / portable::magnitude(from), to / portable::magnitude(to));
    (from.conj() * to).re < TURN_COSINE
}
