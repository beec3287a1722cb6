//! Ranges of `[uncertainty]` that follow a rig: ranges of parameters of the linear model are moved
//! by the factor by which another rig changes the parameter.

use phea_hydraulics::line::StiffeningMember;

use super::{PrepareError, PreparedAlternative};
use crate::linearize::stroke_stiffness;
use crate::project::Uncertain;
use crate::rig::Rig;

/// A moved range.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedRange {
    /// Name of the parameter of the linear model.
    pub name: String,
    /// Nominal value, minimum and maximum as they were stated, SI.
    pub stated: [f64; 3],
    /// Nominal value, minimum and maximum for the rig of the alternative, SI.
    pub moved: [f64; 3],
}

/// Relative change of a parameter that counts as zero.
const SAME: f64 = 1e-9;

/// Ranges that the rig of another project moves.
///
/// ```text
/// least' = least k(least)       greatest' = greatest k(greatest)       nominal' = nominal k, within both
/// ```
///
/// k is the quotient of the derived parameter of both rigs at their operating points. For K_H,
/// whose range is that over the stroke, the ends have the quotients of the least and of the
/// greatest stiffness over the stroke. A range that the other project states differently is not
/// moved, nor is a parameter that `[linear]` states.
pub(super) fn moved(
    base: &PreparedAlternative,
    other: &PreparedAlternative,
) -> Result<Vec<MovedRange>, PrepareError> {
    let rigs = [base.rig.as_ref().map_err(Clone::clone)?, other.rig.as_ref().map_err(Clone::clone)?];
    let [base, other] = [base, other].map(|one| &one.loaded.project);
    let inherited = |range: &&Uncertain| base.uncertainty.contains(range);
    let mut found = Vec::new();
    for range in other.uncertainty.iter().filter(inherited) {
        let Some([from, to]) = derived(&rigs, &range.name) else { continue };
        if other.linear.get(&range.name).is_some() || same(&from, &to) {
            continue;
        }
        if from.contains(&0.0) {
            return Err(PrepareError::ZeroRange { parameter: range.name.clone() });
        }
        let scaled = |stated: f64, end: usize| stated * to[end] / from[end];
        let [least, greatest] = [scaled(range.minimum, 1), scaled(range.maximum, 2)];
        found.push(MovedRange {
            name: range.name.clone(),
            stated: [range.nominal, range.minimum, range.maximum],
            moved: [scaled(range.nominal, 0).max(least).min(greatest), least, greatest],
        });
    }
    Ok(found)
}

/// Derived parameter of each rig: at the operating point, and the values by which its least and its
/// greatest value are scaled.
fn derived(rigs: &[&Rig; 2], name: &str) -> Option<[[f64; 3]; 2]> {
    let of = |rig: &Rig| {
        let found = rig.parameters.iter().find(|parameter| parameter.name == name)?;
        let here = found.derived;
        Some(match name {
            "hydraulic_stiffness" => {
                let stroke = stroke_stiffness(rig, StiffeningMember::Nominal);
                [here, stroke.minimum, stroke.maximum]
            }
            _ => [here; 3],
        })
    };
    Some([of(rigs[0])?, of(rigs[1])?])
}

fn same(from: &[f64; 3], to: &[f64; 3]) -> bool {
    from.iter().zip(to).all(|(from, to)| (to - from).abs() <= SAME * from.abs())
}

/// Settings for `--set` with the moved ranges.
pub(super) fn settings(moved: &[MovedRange]) -> Vec<String> {
    let each = moved.iter().flat_map(|range| {
        let parts = ["nominal", "minimum", "maximum"].into_iter().zip(range.moved);
        parts.map(|(part, value)| format!("uncertainty.{}.{part}={value:e}", range.name))
    });
    each.collect()
}
