//! The plant as it appears to the loop: with the feed-forward of the load velocity.

use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{LinearPlant, PlantInMotion};

use super::Rig;
use crate::project::{Load, Project, SpecificationKind};

impl Rig {
    /// The same rig with the velocity of its load fed forward. Without delay it is in `plant` and
    /// `in_motion`. With delay and a load that can move it has no polynomials and is in `in_motion`
    /// alone, which then exists for lumped lines too. A sampled feed-forward is not part of the
    /// plant, nor a delayed one on the path of a prescribed motion: the loop includes them.
    ///
    /// # Example
    /// For a prescribed load only the path of its motion changes.
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

/// The feed-forward of the load velocity in the linear loop: a gain in V s/m, and where it acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeedForwardPath {
    /// In the plant: without delay, or with a delay in s where the load can move.
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
    /// The feed-forward in the loop of a project; `None` where nothing is fed forward.
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

    /// The gain, if it acts in the plant without delay.
    pub fn at_once(&self) -> Option<f64> {
        match *self {
            FeedForwardPath::InPlant { gain, delay: 0.0 } => Some(gain),
            FeedForwardPath::InPlant { .. } | FeedForwardPath::InLoop { .. } => None,
        }
    }

    /// The gain, if it acts in the loop around the plant.
    pub(crate) fn in_loop(&self) -> Option<f64> {
        match *self {
            FeedForwardPath::InLoop { gain } => Some(gain),
            FeedForwardPath::InPlant { .. } => None,
        }
    }
}

/// The plant without polynomials as it appears to the loop: with these lines in motion, or with
/// lumped lines and the delayed velocity of a load that can move; `None` where there are
/// polynomials.
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
/// over the flow gain supplies the flow that the motion needs.
pub fn feed_forward(project: &Project, linear: &LinearParameters) -> f64 {
    let declared = project.controller.as_ref().and_then(|controller| controller.load_velocity_feed_forward);
    declared.map_or(0.0, |declared| declared.gain.unwrap_or(linear.useful_area / linear.flow_gain))
}
