//! How far a cylinder or motor moves, and what that does to its chambers.

use phea_dynamics::scalar::Scalar;

/// The stroke, in m or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActuatorStroke<S = f64> {
    /// From zero at the A end to this at the B end: chamber A grows by what chamber B loses.
    Limited(S),
    /// None: a motor that turns on. What enters one of its ports leaves the other, and its chambers
    /// keep their volumes.
    Unlimited,
}

impl<S: Copy> ActuatorStroke<S> {
    /// Every parameter replaced.
    #[inline(always)]
    pub fn convert<T>(&self, of: &mut impl FnMut(S) -> T) -> ActuatorStroke<T> {
        match self {
            ActuatorStroke::Limited(stroke) => ActuatorStroke::Limited(of(*stroke)),
            ActuatorStroke::Unlimited => ActuatorStroke::Unlimited,
        }
    }

    /// The stroke in m or rad, where there is one.
    pub fn length(&self) -> Option<S> {
        match self {
            ActuatorStroke::Limited(stroke) => Some(*stroke),
            ActuatorStroke::Unlimited => None,
        }
    }
}

impl<S: Scalar> ActuatorStroke<S> {
    /// What the position adds to each chamber: the way from the A end and the way to the B end.
    ///
    /// ```text
    /// x and L - x, or zero and zero without a stroke
    /// ```
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::stroke::ActuatorStroke;
    /// assert_eq!(ActuatorStroke::Limited(0.5).travels(0.125), [0.125, 0.375]);
    /// assert_eq!(ActuatorStroke::Unlimited.travels(1e3), [0.0, 0.0]);
    /// ```
    #[inline(always)]
    pub fn travels(&self, position: S) -> [S; 2] {
        match self {
            ActuatorStroke::Limited(stroke) => [position, *stroke - position],
            ActuatorStroke::Unlimited => [S::from(0.0); 2],
        }
    }

    /// Half of it, where the position is taken that nobody states; zero without a stroke.
    pub fn middle(&self) -> S {
        match self {
            ActuatorStroke::Limited(stroke) => *stroke / S::from(2.0),
            ActuatorStroke::Unlimited => S::from(0.0),
        }
    }
}

impl ActuatorStroke {
    /// Whether it has this position; without a stroke every finite one.
    pub fn contains(&self, position: f64) -> bool {
        match self {
            ActuatorStroke::Limited(stroke) => (0.0..=*stroke).contains(&position),
            ActuatorStroke::Unlimited => position.is_finite(),
        }
    }
}
