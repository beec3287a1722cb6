//! Rigs with any combination of parts: the linear plant and the machine for small motions.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::controller::InnerFeedback;
use phea_dynamics::portable::pow;
use phea_dynamics::random::{stream, uniform};
use phea_hydraulics::accumulator::{
    Accumulator, AdjustedGas, ChamberGas, GasContent, GasPassage, GasValve, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cross_port::{CrossPort, Restrictor};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::{DynamicLine, END_SHARE, Line, LineModel, Pipe, PipeWall, StiffeningMember};
use phea_hydraulics::linkage::Linkage;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{InitialCondition, Machine, MachineOptions, PowerUnit};
use phea_hydraulics::operating_point::{Condition, operating_point};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::plant::{
    LineChambers, LinearLoad, LinearPlant, LinearSeries, PlantInMotion, PressureFeedback, SeriesOutput,
};
use phea_hydraulics::reference_rig::{components, cylinder, hose, hose_line};
use phea_hydraulics::series::SeriesElement;
use phea_hydraulics::signal::Signal;
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::{ActuatorStroke, PistonStage, Telescope};

use super::commanded::{amplitudes, cross_port, power_unit, signal_of, slopes};
use super::linkage::{STROKE, linkages};
use super::plant::{plant_at_rest, port_valves, telescope};
use super::plant_in_motion::{model, plant_with_lines};
use super::series::element;
use super::transmission::transmission;

const RIGS: u64 = 200;

/// Parts by name, each with the later parts with which no rig combines it.
const PARTS: [(&str, &[&str]); 31] = [
    ("polytropic gas", &[]),
    ("gas with heat", &[]),
    ("neck", &[]),
    ("gas valve", &[]),
    ("shut gas valve", &[]),
    ("gas that is added", &[]),
    ("laminar valve", &["orifice", "laminar feedback", "feedback"]),
    ("orifice", &["laminar feedback", "feedback"]),
    ("laminar feedback", &["feedback"]),
    ("feedback", &[]),
    ("spring", &["transmission", "motor"]),
    ("series damper", &["transmission", "motor"]),
    ("series mass", &["transmission", "motor"]),
    ("progression", &["transmission", "motor"]),
    ("transmission", &["motor"]),
    ("linkage", &["motor"]),
    ("weight", &["motor"]),
    ("unequal areas", &["motor"]),
    ("unequal lines", &[]),
    ("lines in motion", &[]),
    ("telescopic piston", &["motor"]),
    ("motor", &[]),
    ("leakage across the piston", &[]),
    ("leakage to the tank", &[]),
    ("port valves", &[]),
    ("pump", &[]),
    ("air", &[]),
    ("feed-forward", &[]),
    ("pressure feedback", &[]),
    ("prescribed load", &["sprung load"]),
    ("sprung load", &[]),
];

/// Random numbers, and the parts drawn so far.
struct Draw {
    state: u64,
    parts: Vec<&'static str>,
}

impl Draw {
    fn new(seed: u64, number: u64) -> Draw {
        Draw { state: stream(seed, number), parts: Vec::new() }
    }

    fn spread(&mut self, low: f64, high: f64) -> f64 {
        low * pow(high / low, uniform(&mut self.state))
    }

    /// True if the rig has a part that this fraction of the rigs has.
    fn part(&mut self, name: &'static str, likely: f64) -> bool {
        let has = uniform(&mut self.state) < likely;
        self.parts.extend(has.then_some(name));
        has
    }
}

/// Gas at a chamber, with all its options.
fn gas(draw: &mut Draw) -> Option<ChamberGas> {
    if uniform(&mut draw.state) > 0.65 {
        return None;
    }
    let heat = draw.part("gas with heat", 0.4).then(|| draw.spread(1e-3, 1e2));
    draw.parts.extend(heat.is_none().then_some("polytropic gas"));
    let (gas_volume, precharge_pressure) = (draw.spread(1e-6, 1e-4), draw.spread(1e5, 15e5));
    let polytropic_exponent = heat.map_or_else(|| draw.spread(1.0, 1.6), |_| 1.0);
    let at_rest = Accumulator { gas_volume, precharge_pressure, polytropic_exponent };
    let size = [draw.spread(2e-3, 1e-2), draw.spread(1e-2, 0.3)];
    let neck =
        draw.part("neck", 0.35).then(|| Neck::round(size, [870.0, draw.spread(1e-5, 1e-4), 1.45e9], 1.5));
    let shut = neck.is_none() && draw.part("shut gas valve", 0.2);
    let valve = shut || neck.is_none() && draw.part("gas valve", 0.4);
    let (setting, moved) = (draw.spread(1e-2, 1.0), draw.spread(0.1, 0.6));
    let passage = if valve {
        GasPassage::Valve(GasValve {
            setting: if shut { 0.0 } else { setting },
            flow_coefficient: draw.spread(1e-9, 1e-7),
            transition_pressure: draw.spread(1e3, 1e5),
            compliance: draw.spread(1e-16, 1e-13),
            shut,
        })
    } else if heat.is_none() && draw.part("gas that is added", 0.6) {
        let (volume_rise, precharge_rise) = (moved * gas_volume, -0.8 * moved * precharge_pressure);
        let gas =
            AdjustedGas { at_rest, setting, volume_rise, precharge_rise, neck, maximum_pressure_ratio: None };
        return Some(ChamberGas::Adjusted(gas));
    } else {
        neck.map_or(GasPassage::Open, GasPassage::Neck)
    };
    let content = match heat {
        None => GasContent::Polytropic(at_rest),
        Some(time_constant) => {
            GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
        }
    };
    Some(ChamberGas::Sealed(SealedGas { content, passage, maximum_pressure_ratio: None }))
}

/// Motor with unlimited rotation, or a cylinder of this stroke in m, with its friction and its
/// force sensor.
fn actuator(draw: &mut Draw, number: u64, stroke: f64, motor: bool) -> Components {
    let telescopic = !motor && draw.part("telescopic piston", 0.4);
    let unequal = !motor && draw.part("unequal areas", 0.6);
    let external_leakage = draw.part("leakage to the tank", 0.35).then(|| draw.spread(1e-14, 1e-11));
    let internal_leakage = draw.part("leakage across the piston", 0.4).then(|| draw.spread(1e-14, 1e-10));
    let least = if stroke < 0.5 { 0.02 } else { 0.05 };
    let rods = [0.3 * least, if unequal { draw.spread(0.4, 0.7) * least } else { 0.3 * least }];
    let [area_a, area_b] = match motor {
        true => [draw.spread(1e-5, 1e-4); 2],
        false => rods.map(|rod| annulus_area(least, rod)),
    };
    let stages = telescope(number);
    let scale = stroke / stages.stroke;
    let stages = Telescope {
        stroke,
        stages: stages
            .stages
            .map(|stage| stage.map(|stage| PistonStage { from: stage.from * scale, ..stage })),
        transition: stages.transition * scale,
    };
    let moving_mass = if motor { draw.spread(1e-3, 0.1) } else { draw.spread(0.5, 60.0) };
    let viscous = if motor { draw.spread(1e-2, 5.0) } else { draw.spread(20.0, 1e4) };
    let stiffness = if motor { draw.spread(1e3, 1e5) } else { draw.spread(1e6, 1e8) };
    let stroke = match (motor, telescopic) {
        (true, _) => ActuatorStroke::Unlimited,
        (false, true) => ActuatorStroke::Telescopic(stages),
        (false, false) => ActuatorStroke::Limited(stroke),
    };
    Components {
        cylinder: Cylinder { area_a, area_b, stroke, moving_mass, internal_leakage, ..cylinder() },
        outward: OutwardFlow { external_leakage, ..OutwardFlow::default() },
        friction: Friction::Viscous { viscous },
        force_sensor: ForceSensor { stiffness },
        ..components(
            hose_line(),
            if number.is_multiple_of(3) { StiffnessModel::Uniform } else { StiffnessModel::ByVolume },
        )
    }
}

/// Hoses or pipes on both sides, equal or not.
fn lines(draw: &mut Draw) -> [Line; 2] {
    let mut line = |is_hose: bool| match is_hose {
        true => Line::Hose { hose: hose(), length: draw.spread(0.3, 3.0) },
        false => {
            let pipe = Pipe { bore: draw.spread(5e-3, 2e-2), wall: PipeWall::Rigid };
            Line::Pipe { pipe, length: draw.spread(0.2, 2.0) }
        }
    };
    let (one, other) = (line(true), line(false));
    let swapped = uniform(&mut draw.state) < 0.5;
    let [one, other] = if swapped { [other, one] } else { [one, other] };
    [one, if draw.part("unequal lines", 0.5) { other } else { one }]
}

/// Element between sensor and load.
fn series(draw: &mut Draw, number: u64) -> Option<SeriesElement> {
    if draw.part("transmission", 0.35) {
        return Some(SeriesElement::Transmission(transmission(number)));
    }
    let spring = element((draw.spread(1.0, 2.0) * 1e6) as u64);
    let has = draw.part("spring", 0.6);
    let of_spring = [
        ("series damper", spring.damping.is_some()),
        ("series mass", spring.mass.is_some()),
        ("progression", spring.travel.is_some()),
    ];
    let of_spring = of_spring.into_iter().filter(|(_, is_there)| has && *is_there);
    draw.parts.extend(of_spring.map(|(name, _)| name));
    has.then_some(SeriesElement::Spring(spring))
}

/// Names of a valve between the chambers of every kind.
fn name_of(port: &CrossPort) -> &'static str {
    match (port.restrictor, port.capacity) {
        (Restrictor::Laminar { .. }, None) => "laminar valve",
        (Restrictor::Orifice { .. }, None) => "orifice",
        (Restrictor::Laminar { .. }, Some(_)) => "laminar feedback",
        (Restrictor::Orifice { .. }, Some(_)) => "feedback",
    }
}

fn linkage(draw: &mut Draw, kinds: &[Linkage; 4]) -> Option<Linkage> {
    if !draw.part("linkage", 0.5) {
        return None;
    }
    let linkage = kinds[(4.0 * uniform(&mut draw.state)) as usize];
    let weighed = linkage.level_at(draw.spread(0.1, 6.0)).with_moment(draw.spread(0.1, 30.0));
    Some(if draw.part("weight", 0.6) { weighed } else { linkage })
}

/// Machine at rest, and its plant.
struct Drawn {
    machine: Machine,
    rest: InitialCondition,
    /// Motion of its ground for one metre of the rod's end.
    turned: f64,
    plant: LinearPlant,
    /// Lines with dynamics.
    behind: Option<LineChambers>,
    parts: Vec<&'static str>,
}

/// Actuator whose piston is at a position in m when its machine is at rest.
struct Resting {
    actuator: Actuator,
    lines: Option<[DynamicLine; 2]>,
    machine: Machine,
    position: f64,
    rest: InitialCondition,
}

/// Parts of a rig, and its gas, whose parts count if the gas is in use.
fn parts(draw: &mut Draw, number: u64, kinds: &[Linkage; 4]) -> (Components, [Draw; 2]) {
    let motor = draw.part("motor", 0.25);
    let linkage = if motor { None } else { linkage(draw, kinds) };
    let rig = actuator(draw, number, if linkage.is_some() { STROKE } else { 0.5 }, motor);
    let [line_a, line_b] = lines(draw);
    let air = draw.part("air", 0.3).then(|| EntrainedAir {
        volume_fraction: draw.spread(1e-3, 2e-2),
        polytropic_exponent: draw.spread(1.0, 1.4),
    });
    let cross_port = cross_port(number);
    draw.parts.extend(cross_port.iter().map(name_of));
    let series = if motor { None } else { series(draw, number) };
    let port_valves = if number.is_multiple_of(3) { port_valves(number) } else { [None; 2] };
    draw.parts.extend(port_valves.iter().any(Option::is_some).then_some("port valves"));
    let mut of_gas = [Draw::new(91, number), Draw::new(92, number)];
    let gas = of_gas.each_mut().map(gas);
    let rig = Components {
        fluid: Fluid { entrained_air: air, ..rig.fluid },
        line_a,
        line_b,
        gas,
        cross_port,
        outward: OutwardFlow { port_valves, ..rig.outward },
        series,
        linkage,
        power_unit: power_unit(number),
        ..rig
    };
    (rig, of_gas)
}

/// Rest of a machine at a small command to either side, its rod within the linkage.
fn rest(draw: &mut Draw, rig: &Actuator, machine: &Machine, position: f64) -> InitialCondition {
    let side = if uniform(&mut draw.state) < 0.5 { -1.0 } else { 1.0 };
    let command = draw.spread(3e-3, 0.3);
    let mut rests = (0..60).filter_map(|step| {
        let condition = Condition::Command(side * command * pow(0.8, f64::from(step)));
        machine.rest(&operating_point(rig, position, condition).unwrap()).ok()
    });
    let end = |rest: &InitialCondition| machine.signals(&rest.state, &rest.all_inputs()).load.position;
    let within =
        |rest: &InitialCondition| rig.components().linkage.is_none() || (0.0..=STROKE).contains(&end(rest));
    rests.find(within).unwrap()
}

/// Models of lines in motion, of every kind.
fn moving_lines(draw: &mut Draw, parts: &Components) -> [LineModel; 2] {
    if !draw.part("lines in motion", 0.4) {
        return [LineModel::Lumped; 2];
    }
    let (first, second) = (draw.spread(1.0, 2.0), draw.spread(1.0, 2.0));
    let numbers = [first, second].map(|drawn| (1e6 * drawn) as u64);
    let pressure = 0.5 * (parts.supply.pressure + parts.supply.tank_pressure);
    let of = |line: &Line, number: u64, time: f64| {
        let found = model(number, time);
        let moving = DynamicLine::new(line, &parts.fluid, pressure, StiffeningMember::Nominal, &found);
        // a pipe neither creeps nor has two waves
        moving.map_or(LineModel::TransmissionLine { end_share: END_SHARE }, |_| found)
    };
    let times = [draw.spread(1e-4, 0.1), draw.spread(1e-4, 0.1)];
    [of(&parts.line_a, numbers[0], times[0]), of(&parts.line_b, numbers[1], times[1])]
}

fn resting(draw: &mut Draw, rig: Components) -> Resting {
    let turns = rig.linkage.is_some() || rig.cylinder.stroke == ActuatorStroke::Unlimited;
    let (mass, stiffness, damping) = match turns {
        true => (draw.spread(0.05, 5.0), draw.spread(1e2, 1e5), draw.spread(0.1, 30.0)),
        false => (draw.spread(1.0, 500.0), draw.spread(1e4, 1e8), draw.spread(10.0, 1e4)),
    };
    let load = match draw.part("prescribed load", 0.4) {
        true => Load::Prescribed,
        false => Load::SpringMassDamper { mass, stiffness, damping },
    };
    draw.parts.extend(load.moves().then_some("sprung load"));
    draw.parts.extend((rig.power_unit != PowerUnit::Constant).then_some("pump"));
    let rig = Components { load, ..rig };
    let line_models = moving_lines(draw, &rig);
    let actuator = Actuator::new(Components { line_models, ..rig }).unwrap();
    let lines = actuator.components().lines_in_motion(StiffeningMember::Nominal).unwrap();
    let options = MachineOptions { moving_setting: true, ..MachineOptions::default() };
    let machine = Machine::new(&actuator, &options).unwrap();
    let position = draw.spread(0.1, 0.9) * rig.cylinder.stroke.length().unwrap_or(7.0);
    let rest = rest(draw, &actuator, &machine, position);
    Resting { actuator, lines, machine, position, rest }
}

/// Load at its held position, and the motion of its ground for the rod's end.
fn linear_load(load: &Load, linkage: Option<&Linkage>, force: f64, angle: f64) -> (LinearLoad, f64) {
    let end = linkage.map(|linkage| linkage.end(angle));
    let own = match (*load, end) {
        (Load::SpringMassDamper { mass, stiffness, damping }, None) => {
            LinearLoad::Yielding { mass, damping, stiffness }
        }
        (Load::SpringMassDamper { mass, stiffness, damping }, Some(end)) => {
            let weight = linkage.and_then(|linkage| linkage.weight_at(angle));
            LinearLoad::Linked {
                inertia: mass,
                damping,
                stiffness,
                geometric_stiffness: weight.map_or(0.0, |weight| weight.stiffness) - force * end.lever_slope,
                lever_arm: end.lever_arm,
            }
        }
        _ => LinearLoad::Prescribed,
    };
    (own, end.map_or(1.0, |end| 1.0 / end.lever_arm))
}

/// Feedback of pressure difference, load pressure or another reading, with any filter or none.
fn pressure_feedback(draw: &mut Draw, actuator: &Actuator) -> Option<PressureFeedback> {
    if !draw.part("pressure feedback", 0.6) {
        return None;
    }
    let Cylinder { area_a, area_b, .. } = actuator.components().cylinder;
    let ratio = [1.0, area_b / area_a, draw.spread(0.1, 3.0)][(3.0 * uniform(&mut draw.state)) as usize];
    let corners = [draw.spread(0.1, 300.0), draw.spread(30.0, 3e4)];
    let [high_pass_rad_per_s, low_pass_rad_per_s] =
        corners.map(|corner| (uniform(&mut draw.state) < 0.6).then_some(corner));
    let filter = InnerFeedback { gain: draw.spread(1e-9, 1e-5), high_pass_rad_per_s, low_pass_rad_per_s };
    Some(PressureFeedback { filter, ratio })
}

fn drawn(number: u64, kinds: &[Linkage; 4]) -> Drawn {
    let mut draw = Draw::new(90, number);
    let (rig, of_gas) = parts(&mut draw, number, kinds);
    let Resting { actuator, lines, machine, position, rest } = resting(&mut draw, rig);
    let outputs = machine.signals(&rest.state, &rest.all_inputs());
    assert!((outputs.piston.position - position).abs() < 1e-11, "{number}");
    let (force, angle) = (outputs.hydraulic_force, outputs.joint.position);
    let (own, turned) = linear_load(&actuator.components().load, rig.linkage.as_ref(), force, angle);
    let pressures = outputs.pressures;
    let (plant, behind) = match lines {
        Some(lines) => {
            let (plant, behind) = plant_with_lines(&actuator, &machine, lines, (position, &rest), own);
            (plant, Some(behind))
        }
        None => {
            let (plant, _) = plant_at_rest(&actuator, &machine, (position, pressures, &rest.state), own);
            (plant, None)
        }
    };
    let turns = rig.linkage.is_some() || rig.cylinder.stroke == ActuatorStroke::Unlimited;
    let plant = LinearPlant {
        series: LinearSeries::of_components(&rig, force),
        load_velocity_feed_forward: draw
            .part("feed-forward", 0.5)
            .then(|| draw.spread(0.01, if turns { 1.0 } else { 30.0 })),
        pressure_feedback: pressure_feedback(&mut draw, &actuator),
        ..plant
    };
    for ((of_gas, gas), pressure) in of_gas.into_iter().zip(rig.gas).zip(pressures) {
        let in_use = gas.is_some_and(|gas| gas.at_rest().least_pressure() < pressure);
        draw.parts.extend(of_gas.parts.into_iter().filter(|_| in_use));
    }
    Drawn { machine, rest, turned, plant, behind, parts: draw.parts }
}

/// Signals by command and by motion with the pressures A and B, the last two, fed back.
fn closed(
    feedback: Option<PressureFeedback>,
    s: Complex64,
    [force, felt, velocity, of_a, of_b]: [[Complex64; 2]; 5],
) -> [[Complex64; 2]; 3] {
    let Some(PressureFeedback { filter, ratio }) = feedback else { return [force, felt, velocity] };
    let back = [0, 1].map(|path| filter.response(s) * (of_a[path] - ratio * of_b[path]));
    [force, felt, velocity].map(|[command, motion]| {
        let command = command / (1.0 + back[0]);
        [command, motion - command * back[1]]
    })
}

/// Largest relative difference between plant and machine over frequency: in measured force, force
/// on the load, velocity of a load that yields, as polynomials and as responses.
fn apart(rig: &Drawn) -> f64 {
    let Drawn { machine, rest, turned, plant, behind, .. } = rig;
    let on_load = plant.series.map(|series| LinearSeries { output: SeriesOutput::OnLoad, ..series });
    let plants = [*plant, LinearPlant { series: on_load, ..*plant }];
    let moving = plants.map(|plant| match behind {
        Some(behind) => PlantInMotion::new(&plant, behind),
        None => PlantInMotion::lumped(&plant),
    });
    let polynomials = plants.map(|plant| plant.coefficients());
    let names =
        [Signal::Force, Signal::LoadForce, Signal::LoadVelocity, Signal::PressureA, Signal::PressureB];
    let signals = slopes(machine, rest, &names);
    let gain = plant.load_velocity_feed_forward.unwrap_or(0.0);
    let mut worst = 0.0_f64;
    for step in 0..13 {
        let frequency = 1e-2 * pow(1e6, f64::from(step) / 12.0);
        let s = Complex64::new(0.0, frequency);
        let amplitudes = amplitudes(machine, rest, (gain, *turned), frequency);
        let of = [0, 1, 2, 3, 4].map(|one| amplitudes.each_ref().map(|of| signal_of(of, &signals[one])));
        let [force, felt, velocity] = closed(plant.pressure_feedback, s, of);
        let mut pairs = vec![(moving[0].response(s), force), (moving[1].response(s), felt)];
        pairs.extend((plant.load != LinearLoad::Prescribed).then(|| (moving[0].load_velocity(s), velocity)));
        let of_polynomials = polynomials.iter().zip([force, felt]).filter(|_| behind.is_none());
        pairs.extend(of_polynomials.map(|(plant, own)| {
            let by_motion = plant.disturbance.as_ref().unwrap().at_frequency(frequency);
            ([plant.command.at_frequency(frequency), by_motion], own)
        }));
        for (found, own) in pairs.into_iter().flat_map(|(found, own)| found.into_iter().zip(own)) {
            worst = worst.max((found / own - 1.0).norm_sqr().sqrt());
        }
    }
    worst
}

/// 200 rigs, lines lumped or in motion, each of a random choice of these parts, at 13 frequencies,
/// to 1e-8: forces by command and by motion of the load or of its ground, and the velocity of a
/// load that yields.
///
/// Invalid combinations: [`Actuator::new`] rejects a neck with a valve before one gas, since only
/// one of them leads to it; a polytropic exponent other than one with a thermal time constant,
/// which states the heat already; and gas that is added and removed with a thermal time constant,
/// as the temperature of the added gas is not known. Spring and transmission, the kinds of valves
/// between the chambers, and the strokes of a motor with unlimited rotation, of a telescopic piston
/// and of any other cylinder are each one choice. A motor has one displacement, and with a motor
/// `phea check` rejects a linkage, a spring and a transmission.
#[test]
fn it_is_the_machine_for_small_motions() {
    let kinds = linkages();
    let mut found: Vec<Vec<&str>> = Vec::new();
    for number in 0..RIGS {
        let rig = drawn(number, &kinds);
        let worst = apart(&rig);
        assert!(worst < 1e-8, "rig {number} of {:?}: {worst}", rig.parts);
        found.push(rig.parts);
    }
    // each part in ten rigs, and every possible pair in one
    let count =
        |names: [&str; 2]| found.iter().filter(|of| names.iter().all(|name| of.contains(name))).count();
    for (index, (name, never)) in PARTS.iter().enumerate() {
        assert!(count([name; 2]) >= 10, "{name}: {}", count([name; 2]));
        for (other, _) in &PARTS[index + 1..] {
            let (met, can) = (count([name, other]), !never.contains(other));
            assert_eq!(met > 0, can, "{name} with {other}: {met}");
        }
    }
    assert!(found.iter().any(|of| of.len() > 12));
}
