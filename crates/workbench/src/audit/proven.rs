//! Proven claims, and the reasons why others are not, in words.

use phea_qft::proof::{ClaimStatus, NotProven, Proof, ProofRegion};

use super::ProjectAudit;
use super::words::rounded;

/// The outcome of a claim, in a word.
pub(super) fn status_word(claim_status: &ClaimStatus) -> &'static str {
    match claim_status {
        ClaimStatus::Proven => "proven",
        ClaimStatus::Refuted => "refuted",
        ClaimStatus::NotProven(_) => "not proven",
    }
}

/// Reason why a claim is neither proven nor refuted, in a sentence without its full stop; `None` if
/// it is proven or refuted.
pub(super) fn why_not_proven(
    view: &ProjectAudit,
    proof: &Proof,
    claim_status: &ClaimStatus,
) -> Option<String> {
    let ClaimStatus::NotProven(reason) = claim_status else { return None };
    Some(match reason {
        NotProven::Measured => {
            "the plants were measured, and between two of them nothing can be claimed".into()
        }
        NotProven::Images => {
            "the loop is sampled, and the response of the plant could not be bounded beyond the images".into()
        }
        NotProven::BeyondSampling => "its band lies beyond half the sampling frequency".into(),
        NotProven::RateFedForward => {
            "the load's velocity is fed forward, which the prover does not yet cover".into()
        }
        NotProven::InnerFeedback => {
            "a sampled controller feeds the pressures back, which the prover does not yet cover".into()
        }
        NotProven::Waves => "waves travel in the lines, so that the plant has no polynomials".into(),
        NotProven::NotPolynomial => {
            format!(
                "the coefficients of the plant could not be enclosed by polynomials of the uncertain numbers{}",
                sought_point(view)
            )
        }
        NotProven::TooManyVariables => "the box has too many uncertain numbers".into(),
        NotProven::TableLimit => "its limit is a table without two points within its band".into(),
        NotProven::Spread => "there is no prefilter, and a spread is not the ratio of one plant".into(),
        NotProven::Unstable => "the loop is not proven to be stable".into(),
        NotProven::Unbounded => "the ratio grows, and no maximum was found".into(),
        NotProven::NoStableMember => "no plant could be shown to be stable or unstable".into(),
        NotProven::Rounding => "the checker, which rounds outwards, could not confirm it".into(),
        NotProven::Contradicted => {
            "the search found a plant and a frequency that violate it, which is a defect of search or proof"
                .into()
        }
        NotProven::Budget(region) => {
            let [from, to] = region.band_rad_per_s.map(rounded);
            format!(
                "the boxes that one claim may take are used up: between {from} and {to} rad/s it remains open{}",
                part_of(view, proof, region)
            )
        }
    })
}

/// The part of the box that remains, if it is smaller than the box.
fn part_of(view: &ProjectAudit, proof: &Proof, region: &ProofRegion) -> String {
    let Some(certificate) = &proof.certificate else { return String::new() };
    let segments = certificate.plant.boxes.get(region.of_box).into_iter().flatten();
    let sides = segments.zip(view.names.headings()).filter_map(|(one, name)| {
        let [from, to] = *region.variables.get(one.variable?)?;
        let [least, most] = [one.value(from), one.value(to)];
        (from > 0.0 || to < 1.0).then(|| format!("{name} from {least:.4e} to {most:.4e}"))
    });
    let sides: Vec<String> = sides.collect();
    if sides.is_empty() { String::new() } else { format!(", for {}", sides.join(", ")) }
}

/// Remark on the operating point of each plant, which is not enclosed.
fn sought_point(view: &ProjectAudit) -> &'static str {
    let headings = view.names.headings();
    let sought = ["operating_point.load_force", "operating_point.load_pressure", "operating_point.velocity"];
    match headings.iter().any(|name| sought.contains(name)) {
        true => {
            ": they do not follow the command that holds a load or a velocity through null of the spool, with a pump that is limited, or where \
             more than three numbers move it; ranges of `flow_gain`, \
             `flow_pressure_coefficient` and `hydraulic_stiffness` can be proven, and `check` prints those of this family"
        }
        false => "",
    }
}
