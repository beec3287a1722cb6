//! Families of plants: the members that are examined, and the plants between them.
//!
//! A family over a box has members at grid points, corners, random points or given cases, and every
//! plant between them also belongs to it; a family of explicit cases or of measured responses
//! consists only of its members.

mod coordinate;
mod measured;
mod member;
mod tabulated;

pub use coordinate::Coordinate;
pub use measured::{MeasuredFamily, MeasuredPlant, MeasurementError};
pub use member::{grid, random, vertices};
pub(crate) use tabulated::{COARSE, points, table};
pub use tabulated::{FINE, tabulated};

pub use phea_dynamics::uncertain_plant::Spacing;
use phea_dynamics::uncertain_plant::UncertainPlant;

/// The plants that a loop must control.
#[derive(Clone, Debug, PartialEq)]
pub enum Family {
    /// An uncertain plant and the members of its family.
    Uncertain(UncertainFamily),
    /// Measured frequency responses: no conclusion is possible between two of them.
    Measured(MeasuredFamily),
}

/// Plants that belong to the family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Every point of the box that the coordinates span, of which the members are samples.
    Box,
    /// Only the members, without plants between them.
    Members,
}

/// Reason why there is no family.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FamilyError {
    /// A member with a number of values other than the plant's number of parameters.
    #[error("member {member} has {found} values, the plant has {expected} parameters")]
    Values {
        /// Index of the member, from 0.
        member: usize,
        /// Number of values of the member.
        found: usize,
        /// The plant's number of parameters.
        expected: usize,
    },
    /// A value that is not finite, or is outside its parameter's bounds.
    #[error("member {member}: `{parameter}` = {value} lies outside of {minimum} to {maximum}")]
    Outside {
        /// Index of the member, from 0.
        member: usize,
        /// The parameter's name.
        parameter: String,
        /// Value of the parameter.
        value: f64,
        /// The parameter's lower bound.
        minimum: f64,
        /// The parameter's upper bound.
        maximum: f64,
    },
    /// A coordinate that moves a nonexistent parameter, or one that another coordinate already
    /// moves.
    #[error("a coordinate moves parameter {0}, which does not exist or is moved already")]
    Coordinate(usize),
    /// A parameter with logarithmic spacing whose bounds are not positive.
    #[error("parameter `{0}` cannot be spaced by equal factors: its lower bound is not positive")]
    Logarithmic(String),
    /// More members than can be examined.
    #[error("the family would have {0} members; at most {1} are examined")]
    TooManyMembers(f64, usize),
}

/// Largest number of members that a family may have.
pub const MEMBERS_MAXIMUM: usize = 2_000_000;

/// Largest dimension of a box whose corners are examined.
const CORNERS_DIMENSION_MAXIMUM: usize = 8;

/// An uncertain plant, the coordinates that span its box, and the members that are examined; the
/// nominal plant is member 0.
///
/// # Example
/// ```
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_qft::family::{Coordinate, Extent, Spacing, UncertainFamily, grid};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let gain = UncertainParameter { name: "k".into(), nominal: 2.0, minimum: 1.0, maximum: 100.0 };
/// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let coordinate = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Logarithmic], points: 3 };
/// let members = grid(&plant, &[coordinate.clone()])?;
/// let family = UncertainFamily::new(plant, vec![coordinate], members, Extent::Box)?;
/// let gains: Vec<f64> = family.members().iter().map(|values| values[0].round()).collect();
/// assert_eq!(gains, [2.0, 1.0, 10.0, 100.0]); // the nominal plant first
/// assert!((family.values(&[0.5])[0] - 10.0).abs() < 1e-13); // the middle of the box, by equal factors
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct UncertainFamily {
    plant: UncertainPlant,
    coordinates: Vec<Coordinate>,
    members: Vec<Vec<f64>>,
    extent: Extent,
}

impl UncertainFamily {
    /// A family with these members, to which the nominal plant is added in front.
    ///
    /// # Errors
    /// [`FamilyError`] for members outside the box, and for coordinates that do not fit the plant.
    pub fn new(
        plant: UncertainPlant,
        coordinates: Vec<Coordinate>,
        members: Vec<Vec<f64>>,
        extent: Extent,
    ) -> Result<UncertainFamily, FamilyError> {
        coordinate::check(&plant, &coordinates)?;
        member::check(&plant, &members)?;
        let nominal = plant.nominal();
        let others = members.into_iter().filter(|values| *values != nominal);
        let members = std::iter::once(nominal.clone()).chain(others).collect();
        Ok(UncertainFamily { plant, coordinates, members, extent })
    }

    /// Family of only the nominal plant.
    pub fn of_nominal(plant: UncertainPlant) -> UncertainFamily {
        let members = vec![plant.nominal()];
        UncertainFamily { plant, coordinates: vec![], members, extent: Extent::Members }
    }

    /// The plant whose parameters are uncertain.
    pub fn plant(&self) -> &UncertainPlant {
        &self.plant
    }

    /// Parameter values of every member, the nominal plant first.
    pub fn members(&self) -> &[Vec<f64>] {
        &self.members
    }

    /// Plants that belong to the family.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// The coordinates that span the box; their number is its dimension.
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// Parameter values at a point of the box, given by a fraction in [0, 1] of each coordinate.
    /// Fractions outside this range are set to the nearest end, and missing ones count as zero.
    pub fn values(&self, fractions: &[f64]) -> Vec<f64> {
        coordinate::values(&self.plant, &self.coordinates, fractions)
    }

    /// The fractions nearest to these parameter values, one for each coordinate.
    pub fn fractions(&self, values: &[f64]) -> Vec<f64> {
        self.coordinates.iter().map(|coordinate| coordinate.fraction(&self.plant, values)).collect()
    }
}

/// The corners of a family's box, if it has one and there are not too many.
pub(crate) fn corners(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let dimension = family.coordinates().len();
    if family.extent() == Extent::Members || dimension == 0 || dimension > CORNERS_DIMENSION_MAXIMUM {
        return Vec::new();
    }
    vertices(family.plant(), family.coordinates()).unwrap_or_default()
}
