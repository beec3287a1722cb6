//! A linkage between rod and load: geometry, machine and plant by closed forms and a Lagrangian.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::portable::{cos, pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::scalar::{Interval, Parameters};
use phea_dynamics::simulation::{Plant, small_signal};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::{Line, StiffeningMember};
use phea_hydraulics::linkage::{
    FourBar, Linkage, LinkageError, LinkageGeometry, LinkageTable, PivotTriangle, RodEnd, STANDARD_GRAVITY,
};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{InitialCondition, Machine, MachineOptions, StartValues};
use phea_hydraulics::operating_point::{Condition, operating_point};
use phea_hydraulics::plant::{LinearLoad, LinearPlant, LinearSeries, PlantInMotion};
use phea_hydraulics::reference_rig::{components, cylinder, hose_line, nominal_plant, pipe_line};
use phea_hydraulics::series::{ForceFrom, SeriesElement, SeriesSpring, SeriesTravel, Transmission};
use phea_hydraulics::servovalve::SpoolDirection;
use phea_hydraulics::signal::Signal;
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::ActuatorStroke;
use phea_hydraulics::two_pressure::{TwoPressureModel, two_pressure_linear_parameters};

use super::commanded::Commanded;
use super::machine_conservation::{Motion, check, machine_of, step};
use super::plant::point_at;
use super::rich_machines::{asymmetric, pump};

pub(super) const STROKE: f64 = 0.08;
/// Zero of the joint's angle, rad.
pub(super) const OFFSET: f64 = 0.4;

/// Knee of comparisons/recompute_linkage.py.
pub(super) fn knee() -> PivotTriangle {
    PivotTriangle { cylinder_pivot: 0.30, rod_pivot: 0.05, retracted_length: 0.26 }
}

fn four_bar(crossed: bool) -> FourBar {
    FourBar {
        triangle: knee(),
        input_angle: 0.2,
        fixed_link: 0.20,
        input_link: 0.06,
        coupler: 0.19,
        output_link: 0.08,
        crossed,
    }
}

fn reduced(geometry: LinkageGeometry) -> Linkage {
    geometry.reduced(STROKE, OFFSET).unwrap().linkage
}

/// Rows of the knee, measured to a micrometre or exact.
fn table(rows: usize, roughness: f64, tolerance: f64) -> LinkageGeometry {
    let linkage = reduced(LinkageGeometry::Triangle(knee()));
    let extensions: Vec<f64> = (0..rows).map(|row| STROKE * row as f64 / (rows - 1) as f64).collect();
    let angles: Vec<f64> = extensions.iter().map(|extension| linkage.angle(*extension)).collect();
    let mut state = stream(5, rows as u64);
    let mut measured = extensions;
    for extension in measured.iter_mut().skip(1).rev().skip(1) {
        *extension += roughness * (2.0 * uniform(&mut state) - 1.0);
    }
    LinkageGeometry::Table(LinkageTable { extensions: measured, angles, tolerance })
}

/// Linkages of all kinds.
pub(super) fn linkages() -> [Linkage; 4] {
    let table = table(30, 0.0, 1e-6).reduced(STROKE, 0.0).unwrap().linkage;
    let [open, crossed] = [false, true].map(|crossed| reduced(LinkageGeometry::FourBar(four_bar(crossed))));
    [reduced(LinkageGeometry::Triangle(knee())), open, crossed, table]
}

/// Extension, lever arm, its slope and the inverse of the triangle in closed form.
#[test]
fn a_triangle_is_the_law_of_cosines() {
    let linkage = reduced(LinkageGeometry::Triangle(knee()));
    let PivotTriangle { cylinder_pivot: a, rod_pivot: b, retracted_length } = knee();
    for place in 0..=200 {
        let x = STROKE * f64::from(place) / 200.0;
        let length = retracted_length + x;
        let angle = linkage.angle(x);
        let opening = angle + OFFSET;
        assert!((length * length - (a * a + b * b - 2.0 * a * b * cos(opening))).abs() < 1e-12, "{x}");
        let end = linkage.end(angle);
        assert!((end.position - x).abs() < 1e-12 * STROKE.max(1.0), "{x}: {end:?}");
        // l dl/dphi = a b sin(phi), and its derivative
        let arm = a * b * sin(opening) / length;
        let slope = (a * b * cos(opening) - arm * arm) / length;
        assert!((end.lever_arm / arm - 1.0).abs() < 1e-9, "{x}: {} {arm}", end.lever_arm);
        assert!((end.lever_slope - slope).abs() < 1e-7 * a, "{x}: {} {slope}", end.lever_slope);
    }
}

/// Closure of a four-bar on both branches, with the joint's angle counted in its growing direction.
#[test]
fn a_four_bar_closes() {
    // ORIGIN: recomputed by comparisons/recompute_linkage.py
    let open = [(0.0, 1.193_122_678_410), (0.04, 1.796_072_303_383), (0.08, 2.496_345_463_151)];
    let crossed = [(0.0, 4.561_749_849_302), (0.04, 3.926_441_197_654), (0.08, 3.563_629_475_758)];
    for (is_crossed, sense, rows) in [(false, 1.0, open), (true, -1.0, crossed)] {
        let linkage = reduced(LinkageGeometry::FourBar(four_bar(is_crossed)));
        let at = |x: f64| sense * (linkage.angle(x) + OFFSET);
        for (x, expected) in rows {
            let turns = (at(x) - expected) / std::f64::consts::TAU;
            // crossed, the lever arm grows fourfold towards a dead point: the fit is less accurate
            let tolerance = if is_crossed { 1e-7 } else { 1e-10 };
            assert!((turns - turns.round()).abs() < tolerance, "{is_crossed} {x}: {} {expected}", at(x));
        }
        assert!(linkage.angle(STROKE) > linkage.angle(0.0));
    }
}

/// Linkages that no polynomial can represent are rejected, with the position.
#[test]
fn impossible_linkages_are_refused() {
    let of = |geometry: LinkageGeometry| geometry.reduced(STROKE, 0.0).unwrap_err();
    let triangle = |retracted_length| LinkageGeometry::Triangle(PivotTriangle { retracted_length, ..knee() });
    let long = of(triangle(0.30));
    let LinkageError::NoTriangle { position, length, possible } = long else { panic!("{long:?}") };
    assert!((0.0499..0.051).contains(&position) && length >= 0.35 && possible == [0.25, 0.35], "{long:?}");
    let short = of(triangle(0.24));
    assert!(matches!(short, LinkageError::NoTriangle { position, .. } if position < 0.0), "{short:?}");
    // within a hundredth of the stroke of its dead point
    let near = of(triangle(0.2692));
    assert!(matches!(near, LinkageError::NoTriangle { .. } | LinkageError::DeadPoint { .. }), "{near:?}");
    let apart = of(LinkageGeometry::FourBar(FourBar { coupler: 0.02, ..four_bar(false) }));
    assert!(matches!(apart, LinkageError::NoFourBar { position } if position < 0.0), "{apart:?}");
    let rows = |extensions: &[f64], angles: &[f64]| {
        let (extensions, angles) = (extensions.to_vec(), angles.to_vec());
        of(LinkageGeometry::Table(LinkageTable { extensions, angles, tolerance: 1e-4 }))
    };
    assert_eq!(rows(&[0.0], &[0.0]), LinkageError::TableShort { from: 0.0, to: 0.0 });
    assert_eq!(rows(&[0.0, 0.04, 0.08], &[0.0, 0.5, 0.4]), LinkageError::TableOrder { row: 3 });
    assert_eq!(rows(&[0.0, 0.07], &[0.0, 0.5]), LinkageError::TableShort { from: 0.0, to: 0.07 });
    let rough = of(table(20, 2e-3, 1e-4));
    assert!(matches!(rough, LinkageError::TableRough { residual, .. } if residual > 1e-4), "{rough:?}");
    // an input link in line with the coupler: the output link turns back
    let back = of(LinkageGeometry::FourBar(FourBar { input_angle: 1.5, ..four_bar(false) }));
    assert!(matches!(back, LinkageError::DeadPoint { .. } | LinkageError::NoFourBar { .. }), "{back:?}");
}

/// A table of the knee equals the knee up to its residual; a rough one is within its tolerance.
#[test]
fn a_table_is_what_was_measured() {
    let exact = reduced(LinkageGeometry::Triangle(knee()));
    let smooth = table(30, 0.0, 1e-6).reduced(STROKE, 0.0).unwrap();
    assert!(smooth.residual > 0.0 && smooth.residual <= 1e-6);
    let rough = table(30, 1e-5, 3e-5).reduced(STROKE, 0.0).unwrap();
    assert!(rough.residual > 1e-6 && rough.residual <= 3e-5, "{}", rough.residual);
    for place in 0..=100 {
        let x = STROKE * f64::from(place) / 100.0;
        assert!((smooth.linkage.angle(x) - exact.angle(x)).abs() < 5e-5, "{x}");
        assert!((rough.linkage.angle(x) - exact.angle(x)).abs() < 3e-3, "{x}");
    }
}

/// Intervals of the angle enclose the values in them.
#[test]
fn intervals_enclose_it() {
    for (kind, linkage) in linkages().into_iter().enumerate() {
        let wide = linkage.convert(&mut Interval::from);
        for place in 1..20 {
            let x = STROKE * f64::from(place) / 20.0;
            let found = wide.angle(Interval::new(x - 1e-9, x + 1e-9));
            let angle = linkage.angle(x);
            assert!(found.low() <= angle && angle <= found.high(), "{x}");
            // the angle moves by a twelfth of this, for a knee with a lever arm of 20 to 50 mm
            assert!(kind > 0 || found.high() - found.low() < 1e-6, "{x}");
        }
    }
}

/// A rig with constant chamber pressures: valve and lines behave like infinite volumes.
fn open_ended() -> Components {
    let line = Line::Volume { volume: 1e8, effective_bulk_modulus: 1e9 };
    let rig = components(line, StiffnessModel::ByVolume);
    Components {
        cylinder: Cylinder {
            area_a: 3e-4,
            area_b: 2e-4,
            stroke: ActuatorStroke::Limited(STROKE),
            moving_mass: 0.6,
            ..cylinder()
        },
        friction: Friction::Viscous { viscous: 50.0 },
        force_sensor: ForceSensor { stiffness: 1e6 },
        linkage: Some(reduced(LinkageGeometry::Triangle(knee()))),
        ..rig
    }
}

/// The motion of a knee agrees with a Lagrangian in the coordinates of the rod, which has no lever
/// arm.
#[test]
fn a_knee_swings_by_its_lagrangian() {
    // ORIGIN: recomputed by comparisons/recompute_linkage.py
    let plain = [
        [1.290_061_660_6, 8.408_904_790_4, 0.050_539_821_926],
        [1.624_632_057_3, -2.916_095_963_7, 0.065_651_126_943],
        [1.114_675_778_1, -4.051_975_602_2, 0.041_966_993_124],
    ];
    swings(open_ended(), plain);
    // ORIGIN: recomputed by comparisons/recompute_linkage.py
    let heavy = [
        [1.093_085_895_9, 5.761_060_522_7, 0.040_878_876_723],
        [1.365_203_109_4, -1.222_616_777_5, 0.054_126_149_024],
        [1.041_836_570_2, -3.312_700_022_6, 0.038_335_202_248],
    ];
    let weighed = |linkage: Linkage| linkage.level_at(0.9).with_moment(3.0 * 0.4 * STANDARD_GRAVITY);
    swings(Components { linkage: open_ended().linkage.map(weighed), ..open_ended() }, heavy);
}

fn swings(rig: Components, expected: [[f64; 3]; 3]) {
    let load = Load::SpringMassDamper { mass: 0.2, stiffness: 60.0, damping: 0.8 };
    let machine = machine_of(Components { load, ..rig }, &MachineOptions::default());
    let start = StartValues { position: 0.02, pressure_a: 30e5, pressure_b: 15e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    let mut state = beginning.state.clone();
    // the spring is relaxed at 0.8 rad
    let relaxed = 0.8;
    state[6] += beginning.inputs[0] - relaxed;
    let signal =
        |signal: Signal, state: &[f64]| machine.signals::<f64>(state, &[relaxed, 0.0]).get(signal).unwrap();
    assert!((signal(Signal::Position, &state) - 0.02).abs() < 1e-12);
    let width = 2e-5;
    let mut rates = |_: f64, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        machine.rates(state, 0.0, &[relaxed, 0.0], &mut rates);
        rates
    };
    for expected in expected {
        for index in 0..5000 {
            step(&mut state, f64::from(index) * width, width, &mut rates);
        }
        let names = [Signal::JointAngle, Signal::JointVelocity, Signal::Position];
        for (name, expected) in names.into_iter().zip(expected) {
            let found = signal(name, &state);
            assert!(
                (found - expected).abs() < 2e-8 * expected.abs().max(1.0),
                "{name:?}: {found} {expected}"
            );
        }
    }
}

/// A constant lever arm in m, and the linkage that has it.
const ARM: f64 = 0.05;

fn straight() -> Linkage {
    let table = LinkageTable { extensions: vec![0.0, 0.5], angles: vec![-5.0, 5.0], tolerance: 1e-9 };
    LinkageGeometry::Table(table).reduced(0.5, 0.0).unwrap().linkage
}

/// Loads in linear quantities, and equivalent loads on that lever.
fn pairs() -> [[Load; 2]; 3] {
    let square = ARM * ARM;
    let sprung =
        |by: f64| Load::SpringMassDamper { mass: 20.0 * by, stiffness: 3e5 * by, damping: 200.0 * by };
    let walled = |by: f64, arm: f64| Load::Wall {
        mass: Some(20.0 * by),
        damping: 200.0 * by,
        stiffness: 3e7 * by,
        gap: 4e-4 / arm,
        relative_damping: 0.4 * arm,
    };
    [[Load::Prescribed; 2], [sprung(1.0), sprung(square)], [walled(1.0, 1.0), walled(square, ARM)]]
}

/// A constant lever arm: the rig with the load in linear quantities, by all its rates.
#[test]
fn a_constant_lever_is_a_load_in_other_units() {
    let angle = |x: f64| x / ARM - 5.0;
    for [plain, turning] in pairs() {
        let external_force = plain.moves();
        let of = |load, linkage| {
            let options = MachineOptions { external_force, ..MachineOptions::default() };
            machine_of(Components { linkage, load, ..asymmetric() }, &options)
        };
        let (one, other) = (of(plain, None), of(turning, Some(straight())));
        for place in 0..40 {
            let ground = 0.1 + 0.3 * f64::from(place) / 40.0;
            let mut state = vec![0.7, 20.0, 41e5, 22e5, 3e-4, 0.08, 2e-6];
            let mut turned = state.clone();
            let (relative, velocity) = (1e-3 * sin(f64::from(place)), 0.1 * cos(f64::from(place)));
            if plain.moves() {
                state.extend([relative, velocity]);
                turned.extend([relative / ARM, velocity / ARM]);
            }
            let mut rates = [vec![0.0; state.len()], vec![0.0; state.len()]];
            one.rates(&state, 0.3, &[ground, 0.05, 120.0], &mut rates[0]);
            other.rates(&turned, 0.3, &[angle(ground), 0.05 / ARM, 120.0 * ARM], &mut rates[1]);
            for (index, (plain, turned)) in rates[0].iter().zip(&rates[1]).enumerate() {
                let turned = turned * if index > 6 { ARM } else { 1.0 };
                assert!((plain - turned).abs() <= 1e-9 * plain.abs().max(1e-3), "{index}: {plain} {turned}");
            }
        }
    }
}

/// Equivalence by its plant.
#[test]
fn a_constant_lever_has_the_plant_of_a_load_in_other_units() {
    let (mass, stiffness, damping, square) = (20.0, 3e5, 200.0, ARM * ARM);
    let yielding = LinearLoad::Yielding { mass, damping, stiffness };
    let end = straight().end(0.3);
    let linked = LinearLoad::Linked {
        inertia: mass * square,
        damping: damping * square,
        stiffness: stiffness * square,
        geometric_stiffness: -3e3 * end.lever_slope,
        lever_arm: end.lever_arm,
    };
    let plant = |load| LinearPlant::of_load_pressure(&nominal_plant(), 0.0, load);
    for step in 0..30 {
        let w = 1e-2 * pow(1e6, f64::from(step) / 29.0);
        let [plain, turned] =
            [yielding, linked].map(|load| plant(load).coefficients().command.at_frequency(w));
        assert!((turned / plain - 1.0).norm_sqr().sqrt() < 1e-9);
    }
}

/// Rig for every number, at rest, with every kind of linkage and load, pushed and pulled.
struct Drawn {
    machine: Machine,
    rest: InitialCondition,
    sensor: f64,
    /// Load's end of the rod there.
    end: RodEnd,
    plant: LinearPlant,
}

fn drawn(number: u64) -> Drawn {
    let mut state = stream(61, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let linkage = linkages()[number as usize % 4];
    let friction = spread(20.0, 5e3);
    let cylinder = Cylinder {
        area_a: spread(2e-4, 1e-3),
        area_b: spread(2e-4, 1e-3),
        stroke: ActuatorStroke::Limited(STROKE),
        moving_mass: spread(0.3, 10.0),
        ..cylinder()
    };
    let sensor = spread(1e6, 1e8);
    let rig = Components {
        cylinder,
        friction: Friction::Viscous { viscous: friction },
        force_sensor: ForceSensor { stiffness: sensor },
        linkage: Some(linkage),
        series: series(number, &mut spread),
        ..components(hose_line(), StiffnessModel::ByVolume)
    };
    // every second one with a weight that is level somewhere in the stroke
    let weighed = linkage.level_at(spread(0.1, 6.0)).with_moment(spread(0.1, 30.0));
    let linkage = if number % 2 == 1 { weighed } else { linkage };
    let rig = Components { linkage: Some(linkage), ..rig };
    let (mass, stiffness, damping) = (spread(0.05, 5.0), spread(1e2, 1e5), spread(0.1, 30.0));
    let relative_damping = spread(0.01, 1.0);
    let load = load(number, [mass, stiffness, damping], relative_damping);
    let actuator = Actuator::new(Components { load, ..rig }).unwrap();
    let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
    let position = spread(0.005, 0.075);
    // to either side, but a wall cannot pull
    let sign = if number % 3 == 1 && number.is_multiple_of(2) { -1.0 } else { 1.0 };
    let rests = (1..20).map(|more| {
        let condition = Condition::Command(sign * 0.05 * f64::from(more));
        machine.rest(&operating_point(&actuator, position, condition).unwrap())
    });
    let rest = rests.flatten().next().unwrap();
    let force = sensor * rest.state[4];
    let angle = rest.inputs[0] + if load.moves() { rest.state[6] } else { 0.0 };
    let (end, weight) = (linkage.end(angle), linkage.weight_at(angle));
    let [gravity, falling] = weight.map_or([0.0; 2], |weight| [weight.torque, weight.stiffness]);
    let compressed = machine.signals(&rest.state, &rest.inputs).series_deflection;
    assert!((end.position + rest.state[4] + compressed - position).abs() < 1e-11, "{number}");
    let pressed = if number % 3 == 2 { relative_damping * (force * end.lever_arm + gravity) } else { 0.0 };
    let own = match load {
        Load::Prescribed => LinearLoad::Prescribed,
        _ => LinearLoad::Linked {
            inertia: mass,
            damping: damping + pressed,
            stiffness,
            geometric_stiffness: falling - force * end.lever_slope,
            lever_arm: end.lever_arm,
        },
    };
    let load_velocity_feed_forward = (number % 4 > 1).then_some(0.1 * spread(0.1, 10.0));
    let series = LinearSeries::of_components(&rig, force);
    let plant =
        LinearPlant { series, load_velocity_feed_forward, ..plant_at(&actuator, position, &rest, own) };
    Drawn { machine, rest, sensor, end, plant }
}

fn load(number: u64, [mass, stiffness, damping]: [f64; 3], relative_damping: f64) -> Load {
    match number % 3 {
        0 => Load::Prescribed,
        1 => Load::SpringMassDamper { mass, stiffness, damping },
        _ => Load::Wall { mass: Some(mass), damping, stiffness, gap: 0.02, relative_damping },
    }
}

/// Two out of five numbers have a damped, progressive spring on the rod, one a transmission.
fn series(number: u64, spread: &mut impl FnMut(f64, f64) -> f64) -> Option<SeriesElement> {
    match number % 5 {
        1 | 2 => Some(SeriesElement::Spring(SeriesSpring {
            stiffness: spread(2e5, 2e6),
            damping: Some(spread(50.0, 2e3)),
            mass: (number % 5 == 2).then_some(0.5),
            travel: Some(SeriesTravel { travel: 2e-2, progression: Some(spread(0.1, 1.0)), ends: None }),
            force_from: ForceFrom::Sensor,
        })),
        3 => Some(SeriesElement::Transmission(Transmission {
            piston_area: spread(2e-4, 1e-3),
            line: pipe_line(),
            end_volume: spread(1e-6, 1e-5),
            filling_pressure: 100e5,
            segments: 2,
        })),
        _ => None,
    }
}

/// Plant with this load at the rest of the machine.
fn plant_at(actuator: &Actuator, position: f64, rest: &InitialCondition, load: LinearLoad) -> LinearPlant {
    let pressures = [rest.state[2], rest.state[3]];
    let friction = actuator.components().friction.viscous();
    let model = TwoPressureModel::new(actuator, pressures, StiffeningMember::Nominal, friction);
    let point = point_at(position, &rest.state);
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Extending);
    LinearPlant::of_two_pressures(&parameters, 0.0, load)
}

/// The plant agrees with the machine for small motions, as polynomials and as a response.
#[test]
fn the_plant_is_the_machine_for_small_motions() {
    for number in 0..60_u64 {
        let Drawn { machine, rest, sensor, end, plant } = drawn(number);
        let coefficients = plant.coefficients();
        let fed = plant.load_velocity_feed_forward;
        let moving = PlantInMotion::lumped(&plant).fed_forward(fed);
        let inputs = [&[rest.command], &rest.inputs[..]].concat();
        for step in 0..15 {
            let w = 1e-2 * pow(1e6, f64::from(step) / 14.0);
            let (zero, one) = (Complex64::ZERO, Complex64::ONE);
            // the ground turns by 1/g' for a metre of the rod
            let turned = [zero, one / end.lever_arm, Complex64::new(0.0, w) / end.lever_arm];
            let [command, ground] = [[one, zero, zero], turned].map(|drive| {
                let system = Commanded(machine, fed.unwrap_or(0.0));
                small_signal(&system, &rest.state, &inputs, &drive, w).unwrap()[4] * sensor
            });
            let [alike_command, alike_ground] = moving.response(Complex64::new(0.0, w));
            let disturbance = coefficients.disturbance.as_ref().unwrap();
            let pairs = [
                (coefficients.command.at_frequency(w), command),
                (disturbance.at_frequency(w), ground),
                (alike_command, command),
                (alike_ground, ground),
            ];
            for (found_response, own) in pairs {
                let error = (found_response / own - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-7, "rig {number} at {w} rad/s: {error}");
            }
        }
    }
}

/// Every account of energy closes over an oscillation of the stroke.
#[test]
fn ledgers_close_with_a_linkage() {
    let motion = Motion { amplitude: 0.3, bias: 0.05, ground: 0.0, ground_amplitude: 0.05 };
    let start = StartValues { position: 0.04, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let loads = [
        Load::Prescribed,
        Load::SpringMassDamper { mass: 0.2, stiffness: 4e3, damping: 2.0 },
        Load::Wall { mass: Some(0.2), damping: 2.0, stiffness: 3e5, gap: 0.02, relative_damping: 0.4 },
    ];
    let cases = linkages().into_iter().flat_map(|linkage| loads.map(|load| (linkage, load)));
    for (number, (linkage, load)) in cases.enumerate() {
        let rig = asymmetric();
        let rig = Components {
            cylinder: Cylinder { stroke: ActuatorStroke::Limited(STROKE), ..rig.cylinder },
            linkage: Some(linkage.level_at(1.2).with_moment(15.0)),
            series: series(number as u64, &mut |low, high| (low * high).sqrt()),
            power_unit: pump(),
            load,
            ..rig
        };
        let external_force = load.moves();
        let options = MachineOptions { external_force, ..MachineOptions::default() };
        let [duration, width] = if rig.series.is_some() { [0.06, 2e-6] } else { [0.2, 1e-5] };
        check(&machine_of(rig, &options), &motion, &start, duration, width);
    }
}
