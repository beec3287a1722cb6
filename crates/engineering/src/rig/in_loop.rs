//! The plant as it appears to the loop: with the feed-forward of the load velocity, with the
//! feedback of the chambers' pressures, and with what a virtual impedance adds to its output.

use phea_dynamics::closed_loop::ClosedLoop;
use phea_dynamics::controller::{InnerFeedback, RateFilter, RateSensor};
use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{LinearPlant, PlantInMotion, PressureFeedback, VelocitySensor};

use super::Rig;
use crate::project::{DeclaredActuator, DeclaredPressureFeedback, Load, PressureSignal, Project};

impl Rig {
    /// The same rig with its virtual impedance, whose plant gives out y = F_e + Z_v X_L, with the
    /// velocity of its load fed forward, and with its pressures fed back. Without delay these are
    /// in `plant` and `in_motion`. With delay and a load that can move, or pressures, it has no
    /// polynomials and is in `in_motion` alone, which then exists for lumped lines too. What is
    /// sampled is not part of the plant, nor a delayed feed-forward on the path of a prescribed
    /// motion: the loop includes them.
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
        let moving = self.in_motion.map(|moving| moving.with_virtual_impedance(self.virtual_impedance));
        let plant = self.with_inner_paths(self.plant);
        Rig { in_motion: self.as_response(moving, &plant), plant, ..self.clone() }
    }

    /// A plant with what the loop adds to it, all of the declared rig: the virtual impedance, and
    /// what is fed forward and back without delay.
    pub(crate) fn with_inner_paths<S: Scalar>(&self, plant: LinearPlant<S>) -> LinearPlant<S> {
        let plant = self.fed.map_or(plant, |fed| fed.at_once(plant));
        let pressure_feedback = self.fed_back.and_then(|back| back.at_once());
        let pressure_signal = self.fed_back.and_then(|back| back.sampled_ratio());
        let virtual_impedance = self.virtual_impedance;
        LinearPlant { virtual_impedance, pressure_feedback, pressure_signal, ..plant }
    }

    /// The plant without polynomials as it appears to the loop: with these lines in motion, or with
    /// lumped lines and the delayed velocity of a load that can move or delayed pressures; `None`
    /// where there are polynomials.
    pub(crate) fn as_response(
        &self,
        moving: Option<PlantInMotion>,
        lumped: &LinearPlant,
    ) -> Option<PlantInMotion> {
        let fed = match self.fed {
            Some(FeedForwardPath::InPlant { gain, filter, delay }) => Some((gain, filter, delay)),
            Some(FeedForwardPath::InLoop { .. }) | None => None,
        };
        let back = self.fed_back.filter(|back| !back.sampled);
        let is_late =
            fed.is_some_and(|(_, _, delay)| delay > 0.0) || back.is_some_and(|back| back.delay_s > 0.0);
        let plant = moving.or_else(|| is_late.then(|| PlantInMotion::lumped(lumped)))?;
        let plant = match fed {
            Some((gain, filter, delay)) => plant.fed_forward(Some(gain)).filtered(filter).late(delay),
            None => plant,
        };
        Some(match back {
            Some(back) => plant.fed_back(Some(back.feedback), back.delay_s),
            None => plant.showing(self.fed_back.and_then(|back| back.sampled_ratio())),
        })
    }

    /// Gain of the load's velocity on the command in V s/m, zero where nothing is fed forward.
    pub fn feed_forward(&self) -> f64 {
        match self.fed {
            Some(FeedForwardPath::InPlant { gain, .. } | FeedForwardPath::InLoop { gain, .. }) => gain,
            None => 0.0,
        }
    }

    /// The same rig in a loop without its virtual impedance: the output of its plant is the force.
    #[must_use]
    pub fn without_impedance(&self) -> Rig {
        Rig { virtual_impedance: None, ..self.clone() }
    }
}

/// The feed-forward of the load velocity in the linear loop: a gain in V s/m, and where it acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeedForwardPath {
    /// In the plant: without delay, or with a delay in s where the load can move.
    InPlant {
        /// V s/m
        gain: f64,
        /// Filter of the sensor.
        filter: RateFilter,
        /// Delay of sensor and loop together, s.
        delay: f64,
    },
    /// In the loop around the plant, with the samples and the delay of the command: see
    /// [`rate_feed_forward`](phea_qft::closed_loop::Compensation::rate_feed_forward).
    InLoop {
        /// V s/m
        gain: f64,
        /// Before the samples and the delay.
        sensor: RateSensor,
    },
}

impl FeedForwardPath {
    /// The feed-forward in the loop of a project; `None` where nothing is fed forward. The area
    /// over the flow gain supplies the flow that the motion needs.
    pub(super) fn of(
        project: &Project,
        linear: &LinearParameters,
        sensor: RateSensor,
    ) -> Option<FeedForwardPath> {
        let controller = project.controller.as_ref()?;
        let yields = project.actuator.as_ref()?.load != Load::Prescribed;
        let declared = controller.load_velocity_feed_forward?;
        let gain = declared.gain.unwrap_or(linear.useful_area / linear.flow_gain);
        let (filter, delay) = (sensor.filter, controller.delay + sensor.delay_s);
        match (yields, controller.sample_time) {
            _ if gain == 0.0 => None,
            (true, None) => Some(FeedForwardPath::InPlant { gain, filter, delay }),
            (false, None) if delay == 0.0 => Some(FeedForwardPath::InPlant { gain, filter, delay }),
            (true, Some(_)) | (false, _) => Some(FeedForwardPath::InLoop { gain, sensor }),
        }
    }

    /// The plant with what acts in it without delay.
    pub(crate) fn at_once<S: Scalar>(&self, plant: LinearPlant<S>) -> LinearPlant<S> {
        match *self {
            FeedForwardPath::InPlant { gain, filter, delay: 0.0 } => LinearPlant {
                load_velocity_feed_forward: Some(S::from(gain)),
                velocity_sensor: VelocitySensor { filter, ..plant.velocity_sensor },
                ..plant
            },
            FeedForwardPath::InPlant { .. } | FeedForwardPath::InLoop { .. } => plant,
        }
    }

    /// Gain and sensor, if it acts in the loop around the plant.
    pub(crate) fn in_loop(&self) -> Option<(f64, RateSensor)> {
        match *self {
            FeedForwardPath::InLoop { gain, sensor } => Some((gain, sensor)),
            FeedForwardPath::InPlant { .. } => None,
        }
    }
}

/// The feedback of the chambers' pressures in the linear loop, and where it acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureFeedbackPath {
    /// H and phi.
    pub feedback: PressureFeedback,
    /// Delay of the loop in s.
    pub delay_s: f64,
    /// Whether it is sampled with the controller: then the loop around the plant has it.
    pub sampled: bool,
}

impl PressureFeedbackPath {
    /// The feedback in the loop of a project; `None` where nothing is fed back.
    pub(super) fn of(project: &Project, components: &Components) -> Option<PressureFeedbackPath> {
        let controller = project.controller.as_ref()?;
        let declared = controller.pressure_feedback.filter(|declared| declared.gain != 0.0)?;
        let ratio = pressure_ratio(&declared, components);
        let feedback = PressureFeedback { filter: inner_feedback(&declared), ratio };
        let (delay_s, sampled) = (controller.delay, controller.sample_time.is_some());
        Some(PressureFeedbackPath { feedback, delay_s, sampled })
    }

    /// phi of the signal that the loop around the plant samples, if it does.
    fn sampled_ratio(&self) -> Option<f64> {
        self.sampled.then_some(self.feedback.ratio)
    }

    /// What acts in the plant without delay.
    fn at_once(&self) -> Option<PressureFeedback> {
        (!self.sampled && self.delay_s == 0.0).then_some(self.feedback)
    }
}

/// H of a declared pressure feedback.
pub(crate) fn inner_feedback(declared: &DeclaredPressureFeedback) -> InnerFeedback {
    InnerFeedback {
        gain: declared.gain,
        high_pass_rad_per_s: declared.high_pass,
        low_pass_rad_per_s: declared.low_pass,
    }
}

/// phi of its signal p_A - phi p_B.
pub(crate) fn pressure_ratio(declared: &DeclaredPressureFeedback, components: &Components) -> f64 {
    let Cylinder { area_a, area_b, .. } = components.cylinder;
    match declared.signal {
        PressureSignal::PressureDifference => 1.0,
        PressureSignal::LoadPressure => declared.area_ratio.unwrap_or(area_b / area_a),
    }
}

/// A project whose controller keeps what it takes from the declared rig, whatever rig it then
/// commands: the gain of a feed-forward, and the ratio of areas of a load pressure.
pub(crate) fn with_controller_of(mut project: Project, rig: &Rig) -> Project {
    let Some(controller) = project.controller.as_mut() else { return project };
    if let Some(fed) = &mut controller.load_velocity_feed_forward {
        fed.gain = Some(rig.feed_forward());
    }
    if let (Some(declared), Some(back)) = (&mut controller.pressure_feedback, rig.fed_back)
        && declared.signal == PressureSignal::LoadPressure
    {
        declared.area_ratio = Some(back.feedback.ratio);
    }
    project
}

/// Shown velocity of the load over the true one; `None` where its gain has no error.
pub(super) fn velocity_gain<S: Scalar>(declared: &DeclaredActuator<S>) -> Option<S> {
    let error = declared.velocity_sensor.as_ref()?.gain_error?;
    Some(S::from(1.0) + error)
}

/// Whether a specification limits the path that a prescribed load has into the loop.
pub(crate) fn limits_load_motion(project: &Project) -> bool {
    project.specifications.iter().any(|one| one.closed_loop() == Some(ClosedLoop::LoadMotion))
}
