use num_complex::Complex64;
use phea_dynamics::frequency::PassivityReport;
use phea_dynamics::linear::TransferFunction;
use phea_hydraulics::impedance::{Asymptote, AsymptoteKind};
use phea_hydraulics::linear::{ModeShare, ResponseDifference};
use serde::Serialize;

use super::sweep_answer::{SweepRow, SweptRow, head, rows};
use super::{
    Agreement, Comparison, Linearization, PortView, Sweep, WITHIN_DB, WITHIN_DEG, stiffness_sentence,
};
use crate::answer::{self, Number, OutputFile, significant, table};
use crate::caveat::of_models;
use crate::project::Loaded;

#[derive(Serialize)]
struct Body<'a> {
    stiffness: StiffnessRow,
    poles: Poles,
    plant: PlantRow,
    agreement: Vec<AgreementRow<'a>>,
    decomposition_error: DecompositionError,
    reduction_error: Difference,
    first_order_error: Difference,
    dominance: Vec<Mode>,
    impedance: Ports<'a, ImpedanceRow>,
    passivity: Ports<'a, PassivityRow>,
    compliance_hidden_above_rad_per_s: f64,
    load_step_final_force_n: FinalForce<'a>,
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    swept: Option<SweptRow<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sweep: Vec<SweepRow>,
}

#[derive(Serialize)]
struct StiffnessRow {
    minimum_n_per_m: f64,
    maximum_n_per_m: f64,
    minimum_position_m: f64,
    minimum_softest_wall_n_per_m: f64,
    maximum_stiffest_wall_n_per_m: f64,
    uniform: [f64; 2],
    by_volume: [f64; 2],
    sentence: String,
}

#[derive(Serialize)]
struct Poles {
    plant: Vec<[f64; 2]>,
    full: Vec<[f64; 2]>,
    decomposed: Vec<[f64; 2]>,
    first_order: Vec<[f64; 2]>,
    two_pressure: Vec<[f64; 2]>,
}

/// The plant that every verdict is of, from the command in V and from the position of the load or its ground in m, to the force in N.
#[derive(Serialize)]
struct PlantRow {
    command: FactorRow,
    load_position: FactorRow,
}

/// gain (s - zero).../((s - pole)...)
#[derive(Serialize)]
struct FactorRow {
    gain: f64,
    zeros: Vec<[f64; 2]>,
    poles: Vec<[f64; 2]>,
}

/// Where a reduction is within 1 dB and 5 degrees of the plant.
#[derive(Serialize)]
struct AgreementRow<'a> {
    model: &'a str,
    equation: String,
    bands_rad_per_s: &'a [[f64; 2]],
}

#[derive(Serialize)]
struct DecompositionError {
    #[serde(flatten)]
    corrected: Difference,
    as_printed: Difference,
}

/// Largest differences over all frequencies, and below 1000 rad/s.
#[derive(Serialize)]
struct Difference {
    magnitude_db: f64,
    magnitude_at_rad_per_s: f64,
    phase_deg: f64,
    phase_at_rad_per_s: f64,
    below_1000_rad_per_s: LowDifference,
}

#[derive(Serialize)]
struct LowDifference {
    magnitude_db: f64,
    phase_deg: f64,
}

#[derive(Serialize)]
struct Mode {
    pole: [f64; 2],
    step_share: Number,
    decay_ratio: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Serialize)]
struct Ports<'a, Row> {
    open_loop: Row,
    closed_loop: Option<Row>,
    #[serde(skip_serializing_if = "Option::is_none")]
    closed_loop_reason: Option<&'a str>,
}

#[derive(Serialize)]
struct FinalForce<'a> {
    open_loop: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    open_loop_reason: Option<&'a str>,
    closed_loop: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    closed_loop_reason: Option<&'a str>,
}

#[derive(Serialize)]
struct ImpedanceRow {
    gain: f64,
    zeros: Vec<[f64; 2]>,
    poles: Vec<[f64; 2]>,
    asymptotes: Vec<AsymptoteRow>,
}

#[derive(Serialize)]
struct AsymptoteRow {
    kind: &'static str,
    /// Z = coefficient s^power
    coefficient: Number,
    power: i32,
    from_rad_per_s: Number,
    to_rad_per_s: Number,
}

#[derive(Serialize)]
struct PassivityRow {
    passive: bool,
    right_half_plane_poles: Vec<[f64; 2]>,
    imaginary_poles: Vec<f64>,
    bands: Vec<[Number; 2]>,
}

fn pairs(roots: &[Complex64]) -> Vec<[f64; 2]> {
    roots.iter().map(|root| [root.re, root.im]).collect()
}

fn difference(comparison: &Comparison) -> Difference {
    let ResponseDifference { magnitude_db, magnitude_frequency, phase_deg, phase_frequency } = comparison.all;
    Difference {
        magnitude_db,
        magnitude_at_rad_per_s: magnitude_frequency,
        phase_deg,
        phase_at_rad_per_s: phase_frequency,
        below_1000_rad_per_s: LowDifference {
            magnitude_db: comparison.low.magnitude_db,
            phase_deg: comparison.low.phase_deg,
        },
    }
}

/// The JSON object of `linearize`.
pub fn json(loaded: &Loaded, linearization: &Linearization) -> String {
    answer::json("linearize", loaded, body(loaded, linearization))
}

/// The same with what a sweep found.
pub fn json_swept(loaded: &Loaded, linearization: &Linearization, sweep: &Sweep) -> String {
    let body = Body { swept: Some(head(sweep)), sweep: rows(sweep), ..body(loaded, linearization) };
    answer::json("linearize", loaded, body)
}

fn body<'a>(loaded: &Loaded, linearization: &'a Linearization) -> Body<'a> {
    let [nominal, softest, stiffest] = linearization.stiffness;
    let models = &linearization.stiffness_models;
    let modes = linearization.modes.iter().map(|mode| Mode {
        pole: [mode.pole.re, mode.pole.im],
        step_share: Number(mode.step_share),
        decay_ratio: Number(mode.decay_ratio),
        reason: mode.absence.map(|absence| absence.to_string()),
    });
    Body {
        stiffness: StiffnessRow {
            minimum_n_per_m: nominal.minimum,
            maximum_n_per_m: nominal.maximum,
            minimum_position_m: nominal.minimum_position,
            minimum_softest_wall_n_per_m: softest.minimum,
            maximum_stiffest_wall_n_per_m: stiffest.maximum,
            uniform: [models.uniform.minimum, models.uniform.maximum],
            by_volume: [models.by_volume.minimum, models.by_volume.maximum],
            sentence: stiffness_sentence(models),
        },
        poles: Poles {
            plant: pairs(linearization.plant.command.poles()),
            full: pairs(linearization.full.command.poles()),
            decomposed: pairs(linearization.decomposed[1].poles()),
            first_order: pairs(linearization.first_order.poles()),
            two_pressure: pairs(linearization.two_pressure.command.poles()),
        },
        plant: PlantRow {
            command: factors(&linearization.plant.command),
            load_position: factors(&linearization.plant.load_position),
        },
        agreement: linearization.agreement.iter().map(agreement_row).collect(),
        decomposition_error: DecompositionError {
            corrected: difference(&linearization.corrected_decomposition),
            as_printed: difference(&linearization.printed_decomposition),
        },
        reduction_error: difference(&linearization.reduction),
        first_order_error: difference(&linearization.truncation),
        dominance: modes.collect(),
        impedance: ports(linearization, impedance_row),
        passivity: ports(linearization, |view| passivity_row(&view.passivity)),
        compliance_hidden_above_rad_per_s: linearization.compliance_hidden_above_rad_per_s,
        load_step_final_force_n: final_force(linearization),
        warnings: of_models(&loaded.project),
        swept: None,
        sweep: vec![],
    }
}

fn factors(function: &TransferFunction) -> FactorRow {
    FactorRow { gain: function.gain(), zeros: pairs(function.zeros()), poles: pairs(function.poles()) }
}

fn agreement_row(agreement: &Agreement) -> AgreementRow<'_> {
    let Agreement { model, equation, bands_rad_per_s } = agreement;
    AgreementRow { model, equation: format!("thesis {equation}"), bands_rad_per_s }
}

fn ports<Row>(linearization: &Linearization, row: impl Fn(&PortView) -> Row) -> Ports<'_, Row> {
    Ports {
        open_loop: row(&linearization.open_loop),
        closed_loop: linearization.closed_loop.as_ref().map(&row),
        closed_loop_reason: linearization.closed_loop_absent.as_deref(),
    }
}

fn final_force(linearization: &Linearization) -> FinalForce<'_> {
    let unstable = "unstable: the force has no final value";
    let force =
        |view: Option<&PortView>| Number(view.and_then(|view| view.final_force_n).unwrap_or(f64::NAN));
    let reason = |view: &PortView| view.final_force_n.is_none().then_some(unstable);
    let closed_loop = linearization.closed_loop.as_ref();
    FinalForce {
        open_loop: force(Some(&linearization.open_loop)),
        open_loop_reason: reason(&linearization.open_loop),
        closed_loop: force(closed_loop),
        closed_loop_reason: linearization.closed_loop_absent.as_deref().or(closed_loop.and_then(reason)),
    }
}

fn impedance_row(view: &PortView) -> ImpedanceRow {
    ImpedanceRow {
        gain: view.impedance.gain(),
        zeros: pairs(view.impedance.zeros()),
        poles: pairs(view.impedance.poles()),
        asymptotes: view.asymptotes.iter().map(asymptote_row).collect(),
    }
}

fn asymptote_row(asymptote: &Asymptote) -> AsymptoteRow {
    AsymptoteRow {
        kind: match asymptote.kind {
            AsymptoteKind::LowFrequency => "low_frequency",
            AsymptoteKind::CompliancePlateau => "compliance_plateau",
            AsymptoteKind::SensorLimit => "sensor_limit",
        },
        coefficient: Number(asymptote.coefficient),
        power: asymptote.power,
        from_rad_per_s: Number(asymptote.from),
        to_rad_per_s: Number(asymptote.to),
    }
}

fn passivity_row(report: &PassivityReport) -> PassivityRow {
    PassivityRow {
        passive: report.passive,
        right_half_plane_poles: pairs(&report.right_half_plane_poles),
        imaginary_poles: report.imaginary_poles.iter().map(|pole| pole.frequency_rad_per_s).collect(),
        bands: report
            .bands
            .iter()
            .map(|band| [Number(band.from_rad_per_s), Number(band.to_rad_per_s)])
            .collect(),
    }
}

/// The tables and sentences of `linearize` for people.
pub fn text(loaded: &Loaded, linearization: &Linearization) -> String {
    let mut out = String::new();
    for sentence in of_models(&loaded.project) {
        out.push_str(&format!("warning: {sentence}\n"));
    }
    out.push_str(&format!("Stiffness\n  {}\n", stiffness_sentence(&linearization.stiffness_models)));
    let mut poles = table(&["model", "equation", "poles, rad/s"]);
    for (model, equation, function) in models(linearization) {
        poles.add_row([model, equation, &root_list(function.poles())]);
    }
    out.push_str(&format!("\nPoles\n{}\n", poles.trim_fmt()));
    out.push_str(&format!("\n{}\n{}\n", agreement_heading(), agreement_table(linearization)));
    let mut errors = table(&["comparison", "below 1000 rad/s", "everywhere"]);
    for (name, comparison) in comparisons(linearization) {
        errors.add_row([name.to_string(), difference_text(&comparison.low), located(&comparison.all)]);
    }
    out.push_str(&format!("\nLargest differences\n{}\n", errors.trim_fmt()));
    let mut modes =
        table(&["mode, rad/s", "share of the step response", "decays faster than the slowest by"]);
    for mode in &linearization.modes {
        let [share, decay] = mode_words(mode);
        modes.add_row([root_list(&[mode.pole]), share, decay]);
    }
    out.push_str(&format!("\nDominance\n{}\n\nDriving-point impedance Z = -F_e/(s X_L)\n", modes.trim_fmt()));
    out.push_str(&format!("  open loop:   {}\n", passivity_sentence(&linearization.open_loop.passivity)));
    match (&linearization.closed_loop, &linearization.closed_loop_absent) {
        (Some(view), _) => out.push_str(&format!("  closed loop: {}\n", passivity_sentence(&view.passivity))),
        (None, reason) => {
            out.push_str(&format!("  closed loop: none, {}\n", reason.as_deref().unwrap_or("not computed")))
        }
    }
    let hidden = significant(linearization.compliance_hidden_above_rad_per_s, 4);
    out.push_str(&format!("  above {hidden} rad/s the piston's mass hides the compliance\n"));
    out
}

/// What the table below it tells.
pub(crate) fn agreement_heading() -> String {
    format!("Where a reduction is within {WITHIN_DB} dB and {WITHIN_DEG}° of the plant")
}

/// The bands of an agreement in words.
pub(crate) fn band_words(agreement: &Agreement) -> String {
    let band = |[from, to]: &[f64; 2]| format!("{} to {} rad/s", significant(*from, 3), significant(*to, 3));
    let bands: Vec<String> = agreement.bands_rad_per_s.iter().map(band).collect();
    if bands.is_empty() { "nowhere".to_string() } else { bands.join(", ") }
}

fn agreement_table(linearization: &Linearization) -> String {
    let mut rows = table(&["model", "equation", "frequencies"]);
    for agreement in &linearization.agreement {
        rows.add_row([agreement.model, agreement.equation, &band_words(agreement)]);
    }
    rows.trim_fmt()
}

/// The poles of every model as a table for other programs.
pub fn files(linearization: &Linearization) -> Vec<OutputFile> {
    let mut csv = String::from("model,equation,real_rad_per_s,imaginary_rad_per_s\n");
    for (model, equation, function) in models(linearization) {
        for pole in function.poles() {
            csv.push_str(&format!("\"{model}\",{equation},{},{}\n", pole.re, pole.im));
        }
    }
    vec![OutputFile { name: "poles.csv".to_string(), bytes: csv.into_bytes() }]
}

/// Share and decay ratio of a mode; in place of a number that does not exist, why.
pub(crate) fn mode_words(mode: &ModeShare) -> [String; 2] {
    let absence = mode.absence.map(|absence| absence.to_string()).unwrap_or_default();
    let words = |value: f64, otherwise: &str| match value.is_nan() {
        true => otherwise.to_string(),
        false => significant(value, 3),
    };
    [words(mode.step_share, &absence), words(mode.decay_ratio, "none")]
}

/// Every model with its equation, the fullest first; with the values that hold where nothing else is said.
pub(crate) fn models(linearization: &Linearization) -> [(&'static str, &'static str, &TransferFunction); 7] {
    [
        ("plant", "4.1 to 4.45", &linearization.plant.command),
        ("two-pressure, derived parameters", "4.25 to 4.29", &linearization.two_pressure.command),
        ("fifth order, derived parameters", "6.7", &linearization.derived_full.command),
        ("fifth order", "6.7", &linearization.full.command),
        ("decomposed, as printed", "6.12", &linearization.decomposed[0]),
        ("decomposed, corrected", "6.12", &linearization.decomposed[1]),
        ("first order", "6.13", &linearization.first_order),
    ]
}

/// Every comparison with its name.
pub(crate) fn comparisons(linearization: &Linearization) -> [(&'static str, &Comparison); 4] {
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

pub(crate) fn difference_text(difference: &ResponseDifference) -> String {
    format!("{} dB, {}°", significant(difference.magnitude_db, 2), significant(difference.phase_deg, 2))
}

pub(crate) fn located(difference: &ResponseDifference) -> String {
    format!(
        "{} dB at {} rad/s, {}° at {} rad/s",
        significant(difference.magnitude_db, 2),
        significant(difference.magnitude_frequency, 4),
        significant(difference.phase_deg, 2),
        significant(difference.phase_frequency, 4)
    )
}

/// Whether an impedance is passive, and where not.
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
