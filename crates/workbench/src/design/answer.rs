mod repair;
mod rounding;

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_qft::design::{DesignRound, DesignStatus};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::verification::SpecificationMargin;

use super::AuditedController;
use super::structure_key;
use super::words::{objective_key, part_key, searched_limit_name, unusable_words, verdict_key};
use super::{DesignPart, Explanation, ProjectDesign};
use super::{limits, manual, pressure_feedback_object, relaxed, structures};
use crate::answer::{Describe, Json, Object};
use crate::audit;
use crate::explanation::explanation_sentence;
use crate::trial::{self, Agreement};

/// A design in JSON, without the keys of every object.
pub fn body(view: &ProjectDesign) -> Result<Object, LinearError> {
    let design = &view.design;
    let side = &view.designed;
    let prefilter = side.problem.has_prefilter.then(|| factors(side.problem.compensation.prefilter()));
    let relaxation = match &design.status {
        DesignStatus::Infeasible(relaxation) => Some(relaxation),
        _ => None,
    };
    let objective = Object::new()
        .with("kind", objective_key(view.options.objective))
        .with("value_db", design.objective_db);
    let starts = design.starts.as_ref().map(|starts| {
        // of three numbers the best, the median and the worst
        Object::new()
            .with("tried", starts.tried)
            .with("stabilised", starts.stabilised)
            .with("ended", starts.ended)
            .with("worst_margin_db", starts.margins_db)
            .with("objective_db", starts.objectives_db)
    });
    let no_repair = match view.agreement() == Agreement::Contradicts {
        true => "it was not asked for",
        false => "no machine contradicts the design",
    };
    Ok(Object::new()
        .with("status", verdict_key(&view.verdict()))
        .maybe("unusable", unusable_words(view))
        .with("unfinished", view.unfinished.iter().map(|part| part.key()).collect::<Vec<_>>())
        .with("objective", objective)
        .with("seed", view.options.seed)
        .with("controller", factors(side.problem.compensation.feedback()))
        .known("prefilter", prefilter, "no prefilter is needed or requested")
        .maybe("pressure_feedback", view.pressure_feedback.as_ref().map(pressure_feedback_object))
        .maybe("continuous_law", continuous_law(side)?)
        .with("figures", figures(side))
        .and(of_structures(view))
        .with("verification", audit::body(&side.view).into_json())
        .with("published", view.published.as_deref().map(audited))
        .maybe("continuous_as_sampled", view.continuous.as_deref().map(audited))
        .with("minimum_delay_margin_s", view.minimum_delay_margin_s)
        .with("limits", limits::rows(view))
        .with("reserve_db", view.options.reserve_db)
        .maybe("published_reason", why_not_published(view))
        .each("rounds", &design.rounds, round)
        .known("starts", starts, "no search ended")
        .each("binding", &design.binding, |limit| limit_row(view, limit))
        .with("relaxations", relaxed::rows(view))
        .known(
            "relaxation_db",
            relaxation.map(|relaxation| relaxation.relaxation_db),
            "the specifications were not found infeasible",
        )
        .with("conflicts", conflicts(view))
        .each("explanations", &view.explanations, |one| explanation(view, one))
        .maybe("rounding", view.rounding.as_ref().map(|rounding| rounding::row(rounding, &side.view.names)))
        .known(
            "machine",
            view.trial.as_ref().map(|trial| trial::body(trial).into_json()),
            why_not_tried(view),
        )
        .known("repair", view.repair.as_ref().map(|repair| repair::row(view, repair)), no_repair))
}

/// The reason for the absence of a trial.
fn why_not_tried(view: &ProjectDesign) -> &'static str {
    match view.unfinished.contains(&DesignPart::Trial) {
        true => "the design was stopped before it was tried in the nonlinear simulation",
        false => "the project describes a plant and no machine",
    }
}

/// The reason for the absence of the given controller.
fn why_not_published(view: &ProjectDesign) -> Option<&'static str> {
    view.published.is_none().then_some(match view.unfinished.contains(&DesignPart::GivenController) {
        true => "the design was stopped before the given controller was audited",
        false => "the project gives no controller",
    })
}

/// The structure, what others reached, and the law in the words of a manual.
fn of_structures(view: &ProjectDesign) -> Object {
    let design = &view.design;
    let name = design.name.map(|name| structure_key(Some(name)));
    let gap = view.manual.as_ref().err().map_or(String::new(), ToString::to_string);
    Object::new()
        .with("structure", structure(&design.structure).maybe("name", name))
        .known("manual", view.manual.as_ref().ok().map(manual::object), &gap)
        .with("structures", structures::rows(view))
        .with("led_by", structures::led_key(view.led_by))
        .maybe("earned_per_pole_db", structures::earned_per_pole_db(view))
}

/// k Π(s - z)/Π(s - p), or the same in z.
pub(super) fn factors(function: &TransferFunction) -> Object {
    let (domain, sample_time_s) = match function.domain() {
        TimeDomain::Continuous => ("s", None),
        TimeDomain::Discrete { sample_time_s } => ("z", Some(sample_time_s)),
    };
    // a negative zero is one that nobody wrote
    let pair = |root: &num_complex::Complex64| Json::from([root.re + 0.0, root.im + 0.0]);
    Object::new()
        .with("gain", function.gain())
        .each("zeros", function.zeros(), pair)
        .each("poles", function.poles(), pair)
        .with("domain", domain)
        .known("sample_time_s", sample_time_s, "it is continuous")
}

/// The continuous-time form of the controller of a sampled loop, if it was given in this form.
fn continuous_law(side: &AuditedController) -> Result<Option<Object>, LinearError> {
    let Controller { feedback, prefilter, .. } = &side.controller;
    let law = feedback.transfer_function()?;
    let sampled = side.problem.compensation.sample_time_s().is_some();
    if !sampled || law.domain() != TimeDomain::Continuous {
        return Ok(None);
    }
    let prefilter = factors(&prefilter.transfer_function()?);
    Ok(Some(Object::new().with("controller", factors(&law)).with("prefilter", prefilter)))
}

fn figures(side: &AuditedController) -> Object {
    let figures = &side.figures;
    let nominal = figures.nominal.as_ref();
    let missing = figures.modulus_margin.is_none() || nominal.is_none();
    let reason = "the loop is not known to be stable";
    Object::new()
        .with("order", figures.order)
        .with("relative_degree", figures.relative_degree)
        .with("prefilter_order", figures.prefilter_order)
        .with("high_frequency_gain_db", figures.high_frequency_gain_db)
        .with("high_frequency_gain_of", if side.is_in_z() { "law_in_z" } else { "continuous_law" })
        .with("modulus_margin", figures.modulus_margin)
        .with("gain_margin_db", nominal.map(|margins| margins.gain_margin_db))
        .with("gain_reduction_db", nominal.map(|margins| margins.gain_reduction_db))
        .with("phase_margin_deg", nominal.map(|margins| margins.phase_margin_deg))
        .and(structures::crossovers(nominal))
        .maybe("reason", missing.then_some(reason))
}

fn structure(structure: &Structure) -> Object {
    Object::new().with("sign", structure.sign).with("gain", structure.gain).each(
        "parts",
        &structure.parts,
        |part| {
            let (frequency, damping_ratio, depth) = match *part {
                StructureFactor::Fixed(_) => (None, None, None),
                StructureFactor::RealZero { frequency } | StructureFactor::RealPole { frequency } => {
                    (Some(frequency), None, None)
                }
                StructureFactor::ZeroPair { natural_frequency, damping_ratio }
                | StructureFactor::PolePair { natural_frequency, damping_ratio } => {
                    (Some(natural_frequency), Some(damping_ratio), None)
                }
                StructureFactor::Notch { natural_frequency, damping_ratio, depth } => {
                    (Some(natural_frequency), Some(damping_ratio), Some(depth))
                }
            };
            Object::new()
                .with("kind", part_key(part))
                .maybe("frequency_rad_per_s", frequency)
                .maybe("damping_ratio", damping_ratio)
                .maybe("depth", depth)
        },
    )
}

/// A controller with its audit.
fn audited(side: &AuditedController) -> Object {
    Object::new()
        .with("controller", factors(side.problem.compensation.feedback()))
        .with("prefilter", factors(side.problem.compensation.prefilter()))
        .with("figures", figures(side))
        .with("verification", audit::body(&side.view).into_json())
}

fn round(round: &DesignRound) -> Object {
    let unstable = round.audited_margin_db.is_none().then_some("the audit finds an unstable plant");
    Object::new()
        .with("structure", structure(&round.structure))
        .with("objective_db", round.objective_db)
        .with("plants", round.plants)
        .with("frequencies", round.frequencies)
        .with("searched_margin_db", round.searched_margin_db)
        .with("audited_margin_db", round.audited_margin_db)
        .maybe("reason", unstable)
}

/// What conflicts where the search can do no better.
fn conflicts(view: &ProjectDesign) -> Vec<Object> {
    let DesignStatus::Infeasible(relaxation) = &view.design.status else { return vec![] };
    relaxation.conflicts.iter().map(|conflict| limit_row(view, conflict)).collect()
}

/// A limit that is touched or in the way; specifications are counted from 0, in file order.
fn limit_row(view: &ProjectDesign, margin: &SpecificationMargin) -> Object {
    let (side, specification) = (&view.designed, margin.specification);
    let requirement = side.problem.specifications.get(specification).map(|one| &one.requirement);
    Object::new()
        .with("specification", specification)
        .with("name", searched_limit_name(view, view.searched_limit(specification)))
        .with("kind", requirement.map_or("", crate::specification::kind_key))
        .with("frequency_rad_per_s", margin.frequency_rad_per_s)
        .with("margin_db", margin.margin_db)
        .with("plant", side.view.names.named(&margin.plant))
}

fn explanation(view: &ProjectDesign, explanation: &Explanation) -> Object {
    let names = &view.designed.view.names;
    Object::new()
        .with("sentence", explanation_sentence(explanation))
        .with("severity", if explanation.is_impossible { "impossible" } else { "warning" })
        .maybe("frequency_rad_per_s", explanation.frequency_rad_per_s)
        .each("plants", &explanation.plants, |plant| names.named(plant))
        .with("specifications", explanation.specifications.as_slice())
        .maybe("relaxation_db", explanation.relaxation_db)
}
