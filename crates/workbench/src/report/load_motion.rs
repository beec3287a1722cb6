//! The force while the load moves, from the driving-point impedance: open loop and closed loop.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::time_response::{
    Interpolation, SampledSignal, TimeResponseError, forced_response, uniform_times,
};
use phea_engineering::linearize::PortView;

use crate::answer::significant;
use crate::figure::axis::extent;
use crate::figure::{Figure, Words};
use crate::over_time::{Trace, chart, measured_force, panel, trace};
use crate::project::{LoadMotion, MotionShape, Project};
use crate::quantity::Units;

/// Motion of the load if no scenario moves it: 1 mm in 0.1 s.
const MOTION: (f64, f64) = (1e-3, 0.1);

/// Samples of the motion; straight between them.
const MOTION_SAMPLES: u32 = 400;

/// Samples of the drawn force, over ten times the motion's duration.
const SAMPLES: usize = 2000;

/// Distance in m and duration in s of the first smooth step of the load in the scenarios, or 1 mm
/// in 0.1 s.
fn motion(project: &Project) -> (f64, f64) {
    let smooth = |motion: &LoadMotion| match motion.shape {
        MotionShape::SmoothStep { duration, distance } => Some((distance, duration)),
        _ => None,
    };
    // a scenario turns the joint if there is a linkage
    let turns = project.actuator.as_ref().is_some_and(|actuator| actuator.linkage.is_some());
    project
        .scenarios
        .iter()
        .filter(|_| !turns)
        .filter_map(|scenario| scenario.load_motion.as_ref())
        .find_map(smooth)
        .unwrap_or(MOTION)
}

/// Velocity of a quintic step, m/s.
///
/// ```text
/// x = h (10 u^3 - 15 u^4 + 6 u^5),    v = h/T 30 u^2 (1 - u)^2,    u = t/T
/// ```
fn velocity(distance: f64, duration: f64) -> Result<SampledSignal, TimeResponseError> {
    let fractions = (0..=MOTION_SAMPLES).map(|sample| f64::from(sample) / f64::from(MOTION_SAMPLES));
    let (times, velocities) =
        fractions.map(|u| (u * duration, distance / duration * 30.0 * u * u * (1.0 - u) * (1.0 - u))).unzip();
    SampledSignal::new(times, velocities, Interpolation::Linear)
}

/// The force at one port while the load moves.
pub(super) struct Moved {
    /// Name of the loop.
    pub(super) name: &'static str,
    /// True if the ground of the load moves and not the load itself.
    pub(super) moves_ground: bool,
    /// The force; absent if the port is unstable.
    pub(super) force: Option<MovedForce>,
}

/// The force over time, if it does not grow without bound.
pub(super) struct MovedForce {
    /// Largest change with its sign, N.
    pub(super) peak_n: f64,
    /// The remaining force, N.
    remains_n: f64,
    series: Trace,
}

/// Load step that the final force of a port is stated for, m.
const STATED_STEP: f64 = 1e-3;

/// Final force that counts as zero, N.
const NOTHING: f64 = 1e-6;

/// The force at each port while the load moves; an unstable port has none.
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
        let Some(final_force_n) = view.final_force_n else {
            forces.push(Moved { name, moves_ground: view.moves_ground, force: None });
            continue;
        };
        // F_e = -Z (s X_L); for a load that yields, its ground takes the place of X_L
        let force = view.by_motion.series(&TransferFunction::gain_only(-1.0))?;
        let values = forced_response(&force, &input, &times_s)?;
        let peak_n = values.iter().copied().fold(0.0, larger);
        let series = trace(&times_s, &values);
        let remains_n = final_force_n * distance / STATED_STEP;
        let force = Some(MovedForce { peak_n, remains_n, series });
        forces.push(Moved { name, moves_ground: view.moves_ground, force });
    }
    Ok(forces)
}

/// The remaining forces, in sentences.
fn end(forces: &[Moved], units: Units) -> String {
    let (unit, force) = (units.force, units.motion.words().force);
    let known: Vec<(&str, f64)> =
        forces.iter().filter_map(|moved| Some((moved.name, moved.force.as_ref()?.remains_n))).collect();
    let unstable = forces.iter().filter(|moved| moved.force.is_none()).map(|moved| moved.name);
    let mut sentences = match known.iter().all(|(_, remains)| remains.abs() < NOTHING) {
        true if known.is_empty() => vec![],
        true => vec!["In the end nothing remains.".to_string()],
        false => {
            let one = |(name, remains): &(&str, f64)| format!("{} {name}", unit.text(*remains, 3));
            vec![format!(
                "In the end there remains {}.",
                known.iter().map(one).collect::<Vec<_>>().join(", ")
            )]
        }
    };
    sentences
        .extend(unstable.map(|name| {
            format!("The {name} is unstable: its {force} grows without bound and is not drawn.")
        }));
    sentences.join(" ")
}

/// The moving body in words: the ground of a load that yields.
pub(super) fn what_moves(project: &Project, is_ground: bool) -> &'static str {
    let linked = project.actuator.as_ref().is_some_and(|actuator| actuator.linkage.is_some());
    match (is_ground, linked) {
        // a linkage is driven by a rod
        (true, true) => "the ground of the load, as seen at the rod's end,",
        (true, false) => "the ground of the load",
        (false, true) => "the rod's end",
        (false, false) => "the load",
    }
}

/// The figure of these forces.
pub(super) fn figure(project: &Project, forces: &[Moved]) -> Figure {
    let (distance, duration) = motion(project);
    let units = project.units;
    let moved = what_moves(project, forces.iter().any(|moved| moved.moves_ground));
    let caption = format!(
        "Change of the {} while {moved} moves {} in {} s (a smooth step of fifth order), linear and with no limit on the command. {}",
        units.motion.words().force,
        project.units.position.text(distance, 3),
        significant(duration, 3),
        end(forces, units)
    );
    let known = forces
        .iter()
        .filter_map(|moved| Some((moved.name.to_string(), moved.force.as_ref()?.series.clone())));
    let (names, series): (Vec<String>, Vec<Trace>) = known.unzip();
    let (start, end) = extent(series.iter().flatten().map(|(time, _)| *time));
    let chart = chart(
        vec![panel(&measured_force(units.motion), units.force, 250.0, series)],
        names,
        &[],
        [start, end],
    );
    chart.draw(&Words::new("load-motion", "Load motion", caption))
}
