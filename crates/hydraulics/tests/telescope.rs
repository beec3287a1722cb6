//! A telescopic piston: its areas and volumes, machine and stiffness compared with closed forms,
//! the single stage, and its ledgers.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::random::{stream, uniform};
use phea_dynamics::scalar::{Dual, Interval, Parameters};
use phea_dynamics::simulation::{DIRECTIONS, Plant};
use phea_hydraulics::accumulator::Accumulator;
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::cylinder::{Cylinder, chamber_volumes};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{MachineOptions, StartValues};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::cylinder;
use phea_hydraulics::servovalve::Supply;
use phea_hydraulics::stiffness::hydraulic_stiffness;
use phea_hydraulics::stroke::{ActuatorStroke, PistonStage, Telescope};

use super::machine_conservation::{Motion, check, machine_of};
use super::rich_machines::{asymmetric, pump};

fn stage(from: f64, ratios: [f64; 2]) -> Option<PistonStage> {
    Some(PistonStage { from, ratios })
}

/// Three stages over half a metre.
fn three(transition: f64) -> Telescope {
    Telescope { stroke: 0.5, stages: [stage(0.2, [0.7, 0.9]), stage(0.35, [0.4, 1.2]), None], transition }
}

fn with(telescope: Telescope, rig: Components) -> Components {
    Components { cylinder: Cylinder { stroke: ActuatorStroke::Telescopic(telescope), ..rig.cylinder }, ..rig }
}

/// Derivatives dV_A/dx = A_A and dV_B/dx = -A_B at every position, within transitions too; likewise
/// the slopes of the areas.
#[test]
fn areas_are_the_slopes_of_the_volumes() {
    let cylinder = with(three(0.05), asymmetric()).cylinder;
    let mut state = stream(71, 1);
    for _ in 0..400 {
        let x = 0.5 * uniform(&mut state);
        let [volume_a, volume_b] = chamber_volumes(&cylinder, Dual::<DIRECTIONS>::variable(x, 0));
        let [area_a, area_b] = cylinder.areas_at(x);
        assert!(
            (volume_a.gradient()[0] - area_a).abs() < 1e-14
                && (volume_b.gradient()[0] + area_b).abs() < 1e-14
        );
        let along = three(0.05).convert(&mut Dual::<DIRECTIONS>::constant).ratios(Dual::variable(x, 0));
        let slopes = three(0.05).slopes(x);
        for side in [0, 1] {
            assert!((along[side].gradient()[0] - slopes[side]).abs() < 1e-11, "{x}");
        }
    }
}

/// The enclosure of an interval of positions contains every position of it.
#[test]
fn intervals_enclose_it() {
    let telescope = three(0.05);
    let over = telescope.convert(&mut Interval::from);
    let mut state = stream(72, 1);
    for _ in 0..200 {
        let (from, width) = (0.4 * uniform(&mut state), 0.1 * uniform(&mut state));
        let x = from + width * uniform(&mut state);
        let interval = Interval::new(from, from + width);
        let enclosed = [over.ratios(interval), over.travels(interval), over.slopes(interval)].concat();
        let own = [telescope.ratios(x), telescope.travels(x), telescope.slopes(x)].concat();
        assert!(
            enclosed
                .iter()
                .zip(&own)
                .all(|(enclosed, own)| enclosed.low() <= *own && *own <= enclosed.high()),
            "{x}"
        );
    }
}

/// A stage of equal areas leaves a machine unchanged to the bit.
#[test]
fn a_stage_of_equal_areas_has_no_effect() {
    let same = Telescope { stroke: 0.5, stages: [stage(0.2, [1.0; 2]), None, None], transition: 0.05 };
    let options = MachineOptions::default();
    let [plain, stages] = [asymmetric(), with(same, asymmetric())].map(|rig| machine_of(rig, &options));
    for place in 0..50 {
        let x = 0.01 * f64::from(place);
        let state = [0.7, 20.0, 41e5, 22e5, 3e-4, 0.08, 2e-6];
        let mut rates = [[0.0; 7]; 2];
        plain.rates(&state, 0.3, &[x, 0.05], &mut rates[0]);
        stages.rates(&state, 0.3, &[x, 0.05], &mut rates[1]);
        assert_eq!(rates[0], rates[1], "{x}");
    }
}

/// K_H away from transitions is that of the areas and the volumes swept by the stages there.
#[test]
fn stiffness_is_that_of_each_stage() {
    let rig = with(three(1e-6), asymmetric());
    let actuator = Actuator::new(rig).unwrap();
    let chambers = actuator.chamber_compliance([0.0; 2], StiffeningMember::Nominal);
    let plain = Actuator::new(asymmetric()).unwrap();
    let plain = plain.chamber_compliance([0.0; 2], StiffeningMember::Nominal);
    let Cylinder { area_a, area_b, .. } = rig.cylinder;
    // ORIGIN: analytic, areas and the ways swept by hand: 0.2 m, 0.15 m and 0.15 m of the three
    // stages
    let by_hand = [
        (0.1, [1.0, 1.0], [0.1, 0.1 + 0.15 * 0.9 + 0.15 * 1.2]),
        (0.3, [0.7, 0.9], [0.2 + 0.1 * 0.7, 0.05 * 0.9 + 0.15 * 1.2]),
        (0.45, [0.4, 1.2], [0.2 + 0.15 * 0.7 + 0.1 * 0.4, 0.05 * 1.2]),
    ];
    for (x, ratios, [from_a, to_b]) in by_hand {
        let compliances =
            [plain.constant_a + plain.slope_a * from_a, plain.constant_b + plain.slope_b * to_b];
        let areas = [area_a * ratios[0], area_b * ratios[1]];
        let expected: f64 =
            areas.iter().zip(&compliances).map(|(area, compliance)| area * area / compliance).sum();
        assert!((hydraulic_stiffness(&chambers, x) / expected - 1.0).abs() < 1e-12, "{x}");
    }
}

/// The range over the stroke agrees with a fine grid, and its positions are those at which it is
/// reached.
#[test]
fn the_range_over_the_stroke_is_reached() {
    let actuator = Actuator::new(with(three(0.02), asymmetric())).unwrap();
    let chambers = actuator.chamber_compliance([0.0; 2], StiffeningMember::Nominal);
    let range = chambers.over_stroke();
    assert_eq!(hydraulic_stiffness(&chambers, range.minimum_position), range.minimum);
    assert_eq!(hydraulic_stiffness(&chambers, range.maximum_position), range.maximum);
    for place in 0..=7919 {
        let here = hydraulic_stiffness(&chambers, 0.5 * f64::from(place) / 7919.0);
        assert!(here > range.minimum * (1.0 - 1e-5) && here < range.maximum * (1.0 + 1e-5));
    }
}

/// A force is held with the areas of the stage at the piston position, and the machine rests there.
#[test]
fn a_force_is_held_by_the_stage_that_moves() {
    let rig = with(three(0.02), asymmetric());
    let actuator = Actuator::new(rig).unwrap();
    let machine = machine_of(rig, &MachineOptions::default());
    for x in [0.1, 0.3, 0.35, 0.45] {
        let point = operating_point(&actuator, x, Condition::Load(SteadyLoad::Force(2e3))).unwrap();
        let [area_a, area_b] = rig.cylinder.areas_at(x);
        assert!((area_a * point.pressure_a - area_b * point.pressure_b - 2e3).abs() < 1e-6, "{x}");
        let rest = machine.rest_under_load(&point).unwrap();
        assert!((rest.state[4] * rig.force_sensor.stiffness - 2e3).abs() < 1e-3, "{x}");
    }
}

/// Greatest forces are those of the greatest stage.
#[test]
fn the_greatest_stage_stalls_last() {
    let of_stages = Telescope { stroke: 0.5, stages: [stage(0.2, [1.5, 0.5]), None, None], transition: 0.02 };
    let cylinder = Cylinder { stroke: ActuatorStroke::Telescopic(of_stages), ..cylinder() };
    let Cylinder { area_a, area_b, .. } = cylinder;
    let supply = Supply { pressure: 70e5, tank_pressure: 1e5 };
    let expected = [area_a * 1e5 - area_b * 70e5, 1.5 * area_a * 70e5 - 0.5 * area_b * 1e5];
    assert_eq!(cylinder.stall_forces(&supply), expected);
    assert_eq!(cylinder.greatest_areas(), [1.5 * area_a, area_b]);
}

/// Ledgers of oil and energy close while the piston passes both transitions.
#[test]
fn ledgers_close_through_the_stages() {
    let motion = Motion { amplitude: 1.5, bias: 0.2, ground: 0.0, ground_amplitude: 2e-3 };
    let start = StartValues { position: 0.199, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let close = [stage(0.2, [0.7, 0.9]), stage(0.202, [0.4, 1.2]), None];
    let telescope = Telescope { stages: close, ..three(1.5e-3) };
    let loads = [
        Load::Prescribed,
        Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 },
        Load::Wall { mass: Some(20.0), damping: 200.0, stiffness: 3e7, gap: 1e-4, relative_damping: 0.4 },
    ];
    for load in loads {
        let external_force = load.moves();
        let options = MachineOptions { external_force, ..MachineOptions::default() };
        let rig = Components { power_unit: pump(), load, ..with(telescope, asymmetric()) };
        check(&machine_of(rig, &options), &motion, &start, 0.2, 1e-5);
    }
    let air = Some(EntrainedAir { volume_fraction: 5e-3, polytropic_exponent: 1.2 });
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 15e5, polytropic_exponent: 1.2 };
    let rig = with(telescope, asymmetric());
    let rig =
        Components { fluid: Fluid { entrained_air: air, ..rig.fluid }, gas: [Some(gas.into()), None], ..rig };
    check(&machine_of(rig, &MachineOptions::default()), &motion, &start, 0.2, 1e-5);
}

/// Stages that do not follow each other within the stroke, and impossible areas.
#[test]
fn impossible_stages_are_refused() {
    let refused = |telescope: Telescope, path: &str| {
        let ActuatorError { problems } = Actuator::new(with(telescope, asymmetric())).unwrap_err();
        assert!(problems.iter().any(|problem| problem.quantity == path), "{problems:?}");
    };
    refused(three(0.2), "cylinder.stage.from");
    refused(three(0.0), "cylinder.transition");
    refused(Telescope { stroke: 0.355, ..three(0.02) }, "cylinder.stage.from");
    let empty = Telescope { stages: [stage(0.2, [0.0, 1.0]), None, None], ..three(0.02) };
    refused(empty, "cylinder.stage.piston_areas");
}
