use phea_dynamics::frequency::PassivityReport;
use phea_dynamics::linear::TransferFunction;
use phea_hydraulics::impedance::{Asymptote, AsymptoteKind};

use super::sweep_answer::{head, rows};
use super::{
    AgreementBand, AskedImpedance, Linearization, LinkagePlace, PortView, ReductionDifference, Sweep,
    WITHIN_PERCENT, models, no_closed_impedance_words, stiffness_sentence,
};
use crate::answer::{Csv, Json, Object, OutputFile, quoted};
use crate::caveat;
use crate::quantity::{DAMPING, FORCE, LENGTH, MASS, QuantityName, STIFFNESS};
use crate::setup::Setup;

/// The same with the results of a sweep.
pub(crate) fn body_swept(setup: &Setup<'_>, linearization: &Linearization, sweep: &Sweep) -> Object {
    body(setup, linearization).with("swept", head(sweep)).with("sweep", rows(sweep))
}

/// What `linearize` says to programs.
pub(crate) fn body(setup: &Setup<'_>, linearization: &Linearization) -> Object {
    let plant = &linearization.plant;
    let poles = Object::new()
        .with("plant", plant.command.poles())
        .with("full", linearization.full.command.poles())
        .with("decomposed", linearization.decomposed[1].poles())
        .with("first_order", linearization.first_order.poles())
        .with("two_pressure", linearization.two_pressure.command.poles());
    let held_still = linearization.load_yields.then(|| {
        let first_order = (!linearization.first_order_has_load).then_some("first_order");
        ["two_pressure", "full", "decomposed"].into_iter().chain(first_order).collect::<Vec<_>>()
    });
    let decomposition = difference(&linearization.corrected_decomposition)
        .with("as_printed", difference(&linearization.printed_decomposition));
    Object::new()
        .with("stiffness", stiffness(linearization))
        .with("poles", poles)
        .maybe("load_held_still_in", held_still)
        .with(
            "plant",
            Object::new()
                .with("command", factors(&plant.command))
                .with("load_position", factors(&plant.load_position)),
        )
        .maybe("linkage", linkages(&linearization.linkage))
        .each("agreement", &linearization.agreement, agreement)
        .with("decomposition_error", decomposition)
        .with("reduction_error", difference(&linearization.reduction))
        .with("first_order_error", difference(&linearization.truncation))
        .each("dominance", &linearization.modes, |mode| {
            Object::new()
                .with("pole", mode.pole)
                .with("step_share", mode.step_share)
                .with("decay_ratio", mode.decay_ratio)
                .maybe("reason", mode.absence.map(|absence| absence.to_string()))
        })
        .with("impedance", ports(linearization, impedance))
        .with("passivity", ports(linearization, |view| passivity(&view.passivity)))
        .maybe("virtual_impedance", linearization.asked.as_ref().map(asked))
        .with("compliance_hidden_above_rad_per_s", linearization.compliance_hidden_above_rad_per_s)
        .with(
            QuantityName::OfMotion(["load_step_final_force", "load_step_final_torque"], &FORCE),
            final_force(linearization),
        )
        .with("load_step_moves", if linearization.open_loop.moves_ground { "ground" } else { "load" })
        .with("warnings", caveat::of_models_in_words(setup))
}

fn stiffness(linearization: &Linearization) -> Object {
    let [nominal, softest, stiffest] = linearization.stiffness;
    let models = &linearization.stiffness_models;
    Object::new()
        .with(QuantityName::moving("minimum", &STIFFNESS), nominal.minimum)
        .with(QuantityName::moving("maximum", &STIFFNESS), nominal.maximum)
        .with(
            QuantityName::OfMotion(["minimum_position", "minimum_angle"], &LENGTH),
            nominal.minimum_position,
        )
        .with(QuantityName::moving("minimum_softest_wall", &STIFFNESS), softest.minimum)
        .with(QuantityName::moving("maximum_stiffest_wall", &STIFFNESS), stiffest.maximum)
        .with("uniform", [models.uniform.minimum, models.uniform.maximum])
        .with("by_volume", [models.by_volume.minimum, models.by_volume.maximum])
        .with("sentence", stiffness_sentence(linearization))
}

fn linkages(places: &[LinkagePlace]) -> Option<Vec<Object>> {
    (!places.is_empty()).then(|| places.iter().map(linkage).collect())
}

/// A linkage at one position: it joins the rod of a cylinder.
fn linkage(place: &LinkagePlace) -> Object {
    Object::new()
        .with("at", place.at.words())
        .with("position_m", place.position_m)
        .with("angle_rad", place.angle_rad)
        .with("lever_arm_m", place.lever_arm_m)
        .maybe("reflected_mass_kg", place.reflected_mass_kg)
}

/// gain (s - zero).../((s - pole)...)
fn factors(function: &TransferFunction) -> Object {
    Object::new()
        .with("gain", function.gain())
        .with("zeros", function.zeros())
        .with("poles", function.poles())
}

/// Bands where a reduction is within 1 dB and 5 degrees of the plant.
fn agreement(agreement: &AgreementBand) -> Object {
    Object::new()
        .with("model", agreement.model)
        .with("equation", format!("thesis {}", agreement.equation))
        .with("bands_rad_per_s", agreement.bands_rad_per_s.as_slice())
}

/// Largest differences over all frequencies, and below 1000 rad/s.
fn difference(comparison: &ReductionDifference) -> Object {
    let ReductionDifference { all, low } = comparison;
    Object::new()
        .with("magnitude_db", all.magnitude_db)
        .with("magnitude_at_rad_per_s", all.magnitude_frequency)
        .with("phase_deg", all.phase_deg)
        .with("phase_at_rad_per_s", all.phase_frequency)
        .with(
            "below_1000_rad_per_s",
            Object::new().with("magnitude_db", low.magnitude_db).with("phase_deg", low.phase_deg),
        )
}

fn ports(linearization: &Linearization, of: impl Fn(&PortView) -> Object) -> Object {
    Object::new()
        .with("open_loop", of(&linearization.open_loop))
        .with("closed_loop", linearization.closed_loop.as_ref().map(&of))
        .maybe("closed_loop_reason", linearization.closed_loop_absent.map(no_closed_impedance_words))
}

/// A virtual impedance, and what the port shows of it.
fn asked(asked: &AskedImpedance) -> Object {
    let magnitude = phea_dynamics::portable::magnitude;
    Object::new()
        .with(QuantityName::moving("stiffness", &STIFFNESS), asked.impedance.stiffness)
        .with(QuantityName::moving("damping", &DAMPING), asked.impedance.damping)
        .with(QuantityName::OfMotion(["mass", "inertia"], &MASS), asked.impedance.mass)
        .with("filter_time_s", asked.impedance.filter_time_s)
        .with("within_percent", WITHIN_PERCENT)
        .known("follows_rad_per_s", asked.follows_rad_per_s.map(|band| band.to_vec()), "nowhere within that")
        .each("points", &asked.points, |point| {
            Object::new()
                .with("frequency_rad_per_s", point.frequency_rad_per_s)
                .with(QuantityName::moving("asked", &DAMPING), magnitude(point.asked))
                .with(QuantityName::moving("shown", &DAMPING), magnitude(point.shown))
                .with("asked", point.asked)
                .with("shown", point.shown)
        })
}

fn final_force(linearization: &Linearization) -> Object {
    let unstable = linearization
        .motion
        .either("unstable: the force has no final value", "unstable: the torque has no final value");
    let closed_loop = linearization.closed_loop.as_ref().and_then(|view| view.final_force_n);
    let reason = linearization.closed_loop_absent.map_or(unstable, no_closed_impedance_words);
    Object::new().known("open_loop", linearization.open_loop.final_force_n, unstable).known(
        "closed_loop",
        closed_loop,
        reason,
    )
}

fn impedance(view: &PortView) -> Object {
    factors(&view.impedance).each("asymptotes", &view.asymptotes, asymptote)
}

/// Z = coefficient s^power
fn asymptote(asymptote: &Asymptote) -> Object {
    let kind = match asymptote.kind {
        AsymptoteKind::LowFrequency => "low_frequency",
        AsymptoteKind::CompliancePlateau => "compliance_plateau",
        AsymptoteKind::SensorLimit => "sensor_limit",
        AsymptoteKind::OilLimit => "oil_limit",
    };
    Object::new()
        .with("kind", kind)
        .with("coefficient", asymptote.coefficient)
        .with("power", asymptote.power)
        .with("from_rad_per_s", asymptote.from)
        .with("to_rad_per_s", asymptote.to)
}

pub(crate) fn passivity(report: &PassivityReport) -> Object {
    Object::new()
        .with("passive", report.passive)
        .with("right_half_plane_poles", report.right_half_plane_poles.as_slice())
        .each("imaginary_poles", &report.imaginary_poles, |pole| pole.frequency_rad_per_s)
        .each("bands", &report.bands, |band| Json::from([band.from_rad_per_s, band.to_rad_per_s]))
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
