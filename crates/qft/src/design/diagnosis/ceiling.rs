//! The upper limits of |S| and |T| of one plant that result from all specifications, frequency by
//! frequency.

use phea_dynamics::portable;

use super::candidate::PlantWithinLoop;
use super::plane::BoundaryCells;
use crate::closed_loop::MemberResponse;
use crate::specification::{ClosedLoop, Requirement, Specification};

/// An upper limit, and the specification that sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoomFraction {
    pub(super) limit: f64,
    pub(super) specification: Option<usize>,
}

/// Upper limits of |S| and |T| of one plant at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ceiling {
    pub(super) sensitivity: RoomFraction,
    pub(super) complementary: RoomFraction,
}

impl RoomFraction {
    const FREE: RoomFraction = RoomFraction { limit: f64::INFINITY, specification: None };

    fn lowered(&mut self, limit: f64, specification: Option<usize>) {
        if limit < self.limit {
            *self = RoomFraction { limit, specification };
        }
    }
}

/// The limit of a specification at a frequency, upper over lower for tracking; `None` where nothing
/// is required.
pub(super) fn demanded(specification: &Specification, frequency: f64) -> Option<f64> {
    let [from, to] = specification.band_rad_per_s;
    if !(from <= frequency && frequency <= to) {
        return None;
    }
    let (lower, upper) = specification.requirement.limits();
    let upper = upper.magnitude(frequency)?;
    let limit = match lower {
        None => upper,
        Some(lower) => upper / lower.magnitude(frequency)?,
    };
    (0.0..f64::INFINITY).contains(&limit).then_some(limit)
}

/// The requirements at one frequency, and their plants.
#[derive(Clone, Debug)]
pub(super) struct FrequencyDemand {
    /// Specification with its limit.
    demands: Vec<(usize, f64)>,
    /// Responses of the candidates.
    responses: Vec<Option<MemberResponse>>,
    /// Plants of extreme magnitude and phase, with which tracking compares the others.
    partners: Vec<MemberResponse>,
}

/// The requirements on all candidates over all frequencies of a boundary.
#[derive(Clone, Debug)]
pub(super) struct Ceilings<'a> {
    pub(super) boundary: &'a BoundaryCells,
    specifications: &'a [Specification],
    nodes: Vec<FrequencyDemand>,
}

impl<'a> Ceilings<'a> {
    pub(super) fn new(
        boundary: &'a BoundaryCells,
        specifications: &'a [Specification],
        candidates: &[PlantWithinLoop],
    ) -> Ceilings<'a> {
        let node = |frequency: &f64| node(specifications, candidates, *frequency);
        Ceilings { boundary, specifications, nodes: boundary.frequencies.iter().map(node).collect() }
    }

    /// The limits of one candidate at all frequencies, with every specification relaxed by a
    /// factor.
    pub(super) fn of(&self, candidate: usize, factor: f64) -> impl Iterator<Item = Ceiling> {
        self.nodes.iter().map(move |node| self.at(node, candidate, factor))
    }

    /// The limits of one candidate at one frequency.
    pub(super) fn at_node(&self, place: usize, candidate: usize, factor: f64) -> Option<Ceiling> {
        self.nodes.get(place).map(|node| self.at(node, candidate, factor))
    }

    /// ```text
    /// |T| <= W        |S| <= W        |P S| <= W: |S| <= W/|P|        |Pd S| <= W: |S| <= W/|Pd|        |G S| <= W: |T| <= W |P H|
    /// |S| <= 1 + |T|,  |T| <= 1 + |S|                                     since S + T = 1
    /// ```
    fn at(&self, node: &FrequencyDemand, candidate: usize, factor: f64) -> Ceiling {
        let mut ceiling = Ceiling { sensitivity: RoomFraction::FREE, complementary: RoomFraction::FREE };
        let own = node.responses.get(candidate).and_then(Option::as_ref);
        let size = portable::magnitude;
        for &(index, limit) in &node.demands {
            let Some(specification) = self.specifications.get(index) else { continue };
            let by = Some(index);
            let relaxed = factor * limit;
            match (specification.requirement.closed_loop(), own) {
                (ClosedLoop::RobustStability, _) => ceiling.complementary.lowered(relaxed, by),
                (ClosedLoop::Sensitivity, _) => ceiling.sensitivity.lowered(relaxed, by),
                (ClosedLoop::PlantInputDisturbance, Some(own)) => {
                    ceiling.sensitivity.lowered(relaxed / size(own.plant), by);
                }
                (ClosedLoop::LoadMotion, Some(own)) => {
                    ceiling.sensitivity.lowered(relaxed / size(own.load_motion), by);
                }
                (ClosedLoop::ControlEffort, Some(own)) => {
                    ceiling.complementary.lowered(relaxed * size(own.plant * own.sensor), by);
                }
                (ClosedLoop::Tracking, Some(own)) => {
                    for partner in &node.partners {
                        let [sensitivity, complementary] = spread(own, partner, factor * relaxed);
                        ceiling.sensitivity.lowered(sensitivity, by);
                        ceiling.complementary.lowered(complementary, by);
                    }
                }
                (_, None) => {}
            }
        }
        let Ceiling { sensitivity, complementary } = ceiling;
        ceiling.sensitivity.lowered(1.0 + complementary.limit, complementary.specification);
        ceiling.complementary.lowered(1.0 + sensitivity.limit, sensitivity.specification);
        ceiling
    }
}

/// The limits on |S| and |T| of the first plant that follow from a spread of at most d between two
/// plants.
///
/// ```text
/// x = L2/L1,  rho = |P1/P2|:      P1 S1/(P2 S2) = (P1/P2) (x + (1 - x) S1) = (P1/P2) (1 - (1 - x) T1),  at most d, so
/// |S1| <= (d/rho + |x|)/|1 - x|,          |T1| <= (d/rho + 1)/|1 - x|
/// ```
fn spread(own: &MemberResponse, partner: &MemberResponse, d: f64) -> [f64; 2] {
    let x = partner.plant * partner.sensor / (own.plant * own.sensor);
    let scaled = d * portable::magnitude(partner.plant / own.plant);
    let apart = portable::magnitude(1.0 - x);
    [(scaled + portable::magnitude(x)) / apart, (scaled + 1.0) / apart]
}

fn node(specifications: &[Specification], candidates: &[PlantWithinLoop], frequency: f64) -> FrequencyDemand {
    let demands: Vec<(usize, f64)> = specifications
        .iter()
        .enumerate()
        .filter_map(|(index, specification)| Some((index, demanded(specification, frequency)?)))
        .collect();
    let of = |index: &usize| specifications.get(*index).map(|specification| &specification.requirement);
    let plain = |requirement: &Requirement| {
        matches!(requirement.closed_loop(), ClosedLoop::RobustStability | ClosedLoop::Sensitivity)
    };
    let needed = demands.iter().any(|(index, _)| of(index).is_some_and(|requirement| !plain(requirement)));
    let responses: Vec<Option<MemberResponse>> = candidates
        .iter()
        .map(|candidate| if needed { candidate.member.response(frequency) } else { None })
        .collect();
    let tracked = |(index, limit): &(usize, f64)| {
        // crossed limits are reported separately
        *limit >= 1.0 && of(index).is_some_and(Requirement::is_tracking)
    };
    let partners = if demands.iter().any(tracked) { extremes(&responses) } else { Vec::new() };
    let crossed =
        |demand: &(usize, f64)| of(&demand.0).is_some_and(Requirement::is_tracking) && !tracked(demand);
    let demands = demands.into_iter().filter(|demand| !crossed(demand)).collect();
    FrequencyDemand { demands, responses, partners }
}

/// The responses of least and greatest magnitude, and those with the largest lag and lead relative
/// to the first.
fn extremes(responses: &[Option<MemberResponse>]) -> Vec<MemberResponse> {
    let known: Vec<MemberResponse> = responses.iter().flatten().copied().collect();
    let Some(first) = known.first().copied() else { return Vec::new() };
    let magnitude = |response: &MemberResponse| portable::magnitude(response.plant);
    let phase = |response: &MemberResponse| portable::argument(response.plant / first.plant);
    let measures: [&dyn Fn(&MemberResponse) -> f64; 2] = [&magnitude, &phase];
    let mut chosen = vec![first];
    for measure in measures {
        let least = known.iter().min_by(|a, b| measure(a).total_cmp(&measure(b)));
        let greatest = known.iter().max_by(|a, b| measure(a).total_cmp(&measure(b)));
        chosen.extend([least, greatest].into_iter().flatten());
    }
    chosen
}
