//! Linkage between the rod and a load that turns about a joint: x_L = g(theta).
//!
//! ```text
//! tau = F_L g'(theta),     v_L = g'(theta) omega                 so that F_L v_L = tau omega
//! ```
//!
//! The lever arm g' is in m, or m/rad. The position x_L is that of the end of the force sensor on
//! the load's side, in the coordinate of the piston; it grows with the angle theta of the joint,
//! and so does the torque with which the rod pushes. A triangle, a four-bar and a table are reduced
//! to one polynomial over the stroke, which both machine and plant evaluate.

mod chebyshev;
mod checks;
mod component;
mod geometry;
mod keys;
mod weight;

pub use keys::{
    CylinderTriangle, DeclaredLinkage, DeclaredLinks, DeclaredWeight, FourBarBranch, LinkageKind,
};
pub use weight::{LinkedWeight, STANDARD_GRAVITY, WeightAt};

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, ParameterRequirement, Problems};
use chebyshev::ChebyshevSeries;
use geometry::{rising_root, through_table, where_it_is};

/// Margin beyond either end of the stroke over which the polynomial represents the linkage, as a
/// fraction of the stroke: end stops yield, and so does the force sensor.
const BEYOND: f64 = 0.01;
/// Number of positions at which a linkage is examined.
const EXAMINED: usize = 401;
/// Largest error of the polynomial, as a fraction of the stroke.
const LARGEST_ERROR: f64 = 1e-6;
/// Shortest lever arm, as a fraction of the longest.
const SHORTEST_ARM: f64 = 0.02;
/// Newton steps to the angle from the polynomial that estimates it.
const STEPS: usize = 2;

/// Cylinder between two pivots on either side of a joint. Units: m, rad.
///
/// ```text
/// l = l_0 + x,     cos(phi) = (a^2 + b^2 - l^2)/(2 a b),     theta = phi - phi_0
/// ```
///
/// Angle phi is at the joint between both pivots; phi_0 shifts the zero of theta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotTriangle {
    /// Distance a from the joint to the pivot of the cylinder's body.
    pub cylinder_pivot: f64,
    /// Distance b from the joint to the pivot of the rod.
    pub rod_pivot: f64,
    /// Distance l_0 from pivot to pivot at x = 0.
    pub retracted_length: f64,
}

/// Cylinder that turns the input link of a four-bar linkage by a triangle about its joint. Units:
/// m, rad.
///
/// ```text
/// alpha = phi + alpha_0,   A = r (cos alpha, sin alpha),   D = (d, 0),   e = |A - D|
/// cos(beta) = (e^2 + o^2 - c^2)/(2 e o),   psi = arg(A - D) -+ beta         - open, + crossed
/// ```
///
/// Angle alpha is that of the input link from the fixed link, psi that of the output link, counted
/// in the same sense; theta is psi or -psi, whichever grows with x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBar {
    /// Triangle about the joint of the input link.
    pub triangle: PivotTriangle,
    /// Angle alpha_0, rad.
    pub input_angle: f64,
    /// Length d from joint to joint.
    pub fixed_link: f64,
    /// Length r.
    pub input_link: f64,
    /// Length c.
    pub coupler: f64,
    /// Length o.
    pub output_link: f64,
    /// True if coupler and fixed link cross.
    pub crossed: bool,
}

/// Measured angles over the stroke. Units: m, rad. Both lists increase.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkageTable {
    /// Extension x of each row.
    pub extensions: Vec<f64>,
    /// Angle theta of each row.
    pub angles: Vec<f64>,
    /// Largest distance of the polynomial from a row, m.
    pub tolerance: f64,
}

/// Geometry of a linkage.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkageGeometry {
    /// Single joint.
    Triangle(PivotTriangle),
    /// Four joints in addition to those of the cylinder.
    FourBar(FourBar),
    /// Measured table of an unknown geometry.
    Table(LinkageTable),
}

/// Function g and data for its inversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linkage<S = f64> {
    /// Extension g(theta), m.
    extension: ChebyshevSeries<S>,
    /// Angle theta(x), close enough for Newton's steps, rad.
    guess: ChebyshevSeries<S>,
    /// Weight of the load; `None` if gravity exerts no torque.
    weight: Option<LinkedWeight<S>>,
}

/// Load end of the rod at one angle. Units: m, m/rad, m/rad2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodEnd<S = f64> {
    /// Position x_L = g.
    pub position: S,
    /// Lever arm g'.
    pub lever_arm: S,
    /// Slope g'' of the lever arm.
    pub lever_slope: S,
}

/// Error for a linkage that does not exist. Positions are those of the piston in m.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LinkageError {
    /// Sides that form no triangle.
    #[error("the triangle of cylinder and joint does not close at {position} m")]
    NoTriangle {
        /// First such position.
        position: f64,
        /// Distance from pivot to pivot there.
        length: f64,
        /// Least and greatest of the possible lengths.
        possible: [f64; 2],
    },
    /// Links of a four-bar linkage that do not meet.
    #[error("coupler and output link do not meet at {position} m")]
    NoFourBar {
        /// First such position.
        position: f64,
    },
    /// A joint that reverses, or whose lever arm nearly vanishes or grows beyond bounds.
    #[error("the linkage is at a dead point at {position} m")]
    DeadPoint {
        /// Position of the dead point.
        position: f64,
    },
    /// A lever arm that changes too much for one polynomial.
    #[error("no polynomial follows the linkage over its stroke: {error} m are left")]
    NotSmooth {
        /// Largest error of the polynomial, m.
        error: f64,
    },
    /// A table of fewer than two rows.
    #[error("a table of {rows} rows describes no linkage")]
    FewRows {
        /// Number of rows.
        rows: usize,
    },
    /// A row of a table that does not increase.
    #[error("row {row} of the table does not increase")]
    TableOrder {
        /// Index of the row, counted from 1.
        row: usize,
    },
    /// A table that is not smooth enough.
    #[error(
        "the table is not smooth: a polynomial of degree {degree} leaves {residual} m, {tolerance} m are permitted"
    )]
    TableRough {
        /// Residual of the highest degree, m.
        residual: f64,
        /// Permitted residual, m.
        tolerance: f64,
        /// Highest degree for these rows.
        degree: usize,
    },
    /// A table that does not cover both ends of the stroke.
    #[error("the table extends from {from} m to {to} m and not over the stroke")]
    TableShort {
        /// First extension.
        from: f64,
        /// Last extension.
        to: f64,
    },
}

/// Linkage after its reduction to polynomials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedLinkage {
    /// The linkage.
    pub linkage: Linkage,
    /// Largest error of the polynomial, m; for a table, its largest distance from a row.
    pub residual: f64,
}

impl LinkageGeometry {
    /// Reduced linkage over a stroke in m; theta is the angle of the geometry less `angle_offset`
    /// in rad.
    ///
    /// # Errors
    /// Linkage that does not close, or reaches a dead point, within the stroke or a hundredth of it
    /// beyond; a table that is too short or too rough.
    ///
    /// # Example
    /// A right angle between both arms: a cylinder of 5 with arms of 3 and 4, whose lever arm is
    /// 3 * 4/5.
    /// ```
    /// use phea_hydraulics::linkage::{LinkageGeometry, PivotTriangle};
    /// use std::f64::consts::FRAC_PI_2;
    /// let triangle = PivotTriangle { cylinder_pivot: 0.4, rod_pivot: 0.3, retracted_length: 0.45 };
    /// let linkage = LinkageGeometry::Triangle(triangle).reduced(0.1, 0.0)?.linkage;
    /// let end = linkage.end(FRAC_PI_2);
    /// assert!((end.position - 0.05).abs() < 1e-10 && (end.lever_arm - 0.24).abs() < 1e-8);
    /// assert!((linkage.angle(0.05_f64) - FRAC_PI_2).abs() < 1e-9);
    /// # Ok::<(), phea_hydraulics::linkage::LinkageError>(())
    /// ```
    pub fn reduced(&self, stroke: f64, angle_offset: f64) -> Result<ReducedLinkage, LinkageError> {
        let range = [-BEYOND * stroke, (1.0 + BEYOND) * stroke];
        let table = match self {
            LinkageGeometry::Table(table) => {
                check_rows(table, stroke)?;
                Some(through_table(table)?)
            }
            _ => None,
        };
        let positions: Vec<f64> = (0..EXAMINED)
            .map(|place| range[0] + (range[1] - range[0]) * place as f64 / (EXAMINED - 1) as f64)
            .collect();
        let closed = |position: f64| self.closed(table.as_ref().map(|(series, _)| series), position);
        let seen = positions.iter().map(|position| closed(*position)).collect::<Result<Vec<f64>, _>>()?;
        let middle = seen[EXAMINED / 2];
        // only the argument of a four-bar's link jumps by a full turn
        let jumps = matches!(self, LinkageGeometry::FourBar(_));
        let unwrapped = |angle: f64| if jumps { middle + wrapped(angle - middle) } else { angle };
        let turns = unwrapped(seen[EXAMINED - 1]) - unwrapped(seen[0]);
        let sense = if turns < 0.0 { -1.0 } else { 1.0 };
        // for a four-bar linkage the middle of the stroke is within half a turn of zero
        let own = sense * middle - angle_offset;
        let zero = if jumps { angle_offset + own - wrapped(own) } else { angle_offset };
        let angle = |position: f64| Ok(sense * unwrapped(closed(position)?) - zero);
        for (pair, position) in seen.windows(2).zip(&positions) {
            if sense * (unwrapped(pair[1]) - unwrapped(pair[0])) <= 0.0 {
                return Err(LinkageError::DeadPoint { position: *position });
            }
        }
        let guess = ChebyshevSeries::through(range, angle)?;
        let extension = match table {
            Some((series, _)) => ChebyshevSeries { middle: series.middle - angle_offset, ..series },
            None => ChebyshevSeries::through([angle(range[0])?, angle(range[1])?], |wanted| {
                let ahead = |position: f64| angle(position).ok().map(|found| found - wanted);
                rising_root(ahead, range).ok_or(LinkageError::DeadPoint { position: range[0] })
            })?,
        };
        let linkage = Linkage { extension, guess, weight: None };
        let error = linkage.examined(&positions, angle)?;
        match error <= LARGEST_ERROR * stroke {
            true => Ok(ReducedLinkage { linkage, residual: table.map_or(error, |(_, residual)| residual) }),
            false => Err(LinkageError::NotSmooth { error }),
        }
    }

    /// Angle of the geometry at a position in m, rad; for a table by its polynomial.
    fn closed(&self, table: Option<&ChebyshevSeries>, position: f64) -> Result<f64, LinkageError> {
        let dead = LinkageError::DeadPoint { position };
        match (self, table) {
            (LinkageGeometry::Triangle(triangle), _) => triangle.closed(position),
            (LinkageGeometry::FourBar(links), _) => {
                links.triangle.closed(position)?;
                links.output(position).ok_or(LinkageError::NoFourBar { position })
            }
            (LinkageGeometry::Table(_), Some(series)) => where_it_is(series, position).ok_or(dead),
            (LinkageGeometry::Table(_), None) => Err(dead),
        }
    }
}

impl PivotTriangle {
    fn closed(&self, position: f64) -> Result<f64, LinkageError> {
        let (a, b) = (self.cylinder_pivot, self.rod_pivot);
        let length = self.retracted_length + position;
        let possible = [(a - b).abs(), a + b];
        self.opening(position).ok_or(LinkageError::NoTriangle { position, length, possible })
    }
}

/// Angle within half a turn.
fn wrapped(angle: f64) -> f64 {
    let turn = 2.0 * std::f64::consts::PI;
    angle - turn * (angle / turn).round()
}

/// Rejects rows that do not increase, or do not cover the stroke.
fn check_rows(table: &LinkageTable, stroke: f64) -> Result<(), LinkageError> {
    let rows = table.angles.len().min(table.extensions.len());
    let rising = |values: &[f64], row: usize| values[row] > values[row - 1];
    let wrong = (1..rows).find(|row| !(rising(&table.angles, *row) && rising(&table.extensions, *row)));
    if let Some(row) = wrong {
        return Err(LinkageError::TableOrder { row: row + 1 });
    }
    let (Some(from), Some(to)) = (table.extensions.first(), table.extensions.get(rows.saturating_sub(1)))
    else {
        return Err(LinkageError::FewRows { rows });
    };
    let slack = LARGEST_ERROR * stroke;
    if *from > slack || *to < stroke - slack {
        return Err(LinkageError::TableShort { from: *from, to: *to });
    }
    Ok(())
}

impl Linkage {
    /// Largest error in m over these positions, none of which may be a dead point.
    fn examined(
        &self,
        positions: &[f64],
        angle: impl Fn(f64) -> Result<f64, LinkageError>,
    ) -> Result<f64, LinkageError> {
        let arms: Vec<f64> =
            positions.iter().map(|position| self.end(self.angle(*position)).lever_arm).collect();
        let longest = arms.iter().copied().fold(0.0, f64::max);
        for (position, arm) in positions.iter().zip(&arms) {
            if arm.is_nan() || *arm < SHORTEST_ARM * longest {
                return Err(LinkageError::DeadPoint { position: *position });
            }
        }
        let mut worst = 0.0_f64;
        for position in positions {
            let error = (self.end(angle(*position)?).position - position).abs();
            let inverted = (self.end(self.angle(*position)).position - position).abs();
            worst = worst.max(error).max(inverted);
        }
        Ok(worst)
    }

    /// Numbers that are not finite, in place of a linkage that does not exist; empty if there are
    /// none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        let first = self.extension.coefficients[0];
        problems.require("geometry", first, true, ParameterRequirement::ClosedLinkage);
        problems.into_vec()
    }
}

impl<S: Scalar> Linkage<S> {
    /// Placeholder for a linkage that does not exist: [`Linkage::problems`] rejects it.
    pub fn impossible() -> Linkage<S> {
        let none = S::from(f64::NAN);
        let series =
            ChebyshevSeries { coefficients: [none; chebyshev::TERMS], middle: none, half_width: none };
        Linkage { extension: series, guess: series, weight: None }
    }

    /// Position of the load's end of the rod at an angle in rad, and the lever arm there.
    ///
    /// # Example
    /// A table that is a straight line has a constant lever arm:
    /// ```
    /// use phea_hydraulics::linkage::{LinkageGeometry, LinkageTable};
    /// let table = LinkageTable { extensions: vec![0.0, 0.1], angles: vec![-1.0, 1.0], tolerance: 1e-6 };
    /// let linkage = LinkageGeometry::Table(table).reduced(0.1, 0.0)?.linkage;
    /// let end = linkage.end(0.5);
    /// assert!((end.position - 0.075).abs() < 1e-15 && (end.lever_arm - 0.05).abs() < 1e-15);
    /// # Ok::<(), phea_hydraulics::linkage::LinkageError>(())
    /// ```
    #[inline(always)]
    pub fn end(&self, angle: S) -> RodEnd<S> {
        let [position, lever_arm, lever_slope] = self.extension.at(angle);
        RodEnd { position, lever_arm, lever_slope }
    }

    /// Position and lever arm as in [`Linkage::end`], as part of a machine of many states.
    ///
    /// Separate function, so that machines without a linkage do not contain its code.
    #[inline(never)]
    pub(crate) fn end_of<T: Scalar + From<S>>(&self, angle: T) -> RodEnd<T> {
        let [position, lever_arm, lever_slope] = T::local(&self.extension, [angle]);
        RodEnd { position, lever_arm, lever_slope }
    }

    /// Angle in rad at which the load's end of the rod is at a position in m: the inverse of
    /// [`Linkage::end`], by Newton's steps.
    ///
    /// ```text
    /// theta <- theta - (g(theta) - x)/g'(theta)
    /// ```
    pub fn angle(&self, position: S) -> S {
        let [mut angle, ..] = self.guess.at(position);
        for _ in 0..STEPS {
            let [here, slope, _] = self.extension.at(angle);
            angle = angle - (here - position) / slope;
        }
        angle
    }

    /// Lever arm in the middle of the range of angles, m.
    pub(crate) fn typical_arm(&self) -> S {
        self.end(self.extension.middle).lever_arm
    }
}

phea_dynamics::parameters! { Linkage { extension, guess, weight } }
