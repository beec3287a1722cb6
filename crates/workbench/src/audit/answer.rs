use phea_qft::proof::{Certificate, Proof, Standing};
use phea_qft::verification::{
    Evidence, SearchedInfinity, SpecificationFinding, SpecificationMargin, StabilityFinding, Verdict,
};

use super::in_time::unexamined_words;
use super::proven::why_not_proven;
use super::remark::remark_sentences;
use super::signal_noise::unknown_words;
use super::stability_reason;
use super::words::evidence_key;
use super::{
    NoisySignal, PrefilterGain, ProjectAudit, ReachedLimit, SignalNoise, TimeFinding, TimeOutcome, WorstStep,
};
use super::{below_design, margins};
use crate::answer::{Csv, Object, OutputFile, envelope};
use crate::caveat;
use crate::plant_names::PlantNames;
use crate::project::Loaded;
use crate::quantity::{FORCE, LENGTH, QuantityName, VELOCITY};
use crate::specification::{SpecificationName, kind_key, subject_words};
use crate::verdict_words::verdict_key;
use phea_engineering::limit_kind::limit_key;

/// The JSON object of `verify`, as a file.
pub(crate) fn json(loaded: &Loaded, view: &ProjectAudit) -> String {
    envelope("verify", loaded).and(body(view)).print(loaded.project.motion())
}

/// An audit in JSON, without the keys of every object.
pub(crate) fn body(view: &ProjectAudit) -> Object {
    let (audit, names) = (&view.audit, &view.names);
    let (stability, margin) = (&audit.stability, audit.delay_margin.as_ref());
    let of_stability = Object::new()
        .with("verdict", verdict_key(stability.verdict))
        .with("evidence", evidence_key(stability.evidence))
        .with("largest_real_part_per_s", stability.largest_real_part)
        .with("plant", names.named(&stability.plant))
        .with("reason", stability_reason(stability));
    let of_stability = match &stability.infinity {
        Some(found) => of_stability.with("leading_coefficient", leading_coefficient(found, names)),
        None => of_stability,
    };
    let proof = view.proof.as_ref().map(|proof| {
        Object::new()
            .with("stable", standing(view, proof, &proof.stability))
            .with("leaves", proof.certificate.as_ref().map_or(0, Certificate::leaves))
    });
    let delay_margin = margin.map(|margin| {
        Object::new()
            .with("frequency_rad_per_s", margin.frequency_rad_per_s)
            .with("plant", names.named(&margin.plant))
    });
    let timing = Object::new()
        .known("sample_time_s", view.sample_time_s, "the controller is continuous")
        .with("delay_s", view.delay_s);
    let position = view.position.as_ref().map(|taken| {
        Object::new()
            .with(QuantityName::OfMotion(["position", "angle"], &LENGTH), taken.position)
            .with(QuantityName::moving("stroke", &LENGTH), taken.stroke)
    });
    let reduction = view.nominal.map(|margins| margins.gain_reduction_db);
    let no_margin = "no margin: not every plant is known to be stable";
    let own = Object::new()
        .with("verdict", verdict_key(view.verdict()))
        .with("evidence", evidence_key(view.evidence()))
        .with("tolerance_db", audit.tolerance_db)
        .and(stable(stability))
        .with("stability", of_stability)
        .maybe("proof", proof)
        .known("delay_margin_s", margin.map(|margin| margin.delay_s), no_margin)
        .maybe("delay_margin", delay_margin)
        .known("gain_reduction_db", reduction, margins::NO_NOMINAL)
        .with("margins", margins::object(view))
        .with("members", view.members)
        .maybe("position", position)
        .with("parameters", names.headings())
        .with("timing", timing)
        .maybe("velocity_noise", view.velocity_noise.as_ref().map(|noise| signal_noise(noise, names)))
        .maybe("pressure_noise", view.pressure_noise.as_ref().map(|noise| signal_noise(noise, names)))
        .maybe("amplifying_prefilter", view.amplifying_prefilter.map(amplifying))
        .each("specifications", in_file_order(view), |one| one)
        .with("warnings", caveat::sentences(&view.caveats, &view.units));
    match &view.below_design {
        Some(limits) => own.each("below_design", &limits.exceeded, below_design::object).each(
            "kept_of_design",
            &limits.kept,
            |kind| limit_key(*kind),
        ),
        None => own,
    }
}

/// The limits on closed loops and the requirements on steps, as the file has them; what has no
/// number in it, such as a limit on rounding, comes last.
fn in_file_order(view: &ProjectAudit) -> Vec<Object> {
    let mut steps = view.in_time.iter().filter(|finding| finding.requirement.limits.is_none()).peekable();
    let mut ordered = Vec::new();
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        while let Some(step) = steps.next_if(|step| step.requirement.number == ordered.len() + 1) {
            ordered.push(step_specification(&view.names, step));
        }
        ordered.push(specification(view, index, finding));
    }
    ordered.extend(steps.map(|step| step_specification(&view.names, step)));
    ordered
}

/// A requirement on steps: the plant is that of the property that is nearest to its limit or
/// furthest beyond.
fn step_specification(names: &PlantNames, finding: &TimeFinding) -> Object {
    let nearest = finding.nearest().map(|worst| names.named(&worst.plant));
    Object::new().with("kind", "step").and(in_time(names, finding)).with("plant", nearest)
}

/// The prefilter, where it amplifies.
fn amplifying(gain: PrefilterGain) -> Object {
    Object::new()
        .with("gain_at_zero", gain.at_zero)
        .with("largest_gain", gain.largest)
        .with("rise_db", gain.rise_db())
        .with("frequency_rad_per_s", gain.frequency_rad_per_s)
}

/// The noise of a velocity that is fed forward or of pressures that are fed back, with its effects.
fn signal_noise(noise: &SignalNoise, names: &PlantNames) -> Object {
    let effect = noise.effect.as_ref();
    let (of, reason) = (effect.ok(), effect.err().map_or(String::new(), unknown_words));
    let rms = match noise.signal {
        NoisySignal::LoadVelocity => QuantityName::moving("rms", &VELOCITY),
        NoisySignal::Pressures => QuantityName::Fixed("rms_pa"),
    };
    Object::new()
        .with(rms, noise.rms)
        .known("command_rms_v", of.map(|effect| effect.command_rms_v), &reason)
        .maybe("command_plant", of.map(|effect| names.named(&effect.command_plant)))
        .known(
            QuantityName::OfMotion(["force_rms", "torque_rms"], &FORCE),
            of.map(|effect| effect.force_rms_n),
            &reason,
        )
        .maybe("force_plant", of.map(|effect| names.named(&effect.force_plant)))
}

/// Whether every plant is stable, as far as that is known.
pub(crate) fn stable(stability: &StabilityFinding) -> Object {
    let stable = match stability.verdict {
        Verdict::Met => Some(true),
        Verdict::Violated => Some(false),
        Verdict::NotProven => None,
    };
    Object::new().known("stable", stable, &stability_reason(stability))
}

fn specification(view: &ProjectAudit, index: usize, finding: &SpecificationFinding) -> Object {
    let names = &view.names;
    let worst = finding.worst.as_ref();
    let other = worst.and_then(|worst| worst.other.as_ref());
    let is_other = |name: &&SpecificationName| !matches!(name, SpecificationName::ClosedLoop(_));
    let name = view.specification_names.get(index).filter(is_other);
    let reached = view.reached.get(index).copied().flatten();
    Object::new()
        .with("kind", kind_key(&finding.requirement))
        .maybe("name", name.map(|name| subject_words(*name)))
        .with("verdict", verdict_key(finding.verdict))
        .with("evidence", evidence_key(finding.evidence))
        .with("worst_margin_db", worst.map(|worst| worst.margin_db))
        .with("frequency_rad_per_s", worst.map(|worst| worst.frequency_rad_per_s))
        .with("plant", worst.map(|worst| names.named(&worst.plant)))
        .maybe("other_plant", other.map(|other| names.named(other)))
        .maybe("reason", worst.is_none().then_some("there is no margin; see remarks"))
        .maybe(
            "reached",
            reached.map(|ReachedLimit { magnitude, limit, .. }| {
                Object::new().with("magnitude", magnitude).with("limit", limit)
            }),
        )
        .maybe("interior", finding.interior.as_ref().map(|worst| margin(names, worst)))
        .and(specification_proof(view, index).unwrap_or_default())
        .maybe("in_time", view.in_time_of(index).map(|finding| in_time(names, finding)))
        .each("violations", &finding.violations, |band| {
            Object::new().with("band_rad_per_s", band.band_rad_per_s).and(margin(names, &band.worst))
        })
        .each("at_design_frequencies", &finding.at_design_frequencies, |worst| margin(names, worst))
        .with("remarks", remark_sentences(finding, names))
}

pub(crate) fn margin(names: &PlantNames, worst: &SpecificationMargin) -> Object {
    Object::new()
        .with("frequency_rad_per_s", worst.frequency_rad_per_s)
        .with("margin_db", worst.margin_db)
        .with("plant", names.named(&worst.plant))
        .maybe("other_plant", worst.other.as_ref().map(|other| names.named(other)))
}

/// The requirement in time that the limits follow from, and the worst steps.
fn in_time(names: &PlantNames, finding: &TimeFinding) -> Object {
    let wish = &finding.requirement.wish;
    let required = Object::new()
        .maybe("overshoot_percent", wish.overshoot_percent)
        .maybe("settling_time_s", wish.settling_time_s)
        .maybe("rise_time_s", wish.rise_time_s)
        .with("settling_band_percent", wish.band_percent);
    let (searched, reason) = match &finding.outcome {
        TimeOutcome::Searched { plants, overshoot, settling, rise } => {
            (Some((*plants, [overshoot, settling, rise])), String::new())
        }
        TimeOutcome::NotExamined(why) => (None, unexamined_words(why)),
    };
    let object = Object::new()
        .known("verdict", finding.verdict().map(verdict_key), &reason)
        .with("part_of_verdict", finding.requirement.follows)
        .with("required", required);
    let Some((plants, worst)) = searched else { return object };
    let [overshoot, settling, rise] = worst.map(Option::as_ref);
    let named = |worst: &WorstStep| names.named(&worst.plant);
    object
        .with("evidence", evidence_key(Evidence::Search))
        .with("plants", plants)
        .maybe("worst_overshoot_percent", overshoot.map(|worst| worst.value))
        .maybe("overshoot_plant", overshoot.map(named))
        .maybe("worst_settling_time_s", settling.map(|worst| worst.value))
        .maybe("settling_plant", settling.map(named))
        .maybe("worst_rise_time_s", rise.map(|worst| worst.value))
        .maybe("rise_plant", rise.map(named))
}

/// Whether a claim is proven: false where it is refuted, `null` where it is neither.
fn standing(view: &ProjectAudit, proof: &Proof, standing: &Standing) -> Object {
    let proven = match standing {
        Standing::Proven => Some(true),
        Standing::Refuted => Some(false),
        Standing::NotProven(_) => None,
    };
    Object::new().with("proven", proven).maybe("proven_reason", why_not_proven(view, proof, standing))
}

/// The same for a specification, with bounds of the greatest ratio of closed loop to limit.
fn specification_proof(view: &ProjectAudit, index: usize) -> Option<Object> {
    let proof = view.proof.as_ref()?;
    let own = proof.specifications.get(index)?;
    let ends = [own.least_db, own.most_db];
    let missing = ends.contains(&None).then_some("it was not found; see proven_reason");
    let standing = standing(view, proof, &own.standing);
    Some(standing.with("enclosure_db", ends).maybe("enclosure_db_reason", missing))
}

/// The family's worst margins over frequency as a table for other programs.
pub fn files(view: &ProjectAudit) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,worst_margin_db");
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for (frequency, margin) in &finding.envelope {
            csv.row(&[&index, &kind_key(&finding.requirement), frequency, margin]);
        }
    }
    vec![OutputFile::new("margins.csv", csv.text())]
}

/// The least leading coefficient of the characteristic equation that a search found.
fn leading_coefficient(found: &SearchedInfinity, names: &PlantNames) -> Object {
    let all = names.headings();
    let moved = found.parameters.iter().filter_map(|&index| all.get(index).copied());
    Object::new()
        .with("least_share_of_nominal", found.least_share)
        .with("plant", names.named(&found.plant))
        .with("parameters", moved.map(str::to_string).collect::<Vec<String>>())
}
