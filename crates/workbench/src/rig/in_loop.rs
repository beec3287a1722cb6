//! The plant as the loop around it sees it: with the velocity of the load that is fed forward.

use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::Plant;

use super::Rig;
use crate::project::Project;

impl Rig {
    /// The same rig, with the velocity of its load fed forward in `plant` and `in_motion`: exact where the command follows at once. In a
    /// loop that samples or is late it is not counted, and the plant is that of the rig alone.
    ///
    /// # Example
    /// Beside a prescribed load only the path of its motion changes.
    /// ```
    /// use phea_workbench::setup::Setup;
    /// use phea_workbench::source::Memory;
    /// let source = Memory::default().with("rig.toml", include_str!("../../../../examples/ybitu/hose.toml"));
    /// let settings = ["controller.load_velocity_feed_forward={}".to_string()];
    /// let rig = Setup::rig_of(&phea_workbench::project::read(&source, "rig.toml", &settings, &[])?.project)?;
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
        let gain = self.fed_at_once;
        Rig {
            plant: Plant { load_velocity_feed_forward: gain, ..self.plant },
            in_motion: self.in_motion.map(|plant| plant.fed_forward(gain)),
            ..self.clone()
        }
    }
}

/// Gain of the load's velocity on the command in V s/m, zero where nothing is fed forward; the area over the flow gain holds the flow that
/// the motion takes.
pub(crate) fn feed_forward(project: &Project, linear: &LinearParameters) -> f64 {
    let declared = project.controller.as_ref().and_then(|controller| controller.load_velocity_feed_forward);
    declared.map_or(0.0, |declared| declared.gain.unwrap_or(linear.useful_area / linear.flow_gain))
}

/// The same where it is part of the linear loop; `None` where nothing is fed forward, or not at once.
pub(super) fn fed_at_once(project: &Project, linear: &LinearParameters) -> Option<f64> {
    let late = project
        .controller
        .as_ref()
        .is_some_and(|controller| controller.sample_time.is_some() || controller.delay > 0.0);
    Some(feed_forward(project, linear)).filter(|gain| !late && *gain != 0.0)
}
