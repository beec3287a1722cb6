//! The force while the load moves, from the driving-point impedance: open loop beside closed loop.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::time_response::{
    Interpolation, Signal, TimeResponseError, forced_response, uniform_times,
};

use crate::answer::significant;
use crate::figure::{DisplayUnit, Figure, StepResponseInput, TimeSeries, Words, step_response};
use crate::linearize::PortView;
use crate::project::{LoadMotion, LoadMotionKind, Project};

/// The motion that is shown where no scenario moves the load: 1 mm in 0.1 s.
const MOTION: (f64, f64) = (1e-3, 0.1);

/// Samples of the motion; straight between them.
const MOTION_SAMPLES: u32 = 400;

/// Samples of the drawn force, over ten times the motion's duration.
const SAMPLES: usize = 2000;

/// Distance in m and duration in s of the first smooth step of the load in the scenarios, or 1 mm in 0.1 s.
fn motion(project: &Project) -> (f64, f64) {
    let smooth = |motion: &LoadMotion| match motion.kind {
        LoadMotionKind::SmoothStep => motion.distance.zip(motion.duration),
        _ => None,
    };
    project
        .scenarios
        .iter()
        .filter_map(|scenario| scenario.load_motion.as_ref())
        .find_map(smooth)
        .unwrap_or(MOTION)
}

/// Velocity of a quintic step, m/s.
///
/// ```text
/// x = h (10 u^3 - 15 u^4 + 6 u^5),    v = h/T 30 u^2 (1 - u)^2,    u = t/T
/// ```
fn velocity(distance: f64, duration: f64) -> Result<Signal, TimeResponseError> {
    let shares = (0..=MOTION_SAMPLES).map(|sample| f64::from(sample) / f64::from(MOTION_SAMPLES));
    let (times, velocities) =
        shares.map(|u| (u * duration, distance / duration * 30.0 * u * u * (1.0 - u) * (1.0 - u))).unzip();
    Signal::new(times, velocities, Interpolation::Linear)
}

/// The force at one port while the load moves.
pub(super) struct Moved {
    /// Which loop.
    pub(super) name: &'static str,
    /// Largest change of the force with its sign, N.
    pub(super) peak_n: f64,
    series: TimeSeries,
}

/// The force at each port while the load moves.
pub(super) fn forces(
    project: &Project,
    ports: &[(&'static str, &PortView)],
) -> Result<Vec<Moved>, TimeResponseError> {
    let (distance, duration) = motion(project);
    let times_s = uniform_times(10.0 * duration, SAMPLES)?;
    let input = velocity(distance, duration)?;
    let larger = |peak: f64, value: f64| if value.abs() > peak.abs() { value } else { peak };
    let mut forces = Vec::new();
    for (name, view) in ports {
        // F_e = -Z (s X_L)
        let force = view.impedance.series(&TransferFunction::gain_only(-1.0))?;
        let values = forced_response(&force, &input, &times_s)?;
        let peak_n = values.iter().copied().fold(0.0, larger);
        let series = TimeSeries { name: name.to_string(), times_s: times_s.clone(), values };
        forces.push(Moved { name, peak_n, series });
    }
    Ok(forces)
}

/// The figure of these forces.
pub(super) fn figure(project: &Project, forces: &[Moved]) -> Figure {
    let (distance, duration) = motion(project);
    let caption = format!(
        "Change of the force while the load moves {} mm in {} s (a smooth step of fifth order), linear and with no limit on the command. In the end nothing remains.",
        DisplayUnit::MILLIMETRE.number(distance, 3),
        significant(duration, 3)
    );
    let input = StepResponseInput {
        quantity: "Force F_e".to_string(),
        unit: DisplayUnit::KILONEWTON,
        reference: None,
        responses: forces.iter().map(|moved| moved.series.clone()).collect(),
        settling_band: None,
        bounds: None,
        events: vec![],
        controls: vec![],
    };
    step_response(Words::new("load-motion", "Load motion", caption), &input)
}
