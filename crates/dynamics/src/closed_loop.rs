//! Closed loops around a plant, whose magnitudes specifications limit.

use num_complex::Complex64;

/// A closed loop, with S = 1/(1+L) and L = P G H.
///
/// ```text
/// X = A G^a F^f S,    A one of P H, 1, P, Pd, a and f 0 or 1
/// ```
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::closed_loop::{ClosedLoop, LoopResponse};
/// let value = |real| Complex64::new(real, 0.0);
/// let response = LoopResponse {
///     plant: value(2.0),
///     load_motion: value(5.0),
///     controller: value(3.0),
///     prefilter: value(0.5),
///     sensor: value(1.0),
/// };
/// assert_eq!(ClosedLoop::ControlEffort.response(&response), value(3.0 / 7.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClosedLoop {
    /// L S
    #[default]
    RobustStability,
    /// S
    Sensitivity,
    /// P S
    PlantInputDisturbance,
    /// G S
    ControlEffort,
    /// Pd S
    LoadMotion,
    /// F P G S
    Tracking,
}

/// Factor A that the plant contributes to a closed loop in addition to S.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantPath {
    /// P H
    PlantAndSensor,
    /// 1
    One,
    /// P
    Plant,
    /// Pd
    LoadMotion,
}

impl ClosedLoop {
    /// X
    pub fn response(self, response: &LoopResponse) -> Complex64 {
        let sensitivity = 1.0 / (1.0 + response.open_loop());
        match self {
            ClosedLoop::RobustStability => response.open_loop() * sensitivity,
            ClosedLoop::Sensitivity => sensitivity,
            ClosedLoop::PlantInputDisturbance => response.plant * sensitivity,
            ClosedLoop::ControlEffort => response.controller * sensitivity,
            ClosedLoop::LoadMotion => response.load_motion * sensitivity,
            ClosedLoop::Tracking => response.prefilter * response.plant * response.controller * sensitivity,
        }
    }

    /// A
    pub fn plant_path(self) -> PlantPath {
        match self {
            ClosedLoop::RobustStability => PlantPath::PlantAndSensor,
            ClosedLoop::Sensitivity | ClosedLoop::ControlEffort => PlantPath::One,
            ClosedLoop::PlantInputDisturbance | ClosedLoop::Tracking => PlantPath::Plant,
            ClosedLoop::LoadMotion => PlantPath::LoadMotion,
        }
    }

    /// True if G is a factor: a = 1.
    pub fn has_feedback(self) -> bool {
        matches!(self, ClosedLoop::RobustStability | ClosedLoop::ControlEffort | ClosedLoop::Tracking)
    }

    /// True if F is a factor: f = 1.
    pub fn has_prefilter(self) -> bool {
        self == ClosedLoop::Tracking
    }
}

/// One member of a closed loop at one frequency: plant, load-motion path, controller, prefilter and
/// sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopResponse {
    /// P(j w)
    pub plant: Complex64,
    /// Pd(j w)
    pub load_motion: Complex64,
    /// G(j w)
    pub controller: Complex64,
    /// F(j w)
    pub prefilter: Complex64,
    /// H(j w)
    pub sensor: Complex64,
}

impl LoopResponse {
    /// L = P G H.
    pub fn open_loop(&self) -> Complex64 {
        self.plant * self.controller * self.sensor
    }
}
