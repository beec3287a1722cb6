//! The controllers of a manual as structures with free numbers.

use phea_dynamics::controller::{Element, NamedStructure};

use super::candidates::{Corners, Ground};
use crate::loop_shaping::{Structure, StructureFactor};

/// Damping ratios of the poles of a notch, which are exempt from the least damping of other poles,
/// and its depths: from -30 dB, as deep as can be built, to none.
const NOTCH_DAMPING_RATIOS: [f64; 2] = [0.1, 3.0];
const NOTCH_DEPTHS: [f64; 2] = [0.03162277660168379, 1.0];
/// Damping ratios of the zeros of a PID; above 1 the pair is two real zeros.
const PID_DAMPING_RATIOS: [f64; 2] = [0.2, 20.0];

/// Name of the design stage for this structure.
pub(super) fn stage(name: NamedStructure) -> &'static str {
    match name {
        NamedStructure::Proportional => "trying P",
        NamedStructure::Integral => "trying I",
        NamedStructure::ProportionalIntegral => "trying PI",
        NamedStructure::PiLowPass => "trying PI+low-pass",
        NamedStructure::Pid => "trying PID",
        NamedStructure::PiNotch => "trying PI+notch",
        NamedStructure::PiNotchLowPass => "trying PI+notch+low-pass",
        NamedStructure::PiNotchLead => "trying PI+notch+lead",
        NamedStructure::PiTwoNotches => "trying PI+notch+notch",
    }
}

/// True if structures of growing order with these poles and zeros are also of this kind.
pub(super) fn is_named(order: usize, zeros: usize, integrators: usize) -> bool {
    matches!((integrators, order, zeros), (0, 0, 0) | (1, 1, 0 | 1) | (1, 2, 1 | 2))
}

/// The name of a structure with the factors of a named one.
///
/// # Example
/// ```
/// use phea_dynamics::controller::{Element, NamedStructure};
/// use phea_qft::design::name_of;
/// use phea_qft::loop_shaping::{Structure, StructureFactor};
/// let parts = vec![
///     StructureFactor::Fixed(Element::Integrator),
///     StructureFactor::RealZero { frequency: [1.0, 100.0] },
/// ];
/// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts };
/// assert_eq!(name_of(&structure), Some(NamedStructure::ProportionalIntegral));
/// ```
pub fn name_of(structure: &Structure) -> Option<NamedStructure> {
    use StructureFactor::{Fixed, Notch, RealPole, RealZero, ZeroPair};
    let Some((integrator, behind)) = structure.parts.split_first() else {
        return Some(NamedStructure::Proportional);
    };
    if !matches!(integrator, Fixed(Element::Integrator)) {
        return None;
    }
    match behind {
        [] => Some(NamedStructure::Integral),
        [RealZero { .. }] => Some(NamedStructure::ProportionalIntegral),
        [RealZero { .. }, RealPole { .. }] => Some(NamedStructure::PiLowPass),
        [ZeroPair { .. }, RealPole { .. }] => Some(NamedStructure::Pid),
        [RealZero { .. }, Notch { .. }] => Some(NamedStructure::PiNotch),
        [RealZero { .. }, Notch { .. }, RealPole { .. }] => Some(NamedStructure::PiNotchLowPass),
        [RealZero { .. }, Notch { .. }, RealZero { .. }, RealPole { .. }] => {
            Some(NamedStructure::PiNotchLead)
        }
        [RealZero { .. }, Notch { .. }, Notch { .. }] => Some(NamedStructure::PiTwoNotches),
        _ => None,
    }
}

/// Named structure with free numbers between the corners of the problem.
pub(super) fn named_structure(name: NamedStructure, ground: &Ground) -> Structure {
    let Corners { of_zeros, of_poles } = ground.corners();
    let zero = StructureFactor::RealZero { frequency: of_zeros };
    let pole = StructureFactor::RealPole { frequency: of_poles };
    let notch = StructureFactor::Notch {
        natural_frequency: of_poles,
        damping_ratio: NOTCH_DAMPING_RATIOS,
        depth: NOTCH_DEPTHS,
    };
    let zero_pair =
        StructureFactor::ZeroPair { natural_frequency: of_zeros, damping_ratio: PID_DAMPING_RATIOS };
    let behind = match name {
        NamedStructure::Proportional => return ground.pure_gain(),
        NamedStructure::Integral => vec![],
        NamedStructure::ProportionalIntegral => vec![zero],
        NamedStructure::PiLowPass => vec![zero, pole],
        NamedStructure::Pid => vec![zero_pair, pole],
        NamedStructure::PiNotch => vec![zero, notch],
        NamedStructure::PiNotchLowPass => vec![zero, notch, pole],
        NamedStructure::PiNotchLead => vec![zero.clone(), notch, zero, pole],
        NamedStructure::PiTwoNotches => vec![zero, notch.clone(), notch],
    };
    let integrator = StructureFactor::Fixed(Element::Integrator);
    ground.with_gain(std::iter::once(integrator).chain(behind).collect())
}
