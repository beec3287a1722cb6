//! The family of an actuator compared with the linear model of its rig.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::uncertain_plant::{RationalCoefficients, UncertainParameter, UncertainPlant};
use phea_hydraulics::linear::{LinearParameters, linear_model_coefficients};
use phea_qft::family::Family;
use phea_workbench::engineering::family::{ProjectFamilyError, family};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::{self, LINEAR_PARAMETERS, Project, Random, Uncertain};
use phea_workbench::source::Memory;

fn loaded(text: &str) -> Project {
    let source = Memory::default().with("p.toml", text);
    project::read(&source, "p.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}")).project
}

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// The plant of the family, recorded with few members: their grid may be large.
fn recorded(project: &Project) -> Result<UncertainPlant, ProjectFamilyError> {
    let few = project::DeclaredFamily {
        random: Some(Random { count: 1, seed: 1 }),
        ..project::DeclaredFamily::default()
    };
    let project = Project { family: Some(few), ..project.clone() };
    match family(&Setup::new(&project).unwrap(), &Memory::default())? {
        Family::Uncertain(family) => Ok(family.plant().clone()),
        Family::Measured(_) => panic!("nothing was measured"),
    }
}

/// Values within the ranges: multiples of the golden ratio fill the unit interval evenly.
fn points(plant: &UncertainPlant) -> Vec<Vec<f64>> {
    let mut fraction = 0.0_f64;
    let mut value = |parameter: &UncertainParameter| {
        fraction = (fraction + 0.618_033_988_75).fract();
        parameter.minimum + fraction * (parameter.maximum - parameter.minimum)
    };
    (0..50).map(|_| plant.parameters().iter().map(&mut value).collect()).collect()
}

/// The recorded coefficients are those of the equations evaluated with numbers, inside the box and
/// at its corners.
#[test]
fn the_recorded_rig_is_the_linear_model() {
    let project = loaded(HOSE);
    let plant = recorded(&project).unwrap();
    let rig = Setup::rig_of(&project).unwrap();
    assert_eq!(plant.coefficients(&plant.nominal()), Some(rig.plant.coefficients()));
    for values in points(&plant) {
        let mut stated = project.clone();
        for (uncertain, value) in stated.uncertainty.iter_mut().zip(&values) {
            uncertain.nominal = *value;
        }
        let rig = Setup::rig_of(&stated).unwrap();
        assert_eq!(plant.coefficients(&values), Some(rig.plant.coefficients()));
        // thesis (6.7) for a prescribed load without leakage
        let published = linear_model_coefficients(&rig.linear).command;
        let own = plant.coefficients(&values).unwrap().command;
        let all = |one: &RationalCoefficients<f64>| [&one.numerator[..], &one.denominator[..]].concat();
        for (own, published) in all(&own).iter().zip(&all(&published)) {
            assert!((own - published).abs() <= 1e-14 * published.abs(), "{own} {published}");
        }
    }
}

/// A project whose `[linear]` and `[uncertainty]` are replaced.
fn with_uncertain(text: &str, ranges: &[(&str, [f64; 3])]) -> String {
    let start = text.find("[uncertainty]").unwrap();
    let end = text.find("[[specification]]").unwrap_or(text.len());
    let lines: String = ranges
        .iter()
        .map(|(name, [low, nominal, high])| {
            format!("\"{name}\" = {{ nominal = {nominal:e}, minimum = {low:e}, maximum = {high:e} }}\n")
        })
        .collect();
    format!("{}[uncertainty]\n{lines}{}", &text[..start], &text[end..])
}

/// Checks that every path, recorded, gives the values of the whole rig when the project itself
/// states the number.
#[track_caller]
fn follows_the_rig(text: &str, ranges: &[(&str, [f64; 3])]) {
    follows_the_rig_within(1e-12, text, ranges);
}

/// Checks the paths to a tolerance, for a rig that finds its pressures by other steps.
#[track_caller]
fn follows_the_rig_within(tolerance: f64, text: &str, ranges: &[(&str, [f64; 3])]) {
    let project = loaded(&with_uncertain(text, ranges));
    let plant = recorded(&project).unwrap();
    for values in points(&plant) {
        let mut stated = project.clone();
        stated.uncertainty.clear();
        for (parameter, value) in plant.parameters().iter().zip(&values) {
            stated = stated.with_number(&parameter.name, *value).unwrap();
        }
        let expected = Setup::rig_of(&stated).unwrap().plant.coefficients();
        let found = plant.coefficients(&values).unwrap();
        let [found, expected] = [found, expected].map(|member| {
            let disturbance = member.disturbance.unwrap();
            [member.command.numerator, member.command.denominator, disturbance.numerator].concat()
        });
        for (one, other) in found.iter().zip(&expected) {
            assert!((one - other).abs() <= tolerance * other.abs(), "{values:?}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn physical_paths_reach_the_model_as_through_the_rig() {
    follows_the_rig(
        HOSE,
        &[
            ("cylinder.moving_mass", [10.0, 13.1, 20.0]),
            ("cylinder.friction.viscous", [50.0, 100.0, 3e4]),
            ("cylinder.piston_diameter", [0.049, 0.05, 0.052]),
            ("cylinder.rod_diameter", [0.02, 0.022, 0.024]),
            ("cylinder.stroke", [0.3, 0.5, 0.6]),
            ("force_sensor.stiffness", [1e7, 2e7, 1e8]),
            ("valve.natural_frequency", [879.0, 1099.0, 1319.0]),
            ("valve.damping_ratio", [0.7, 0.9, 1.1]),
            ("fluid.bulk_modulus", [1e9, 1.45e9, 1.6e9]),
            ("line.length", [0.5, 1.5, 3.0]),
            ("line.bore", [0.01, 0.0127, 0.0159]),
            ("line.dynamic_stiffening.nominal", [4.0, 5.0, 5.0]),
        ],
    );
    let loaded_rig = HOSE.replace(
        "[sizing]",
        "[load]\nmodel = \"spring_mass_damper\"\nmass = 100\nstiffness = 2e5\ndamping = 500\n\n[sizing]",
    );
    follows_the_rig(
        &loaded_rig.replace("moving_mass = ", "internal_leakage = 1e-12\nmoving_mass = "),
        &[
            ("load.mass", [50.0, 100.0, 200.0]),
            ("load.stiffness", [1e5, 2e5, 1e7]),
            ("load.damping", [0.0, 500.0, 1e4]),
            ("cylinder.moving_mass", [10.0, 13.1, 20.0]),
        ],
    );
    let asymmetric = include_str!("../../project/tests/valid/asymmetric.toml");
    let free = asymmetric.replace("hydraulic_stiffness =", "# ").replace("flow_gain = \"3.4", "# \"");
    let free = free.replace("model = \"transmission_line\"\n", "");
    follows_the_rig(
        &free,
        &[
            ("fluid.entrained_air", [0.0, 0.005, 0.02]),
            ("fluid.polytropic_exponent", [1.0, 1.0, 1.4]),
            ("line.a.length", [0.5, 1.2, 1.5]),
            ("line.b.length", [0.3, 0.4, 0.5]),
            ("line.b.pipe.bore", [0.008, 0.01, 0.012]),
            ("line.b.pipe.wall_thickness", [0.001, 0.002, 0.003]),
            ("line.b.pipe.youngs_modulus", [7e10, 2.06e11, 2.1e11]),
            ("line.a.dynamic_stiffening", [1.0, 4.5, 5.0]),
        ],
    );
    let volumes = include_str!("../../project/tests/valid/volumes.toml");
    let free = volumes.replace("piston_area = \"15.83 cm2\"\n", "");
    follows_the_rig(
        &free,
        &[
            ("cylinder.piston_area", [1e-3, 1.583e-3, 2e-3]),
            ("cylinder.dead_volume", [0.0, 0.0, 1e-4]),
            ("line.volume", [1e-4, 1.9e-4, 2e-4]),
            ("line.effective_bulk_modulus", [2e8, 2.6e8, 3e8]),
        ],
    );
}

/// A supply that yields changes its own pressure, those of the chambers, and their effect on the
/// force: each plant of the box is that of the rig with these numbers.
#[test]
fn a_supply_that_yields_is_recorded() {
    let pump = HOSE.replace("model = \"constant\"", "model = \"pump_limited\"");
    let with = |more: &str| pump.replacen("[valve]", &format!("{more}\n[valve]"), 1);
    let pressed = "[operating_point]\nload_force = \"4 kN\"\n";
    let gas = "[supply.accumulator]\ngas_volume = \"1 L\"\nprecharge_pressure = \"40 bar\"\n";
    // ORIGIN: written by hand, around those of examples/ybitu/hose.toml
    let numbers = [
        ("supply.flow", [1e-4, 1.6e-4, 3e-4]),
        ("supply.relief_override", [1e5, 5e5, 1e6]),
        ("supply.volume", [2e-4, 1e-3, 5e-3]),
        ("supply.pressure", [65e5, 70e5, 80e5]),
        ("supply.effective_bulk_modulus", [5e8, 1e9, 1.4e9]),
        ("valve.tare_flow", [5e-6, 7.55e-6, 9e-6]),
    ];
    let modulus = "effective_bulk_modulus = \"1e9 Pa\"\n";
    follows_the_rig_within(1e-8, &with(&[modulus, pressed].concat()), &numbers);
    let [flow, _, _, pressure, ..] = numbers;
    let of_gas = [
        flow,
        pressure,
        ("supply.accumulator.gas_volume", [5e-4, 1e-3, 2e-3]),
        ("supply.accumulator.precharge_pressure", [30e5, 40e5, 50e5]),
        ("supply.accumulator.polytropic_exponent", [1.0, 1.2, 1.4]),
    ];
    follows_the_rig_within(1e-8, &with(&[gas, pressed].concat()), &of_gas);
    // numbers that move no pressure leave those of the declared rig unchanged
    follows_the_rig(
        &pump,
        &[("supply.volume", [2e-4, 1e-3, 5e-3]), ("cylinder.moving_mass", [10.0, 13.1, 20.0])],
    );
}

// ORIGIN: written by hand, the numbers are those of examples/ybitu/hose.toml
/// A number that does not enter the plant is rejected with the reason.
#[test]
fn a_number_that_does_not_enter_the_plant_is_refused() {
    let refused = |text: &str, path: &str, value: f64| {
        let text = with_uncertain(text, &[(path, [0.9 * value, value, 1.1 * value])]);
        recorded(&loaded(&text)).unwrap_err().to_string()
    };
    let idle = "[uncertainty] `fluid.density`: it does not enter the linear model";
    assert_eq!(refused(HOSE, "fluid.density", 870.0), idle);
    let stated = HOSE.replace("[sizing]", "[linear]\nvalve_natural_frequency = 1000\n\n[sizing]");
    assert_eq!(
        refused(&stated, "valve.natural_frequency", 1099.0),
        "[uncertainty] `valve.natural_frequency`: what the project states goes before what would follow from it"
    );
}

/// Fields of the linear model correspond to keys one to one.
#[test]
fn every_parameter_of_the_project_has_its_field() {
    let mut project = loaded(HOSE);
    let numbered = |(number, name): (u32, &'static str)| Uncertain {
        name: name.to_string(),
        nominal: f64::from(number),
        ..Uncertain::default()
    };
    let names = LINEAR_PARAMETERS.iter().map(|parameter| parameter.key.name);
    project.uncertainty = (1..).zip(names).map(numbered).collect();
    let LinearParameters {
        useful_area,
        moving_mass,
        viscous_friction,
        flow_gain,
        flow_pressure_coefficient,
        hydraulic_stiffness,
        sensor_stiffness,
        valve_natural_frequency,
        valve_damping_ratio,
    } = Setup::rig_of(&project).unwrap().linear;
    let mut found = [
        useful_area,
        moving_mass,
        viscous_friction,
        flow_gain,
        flow_pressure_coefficient,
        hydraulic_stiffness,
        sensor_stiffness,
        valve_natural_frequency,
        valve_damping_ratio,
    ];
    found.sort_by(f64::total_cmp);
    assert_eq!(found, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
}

/// Areas, volumes and pressures of a telescopic piston follow its position through a transition,
/// and an uncertain first stage leaves the areas of the others as stated.
#[test]
fn stages_are_those_of_the_position() {
    follows_the_rig_within(
        1e-8,
        concat!(include_str!("../../project/tests/valid/telescopic.toml"), "\n[uncertainty]\n"),
        // ORIGIN: written by hand, around those of the file
        &[
            ("cylinder.piston_diameter", [0.049, 0.05, 0.051]),
            ("cylinder.stroke", [0.45, 0.5, 0.55]),
            ("cylinder.stage_transition", [0.01, 0.02, 0.03]),
            ("cylinder.stage[0].from", [0.19, 0.2, 0.21]),
            ("cylinder.stage[0].piston_area", [1.1e-3, 1.2e-3, 1.3e-3]),
            ("operating_point.position", [0.15, 0.195, 0.4]),
        ],
    );
}

/// The oil of a transmission: pistons, hose or pipe, and the fluid in it.
#[test]
fn a_transmission_is_that_of_its_numbers() {
    follows_the_rig(
        include_str!("../../project/tests/valid/transmission.toml"),
        // ORIGIN: written by hand, around those of the file
        &[
            ("series.piston_area", [1.9e-3, 2e-3, 2.1e-3]),
            ("series.end_volume", [1e-5, 2e-5, 3e-5]),
            ("series.filling_pressure", [50e5, 60e5, 70e5]),
            ("series.line.bore", [0.012, 0.0127, 0.0135]),
            ("series.line.length", [1.9, 2.0, 2.1]),
            ("series.line.volumetric_expansion", [1.5e-5, 1.56e-5, 1.6e-5]),
            ("series.line.dynamic_stiffening", [4.2, 5.0, 5.0]),
            ("fluid.kinematic_viscosity", [2e-5, 4.6e-5, 9e-5]),
            ("fluid.density", [850.0, 870.0, 890.0]),
        ],
    );
    follows_the_rig(
        &format!("{}\n[uncertainty]\n", include_str!("../../project/tests/valid/transmission_pipe.toml")),
        // ORIGIN: written by hand, around those of the file
        &[
            ("series.line.pipe.bore", [0.010, 0.0105, 0.011]),
            ("series.line.pipe.wall_thickness", [2.6e-3, 2.75e-3, 2.9e-3]),
            ("series.line.pipe.youngs_modulus", [1.9e11, 2.06e11, 2.1e11]),
            ("fluid.bulk_modulus", [1.4e9, 1.45e9, 1.5e9]),
        ],
    );
}
