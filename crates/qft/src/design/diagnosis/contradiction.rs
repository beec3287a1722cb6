//! Design frequencies at which every loop is forbidden by the bounds of some plants.
//!
//! Only a few plants and the phases of a grid are examined, but if no loop is found, none exists:
//! between two phases L0 changes by a factor 1 + e,
//!
//! ```text
//! |T'| = |T| |1 + e|/|1 + e T|,  |S'| = |S|/|1 + e T|,     both greater by at most (1 + |e|)/(1 - |e| |T|)
//! ```
//!
//! so that a loop allowed anywhere is allowed at the nearest phase of the grid, once every limit is
//! relaxed by that factor.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::frequency::decibels;
use phea_dynamics::order::{sort_by_number, sorted_distinct};
use phea_dynamics::portable;

use super::candidate::PlantWithinLoop;
use super::ceiling::{Ceilings, demanded};
use super::finding::Finding;
use super::interpolation::least_relaxation_db;
use super::plane::BoundaryCells;
use crate::bound::{Bound, Feasibility, FrequencyBounds, PhaseGrid, TemplateFill};
use crate::closed_loop::MemberResponse;
use crate::specification::{Limit, LoopResponse, Requirement, Specification};
use crate::template::{Resolution, Template, TemplatePoint};
use crate::verification::{PlantPoint, SpecificationMargin};

/// Design frequencies that are examined.
const FREQUENCIES_MAXIMUM: usize = 64;
/// Phase spacing of the first search, rad.
const COARSE_RAD: f64 = PI / 36.0;
/// Spacing |e| (1 + |T|) between two phases of the fine grid.
const FINE: f64 = 0.008;
/// Largest |T| of the loops considered.
const COMPLEMENTARY_MAXIMUM: f64 = 60.0;
/// Least contradiction that is not left to the search, dB.
const TOLERANCE_DB: f64 = 0.01;
const RELAXATION_MAXIMUM_DB: f64 = 200.0;

/// The plants at one frequency and the requirements on them there.
struct DemandedPlants<'a> {
    frequency: f64,
    /// Specifications with their limits at this frequency, as constants.
    specifications: Vec<(usize, Specification)>,
    plants: Vec<(&'a PlantPoint, MemberResponse)>,
    template: Template,
}

/// Contradictions at all design frequencies, the worst first.
pub(super) fn contradictions(
    specifications: &[Specification],
    candidates: &[PlantWithinLoop],
    boundary: &BoundaryCells,
) -> Vec<Finding> {
    let mut frequencies: Vec<f64> = specifications
        .iter()
        .flat_map(|specification| &specification.frequencies_rad_per_s)
        .copied()
        .collect();
    frequencies.retain(|frequency| boundary.plane.place(*frequency).is_finite());
    let frequencies = sorted_distinct(frequencies);
    let skip = frequencies.len().div_ceil(FREQUENCIES_MAXIMUM).max(1);
    let places = frequencies.iter().step_by(skip);
    let mut found: Vec<([f64; 2], Finding)> = places
        .filter_map(|&frequency| {
            let place = DemandedPlants::new(specifications, candidates, frequency)?;
            let largest = largest_complementary(specifications, candidates, boundary, frequency)?;
            place.contradiction(largest)
        })
        .collect();
    sort_by_number(&mut found, |one| -one.0[0]);
    found.into_iter().map(|(_, finding)| finding).collect()
}

/// The greatest |T| that the limits allow any plant; `None` if they allow too much for a
/// conclusion.
fn largest_complementary(
    specifications: &[Specification],
    candidates: &[PlantWithinLoop],
    boundary: &BoundaryCells,
    frequency: f64,
) -> Option<f64> {
    let here = BoundaryCells {
        plane: boundary.plane,
        cells: Vec::new(),
        frequencies: vec![frequency],
        highest: frequency,
    };
    let ceilings = Ceilings::new(&here, specifications, candidates);
    let limits = (0..candidates.len())
        .filter_map(|candidate| ceilings.at_node(0, candidate, 1.0))
        .map(|ceiling| ceiling.complementary.limit);
    Some(limits.fold(0.0, f64::max)).filter(|largest| *largest <= COMPLEMENTARY_MAXIMUM)
}

impl<'a> DemandedPlants<'a> {
    fn new(
        specifications: &[Specification],
        candidates: &'a [PlantWithinLoop],
        frequency: f64,
    ) -> Option<DemandedPlants<'a>> {
        let at = |(index, specification): (usize, &Specification)| {
            let own = specification.frequencies_rad_per_s.contains(&frequency);
            demanded(specification, frequency).filter(|_| own)?;
            constant(specification, frequency, 1.0).map(|constant| (index, constant))
        };
        let specifications: Vec<(usize, Specification)> =
            specifications.iter().enumerate().filter_map(at).collect();
        let plants: Vec<(&PlantPoint, MemberResponse)> = candidates
            .iter()
            .filter_map(|candidate| Some((&candidate.point, candidate.member.response(frequency)?)))
            .collect();
        let point = |(index, (_, response)): (usize, &(&PlantPoint, MemberResponse))| TemplatePoint {
            member: Some(index),
            values: Vec::new(),
            response: response.plant * response.sensor,
            load_motion: response.load_motion,
            sensor: response.sensor,
        };
        let points: Vec<TemplatePoint> = plants.iter().enumerate().map(point).collect();
        let nominal = points.first()?.response;
        let template = Template {
            frequency_rad_per_s: frequency,
            nominal,
            points,
            outlines: Vec::new(),
            resolution: Resolution::Members,
        };
        (!specifications.is_empty()).then_some(DemandedPlants { frequency, specifications, plants, template })
    }

    /// The union of all bounds with every limit relaxed; `None` if there is no bound.
    fn union(&self, relaxation_db: f64, spacing_rad: f64) -> Option<(Bound, bool)> {
        let factor = portable::pow(10.0, relaxation_db / 20.0);
        let relaxed: Vec<Specification> = self
            .specifications
            .iter()
            .filter_map(|(_, specification)| constant(specification, self.frequency, factor))
            .collect();
        let bounds = FrequencyBounds::new(&self.template, &relaxed, TemplateFill::Points).ok()?;
        let combined = bounds.combined(&PhaseGrid::uniform(spacing_rad));
        let nowhere = matches!(combined.feasibility, Feasibility::Nowhere { .. });
        Some((combined.union, nowhere))
    }

    fn contradiction(&self, largest_complementary: f64) -> Option<([f64; 2], Finding)> {
        let nowhere = |relaxation_db: f64, spacing_rad: f64| {
            self.union(relaxation_db, spacing_rad).is_some_and(|(_, nowhere)| nowhere)
        };
        let turn = FINE / (1.0 + largest_complementary);
        if !nowhere(0.0, COARSE_RAD) || !nowhere(0.0, 2.0 * turn) {
            return None;
        }
        let coarse =
            least_relaxation_db(RELAXATION_MAXIMUM_DB, |relaxation| !nowhere(relaxation, COARSE_RAD));
        let high = if coarse.is_finite() {
            least_relaxation_db(coarse, |relaxation| !nowhere(relaxation, 2.0 * turn))
        } else {
            coarse
        };
        let low = proven_db(high, turn, largest_complementary);
        if low <= TOLERANCE_DB {
            return None;
        }
        let nearest = self.allowed(high, 2.0 * turn);
        let [phase_rad, gain] = nearest.unwrap_or([0.0, 0.0]);
        let finding = Finding::Contradiction {
            frequency_rad_per_s: self.frequency,
            phase_rad,
            gain,
            conflicts: nearest.map_or_else(Vec::new, |nearest| self.conflicts(nearest, high)),
            relaxation_db: [low, high],
        };
        Some(([low, high], finding))
    }

    /// Phase and gain of a loop that the relaxed limits allow, where the range of allowed gains is
    /// widest.
    fn allowed(&self, relaxation_db: f64, spacing_rad: f64) -> Option<[f64; 2]> {
        if !relaxation_db.is_finite() {
            return None;
        }
        let (union, _) = self.union(relaxation_db + 1e-3, spacing_rad)?;
        let gaps = union.phases_rad.iter().zip(&union.forbidden).flat_map(|(phase, forbidden)| {
            let ends = forbidden.intervals().iter().flatten().copied();
            let ends: Vec<f64> = [0.0].into_iter().chain(ends).chain([f64::INFINITY]).collect();
            let gaps: Vec<[f64; 2]> =
                ends.chunks(2).filter_map(|gap| Some([*gap.first()?, *gap.get(1)?])).collect();
            gaps.into_iter().filter(|[low, high]| low < high).map(move |gap| (*phase, gap))
        });
        let width = |[low, high]: &[f64; 2]| portable::ln(high / low);
        let (phase, gap) = gaps.max_by(|a, b| width(&a.1).total_cmp(&width(&b.1)))?;
        let gain = match gap {
            [0.0, f64::INFINITY] => 1.0,
            [0.0, high] => high * 0.999,
            [low, f64::INFINITY] => low * 1.001,
            [low, high] => (low * high).sqrt(),
        };
        Some([phase, gain])
    }

    /// The specifications that this loop violates, each with its worst plant.
    fn conflicts(&self, [phase_rad, gain]: [f64; 2], relaxation_db: f64) -> Vec<SpecificationMargin> {
        let nominal = Complex64::new(gain * portable::cos(phase_rad), gain * portable::sin(phase_rad));
        let conflicts = self.specifications.iter().filter_map(|(index, specification)| {
            let (margin, rate) = self.margin(*index, specification, nominal)?;
            (margin.margin_db < -0.5 * rate * relaxation_db).then_some(margin)
        });
        conflicts.collect()
    }

    /// The worst margin of one specification, and its improvement per dB of relaxation.
    fn margin(
        &self,
        index: usize,
        specification: &Specification,
        nominal: Complex64,
    ) -> Option<(SpecificationMargin, f64)> {
        let one = Complex64::new(1.0, 0.0);
        let size_db = |(point, plant): &(&'a PlantPoint, MemberResponse)| {
            let own = plant.plant * plant.sensor;
            let response = LoopResponse {
                plant: plant.plant,
                load_motion: plant.load_motion,
                controller: nominal / self.template.nominal,
                prefilter: one,
                sensor: own / plant.plant,
            };
            let size = portable::magnitude(specification.requirement.closed_loop().response(&response));
            (*point, decibels(size))
        };
        let sizes: Vec<(&PlantPoint, f64)> = self.plants.iter().map(size_db).collect();
        let greatest = sizes.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let least = sizes.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let limit_db = decibels(demanded(specification, self.frequency)?);
        let spread = specification.requirement.is_tracking();
        let (size, other, rate) =
            if spread { (greatest.1 - least.1, Some(least.0.clone()), 2.0) } else { (greatest.1, None, 1.0) };
        let margin = SpecificationMargin {
            specification: index,
            frequency_rad_per_s: self.frequency,
            margin_db: limit_db - size,
            plant: greatest.0.clone(),
            other,
        };
        Some((margin, rate))
    }
}

/// A relaxation proven too small, from the least one found on the grid: the allowance for the gap
/// between two phases is subtracted. Limits grow at most with the square of a relaxation, and so
/// does the largest |T|.
fn proven_db(high_db: f64, turn: f64, largest_complementary: f64) -> f64 {
    const COVERED: f64 = 0.1;
    let far = (COVERED / (turn * largest_complementary)).sqrt();
    let factor = portable::pow(10.0, high_db / 20.0).min(far);
    let slack = (1.0 + turn) / (1.0 - turn * largest_complementary * factor * factor);
    decibels(factor / slack) - 1e-3
}

/// The specification at one frequency only, its limits relaxed by a factor.
fn constant(specification: &Specification, frequency: f64, factor: f64) -> Option<Specification> {
    let (lower, upper) = specification.requirement.limits();
    let upper = Limit::Constant(factor * upper.magnitude(frequency)?);
    let requirement = match lower {
        Some(lower) => Requirement::tracking(Limit::Constant(lower.magnitude(frequency)? / factor), upper),
        None => Requirement::at_most(specification.requirement.closed_loop(), upper),
    };
    Some(Specification {
        requirement,
        frequencies_rad_per_s: vec![frequency],
        band_rad_per_s: [frequency, frequency],
    })
}
