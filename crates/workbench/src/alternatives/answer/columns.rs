//! Numbers by which alternatives are compared, for programs.

use phea_qft::verification::Verdict;

use super::super::words::{judge_error_words, no_number_words, undecided_words};
use super::super::{AlternativeColumn, ColumnKey, ColumnPart, JudgedAlternative};
use crate::answer::{Answer, OrReason};
use crate::linearize::{PassivityAnswer, no_closed_impedance_words, passivity_body};
use crate::specification::subject_words;

/// Numbers by which alternatives are compared.
#[derive(Answer)]
pub(super) struct AlternativeColumnsAnswer {
    /// True if the designed loop satisfies every specification and the nonlinear rig every
    /// requirement in time.
    feasible: OrReason<bool>,
    /// Verdict on the stability of the designed loop with the load of the alternative.
    stable_with_its_load: OrReason<Verdict>,
    #[answer(flatten)]
    of_loop: LoopColumnsAnswer,
    #[answer(flatten)]
    rig: RigColumnsAnswer,
    /// ISO 4217 code of the currency of the prices, if a price is stated.
    #[answer(optional)]
    parts_currency: Option<&'static str>,
    /// Specifications in the order of the file; empty if there is no design.
    specifications: Vec<SpecificationColumnsAnswer>,
    /// Scenarios with the designed controller.
    scenarios: Vec<ScenarioColumnsAnswer>,
    /// Driving-point impedance at the load at each requested frequency.
    impedance: Vec<ImpedanceColumnsAnswer>,
    /// Passivity of the driving-point impedance at the load.
    passivity: AlternativePassivityAnswer,
}

/// Numbers of a designed loop.
#[derive(Answer)]
pub(super) struct LoopColumnsAnswer {
    /// Relaxation of every limit with which the specifications can be satisfied; 0 if they are
    /// satisfied.
    relaxation_db: OrReason<f64>,
    /// Order of the controller.
    order: OrReason<i64>,
    /// Order of the prefilter.
    prefilter_order: OrReason<i64>,
    /// Relative degree of the controller.
    relative_degree: OrReason<i64>,
    /// High-frequency gain of the controller.
    high_frequency_gain_db: OrReason<f64>,
    /// Modulus margin of the designed loop.
    modulus_margin: OrReason<f64>,
    /// Delay margin of the designed loop.
    delay_margin_s: OrReason<f64>,
}

/// Numbers of a rig.
#[derive(Answer)]
pub(super) struct RigColumnsAnswer {
    /// Least hydraulic stiffness over the stroke.
    #[answer(key = ColumnKey::StiffnessMinimum.quantity())]
    stiffness_minimum: OrReason<f64>,
    /// Greatest hydraulic stiffness over the stroke.
    #[answer(key = ColumnKey::StiffnessMaximum.quantity())]
    stiffness_maximum: OrReason<f64>,
    /// Stiffness of oil and force sensor in series at the operating point.
    #[answer(key = ColumnKey::EquivalentStiffness.quantity())]
    equivalent_stiffness: OrReason<f64>,
    /// Retracted length of the actuator.
    actuator_length_m: OrReason<f64>,
    /// Length of both lines together.
    lines_length_m: OrReason<f64>,
    /// Moving mass or inertia of the actuator.
    #[answer(key = ColumnKey::MovingMass.quantity())]
    moving_mass: OrReason<f64>,
    /// Volume of the oil in both lines.
    lines_volume_m3: OrReason<f64>,
    /// Volume of the oil in lines, chambers, accumulators and a transmission.
    oil_volume_m3: OrReason<f64>,
    /// Mass of that oil.
    oil_mass_kg: OrReason<f64>,
    /// Volume of the gas of the accumulators at the chambers, at their precharge.
    gas_volume_m3: OrReason<f64>,
    /// Hydraulic power of the rig at rest.
    power_at_rest_w: OrReason<f64>,
    /// Price of the parts, in the currency `parts_currency`.
    parts_price: OrReason<f64>,
    /// Mass of the parts and of the oil in the lines.
    parts_mass_kg: OrReason<f64>,
    /// Length of line A of the best hose by `[sizing]`.
    sized_length_m: OrReason<f64>,
    /// Proportional gain with the best hose by `[sizing]`.
    #[answer(key = ColumnKey::SizedGain.quantity())]
    sized_gain: OrReason<f64>,
}

/// Margin to a specification.
#[derive(Answer)]
pub(super) struct SpecificationColumnsAnswer {
    /// Name of the specification.
    name: &'static str,
    /// Least margin to the specification.
    worst_margin_db: OrReason<f64>,
}

/// Greatest values of all events of a scenario.
#[derive(Answer)]
pub(super) struct ScenarioColumnsAnswer {
    /// Name of the scenario.
    name: String,
    /// Greatest overshoot, of the step.
    overshoot_percent: OrReason<f64>,
    /// Longest settling time.
    settling_time_s: OrReason<f64>,
    /// Greatest deviation of the force or torque after a disturbance.
    #[answer(key = ColumnKey::DisturbancePeak.quantity())]
    disturbance_peak: OrReason<f64>,
    /// Greatest magnitude of the command.
    control_peak_v: OrReason<f64>,
    /// Greatest root mean square of the command.
    control_rms_v: OrReason<f64>,
    /// Energy from the supply over the scenario, including the tare flow.
    energy_from_supply_j: OrReason<f64>,
}

/// Driving-point impedance at the load at one frequency.
#[derive(Answer)]
pub(super) struct ImpedanceColumnsAnswer {
    /// Frequency of the impedance.
    frequency_rad_per_s: f64,
    /// Magnitude with constant command.
    #[answer(key = ColumnKey::ImpedanceOpen.quantity())]
    impedance_open: OrReason<f64>,
    /// Magnitude with the designed controller.
    #[answer(key = ColumnKey::ImpedanceClosed.quantity())]
    impedance_closed: OrReason<f64>,
    /// Magnitude of the required virtual impedance, if there is one.
    #[answer(key = ColumnKey::ImpedanceRequired.quantity())]
    #[answer(optional)]
    impedance_required: Option<OrReason<f64>>,
}

/// Passivity of the driving-point impedance at the load.
#[derive(Answer)]
struct AlternativePassivityAnswer {
    /// Passivity with constant command.
    open_loop: OrReason<PassivityAnswer>,
    /// Passivity with the designed controller.
    closed_loop: OrReason<PassivityAnswer>,
}

pub(super) fn columns(one: &JudgedAlternative) -> AlternativeColumnsAnswer {
    let all = one.columns().0;
    let feasible = one.feasible();
    let reason = if feasible.is_some() { String::new() } else { undecided_words(one) };
    let stability = one.design.as_ref().map(|view| view.designed.view.audit.stability.verdict);
    AlternativeColumnsAnswer {
        feasible: OrReason::new(feasible, reason),
        stable_with_its_load: OrReason(stability.map_err(judge_error_words)),
        of_loop: loop_columns(&PartColumns::of(&all, &ColumnPart::Loop)),
        rig: rig_columns(&PartColumns::of(&all, &ColumnPart::Rig)),
        parts_currency: one.counted.currency.map(|currency| currency.code()),
        specifications: parts(&all).filter_map(|part| specification(&all, part)).collect(),
        scenarios: parts(&all).filter_map(|part| scenario(&all, part)).collect(),
        impedance: parts(&all).filter_map(|part| impedance(&all, part)).collect(),
        passivity: passivity(one),
    }
}

/// Parts of an alternative, each once, in the order of their first columns.
fn parts(all: &[(ColumnPart, AlternativeColumn)]) -> impl Iterator<Item = &ColumnPart> {
    let is_first =
        move |index: usize, part: &ColumnPart| all.iter().take(index).all(|(other, _)| other != part);
    all.iter().enumerate().filter(move |(index, (part, _))| is_first(*index, part)).map(|(_, (part, _))| part)
}

/// Columns of a part of an alternative.
struct PartColumns<'c>(Vec<&'c AlternativeColumn>);

impl<'c> PartColumns<'c> {
    fn of(all: &'c [(ColumnPart, AlternativeColumn)], part: &ColumnPart) -> PartColumns<'c> {
        PartColumns(all.iter().filter(|(own, _)| own == part).map(|(_, column)| column).collect())
    }

    fn find(&self, key: ColumnKey) -> Option<OrReason<f64>> {
        let found = self.0.iter().find(|column| column.key == key)?;
        Some(OrReason(found.value.as_ref().copied().map_err(no_number_words)))
    }

    fn number(&self, key: ColumnKey) -> OrReason<f64> {
        self.find(key).unwrap_or(OrReason(Err(String::new())))
    }

    fn whole(&self, key: ColumnKey) -> OrReason<i64> {
        OrReason(self.number(key).0.map(|value| value as i64))
    }
}

fn loop_columns(columns: &PartColumns<'_>) -> LoopColumnsAnswer {
    LoopColumnsAnswer {
        relaxation_db: columns.number(ColumnKey::Relaxation),
        order: columns.whole(ColumnKey::Order),
        prefilter_order: columns.whole(ColumnKey::PrefilterOrder),
        relative_degree: columns.whole(ColumnKey::RelativeDegree),
        high_frequency_gain_db: columns.number(ColumnKey::HighFrequencyGain),
        modulus_margin: columns.number(ColumnKey::ModulusMargin),
        delay_margin_s: columns.number(ColumnKey::DelayMargin),
    }
}

fn rig_columns(columns: &PartColumns<'_>) -> RigColumnsAnswer {
    RigColumnsAnswer {
        stiffness_minimum: columns.number(ColumnKey::StiffnessMinimum),
        stiffness_maximum: columns.number(ColumnKey::StiffnessMaximum),
        equivalent_stiffness: columns.number(ColumnKey::EquivalentStiffness),
        actuator_length_m: columns.number(ColumnKey::ActuatorLength),
        lines_length_m: columns.number(ColumnKey::LinesLength),
        moving_mass: columns.number(ColumnKey::MovingMass),
        lines_volume_m3: columns.number(ColumnKey::LinesVolume),
        oil_volume_m3: columns.number(ColumnKey::OilVolume),
        oil_mass_kg: columns.number(ColumnKey::OilMass),
        gas_volume_m3: columns.number(ColumnKey::GasVolume),
        power_at_rest_w: columns.number(ColumnKey::PowerAtRest),
        parts_price: columns.number(ColumnKey::PartsPrice),
        parts_mass_kg: columns.number(ColumnKey::PartsMass),
        sized_length_m: columns.number(ColumnKey::SizedLength),
        sized_gain: columns.number(ColumnKey::SizedGain),
    }
}

fn specification(
    all: &[(ColumnPart, AlternativeColumn)],
    part: &ColumnPart,
) -> Option<SpecificationColumnsAnswer> {
    let ColumnPart::Specification(_, name) = part else { return None };
    let worst_margin_db = PartColumns::of(all, part).number(ColumnKey::WorstMargin);
    Some(SpecificationColumnsAnswer { name: subject_words(*name), worst_margin_db })
}

fn scenario(all: &[(ColumnPart, AlternativeColumn)], part: &ColumnPart) -> Option<ScenarioColumnsAnswer> {
    let ColumnPart::Scenario(name) = part else { return None };
    let columns = PartColumns::of(all, part);
    Some(ScenarioColumnsAnswer {
        name: name.clone(),
        overshoot_percent: columns.number(ColumnKey::Overshoot),
        settling_time_s: columns.number(ColumnKey::SettlingTime),
        disturbance_peak: columns.number(ColumnKey::DisturbancePeak),
        control_peak_v: columns.number(ColumnKey::ControlPeak),
        control_rms_v: columns.number(ColumnKey::ControlRms),
        energy_from_supply_j: columns.number(ColumnKey::EnergyFromSupply),
    })
}

fn impedance(all: &[(ColumnPart, AlternativeColumn)], part: &ColumnPart) -> Option<ImpedanceColumnsAnswer> {
    let ColumnPart::Impedance(frequency_rad_per_s) = *part else { return None };
    let columns = PartColumns::of(all, part);
    Some(ImpedanceColumnsAnswer {
        frequency_rad_per_s,
        impedance_open: columns.number(ColumnKey::ImpedanceOpen),
        impedance_closed: columns.number(ColumnKey::ImpedanceClosed),
        impedance_required: columns.find(ColumnKey::ImpedanceRequired),
    })
}

/// Passivity of the impedance at the load, as `linearize` returns it.
fn passivity(one: &JudgedAlternative) -> AlternativePassivityAnswer {
    let linearization = one.linearization.as_ref();
    let failed = linearization.err().map_or(String::new(), |reason| reason.to_string());
    let open = linearization.ok().map(|found| passivity_body(&found.open_loop.passivity));
    let closed = linearization.ok().and_then(|found| found.closed_loop.as_ref());
    let closed = closed.filter(|_| one.deployed.is_ok());
    let absent = linearization.ok().and_then(|found| found.closed_loop_absent).map(no_closed_impedance_words);
    let absent = one.deployed.as_ref().err().map(|reason| reason.to_string()).or(absent.map(str::to_string));
    AlternativePassivityAnswer {
        open_loop: OrReason::new(open, &failed),
        closed_loop: OrReason::new(
            closed.map(|view| passivity_body(&view.passivity)),
            absent.unwrap_or_else(|| failed.clone()),
        ),
    }
}
