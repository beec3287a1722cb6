//! The plant as the loop around it sees it: with the velocity of the load that is fed forward.

use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{LinearPlant, PlantInMotion};

use super::Rig;
use crate::project::{Load, Project, SpecificationKind};

impl Rig {
    /// The same rig, with the velocity of its load fed forward. Where the command follows at once
    /// it is in `plant` and `in_motion`; where it is late and the load yields there are no
    /// polynomials of it, and it is in `in_motion` alone, which lumped lines have then too. What is
    /// sampled is no part of the plant, nor what is late on the path of a prescribed motion: the
    /// loop has it.
    ///
    /// # Example
    /// Beside a prescribed load only the path of its motion changes.
    /// ```
    /// use phea_engineering::setup::Setup;
    /// use phea_project::source::Memory;
    /// let source = Memory::default().with("rig.toml", include_str!("../../../../examples/ybitu/hose.toml"));
    /// let settings = ["controller.load_velocity_feed_forward={}".to_string()];
    /// let rig = Setup::rig_of(&phea_project::read(&source, "rig.toml", &settings, &[])?.project)?;
    /// let [own, seen] = [&rig, &rig.in_loop()].map(|rig| rig.plant.coefficients());
    /// let load = |paths: &phea_dynamics::uncertain_plant::PlantCoefficients<f64>| {
    ///     paths.disturbance.as_ref().map(|path| path.at_frequency(1.0).norm_sqr())
    /// };
    /// assert_eq!(own.command, seen.command);
    /// assert!(load(&seen) < load(&own).map(|size| 1e-3 * size));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn in_loop(&self) -> Rig {
        let gain = self.fed.as_ref().and_then(FeedForwardPath::at_once);
        Rig {
            plant: LinearPlant { load_velocity_feed_forward: gain, ..self.plant },
            in_motion: as_response(self.fed, self.in_motion, &self.plant),
            ..self.clone()
        }
    }
}

/// The load's velocity on the command, as the linear loop counts it: a gain in V s/m, and where it
/// is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeedForwardPath {
    /// In the plant: at once, or late by a delay in s where the load yields.
    InPlant {
        /// V s/m
        gain: f64,
        /// s
        delay: f64,
    },
    /// In the loop around the plant, with the samples and the delay of the command: see
    /// [`rate_feed_forward`](phea_qft::closed_loop::Compensation::rate_feed_forward).
    InLoop {
        /// V s/m
        gain: f64,
    },
}

impl FeedForwardPath {
    /// What the loop of a project counts; `None` where nothing is fed forward.
    pub(super) fn of(project: &Project, linear: &LinearParameters) -> Option<FeedForwardPath> {
        let controller = project.controller.as_ref()?;
        let yields = project.actuator.as_ref()?.load != Load::Prescribed;
        let (gain, delay) = (feed_forward(project, linear), controller.delay);
        match (yields, controller.sample_time) {
            _ if gain == 0.0 => None,
            (true, None) => Some(FeedForwardPath::InPlant { gain, delay }),
            (false, None) if delay == 0.0 => Some(FeedForwardPath::InPlant { gain, delay }),
            (true, Some(_)) | (false, _) => Some(FeedForwardPath::InLoop { gain }),
        }
    }

    /// The gain where it is in the plant and acts at once.
    pub fn at_once(&self) -> Option<f64> {
        match *self {
            FeedForwardPath::InPlant { gain, delay: 0.0 } => Some(gain),
            FeedForwardPath::InPlant { .. } | FeedForwardPath::InLoop { .. } => None,
        }
    }

    /// The gain where the loop around the plant has it.
    pub(crate) fn in_loop(&self) -> Option<f64> {
        match *self {
            FeedForwardPath::InLoop { gain } => Some(gain),
            FeedForwardPath::InPlant { .. } => None,
        }
    }
}

/// The plant without polynomials that the loop sees: with these lines in motion, or with its lumped
/// ones where a load that yields is fed forward late; `None` where there are polynomials.
pub(crate) fn as_response(
    fed: Option<FeedForwardPath>,
    moving: Option<PlantInMotion>,
    lumped: &LinearPlant,
) -> Option<PlantInMotion> {
    let Some(FeedForwardPath::InPlant { gain, delay }) = fed else { return moving };
    let plant = moving.or_else(|| (delay > 0.0).then(|| PlantInMotion::lumped(lumped)))?;
    Some(plant.fed_forward(Some(gain)).late(delay))
}

/// Whether a specification limits the path that a prescribed load has into the loop.
pub(crate) fn limits_load_motion(project: &Project) -> bool {
    project.specifications.iter().any(|specification| specification.kind == SpecificationKind::LoadMotion)
}

/// Gain of the load's velocity on the command in V s/m, zero where nothing is fed forward; the area
/// over the flow gain holds the flow that the motion takes.
pub fn feed_forward(project: &Project, linear: &LinearParameters) -> f64 {
    let declared = project.controller.as_ref().and_then(|controller| controller.load_velocity_feed_forward);
    declared.map_or(0.0, |declared| declared.gain.unwrap_or(linear.useful_area / linear.flow_gain))
}
