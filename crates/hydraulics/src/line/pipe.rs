use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Round pipe. Units: m, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pipe<S = f64> {
    /// Bore D, m.
    pub bore: S,
    /// Elasticity of the wall.
    pub wall: PipeWall<S>,
}

/// Elasticity of a pipe's wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PipeWall<S = f64> {
    /// Rigid wall.
    Rigid,
    /// Linear elasticity.
    Elastic {
        /// Wall thickness e, m.
        thickness: S,
        /// Young's modulus E, Pa.
        youngs_modulus: S,
        /// Poisson's ratio.
        poisson_ratio: S,
        /// Axial support of the pipe.
        anchoring: Anchoring,
        /// True if the stress varies over the wall (exact for any thickness), false if it is taken
        /// as uniform (D/e above 25).
        thick: bool,
    },
}

/// Axial support of a pipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchoring {
    /// Anchored throughout: no axial strain.
    Throughout,
    /// Anchored at one end, the other closed and free: axial stress from the pressure on the end.
    OneEnd,
    /// Expansion joints: no axial stress.
    ExpansionJoints,
}

impl Pipe {
    /// Impossible parameters of this pipe; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::PIPE_BORE, self.bore);
        if let PipeWall::Elastic { thickness, youngs_modulus, poisson_ratio, .. } = self.wall {
            problems.key(super::keys::WALL_THICKNESS_KEY, thickness);
            problems.key(super::keys::YOUNGS_MODULUS_KEY, youngs_modulus);
            problems.key(super::keys::POISSON_RATIO_KEY, poisson_ratio);
        }
        problems.into_vec()
    }
}

impl<S: Scalar> Pipe<S> {
    /// Relative growth of the bore's area per pressure, (dA/A)/dp, 1/Pa; zero for a rigid wall.
    pub fn wall_compliance(&self) -> S {
        match self.wall {
            PipeWall::Rigid => S::from(0.0),
            PipeWall::Elastic { thickness, youngs_modulus, poisson_ratio, anchoring, thick } => {
                pipe_wall_compliance(self.bore, thickness, youngs_modulus, poisson_ratio, anchoring, thick)
            }
        }
    }
}

/// Relative growth of a pipe's bore area per pressure, 1/beta_wall = (dA/A)/dp, 1/Pa.
///
/// ```text
/// 1/beta_wall = D/(E e) c          thin wall:  c = c_a
///                                  thick wall: c = 2 (e/D) (1 + nu) + D/(D + e) c_a
/// c_a = 1 - nu^2 (held throughout), 1 - nu/2 (held at one end), 1 (expansion joints)
/// ```
///
/// Source: Wylie and Streeter (1993), "Fluid Transients in Systems", chapter 2; the thick wall is
/// Lamé's solution.
///
/// # Example
/// A thick steel wall follows Lamé: (dA/A)/p = 2/E ((b^2 + a^2)/(b^2 - a^2) + nu) for radii a and
/// b:
/// ```
/// use phea_hydraulics::line::{Anchoring, pipe_wall_compliance};
/// let (a, b, e, nu) = (5e-3, 8e-3, 206e9, 0.3);
/// let lame = 2.0 / e * ((b * b + a * a) / (b * b - a * a) + nu);
/// let wall = pipe_wall_compliance(2.0 * a, b - a, e, nu, Anchoring::ExpansionJoints, true);
/// assert!((wall / lame - 1.0_f64).abs() < 1e-14);
/// ```
pub fn pipe_wall_compliance<S: Scalar>(
    bore: S,
    thickness: S,
    youngs_modulus: S,
    poisson_ratio: S,
    anchoring: Anchoring,
    thick: bool,
) -> S {
    let one = S::from(1.0);
    let axial = match anchoring {
        Anchoring::Throughout => one - poisson_ratio.squared(),
        Anchoring::OneEnd => one - poisson_ratio / S::from(2.0),
        Anchoring::ExpansionJoints => one,
    };
    let shape = if thick {
        S::from(2.0) * thickness / bore * (one + poisson_ratio) + bore / (bore + thickness) * axial
    } else {
        axial
    };
    bore / (youngs_modulus * thickness) * shape
}
