//! Rigs with friction, gas, air and dynamic lines, for the ledgers.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_hydraulics::accumulator::{
    AdjustedGas, ChamberGas, GasContent, GasPassage, GasValve, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cross_port::{CrossPort, Restrictor};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::friction::{Friction, LuGre, LuGrePassivity};
use phea_hydraulics::line::{LaminarFriction, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Accumulator, Machine, MachineOptions, PowerUnit, PumpLimited};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::port_valves::{PortValves, TankValve};
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
    let of = |rig, (power_unit, line_models): (PowerUnit, [LineModel; 2])| {
        machine_of(Components { power_unit, line_models, ..leaking(rig, 2e-12) }, &MachineOptions::default())
    };
    let lumped = [LineModel::Lumped; 2];
    let with = |power_unit| (power_unit, lumped);
    let uniform = foamy(
        Components { friction: passive_friction(), ..benchmark_components() },
        StiffnessModel::Uniform,
        1.0,
    );
    let by_volume = foamy(rig, StiffnessModel::ByVolume, 1.4);
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let all = Components { load, ..foamy(hoses, StiffnessModel::Uniform, 1.2) };
    let segments = (pump(), [SMEARED, PLAIN]);
    let (open, necks) = ([GasPassage::Open; 2], [neck(6e-3), neck(4e-3)].map(GasPassage::Neck));
    let necked = |rig| with_gas(rig, POLYTROPIC, necks);
    let half_necked = with_gas(by_volume, POLYTROPIC, [GasPassage::Open, GasPassage::Neck(neck(6e-3))]);
    let heated = |rig, time_constants, passages| with_gas(rig, relaxing(time_constants), passages);
    let gas = Accumulator { gas_volume: 1e-5, precharge_pressure: 5e5, polytropic_exponent: 1.25 };
    let at_one = Components { gas: [None, Some(gas.into())], ..by_volume };
    let port =
        |restrictor, capacity| Components { cross_port: Some(CrossPort { restrictor, capacity }), ..rig };
    let valves = PortValves {
        relief: Some(TankValve { cracking_pressure: 30e5, conductance: 2e-11 }),
        check: Some(TankValve { cracking_pressure: 1e5, conductance: 2e-10 }),
        transition_pressure: 1e5,
    };
    let relieved = |rig: Components, port_valves| Components {
        outward: OutwardFlow { port_valves, ..OutwardFlow::default() },
        ..rig
    };
    let orifice = Restrictor::Orifice { flow_coefficient: 2e-9, transition_pressure: 1e4 };
    let laminar = Restrictor::Laminar { conductance: 1e-11 };
    let mut machines = vec![
        ("a laminar valve between the chambers", of(port(laminar, None), with(pump()))),
        ("an orifice between them", of(port(orifice, None), with(PowerUnit::Constant))),
        ("relief and check valves", of(relieved(rig, [Some(valves); 2]), with(pump()))),
        ("valves at a chamber behind a line", of(relieved(by_volume, [None, Some(valves)]), segments)),
        ("laminar feedback", of(port(laminar, Some(3e-13)), with(pump()))),
        ("feedback behind lines", of(port(orifice, Some(3e-13)), segments)),
        ("gas with heat", of(heated(rig, [Some(0.02), None], open), with(charged_pump(40e5, 1.4)))),
        ("gas with heat behind necks", of(heated(rig, [Some(0.3), Some(0.01)], necks), with(pump()))),
        ("gas with heat behind a line", of(heated(by_volume, [None, Some(0.05)], open), segments)),
        ("gas behind necks", of(necked(rig), with(charged_pump(40e5, 1.4)))),
        ("gas behind a neck and a line", of(half_necked, segments)),
        ("gas at the chambers", of(with_gas(rig, POLYTROPIC, open), with(charged_pump(40e5, 1.4)))),
        ("gas behind a line", of(at_one, segments)),
        ("gas", of(rig, with(charged_pump(40e5, 1.4)))),
        ("isothermal gas", of(rig, with(charged_pump(40e5, 1.0)))),
        ("air", of(by_volume, with(pump()))),
        ("air, one modulus", of(uniform, with(PowerUnit::Constant))),
        ("segments", of(rig, (PowerUnit::Constant, [SMEARED, PLAIN]))),
        ("creep", of(hoses, (pump(), [FULL, CREEPING]))),
        ("all", of(all, (charged_pump(40e5, 1.3), [FULL, SMEARED]))),
    ];
    machines.extend(adjusted_machines());
    machines
}

/// Polytropic gas at the chambers.
const LARGE: Accumulator =
    Accumulator { gas_volume: 2e-5, precharge_pressure: 8e5, polytropic_exponent: 1.4 };
const SMALL: Accumulator =
    Accumulator { gas_volume: 5e-6, precharge_pressure: 3e5, polytropic_exponent: 1.0 };
const POLYTROPIC: [GasContent; 2] = [GasContent::Polytropic(LARGE), GasContent::Polytropic(SMALL)];

/// Isothermal gas, or gas with a thermal time constant in s, at the chambers.
fn relaxing(time_constants: [Option<f64>; 2]) -> [GasContent; 2] {
    [0, 1].map(|side| {
        let gas = Accumulator { polytropic_exponent: 1.0, ..[LARGE, SMALL][side] };
        let Accumulator { gas_volume, precharge_pressure, .. } = gas;
        match time_constants[side] {
            None => GasContent::Polytropic(gas),
            Some(time_constant) => {
                GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
            }
        }
    })
}

fn neck(diameter: f64) -> Neck {
    Neck::round([diameter, 0.04], [870.0, 46e-6, 1.45e9], 1.5)
}

fn with_gas(rig: Components, contents: [GasContent; 2], passages: [GasPassage; 2]) -> Components {
    let sealed =
        |side| SealedGas { content: contents[side], passage: passages[side], maximum_pressure_ratio: None };
    Components { gas: [0, 1].map(|side| Some(ChamberGas::Sealed(sealed(side)))), ..rig }
}

/// Rigs whose accumulators are adjusted while an external force acts on their load.
fn adjusted_machines() -> [(&'static str, Machine); 3] {
    let rig = asymmetric();
    let by_volume = foamy(rig, StiffnessModel::ByVolume, 1.4);
    // gas that is moved, at one chamber behind a neck, and gas behind valves, at one chamber with
    // heat
    let more = AdjustedGas {
        at_rest: LARGE,
        setting: 0.5,
        volume_rise: 8e-6,
        precharge_rise: -2e5,
        neck: None,
        maximum_pressure_ratio: None,
    };
    let less = AdjustedGas {
        at_rest: SMALL,
        setting: 0.5,
        volume_rise: -3e-6,
        precharge_rise: 1e5,
        neck: None,
        maximum_pressure_ratio: None,
    };
    let behind_neck = AdjustedGas { neck: Some(neck(6e-3)), ..less };
    let moved = |gas| Some(ChamberGas::Adjusted(gas));
    let of_gas = Components { gas: [moved(more), moved(behind_neck)], ..rig };
    let valves = [3e-8, 1e-8].map(|flow_coefficient| {
        let (transition_pressure, compliance) = (1e4, 3e-15);
        let setting = 0.5;
        GasPassage::Valve(GasValve {
            setting,
            flow_coefficient,
            transition_pressure,
            compliance,
            shut: false,
        })
    });
    let of_valves = with_gas(by_volume, relaxing([None, Some(0.05)]), valves);
    let of_valve = with_gas(rig, POLYTROPIC, valves).gas[0];
    let valve_and_gas = Components { gas: [of_valve, moved(less)], ..rig };
    let moving = MachineOptions { external_force: true, moving_setting: true, ..MachineOptions::default() };
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let of = |rig, power_unit, line_models| {
        machine_of(Components { power_unit, load, line_models, ..leaking(rig, 2e-12) }, &moving)
    };
    let lumped = [LineModel::Lumped; 2];
    [
        ("gas that is moved", of(of_gas, charged_pump(40e5, 1.4), lumped)),
        ("gas with heat behind valves that move", of(of_valves, pump(), [SMEARED, PLAIN])),
        ("gas behind a valve, and moved", of(valve_and_gas, PowerUnit::Constant, lumped)),
    ]
}
