//! The servovalve's part of the list: its edges as declared or from the data sheet, flow gains,
//! slopes.

use phea_hydraulics::servovalve::{
    ChamberCoefficients, SpoolDirection, flow_coefficient_from_rating, leakage_coefficient_from_rating,
    velocity_gain,
};
use phea_hydraulics::two_pressure::{TwoPressureLinearParameters, TwoPressureModel};

use super::list::List;
use crate::project::{self, NullLeakage, Project, RatedFlow, ValveCoefficients};
use crate::rig::{Rig, is_ideal, reduced, two_pressures};
use crate::setup::Setup;

/// Unit of the coefficients of the edges.
const COEFFICIENT: &str = "m3/(s.Pa^0.5)";

/// Edges 3 to 6 with the symbols of their flow and leakage coefficients.
const EDGES: [(&str, &str, &str); 4] = [
    ("supply_to_a", "K_v3", "K_vin3"),
    ("a_to_tank", "K_v4", "K_vin4"),
    ("supply_to_b", "K_v5", "K_vin5"),
    ("b_to_tank", "K_v6", "K_vin6"),
];

/// Equations of the coefficients from a data sheet, thesis (4.12) corrected and (4.13).
const FROM_RATING: &str = "K_{vp} = q_{vn}/sqrt(Δp_{tn}/2)";
const FROM_LEAKAGE: &str = "K_{vinp} = (q_0 - q_{tare} sqrt(p_{in}/p_{tare}))/sqrt(2 p_{in})";

/// Derived quantities of the servovalve: edges, flow gains, slopes.
pub(super) fn valve(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let project = setup.project;
    list.group("Servovalve");
    if let Some(actuator) = &project.actuator {
        edges(&actuator.valve, &actuator.supply, rig, list);
    }
    unloaded_flow_gains(rig, list);
    null_leakage(rig, list);
    null_flow_gains(rig, list);
    greatest_leakage(project, list);
    let chambers = without_outward_flow(rig);
    chamber_slopes(&chambers, list);
    pressure_gain(&TwoPressureLinearParameters { chambers, ..rig.two_pressure }, list);
}

/// K_qU of an unloaded actuator that moves forward or back.
fn unloaded_flow_gains(rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let (valve, supply, cylinder) = (&components.valve, &components.supply, &components.cylinder);
    let areas = cylinder.areas_at(rig.point.position);
    let [forward, back] = list.motion.either(
        [
            "K_{qU} = A_A v/U unloaded, edges 3 and 6 carrying one flow",
            "K_{qU} = A_B v/U unloaded, edges 5 and 4 carrying one flow",
        ],
        [
            "K_{qU} = D ω/U unloaded, edges 3 and 6 carrying one flow",
            "K_{qU} = D ω/U unloaded, edges 5 and 4 carrying one flow",
        ],
    );
    let immovable = list.motion.either(
        "the supply cannot move the unloaded piston this way",
        "the supply cannot move the unloaded shaft this way",
    );
    for (name, direction, area, equation) in [
        ("valve.flow_gain_extending", SpoolDirection::Extending, areas[0], forward),
        ("valve.flow_gain_retracting", SpoolDirection::Retracting, areas[1], back),
    ] {
        match velocity_gain(valve, supply, areas, 0.0, direction) {
            Some(gain) => list.add(name, "K_qU", area * gain, "m3/(s.V)", equation),
            None => list.absent(name, "K_qU", "m3/(s.V)", equation, immovable),
        }
    }
}

/// K_c of the valve on either side of null.
fn null_leakage(rig: &Rig, list: &mut List) {
    let own = TwoPressureModel { outward: None, ..rig.model };
    let [above, below] = list.motion.either(
        [
            "A_u^2/K_c = A_A^2/K_{cA} + A_B^2/K_{cB}, U to 0 from above",
            "A_u^2/K_c = A_A^2/K_{cA} + A_B^2/K_{cB}, U to 0 from below",
        ],
        ["1/K_c = 1/K_{cA} + 1/K_{cB}, U to 0 from above", "1/K_c = 1/K_{cA} + 1/K_{cB}, U to 0 from below"],
    );
    for (name, direction, equation) in [
        ("valve.flow_pressure_coefficient_extending", SpoolDirection::Extending, above),
        ("valve.flow_pressure_coefficient_retracting", SpoolDirection::Retracting, below),
    ] {
        let parameters = reduced(&two_pressures(&own, &rig.point, direction));
        list.add(name, "K_c", parameters.flow_pressure_coefficient, "m3/(s.Pa)", equation);
    }
}

/// K_pU of the valve without any other leakage.
fn pressure_gain(valve: &TwoPressureLinearParameters, list: &mut List) {
    let without_leakage = reduced(valve);
    let (name, equation) = ("valve.pressure_gain", "K_{pU} = K_{qU}/K_c");
    if without_leakage.flow_pressure_coefficient == 0.0 {
        list.absent(name, "K_pU", "Pa/V", equation, "infinite, since the valve does not leak");
    } else {
        let pressure_gain = without_leakage.flow_gain / without_leakage.flow_pressure_coefficient;
        list.add(name, "K_pU", pressure_gain, "Pa/V", equation);
    }
}

/// K_qU of the operating point on either side of null.
fn null_flow_gains(rig: &Rig, list: &mut List) {
    let sides = [
        (
            "valve.flow_gain_above_null",
            SpoolDirection::Extending,
            list.motion.either(
                "K_{qU} = A_u (A_A K_{qA}/C_A + A_B K_{qB}/C_B)/K_H, U to 0 from above",
                "K_{qU} = D^2 (K_{qA}/C_A + K_{qB}/C_B)/K_θ, U to 0 from above",
            ),
        ),
        (
            "valve.flow_gain_below_null",
            SpoolDirection::Retracting,
            list.motion.either(
                "K_{qU} = A_u (A_A K_{qA}/C_A + A_B K_{qB}/C_B)/K_H, U to 0 from below",
                "K_{qU} = D^2 (K_{qA}/C_A + K_{qB}/C_B)/K_θ, U to 0 from below",
            ),
        ),
    ];
    for (name, direction, equation) in sides {
        list.add(name.to_string(), "K_qU", rig.flow_gain(direction), "m3/(s.V)", equation);
    }
}

/// The coefficients of the valve without the flow from the chambers to the tank, such as the case
/// leakage of a motor, which is part of those of the rig.
fn without_outward_flow(rig: &Rig) -> ChamberCoefficients {
    let chambers = rig.two_pressure.chambers;
    let outward = rig.model.outward_slopes([rig.point.pressure_a, rig.point.pressure_b]);
    let [slope_a, slope_b] = outward.unwrap_or([0.0; 2]);
    ChamberCoefficients {
        flow_pressure_a: chambers.flow_pressure_a - slope_a,
        flow_pressure_b: chambers.flow_pressure_b - slope_b,
        ..chambers
    }
}

/// K_c with the highest null leakage of the data sheet, if that gives a range.
fn greatest_leakage(project: &Project, list: &mut List) {
    let declared = project.actuator.as_ref().map(|actuator| actuator.valve.leakage);
    let Some(ValveCoefficients::Rated(NullLeakage { maximum: Some(most), .. })) = declared else { return };
    let leakiest = project.with_number("valve.null_leakage", most);
    let Some(rig) = leakiest.and_then(|leakiest| Setup::rig_of(&leakiest).ok()) else { return };
    let own = TwoPressureModel { outward: None, ..rig.model };
    for (name, direction) in
        [("extending", SpoolDirection::Extending), ("retracting", SpoolDirection::Retracting)]
    {
        let parameters = reduced(&two_pressures(&own, &rig.point, direction));
        list.add(
            format!("valve.flow_pressure_coefficient_{name}_maximum"),
            "K_c",
            parameters.flow_pressure_coefficient,
            "m3/(s.Pa)",
            "the same with `null_leakage_maximum`",
        );
    }
}

fn chamber_slopes(chambers: &ChamberCoefficients, list: &mut List) {
    list.add(
        "valve.flow_gain_a",
        "K_qA",
        chambers.flow_gain_a,
        "m3/(s.V)",
        "K_{qA} = dq_A/dU at the operating point",
    );
    list.add(
        "valve.flow_gain_b",
        "K_qB",
        chambers.flow_gain_b,
        "m3/(s.V)",
        "K_{qB} = -dq_B/dU at the operating point",
    );
    list.add(
        "valve.flow_pressure_a",
        "K_cA",
        chambers.flow_pressure_a,
        "m3/(s.Pa)",
        "K_{cA} = -dq_A/dp_A at the operating point",
    );
    list.add(
        "valve.flow_pressure_b",
        "K_cB",
        chambers.flow_pressure_b,
        "m3/(s.Pa)",
        "K_{cB} = -dq_B/dp_B at the operating point",
    );
}

/// The coefficients of the edges; next to the value from the data sheet, the mean of the declared
/// ones.
fn edges(declared: &project::Valve, supply: &project::DeclaredSupply, rig: &Rig, list: &mut List) {
    let valve = &rig.actuator.components().valve;
    let origin = |is_declared, equation| if is_declared { "declared" } else { equation };
    let flow_origin = origin(declared.flow.edges().is_some(), FROM_RATING);
    let leakage_origin = origin(declared.leakage.edges().is_some(), FROM_LEAKAGE);
    for ((name, symbol, _), value) in EDGES.into_iter().zip(valve.flow_coefficients.to_array()) {
        list.add(format!("valve.flow_coefficient_{name}"), symbol, value, COEFFICIENT, flow_origin);
    }
    let leaking = if is_ideal(valve) { [0.0; 4] } else { valve.leakage_coefficients.to_array() };
    for ((name, _, symbol), value) in EDGES.into_iter().zip(leaking) {
        list.add(format!("valve.leakage_coefficient_{name}"), symbol, value, COEFFICIENT, leakage_origin);
    }
    let mean = |edges: [f64; 4]| edges.iter().sum::<f64>() / 4.0;
    if let ValveCoefficients::Edges { edges, rating: Some(RatedFlow { flow, pressure_drop }) } = declared.flow
    {
        // the data sheet's flow is that of full travel
        let [positive, negative] = valve.opening.full();
        let rated = flow_coefficient_from_rating(flow, pressure_drop) / f64::midpoint(positive, negative);
        list.add("valve.flow_coefficient_rated", "K_vp", rated, COEFFICIENT, FROM_RATING);
        list.stated(mean(edges.to_array()), "[valve.flow_coefficients], the mean of its edges", None);
    }
    if let ValveCoefficients::Edges { edges, rating: Some(NullLeakage { flow, pressure, .. }) } =
        declared.leakage
    {
        let tare = declared.tare_drop(supply);
        let rated = leakage_coefficient_from_rating(flow, declared.tare_flow, tare, pressure);
        list.add("valve.leakage_coefficient_rated", "K_vinp", rated, COEFFICIENT, FROM_LEAKAGE);
        list.stated(mean(edges.to_array()), "[valve.leakage_coefficients], the mean of its edges", None);
    }
    if declared.tare_flow > 0.0 {
        let supply = &rig.actuator.components().supply;
        let flow = phea_hydraulics::servovalve::tare_flow(valve, supply);
        list.add(
            "valve.tare_flow",
            "q_tare",
            flow,
            "m3/s",
            "q_{tare}(p_S) = q_{tare} sqrt((p_S - p_T)/p_{tare})",
        );
    }
}
