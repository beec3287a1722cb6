use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_qft::family::Family;
use phea_qft::family::Spacing::{Linear, Logarithmic};
use phea_qft::template::{Resolution, TemplateOptions, Templates};

use super::support::{Range, beyond, coefficients, family, plain_loop, random_values};
use crate::rig::force;

fn actuator<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    let RationalCoefficients { numerator, denominator } = force(p);
    coefficients(numerator, denominator)
}

/// Parameter ranges of thesis Table 6.3.
const RANGES: [Range; 6] = [
    ("viscous_friction", 100.0, 3e4, Logarithmic),
    ("flow_gain", 3.23e-5, 5.61e-5, Linear),
    ("flow_pressure_coefficient", 6.42e-13, 7e-11, Logarithmic),
    ("hydraulic_stiffness", 2.24e6, 4.11e6, Linear),
    ("valve_natural_frequency", 879.0, 1319.0, Linear),
    ("valve_damping_ratio", 0.72, 1.08, Linear),
];

/// Thousands of plants for a box of six dimensions, not millions, and no random plant outside, also
/// for the piston's resonance at 1300 rad/s.
#[test]
fn an_actuator_is_resolved_with_little_work() {
    let family = family(&RANGES, 3, actuator);
    let frequencies = [0.01, 0.1, 1.0, 5.0, 10.0, 50.0, 100.0, 150.0, 1300.0];
    let (whole, compensation) = (Family::Uncertain(family.clone()), plain_loop());
    let options = TemplateOptions::default();
    let mut evaluations = 0;
    for built in Templates::new(&whole, &compensation, &frequencies, options) {
        let built = built.unwrap();
        let template = built.template;
        assert!(matches!(template.resolution, Resolution::Resolved { .. }), "{:?}", template.resolution);
        evaluations += built.evaluations;
        for values in random_values(&family, 2000, 5) {
            let response = family.plant().response(&values, template.frequency_rad_per_s).unwrap();
            assert!(beyond(&template.outlines, response, &options) < 0.1, "{values:?}");
        }
    }
    assert!(evaluations < 80_000, "{evaluations}");
}

#[test]
fn the_same_family_gives_the_same_template() {
    let family = Family::Uncertain(family(&RANGES, 2, actuator));
    let compensation = plain_loop();
    let all = || -> Vec<_> {
        Templates::new(&family, &compensation, &[1.0, 10.0], TemplateOptions::default()).collect()
    };
    assert_eq!(all(), all());
}
