use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::PlantCoefficients;
use phea_qft::family::Family;
use phea_qft::family::Spacing::{Linear, Logarithmic};
use phea_qft::template::{Resolution, TemplateOptions, Templates};

use crate::support::{Range, beyond, coefficients, family, plain_loop, random_values};

/// Command to force of a servovalve, cylinder and load cell: thesis 6.7 with A_u 1.58336e-3 m2, M 13.1 kg, K_S 2e7 N/m.
fn actuator<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    let [friction, flow_gain, leak, stiffness, w, damping] = [p[0], p[1], p[2], p[3], p[4], p[5]];
    let fixed = |value: f64| Recorded::from(value);
    let area = 1.58336e-3;
    let (area_squared, mass, sensor) = (fixed(area * area), fixed(13.1), fixed(2e7));
    let (w_squared, spool) = (w * w, fixed(2.0) * damping * w);
    let (leak, springs) = (leak * stiffness, stiffness + sensor);
    let denominator = vec![
        area_squared * mass,
        spool * area_squared * mass + area_squared * friction + leak * mass,
        spool * area_squared * friction
            + w_squared * area_squared * mass
            + leak * (spool * mass + friction)
            + area_squared * springs,
        spool * area_squared * springs
            + w_squared * area_squared * friction
            + leak * (spool * friction + w_squared * mass + sensor),
        w_squared * area_squared * springs + leak * (spool * sensor + w_squared * friction),
        w_squared * leak * sensor,
    ];
    coefficients(vec![fixed(area) * stiffness * flow_gain * sensor * w_squared], denominator)
}

/// Ranges of thesis Table 6.3.
const RANGES: [Range; 6] = [
    ("viscous_friction", 100.0, 3e4, Logarithmic),
    ("flow_gain", 3.23e-5, 5.61e-5, Linear),
    ("flow_pressure_coefficient", 6.42e-13, 7e-11, Logarithmic),
    ("hydraulic_stiffness", 2.24e6, 4.11e6, Linear),
    ("valve_natural_frequency", 879.0, 1319.0, Linear),
    ("valve_damping_ratio", 0.72, 1.08, Linear),
];

/// Thousands of plants for a box of six dimensions, not millions, and no random plant outside; the piston's resonance at 1300 rad/s too.
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
            let response = family.plant().response(&values, template.frequency_rad_per_s);
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
