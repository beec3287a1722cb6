use std::f64::consts::PI;

use phea_dynamics::scalar::Scalar;

use super::{StiffnessModel, chamber_compliance};
use crate::cylinder::Cylinder;
use crate::line::{Line, StiffeningMember};

/// Length of each of two equal lines that gives the wanted least stiffness over the stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineLength {
    /// Length of each line, m.
    Length(f64),
    /// No line needed: even without a line the actuator is no stiffer than wanted.
    NotNeeded {
        /// Least stiffness over the stroke without lines, N/m.
        stiffness_without_line: f64,
    },
    /// Stiffness that no line of this kind makes low enough (none reaches zero or less).
    OutOfReach,
}

impl LineLength {
    /// Length in m: zero if none is needed, infinite if none is sufficient.
    pub fn metres(self) -> f64 {
        match self {
            LineLength::Length(length) => length,
            LineLength::NotNeeded { .. } => 0.0,
            LineLength::OutOfReach => f64::INFINITY,
        }
    }
}

/// Hose length L_ho of each line for a wanted least stiffness K_H, one modulus for hose and
/// chamber, m.
///
/// ```text
/// L_ho = 8 A^2 r_b beta_0 (pi D^2 + 4 E) / (pi D^2 K_H (4 eps beta_0 + r_b (pi D^2 + 4 E))) - 2 A L/(pi D^2)
///      = (4 beta_e A^2/K_H - A L) 2/(pi D^2)                                                   thesis (6.25)
/// ```
///
/// For a symmetric cylinder of area A and stroke L with a hose of bore D and effective modulus
/// beta_e on each side. A negative length means that no hose is needed.
pub fn hose_length_uniform<S: Scalar>(stiffness: S, area: S, stroke: S, bore: S, effective_modulus: S) -> S {
    let needed = S::from(4.0) * effective_modulus * area.squared() / stiffness - area * stroke;
    needed * S::from(2.0 / PI) / bore.squared()
}

/// Hose length L_ho of each line for a wanted least stiffness K_H, with the fluid's modulus in the
/// chamber, m.
///
/// ```text
/// L_ho = (2 A^2/K_H - A L/(2 beta_0)) / (epsilon/r_beta + (A_ho + E(p))/beta_0)      thesis (6.25), corrected
/// ```
///
/// For a symmetric cylinder, as [`hose_length_uniform`]; the divisor is
/// [`crate::line::Hose::compliance_per_length`]; a negative length means that no hose is needed.
///
/// # Example
/// The thesis' 2.24e6 N/m requires 3.64 m of its hose, not 1.5 m:
/// ```
/// use phea_hydraulics::{line::StiffeningMember, reference_rig::hose, stiffness::hose_length_by_volume};
/// let metre = hose().compliance_per_length(1.45e9, StiffeningMember::Nominal);
/// let length = hose_length_by_volume(2.24e6, 1.58336e-3, 0.5, metre, 1.45e9);
/// assert!((length - 3.64_f64).abs() < 0.005);
/// ```
pub fn hose_length_by_volume<S: Scalar>(
    stiffness: S,
    area: S,
    stroke: S,
    compliance_per_length: S,
    fluid_modulus: S,
) -> S {
    let needed = S::from(2.0) * area.squared() / stiffness - area * stroke / (S::from(2.0) * fluid_modulus);
    needed / compliance_per_length
}

/// Least stiffness K_H over the stroke from the hose length of each line, one modulus for hose and
/// chamber, N/m.
///
/// ```text
/// K_H = 8 r_b beta_0 A^2 (pi D^2 + 4 E) / ((4 eps beta_0 + r_b (pi D^2 + 4 E)) (2 A L + pi D^2 L_ho))
///     = 8 beta_e A^2 / (2 A L + pi D^2 L_ho)                                                    thesis (6.26)
/// ```
pub fn stiffness_from_hose_length<S: Scalar>(
    length: S,
    area: S,
    stroke: S,
    bore: S,
    effective_modulus: S,
) -> S {
    S::from(8.0) * effective_modulus * area.squared()
        / (S::from(2.0) * area * stroke + S::from(PI) * bore.squared() * length)
}

/// Factor of the lengths of two lines that gives the least stiffness `stiffness` in N/m over the
/// stroke: lines in this proportion, each with its own hose; either model, any cylinder.
///
/// The length of a [`Line::Volume`] is its volume over the given one. Solved by bisection, since
/// the least stiffness falls strictly as lines grow; agrees with [`hose_length_uniform`] and
/// [`hose_length_by_volume`] if these apply.
///
/// If the softest position is within the stroke and both lines have one compliance c:
///
/// ```text
/// c = (Q^2/K_H - L - k_0A/s_A - k_0B/s_B) / (1/s_A + 1/s_B),    Q = A_A/sqrt(s_A) + A_B/sqrt(s_B)
/// ```
///
/// for C_A(x) = k_0A + s_A x + c and C_B(x) = k_0B + s_B (L - x) + c.
pub fn line_fraction_for_stiffness(
    model: StiffnessModel,
    fluid_modulus: f64,
    cylinder: &Cylinder,
    lines: [&Line; 2],
    member: StiffeningMember,
    stiffness: f64,
) -> LineLength {
    if stiffness.is_nan() || stiffness <= 0.0 {
        return LineLength::OutOfReach;
    }
    let minimum_at = |fraction: f64| {
        let [line_a, line_b] = lines.map(|line| scaled(line, fraction));
        chamber_compliance(model, [fluid_modulus; 2], cylinder, [&line_a, &line_b], member)
            .over_stroke()
            .minimum
    };
    let stiffness_without_line = minimum_at(0.0);
    if stiffness_without_line <= stiffness {
        return LineLength::NotNeeded { stiffness_without_line };
    }
    let mut longer = 1.0;
    while minimum_at(longer) > stiffness {
        longer *= 2.0;
        if longer > 1e12 {
            return LineLength::OutOfReach;
        }
    }
    let mut shorter = 0.0;
    loop {
        let middle = 0.5 * (shorter + longer);
        if middle <= shorter || middle >= longer {
            return LineLength::Length(middle);
        }
        if minimum_at(middle) > stiffness {
            shorter = middle;
        } else {
            longer = middle;
        }
    }
}

fn scaled(line: &Line, fraction: f64) -> Line {
    match *line {
        Line::Hose { length, .. } | Line::Pipe { length, .. } => with_length(line, length * fraction),
        Line::Volume { .. } => with_length(line, fraction),
    }
}

fn with_length(line: &Line, length: f64) -> Line {
    match *line {
        Line::Hose { hose, .. } => Line::Hose { hose, length },
        Line::Pipe { pipe, .. } => Line::Pipe { pipe, length },
        Line::Volume { volume, effective_bulk_modulus } => {
            Line::Volume { volume: volume * length, effective_bulk_modulus }
        }
    }
}
