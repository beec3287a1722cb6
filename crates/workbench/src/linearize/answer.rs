//! The answer of `linearize`, and the table of its poles.

mod differences;
mod port;
mod stiffness;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_engineering::linearize::{AgreementBand, Linearization, LinkagePlace, LinkagePosition, Sweep};
use phea_engineering::setup::Setup;
use phea_hydraulics::linear::ModeContribution;

use super::models;
use super::sweep_answer::{SweptKeyAnswer, SweptPointAnswer, head, rows};
use crate::answer::{Answer, Csv, OutputFile, quoted, words};
use crate::caveat;
use crate::quantity::{FORCE, QuantityName};
use differences::{DecompositionErrorAnswer, ResponseDifferenceAnswer, decomposition, difference};
use port::{
    FinalForcesAnswer, ImpedancesAnswer, PassivitiesAnswer, VirtualImpedanceAnswer, final_forces, impedances,
    passivities, virtual_impedance,
};
use stiffness::{LinearStiffnessAnswer, stiffness};

pub(crate) use port::{PassivityAnswer, passivity, phase_difference_deg};

/// Answer of `linearize`.
#[derive(Answer)]
pub(crate) struct LinearizeAnswer {
    /// Hydraulic stiffness over the stroke.
    stiffness: LinearStiffnessAnswer,
    /// Poles of the linear models from the command to the force.
    poles: ModelPolesAnswer,
    /// Models in which the load is held still, only if the load yields to force.
    #[answer(optional)]
    load_held_still_in: Option<Vec<HeldModel>>,
    /// Transfer functions of the plant of every verdict.
    plant: LinearPlantAnswer,
    /// Linkage at selected positions over the stroke, if the rig has one.
    #[answer(optional)]
    linkage: Option<Vec<LinkagePlaceAnswer>>,
    /// Frequency bands in which each reduced model agrees with the plant to 1 dB and 5 degrees, the
    /// fullest model first.
    agreement: Vec<AgreementBandsAnswer>,
    /// Difference of the corrected decomposed model (thesis 6.12) from the fifth-order one (6.7).
    decomposition_error: DecompositionErrorAnswer,
    /// Difference of the fifth-order model from the two-pressure one, both with derived parameters.
    reduction_error: ResponseDifferenceAnswer,
    /// Difference of the first-order model (thesis 6.13) from the fifth-order one (6.7), both with
    /// the load held still.
    first_order_error: ResponseDifferenceAnswer,
    /// Modes of the plant with their parts in its step response.
    dominance: Vec<DominantModeAnswer>,
    /// Driving-point impedance at the load, -F_e/(s X_L).
    impedance: ImpedancesAnswer,
    /// Passivity of the driving-point impedance.
    passivity: PassivitiesAnswer,
    /// Virtual impedance compared with the impedance of the loop, only with
    /// `[controller.impedance]`.
    #[answer(optional)]
    virtual_impedance: Option<VirtualImpedanceAnswer>,
    /// Frequency above which the mass of the piston, or the oil of a transmission, hides the
    /// compliance from the load.
    compliance_hidden_above_rad_per_s: f64,
    /// Force or torque that remains after a step of the position by 0.001 (m or rad).
    #[answer(key = QuantityName::OfMotion(["load_step_final_force", "load_step_final_torque"], &FORCE))]
    load_step_final_force: FinalForcesAnswer,
    /// Body that this step moves.
    load_step_moves: MovedByStep,
    /// Declared effects that the linear models do not include.
    warnings: Vec<String>,
    /// Swept key, if a sweep was requested.
    #[answer(optional)]
    swept: Option<SweptKeyAnswer>,
    /// Results at each value of the swept key, if a sweep was requested.
    #[answer(optional)]
    sweep: Option<Vec<SweptPointAnswer>>,
}

/// Poles of the linear models from the command to the force, sorted by magnitude.
#[derive(Answer)]
struct ModelPolesAnswer {
    /// Plant of every verdict, with its load and the parameters in use.
    plant: Vec<Complex64>,
    /// Fifth-order model (thesis 6.7) with the parameters in use.
    full: Vec<Complex64>,
    /// Fifth-order model (thesis 6.7) with derived parameters.
    full_derived: Vec<Complex64>,
    /// Decomposed model (thesis 6.12) with the damping corrected.
    decomposed: Vec<Complex64>,
    /// Decomposed model as the thesis prints it.
    decomposed_as_printed: Vec<Complex64>,
    /// First-order model (thesis 6.13).
    first_order: Vec<Complex64>,
    /// Linearised two-pressure model with derived parameters.
    two_pressure: Vec<Complex64>,
}

#[derive(Clone, Copy)]
enum HeldModel {
    TwoPressure,
    Full,
    Decomposed,
    FirstOrder,
}

words! {
    /// Model that holds the load still, by its key in `poles`.
    HeldModel {
        TwoPressure => "two_pressure",
        Full => "full",
        Decomposed => "decomposed",
        FirstOrder => "first_order",
    }
}

/// Transfer functions of the plant, to the measured force.
#[derive(Answer)]
struct LinearPlantAnswer {
    /// From the command of the valve.
    command: FactorsAnswer,
    /// From the position of the load, or of the ground of a load that yields.
    load_position: FactorsAnswer,
}

/// Transfer function gain (s - zeros).../((s - poles)...).
#[derive(Answer)]
struct FactorsAnswer {
    /// Leading coefficient.
    gain: f64,
    /// Zeros, sorted by magnitude.
    zeros: Vec<Complex64>,
    /// Poles, sorted by magnitude.
    poles: Vec<Complex64>,
}

/// Linkage at one position, which joins the rod of a cylinder.
#[derive(Answer)]
struct LinkagePlaceAnswer {
    /// Name of the position.
    at: LinkagePosition,
    /// Position of the end of the rod from the start of the stroke.
    position_m: f64,
    /// Angle of the joint.
    angle_rad: f64,
    /// Lever arm: torque over force, and velocity over angular velocity.
    lever_arm_m: f64,
    /// Inertia of the load over the square of the lever arm, only of a load that yields.
    #[answer(optional)]
    reflected_mass_kg: Option<f64>,
}

words! {
    /// Position of a linkage.
    LinkagePosition by LinkagePosition::words [
        Retracted, Extended, OperatingPoint, LeastArm, GreatestArm,
    ]
}

/// Frequency bands in which a reduced model is within 1 dB and 5 degrees of the plant.
#[derive(Answer)]
struct AgreementBandsAnswer {
    /// Name of the reduced model.
    model: &'static str,
    /// Equation of the reduced model in the thesis.
    equation: String,
    /// Bands from the lower to the upper frequency, ascending, as resolved by the grid.
    #[answer(interval)]
    bands_rad_per_s: Vec<[f64; 2]>,
}

/// Mode of the plant in its step response.
#[derive(Answer)]
struct DominantModeAnswer {
    /// Pole, of a conjugate pair the one with positive imaginary part.
    pole: Complex64,
    /// Greatest amplitude of the mode in the step response, of the final value; null if it does not
    /// exist.
    step_fraction: Option<f64>,
    /// Ratio of the decay rate to that of the slowest mode; null if it does not exist.
    decay_ratio: Option<f64>,
    /// Reason for a number that does not exist, only in that case.
    #[answer(optional)]
    reason: Option<String>,
}

enum MovedByStep {
    Ground,
    Load,
}

words! {
    /// Body that a step of the position moves: the load, or the ground of a load that yields.
    MovedByStep { Ground => "ground", Load => "load" }
}

/// The same with the results of a sweep.
pub(crate) fn body_swept(setup: &Setup<'_>, linearization: &Linearization, sweep: &Sweep) -> LinearizeAnswer {
    LinearizeAnswer { swept: Some(head(sweep)), sweep: Some(rows(sweep)), ..body(setup, linearization) }
}

/// Answer of `linearize` without a sweep.
pub(crate) fn body(setup: &Setup<'_>, linearization: &Linearization) -> LinearizeAnswer {
    let plant = &linearization.plant;
    let linkage = linearization.linkage.as_slice();
    let moves_ground = linearization.open_loop.moves_ground;
    LinearizeAnswer {
        stiffness: stiffness(linearization),
        poles: model_poles(linearization),
        load_held_still_in: linearization.load_yields.then(|| held_models(linearization)),
        plant: LinearPlantAnswer {
            command: factors(&plant.command),
            load_position: factors(&plant.load_position),
        },
        linkage: (!linkage.is_empty()).then(|| linkage.iter().map(linkage_place).collect()),
        agreement: linearization.agreement.iter().map(agreement).collect(),
        decomposition_error: decomposition(linearization),
        reduction_error: difference(&linearization.reduction),
        first_order_error: difference(&linearization.truncation),
        dominance: linearization.modes.iter().map(mode).collect(),
        impedance: impedances(linearization),
        passivity: passivities(linearization),
        virtual_impedance: linearization.required_impedance.as_ref().map(virtual_impedance),
        compliance_hidden_above_rad_per_s: linearization.compliance_hidden_above_rad_per_s,
        load_step_final_force: final_forces(linearization),
        load_step_moves: if moves_ground { MovedByStep::Ground } else { MovedByStep::Load },
        warnings: caveat::of_models_in_words(setup),
        swept: None,
        sweep: None,
    }
}

fn model_poles(linearization: &Linearization) -> ModelPolesAnswer {
    ModelPolesAnswer {
        plant: linearization.plant.command.poles().to_vec(),
        full: linearization.full.command.poles().to_vec(),
        full_derived: linearization.derived_full.command.poles().to_vec(),
        decomposed: linearization.decomposed[1].poles().to_vec(),
        decomposed_as_printed: linearization.decomposed[0].poles().to_vec(),
        first_order: linearization.first_order.poles().to_vec(),
        two_pressure: linearization.two_pressure.command.poles().to_vec(),
    }
}

fn held_models(linearization: &Linearization) -> Vec<HeldModel> {
    let first_order = (!linearization.first_order_has_load).then_some(HeldModel::FirstOrder);
    let always = [HeldModel::TwoPressure, HeldModel::Full, HeldModel::Decomposed];
    always.into_iter().chain(first_order).collect()
}

fn factors(function: &TransferFunction) -> FactorsAnswer {
    FactorsAnswer {
        gain: function.gain(),
        zeros: function.zeros().to_vec(),
        poles: function.poles().to_vec(),
    }
}

fn linkage_place(place: &LinkagePlace) -> LinkagePlaceAnswer {
    LinkagePlaceAnswer {
        at: place.at,
        position_m: place.position_m,
        angle_rad: place.angle_rad,
        lever_arm_m: place.lever_arm_m,
        reflected_mass_kg: place.reflected_mass_kg,
    }
}

fn agreement(agreement: &AgreementBand) -> AgreementBandsAnswer {
    AgreementBandsAnswer {
        model: agreement.model,
        equation: format!("thesis {}", agreement.equation),
        bands_rad_per_s: agreement.bands_rad_per_s.clone(),
    }
}

fn mode(mode: &ModeContribution) -> DominantModeAnswer {
    let known = |value: f64| Some(value).filter(|value| !value.is_nan());
    DominantModeAnswer {
        pole: mode.pole,
        step_fraction: known(mode.step_fraction),
        decay_ratio: known(mode.decay_ratio),
        reason: mode.absence.map(|absence| absence.to_string()),
    }
}

/// The poles of every model as a table for other programs.
pub fn files(linearization: &Linearization) -> Vec<OutputFile> {
    let mut csv = Csv::new("model,equation,real_rad_per_s,imaginary_rad_per_s");
    for (model, equation, function) in models(linearization) {
        for pole in function.poles() {
            csv.row(&[&quoted(&model), &equation, &pole.re, &pole.im]);
        }
    }
    vec![OutputFile::new("poles.csv", csv.text())]
}
