//! Comparison of the linear models of a rig: two-pressure, fifth order (6.7), decomposed (6.12),
//! first order (6.13); their omissions, the impedance at the load, and its passivity.

mod agreement;
mod linkage;
mod over_force;
mod port;
mod sweep;

use std::f64::consts::FRAC_PI_2;

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, Timing};
use phea_dynamics::frequency::{PassivityReport, logarithmic_grid, passivity};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_hydraulics::accumulator::ChamberGas;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::impedance::{
    Asymptote, closed_loop_impedance, closed_loop_port, final_force_after_load_step, load_motion_of,
    open_loop_impedance, port,
};
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::linear::{
    LinearModel, MechanicalDamping, ModeContribution, ResponseDifference, decomposed_model, dominance,
    first_order_model, linear_model, response_difference, transfer_functions,
};
use phea_hydraulics::plant::ChamberDynamics;
use phea_hydraulics::stiffness::{
    ModelDifference, StiffnessModel, StrokeStiffness, hydraulic_stiffness, model_difference,
};

pub use agreement::AgreementBand;
pub use agreement::{FIRST_ORDER, LUMPED, WITHIN_DB, WITHIN_DEG};
pub use linkage::{LinkagePlace, LinkagePosition, linkage_places};
pub use over_force::{StiffnessOverForce, stiffness_over_force};
pub use port::{
    ComparedImpedance, HidingMass, REPORTED_AT_RAD_PER_S, RequiredImpedance, WITHIN_PERCENT, hidden_above,
};
pub use sweep::{
    NoBandwidth, NoSweptModels, POINTS, Sweep, SweepError, SweepPoint, SweepRequest, Swept, sweep,
};
pub(crate) use sweep::{points, range, values};

use crate::quantity::MotionKind;
use crate::rig::Rig;

/// Frequency up to which the thesis compares its models, rad/s.
const COMPARISON_END: f64 = 1000.0;

/// All linear models and properties of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Motion of the rig.
    pub motion: MotionKind,
    /// Stiffness over the stroke by the project's model: nominal, softest and stiffest wall.
    pub stiffness: [StrokeStiffness; 3],
    /// Both stiffness models for comparison, nominal.
    pub stiffness_models: ModelDifference,
    /// Plant of every verdict: with its load, its leakage, and the parameters in use.
    pub plant: LinearModel,
    /// True if 6.7 is the plant: one load pressure, no flow from chamber to chamber, a load whose
    /// motion is prescribed.
    pub plant_is_fifth_order: bool,
    /// True if the load can move under force: in the models from [`Linearization::two_pressure`] to
    /// [`Linearization::decomposed`] the load is at rest.
    pub load_yields: bool,
    /// True if the stiffness of the load is part of [`Linearization::first_order`]: false for a
    /// load without a stiffness.
    pub first_order_has_load: bool,
    /// Linearised two-pressure model of the actuator as declared, with the leakage from chamber to
    /// chamber, at its operating point, the load at rest.
    pub two_pressure: LinearModel,
    /// Fifth-order model with the parameters in use, equation 6.7; K_c includes the leakage from
    /// chamber to chamber.
    pub full: LinearModel,
    /// Fifth-order model with the derived parameters, with which the two-pressure model is
    /// compared.
    pub derived_full: LinearModel,
    /// Fifth-order model with the derived parameters and the load: equal to the plant of a project
    /// that states no parameter, except for the second chamber pressure.
    pub derived_plant: TransferFunction,
    /// Equation 6.12 as printed, and with the damping corrected.
    pub decomposed: [TransferFunction; 2],
    /// Equation 6.13, with the stiffness of the load in series.
    pub first_order: TransferFunction,
    /// The bands in which each reduction agrees with the plant.
    pub agreement: Vec<AgreementBand>,
    /// Difference between the fifth-order and the two-pressure model, both with derived parameters.
    pub reduction: ReductionDifference,
    /// Equation 6.12 as printed against 6.7.
    pub printed_decomposition: ReductionDifference,
    /// Equation 6.12 corrected against 6.7.
    pub corrected_decomposition: ReductionDifference,
    /// Equation 6.13 against 6.7, both with the load at rest.
    pub truncation: ReductionDifference,
    /// Fraction of each mode in the step response of the plant.
    pub modes: Vec<ModeContribution>,
    /// The impedance at the load with constant command.
    pub open_loop: PortView,
    /// The impedance at the load with the given controller, if it is continuous and without dead
    /// time.
    pub closed_loop: Option<PortView>,
    /// Reason why there is no closed loop.
    pub closed_loop_absent: Option<NoClosedImpedance>,
    /// Impedance required at the port by a virtual impedance, and the impedance of the loop there;
    /// `None` without a virtual impedance, or without a controller.
    pub required_impedance: Option<RequiredImpedance>,
    /// The linkage over the stroke; empty without one.
    pub linkage: Vec<LinkagePlace>,
    /// Frequency above which the piston's mass hides the compliance, rad/s.
    pub compliance_hidden_above_rad_per_s: f64,
    /// The mass that hides it.
    pub hidden_by: HidingMass,
}

/// Largest differences of two responses: below 1000 rad/s, and everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReductionDifference {
    /// Difference up to 1000 rad/s.
    pub low: ResponseDifference,
    /// Difference over the whole grid, including the resonance.
    pub all: ResponseDifference,
}

/// Driving-point impedance and its properties.
#[derive(Clone, Debug, PartialEq)]
pub struct PortView {
    /// Impedance, Z = -F_e/(s X_L), N s/m.
    pub impedance: TransferFunction,
    /// Straight-line asymptotes of the impedance.
    pub asymptotes: Vec<Asymptote>,
    /// Passivity of the impedance, and the frequencies at which it is not passive.
    pub passivity: PassivityReport,
    /// Minus the force per velocity of the moving part of a scenario, N s/m: Z itself if the motion
    /// of the load is prescribed; the impedance at the ground of a load that yields.
    pub by_motion: TransferFunction,
    /// True if the moving part is the ground of a load that yields.
    pub moves_ground: bool,
    /// Force that remains after a step of that motion by 1 mm, N (Proposition 6.2: zero); absent if
    /// unstable.
    pub final_force_n: Option<f64>,
}

/// Product G H of a continuous controller, through which the load motion acts; G of another
/// controller.
fn in_series_with(
    controller: &Controller,
    sensor: &TransferFunction,
) -> Result<TransferFunction, LinearError> {
    let feedback = controller.feedback.transfer_function()?;
    if is_continuous(&feedback) { feedback.series(sensor) } else { Ok(feedback) }
}

/// Linearises a rig; `controller` is the given one, if there is one, to which the sensor H feeds
/// back the force.
///
/// # Errors
/// [`LinearError`] for a model without finite roots: parameters so extreme that the arithmetic
/// overflows.
pub fn linearize(
    rig: &Rig,
    controller: Option<&Controller>,
    sensor: &TransferFunction,
) -> Result<Linearization, LinearError> {
    let feedback = controller.map(|given| in_series_with(given, sensor)).transpose()?;
    let plant = transfer_functions(&rig.plant.coefficients())?;
    let leaking = rig.leaking();
    let full = linear_model(&leaking)?;
    let port = port(&rig.plant)?;
    let two_pressure = transfer_functions(&rig.two_pressure_held().coefficients())?;
    let decomposed = [
        decomposed_model(&leaking, MechanicalDamping::Printed)?,
        decomposed_model(&leaking, MechanicalDamping::Corrected)?,
    ];
    let first_order = first_order_model(&rig.against_load())?;
    let derived_full = linear_model(&rig.leaking_derived())?;
    let derived_plant = transfer_functions(&rig.one_pressure(&rig.derived).coefficients())?.command;
    let grid = frequency_grid(&full.command)?;
    let against_full = |other: &TransferFunction| compare(&grid, &full.command, other);
    let rational = controller.is_some_and(|given| {
        given.timing == Timing { discretization: given.timing.discretization, ..Timing::default() }
    });
    let rational = rational && sensor.dead_time_s() == 0.0;
    let continuous = feedback.as_ref().filter(|function| rational && is_continuous(function));
    let closed_loop = continuous.map(|controller| closed_loop_view(rig, controller)).transpose()?;
    let reductions = [&two_pressure.command, &full.command, &decomposed[1], &first_order];
    let agreement = agreement::agreement(rig, &frequency_grid(&plant.command)?, &plant.command, reductions);
    let (hidden_by, compliance_hidden_above_rad_per_s) = hidden_above(rig);
    Ok(Linearization {
        motion: rig.motion,
        plant_is_fifth_order: is_fifth_order(rig),
        agreement,
        stiffness: [StiffeningMember::Nominal, StiffeningMember::Minimum, StiffeningMember::Maximum]
            .map(|member| stroke_stiffness(rig, member)),
        stiffness_models: stiffness_models(rig),
        reduction: compare(
            &frequency_grid(&two_pressure.command)?,
            &two_pressure.command,
            &derived_full.command,
        ),
        printed_decomposition: against_full(&decomposed[0]),
        corrected_decomposition: against_full(&decomposed[1]),
        truncation: against_full(&first_order_model(&leaking)?),
        modes: dominance(&plant.command),
        load_yields: rig.load_moves(),
        first_order_has_load: rig.load_stiffness().is_some(),
        open_loop: open_loop_view(rig, [&port, &plant])?,
        closed_loop_absent: absence(feedback.as_ref(), closed_loop.as_ref()),
        closed_loop,
        required_impedance: controller
            .map(|given| port::required_impedance(rig, given, sensor))
            .transpose()?
            .flatten(),
        linkage: linkage_places(rig),
        compliance_hidden_above_rad_per_s,
        hidden_by,
        plant,
        two_pressure,
        full,
        derived_full,
        derived_plant,
        decomposed,
        first_order,
    })
}

fn is_continuous(function: &TransferFunction) -> bool {
    function.domain() == phea_dynamics::linear::TimeDomain::Continuous
}

/// Reason why there is no impedance of the closed loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoClosedImpedance {
    /// The project gives no controller.
    NoController,
    /// The controller is sampled or the loop has dead time, so that the impedance is not a rational
    /// function.
    NotRational,
}

fn absence(controller: Option<&TransferFunction>, view: Option<&PortView>) -> Option<NoClosedImpedance> {
    match (controller, view) {
        (_, Some(_)) => None,
        (None, None) => Some(NoClosedImpedance::NoController),
        (Some(_), None) => Some(NoClosedImpedance::NotRational),
    }
}

fn open_loop_view(rig: &Rig, [port, plant]: [&LinearModel; 2]) -> Result<PortView, LinearError> {
    let impedance = open_loop_impedance(port)?;
    let moved = if moves_ground(rig) { plant } else { port };
    Ok(PortView {
        passivity: passivity(&impedance)?,
        asymptotes: port::own_asymptotes(rig, None),
        final_force_n: final_force_after_load_step(&moved.load_position, 1e-3),
        by_motion: open_loop_impedance(moved)?,
        moves_ground: moves_ground(rig),
        impedance,
    })
}

/// True if the plant is thesis (6.7): one load pressure, a prescribed load, no leakage, and no
/// effect of the supply; a series spring only makes the sensor softer.
fn is_fifth_order(rig: &Rig) -> bool {
    matches!(rig.plant.chambers, ChamberDynamics::LoadPressure { .. })
        && rig.internal_leakage == 0.0
        && rig.plant.dynamic_feedback.is_none()
        && !rig.load_moves()
        && rig.plant.supply.is_none()
        && rig.plant.series.is_none_or(|series| series.is_pure_spring())
}

/// True if the ground of the load moves instead of the load: with a virtual impedance the output of
/// the plant is not only the force.
fn moves_ground(rig: &Rig) -> bool {
    rig.load_moves() && rig.virtual_impedance.is_none()
}

fn closed_loop_view(rig: &Rig, controller: &TransferFunction) -> Result<PortView, LinearError> {
    let plant = rig.in_loop().plant;
    let impedance = closed_loop_port(&plant, controller)?;
    let by_motion = match moves_ground(rig) {
        true => closed_loop_impedance(&transfer_functions(&plant.coefficients())?, controller)?,
        false => impedance.clone(),
    };
    Ok(PortView {
        passivity: passivity(&impedance)?,
        asymptotes: port::asymptotes(rig, controller),
        final_force_n: final_force_after_load_step(&load_motion_of(&by_motion)?, 1e-3),
        by_motion,
        moves_ground: moves_ground(rig),
        impedance,
    })
}

/// Stiffness over the stroke by the project's model, for one member of the stiffening interval.
pub fn stroke_stiffness(rig: &Rig, member: StiffeningMember) -> StrokeStiffness {
    rig.actuator.chamber_compliance([rig.point.pressure_a, rig.point.pressure_b], member).over_stroke()
}

/// Settings, 0 and 1, to which accumulators can be adjusted in addition to that at rest, with the
/// stiffness over the stroke at each; empty if nothing is adjusted.
pub fn stiffness_at_settings(rig: &Rig) -> Vec<(f64, StrokeStiffness)> {
    let components = rig.actuator.components();
    let pressures = [rig.point.pressure_a, rig.point.pressure_b];
    let settings = || components.gas.iter().flatten().filter_map(ChamberGas::setting);
    let rests = |setting: f64| settings().all(|at_rest| at_rest == setting);
    let of = |setting: f64| {
        let there = components.at_setting(setting);
        (setting, there.chamber_compliance(pressures, StiffeningMember::Nominal).over_stroke())
    };
    [0.0, 1.0].into_iter().filter(|setting| !rests(*setting)).map(of).collect()
}

/// Stiffness at a position by the project's model, with the accumulators adjusted to a setting.
pub fn stiffness_at_setting(rig: &Rig, setting: f64, position: f64) -> f64 {
    let there = rig.actuator.components().at_setting(setting);
    let pressures = [rig.point.pressure_a, rig.point.pressure_b];
    hydraulic_stiffness(&there.chamber_compliance(pressures, StiffeningMember::Nominal), position)
}

/// Stiffness at a position by either model.
pub fn stiffness_at(rig: &Rig, model: StiffnessModel, member: StiffeningMember, position: f64) -> f64 {
    let components = Components { stiffness_model: model, ..*rig.actuator.components() };
    let chambers = components.chamber_compliance([rig.point.pressure_a, rig.point.pressure_b], member);
    hydraulic_stiffness(&chambers, position)
}

/// Both stiffness models of a rig, nominal.
pub fn stiffness_models(rig: &Rig) -> ModelDifference {
    let components = rig.actuator.components();
    let lines = [&components.line_a, &components.line_b];
    let gas = components.gas_compliance([rig.point.pressure_a, rig.point.pressure_b]);
    model_difference(fluid_moduli(rig), &components.cylinder, lines, gas, StiffeningMember::Nominal)
}

/// Bulk modulus of the fluid on either side at the operating point, Pa.
fn fluid_moduli(rig: &Rig) -> [f64; 2] {
    let fluid = &rig.actuator.components().fluid;
    [rig.point.pressure_a, rig.point.pressure_b].map(|pressure| fluid.modulus_at(pressure))
}

/// Frequencies for comparing and drawing: from a decade below the slowest pole to a decade above
/// the fastest, at least 0.01 to 10 000 rad/s, with each resonance resolved.
pub fn frequency_grid(function: &TransferFunction) -> Result<Vec<f64>, LinearError> {
    let moduli: Vec<f64> = function.poles().iter().map(|pole| portable::magnitude(*pole)).collect();
    let slowest = moduli.iter().copied().filter(|modulus| *modulus > 0.0).fold(0.1, f64::min);
    let fastest = moduli.iter().copied().fold(1e3, f64::max);
    let (first, last) = ((slowest / 10.0).max(1e-6), (fastest * 10.0).min(1e9));
    let mut grid = logarithmic_grid(first, last, 600)?;
    grid.extend(function.poles().iter().filter(|pole| pole.im > 0.0).flat_map(resonance_grid));
    grid.retain(|frequency| (first..=last).contains(frequency));
    Ok(sorted_distinct(grid))
}

/// The lightly damped pole of a system, upper half plane: the complex one with the smallest damping
/// ratio.
pub fn resonance(function: &TransferFunction) -> Option<Complex64> {
    let damping_ratio = |pole: &Complex64| -pole.re / portable::magnitude(*pole);
    let complex = function.poles().iter().copied().filter(|pole| pole.im > 0.0);
    complex
        .filter(|pole| damping_ratio(pole) < LIGHT_DAMPING)
        .min_by(|one, other| damping_ratio(one).total_cmp(&damping_ratio(other)))
}

/// Damping ratio from which a pole has no resonance peak, 1/sqrt(2).
const LIGHT_DAMPING: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Frequencies around a pole over which its phase turns in equal steps: the peak of a lightly
/// damped pole is much narrower than the steps of a grid over decades.
fn resonance_grid(pole: &Complex64) -> impl Iterator<Item = f64> + use<> {
    const STEPS: i32 = 64;
    let (centre, half_width) = (pole.im, pole.re.abs());
    (1 - STEPS..STEPS).map(move |step| {
        let turn = FRAC_PI_2 * f64::from(step) / f64::from(STEPS);
        centre + half_width * portable::sin(turn) / portable::cos(turn)
    })
}

fn compare(grid: &[f64], reference: &TransferFunction, other: &TransferFunction) -> ReductionDifference {
    let difference =
        |grid: &[f64]| response_difference(grid, |w| reference.at_frequency(w), |w| other.at_frequency(w));
    let low: Vec<f64> = grid.iter().copied().filter(|frequency| *frequency <= COMPARISON_END).collect();
    ReductionDifference { low: difference(&low), all: difference(grid) }
}
