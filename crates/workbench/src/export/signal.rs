//! Signals that a controller reads at a sample.

use phea_machine::{Deployed, SampledSignals};

use crate::quantity::{FORCE, MotionKind, VELOCITY};

/// A signal that a controller reads at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeployedSignal {
    /// Reference of the controlled quantity.
    Reference,
    /// Measured quantity.
    Measurement,
    /// Velocity of the load, fed forward.
    Velocity,
    /// Pressure signal, fed back.
    Pressure,
}

impl DeployedSignal {
    /// Signals that a controller uses, in the order of all files.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::export::DeployedSignal;
    /// # use phea_dynamics::controller::Controller;
    /// # use phea_machine::Deployed;
    /// let plain = Deployed::new(Controller::default().sampled(1e-3)?);
    /// let with_velocity = Deployed { feed_forward: 2.0, ..plain.clone() };
    /// assert_eq!(DeployedSignal::of(&plain), [DeployedSignal::Reference, DeployedSignal::Measurement]);
    /// assert_eq!(DeployedSignal::of(&with_velocity).last(), Some(&DeployedSignal::Velocity));
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn of(deployed: &Deployed) -> Vec<DeployedSignal> {
        let velocity = (deployed.feed_forward != 0.0).then_some(DeployedSignal::Velocity);
        let pressure = deployed.controller.reads_inner().then_some(DeployedSignal::Pressure);
        let always = [DeployedSignal::Reference, DeployedSignal::Measurement];
        always.into_iter().chain(velocity).chain(pressure).collect()
    }

    /// Name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            DeployedSignal::Reference => "reference",
            DeployedSignal::Measurement => "measurement",
            DeployedSignal::Velocity => "velocity",
            DeployedSignal::Pressure => "pressure",
        }
    }

    /// Value among the signals of a sample.
    pub fn value(self, signals: &SampledSignals) -> f64 {
        match self {
            DeployedSignal::Reference => signals.reference,
            DeployedSignal::Measurement => signals.measurement,
            DeployedSignal::Velocity => signals.velocity,
            DeployedSignal::Pressure => signals.pressure,
        }
    }

    /// SI unit and meaning in a rig of this motion, or for a plant without units.
    pub(crate) fn meaning(self, motion: Option<MotionKind>) -> String {
        let Some(motion) = motion else {
            return match self {
                DeployedSignal::Reference => "wanted output of the plant",
                DeployedSignal::Measurement => "measured output of the plant",
                DeployedSignal::Velocity => "measured rate of the load, positive as in the project",
                DeployedSignal::Pressure => "signal that is fed back",
            }
            .to_string();
        };
        let force = motion.words().force;
        let (unit, words) = match self {
            DeployedSignal::Reference => (motion.dimension(&FORCE).si, format!("wanted {force}")),
            DeployedSignal::Measurement => (motion.dimension(&FORCE).si, format!("measured {force}")),
            DeployedSignal::Velocity => {
                (motion.dimension(&VELOCITY).si, "measured velocity of the load".to_string())
            }
            DeployedSignal::Pressure => ("Pa", "pressure signal that is fed back".to_string()),
        };
        format!("{words} in {unit}, positive as in the project")
    }
}
