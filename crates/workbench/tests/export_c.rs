//! Exported C gives the bits of the simulation, whatever the compiler does.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use phea_dynamics::controller::{
    AntiWindup, Compensator, Controller, Converter, Element, InnerFeedback, Timing,
};
use phea_dynamics::random;
use phea_machine::{Deployed, SampledSignals};
use phea_workbench::export::{Contract, c, test_vectors};

const WARNINGS: &str = "-std=c99 -pedantic -Wall -Wextra -Werror -Wconversion -Wsign-conversion \
    -Wdouble-promotion -Wfloat-equal -Wshadow -Wcast-qual -Wmissing-prototypes -Wvla";

fn contract() -> Contract {
    Contract {
        title: "Rig of the test */ with a comment".to_string(),
        name: "rig".to_string(),
        version: "0",
        project_sha256: "0".repeat(64),
        verdict: "met, by a grid".to_string(),
        delay_s: 0.0,
        not_covered: vec!["what lies between samples".to_string()],
    }
}

/// A controller with these many elements, drawn from a seed.
fn drawn(seed: u64) -> Deployed {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = move |from: f64, to: f64| from + (to - from) * random::uniform(&mut state);
    let sample_time_s = 1e-3;
    let mut elements = vec![Element::Gain(10_f64.powf(uniform(-4.0, 0.0)))];
    if uniform(0.0, 1.0) < 0.7 {
        elements.push(Element::Integrator);
    }
    for _ in 0..(uniform(0.0, 5.0) as usize) {
        let frequency = 10_f64.powf(uniform(-1.0, 3.3));
        let second = 10_f64.powf(uniform(-1.0, 3.3));
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
        ..Controller::default()
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

/// A program that reads signals and writes commands, with the exported files beside it.
fn written(deployed: &Deployed, folder: &Path) -> Vec<&'static str> {
    fs::create_dir_all(folder).unwrap();
    for file in c::files(deployed, &contract(), &test_vectors(deployed, 1e4)) {
        fs::write(folder.join(&file.name), &file.bytes).unwrap();
    }
    let mut signals = vec!["reference", "measurement"];
    if deployed.feed_forward != 0.0 {
        signals.push("velocity");
    }
    if deployed.controller.reads_inner() {
        signals.push("pressure");
    }
    let assigned: String = ["reference", "measurement", "velocity", "pressure"]
        .iter()
        .enumerate()
        .filter(|(_, signal)| signals.contains(signal))
        .map(|(place, signal)| format!("        read.{signal} = row[{place}];\n"))
        .collect();
    let program = format!(
        "#include \"rig.h\"\n#include <stdio.h>\nint main(void) {{\n    double row[4];\n    rig_state state;\n    \
         rig_signals read;\n    rig_reset(&state);\n    while (fread(row, sizeof row, 1, stdin) == 1) {{\n{assigned}        \
         row[0] = rig_step(&state, &read).command;\n        (void)fwrite(row, sizeof(double), 1, stdout);\n    }}\n    \
         return 0;\n}}\n"
    );
    fs::write(folder.join("through.c"), program).unwrap();
    signals
}

fn compiled(folder: &Path, program: &str, options: &str) -> PathBuf {
    let out = folder.join(format!("{program}.{}", options.len()));
    let sources = ["rig.c", "rig_self_test.c", program];
    let status = Command::new("gcc")
        .args(WARNINGS.split_whitespace())
        .args(options.split_whitespace())
        .args(sources)
        .arg("-o")
        .arg(&out)
        .current_dir(folder)
        .status()
        .unwrap();
    assert!(status.success(), "gcc {options} {}", folder.display());
    out
}

/// Samples that drive a controller into its limits and out of them.
fn samples(count: usize, seed: u64) -> Vec<[f64; 4]> {
    let mut state = seed | 1;
    let mut size = 1e3;
    (0..count)
        .map(|index| {
            if index % 97 == 0 {
                size = 10_f64.powf(1.0 + 4.0 * random::uniform(&mut state));
            }
            let mut draw = |scale: f64| scale * (2.0 * random::uniform(&mut state) - 1.0);
            let reference = draw(size);
            [reference, draw(size), draw(0.3), draw(1e6)]
        })
        .collect()
}

fn commands(deployed: &Deployed, samples: &[[f64; 4]]) -> Vec<u64> {
    let mut state = deployed.at_rest();
    let step = |&[reference, measurement, velocity, pressure]: &[f64; 4]| {
        let read = SampledSignals { reference, measurement, velocity, pressure };
        deployed.step(&mut state, &read).command_v.to_bits()
    };
    samples.iter().map(step).collect()
}

fn run(program: &Path, samples: &[[f64; 4]]) -> Vec<u64> {
    let input = program.with_extension("input");
    let bytes: Vec<u8> = samples.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    fs::write(&input, bytes).unwrap();
    let output = Command::new(program).stdin(Stdio::from(fs::File::open(input).unwrap())).output().unwrap();
    output.stdout.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
}

#[test]
fn exported_c_gives_the_bits_of_the_simulation() {
    let root = std::env::temp_dir().join(format!("phea_export_c_{}", std::process::id()));
    for seed in 1..13 {
        let deployed = drawn(seed);
        let folder = root.join(seed.to_string());
        written(&deployed, &folder);
        let samples = samples(4000, seed);
        let expected = commands(&deployed, &samples);
        for options in ["-O0", "-O3 -march=native -ffp-contract=fast"] {
            let program = compiled(&folder, "through.c", options);
            assert!(run(&program, &samples) == expected, "controller {seed}, {options}");
            let test = compiled(&folder, "example_main.c", options);
            let outcome = Command::new(test).output().unwrap();
            assert!(outcome.status.success(), "{}", String::from_utf8_lossy(&outcome.stdout));
        }
    }
    fs::remove_dir_all(root).unwrap();
}
