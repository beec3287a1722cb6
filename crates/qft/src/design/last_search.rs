//! Continuation of the last search of a design.

use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sort_by_number;

use super::attempt::{LoopDesignError, NEIGHBOURS};
use super::problem::DesignOptions;
use super::result::{Design, DesignStatus};
use super::{Objective, PoleRange};
use crate::loop_shaping::{Aim, Samples, Shaping, Structure, StructureFactor};
use crate::verification::PlantPoint;

/// The shaping of a design at these samples, with the aim of its search: the least objective, or if
/// the limits were missed, the greatest worst margin.
///
/// # Errors
/// [`LinearError`] for a structure that cannot be sampled.
pub fn last_search(
    design: &Design,
    mut samples: Samples,
    options: &DesignOptions,
) -> Result<(Shaping, Aim), LinearError> {
    let relaxes = matches!(design.status, DesignStatus::Infeasible(_));
    samples.keep_in_reserve(options.search_reserve_db(relaxes));
    samples.count_fractions_of_room(options.objective == Objective::BestWorstMargin && !relaxes);
    let (structure, prefilter) = (design.structure.clone(), design.prefilter.clone());
    let shaping = Shaping::new(structure, prefilter, options.objective, samples)?;
    Ok((shaping, options.aim(relaxes)))
}

/// Adds to a search the points next to the samples with the least margins at x, since a peak moves
/// with the limits.
///
/// # Errors
/// [`LoopDesignError`] for a structure that cannot be sampled.
pub fn sample_near_worst(shaping: &mut Shaping, x: &[f64]) -> Result<(), LoopDesignError> {
    let frequencies = shaping.samples().frequencies_rad_per_s();
    let (Some(&lowest), Some(&highest)) = (frequencies.first(), frequencies.last()) else { return Ok(()) };
    let mut margins = shaping.margins(x);
    sort_by_number(&mut margins, |margin| margin.margin_db);
    let mut known: Vec<usize> = Vec::new();
    for margin in margins {
        if known.contains(&margin.specification) {
            continue;
        }
        known.push(margin.specification);
        let plants: Vec<PlantPoint> = margin.plants().cloned().collect();
        for factor in NEIGHBOURS {
            shaping.add(&plants, (factor * margin.frequency_rad_per_s).clamp(lowest, highest))?;
        }
    }
    Ok(())
}

impl Structure {
    /// Structure with another range of poles in place of the original one.
    ///
    /// # Example
    /// ```
    /// use phea_qft::design::PoleRange;
    /// use phea_qft::loop_shaping::{Structure, StructureFactor};
    /// let fastest = |frequency: f64| Structure {
    ///     sign: 1.0,
    ///     gain: [0.1, 10.0],
    ///     parts: vec![StructureFactor::RealPole { frequency: [1.0, frequency] }],
    /// };
    /// let range = |frequency: f64| PoleRange { fastest_rad_per_s: frequency, ..PoleRange::default() };
    /// assert_eq!(fastest(100.0).with_poles_in([range(100.0), range(110.0)]), fastest(110.0));
    /// ```
    #[must_use]
    pub fn with_poles_in(&self, [from, to]: [PoleRange; 2]) -> Structure {
        let moved = |end: &mut f64, [from, to]: [f64; 2]| {
            if *end == from {
                *end = to;
            }
        };
        let fastest = [from.fastest_rad_per_s, to.fastest_rad_per_s];
        let damping = [from.least_damping_ratio, to.least_damping_ratio];
        let mut structure = self.clone();
        for part in &mut structure.parts {
            match part {
                StructureFactor::RealPole { frequency: [_, greatest] }
                | StructureFactor::Notch { natural_frequency: [_, greatest], .. } => moved(greatest, fastest),
                StructureFactor::PolePair { natural_frequency: [_, greatest], damping_ratio: [least, _] } => {
                    moved(greatest, fastest);
                    moved(least, damping);
                }
                StructureFactor::Fixed(_)
                | StructureFactor::RealZero { .. }
                | StructureFactor::ZeroPair { .. } => {}
            }
        }
        structure
    }
}
