//! The names and sentences of a sizing.

use phea_engineering::rig::{FlowLimit, LargestFlow};
use phea_engineering::sizing::{
    Branch, CoilUnknown, HoseName, Influence, SizedLoad, SizedSystem, Sizing, SizingReason, SizingStep,
    SoonerRequirement, TimeConstantOrigin, UncertainHoseNumber, UnlikeLines,
};
use phea_hydraulics::stiffness::StiffnessModel;

use crate::answer::significant;
use crate::caveat::port_valve_in_sizing;
use crate::document::Cell;
use crate::quantity::{DisplayUnit, Units};

/// Declared effects that the procedure does not include, in sentences.
pub(crate) fn warnings(sizing: &Sizing, units: &Units) -> Vec<String> {
    sizing.port_valves.iter().map(|(side, valve)| port_valve_in_sizing(*side, valve, units)).collect()
}

/// The model's name in the project file.
pub(crate) fn model_name(model: StiffnessModel) -> &'static str {
    match model {
        StiffnessModel::Uniform => "uniform",
        StiffnessModel::ByVolume => "by_volume",
    }
}

/// The name of a hose or a dash size; both names if the hoses differ.
pub(crate) fn hose_name(name: &HoseName) -> String {
    let one = |name: &Option<String>| name.as_deref().unwrap_or("the project's hose").to_string();
    match name {
        HoseName::Both(name) => one(name),
        HoseName::Each([a, b]) => format!("{} in line A, {} in line B", one(a), one(b)),
    }
}

/// The length of each line with these significant digits.
pub(crate) fn length_words(branch: &Branch, digits: usize) -> String {
    let [length_a, length_b] = branch.lengths_m.map(|length| significant(length, digits));
    match branch.is_alike() {
        true => format!("{length_a} m a line"),
        false => format!("{length_a} m in line A and {length_b} m in line B"),
    }
}

/// The uncertain number, with its symbol.
pub(crate) fn uncertain_name(quantity: UncertainHoseNumber) -> &'static str {
    match quantity {
        UncertainHoseNumber::DynamicStiffening => "dynamic stiffening r_β",
        UncertainHoseNumber::FluidBulkModulus => "fluid bulk modulus β_0",
        UncertainHoseNumber::VolumetricExpansion => "volumetric expansion E",
    }
}

/// Low, nominal and high, with their unit.
pub(super) fn setting_cell(influence: &Influence) -> Cell {
    let [low, nominal, high] = influence.values;
    let [low, nominal] = [low, nominal].map(|value| Cell::number_in(value, 4, influence.unit));
    Cell::listed([low, nominal, Cell::quantity(high, 4, influence.unit)], " · ")
}

/// Reason why the winding of a spring is not known.
pub(crate) fn coil_unknown_words(reason: CoilUnknown) -> &'static str {
    match reason {
        CoilUnknown::NotStated => "not stated: sizing.other_means.coil",
        CoilUnknown::TooFewCoils => {
            "fewer than two active coils, whose ends would decide the stiffness: take a smaller index, a lower stress, or disc springs"
        }
    }
}

/// The reason for or against a candidate, with its numbers.
pub(super) fn reason_words(reason: &SizingReason) -> String {
    let three = |value: f64| significant(value, 3);
    let bar = |pressure: f64| DisplayUnit::BAR.number(pressure, 3);
    match *reason {
        SizingReason::OilTooFast { velocity, fastest } => {
            format!("oil runs at {} m/s, above {fastest} m/s", three(velocity))
        }
        SizingReason::OilSlow { velocity, slowest } => {
            let velocity = three(velocity);
            format!("oil runs at {velocity} m/s, below {slowest} m/s: a smaller bore would carry the flow")
        }
        SizingReason::NoHoseNeeded(model) => no_hose_words(model),
        SizingReason::TooShort { length, shortest } => {
            format!("{} m a line is shorter than the acceptable {shortest} m", three(length))
        }
        SizingReason::TooLong { length, longest } => {
            format!("{} m a line is longer than the acceptable {longest} m", three(length))
        }
        SizingReason::BeyondStock { both, stock } => {
            format!("both lines take {} m, the stock is {stock} m", three(both))
        }
        SizingReason::RigidTooSlow { gain, pole_gain } => {
            let [gain, pole] = [gain, pole_gain].map(three);
            format!("K_p = {gain} V/N is not above {pole} V/N, where even a rigid transmission is too slow")
        }
        SizingReason::GainTooSmall { gain, minimum_gain } => {
            let [gain, least] = [gain, minimum_gain].map(three);
            format!("K_p = {gain} V/N is below the practical {least} V/N: the valve would hardly be driven")
        }
        SizingReason::PressureUnknown { peak, supply } => unknown_pressure_words([peak, supply].map(bar)),
        SizingReason::BelowSupply { working, supply } => {
            format!("working pressure {} bar is below the supply's {} bar", bar(working), bar(supply))
        }
        SizingReason::BelowSurge { working, peak } => {
            format!("working pressure {} bar is below supply and surge, {} bar", bar(working), bar(peak))
        }
        SizingReason::ExpansionExtrapolated { stated, supply } => expansion_words([stated, supply].map(bar)),
        SizingReason::ShorterThanBend { radius, quarter_turn } => bend_words(radius, quarter_turn),
        SizingReason::StaticWall => STATIC_WALL.to_string(),
        SizingReason::DeadBand { fraction } => dead_band_words(fraction),
        SizingReason::NullSides { flow_gains, time_constants } => {
            null_sides_words(flow_gains.map(three), time_constants.map(three))
        }
        SizingReason::SlowLoop { time_constant, desired } => {
            let [own, desired] = [time_constant, desired].map(three);
            format!("the closed loop's time constant is {own} s, slower than {desired} s")
        }
        SizingReason::SteadyStateGain { at_null, at_largest } => {
            steady_state_words([at_null, at_largest].map(|gain| three(100.0 * gain)))
        }
    }
}

const STATIC_WALL: &str = "[line] declares no `dynamic_stiffening`: the wall has its static modulus, and a stiffer one takes more hose";

fn no_hose_words(model: StiffnessModel) -> String {
    let why = match model {
        StiffnessModel::Uniform => "by this model the oil in the chambers alone, with the hose's modulus,",
        StiffnessModel::ByVolume => "with rigid lines the actuator",
    };
    format!("no hose is needed: {why} is already as compliant as this asks for")
}

fn unknown_pressure_words([peak, supply]: [String; 2]) -> String {
    format!(
        "no working pressure is stated: the hose must withstand {peak} bar with surge ({supply} bar supply); state `working_pressure`"
    )
}

fn expansion_words([stated, supply]: [String; 2]) -> String {
    format!(
        "its expansion is stated at {stated} bar, and the supply has {supply} bar: in between it is carried on along its slope"
    )
}

fn bend_words(radius: f64, quarter_turn: f64) -> String {
    format!(
        "a bend of 90 degrees at the least radius of {} mm takes {} m, more than the hose has",
        DisplayUnit::MILLIMETRE.number(radius, 3),
        significant(quarter_turn, 3)
    )
}

fn dead_band_words(fraction: f64) -> String {
    format!(
        "the edges of the valve overlap, and K_qU at null, which is sized with, is {} % of that beyond the lap: a loop of this gain is unstable \
         there. State the gain beyond the lap, `sizing.flow_gain`, and its `flow_pressure_coefficient`",
        significant(100.0 * fraction, 2)
    )
}

fn null_sides_words([retracting, extending]: [String; 2], [below, above]: [String; 2]) -> String {
    format!(
        "K_qU at null is {retracting} m3/(s.V) retracting and {extending} extending, and its mean is sized with: the time constant is {below} s and {above} s"
    )
}

fn steady_state_words([at_null, at_largest]: [String; 2]) -> String {
    format!(
        "a proportional loop reaches only {at_null} % of the reference at null and {at_largest} % at the largest K_c: integral action is needed"
    )
}

/// The decisions in order, each with its letter in the flowchart, section 6.3.2.
pub(super) fn decisions(steps: &[SizingStep]) -> Vec<(&'static str, String)> {
    steps.iter().flat_map(step_words).collect()
}

fn step_words(step: &SizingStep) -> Vec<(&'static str, String)> {
    match step {
        SizingStep::SystemData(system) => vec![("a", system_words(system))],
        SizingStep::TimeConstant { time_constant, origin, sooner } => {
            vec![("b", time_constant_words(*time_constant, origin, sooner.as_ref()))]
        }
        SizingStep::OilVelocity([slowest, fastest]) => vec![(
            "c.2",
            format!(
                "Oil velocity {slowest} to {fastest} m/s: a bore with faster oil is rejected, one with slower oil only warned of."
            ),
        )],
        SizingStep::LowPressureLines { velocity, return_flow, return_bores, suction_bores } => {
            let [slowest, fastest] = velocity;
            let bores = |[small, large]: [f64; 2]| {
                let [small, large] = [small, large].map(|bore| DisplayUnit::MILLIMETRE.number(bore, 3));
                format!("{small} to {large} mm")
            };
            let text = format!(
                "Return and suction lines carry oil at {slowest} to {fastest} m/s: bores of {} for the return line of {} L/min, of {} for suction.",
                bores(*return_bores),
                DisplayUnit::LITRE_PER_MINUTE.number(*return_flow, 4),
                bores(*suction_bores)
            );
            vec![("c.2", text)]
        }
        SizingStep::Bores { flow, range, feasible } => {
            let [smallest, largest] = range.map(|bore| DisplayUnit::MILLIMETRE.number(bore, 3));
            let names: Vec<String> = feasible.iter().map(hose_name).collect();
            let text = format!(
                "Largest flow {} L/min ({}): bores from {smallest} to {largest} mm; on the market there are {}.",
                DisplayUnit::LITRE_PER_MINUTE.number(flow.line(), 4),
                flow_origin(flow),
                if names.is_empty() { "none".to_string() } else { names.join(", ") }
            );
            vec![("c.3", text)]
        }
        SizingStep::Search { maximum_gain, available_length, minimum_gain, pole_gain } => {
            let text = format!(
                "K_p starts at {} V/N and is halved while the hose is longer than {} m, but not below {} V/N; at {} V/N even a rigid transmission would be too slow (K_H infinite).",
                significant(*maximum_gain, 3),
                significant(*available_length, 4),
                significant(*minimum_gain, 3),
                significant(*pole_gain, 3)
            );
            vec![("f", text)]
        }
        SizingStep::Branch(name, branch) => {
            let own = format!("{}, {}", hose_name(name), model_name(branch.model));
            let each = branch_words(branch).into_iter();
            each.map(|(letters, text)| (letters, format!("{own}: {text}"))).collect()
        }
    }
}

fn system_words(system: &SizedSystem) -> String {
    let number = |value| significant(value, 4);
    format!(
        "System data: A_u = {} cm2, stroke {} mm, β_0 = {} GPa, {}, K_qU = {} m3/(s.V), K_c0 = {} m3/(s.Pa){}; {}.",
        DisplayUnit::SQUARE_CENTIMETRE.number(system.useful_area, 4),
        DisplayUnit::MILLIMETRE.number(system.stroke, 4),
        DisplayUnit::GIGAPASCAL.number(system.fluid_modulus, 4),
        sensor_words(system),
        number(system.flow_gain),
        number(system.flow_pressure_coefficient),
        match system.internal_leakage {
            0.0 => String::new(),
            leakage => format!(" with {} m3/(s.Pa) from chamber to chamber", number(leakage)),
        },
        match system.unlike {
            None => "both lines alike",
            Some(UnlikeLines::HosesDiffer) => {
                "the lines differ: each is sized so that both have the same compliance"
            }
            Some(UnlikeLines::LineBIsNoHose) => {
                "line B is not declared as a hose: hoses are sized for both lines"
            }
            Some(UnlikeLines::LineAIsNoHose) => {
                "line A is not declared as a hose: hoses are sized for both lines"
            }
        }
    )
}

/// K_S, and its value in series with the load.
fn sensor_words(system: &SizedSystem) -> String {
    let unit = DisplayUnit::MEGANEWTON_PER_METRE;
    let sensor = format!("K_S = {}", unit.text(system.sensor_without_load, 4));
    match system.load {
        SizedLoad::Prescribed => sensor,
        SizedLoad::Yielding { stiffness } => format!(
            "{sensor} in series with the load's {}: {}",
            unit.text(stiffness, 4),
            unit.text(system.sensor_stiffness, 4)
        ),
        SizedLoad::HeldStill => format!("{sensor}, the load held still, as no stiffness holds it"),
    }
}

fn time_constant_words(
    time_constant: f64,
    origin: &TimeConstantOrigin,
    sooner: Option<&SoonerRequirement>,
) -> String {
    let origin = match origin {
        TimeConstantOrigin::Stated => "stated".to_string(),
        TimeConstantOrigin::Settling { settling_time, band_percent, constants } => format!(
            "{} s to {band_percent} % is {} time constants of a first-order response (the thesis takes four whatever the band: for its numbers state `time_constant`)",
            significant(*settling_time, 4),
            significant(*constants, 3)
        ),
    };
    let sooner = sooner.map_or(String::new(), |one| {
        format!(
            "; that settles within {} % in {} s, and specification {} requires it in {} s",
            one.band_percent,
            significant(one.settles, 4),
            one.specification,
            one.required
        )
    });
    let time_constant = DisplayUnit::MILLISECOND.number(time_constant, 4);
    format!("Time constant τ_d = {time_constant} ms: {origin}{sooner}.")
}

/// The decisions of steps f to l for one hose and one stiffness model.
fn branch_words(branch: &Branch) -> Vec<(&'static str, String)> {
    let number = |value| significant(value, 4);
    let [own_length, own_stiffness, own_gain] =
        [length_words(branch, 4), number(branch.stiffness.minimum), number(branch.gain_v_per_n)];
    if !branch.by_gain {
        let text = format!(
            "{own_length} gives K_H = {own_stiffness} N/m at its least (6.26), which needs K_p = {own_gain} V/N (6.27)."
        );
        return vec![("k, l", text)];
    }
    let Some((end, _)) = branch.steps.split_last() else { return vec![] };
    let mut decided: Vec<(&'static str, String)> =
        too_long_words(branch).map(|text| ("g, h", text)).into_iter().collect();
    let (gain, stiffness) = (number(end.gain_v_per_n), number(end.stiffness_n_per_m));
    if end.stiffness_n_per_m == f64::INFINITY {
        decided.push(("i, j", format!("at K_p = {gain} V/N even a rigid transmission is too slow (6.16).")));
        return decided;
    }
    let length = match end.length_m {
        0.0 => "for which no hose is needed".to_string(),
        length if branch.is_alike() => format!("which {} m of hose per line gives (6.25)", number(length)),
        _ => format!("which {own_length} gives, both lines of the same compliance"),
    };
    decided.push(("i, j", format!("K_p = {gain} V/N requires K_H = {stiffness} N/m (6.16), {length}.")));
    // Lengths that differ by the search's rounding are one length.
    if (branch.lengths_m[0] - end.length_m).abs() > 1e-6 {
        let text = format!(
            "cut to {own_length}, which gives K_H = {own_stiffness} N/m and needs K_p = {own_gain} V/N."
        );
        decided.push(("i", text));
    }
    decided
}

/// The trials whose hose is too long; `None` if the first one is not.
fn too_long_words(branch: &Branch) -> Option<String> {
    let number = |value| significant(value, 4);
    let (_, trials) = branch.steps.split_last()?;
    let (first, last) = (trials.first()?, trials.last()?);
    let halved = match trials.len() {
        1 => String::new(),
        count => format!(
            "; so does every successive halving down to {} V/N with {} m, {count} trials",
            number(last.gain_v_per_n),
            number(last.length_m)
        ),
    };
    Some(format!(
        "K_p = {} V/N asks for {} m of hose {} (6.16, 6.25), too long{halved}.",
        number(first.gain_v_per_n),
        number(first.length_m),
        if branch.is_alike() { "per line" } else { "in line A" }
    ))
}

/// Origin of the largest flow of a line.
fn flow_origin(flow: &LargestFlow) -> String {
    let litres = |value: f64| format!("{} L/min", DisplayUnit::LITRE_PER_MINUTE.number(value, 4));
    let valve = "the valve's, fully open at this supply without load";
    match (flow.limit, flow.pump) {
        (FlowLimit::Pump, Some((pump, _))) => {
            let through = match flow.line() > pump * (1.0 + 1e-9) {
                true => format!("the pump's {} times the ratio of the areas", litres(pump)),
                false => "the pump's".to_string(),
            };
            format!("{through}; the valve passes up to {} without load", litres(flow.valve))
        }
        (_, Some((pump, true))) => {
            format!("{valve}; the pump gives {}, and the supply's accumulator more for a time", litres(pump))
        }
        (_, Some((pump, false))) => format!("{valve}; the pump gives {}", litres(pump)),
        (_, None) => valve.to_string(),
    }
}
