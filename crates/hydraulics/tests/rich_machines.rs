//! Rigs with friction, gas, air and dynamic lines, for the ledgers.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_hydraulics::accumulator::{AdjustedPart, Adjustment, GasValve, Neck};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cross_port::{CrossPort, Restrictor};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::friction::{Friction, LuGre, LuGrePassivity};
use phea_hydraulics::line::{DynamicLine, LaminarFriction, LineModel, StiffeningMember};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Accumulator, Machine, MachineOptions, PowerUnit, PumpLimited};
use phea_hydraulics::reference_rig::{
    benchmark_components, components, cylinder, hose_line, leaking, pipe_line,
};
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::machine_of;

/// LuGre friction that is passive.
pub(super) fn passive_friction() -> Friction {
    let Friction::LuGre(lugre) = benchmark_components().friction else { unreachable!() };
    let passive = LuGre { bristle_damping: 150.0, ..lugre };
    assert!(matches!(passive.passivity(), LuGrePassivity::Passive { .. }));
    Friction::LuGre(passive)
}

pub(super) fn asymmetric() -> Components {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    let hose = components(hose_line(), StiffnessModel::ByVolume);
    Components {
        cylinder: Cylinder { area_a, area_b, dead_volume_a: 2e-5, dead_volume_b: 1e-5, ..cylinder() },
        line_b: pipe_line(),
        friction: passive_friction(),
        ..hose
    }
}

pub(super) fn pump_with(accumulator: Option<Accumulator>) -> PowerUnit {
    PowerUnit::PumpLimited(PumpLimited {
        pump_flow: 1.633e-4,
        relief_override: 5e5,
        volume: 5e-4,
        effective_bulk_modulus: 1e9,
        accumulator,
    })
}

pub(super) fn pump() -> PowerUnit {
    pump_with(None)
}

/// Pump with gas of this precharge in Pa and this index.
pub(super) fn charged_pump(precharge_pressure: f64, polytropic_exponent: f64) -> PowerUnit {
    pump_with(Some(Accumulator { gas_volume: 1e-4, precharge_pressure, polytropic_exponent }))
}

/// Rig with bubbles in its fluid.
pub(super) fn foamy(
    rig: Components,
    stiffness_model: StiffnessModel,
    polytropic_exponent: f64,
) -> Components {
    let air = Some(EntrainedAir { volume_fraction: 0.02, polytropic_exponent });
    Components { fluid: Fluid { entrained_air: air, ..rig.fluid }, stiffness_model, ..rig }
}

/// Rig with dynamics of both lines.
pub(super) fn lines_of(rig: &Components, models: [LineModel; 2]) -> Option<[DynamicLine; 2]> {
    let [model_a, model_b] = models;
    let of =
        |line, model| DynamicLine::new(line, &rig.fluid, 35e5, StiffeningMember::Nominal, &model).unwrap();
    Some([of(&rig.line_a, model_a), of(&rig.line_b, model_b)])
}

/// Segments with all their options.
const FULL: LineModel = LineModel::Segments {
    count: 3,
    friction: LaminarFriction::FrequencyDependent,
    relaxation_time: Some(0.02),
};
pub(super) const PLAIN: LineModel =
    LineModel::Segments { count: 1, friction: LaminarFriction::Steady, relaxation_time: None };
const SMEARED: LineModel =
    LineModel::Segments { count: 2, friction: LaminarFriction::FrequencyDependent, relaxation_time: None };
const CREEPING: LineModel = LineModel::Creeping { relaxation_time: 0.02 };

/// Rigs with gas in the supply, air in the oil, and dynamic lines, one by one and all at once.
pub(super) fn rich_machines() -> Vec<(&'static str, Machine)> {
    let rig = asymmetric();
    let hoses = Components { line_b: hose_line(), ..rig };
    let of = |rig, (power_unit, options): (PowerUnit, MachineOptions)| {
        machine_of(Components { power_unit, ..leaking(rig, 2e-12) }, &options)
    };
    let with = |power_unit, lines| (power_unit, MachineOptions { lines, ..MachineOptions::default() });
    let uniform = foamy(
        Components { friction: passive_friction(), ..benchmark_components() },
        StiffnessModel::Uniform,
        1.0,
    );
    let by_volume = foamy(rig, StiffnessModel::ByVolume, 1.4);
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let all = Components { load, ..foamy(hoses, StiffnessModel::Uniform, 1.2) };
    let segments = with(pump(), lines_of(&rig, [SMEARED, PLAIN]));
    let gas = |gas_volume, precharge_pressure, polytropic_exponent| {
        Some(Accumulator { gas_volume, precharge_pressure, polytropic_exponent })
    };
    let at_chambers = |rig| Components { accumulators: [gas(2e-5, 8e5, 1.4), gas(5e-6, 3e5, 1.0)], ..rig };
    let neck = |diameter| Some(Neck::round([diameter, 0.04], [870.0, 46e-6, 1.45e9], 1.5));
    let necked = |rig| Components { necks: [neck(6e-3), neck(4e-3)], ..at_chambers(rig) };
    let half_necked = Components { necks: [None, neck(6e-3)], ..at_chambers(by_volume) };
    let heated = |rig: Components, thermal_time_constants| Components {
        accumulators: [gas(2e-5, 8e5, 1.0), gas(5e-6, 3e5, 1.0)],
        thermal_time_constants,
        ..rig
    };
    let at_one = Components { accumulators: [None, gas(1e-5, 5e5, 1.25)], ..by_volume };
    let port =
        |restrictor, capacity| Components { cross_port: Some(CrossPort { restrictor, capacity }), ..rig };
    let orifice = Restrictor::Orifice { flow_coefficient: 2e-9, transition_pressure: 1e4 };
    let laminar = Restrictor::Laminar { conductance: 1e-11 };
    let mut machines = vec![
        ("a laminar valve between the chambers", of(port(laminar, None), with(pump(), None))),
        ("an orifice between them", of(port(orifice, None), with(PowerUnit::Constant, None))),
        ("laminar feedback", of(port(laminar, Some(3e-13)), with(pump(), None))),
        ("feedback behind lines", of(port(orifice, Some(3e-13)), segments)),
        ("gas with heat", of(heated(rig, [Some(0.02), None]), with(charged_pump(40e5, 1.4), None))),
        ("gas with heat behind necks", of(heated(necked(rig), [Some(0.3), Some(0.01)]), with(pump(), None))),
        ("gas with heat behind a line", of(heated(by_volume, [None, Some(0.05)]), segments)),
        ("gas behind necks", of(necked(rig), with(charged_pump(40e5, 1.4), None))),
        ("gas behind a neck and a line", of(half_necked, segments)),
        ("gas at the chambers", of(at_chambers(rig), with(charged_pump(40e5, 1.4), None))),
        ("gas behind a line", of(at_one, segments)),
        ("gas", of(rig, with(charged_pump(40e5, 1.4), None))),
        ("isothermal gas", of(rig, with(charged_pump(40e5, 1.0), None))),
        ("air", of(by_volume, with(pump(), None))),
        ("air, one modulus", of(uniform, with(PowerUnit::Constant, None))),
        ("segments", of(rig, with(PowerUnit::Constant, lines_of(&rig, [SMEARED, PLAIN])))),
        ("creep", of(hoses, with(pump(), lines_of(&hoses, [FULL, CREEPING])))),
        ("all", of(all, with(charged_pump(40e5, 1.3), lines_of(&all, [FULL, SMEARED])))),
    ];
    machines.extend(adjusted_machines());
    machines
}

/// Rigs whose accumulators are adjusted while an external force acts on their load.
fn adjusted_machines() -> [(&'static str, Machine); 3] {
    let rig = asymmetric();
    let by_volume = foamy(rig, StiffnessModel::ByVolume, 1.4);
    let gas = |gas_volume, precharge_pressure, polytropic_exponent| {
        Some(Accumulator { gas_volume, precharge_pressure, polytropic_exponent })
    };
    let at_chambers = |rig| Components { accumulators: [gas(2e-5, 8e5, 1.4), gas(5e-6, 3e5, 1.0)], ..rig };
    let isothermal = Components { accumulators: [gas(2e-5, 8e5, 1.0), gas(5e-6, 3e5, 1.0)], ..by_volume };
    let neck = Some(Neck::round([6e-3, 0.04], [870.0, 46e-6, 1.45e9], 1.5));
    // gas that is moved, at one chamber behind a neck, and gas behind valves, at one chamber with
    // heat
    let adjustment = |part| Some(Adjustment { setting: 0.5, part });
    let more = AdjustedPart::Gas { gas_volume: 8e-6, precharge_pressure: -2e5 };
    let less = AdjustedPart::Gas { gas_volume: -3e-6, precharge_pressure: 1e5 };
    let valve = |flow_coefficient| {
        let (transition_pressure, compliance) = (1e4, 3e-15);
        AdjustedPart::Valve(GasValve { flow_coefficient, transition_pressure, compliance, shut: false })
    };
    let of_gas = Components {
        adjustments: [adjustment(more), adjustment(less)],
        necks: [None, neck],
        ..at_chambers(rig)
    };
    let valves = [adjustment(valve(3e-8)), adjustment(valve(1e-8))];
    let of_valves =
        Components { adjustments: valves, thermal_time_constants: [None, Some(0.05)], ..isothermal };
    let valve_and_gas = Components { adjustments: [valves[0], adjustment(less)], ..at_chambers(rig) };
    let moving = |lines| MachineOptions {
        external_force: true,
        moving_setting: true,
        lines,
        ..MachineOptions::default()
    };
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let of = |rig, power_unit, lines| {
        machine_of(Components { power_unit, load, ..leaking(rig, 2e-12) }, &moving(lines))
    };
    let lines = lines_of(&rig, [SMEARED, PLAIN]);
    [
        ("gas that is moved", of(of_gas, charged_pump(40e5, 1.4), None)),
        ("gas with heat behind valves that move", of(of_valves, pump(), lines)),
        ("gas behind a valve, and moved", of(valve_and_gas, PowerUnit::Constant, None)),
    ]
}
