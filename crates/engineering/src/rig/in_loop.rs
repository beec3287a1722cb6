//! The plant as the loop around it sees it: with the velocity of the load that is fed forward.

use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{Lateness, Plant, PlantInMotion};

use super::Rig;
use crate::project::{Load, Project, SpecificationKind};

impl Rig {
    /// The same rig, with the velocity of its load fed forward. Where the command follows at once it is in `plant` and `in_motion`; where it
    /// is late there are no polynomials of it, and it is in `in_motion` alone, which lumped lines have then too.
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
        let gain = self.fed.as_ref().and_then(FedForward::at_once);
        Rig {
            plant: Plant { load_velocity_feed_forward: gain, ..self.plant },
            in_motion: as_response(self.fed, self.in_motion, &self.plant),
            ..self.clone()
        }
    }
}

/// The load's velocity on the command, as the linear loop counts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FedForward {
    /// Gain in V s/m.
    pub gain: f64,
    /// How late it acts.
    pub lateness: Lateness,
    /// Whether something that is asked of the loop depends on it: a load that yields closes a loop, beside a prescribed one only a limit
    /// on its motion does.
    pub decides: bool,
}

impl FedForward {
    /// What the loop of a project counts; `None` where nothing is fed forward, or where a load that yields is sampled: its velocity
    /// reaches the samples by another path than the force.
    pub(super) fn of(project: &Project, linear: &LinearParameters) -> Option<FedForward> {
        let controller = project.controller.as_ref()?;
        let yields = project.actuator.as_ref()?.load != Load::Prescribed;
        let lateness = Lateness { delay: controller.delay, hold: controller.sample_time.unwrap_or(0.0) };
        let gain = feed_forward(project, linear);
        let counted = gain != 0.0 && !(yields && lateness.hold > 0.0);
        let decides = yields || limits_load_motion(project);
        counted.then_some(FedForward { gain, lateness, decides })
    }

    /// The gain where it acts at once.
    pub fn at_once(&self) -> Option<f64> {
        (self.lateness == Lateness::default()).then_some(self.gain)
    }
}

/// The plant without polynomials that the loop sees: with these lines in motion, or with its lumped ones where what is fed forward late
/// decides; `None` where there are polynomials. Samples of lumped lines stay with them, as their loop is proven by them alone.
pub fn as_response(
    fed: Option<FedForward>,
    moving: Option<PlantInMotion>,
    lumped: &Plant,
) -> Option<PlantInMotion> {
    let late = fed.filter(|fed| fed.lateness.delay > 0.0 && fed.lateness.hold == 0.0 && fed.decides);
    let plant = moving.or_else(|| late.map(|_| PlantInMotion::lumped(lumped)))?;
    let lateness = fed.map_or(Lateness::default(), |fed| fed.lateness);
    Some(plant.fed_forward(fed.map(|fed| fed.gain)).late(lateness))
}

/// Whether a specification limits the path that a prescribed load has into the loop.
pub fn limits_load_motion(project: &Project) -> bool {
    project.specifications.iter().any(|specification| specification.kind == SpecificationKind::LoadMotion)
}

/// Gain of the load's velocity on the command in V s/m, zero where nothing is fed forward; the area over the flow gain holds the flow that
/// the motion takes.
pub fn feed_forward(project: &Project, linear: &LinearParameters) -> f64 {
    let declared = project.controller.as_ref().and_then(|controller| controller.load_velocity_feed_forward);
    declared.map_or(0.0, |declared| declared.gain.unwrap_or(linear.useful_area / linear.flow_gain))
}
