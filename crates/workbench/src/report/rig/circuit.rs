//! The circuit of a project, in symbols and a few words each.

use super::{DescriptionContext, moving_mass, moving_words, shown, shown_in_millimetres, single_line};
use crate::figure::{
    AccumulatorSymbol, ControllerSymbol, CrossPortSymbol, Environment, Figure, LineSymbol, LinkageSymbol,
    Rods, Schematic, SeriesKind, SeriesSymbol, SupplyKind, Words,
};
use crate::linearize::{LinkagePosition, linkage_places};
use crate::project::{
    self, AdjustmentKind, CrossPortKind, DeclaredAccumulator, DeclaredActuator, DeclaredAdjustment,
    DeclaredCrossPort, DeclaredLine, DeclaredLinkage, DeclaredSeries, LinkageKind, Load, OrificeSize,
    Project, SupplyModel,
};
use crate::quantity::{self, FLOW, LENGTH, MASS, MotionWords, PRESSURE, STIFFNESS, VOLTAGE, VOLUME};
use crate::rig::{CrossPortAtPoint, Rig, cross_port_at_point};
use phea_hydraulics::cross_port::Restrictor;
use phea_hydraulics::port_valves::{PortValveKind, PortValves};

pub(super) fn circuit(project: &Project, actuator: &DeclaredActuator, rig: &Rig) -> Figure {
    let [rod_a, rod_b] = actuator.cylinder.rod_diameters_m();
    let moving = |value, dimension| shown(value, actuator.motion().dimension(dimension));
    let mut supply_rows = vec![shown(actuator.supply.pressure, &PRESSURE)];
    supply_rows.extend(actuator.supply.flow().map(|flow| shown(flow, &FLOW)));
    let symmetric = rod_a > 0.0 && rod_b > 0.0;
    let [valves_a, valves_b] = rig.actuator.components().outward.port_valves;
    let chart = Schematic {
        supply: match actuator.supply.model {
            SupplyModel::Constant { .. } => SupplyKind::ConstantPressure,
            SupplyModel::PumpLimited(_) => SupplyKind::Pump,
        },
        supply_rows,
        tank: shown(actuator.supply.tank_pressure, &PRESSURE),
        valve_rows: vec![
            actuator.valve.model.clone().unwrap_or_else(|| "servovalve".to_string()),
            format!("±{}", shown(actuator.valve.nominal_voltage, &VOLTAGE)),
        ],
        line_a: port_symbol(line_symbol(&actuator.line.a), valves_a),
        line_b: port_symbol(line_symbol(&actuator.line.b), valves_b),
        rods: if symmetric { Rods::Both } else { Rods::TowardsLoad },
        load_at_b: symmetric || rod_b > 0.0 || actuator.motor.is_some(),
        cross_port: actuator.cross_port.as_ref().map(cross_port_symbol),
        motion: actuator.motion(),
        further_stages: actuator.cylinder.stages.len(),
        cylinder: moving_words(actuator, DescriptionContext::Drawing),
        mass: moving(moving_mass(actuator), &MASS),
        load_cell: Some(vec![moving(actuator.force_sensor.stiffness, &STIFFNESS)]),
        series: actuator.series.as_ref().map(series_symbol),
        linkage: actuator.linkage.as_ref().map(|linkage| linkage_symbol(linkage, rig)),
        environment: match actuator.load {
            Load::Prescribed => Environment::PrescribedMotion,
            Load::Wall { .. } => Environment::Wall,
            Load::SpringMassDamper { .. } => Environment::SpringMassDamper,
        },
        environment_rows: environment_rows(actuator),
        controller: project.controller.as_ref().map(|controller| ControllerSymbol {
            has_prefilter: project.prefilter.is_some(),
            rows: controller_words(project, controller),
        }),
    };
    let MotionWords { cylinder, load_cell, force, .. } = actuator.motion().words();
    let caption = format!(
        "The circuit as the project describes it: supply, servovalve, lines, {cylinder}, {load_cell}, load, and the loop that closes over the {force}."
    );
    chart.draw(&Words::new("circuit", "The rig", caption))
}

/// Description of the load, shown below its drawing.
fn environment_rows(actuator: &DeclaredActuator) -> Vec<String> {
    let stiffness = match actuator.load {
        Load::Prescribed => None,
        Load::SpringMassDamper { stiffness, .. } | Load::Wall { stiffness, .. } => Some(stiffness),
    };
    let stiffness = stiffness.map(|value| shown(value, actuator.load_motion().dimension(&STIFFNESS)));
    let weight = actuator.linkage.as_ref().and_then(|linkage| linkage.weight);
    let weight = weight.map(|weight| format!("weighs {}", shown(weight.mass, &MASS)));
    stiffness.into_iter().chain(weight).collect()
}

/// The lever of a linkage: its kind, and its arm at the operating point.
fn linkage_symbol(linkage: &DeclaredLinkage, rig: &Rig) -> LinkageSymbol {
    let kind = match linkage.kind {
        LinkageKind::Triangle(_) => "triangle",
        LinkageKind::FourBar { .. } => "four-bar",
        LinkageKind::Table { .. } => "table",
    };
    let places = linkage_places(rig);
    let here = places.iter().find(|place| place.at == LinkagePosition::OperatingPoint);
    let arm = here.map(|place| ["arm r".to_string(), quantity::display(place.lever_arm_m, &LENGTH, 3)]);
    LinkageSymbol { rows: std::iter::once(kind.to_string()).chain(arm.into_iter().flatten()).collect() }
}

/// A valve between the chambers: its kind, and the numbers that state it.
fn cross_port_symbol(declared: &DeclaredCrossPort) -> CrossPortSymbol {
    let (has_capacity, kind) = match &declared.kind {
        CrossPortKind::Laminar { .. } => (false, "laminar valve"),
        CrossPortKind::Orifice(_) => (false, "orifice"),
        CrossPortKind::DynamicPressureFeedback { .. } => (true, "feedback"),
    };
    let size = declared.orifice().map(|orifice| match orifice.size {
        OrificeSize::Diameter { diameter, .. } => shown(diameter, &LENGTH),
        OrificeSize::Flow { flow, pressure_drop } => {
            format!("{} at {}", shown(flow, &FLOW), shown(pressure_drop, &PRESSURE))
        }
    });
    CrossPortSymbol { has_capacity, rows: std::iter::once(kind.to_string()).chain(size).collect() }
}

/// A line with the stated data of its gas next to the drawing; the effect of heat is stated in the
/// table.
fn line_symbol(declared: &DeclaredLine) -> LineSymbol {
    let mut symbol = single_line(declared);
    let Some(gas) = &declared.accumulator else { return symbol };
    symbol.accumulator = Some(match gas.adjustment.map(|adjustment| adjustment.kind) {
        None => AccumulatorSymbol::Fixed,
        Some(AdjustmentKind::Gas(_)) => AccumulatorSymbol::Adjusted,
        Some(AdjustmentKind::Valve(_)) => AccumulatorSymbol::ThroughValve,
    });
    symbol.rows.push(gas_at_rest(gas));
    symbol.rows.extend(gas.adjustment.iter().flat_map(|adjustment| adjustment_rows(gas, adjustment)));
    symbol.rows.extend(neck_words(gas));
    symbol
}

/// Volume and precharge, if the setting of the gas is at rest.
fn gas_at_rest(gas: &DeclaredAccumulator) -> String {
    let [mut volume, mut precharge] = [gas.gas_volume, gas.precharge_pressure];
    if let Some(DeclaredAdjustment { kind: AdjustmentKind::Gas(one), setting }) = gas.adjustment {
        let setting = setting.unwrap_or(0.0);
        let at = |zero: f64, one: Option<f64>| one.map_or(zero, |one| zero + setting * (one - zero));
        [volume, precharge] = [at(volume, one.gas_volume), at(precharge, one.precharge_pressure)];
    }
    // two quantities of three digits are as wide as a row
    format!("{}, {}", quantity::display(volume, &VOLUME, 3), quantity::display(precharge, &PRESSURE, 3))
}

/// The setting, and the range in which it is adjusted.
fn adjustment_rows(gas: &DeclaredAccumulator, adjustment: &DeclaredAdjustment) -> Vec<String> {
    let setting = shown(adjustment.setting.unwrap_or(0.0), &quantity::RATIO);
    match adjustment.kind {
        AdjustmentKind::Valve(_) => vec![format!("valve, setting {setting}")],
        AdjustmentKind::Gas(one) => {
            let volume = one.gas_volume.map(|one| [shown(gas.gas_volume, &VOLUME), shown(one, &VOLUME)]);
            let precharge = one
                .precharge_pressure
                .map(|one| [shown(gas.precharge_pressure, &PRESSURE), shown(one, &PRESSURE)]);
            let ranges = volume.into_iter().chain(precharge);
            let ranges = ranges.map(|[zero, one]| format!("{zero} to {one}"));
            std::iter::once(format!("at setting {setting} of")).chain(ranges).collect()
        }
    }
}

fn neck_words(gas: &DeclaredAccumulator) -> Option<String> {
    let neck = gas.neck?;
    let mm = shown_in_millimetres;
    Some(format!("neck {} × {} mm", mm(neck.diameter), mm(neck.length)))
}

/// A line with its gas, in a few words.
pub(super) fn line_words(declared: &DeclaredLine) -> String {
    let mut rows = single_line(declared).rows;
    if let Some(gas) = &declared.accumulator {
        rows.push(gas_at_rest(gas));
        rows.extend(gas.temperatures.map(|temperatures| {
            let [stated, working] = [temperatures.precharge, temperatures.working]
                .map(|temperature| shown(temperature, &quantity::TEMPERATURE));
            format!("at {stated}, works at {working}")
        }));
        let time_constant = gas.thermal_time_constant;
        rows.extend(time_constant.map(|time| format!("heat {}", shown(time, &quantity::TIME))));
        rows.extend(neck_words(gas));
        rows.extend(gas.adjustment.as_ref().map(|adjustment| {
            let rows = adjustment_rows(gas, adjustment);
            match adjustment.kind {
                AdjustmentKind::Valve(_) => format!("behind a {}", rows.join(" ")),
                AdjustmentKind::Gas(_) => rows.join(" "),
            }
        }));
    }
    rows.join(", ")
}

/// The valves at the chambers of a rig, each with its place and a few words.
pub(super) fn chamber_valve_rows(rig: &Rig) -> Vec<(&'static str, String)> {
    let cross_port = cross_port_at_point(rig);
    let cross_port = cross_port.map(|found| ("between the chambers", cross_port_words(&found)));
    cross_port.into_iter().chain(port_valve_rows(rig)).collect()
}

/// The relief and check valves of each chamber, with the pressures at which they open and what they
/// pass at rest.
fn port_valve_rows(rig: &Rig) -> Vec<(&'static str, String)> {
    let components = rig.actuator.components();
    let tank = components.supply.tank_pressure;
    let sides = components.outward.port_valves.iter().zip([rig.point.pressure_a, rig.point.pressure_b]);
    let row = |((valves, pressure), name): ((&Option<PortValves>, f64), &'static str)| {
        let valves = valves.as_ref()?;
        let words = valves.at_point(pressure, tank).into_iter().map(|valve| {
            let (name, beyond) = match valve.kind {
                PortValveKind::Relief => ("relief valve", "above"),
                PortValveKind::Check => ("check valve", "below"),
            };
            let conductance = quantity::significant(valve.open_conductance, 3);
            format!("{name} opens {beyond} {}, {conductance} m3/(s.Pa)", shown(valve.opens_at, &PRESSURE))
        });
        let at_rest = match valves.flow(pressure - tank) {
            0.0 => "nothing flows at rest".to_string(),
            flow => format!("passes {} at rest", shown(flow, &FLOW)),
        };
        Some((name, words.chain([at_rest]).collect::<Vec<String>>().join("; ")))
    };
    sides.zip(["chamber A to tank", "chamber B to tank"]).filter_map(row).collect()
}

/// A valve between the chambers in a few words, with its flow and loss at rest.
fn cross_port_words(found: &CrossPortAtPoint) -> String {
    let conductance = quantity::significant(found.conductance, 3);
    let kind = match (found.valve.restrictor, found.valve.capacity) {
        (_, Some(_)) => "dynamic pressure feedback",
        (Restrictor::Laminar { .. }, None) => "laminar valve",
        (Restrictor::Orifice { .. }, None) => "orifice",
    };
    let cost = match found.valve.capacity {
        Some(capacity) => {
            format!("capacity {} m3/Pa, nothing flows at rest", quantity::significant(capacity, 3))
        }
        None => format!(
            "passes {} and loses {} W at rest",
            shown(found.flow, &FLOW),
            quantity::significant(found.loss(), 3)
        ),
    };
    format!("{kind}, conductance {conductance} m3/(s.Pa), {cost}")
}

/// A line with the valves between its chamber and the tank.
fn port_symbol(line: LineSymbol, valves: Option<PortValves>) -> LineSymbol {
    let [relief, check] = valves.map_or([None; 2], |valves| [valves.relief, valves.check]);
    // gas takes the row below the line
    let opens = relief.filter(|_| line.accumulator.is_none());
    let opens = opens.map(|relief| format!("relief {}", shown(relief.cracking_pressure, &PRESSURE)));
    let rows = line.rows.into_iter().chain(opens).collect();
    LineSymbol { has_relief: relief.is_some(), has_check: check.is_some(), rows, ..line }
}

fn series_symbol(series: &DeclaredSeries) -> SeriesSymbol {
    match series {
        DeclaredSeries::Spring(spring) => SeriesSymbol {
            kind: if spring.damping.is_some() { SeriesKind::DampedSpring } else { SeriesKind::Spring },
            words: shown(spring.stiffness, &STIFFNESS),
        },
        DeclaredSeries::Transmission(transmission) => SeriesSymbol {
            kind: SeriesKind::Transmission,
            words: match transmission.line.length() {
                Some(length) => format!("{} of oil", shown(length, &LENGTH)),
                None => "oil".to_string(),
            },
        },
    }
}

fn controller_words(project: &Project, controller: &project::DeclaredController) -> Vec<String> {
    let words = |letter: &str, transfer: &project::Transfer| match (
        &transfer.ratio.numerator,
        &transfer.ratio.denominator,
    ) {
        (Some(numerator), Some(denominator)) => {
            Some(format!("{letter} = {}/{}", polynomial(numerator.text()), polynomial(denominator.text())))
        }
        _ => None,
    };
    let mut rows: Vec<String> = words("G", &controller.transfer).into_iter().collect();
    rows.extend(project.prefilter.as_ref().and_then(|prefilter| words("F", &prefilter.transfer)));
    if let Some(sample_time) = controller.sample_time {
        rows.push(format!("sampled every {}", shown(sample_time, &quantity::TIME)));
    }
    rows
}

/// A polynomial for people: products by a space, in parentheses if it is a sum.
fn polynomial(text: &str) -> String {
    let spaced = text.replace('*', " ");
    if spaced.contains(['+', '-', ' ']) { format!("({spaced})") } else { spaced }
}
