//! Stroke of a cylinder or motor, and its effect on the chambers.

mod keys;
mod telescope;

pub(crate) use keys::{STAGE_TRANSITION_KEY, STROKE_KEY};
pub use telescope::{FURTHER_STAGES, PistonStage, Telescope};

use phea_dynamics::scalar::Scalar;

/// Stroke, m or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActuatorStroke<S = f64> {
    /// Range from zero at the A end to this value at the B end: chamber A grows by the volume that
    /// chamber B loses.
    Limited(S),
    /// Stroke of a telescopic piston, whose areas change from stage to stage.
    Telescopic(Telescope<S>),
    /// Unlimited rotation of a motor. The flow into one of its ports leaves the other, and its
    /// chambers have constant volumes.
    Unlimited,
}

phea_dynamics::parameters! {
    ActuatorStroke = ActuatorStroke::Limited(stroke)
        | ActuatorStroke::Telescopic(telescope)
        | ActuatorStroke::Unlimited
}

impl<S: Copy> ActuatorStroke<S> {
    /// Stroke in m or rad, if there is one.
    pub fn length(&self) -> Option<S> {
        match self {
            ActuatorStroke::Limited(stroke) => Some(*stroke),
            ActuatorStroke::Telescopic(telescope) => Some(telescope.stroke),
            ActuatorStroke::Unlimited => None,
        }
    }

    /// Stages of a telescopic piston; `None` for any other.
    pub fn telescope(&self) -> Option<&Telescope<S>> {
        match self {
            ActuatorStroke::Telescopic(telescope) => Some(telescope),
            ActuatorStroke::Limited(_) | ActuatorStroke::Unlimited => None,
        }
    }
}

impl<S: Scalar> ActuatorStroke<S> {
    /// Contribution of the position to each chamber, as an equivalent travel of the piston's areas:
    /// from the A end and to the B end.
    ///
    /// ```text
    /// x and L - x;   l_A(x) and l_B(L) - l_B(x) of a telescopic piston;   zero and zero without a stroke
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
            ActuatorStroke::Telescopic(telescope) => telescope.travels(position),
            ActuatorStroke::Unlimited => [S::from(0.0); 2],
        }
    }

    /// Distances from the A end and to the B end, m or rad; zero and zero without a stroke.
    #[inline(always)]
    pub fn distances(&self, position: S) -> [S; 2] {
        match self {
            ActuatorStroke::Telescopic(telescope) => [position, telescope.stroke - position],
            other => other.travels(position),
        }
    }

    /// Areas of a piston at a position, from those of its first stage.
    #[inline(always)]
    pub fn areas(&self, first: [S; 2], position: S) -> [S; 2] {
        match self {
            ActuatorStroke::Telescopic(telescope) => {
                let [ratio_a, ratio_b] = telescope.ratios(position);
                [first[0] * ratio_a, first[1] * ratio_b]
            }
            ActuatorStroke::Limited(_) | ActuatorStroke::Unlimited => first,
        }
    }

    /// Half of the stroke, the default position; zero without a stroke.
    pub fn middle(&self) -> S {
        match self {
            ActuatorStroke::Limited(stroke) => *stroke / S::from(2.0),
            ActuatorStroke::Telescopic(telescope) => telescope.stroke / S::from(2.0),
            ActuatorStroke::Unlimited => S::from(0.0),
        }
    }
}

impl ActuatorStroke {
    /// True if the stroke includes this position; without a stroke, for every finite position.
    pub fn contains(&self, position: f64) -> bool {
        match self {
            ActuatorStroke::Limited(stroke) => (0.0..=*stroke).contains(&position),
            ActuatorStroke::Telescopic(telescope) => (0.0..=telescope.stroke).contains(&position),
            ActuatorStroke::Unlimited => position.is_finite(),
        }
    }
}
