//! Problems shared by several tests, and the independent audit of every result.

use phea_dynamics::controller::{Element, Timing};
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::pieces::Workers;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::design::{
    ControllerChoice, Design, DesignOptions, DesignProblem, DesignStatus, Objective, PoleRange,
    PrefilterChoice, design,
};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{Audit, AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict};

pub(crate) const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

type Coefficients<'t> = (Vec<Recorded<'t>>, Vec<Recorded<'t>>);

pub(crate) fn uncertain(
    parameters: &[(&str, f64, f64, f64)],
    coefficients: impl for<'t> Fn(&[Recorded<'t>]) -> Coefficients<'t>,
) -> UncertainPlant {
    let parameter = |&(name, nominal, minimum, maximum): &(&str, f64, f64, f64)| UncertainParameter {
        name: name.into(),
        nominal,
        minimum,
        maximum,
    };
    UncertainPlant::record(parameters.iter().map(parameter).collect(), |p| {
        let (numerator, denominator) = coefficients(p);
        let command = RationalCoefficients { numerator, denominator };
        PlantCoefficients { command, disturbance: None, dead_time_s: 0.0.into(), rate: None }
    })
    .unwrap()
}

/// The whole box of the plant's parameters.
pub(crate) fn boxed(plant: UncertainPlant, spacing: Spacing, points: usize) -> Family {
    let along =
        |index| Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![spacing], points };
    let coordinates: Vec<Coordinate> = (0..plant.parameters().len()).map(along).collect();
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

/// Plant k a/(s (s + a)), k and a from 1 to 10.
pub(crate) fn servo() -> Family {
    let plant = uncertain(&[("k", 1.0, 1.0, 10.0), ("a", 1.0, 1.0, 10.0)], |p| {
        (vec![p[0] * p[1]], vec![1.0.into(), p[1], 0.0.into()])
    });
    boxed(plant, Spacing::Logarithmic, 7)
}

/// Plant k/s, k from 1 to this value.
pub(crate) fn integrator(greatest: f64) -> Family {
    let plant = uncertain(&[("k", 1.0, 1.0, greatest)], |p| (vec![p[0]], vec![1.0.into(), 0.0.into()]));
    boxed(plant, Spacing::Linear, 3)
}

pub(crate) fn rational(numerator: &[f64], denominator: &[f64]) -> Limit {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    Limit::Rational(
        TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap(),
    )
}

pub(crate) fn demand(requirement: Requirement, frequencies: &[f64], band: [f64; 2]) -> Specification {
    Specification { requirement, frequencies_rad_per_s: frequencies.to_vec(), band_rad_per_s: band }
}

pub(crate) fn stability(limit: f64, frequencies: &[f64]) -> Specification {
    demand(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)), frequencies, EVERYWHERE)
}

/// Tracking limits of the servo up to this frequency, rad/s.
pub(crate) fn following(frequencies: &[f64], to: f64) -> Specification {
    let requirement = Requirement::tracking(
        rational(&[120.0], &[1.0, 17.0, 82.0, 120.0]),
        rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752]),
    );
    demand(requirement, frequencies, [0.0, to])
}

/// Example D: the servo, |T| <= 1.2 everywhere, tracking up to 15 rad/s.
pub(crate) fn example_d() -> DesignProblem {
    let specifications =
        vec![stability(1.2, &[0.1, 0.5, 1.0, 15.0, 100.0]), following(&[0.1, 0.5, 1.0, 15.0], 15.0)];
    problem(servo(), specifications)
}

pub(crate) fn problem(family: Family, specifications: Vec<Specification>) -> DesignProblem {
    DesignProblem {
        family,
        additional_plants: vec![],
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications,
        minimum_delay_margin_s: 0.0,
    }
}

/// Structure of zeros and poles with corners and damping ratios in these ranges: in `I Z ZZ P PP`
/// an integrator, a zero, a pair of zeros, and so on.
pub(crate) fn structure(
    text: &str,
    gain: [f64; 2],
    frequency: [f64; 2],
    damping_ratio: [f64; 2],
) -> Structure {
    let natural_frequency = frequency;
    let part = |word| match word {
        "I" => StructureFactor::Fixed(Element::Integrator),
        "Z" => StructureFactor::RealZero { frequency },
        "P" => StructureFactor::RealPole { frequency },
        "ZZ" => StructureFactor::ZeroPair { natural_frequency, damping_ratio },
        "PP" => StructureFactor::PolePair { natural_frequency, damping_ratio },
        _ => panic!("{word}"),
    };
    Structure { sign: 1.0, gain, parts: text.split_whitespace().map(part).collect() }
}

/// The least high-frequency gain among the controllers of a structure, with tracking assessed by
/// its spread.
pub(crate) fn least_gain(structure: Structure, seed: u64) -> DesignOptions {
    DesignOptions {
        objective: Objective::LeastHighFrequencyGain,
        controller: ControllerChoice::Given(structure),
        prefilter: PrefilterChoice::None,
        seed,
        tolerance_db: TOLERANCE_DB,
        reserve_db: 0.0,
        poles: PoleRange::default(),
        coefficients: CoefficientFormat::Double,
        workers: Workers::CALLER,
    }
}

pub(crate) fn designed(problem: &DesignProblem, options: DesignOptions) -> Design {
    design(problem, &options, &mut unwatched).unwrap().design.unwrap()
}

/// An independent audit of a design.
pub(crate) fn audited(problem: &DesignProblem, design: &Design, tracking: TrackingJudgement) -> Audit {
    let compensation = Compensation::new(&design.controller, problem.sensor.clone()).unwrap();
    let problem = AuditProblem {
        family: &problem.family,
        compensation: &compensation,
        specifications: &problem.specifications,
        tracking,
        tolerance_db: TOLERANCE_DB,
    };
    audit(&problem, &mut unwatched).unwrap()
}

/// Asserts that the design is met, by its result and by an independent audit.
pub(crate) fn assert_met(problem: &DesignProblem, design: &Design, tracking: TrackingJudgement) {
    assert_eq!(design.status, DesignStatus::Met, "{:?}", design.rounds);
    let audit = audited(problem, design, tracking);
    assert_eq!(audit.verdict, Verdict::Met, "{:?}", audit.specifications);
    assert_eq!(audit, design.audit);
}

/// High-frequency gain 20 log10 |lim s^r G|, and r.
pub(crate) fn high_frequency_gain(design: &Design) -> (f64, i32) {
    let function = design.controller.feedback.transfer_function().unwrap();
    let degree = function.poles().len() as i32 - function.zeros().len() as i32;
    (20.0 * function.gain().abs().log10(), degree)
}
