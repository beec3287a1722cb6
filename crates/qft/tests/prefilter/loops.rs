//! Loops shared by several tests.

use phea_dynamics::controller::{Compensator, Controller, Element};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::specification::{Limit, Requirement, Specification};

pub(crate) fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

pub(crate) fn around(feedback: TransferFunction) -> Compensation {
    let feedback = Compensator::new(vec![Element::General(feedback)]);
    let controller = Controller { feedback, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

pub(crate) fn member(compensation: &Compensation, numerator: &[f64], denominator: &[f64]) -> Member {
    let command = RationalCoefficients { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    compensation
        .member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })
        .unwrap()
}

/// Plants k/s for each k, closed with gain 1: T = k/(s + k).
pub(crate) fn integrators(gains: &[f64]) -> (Compensation, Vec<Member>) {
    let compensation = around(TransferFunction::gain_only(1.0));
    let members = gains.iter().map(|&k| member(&compensation, &[k], &[1.0, 0.0])).collect();
    (compensation, members)
}

pub(crate) fn tracking(lower: Limit, upper: Limit, band: [f64; 2]) -> Specification {
    let requirement = Requirement::tracking(lower, upper);
    Specification { requirement, frequencies_rad_per_s: vec![], band_rad_per_s: band }
}

/// Plant k a/(s (s + a)), k and a from 1 to 10, with the published controller; its tracking
/// specification up to 10 rad/s.
pub(crate) fn servo() -> (Compensation, Vec<Member>, Specification) {
    let compensation = around(servo_controller());
    let Family::Uncertain(family) = servo_family() else { panic!("it is a box") };
    let coefficients = family.members().iter().map(|values| family.plant().coefficients(values).unwrap());
    let members = coefficients.map(|plant| compensation.member(plant).unwrap()).collect();
    let upper = Limit::Rational(rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752]));
    let lower = Limit::Rational(rational(&[120.0], &[1.0, 17.0, 82.0, 120.0]));
    (compensation, members, tracking(lower, upper, [0.0, 10.0]))
}

pub(crate) fn servo_controller() -> TransferFunction {
    rational(&[3.0787e6, 3.5365e8, 3.8529e8], &[1.0, 1528.8, 1.0636e6, 4.281e7])
}

pub(crate) fn servo_family() -> Family {
    let parameter =
        |name: &str| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 1.0, maximum: 10.0 };
    let plant = UncertainPlant::record(vec![parameter("k"), parameter("a")], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[1]],
            denominator: vec![1.0.into(), p[1], 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })
    .unwrap();
    let along = |index: usize| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Logarithmic],
        points: 5,
    };
    let coordinates = vec![along(0), along(1)];
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

/// Logarithmically spaced frequencies.
pub(crate) fn spaced(from: f64, to: f64, count: u32) -> Vec<f64> {
    let fraction = |index: u32| f64::from(index) / f64::from(count - 1);
    (0..count).map(|index| from * (to / from).powf(fraction(index))).collect()
}
