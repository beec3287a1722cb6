//! Linear models for people.

use num_complex::Complex64;
use phea_dynamics::frequency::PassivityReport;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_hydraulics::linear::{ModeContribution, ResponseDifference};

use super::{
    AgreementBand, ComparedImpedance, FIRST_ORDER, LUMPED, Linearization, LinkagePlace, LinkagePosition,
    ReductionDifference, RequiredImpedance, WITHIN_DB, WITHIN_DEG, WITHIN_PERCENT, hiding_mass_words,
    no_closed_impedance_words, stiffness_sentence,
};
use crate::answer::significant;
use crate::caveat;
use crate::document::{Cell, Document, Table};
use crate::figure::Figure;
use crate::quantity::{DAMPING, MotionKind};
use crate::setup::Setup;

/// The tables and sentences of `linearize` for people.
pub(crate) fn output(setup: &Setup<'_>, linearization: &Linearization) -> Document {
    let mut out = Document::default();
    out.warnings(caveat::of_models_in_words(setup));
    out.heading("Stiffness");
    out.sentences([stiffness_sentence(linearization)]);
    if !linearization.linkage.is_empty() {
        out.section("Linkage", linkage_table(&linearization.linkage));
    }
    out.append(document(linearization, vec![]));
    let motion = linearization.motion;
    let without = if linearization.load_yields { " of the actuator, whatever its load," } else { "" };
    out.heading(format!("Driving-point impedance{without} Z = {}", motion.symbols().impedance));
    let closed = match (&linearization.closed_loop, &linearization.closed_loop_absent) {
        (Some(view), _) => passivity_sentence(&view.passivity),
        (None, Some(reason)) => format!("not computed, because {}", no_closed_impedance_words(*reason)),
        (None, None) => "not computed".to_string(),
    };
    let hidden = significant(linearization.compliance_hidden_above_rad_per_s, 4);
    out.sentences([
        format!("open loop:   {}", passivity_sentence(&linearization.open_loop.passivity)),
        format!("closed loop: {closed}"),
        format!(
            "above {hidden} rad/s {} hides the compliance",
            hiding_mass_words(linearization.hidden_by, motion)
        ),
    ]);
    out.sentences(impedance_at_joint(linearization));
    if let Some(required) = &linearization.required_impedance {
        out.section("Impedance requested and achieved", required_impedance_table(required, motion));
        out.sentences([required_impedance_sentence(required)]);
    }
    out
}

/// Poles of the models, their differences, and the dominant modes; the figures follow the poles.
pub(crate) fn document(linearization: &Linearization, figures: Vec<Figure>) -> Document {
    let mut out = Document::default();
    let pole = |(model, equation, function): (String, &'static str, &TransferFunction)| {
        [model.into(), equation.into(), Cell::Text(root_list(function.poles()))]
    };
    out.section(
        "Poles",
        Table::new(["model", "equation", "poles, rad/s"]).with(models(linearization).map(pole)),
    );
    out.figures(figures);
    let band = |one: &AgreementBand| {
        [model_words(linearization, one.model).into(), one.equation.into(), Cell::Text(band_words(one))]
    };
    out.section(
        format!("Where a reduction is within {WITHIN_DB} dB and {WITHIN_DEG}° of the plant"),
        Table::new(["model", "equation", "frequencies"]).with(linearization.agreement.iter().map(band)),
    );
    let error = |(name, one): (&str, &ReductionDifference)| {
        [name.to_string(), difference_text(&one.low), located(&one.all)]
    };
    let held = if linearization.load_yields { ", the load held still" } else { "" };
    out.section(
        format!("Largest differences{held}"),
        Table::new(["comparison", "below 1000 rad/s", "everywhere"])
            .with(comparisons(linearization).map(error)),
    );
    out.heading("Dominance");
    out.explanation("Share: greatest amplitude of the mode in the step response of the plant over its final value. The slowest mode dominates when every other share is small.");
    out.table(
        Table::new(["mode, rad/s", "share of the step response", "decay rate over the slowest"])
            .with(linearization.modes.iter().map(mode_cells)),
    );
    out
}

/// A linkage over the stroke.
pub(crate) fn linkage_table(places: &[LinkagePlace]) -> Table {
    let row = |place: &LinkagePlace| {
        [
            place.at.words().into(),
            Cell::number(1e3 * place.position_m, 4),
            Cell::number(place.angle_rad.to_degrees(), 4),
            Cell::number(1e3 * place.lever_arm_m, 4),
            place.reflected_mass_kg.map_or(Cell::Missing, |mass| Cell::number(mass, 4)),
        ]
    };
    let headings = ["position", "rod's end, mm", "joint, deg", "lever arm, mm", "reflected mass, kg"];
    Table::new(headings).with(places.iter().map(row))
}

/// Location of Z for a rig whose load turns about a joint: with v = r omega and tau = F r, whose
/// arm changes.
pub(crate) fn impedance_at_joint(linearization: &Linearization) -> Option<String> {
    let here = linearization.linkage.iter().find(|place| place.at == LinkagePosition::OperatingPoint)?;
    let arm = crate::quantity::display(here.lever_arm_m, &crate::quantity::LENGTH, 4);
    Some(format!(
        "Z is that of the rod's end, in N·s/m: about the joint it is r² (Z + k_g/s), in N·m·s/rad, with the lever arm r = {arm} and the geometric stiffness k_g at the operating point"
    ))
}

/// A virtual impedance and the impedance at the port, at a few frequencies.
pub(crate) fn required_impedance_table(required: &RequiredImpedance, motion: MotionKind) -> Table {
    let row = |point: &ComparedImpedance| {
        let size = |value: Complex64| Cell::number(portable::magnitude(value), 3);
        let turned = portable::argument(point.achieved / point.required).to_degrees();
        [
            Cell::number(point.frequency_rad_per_s, 3),
            size(point.required),
            size(point.achieved),
            Cell::number(turned, 2),
        ]
    };
    let unit = motion.dimension(&DAMPING).si;
    let [requested, achieved] = ["requested", "achieved"].map(|word| format!("{word}, {unit}"));
    let headings = ["frequency, rad/s", &requested, &achieved, "phase difference, deg"];
    Table::new(headings).with(required.points.iter().map(row))
}

/// Sentence on the band in which the port has the required impedance.
pub(crate) fn required_impedance_sentence(required: &RequiredImpedance) -> String {
    let within = significant(WITHIN_PERCENT, 3);
    match required.follows_rad_per_s {
        Some([from, to]) => format!(
            "the port shows the virtual impedance within {within} % from {} to {} rad/s",
            significant(from, 3),
            significant(to, 3)
        ),
        None => format!("the port shows the virtual impedance nowhere within {within} %"),
    }
}

/// A mode with its participation and decay ratio, or the reason why a number does not exist.
fn mode_cells(mode: &ModeContribution) -> [Cell; 3] {
    let absence = mode.absence.map(|absence| absence.to_string()).unwrap_or_default();
    let or =
        |value: f64, otherwise: &str| if value.is_nan() { otherwise.into() } else { Cell::number(value, 3) };
    [root_list(&[mode.pole]).into(), or(mode.step_fraction, &absence), or(mode.decay_ratio, "none")]
}

/// The bands of an agreement in words.
fn band_words(agreement: &AgreementBand) -> String {
    let band = |[from, to]: &[f64; 2]| format!("{} to {} rad/s", significant(*from, 3), significant(*to, 3));
    let bands: Vec<String> = agreement.bands_rad_per_s.iter().map(band).collect();
    if bands.is_empty() { "nowhere".to_string() } else { bands.join(", ") }
}

/// Every model with its equation, the fullest first; with the values in use unless stated
/// otherwise.
pub(crate) fn models(linearization: &Linearization) -> [(String, &'static str, &TransferFunction); 7] {
    let all = [
        ("plant", "4.1 to 4.45", &linearization.plant.command),
        ("two-pressure, derived parameters", "4.25 to 4.29", &linearization.two_pressure.command),
        ("fifth order, derived parameters", "6.7", &linearization.derived_full.command),
        ("fifth order", "6.7", &linearization.full.command),
        ("decomposed, as printed", "6.12", &linearization.decomposed[0]),
        ("decomposed, corrected", "6.12", &linearization.decomposed[1]),
        (FIRST_ORDER, "6.13", &linearization.first_order),
    ];
    all.map(|(model, equation, function)| (model_words(linearization, model), equation, function))
}

/// The name of a model, with its treatment of a load that can move under force.
pub(crate) fn model_words(linearization: &Linearization, model: &str) -> String {
    let load = match model {
        _ if !linearization.load_yields => "",
        "plant" | LUMPED => "",
        first if linearization.first_order_has_load && first.starts_with(FIRST_ORDER) => {
            ", the load's stiffness in series"
        }
        _ => ", load held still",
    };
    format!("{model}{load}")
}

/// Every comparison with its name.
fn comparisons(linearization: &Linearization) -> [(&'static str, &ReductionDifference); 4] {
    [
        ("6.7 instead of two-pressure, both with derived parameters", &linearization.reduction),
        ("6.12 as printed instead of 6.7", &linearization.printed_decomposition),
        ("6.12 corrected instead of 6.7", &linearization.corrected_decomposition),
        ("6.13 instead of 6.7", &linearization.truncation),
    ]
}

/// Roots in the upper half plane, pairs as `a ± bi`.
pub(crate) fn root_list(roots: &[Complex64]) -> String {
    let shown: Vec<String> = roots
        .iter()
        .filter(|root| root.im >= 0.0)
        .map(|root| match root.im {
            0.0 => significant(root.re, 4),
            imaginary => format!("{} ± {}i", significant(root.re, 4), significant(imaginary, 4)),
        })
        .collect();
    shown.join(", ")
}

fn difference_text(difference: &ResponseDifference) -> String {
    format!("{} dB, {}°", significant(difference.magnitude_db, 2), significant(difference.phase_deg, 2))
}

fn located(difference: &ResponseDifference) -> String {
    format!(
        "{} dB at {} rad/s, {}° at {} rad/s",
        significant(difference.magnitude_db, 2),
        significant(difference.magnitude_frequency, 4),
        significant(difference.phase_deg, 2),
        significant(difference.phase_frequency, 4)
    )
}

/// Sentence on the passivity of an impedance, and on the bands in which it is not passive.
pub(crate) fn passivity_sentence(report: &PassivityReport) -> String {
    if report.passive {
        return "passive at every frequency".to_string();
    }
    let mut reasons = Vec::new();
    if !report.right_half_plane_poles.is_empty() {
        reasons
            .push(format!("poles in the right half plane at {}", root_list(&report.right_half_plane_poles)));
    }
    for pole in report.imaginary_poles.iter().filter(|pole| !pole.passive) {
        reasons.push(format!(
            "a pole on the imaginary axis at {} rad/s",
            significant(pole.frequency_rad_per_s, 4)
        ));
    }
    for band in &report.bands {
        reasons.push(format!(
            "Re Z < 0 from {} to {} rad/s",
            significant(band.from_rad_per_s, 4),
            significant(band.to_rad_per_s, 4)
        ));
    }
    format!("not passive: {}", reasons.join("; "))
}
