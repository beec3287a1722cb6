mod repair;
mod rounding;

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::{LinearError, TimeDomain};
use phea_qft::design::{BindingLimit, Conflict, DesignRound, DesignStatus, Starts};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::verification::PlantPoint;
use serde::Serialize;

use self::rounding::RoundingRow;
use super::AuditedController;
use super::Factors;
use super::{Explanation, ProjectDesign};
use super::{objective_key, part_key, status_key};
use crate::answer::{self, Number};
use crate::audit::{self, NamedPlant, PlantNames};
use crate::project::Loaded;
use crate::trial::{self, Agreement};

#[derive(Serialize)]
struct DesignAnswer<'a> {
    status: &'static str,
    objective: ObjectiveRow,
    seed: u64,
    controller: Factors,
    prefilter: Option<Factors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    prefilter_reason: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    continuous_law: Option<LawRow>,
    figures: FiguresRow,
    structure: StructureRow,
    verification: audit::VerifyAnswer<'a>,
    published: Option<PublishedRow<'a>>,
    /// In a sampled loop: the design that was made without samples, as it fares here.
    #[serde(skip_serializing_if = "Option::is_none")]
    continuous_as_sampled: Option<PublishedRow<'a>>,
    minimum_delay_margin_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    published_reason: Option<&'static str>,
    rounds: Vec<RoundRow>,
    starts: Option<StartsRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    starts_reason: Option<&'static str>,
    binding: Vec<LimitRow>,
    relaxation_db: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    relaxation_db_reason: Option<&'static str>,
    conflicts: Vec<LimitRow>,
    explanations: Vec<ExplanationRow<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rounding: Option<RoundingRow>,
    machine: Option<trial::TrialAnswer<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    machine_reason: Option<&'static str>,
    repair: Option<repair::RepairRow<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    repair_reason: Option<&'static str>,
}

/// Where the starts of the last search ended; of three numbers the best, the median and the worst.
#[derive(Serialize)]
struct StartsRow {
    tried: usize,
    stabilised: usize,
    ended: usize,
    worst_margin_db: Option<[f64; 3]>,
    objective_db: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct ObjectiveRow {
    kind: &'static str,
    value_db: Number,
}

/// A law that is sampled when it is deployed, as it was before.
#[derive(Serialize)]
struct LawRow {
    controller: Factors,
    prefilter: Factors,
}

#[derive(Serialize)]
struct FiguresRow {
    order: usize,
    relative_degree: i64,
    prefilter_order: usize,
    high_frequency_gain_db: Number,
    modulus_margin: Number,
    gain_margin_db: Number,
    gain_reduction_db: Number,
    phase_margin_deg: Number,
    crossover_rad_per_s: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
}

#[derive(Serialize)]
struct StructureRow {
    sign: f64,
    gain: [f64; 2],
    parts: Vec<PartRow>,
}

#[derive(Serialize)]
struct PartRow {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    frequency_rad_per_s: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    damping_ratio: Option<[f64; 2]>,
}

#[derive(Serialize)]
struct PublishedRow<'a> {
    controller: Factors,
    prefilter: Factors,
    figures: FiguresRow,
    verification: audit::VerifyAnswer<'a>,
}

#[derive(Serialize)]
struct RoundRow {
    structure: StructureRow,
    objective_db: Number,
    plants: usize,
    frequencies: usize,
    searched_margin_db: Number,
    audited_margin_db: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
}

/// A limit that is touched or in the way.
#[derive(Serialize)]
struct LimitRow {
    /// From 0, in file order.
    specification: usize,
    kind: &'static str,
    frequency_rad_per_s: Number,
    margin_db: Number,
    plant: NamedPlant,
}

#[derive(Serialize)]
struct ExplanationRow<'a> {
    sentence: &'a str,
    severity: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    frequency_rad_per_s: Option<Number>,
    plants: Vec<NamedPlant>,
    specifications: &'a [usize],
    #[serde(skip_serializing_if = "Option::is_none")]
    relaxation_db: Option<f64>,
}

/// The JSON object of `design`.
pub fn json(loaded: &Loaded, view: &ProjectDesign) -> Result<String, LinearError> {
    let design = &view.design;
    let has_prefilter = view.designed.problem.has_prefilter;
    let relaxation = match &design.status {
        DesignStatus::Infeasible(relaxation) => Some(relaxation),
        _ => None,
    };
    let body = DesignAnswer {
        status: status_key(view),
        objective: ObjectiveRow {
            kind: objective_key(view.options.objective),
            value_db: Number(design.objective_db),
        },
        seed: view.options.seed,
        controller: Factors::of(view.designed.problem.compensation.feedback()),
        prefilter: has_prefilter.then(|| Factors::of(view.designed.problem.compensation.prefilter())),
        prefilter_reason: (!has_prefilter).then_some("none is needed or wanted"),
        continuous_law: continuous_law(&view.designed)?,
        figures: figures(&view.designed),
        structure: structure(&design.structure),
        verification: audit::body(&view.designed.view),
        published: view.published.as_ref().map(published),
        continuous_as_sampled: view.continuous.as_ref().map(published),
        minimum_delay_margin_s: view.minimum_delay_margin_s,
        published_reason: view.published.is_none().then_some("the project gives no controller"),
        rounds: design.rounds.iter().map(round).collect(),
        starts: design.starts.as_ref().map(starts),
        starts_reason: design.starts.is_none().then_some("no search ended"),
        binding: design.binding.iter().map(|limit| binding(view, limit)).collect(),
        relaxation_db: relaxation.map(|relaxation| relaxation.relaxation_db),
        relaxation_db_reason: relaxation.is_none().then_some("the specifications were not found infeasible"),
        conflicts: relaxation.map_or_else(Vec::new, |relaxation| {
            relaxation.conflicts.iter().map(|one| conflict(view, one)).collect()
        }),
        explanations: view.explanations.iter().map(|one| explanation(view, one)).collect(),
        rounding: view.rounding.as_ref().map(|rounding| rounding::row(rounding, &view.designed.view.names)),
        machine: view.trial.as_ref().map(trial::body),
        machine_reason: view.trial.is_none().then_some(match view.stopped {
            true => "the design was stopped before it was tried on the machine",
            false => "the project describes a plant and no machine",
        }),
        repair: view.repair.as_ref().map(repair::row),
        repair_reason: view.repair.is_none().then_some(match view.agreement() {
            Agreement::Contradicts => "it was not asked for",
            Agreement::Agrees | Agreement::Differs => "no machine contradicts the design",
        }),
    };
    Ok(answer::json("design", loaded, body))
}

/// What a sampled loop's law is in continuous time, where it was given so.
fn continuous_law(side: &AuditedController) -> Result<Option<LawRow>, LinearError> {
    let Controller { feedback, prefilter, .. } = &side.controller;
    let law = feedback.transfer_function()?;
    let sampled = side.problem.compensation.sample_time_s().is_some();
    if !sampled || law.domain() != TimeDomain::Continuous {
        return Ok(None);
    }
    Ok(Some(LawRow {
        controller: Factors::of(&law),
        prefilter: Factors::of(&prefilter.transfer_function()?),
    }))
}

fn figures(side: &AuditedController) -> FiguresRow {
    let figures = &side.figures;
    let nominal = figures.nominal.as_ref();
    let missing = figures.modulus_margin.is_none() || nominal.is_none();
    FiguresRow {
        order: figures.order,
        relative_degree: figures.relative_degree,
        prefilter_order: figures.prefilter_order,
        high_frequency_gain_db: Number(figures.high_frequency_gain_db),
        modulus_margin: Number(figures.modulus_margin.unwrap_or(f64::NAN)),
        gain_margin_db: Number(nominal.map_or(f64::NAN, |margins| margins.gain_margin_db)),
        gain_reduction_db: Number(nominal.map_or(f64::NAN, |margins| margins.gain_reduction_db)),
        phase_margin_deg: Number(nominal.map_or(f64::NAN, |margins| margins.phase_margin_deg)),
        crossover_rad_per_s: Number(nominal.map_or(f64::NAN, |margins| margins.crossover_rad_per_s)),
        reason: missing
            .then_some("not known of a measured plant, or of a family that is not known to be stable"),
    }
}

fn structure(structure: &Structure) -> StructureRow {
    let part = |part: &StructureFactor| {
        let (frequency, damping_ratio) = match part {
            StructureFactor::Fixed(_) => (None, None),
            StructureFactor::RealZero { frequency } | StructureFactor::RealPole { frequency } => {
                (Some(*frequency), None)
            }
            StructureFactor::ZeroPair { natural_frequency, damping_ratio }
            | StructureFactor::PolePair { natural_frequency, damping_ratio } => {
                (Some(*natural_frequency), Some(*damping_ratio))
            }
        };
        PartRow { kind: part_key(part), frequency_rad_per_s: frequency, damping_ratio }
    };
    StructureRow {
        sign: structure.sign,
        gain: structure.gain,
        parts: structure.parts.iter().map(part).collect(),
    }
}

fn published(side: &AuditedController) -> PublishedRow<'_> {
    PublishedRow {
        controller: Factors::of(side.problem.compensation.feedback()),
        prefilter: Factors::of(side.problem.compensation.prefilter()),
        figures: figures(side),
        verification: audit::body(&side.view),
    }
}

fn starts(starts: &Starts) -> StartsRow {
    StartsRow {
        tried: starts.tried,
        stabilised: starts.stabilised,
        ended: starts.ended,
        worst_margin_db: starts.margins_db,
        objective_db: starts.objectives_db,
    }
}

fn round(round: &DesignRound) -> RoundRow {
    RoundRow {
        structure: structure(&round.structure),
        objective_db: Number(round.objective_db),
        plants: round.plants,
        frequencies: round.frequencies,
        searched_margin_db: Number(round.searched_margin_db),
        audited_margin_db: Number(round.audited_margin_db.unwrap_or(f64::NAN)),
        reason: round.audited_margin_db.is_none().then_some("the audit finds an unstable plant"),
    }
}

fn binding(view: &ProjectDesign, limit: &BindingLimit) -> LimitRow {
    limit_row(view, limit.specification, limit.frequency_rad_per_s, limit.margin_db, &limit.plant)
}

fn conflict(view: &ProjectDesign, conflict: &Conflict) -> LimitRow {
    limit_row(view, conflict.specification, conflict.frequency_rad_per_s, conflict.margin_db, &conflict.plant)
}

fn limit_row(
    view: &ProjectDesign,
    specification: usize,
    frequency_rad_per_s: f64,
    margin_db: f64,
    plant: &PlantPoint,
) -> LimitRow {
    let side = &view.designed;
    let names: &PlantNames = &side.view.names;
    let requirement = side.problem.specifications.get(specification).map(|one| &one.requirement);
    LimitRow {
        specification,
        kind: requirement.map_or("", audit::kind_key),
        frequency_rad_per_s: Number(frequency_rad_per_s),
        margin_db: Number(margin_db),
        plant: names.named(plant),
    }
}

fn explanation<'a>(view: &ProjectDesign, explanation: &'a Explanation) -> ExplanationRow<'a> {
    let names = &view.designed.view.names;
    ExplanationRow {
        sentence: &explanation.sentence,
        severity: if explanation.is_impossible { "impossible" } else { "warning" },
        frequency_rad_per_s: explanation.frequency_rad_per_s.map(Number),
        plants: explanation.plants.iter().map(|plant| names.named(plant)).collect(),
        specifications: &explanation.specifications,
        relaxation_db: explanation.relaxation_db,
    }
}
