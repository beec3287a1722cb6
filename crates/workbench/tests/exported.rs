//! Controllers for the tests of exported files, drawn from seeds, with the commands that they give
//! in the simulation.

use phea_dynamics::controller::{
    AntiWindup, Compensator, Controller, Converter, Element, InnerFeedback, Timing,
};
use phea_dynamics::{portable, random};
use phea_machine::{Deployed, SampledSignals};
use phea_workbench::export::{Contract, ExportedController, ExportedPlant, test_vectors};
use phea_workbench::plant_values::Factors;

pub(crate) fn exported(deployed: &Deployed) -> ExportedController {
    let contract = Contract {
        title: "Rig of the test */ with a comment".to_string(),
        version: "0",
        project_sha256: "0".repeat(64),
        settings: vec!["line.length=2 m".to_string()],
        verdict: "met, by a grid".to_string(),
        delay_s: 0.0,
        motion: None,
        not_covered: vec!["what lies between samples".to_string()],
    };
    let (deployed, vectors) = (deployed.clone(), test_vectors(deployed, 1e4));
    let plant = Factors {
        gain: 2.0,
        zeros: vec![],
        poles: vec![[-1.0, 2.0], [-1.0, -2.0]],
        dead_time_s: 0.0,
        sample_time_s: None,
    };
    let plants = vec![ExportedPlant { values: vec![3.0], factors: plant }];
    let (name, parameters) = ("rig".to_string(), vec!["k".to_string()]);
    ExportedController { name, deployed, contract, vectors, parameters, plants }
}

fn power(exponent: f64) -> f64 {
    portable::pow(10.0, exponent)
}

/// A controller of up to six elements, drawn from a seed.
pub(crate) fn drawn(seed: u64) -> Deployed {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = move |from: f64, to: f64| from + (to - from) * random::uniform(&mut state);
    let sample_time_s = 1e-3;
    let mut elements = vec![Element::Gain(power(uniform(-4.0, 0.0)))];
    if uniform(0.0, 1.0) < 0.7 {
        elements.push(Element::Integrator);
    }
    for _ in 0..(uniform(0.0, 5.0) as usize) {
        let frequency = power(uniform(-1.0, 3.3));
        let second = power(uniform(-1.0, 3.3));
        elements.push(match uniform(0.0, 3.0) as usize {
            0 => Element::RealPole { frequency },
            1 => Element::LeadLag { zero_frequency: frequency, pole_frequency: second },
            _ => Element::ComplexPoles { natural_frequency: frequency, damping_ratio: uniform(0.05, 1.0) },
        });
    }
    let prefilter = vec![Element::RealPole { frequency: uniform(1.0, 500.0) }];
    let anti_windup =
        [AntiWindup::None, AntiWindup::BackCalculation, AntiWindup::Clamping][uniform(0.0, 3.0) as usize];
    let inner = InnerFeedback { gain: 1e-7, high_pass_rad_per_s: Some(10.0), ..InnerFeedback::default() };
    let inner_feedback = if uniform(0.0, 1.0) < 0.4 { inner } else { InnerFeedback::default() };
    let controller = Controller {
        feedback: Compensator::new(elements),
        prefilter: Compensator::new(prefilter),
        command_limit: (uniform(0.0, 1.0) < 0.8).then_some(10.0),
        anti_windup,
        timing: Timing { inner_feedback, ..Timing::default() },
    };
    let mut deployed = Deployed::new(controller.sampled(sample_time_s).unwrap());
    if uniform(0.0, 1.0) < 0.5 {
        deployed.measurement_converter = Converter::new(16, [-2e4, 2e4]).ok();
        deployed.command_converter = Converter::new(12, [-10.0, 10.0]).ok();
    }
    if uniform(0.0, 1.0) < 0.5 {
        deployed.feed_forward = 12.3;
        deployed.velocity_resolution = if uniform(0.0, 1.0) < 0.5 { 1e-4 } else { 0.0 };
    }
    deployed
}

/// Samples that drive a controller into its limits and out of them.
pub(crate) fn samples(count: usize, seed: u64) -> Vec<[f64; 4]> {
    let mut state = seed | 1;
    let mut size = 1e3;
    (0..count)
        .map(|index| {
            if index % 97 == 0 {
                size = power(1.0 + 4.0 * random::uniform(&mut state));
            }
            let mut draw = |scale: f64| scale * (2.0 * random::uniform(&mut state) - 1.0);
            let reference = draw(size);
            [reference, draw(size), draw(0.3), draw(1e6)]
        })
        .collect()
}

pub(crate) fn commands(deployed: &Deployed, samples: &[[f64; 4]]) -> Vec<u64> {
    let mut state = deployed.at_rest();
    let step = |&[reference, measurement, velocity, pressure]: &[f64; 4]| {
        let read = SampledSignals { reference, measurement, velocity, pressure };
        deployed.step(&mut state, &read).command_v.to_bits()
    };
    samples.iter().map(step).collect()
}
