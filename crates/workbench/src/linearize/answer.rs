use num_complex::Complex64;
use phea_dynamics::frequency::PassivityReport;
use phea_dynamics::linear::TransferFunction;
use phea_hydraulics::impedance::{Asymptote, AsymptoteKind};
use phea_hydraulics::linear::ResponseDifference;
use serde::Serialize;

use super::sweep_answer::{SweepRow, SweptRow, head, rows};
use super::{AgreementBand, Linearization, PortView, ReductionDifference, Sweep, models, stiffness_sentence};
use crate::answer::{self, Csv, Number, OutputFile, quoted};
use crate::caveat::of_models;
use crate::project::Loaded;

#[derive(Serialize)]
struct LinearizeAnswer<'a> {
    stiffness: StiffnessRow,
    poles: PolesAnswer,
    plant: PlantRow,
    agreement: Vec<AgreementRow<'a>>,
    decomposition_error: DecompositionErrorAnswer,
    reduction_error: DifferenceAnswer,
    first_order_error: DifferenceAnswer,
    dominance: Vec<ModeAnswer>,
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
struct PolesAnswer {
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
struct DecompositionErrorAnswer {
    #[serde(flatten)]
    corrected: DifferenceAnswer,
    as_printed: DifferenceAnswer,
}

/// Largest differences over all frequencies, and below 1000 rad/s.
#[derive(Serialize)]
struct DifferenceAnswer {
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
struct ModeAnswer {
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

fn difference(comparison: &ReductionDifference) -> DifferenceAnswer {
    let ResponseDifference { magnitude_db, magnitude_frequency, phase_deg, phase_frequency } = comparison.all;
    DifferenceAnswer {
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
pub(crate) fn json_swept(loaded: &Loaded, linearization: &Linearization, sweep: &Sweep) -> String {
    let body =
        LinearizeAnswer { swept: Some(head(sweep)), sweep: rows(sweep), ..body(loaded, linearization) };
    answer::json("linearize", loaded, body)
}

fn body<'a>(loaded: &Loaded, linearization: &'a Linearization) -> LinearizeAnswer<'a> {
    let [nominal, softest, stiffest] = linearization.stiffness;
    let models = &linearization.stiffness_models;
    let modes = linearization.modes.iter().map(|mode| ModeAnswer {
        pole: [mode.pole.re, mode.pole.im],
        step_share: Number(mode.step_share),
        decay_ratio: Number(mode.decay_ratio),
        reason: mode.absence.map(|absence| absence.to_string()),
    });
    LinearizeAnswer {
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
        poles: PolesAnswer {
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
        decomposition_error: DecompositionErrorAnswer {
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

fn agreement_row(agreement: &AgreementBand) -> AgreementRow<'_> {
    let AgreementBand { model, equation, bands_rad_per_s } = agreement;
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

/// The poles of every model as a table for other programs.
pub fn files(linearization: &Linearization) -> Vec<OutputFile> {
    let mut csv = Csv::new("model,equation,real_rad_per_s,imaginary_rad_per_s");
    for (model, equation, function) in models(linearization) {
        for pole in function.poles() {
            csv.row(&[&quoted(model), &equation, &pole.re, &pole.im]);
        }
    }
    vec![csv.file("poles.csv")]
}
