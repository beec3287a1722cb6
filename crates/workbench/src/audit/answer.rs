//! The answer of `verify`, and the audit in other answers.

mod noise;
mod specification;
mod stability;

use phea_engineering::audit::{PrefilterGain, ProjectAudit};
use phea_engineering::limit_kind::DesignLimitKind;
use phea_engineering::plant_names::NamedPlant;
use phea_engineering::specification::kind_key;
use phea_qft::verification::{Evidence, Verdict};

use super::below_design::{self, ExceededLimitAnswer};
use super::margins::{self, AuditMarginsAnswer};
use crate::answer::{Answer, Body, Csv, OrReason, OutputFile, envelope};
use crate::caveat;
use crate::project::Loaded;
use crate::quantity::{LENGTH, QuantityName};
use crate::specification::number_cell;
use noise::{PressureNoiseAnswer, VelocityNoiseAnswer, pressure_noise, velocity_noise};
use specification::{AuditedSpecification, in_file_order};
use stability::{AuditProofAnswer, StabilityAnswer, proof, stability};

pub(crate) use specification::{SpecificationMarginAnswer, margin};
pub(crate) use stability::{StableAnswer, stable};

/// Audit of a controller and prefilter over the family and the frequency band.
#[derive(Answer)]
pub(crate) struct AuditAnswer {
    /// Verdict on stability and all specifications.
    verdict: Verdict,
    /// Weakest evidence behind the verdict.
    evidence: Evidence,
    /// Violation that still counts as met.
    tolerance_db: f64,
    #[answer(flatten)]
    stable: StableAnswer,
    /// Stability of the family.
    stability: StabilityAnswer,
    /// Proof of stability over the box, if a proof was requested.
    #[answer(optional)]
    proof: Option<AuditProofAnswer>,
    /// Least additional delay that makes a plant of the family unstable.
    delay_margin_s: OrReason<f64>,
    /// Place of the delay margin.
    #[answer(optional)]
    delay_margin: Option<DelayMarginAnswer>,
    /// Factor to which the gain of the nominal loop may fall, negative; `-inf` if it may vanish.
    gain_reduction_db: OrReason<f64>,
    /// Margins of the nominal loop and the worst of the family.
    margins: AuditMarginsAnswer,
    /// Number of plants of the family.
    members: usize,
    /// Position of every plant, only if all plants have it and a rig is declared.
    #[answer(optional)]
    position: Option<CommonPositionAnswer>,
    /// Names of the parameters of a plant, in the order of the tables in files.
    parameters: Vec<String>,
    /// Sampling and delay of the loop.
    timing: TimingAnswer,
    /// Noise of the load velocity that is fed forward, if a sensor measures it.
    #[answer(optional)]
    velocity_noise: Option<VelocityNoiseAnswer>,
    /// Noise of the pressures that are fed back, if any.
    #[answer(optional)]
    pressure_noise: Option<PressureNoiseAnswer>,
    /// Gain of the prefilter, only if it amplifies.
    #[answer(optional)]
    amplifying_prefilter: Option<AmplifyingPrefilterAnswer>,
    /// Findings in the order of the specifications in the file; those without a number in the file,
    /// such as a limit on rounding, are last.
    specifications: Vec<AuditedSpecification>,
    /// Declared effects that the audit does not include.
    warnings: Vec<String>,
    /// Limits of a design that the loop exceeds, which are no part of the verdict.
    #[answer(optional)]
    below_design: Option<Vec<ExceededLimitAnswer>>,
    /// Limits of a design that the loop satisfies.
    #[answer(optional)]
    satisfied_limits_of_design: Option<Vec<DesignLimitKind>>,
}

/// Place of the delay margin.
#[derive(Answer)]
struct DelayMarginAnswer {
    /// Gain crossover at which the loop becomes unstable.
    frequency_rad_per_s: f64,
    /// Plant that becomes unstable.
    plant: NamedPlant,
}

/// Sampling and delay of a loop.
#[derive(Answer)]
struct TimingAnswer {
    /// Sample time of the controller.
    sample_time_s: OrReason<f64>,
    /// Delay of the loop in addition to sampling.
    delay_s: f64,
}

/// Position that no plant of the family varies.
#[derive(Answer)]
struct CommonPositionAnswer {
    /// Position from the end of chamber A.
    #[answer(key = QuantityName::OfMotion(["position", "angle"], &LENGTH))]
    position: f64,
    /// Length of the stroke.
    #[answer(key = QuantityName::moving("stroke", &LENGTH))]
    stroke: f64,
}

/// Gain of a prefilter F that amplifies.
#[derive(Answer)]
struct AmplifyingPrefilterAnswer {
    /// Gain |F(0)|.
    gain_at_zero: f64,
    /// Largest |F|.
    largest_gain: f64,
    /// Ratio of the largest gain to the one at zero frequency.
    rise_db: f64,
    /// Frequency of the largest gain.
    frequency_rad_per_s: f64,
}

impl From<PrefilterGain> for AmplifyingPrefilterAnswer {
    fn from(gain: PrefilterGain) -> Self {
        AmplifyingPrefilterAnswer {
            gain_at_zero: gain.at_zero,
            largest_gain: gain.largest,
            rise_db: gain.rise_db(),
            frequency_rad_per_s: gain.frequency_rad_per_s,
        }
    }
}

/// The JSON object of `verify`, as a file.
pub(crate) fn json(loaded: &Loaded, view: &ProjectAudit) -> String {
    envelope("verify", loaded).and(body(view).into_object()).print(loaded.project.motion())
}

/// An audit in JSON, without the keys of every object.
pub(crate) fn body(view: &ProjectAudit) -> AuditAnswer {
    let (audit, names) = (&view.audit, &view.names);
    let margin = audit.delay_margin.as_ref();
    let no_margin = "no margin: not every plant is known to be stable";
    let (exceeded, satisfied) =
        view.below_design.clone().map(|limits| (limits.exceeded, limits.satisfied)).unzip();
    AuditAnswer {
        verdict: view.verdict(),
        evidence: view.evidence(),
        tolerance_db: audit.tolerance_db,
        stable: stable(&audit.stability),
        stability: stability(&audit.stability, names),
        proof: view.proof.as_ref().map(|own| proof(view, own)),
        delay_margin_s: OrReason::new(margin.map(|margin| margin.delay_s), no_margin),
        delay_margin: margin.map(|margin| DelayMarginAnswer {
            frequency_rad_per_s: margin.frequency_rad_per_s,
            plant: names.named(&margin.plant),
        }),
        gain_reduction_db: OrReason::new(
            view.nominal.map(|margins| margins.gain_reduction_db),
            margins::NO_NOMINAL,
        ),
        margins: margins::answer(view),
        members: view.members,
        position: view
            .position
            .as_ref()
            .map(|common| CommonPositionAnswer { position: common.position, stroke: common.stroke }),
        parameters: names.headings().into_iter().map(str::to_string).collect(),
        timing: TimingAnswer {
            sample_time_s: OrReason::new(view.sample_time_s, "the controller is continuous"),
            delay_s: view.delay_s,
        },
        velocity_noise: view.velocity_noise.as_ref().map(|noise| velocity_noise(noise, names)),
        pressure_noise: view.pressure_noise.as_ref().map(|noise| pressure_noise(noise, names)),
        amplifying_prefilter: view.amplifying_prefilter.map(Into::into),
        specifications: in_file_order(view),
        warnings: caveat::sentences(&view.caveats, &view.units),
        below_design: exceeded.map(|all| all.iter().map(below_design::answer).collect()),
        satisfied_limits_of_design: satisfied,
    }
}

/// The family's worst margins over frequency as a table for other programs.
pub fn files(view: &ProjectAudit) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,worst_margin_db");
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        let number = number_cell(view.number_of(index));
        for (frequency, margin) in &finding.envelope {
            csv.row(&[&number, &kind_key(&finding.requirement), frequency, margin]);
        }
    }
    vec![OutputFile::new("margins.csv", csv.text())]
}
