//! The design with the least high-frequency gain of the servo k a/(s (s + a)), timed: `cargo bench -p phea-qft --bench design`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::process::ExitCode;
use std::time::Instant;

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::design::{
    ControllerChoice, DesignOptions, DesignProblem, DesignRun, Objective, PrefilterChoice,
};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::loop_shaping::{Part, Structure};
use phea_qft::specification::{Limit, Requirement, Specification};
use phea_qft::verification::TOLERANCE_DB;

type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Failure> {
    let problem = servo()?;
    for (name, damping_ratio) in [("two real poles", [1.0, 5.0]), ("complex poles", [0.1, 5.0])] {
        for seed in 1..=3 {
            let corner = [0.1, 1e5];
            let parts = vec![
                Part::RealZero { frequency: corner },
                Part::PolePair { natural_frequency: corner, damping_ratio },
            ];
            let structure = Structure { sign: 1.0, gain: [1e-2, 1e4], parts };
            let options = DesignOptions {
                objective: Objective::LeastHighFrequencyGain,
                controller: ControllerChoice::Given(structure),
                prefilter: PrefilterChoice::None,
                seed,
                tolerance_db: TOLERANCE_DB,
            };
            let begun = Instant::now();
            let mut run = DesignRun::new(problem.clone(), options);
            while run.step()? {}
            let seconds = begun.elapsed().as_secs_f64();
            let design = run.design().ok_or("no design")?;
            println!(
                "{name}, seed {seed}: {:.3} s, {:?}, {:.3} dB, {} rounds",
                seconds,
                design.status,
                design.objective_db,
                design.rounds.len()
            );
            for round in &design.rounds {
                println!(
                    "   {:.4} dB, {} plants, {} frequencies, searched {:.5} audited {:?}",
                    round.objective_db,
                    round.plants,
                    round.frequencies,
                    round.searched_margin_db,
                    round.audited_margin_db
                );
            }
        }
    }
    Ok(())
}

fn servo() -> Result<DesignProblem, Failure> {
    let parameter =
        |name: &str| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 1.0, maximum: 10.0 };
    let plant = UncertainPlant::record(vec![parameter("k"), parameter("a")], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[1]],
            denominator: vec![1.0.into(), p[1], 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
    })?;
    let along = |parameter| Coordinate {
        parameters: vec![parameter],
        opposed: vec![],
        spacing: vec![Spacing::Logarithmic],
        points: 7,
    };
    let coordinates = vec![along(0), along(1)];
    let members = grid(&plant, &coordinates)?;
    let family = UncertainFamily::new(plant, coordinates, members, Extent::Box)?;
    let rational = |numerator: &[f64], denominator: &[f64]| {
        let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
        TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator))
            .map(Limit::Rational)
    };
    let specifications = vec![
        Specification {
            requirement: Requirement::RobustStability(Limit::Constant(1.2)),
            frequencies_rad_per_s: vec![0.1, 0.5, 1.0, 15.0, 100.0],
            band_rad_per_s: [0.0, f64::INFINITY],
        },
        Specification {
            requirement: Requirement::Tracking {
                lower: rational(&[120.0], &[1.0, 17.0, 82.0, 120.0])?,
                upper: rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752])?,
            },
            frequencies_rad_per_s: vec![0.1, 0.5, 1.0, 15.0],
            band_rad_per_s: [0.0, 15.0],
        },
    ];
    Ok(DesignProblem {
        family: Family::Uncertain(family),
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications,
        minimum_delay_margin_s: 0.0,
    })
}
