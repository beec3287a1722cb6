//! Random structures and problems shared by several tests, from fixed seeds.

use num_complex::Complex64;
use phea_dynamics::controller::{Element, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::design::DesignProblem;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, random};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::specification::{ClosedLoop, Limit, LimitTable, Requirement, Specification};
use phea_qft::verification::PlantPoint;

/// A linear congruential generator (Knuth's MMIX constants), so that the draws are identical
/// everywhere.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    /// A number uniform in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number between these two, uniform in its logarithm.
    pub(crate) fn factor(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.uniform())
    }

    /// A point within bounds.
    pub(crate) fn point(&mut self, bounds: &[[f64; 2]]) -> Vec<f64> {
        bounds.iter().map(|[low, high]| low + (high - low) * self.uniform()).collect()
    }
}

/// Structure of three zeros and five poles, including an integrator.
pub(crate) fn structure(draw: &mut Draw) -> Structure {
    let mut range = |low: f64, high: f64| {
        let middle = draw.factor(low, high);
        [middle / 2.0, middle * 2.0]
    };
    let parts = vec![
        StructureFactor::RealZero { frequency: range(1.0, 20.0) },
        StructureFactor::PolePair { natural_frequency: range(20.0, 200.0), damping_ratio: range(0.3, 2.0) },
        StructureFactor::Fixed(Element::Integrator),
        StructureFactor::ZeroPair { natural_frequency: range(2.0, 50.0), damping_ratio: range(0.2, 1.5) },
        StructureFactor::RealPole { frequency: range(50.0, 500.0) },
        StructureFactor::Fixed(Element::LeadLag { zero_frequency: 30.0, pole_frequency: 7.0 }),
    ];
    let sign = if draw.uniform() < 0.5 { -1.0 } else { 1.0 };
    Structure { sign, gain: [0.2, 5.0], parts }
}

pub(crate) fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

pub(crate) fn specification(requirement: Requirement, band_rad_per_s: [f64; 2]) -> Specification {
    Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s }
}

/// A specification of each kind, over different bands.
pub(crate) fn specifications() -> Vec<Specification> {
    let constant = Limit::Constant;
    let everywhere = [0.0, f64::INFINITY];
    let table = LimitTable::new(vec![(0.5, 0.3), (5.0, 1.0), (20.0, 2.0)]).unwrap();
    vec![
        specification(Requirement::at_most(ClosedLoop::RobustStability, constant(1.3)), everywhere),
        specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Table(table)), everywhere),
        specification(Requirement::at_most(ClosedLoop::PlantInputDisturbance, constant(0.4)), [0.0, 40.0]),
        specification(Requirement::at_most(ClosedLoop::ControlEffort, constant(7.0)), [3.0, f64::INFINITY]),
        specification(
            Requirement::at_most(ClosedLoop::LoadMotion, Limit::Rational(rational(&[5.0, 0.0], &[1.0, 4.0]))),
            everywhere,
        ),
        specification(
            Requirement::tracking(
                Limit::Rational(rational(&[120.0], &[1.0, 17.0, 82.0, 120.0])),
                Limit::Rational(rational(&[1.0, 20.0], &[1.0, 4.0, 20.0])),
            ),
            [0.0, 15.0],
        ),
    ]
}

/// Plant k w^2 (s/5 + 1)/((s/a + 1)(s^2 + 2 d w s + w^2)) e^(-0.003 s) with load motion through
/// this resonance, and a sensor.
pub(crate) fn problem(timing: Timing) -> DesignProblem {
    let parameter = |name: &str, minimum: f64, maximum: f64| UncertainParameter {
        name: name.into(),
        nominal: minimum,
        minimum,
        maximum,
    };
    let parameters = vec![
        parameter("k", 0.5, 5.0),
        parameter("a", 0.5, 3.0),
        parameter("d", 0.05, 0.5),
        parameter("w", 10.0, 30.0),
    ];
    let plant = UncertainPlant::record(parameters, |p| {
        let [k, a, d, w] = [p[0], p[1], p[2], p[3]];
        let damping = d * w + d * w;
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![k * w * w * a * 0.2.into(), k * w * w * a],
                denominator: vec![1.0.into(), damping + a, w * w + damping * a, w * w * a],
            },
            disturbance: Some(RationalCoefficients {
                numerator: vec![3.0.into(), 0.0.into()],
                denominator: vec![1.0.into(), damping, w * w],
            }),
            dead_time_s: 0.003.into(),
            rate: None,
        }
    })
    .unwrap();
    let along = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Logarithmic],
        points: 2,
    };
    let coordinates: Vec<Coordinate> = (0..4).map(along).collect();
    let members = random(&plant, &coordinates, 23, 5).unwrap();
    let family = UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap();
    DesignProblem {
        family: Family::Uncertain(family),
        additional_plants: vec![],
        sensor: TransferFunction::from_factors(80.0, vec![], vec![Complex64::new(-80.0, 0.0)]).unwrap(),
        timing,
        specifications: specifications(),
        minimum_delay_margin_s: 0.0,
    }
}

/// The members of the problem's family.
pub(crate) fn plants(problem: &DesignProblem) -> Vec<PlantPoint> {
    match &problem.family {
        Family::Uncertain(family) => family.members().iter().cloned().map(PlantPoint::Parameters).collect(),
        Family::Measured(family) => (0..family.plants().len()).map(PlantPoint::Measured).collect(),
    }
}
