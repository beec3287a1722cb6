//! A rig whose peak depends on a growing ringing of 1e-5 N, simulated by CVODE and by phea at many
//! tolerances.
//!
//!     cargo run --release -p sundials --example ill_conditioned -- 1e-9 1e-11
//!
//! `examples/ybitu/pipe.toml` with its load moved by 20 mm in 2 s: the piston follows so slowly
//! that its friction falls with the velocity and feeds the ringing on the load cell. For each
//! tolerance it prints the peak of the force's deviation from 4 kN after 3 s, on rows of 0.1 ms.

use std::f64::consts::FRAC_PI_4;
use std::time::Instant;

use phea_dynamics::controller::{AntiWindup, Compensator, Controller, Element};
use phea_dynamics::simulation::{
    CommandedPlant, Input, InputSchedule, Plant, Profile, SimulationSettings, System, simulate,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::machine::{Machine, MachineOptions, StartValues};
use phea_hydraulics::reference_rig::{benchmark_components, components, pipe_line};
use phea_hydraulics::servovalve::Servovalve;
use phea_hydraulics::stiffness::StiffnessModel;
use sundials::{Following, Kicks, Method, follow};

const REFERENCE_N: f64 = 4e3;
const REFERENCE_S: f64 = 2.0;
const MOTION_S: f64 = 3.0;
const OUTPUT_STEP_S: f64 = 1e-4;

fn main() {
    let area = FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    let rig = components(pipe_line(), StiffnessModel::Uniform);
    let rig = Components {
        friction: benchmark_components().friction,
        cylinder: Cylinder { area_a: area, area_b: area, ..rig.cylinder },
        valve: Servovalve { tare_reference_drop: 210e5, ..rig.valve },
        ..rig
    };
    let actuator = Actuator::new(rig).expect("the rig of the thesis");
    let machine = Machine::new(&actuator, &MachineOptions::default()).expect("its machine");
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    let beginning = machine.start(&start).expect("inside the stroke");
    let gains = Element::ProportionalIntegral { proportional_gain: 5e-4, integral_gain: 2e-3 };
    let filter = Element::ComplexPoles { natural_frequency: 22.0, damping_ratio: 1.0 };
    let controller = Controller {
        feedback: Compensator::new(vec![gains]),
        prefilter: Compensator::new(vec![filter]),
        command_limit: Some(10.0),
        anti_windup: AntiWindup::None,
        ..Controller::default()
    };
    let closed = CommandedPlant::in_loop(machine, &controller, 0.0).expect("a proper controller");
    let reference = Profile::steps(0.0, &[(REFERENCE_S, REFERENCE_N)]).expect("one step");
    let ground = Profile::smooth_step(MOTION_S, 2.0, 0.02).expect("a motion").shifted(beginning.inputs[0]);
    let inputs = vec![Input::Value(reference), Input::Value(ground.clone()), Input::Rate(ground)];
    let schedule = InputSchedule { duration_s: 5.0, output_step_s: OUTPUT_STEP_S, inputs };
    let mut state = beginning.state.clone();
    state.resize(System::<f64>::states(&closed), 0.0);
    let states = Plant::<f64>::states(&machine);
    let force = |row: &Vec<f64>| machine.measurement(&row[..states], &[0.0; 2]);

    let words: Vec<String> = std::env::args().skip(1).collect();
    for word in &words {
        let tolerance: f64 = word.parse().expect("a tolerance");
        let begun = Instant::now();
        let settings = SimulationSettings { tolerance, ..SimulationSettings::default() };
        if let Ok(run) = simulate(&closed, &state, &schedule, None, &settings, &mut |_| true) {
            let rows: Vec<f64> = run.trajectory.states.iter().map(force).collect();
            let work = run.outcome.work;
            print_peak(&format!("phea {word}, {} steps", work.steps + work.rejected), &rows, begun);
        }
        let kicks = Some(Kicks { period_s: 1e-2, size: tolerance, seed: 1 });
        let plain = |method| Following::new(tolerance, method);
        for (name, following) in [
            ("BDF", plain(Method::BackwardDifferentiation)),
            ("BDF with stability limit", plain(Method::StabilityLimit)),
            ("Adams", plain(Method::Adams)),
            ("Adams, kicked by its tolerance every 10 ms", Following { kicks, ..plain(Method::Adams) }),
        ] {
            let begun = Instant::now();
            match follow(&closed, &state, &schedule, None, &following) {
                Ok(rows) => {
                    print_peak(&format!("{name} {word}"), &rows.iter().map(force).collect::<Vec<_>>(), begun)
                }
                Err(problem) => println!("{name} {word}: {problem}"),
            }
        }
    }
}

/// Prints the peak after the load has begun to move, its time, and the ringing just before it
/// grows.
fn print_peak(name: &str, force: &[f64], begun: Instant) {
    let from = (MOTION_S / OUTPUT_STEP_S).round() as usize;
    let errors = force.iter().enumerate().skip(from).map(|(row, force)| (row, (force - REFERENCE_N).abs()));
    let (row, peak) = errors.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    let at = |time: f64| (time / OUTPUT_STEP_S).round() as usize;
    // Third differences show ringing, and little of the slow part.
    let ringing = |from: f64, to: f64| -> f64 {
        let rows = force.get(at(from)..at(to)).unwrap_or_default();
        let differences = rows.windows(4).map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs());
        differences.fold(0.0, f64::max)
    };
    println!(
        "{name}: peak {peak:.3} N at {:.4} s; third differences {:.2e} N in 3.34 to 3.36 s, {:.2e} in 3.5 to 3.6 s; {:.1} s",
        row as f64 * OUTPUT_STEP_S,
        ringing(3.34, 3.36),
        ringing(3.5, 3.6),
        begun.elapsed().as_secs_f64()
    );
}
