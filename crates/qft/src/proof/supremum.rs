//! The supremum of a ratio, enclosed: from below by points, from above by trees.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};

use super::certificate::{Certificate, CertificateMember, FrequencyPanel, LimitedLoop};
use super::claimed::{BandClaim, Claimed, Loop};
use super::panels::{frequencies, walk_band};
use super::part::{PolynomialProduct, number};
use super::patch::at_point;
use super::polynomial::InS;
use super::walk::{ProofEffort, ProofRegion, WalkOutcome};

/// Corners of a box that are evaluated before any proof.
const CORNERS_MAXIMUM: usize = 64;
/// Number of times that a tree may be restarted because the supremum turned out to be greater.
const RAISES_MAXIMUM: usize = 48;
/// The amount by which a reached ratio is reduced, so that rounding cannot invalidate it.
const ROUNDED: f64 = 1e-9;

/// A plant and a frequency.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlantAtFrequency {
    pub(super) frequency_rad_per_s: f64,
    pub(super) member: CertificateMember,
}

/// Enclosure of a supremum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EnclosedSupremum {
    /// Ratio that is reached.
    pub(super) least: f64,
    pub(super) at: PlantAtFrequency,
    /// A ratio that is not exceeded, with its proof.
    pub(super) most: Option<(f64, Vec<Vec<FrequencyPanel>>)>,
    /// Reason why there is no such proof.
    pub(super) open: Option<ProofRegion>,
}

/// Factor that rounds a ratio of eight digits down to the next one.
const BELOW: f64 = 1.0 - 1e-7;

/// Supremum to be enclosed.
#[derive(Clone, Copy, Debug)]
pub(super) struct SoughtSupremum<'a> {
    /// Largest ratio of the two ends of the enclosure.
    pub(super) width: f64,
    /// Decisive ratio: the search ends once it is proven or refuted, even if the enclosure could be
    /// narrower.
    pub(super) decisive: f64,
    pub(super) effort: ProofEffort<'a>,
    /// True if only points are evaluated.
    pub(super) only_points: bool,
}

/// Encloses the supremum of the ratio of a closed loop to its limit; `None` for a loop without that
/// path.
pub(super) fn enclose(
    certificate: &Certificate,
    limited: &LimitedLoop,
    hints: &[PlantAtFrequency],
    wanted: SoughtSupremum<'_>,
    watch: Watch<'_>,
) -> Result<Option<EnclosedSupremum>, Stopped> {
    let boxes = 0..certificate.plant.boxes.len();
    let claims = boxes.map(|of_box| Loop::<f64>::over_box(certificate, of_box)?.claimed(limited, 1.0));
    let Some(claims) = claims.collect::<Option<Vec<Vec<BandClaim<f64>>>>>() else { return Ok(None) };
    let Some(mut found) = seen(certificate, limited, &claims, hints) else { return Ok(None) };
    for _ in 0..RAISES_MAXIMUM {
        if wanted.only_points {
            break;
        }
        let near = found.least * wanted.width;
        let may_decide = found.least <= wanted.decisive;
        let ratio = portable::rounded(if may_decide { near.min(wanted.decisive) } else { near }, 8);
        // a ratio rounded up would be inconclusive
        let is_beyond = may_decide && ratio > wanted.decisive;
        let ratio = if is_beyond { portable::rounded(wanted.decisive * BELOW, 8) } else { ratio };
        match walk_boxes(certificate, (&claims, ratio), wanted.effort, watch)? {
            Boxes::Shown(panels) => {
                found.most = Some((ratio, panels));
                break;
            }
            Boxes::Wrong { at, ratio: by } => (found.least, found.at) = (ratio * by, at),
            Boxes::Open(region) => {
                found.open = region;
                break;
            }
        }
    }
    // the value that the checker can confirm at that point
    let at = Loop::<f64>::at(certificate, &found.at.member).and_then(|at| at.claimed(limited, 1.0));
    let frequency_rad_per_s = found.at.frequency_rad_per_s;
    let pieces = at.iter().flatten().filter(|piece| piece.holds(frequency_rad_per_s));
    let confirmed = pieces.filter_map(|piece| at_point(&piece.claimed, frequency_rad_per_s));
    let least = confirmed.map(|[u, v]| v / u).fold(f64::NEG_INFINITY, f64::max);
    found.least = if least.is_finite() { least } else { found.least } * (1.0 - ROUNDED);
    Ok(Some(found))
}

/// Results of a claim in all boxes.
enum Boxes {
    Shown(Vec<Vec<FrequencyPanel>>),
    Wrong { at: PlantAtFrequency, ratio: f64 },
    Open(Option<ProofRegion>),
}

fn walk_boxes(
    certificate: &Certificate,
    (claims, ratio): (&[Vec<BandClaim<f64>>], f64),
    effort: ProofEffort<'_>,
    watch: Watch<'_>,
) -> Result<Boxes, Stopped> {
    let mut shown = vec![vec![]; claims.len()];
    let each =
        claims.iter().enumerate().flat_map(|(of_box, pieces)| pieces.iter().map(move |one| (of_box, one)));
    for (of_box, BandClaim { band, claimed }) in each {
        let band = claimed.band_covered(*band);
        match walk_band(&claimed.raised(ratio), certificate.plant.variables, band, effort, watch)? {
            WalkOutcome::Shown(panels) => shown[of_box].extend(panels),
            WalkOutcome::Wrong { at, ratio } => {
                let member = CertificateMember { of_box, variables: at.variables };
                let at = PlantAtFrequency { frequency_rad_per_s: at.frequency_rad_per_s, member };
                return Ok(Boxes::Wrong { at, ratio });
            }
            WalkOutcome::Open(region) => return Ok(Boxes::Open(Some(ProofRegion { of_box, ..region }))),
            WalkOutcome::TooLarge => return Ok(Boxes::Open(None)),
        }
    }
    Ok(Boxes::Shown(shown))
}

/// The greatest ratio at points: hints, and corners over the band.
fn seen(
    certificate: &Certificate,
    limited: &LimitedLoop,
    claims: &[Vec<BandClaim<f64>>],
    hints: &[PlantAtFrequency],
) -> Option<EnclosedSupremum> {
    let mut members: Vec<CertificateMember> = hints.iter().map(|hint| hint.member.clone()).collect();
    members.extend((0..claims.len()).flat_map(|of_box| corners(certificate, of_box)));
    members.dedup();
    let own = hints.iter().map(|hint| hint.frequency_rad_per_s);
    let pieces = claims.first()?;
    let spread = pieces.iter().flat_map(|piece| frequencies(piece.claimed.band(piece.band), &piece.claimed));
    let frequencies: Vec<f64> = own.chain(spread).collect();
    let mut best: Option<EnclosedSupremum> = None;
    for member in members {
        let pieces = Loop::<f64>::at(certificate, &member)?.claimed(limited, 1.0)?;
        let each = frequencies.iter().flat_map(|&one| {
            let holding = pieces.iter().filter(move |piece| piece.holds(one));
            holding.map(move |piece| (one, ratio_at(&piece.claimed, one)))
        });
        for (frequency_rad_per_s, ratio) in each {
            if ratio.is_finite() && best.as_ref().is_none_or(|known| ratio > known.least) {
                let at = PlantAtFrequency { frequency_rad_per_s, member: member.clone() };
                best = Some(EnclosedSupremum { least: ratio, at, most: None, open: None });
            }
        }
    }
    best.filter(|found| found.least > 0.0)
}

/// Corners of a box.
pub(super) fn corners(certificate: &Certificate, of_box: usize) -> impl Iterator<Item = CertificateMember> {
    let variables = certificate.plant.variables;
    (0..1_usize << variables).take(CORNERS_MAXIMUM).map(move |bits| CertificateMember {
        of_box,
        variables: (0..variables).map(|axis| (bits >> axis & 1) as f64).collect(),
    })
}

/// Ratio |V|/|U| at a frequency; its limit towards infinity, if dead time does not matter there.
fn ratio_at(claimed: &Claimed<f64>, frequency_rad_per_s: f64) -> f64 {
    let size = |value: Option<[f64; 2]>| {
        value.map_or(f64::NAN, |[re, im]| portable::magnitude(Complex64::new(re, im)))
    };
    match frequency_rad_per_s.is_finite() {
        true => size(claimed.value_of_v(frequency_rad_per_s)) / size(claimed.value_of_u(frequency_rad_per_s)),
        false => {
            let degree = claimed.of_s().filter_map(InS::degree).max().unwrap_or(0);
            let leading = |of: &[PolynomialProduct<f64>]| -> f64 {
                of.iter().map(|part| part.of_s.0.get(degree).map_or(0.0, number)).sum()
            };
            // the phase of the part multiplied by dead time changes without limit
            let value = |[own, late, _]: &[Vec<PolynomialProduct<f64>>; 3]| {
                if leading(late) == 0.0 { leading(own).abs() } else { f64::NAN }
            };
            value(&claimed.v) / value(&claimed.u)
        }
    }
}
