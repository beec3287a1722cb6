//! The load of a controlled machine, shaken by small sines, and the linear loop at the same
//! frequency.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use phea_hydraulics::signal::Signal;
use std::f64::consts::TAU;
use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::portable::exp_complex;
use phea_dynamics::simulation::Status;
use phea_qft::closed_loop::{Compensation, MemberResponse};
use phea_workbench::engineering::rig::Rig;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::simulate_project;
use phea_workbench::project::{self, Project};
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
/// Viscous friction and four equal edges: nothing has a kink. The controller starts at rest.
const SMOOTH: [&str; 6] = [
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
    "scenario.0.reference=[]",
    "scenario.0.output_step=1 ms",
    "simulation.tolerance=1e-9",
];
pub(crate) const WAVES: &str =
    "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
pub(crate) const SENSOR: &str =
    "sensor={ numerator = \"2000\", denominator = \"s + 2000\", delay = \"0.5 ms\" }";
/// Amplitude of the velocity, m/s.
const SPEED: f64 = 2e-5;
/// Duration, s, of which the last second is evaluated: it contains whole periods and samples.
const DURATION: f64 = 3.0;

pub(crate) fn loaded(settings: &[&str], more: &[String]) -> Project {
    let from_rest: Vec<&str> = BENCHMARK.lines().filter(|line| !line.starts_with("start = ")).collect();
    let source = Memory::default().with("rig.toml", from_rest.join("\n"));
    let settings = SMOOTH.iter().chain(settings).map(|text| (*text).to_string()).chain(more.iter().cloned());
    let settings: Vec<String> = settings.collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

/// Force over motion of the load or its ground in N/m, at this frequency in Hz, from the machine's
/// samples.
pub(crate) fn of_machine(settings: &[&str], hertz: u32) -> Complex64 {
    let frequency = TAU * f64::from(hertz);
    let amplitude = SPEED / frequency;
    let motion = format!(
        "scenario.0.load_motion={{ kind = \"sine\", amplitude = {amplitude:e}, frequency = \"{frequency} rad/s\" }}"
    );
    let project = loaded(settings, &[motion, format!("scenario.0.duration={DURATION} s")]);
    let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert_eq!(run.status, Status::Completed);
    let (times, force) = (&run.record.times_s, run.record.signal(Signal::Force));
    let sample_s = project.controller.as_ref().unwrap().sample_time.unwrap_or(1e-3);
    let at_samples = times.iter().zip(&force).filter(|(time, _)| {
        let samples = **time / sample_s;
        **time > DURATION - 1.0 + 5e-4 && (samples - samples.round()).abs() < 1e-6
    });
    let (mut sum, mut count) = (Complex64::ZERO, 0.0);
    for (time, force) in at_samples {
        sum += *force * exp_complex(Complex64::new(0.0, -frequency * time));
        count += 1.0;
    }
    assert!((count * sample_s - 1.0).abs() < 1e-9, "{count}");
    sum * Complex64::I * 2.0 / count / amplitude
}

/// Response of the linear plant of a rig at a frequency in rad/s.
pub(crate) fn response(compensation: &Compensation, rig: Rig, frequency: f64) -> MemberResponse {
    let member = match rig.in_motion {
        Some(moving) => compensation.responding(Arc::new(moving)),
        None => compensation.member(rig.plant.coefficients()).unwrap(),
    };
    member.response(frequency).unwrap()
}

/// Relative distance.
pub(crate) fn apart(one: Complex64, other: Complex64) -> f64 {
    (one / other - 1.0).norm_sqr().sqrt()
}
