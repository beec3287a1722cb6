//! All specifications at one frequency together: the allowed region of the nominal loop, the gains
//! forbidden by each specification, and contradictions between them.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::covering::covering;
use super::function::BoundFunction;
use super::interval::GainIntervals;
use super::phases::{PhaseGrid, PhaseSample, sampled};
use super::{Bound, BoundError, TemplateFill};
use crate::specification::Specification;
use crate::template::Template;

/// The bounds of all specifications that have one frequency among their design frequencies.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_qft::bound::{Feasibility, TemplateFill, FrequencyBounds, PhaseGrid, Placement};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::template::{Resolution, Template, TemplatePoint};
/// let one = Complex64::new(1.0, 0.0);
/// let plant = TemplatePoint { member: Some(0), values: vec![], response: one, load_motion: one, sensor: one };
/// let template = Template {
///     frequency_rad_per_s: 1.0, nominal: one, points: vec![plant], outlines: vec![], resolution: Resolution::Members,
/// };
/// let specification = |requirement| Specification {
///     requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: [1.0, 1.0],
/// };
/// // |S| <= 1/2 and |T| <= 1/2 contradict each other, since S + T = 1: only S = T = 1/2 would do
/// let bounds = FrequencyBounds::new(&template, &[
///     specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.4))),
///     specification(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(0.5))),
/// ], TemplateFill::Points)?;
/// let Feasibility::Nowhere { collisions } = bounds.combined(&PhaseGrid::default()).feasibility else { panic!() };
/// assert_eq!(collisions[0].specifications, [0, 1]); // more gain for the first, less for the second
/// assert_eq!(bounds.placement(Complex64::new(4.0, 0.0)), Placement::Forbidden { by: vec![1], nearest_db: None });
/// # Ok::<(), phea_qft::bound::BoundError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FrequencyBounds {
    frequency_rad_per_s: f64,
    functions: Vec<(usize, BoundFunction)>,
}

/// The bound of one specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationBound {
    /// Index of the specification, from 0.
    pub specification: usize,
    /// Bound of the specification.
    pub bound: Bound,
}

/// The bounds of several specifications at one frequency, at common phases, and their union.
#[derive(Clone, Debug, PartialEq)]
pub struct CombinedBound {
    /// The gains forbidden by any specification.
    pub union: Bound,
    /// The gains forbidden by each specification.
    pub parts: Vec<SpecificationBound>,
    /// Existence of allowed gains.
    pub feasibility: Feasibility,
}

/// Existence of allowed gains at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum Feasibility {
    /// Allowed gains exist at every examined phase.
    Everywhere,
    /// Allowed gains exist only at some phases.
    Somewhere {
        /// The phases without an allowed gain, in increasing order.
        collisions: Vec<Collision>,
    },
    /// Allowed gains exist at no examined phase.
    Nowhere {
        /// The phases and the conflicting specifications, in order of increasing phase.
        collisions: Vec<Collision>,
    },
}

/// Phases without an allowed gain, and the specifications that together exclude every gain.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// First and last of these neighbouring phases, rad.
    pub phases_rad: [f64; 2],
    /// The fewest specifications that together forbid every gain: a single one, or two that
    /// contradict each other, in the order of the gains that they forbid, lowest first (it requires
    /// more gain); more than two only if no two of them suffice.
    pub specifications: Vec<usize>,
}

/// Position of a nominal loop relative to the bounds.
#[derive(Clone, Debug, PartialEq)]
pub enum Placement {
    /// Every specification allows it.
    Allowed {
        /// Distance to the nearest forbidden gain at its phase, dB; infinite if there is none.
        slack_db: f64,
    },
    /// Some specifications forbid it.
    Forbidden {
        /// Indices of the specifications that forbid it.
        by: Vec<usize>,
        /// The change to the nearest gain at its phase that all specifications allow, dB; positive
        /// for more gain. `None` if there is no such gain.
        nearest_db: Option<f64>,
    },
}

impl FrequencyBounds {
    /// Prepares the bounds of those specifications whose design frequencies include the template's
    /// and that apply there.
    ///
    /// # Errors
    /// [`BoundError`], see [`BoundFunction::new`].
    pub fn new(
        template: &Template,
        specifications: &[Specification],
        fill: TemplateFill,
    ) -> Result<FrequencyBounds, BoundError> {
        let frequency_rad_per_s = template.frequency_rad_per_s;
        let functions = specifications
            .iter()
            .enumerate()
            .filter(|(_, specification)| specification.frequencies_rad_per_s.contains(&frequency_rad_per_s))
            .filter_map(|(index, specification)| {
                match BoundFunction::new(template, &specification.requirement, fill) {
                    // a table that does not cover this frequency sets no limit here
                    Err(BoundError::NoLimit { .. }) => None,
                    function => Some(function.map(|function| (index, function))),
                }
            })
            .collect::<Result<_, BoundError>>()?;
        Ok(FrequencyBounds { frequency_rad_per_s, functions })
    }

    /// The bounds at the phases of a grid, refined where one of them or their union bends.
    pub fn combined(&self, grid: &PhaseGrid) -> CombinedBound {
        let functions: Vec<&BoundFunction> = self.functions.iter().map(|(_, function)| function).collect();
        let samples = sampled(grid, &functions);
        let bound = |place: usize| Bound {
            frequency_rad_per_s: self.frequency_rad_per_s,
            phases_rad: samples.iter().map(|sample| sample.phase_rad).collect(),
            forbidden: samples.iter().filter_map(|sample| sample.forbidden.get(place).cloned()).collect(),
        };
        let parts = self.functions.iter().enumerate();
        CombinedBound {
            union: bound(self.functions.len()),
            parts: parts
                .map(|(place, (specification, _))| SpecificationBound {
                    specification: *specification,
                    bound: bound(place),
                })
                .collect(),
            feasibility: self.feasibility(&samples),
        }
    }

    /// Position of a nominal loop relative to the bounds, exact at its own phase.
    ///
    /// A loop that is zero or not finite has no phase: it is evaluated at phase 0, where only its
    /// gain matters.
    pub fn placement(&self, nominal_loop: Complex64) -> Placement {
        let gain = portable::magnitude(nominal_loop);
        let phased = gain > 0.0 && gain.is_finite();
        let direction = if phased { nominal_loop / gain } else { Complex64::new(1.0, 0.0) };
        let each: Vec<(usize, GainIntervals)> = self
            .functions
            .iter()
            .map(|(index, function)| (*index, function.forbidden_towards(direction)))
            .collect();
        let union = union_of(each.iter().map(|(_, forbidden)| forbidden));
        match union.around(gain) {
            None => Placement::Allowed { slack_db: slack_db(&union, gain) },
            Some([low, high]) => Placement::Forbidden {
                by: each.iter().filter(|(_, own)| own.contains(gain)).map(|(index, _)| *index).collect(),
                nearest_db: [low, high]
                    .into_iter()
                    .filter(|end| *end > 0.0 && end.is_finite())
                    .map(|end| distance_db(gain, end))
                    .min_by(|a, b| a.abs().total_cmp(&b.abs())),
            },
        }
    }

    fn feasibility(&self, samples: &[PhaseSample]) -> Feasibility {
        let mut collisions: Vec<Collision> = Vec::new();
        let mut continues = false;
        let mut blocked = 0;
        for PhaseSample { phase_rad, forbidden } in samples {
            let Some((union, parts)) = forbidden.split_last() else { continue };
            if !union.is_everything() {
                continues = false;
                continue;
            }
            blocked += 1;
            let culprits = self.culprits(parts);
            match collisions.last_mut() {
                Some(last) if continues && last.specifications == culprits => last.phases_rad[1] = *phase_rad,
                _ => collisions.push(Collision {
                    frequency_rad_per_s: self.frequency_rad_per_s,
                    phases_rad: [*phase_rad, *phase_rad],
                    specifications: culprits,
                }),
            }
            continues = true;
        }
        match blocked {
            0 => Feasibility::Everywhere,
            _ if blocked == samples.len() => Feasibility::Nowhere { collisions },
            _ => Feasibility::Somewhere { collisions },
        }
    }

    /// The fewest of these specifications that together forbid every gain, given that all of them
    /// together do.
    fn culprits(&self, parts: &[GainIntervals]) -> Vec<usize> {
        let own = || self.functions.iter().map(|(index, _)| *index).zip(parts);
        if let Some((index, _)) = own().find(|(_, part)| part.is_everything()) {
            return vec![index];
        }
        let from_zero = |part: &GainIntervals| part.intervals().first().is_some_and(|[low, _]| *low == 0.0);
        let pair = own().filter(|(_, part)| from_zero(part)).find_map(|(index, part)| {
            let other = own().find(|(_, other)| part.union(other).is_everything())?;
            Some(vec![index, other.0])
        });
        pair.unwrap_or_else(|| covering(own().collect()))
    }
}

fn union_of<'a>(parts: impl Iterator<Item = &'a GainIntervals>) -> GainIntervals {
    GainIntervals::union_of(parts.flat_map(GainIntervals::intervals).copied().collect())
}

fn distance_db(from: f64, to: f64) -> f64 {
    20.0 * portable::log10(to / from)
}

fn slack_db(union: &GainIntervals, gain: f64) -> f64 {
    let ends = union.intervals().iter().flatten().filter(|end| **end > 0.0);
    ends.map(|end| distance_db(gain, *end).abs()).fold(f64::INFINITY, f64::min)
}
