//! Evidence for models of the leakage and for terms of the valve, for programs.

use std::collections::BTreeMap;

use phea_engineering::identify::{COEFFICIENT_NAMES, ExplainedBy, Identification, TermEvidence, ValveTerm};
use phea_hydraulics::servovalve::{LeakageModel, StaticCoefficients};

use crate::answer::{Answer, KeyList, Keyed, ObjectKey, words};
use crate::project::LEAKAGE_MODELS;

/// Evidence for a term of the valve.
#[derive(Answer)]
pub(super) struct ValveTermAnswer {
    /// Term in addition to edges that open in proportion and leak in one shape.
    term: ValveTerm,
    /// Decrease of the information criterion by the term; negative if the term does not explain
    /// enough for its coefficients.
    criterion_gain: f64,
    /// True if the valve is identified with the term.
    taken: bool,
}

/// Fit with one model of the leakage.
#[derive(Answer)]
pub(super) struct LeakageFitAnswer {
    /// Model of the leakage.
    model: LeakageModel,
    /// Information criterion of Schwarz: the lower, the better; its zero has no meaning.
    criterion: f64,
    /// Root mean square of all residuals, each over the range of its signal.
    residual_rms: f64,
    /// Coefficients of the fit.
    coefficients: CoefficientValuesAnswer,
}

/// Coefficients of a valve by their names in the table `[valve]`, in SI.
#[derive(Answer)]
pub(super) struct CoefficientValuesAnswer {
    #[answer(flatten)]
    values: Keyed<CoefficientKeys, f64>,
}

/// Names of the coefficients.
pub(super) struct CoefficientKeys;

impl KeyList for CoefficientKeys {
    fn keys() -> Vec<(ObjectKey, String)> {
        let key = |(name, unit): (&'static str, &'static str)| {
            let description = match unit {
                "1" => format!("Value of `valve.{name}`, dimensionless."),
                unit => format!("Value of `valve.{name}` in {unit}."),
            };
            (ObjectKey::from(name), description)
        };
        COEFFICIENT_NAMES.map(key).to_vec()
    }
}

words! {
    /// Dependence of the leakage on the spool position.
    LeakageModel in LEAKAGE_MODELS
}

words! {
    /// Term that a valve may have in addition to edges that open in proportion and leak in one
    /// shape.
    ValveTerm by ValveTerm::name [Lap, Saturation, LeakageByEdge]
}

pub(super) fn term(evidence: &TermEvidence) -> ValveTermAnswer {
    let TermEvidence { term, gain, taken } = *evidence;
    ValveTermAnswer { term, criterion_gain: gain, taken }
}

pub(super) fn leakage_models(found: &Identification) -> [LeakageFitAnswer; 2] {
    found.evidence.models.each_ref().map(|explained: &ExplainedBy| LeakageFitAnswer {
        model: explained.model,
        criterion: explained.criterion,
        residual_rms: explained.residual_rms,
        coefficients: values_by_name(found, &explained.coefficients),
    })
}

/// The coefficients of the model of the numbers, in the order of the alphabet.
pub(super) fn values_by_name(
    found: &Identification,
    coefficients: &StaticCoefficients,
) -> CoefficientValuesAnswer {
    let all = coefficients.to_array();
    let one = |index: usize| Some((COEFFICIENT_NAMES.get(index)?.0, *all.get(index)?));
    let sorted: BTreeMap<&'static str, f64> = found.in_model().filter_map(one).collect();
    CoefficientValuesAnswer {
        values: Keyed::new(sorted.into_iter().map(|(name, value)| (ObjectKey::from(name), value))),
    }
}
