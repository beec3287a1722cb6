//! Findings derived from margins.

use std::ops::Range;

use super::evaluator::Evaluator;
use super::remark::remarks;
use super::response::decibels;
use super::scan::{Scan, ScannedPlant, WorstPlant};
use super::{Evidence, PlantPoint, SpecificationFinding, SpecificationMargin, Verdict, ViolatedBand};
use crate::family::Family;
use crate::specification::Specification;
use phea_dynamics::order::sort_by_number;

/// Violation below which it counts as rounding error, dB.
const ROUNDING_DB: f64 = 1e-9;
/// Relative accuracy of the ends of violated bands.
const EDGE_TOLERANCE: f64 = 1e-4;

/// Excess over the worst margin up to which a margin counts as equally bad, dB.
const AS_BAD_DB: f64 = 0.05;
/// Relative difference of the frequencies of one minimum, and fraction of the box within which its
/// plants count as near each other.
const SAME_FREQUENCY: f64 = 0.05;
const SAME_FRACTION: f64 = 0.5;
/// Largest number of places as bad as the worst.
const PLACES_MAXIMUM: usize = 4;

/// The criteria of one specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SpecificationCriteria {
    pub(super) first: usize,
    pub(super) count: usize,
    /// True if their margins are summed, each with a separate plant.
    pub(super) spread: bool,
}

/// A margin found in an audit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FoundMargin {
    pub(super) margin: SpecificationMargin,
    /// Upper bound on the margin over the discs of a measurement, dB; the margin itself without
    /// discs.
    pub(super) certain_db: f64,
    /// The criterion; both for a spread.
    pub(super) criteria: Vec<usize>,
    /// True if the margin has a minimum here, at a frequency inside the band.
    pub(super) interior: bool,
}

/// The worst margin of the family at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EnvelopePoint {
    pub(super) frequency: f64,
    pub(super) margin_db: f64,
    pub(super) certain_db: f64,
    pub(super) criteria: Vec<usize>,
    pub(super) plants: Vec<usize>,
}

impl FoundMargin {
    fn is_at(&self, frequency_rad_per_s: f64) -> bool {
        self.margin.frequency_rad_per_s == frequency_rad_per_s
    }
}

impl EnvelopePoint {
    /// The margin of the specification with this index.
    pub(super) fn found(&self, specification: usize, plants: &[ScannedPlant]) -> Option<FoundMargin> {
        let points = self.plants.iter().filter_map(|plant| plants.get(*plant));
        let mut points = points.map(|plant| plant.point.clone());
        Some(FoundMargin {
            margin: SpecificationMargin {
                specification,
                frequency_rad_per_s: self.frequency,
                margin_db: self.margin_db,
                plant: points.next()?,
                other: points.next(),
            },
            certain_db: self.certain_db,
            criteria: self.criteria.clone(),
            interior: false,
        })
    }
}

impl SpecificationCriteria {
    pub(super) fn criteria(self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// The units of a search: a spread as a whole, otherwise each criterion.
    pub(super) fn searched(self) -> Vec<SpecificationCriteria> {
        if self.spread {
            return vec![self];
        }
        self.criteria().map(|first| SpecificationCriteria { first, count: 1, spread: false }).collect()
    }

    /// The worst margin of the family at one frequency; `None` if no criterion applies or is
    /// resolved.
    pub(super) fn combined(self, frequency: f64, worst: &[Option<WorstPlant>]) -> Option<EnvelopePoint> {
        let own = self
            .criteria()
            .map(|criterion| worst.get(criterion).copied().flatten().map(|worst| (criterion, worst)));
        let chosen: Vec<(usize, WorstPlant)> = if self.spread {
            own.collect::<Option<_>>()?
        } else {
            vec![own.flatten().max_by(|left, right| left.1.excess.total_cmp(&right.1.excess))?]
        };
        let margin_db: f64 = chosen.iter().map(|(_, worst)| decibels(worst.excess)).sum();
        let certain = if self.spread {
            chosen.iter().map(|(_, worst)| decibels(worst.certain)).sum()
        } else {
            let own = self.criteria().filter_map(|one| worst.get(one).copied().flatten());
            own.map(|worst| decibels(worst.certain)).fold(f64::INFINITY, f64::min)
        };
        (!margin_db.is_nan()).then(|| EnvelopePoint {
            frequency,
            margin_db,
            certain_db: certain,
            criteria: chosen.iter().map(|(criterion, _)| *criterion).collect(),
            plants: chosen.iter().map(|(_, worst)| worst.plant).collect(),
        })
    }
}

/// A common frequency at which every criterion has a margin, but their spread has none.
pub(super) fn undefined(part: SpecificationCriteria, scan: &Scan) -> Option<f64> {
    let everywhere =
        |worst: &[Option<WorstPlant>]| part.criteria().all(|one| worst.get(one).is_some_and(Option::is_some));
    let mut points = scan.envelope();
    let lost =
        points.find(|(frequency, worst)| everywhere(worst) && part.combined(*frequency, worst).is_none());
    lost.map(|(frequency, _)| frequency)
}

/// The worst margin of the family at the common frequencies.
pub(super) fn envelope(part: SpecificationCriteria, scan: &Scan) -> Vec<EnvelopePoint> {
    scan.envelope().filter_map(|(frequency, worst)| part.combined(frequency, worst)).collect()
}

/// Frequencies of the local minima inside, each with its neighbours, the worst first.
pub(super) fn local_minima(envelope: &[EnvelopePoint]) -> Vec<[f64; 3]> {
    let mut minima: Vec<(f64, [f64; 3])> = envelope
        .windows(3)
        .filter_map(|triple| match triple {
            [before, here, after]
                if here.margin_db <= before.margin_db && here.margin_db < after.margin_db =>
            {
                let low = if before.frequency > 0.0 { before.frequency } else { here.frequency / 10.0 };
                let high = after.frequency.min(here.frequency * 10.0);
                Some((here.margin_db, [low, here.frequency, high]))
            }
            _ => None,
        })
        .collect();
    sort_by_number(&mut minima, |minimum| minimum.0);
    minima.into_iter().map(|minimum| minimum.1).collect()
}

/// All data of a finding.
pub(super) struct Joining<'a> {
    pub(super) part: SpecificationCriteria,
    pub(super) family: &'a Family,
    pub(super) index: usize,
    pub(super) specification: &'a Specification,
    pub(super) evaluator: &'a Evaluator<'a>,
    pub(super) plants: &'a [ScannedPlant],
    pub(super) cases: &'a [FoundMargin],
    /// A frequency at which a plant found in a search, or the spread of the family, has no margin.
    pub(super) undefined: Option<f64>,
    pub(super) tolerance_db: f64,
}

impl Joining<'_> {
    pub(super) fn finding(&self, scan: &mut Scan) -> SpecificationFinding {
        let envelope = envelope(self.part, scan);
        let own = envelope.iter().filter_map(|point| point.found(self.index, self.plants));
        let all: Vec<FoundMargin> = own.chain(self.cases.iter().cloned()).collect();
        let worst = least(all.iter());
        let ends = [envelope.first(), envelope.last()].map(|end| end.map(|point| point.frequency));
        let at_an_end = worst.is_some_and(|worst| ends.contains(&Some(worst.margin.frequency_rad_per_s)));
        let minima: Vec<f64> = local_minima(&envelope).iter().map(|bracket| bracket[1]).collect();
        let interior =
            |case: &&FoundMargin| case.interior || minima.contains(&case.margin.frequency_rad_per_s);
        let interior = least(all.iter().filter(interior)).filter(|_| at_an_end);
        let unresolved = self.part.criteria().find_map(|criterion| scan.unresolved(criterion));
        let certain_db = all.iter().map(|case| case.certain_db).fold(f64::INFINITY, f64::min);
        let violated = certain_db < -self.tolerance();
        let is_open = !violated && worst.is_some_and(|worst| worst.margin.margin_db < -self.tolerance());
        SpecificationFinding {
            requirement: self.specification.requirement.clone(),
            verdict: match (
                violated,
                !is_open && unresolved.is_none() && self.undefined.is_none() && worst.is_some(),
            ) {
                (true, _) => Verdict::Violated,
                (false, true) => Verdict::Met,
                (false, false) => Verdict::NotProven,
            },
            evidence: Evidence::of(self.family),
            worst: worst.map(margin),
            interior: interior.map(margin),
            as_bad: self.as_bad(worst, &all, &minima),
            violations: self.violations(scan, &envelope, &all),
            at_design_frequencies: self
                .specification
                .frequencies_rad_per_s
                .iter()
                .filter_map(|&frequency| least(all.iter().filter(|case| case.is_at(frequency))))
                .map(margin)
                .collect(),
            envelope: self.drawn(&envelope),
            remarks: remarks(self, worst, unresolved, is_open.then_some(certain_db)),
        }
    }

    /// The minima as bad as the worst, one for each place.
    fn as_bad(
        &self,
        worst: Option<&FoundMargin>,
        all: &[FoundMargin],
        minima: &[f64],
    ) -> Vec<SpecificationMargin> {
        let Some(worst) = worst else { return vec![] };
        let most_db = worst.margin.margin_db + AS_BAD_DB;
        let is_minimum =
            |case: &&FoundMargin| case.interior || minima.contains(&case.margin.frequency_rad_per_s);
        let mut near: Vec<&FoundMargin> =
            all.iter().filter(is_minimum).filter(|case| case.margin.margin_db <= most_db).collect();
        sort_by_number(&mut near, |case| case.margin.margin_db);
        let mut places = vec![worst];
        for case in near {
            if places.len() <= PLACES_MAXIMUM && !places.iter().any(|known| self.is_same_place(known, case)) {
                places.push(case);
            }
        }
        places.into_iter().skip(1).map(margin).collect()
    }

    /// True if two margins belong to one minimum: at about one frequency, with plants that are near
    /// each other in most coordinates of the box.
    fn is_same_place(&self, one: &FoundMargin, other: &FoundMargin) -> bool {
        let [one, other] = [&one.margin, &other.margin];
        let [own, second] = [one.frequency_rad_per_s, other.frequency_rad_per_s];
        if (own - second).abs() > SAME_FREQUENCY * own {
            return false;
        }
        let Family::Uncertain(family) = self.family else { return one.plants().eq(other.plants()) };
        let fractions = |margin: &SpecificationMargin| match &margin.plant {
            PlantPoint::Parameters(values) => family.fractions(values),
            _ => vec![],
        };
        let (one, other) = (fractions(one), fractions(other));
        let far =
            one.iter().zip(&other).filter(|(one, other)| (*one - *other).abs() >= SAME_FRACTION).count();
        2 * far < one.len().max(1)
    }

    /// True if a plant is known within confidence discs.
    pub(super) fn has_discs(&self) -> bool {
        let Family::Measured(family) = self.family else { return false };
        family.plants().iter().any(|plant| !plant.radii.is_empty())
    }

    fn tolerance(&self) -> f64 {
        self.tolerance_db.max(ROUNDING_DB)
    }

    /// The envelope, including the margins found by searches between the plants.
    fn drawn(&self, envelope: &[EnvelopePoint]) -> Vec<(f64, f64)> {
        let margin = |point: &EnvelopePoint| {
            let here = self.cases.iter().filter(|case| case.is_at(point.frequency));
            here.map(|case| case.margin.margin_db).fold(point.margin_db, f64::min)
        };
        envelope.iter().map(|point| (point.frequency, margin(point))).collect()
    }

    /// Ranges of frequencies at which some plant violates the specification, with refined ends.
    fn violations(
        &self,
        scan: &mut Scan,
        envelope: &[EnvelopePoint],
        all: &[FoundMargin],
    ) -> Vec<ViolatedBand> {
        let violated = |point: &EnvelopePoint| point.certain_db < -self.tolerance();
        let mut bands = Vec::new();
        let mut from: Option<usize> = None;
        for (index, point) in envelope.iter().enumerate() {
            match (from, violated(point)) {
                (None, true) => from = Some(index),
                (Some(first), false) => {
                    bands.push((first, index - 1));
                    from = None;
                }
                _ => {}
            }
        }
        bands.extend(from.map(|first| (first, envelope.len() - 1)));
        let frequency = |index: usize| envelope.get(index).map(|point| point.frequency);
        let mut found = Vec::new();
        for (first, last) in bands {
            let (Some(low), Some(high)) = (frequency(first), frequency(last)) else { continue };
            let band = [
                self.edge(scan, low, first.checked_sub(1).and_then(frequency)),
                self.edge(scan, high, frequency(last + 1)),
            ];
            let is_within = |frequency: f64| band[0] <= frequency && frequency <= band[1];
            let within = all.iter().filter(|case| is_within(case.margin.frequency_rad_per_s));
            found
                .extend(least(within).map(|case| ViolatedBand { band_rad_per_s: band, worst: margin(case) }));
        }
        found
    }

    /// The boundary between a violated frequency and one that is not violated.
    fn edge(&self, scan: &mut Scan, violated: f64, cache: Option<f64>) -> f64 {
        let finite = |frequency: f64| frequency > 0.0 && frequency < f64::INFINITY;
        let Some(mut cache) = cache.filter(|cache| finite(*cache) && finite(violated)) else {
            return violated;
        };
        let mut violated = violated;
        while (violated - cache).abs() > EDGE_TOLERANCE * violated {
            let middle = (violated * cache).sqrt();
            let worst = scan.family_at(self.evaluator, self.plants, middle);
            match self.part.combined(middle, &worst) {
                Some(point) if point.certain_db < -self.tolerance() => violated = middle,
                _ => cache = middle,
            }
        }
        violated
    }
}

fn least<'a>(cases: impl Iterator<Item = &'a FoundMargin>) -> Option<&'a FoundMargin> {
    cases.min_by(|left, right| left.margin.margin_db.total_cmp(&right.margin.margin_db))
}

fn margin(case: &FoundMargin) -> SpecificationMargin {
    case.margin.clone()
}
