//! Margins of one plant: all of a loop and its specifications except the family, and a count of the
//! work.

use std::cell::Cell;

use num_complex::Complex64;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::minimum;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::UncertainPlant;

use super::asymptote::{self, AxisEnd};
use super::criterion::Criterion;
use super::response::{LoopAround, LoopAt, decibels};
use crate::closed_loop::{Compensation, Member, TrialPlant};
use crate::plant_cache::PlantCache;

/// Relative accuracy of polished frequencies.
pub(super) const FREQUENCY_TOLERANCE: f64 = 1e-7;

/// A loop without its plant, and its specifications.
#[derive(Debug)]
pub(super) struct Evaluator<'a> {
    pub(super) compensation: &'a Compensation,
    pub(super) criteria: Vec<Criterion>,
    pub(super) with_prefilter: bool,
    /// Numerator and denominator of G H without its dead time, if both are continuous.
    pub(super) compensator: Option<(Polynomial, Polynomial)>,
    /// Dead time of G H, s.
    pub(super) compensator_dead_time_s: f64,
    responses: Cell<u64>,
    /// The power of s of the first plant's |T| at either end; plants with another power have no
    /// spread there.
    steepness: [Cell<Option<i32>>; 2],
    /// Plants from earlier evaluations.
    pub(super) cache: &'a PlantCache,
}

/// A loop without its plant, and its specifications, shared between threads.
pub(super) struct EvaluatorSeed<'a> {
    compensation: &'a Compensation,
    criteria: Vec<Criterion>,
    with_prefilter: bool,
    steepness: [Option<i32>; 2],
}

impl EvaluatorSeed<'_> {
    /// An evaluator with these plants.
    pub(super) fn evaluator<'k>(&'k self, cache: &'k PlantCache) -> Evaluator<'k> {
        let own = Evaluator::new(self.compensation, self.criteria.clone(), self.with_prefilter, cache);
        Evaluator { steepness: self.steepness.map(Cell::new), ..own }
    }
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(
        compensation: &'a Compensation,
        criteria: Vec<Criterion>,
        with_prefilter: bool,
        cache: &'a PlantCache,
    ) -> Evaluator<'a> {
        let (feedback, sensor) = (compensation.feedback(), compensation.sensor());
        let compensator_dead_time_s = feedback.dead_time_s() + sensor.dead_time_s();
        let compensator = compensation.sample_time_s().is_none().then(|| {
            let numerator = feedback.numerator().product(&sensor.numerator());
            (numerator, feedback.denominator().product(&sensor.denominator()))
        });
        Evaluator {
            compensation,
            criteria,
            with_prefilter,
            compensator,
            compensator_dead_time_s,
            responses: Cell::new(0),
            steepness: [Cell::new(None), Cell::new(None)],
            cache,
        }
    }

    /// The source of evaluators of equal margins, for parallel tasks.
    pub(super) fn seed(&self) -> EvaluatorSeed<'a> {
        EvaluatorSeed {
            compensation: self.compensation,
            criteria: self.criteria.clone(),
            with_prefilter: self.with_prefilter,
            steepness: [self.steepness[0].get(), self.steepness[1].get()],
        }
    }

    /// Counts responses that a task evaluated.
    pub(super) fn count(&self, responses: u64) {
        self.responses.set(self.responses.get() + responses);
    }

    /// Number of responses of a plant evaluated so far.
    pub(super) fn responses(&self) -> u64 {
        self.responses.get()
    }

    /// A plant within the loop; `None` if it cannot be sampled.
    pub(super) fn member(&self, plant: &UncertainPlant, values: &[f64]) -> Option<Member> {
        self.cache.member(self.compensation, plant, values).ok()
    }

    /// A trial plant of a search; `None` if it cannot be sampled.
    pub(super) fn trial(&self, plant: &UncertainPlant, values: &[f64]) -> Option<TrialPlant> {
        self.cache.trial(self.compensation, plant, values)
    }

    pub(super) fn loop_at(&self, frequency: f64) -> LoopAt {
        LoopAt::new(self.compensation, &self.criteria, self.with_prefilter, frequency)
    }

    pub(super) fn closed(&self, at: &LoopAt, member: &Member) -> Option<LoopAround> {
        self.responses.set(self.responses.get() + 1);
        at.closed(member)
    }

    /// The margin of one plant to one criterion, dB; at zero and infinite frequency its limit.
    /// `None` if it is undefined or does not apply.
    pub(super) fn margin_db(&self, criterion: usize, member: &Member, frequency: f64) -> Option<f64> {
        let criterion = self.criteria.get(criterion)?;
        let end = match frequency {
            0.0 => Some(AxisEnd::Zero),
            f64::INFINITY => Some(AxisEnd::Infinity),
            _ => None,
        };
        if let Some(end) = end {
            return if criterion.demands(frequency) {
                self.end_margin_db(criterion, member, end)
            } else {
                None
            };
        }
        self.finite(criterion, member, frequency).map(|(_, margin_db)| margin_db)
    }

    /// Upper bound on the margin for every plant of a disc at a frequency that is neither zero nor
    /// infinite, dB.
    pub(super) fn certain_margin_db(&self, criterion: usize, member: &Member, frequency: f64) -> Option<f64> {
        let criterion = self.criteria.get(criterion)?;
        let only = std::slice::from_ref(criterion);
        let at = LoopAt::new(self.compensation, only, self.with_prefilter, frequency);
        let closed = self.closed(&at, member)?;
        Some(decibels(at.excess(0, criterion, &closed)?.certain))
    }

    /// The margin of a trial plant, dB: for a sampled one from its modes, if they suffice.
    pub(super) fn trial_margin_db(
        &self,
        criterion: usize,
        plant: &TrialPlant,
        frequency: f64,
    ) -> Option<f64> {
        let is_inside = frequency > 0.0 && frequency < f64::INFINITY;
        if let (true, TrialPlant::Held(_)) = (is_inside, plant) {
            return self.finite_trial(criterion, plant, frequency).map(|(_, margin_db)| margin_db);
        }
        self.margin_db(criterion, &*plant.whole(self.compensation)?, frequency)
    }

    /// A quantity that vanishes at a resonance, and the margin, dB, at a frequency that is neither
    /// zero nor infinite.
    pub(super) fn resonance(
        &self,
        criterion: usize,
        plant: &TrialPlant,
        frequency: f64,
    ) -> Option<(Complex64, f64)> {
        let (closed, margin_db) = self.finite_trial(criterion, plant, frequency)?;
        Some((closed.vanishing(self.criteria.get(criterion)?), margin_db))
    }

    fn finite(&self, criterion: &Criterion, member: &Member, frequency: f64) -> Option<(LoopAround, f64)> {
        self.finite_by(criterion, frequency, |at| self.closed(at, member))
    }

    fn finite_trial(
        &self,
        criterion: usize,
        plant: &TrialPlant,
        frequency: f64,
    ) -> Option<(LoopAround, f64)> {
        let criterion = self.criteria.get(criterion)?;
        let closed = |at: &LoopAt| {
            let by_modes = match plant {
                TrialPlant::Held(held) => at.closed_held(held),
                TrialPlant::Whole(_) => None,
            };
            match by_modes {
                Some(closed) => {
                    self.responses.set(self.responses.get() + 1);
                    Some(closed)
                }
                None => self.closed(at, &*plant.whole(self.compensation)?),
            }
        };
        self.finite_by(criterion, frequency, closed)
    }

    fn finite_by(
        &self,
        criterion: &Criterion,
        frequency: f64,
        closed: impl Fn(&LoopAt) -> Option<LoopAround>,
    ) -> Option<(LoopAround, f64)> {
        let only = std::slice::from_ref(criterion);
        let at = LoopAt::new(self.compensation, only, self.with_prefilter, frequency);
        let closed = closed(&at)?;
        let excess = at.excess(0, criterion, &closed)?.worst;
        (!excess.is_nan()).then(|| (closed, decibels(excess)))
    }

    fn end_margin_db(&self, criterion: &Criterion, member: &Member, end: AxisEnd) -> Option<f64> {
        self.responses.set(self.responses.get() + 1);
        let found = asymptote::margin(criterion, self.compensation, member, self.with_prefilter, end)?;
        if self.with_prefilter || criterion.upper.is_none() {
            return Some(found.margin_db);
        }
        let [zero, infinity] = &self.steepness;
        let steepness = if end == AxisEnd::Zero { zero } else { infinity };
        if steepness.get().is_none() {
            steepness.set(Some(found.power));
        }
        (steepness.get() == Some(found.power)).then_some(found.margin_db)
    }

    /// The local minimum of a margin between two frequencies, starting from one between them:
    /// (rad/s, dB).
    pub(super) fn polished(
        &self,
        criterion: usize,
        member: &Member,
        [low, middle, high]: [f64; 3],
    ) -> Option<(f64, f64)> {
        let within = |logarithm: f64| portable::exp(logarithm).clamp(low, high);
        let margin =
            |logarithm: f64| self.margin_db(criterion, member, within(logarithm)).unwrap_or(f64::INFINITY);
        let start = (portable::ln(middle), self.margin_db(criterion, member, middle)?);
        let ends = [portable::ln(low), portable::ln(high)];
        let (logarithm, value) = minimum::between(margin, ends, start, FREQUENCY_TOLERANCE);
        Some(if value < start.1 { (within(logarithm), value) } else { (middle, start.1) })
    }
}
