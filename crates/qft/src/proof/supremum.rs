//! The supremum of a ratio, enclosed: from below by points, from above by trees.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};

use super::certificate::{Certificate, Limited, Member, Panel};
use super::claimed::{Claimed, Loop};
use super::panels::{frequencies, walk_band};
use super::polynomial::{InS, Polynomial};
use super::walk::{Effort, Region, Walk};

/// Corners of a box that are looked at before anything is shown.
const CORNERS_MAXIMUM: usize = 64;
/// How often a tree may be begun anew because the supremum turned out to be greater.
const RAISES_MAXIMUM: usize = 48;
/// What a ratio that is reached is lowered by, so that rounding does not hide it.
const ROUNDED: f64 = 1e-9;

/// A plant and a frequency.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) frequency_rad_per_s: f64,
    pub(super) member: Member,
}

/// What was found of a supremum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Enclosed {
    /// A ratio that is reached, and where.
    pub(super) least: f64,
    pub(super) at: Place,
    /// A ratio that is not exceeded, with what shows it.
    pub(super) most: Option<(f64, Vec<Vec<Panel>>)>,
    /// What remained where there is none.
    pub(super) open: Option<Region>,
}

/// What is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    /// The factor between both ends of the enclosure at most.
    pub(super) width: f64,
    /// A ratio that decides: it is shown or refuted, though the enclosure might be narrower.
    pub(super) decisive: f64,
    pub(super) effort: Effort,
    /// Whether only points are looked at.
    pub(super) only_points: bool,
}

/// Encloses the supremum of the ratio of a closed loop to its limit; `None` of a loop without that path.
pub(super) fn enclose(
    certificate: &Certificate,
    limited: &Limited,
    hints: &[Place],
    wanted: Wanted,
    watch: Watch<'_>,
) -> Result<Option<Enclosed>, Stopped> {
    let boxes = 0..certificate.plant.boxes.len();
    let claims = boxes.map(|of_box| Loop::<f64>::over_box(certificate, of_box)?.claimed(limited, 1.0));
    let Some(claims) = claims.collect::<Option<Vec<Claimed<f64>>>>() else { return Ok(None) };
    let Some(mut found) = seen(certificate, limited, &claims, hints) else { return Ok(None) };
    for _ in 0..RAISES_MAXIMUM {
        if wanted.only_points {
            break;
        }
        let near = found.least * wanted.width;
        let ratio = rounded(if found.least <= wanted.decisive { near.min(wanted.decisive) } else { near });
        match walk_boxes(certificate, limited, (&claims, ratio), wanted.effort, watch)? {
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
    found.least *= 1.0 - ROUNDED;
    Ok(Some(found))
}

/// A number of few digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.7e}").parse().unwrap_or(value)
}

/// What became of a claim in all boxes.
enum Boxes {
    Shown(Vec<Vec<Panel>>),
    Wrong { at: Place, ratio: f64 },
    Open(Option<Region>),
}

fn walk_boxes(
    certificate: &Certificate,
    limited: &Limited,
    (claims, ratio): (&[Claimed<f64>], f64),
    effort: Effort,
    watch: Watch<'_>,
) -> Result<Boxes, Stopped> {
    let mut shown = Vec::with_capacity(claims.len());
    for (of_box, claim) in claims.iter().enumerate() {
        match walk_band(
            &claim.raised(ratio),
            certificate.plant.variables,
            limited.band_rad_per_s,
            effort,
            watch,
        )? {
            Walk::Shown(panels) => shown.push(panels),
            Walk::Wrong { at, ratio } => {
                let member = Member { of_box, variables: at.variables };
                return Ok(Boxes::Wrong {
                    at: Place { frequency_rad_per_s: at.frequency_rad_per_s, member },
                    ratio,
                });
            }
            Walk::Open(region) => return Ok(Boxes::Open(Some(Region { of_box, ..region }))),
            Walk::TooLarge => return Ok(Boxes::Open(None)),
        }
    }
    Ok(Boxes::Shown(shown))
}

/// The greatest ratio at points: hints, and corners over the band.
fn seen(
    certificate: &Certificate,
    limited: &Limited,
    claims: &[Claimed<f64>],
    hints: &[Place],
) -> Option<Enclosed> {
    let mut members: Vec<Member> = hints.iter().map(|hint| hint.member.clone()).collect();
    members.extend((0..claims.len()).flat_map(|of_box| corners(certificate, of_box)));
    members.dedup();
    let own = hints.iter().map(|hint| hint.frequency_rad_per_s);
    let [from, to] = limited.band_rad_per_s;
    let all = own.chain(frequencies(limited.band_rad_per_s, claims.first()?));
    let frequencies: Vec<f64> = all.filter(|one| from <= *one && *one <= to).collect();
    let mut best: Option<Enclosed> = None;
    for member in members {
        let claimed = Loop::<f64>::at(certificate, &member)?.claimed(limited, 1.0)?;
        for &frequency_rad_per_s in &frequencies {
            let ratio = ratio_at(&claimed, frequency_rad_per_s);
            if ratio.is_finite() && best.as_ref().is_none_or(|known| ratio > known.least) {
                let at = Place { frequency_rad_per_s, member: member.clone() };
                best = Some(Enclosed { least: ratio, at, most: None, open: None });
            }
        }
    }
    best.filter(|found| found.least > 0.0)
}

/// Corners of a box.
pub(super) fn corners(certificate: &Certificate, of_box: usize) -> impl Iterator<Item = Member> {
    let variables = certificate.plant.variables;
    (0..1_usize << variables).take(CORNERS_MAXIMUM).map(move |bits| Member {
        of_box,
        variables: (0..variables).map(|axis| (bits >> axis & 1) as f64).collect(),
    })
}

/// |V|/|U| at a frequency; towards infinity the limit, where dead time does not matter there.
fn ratio_at(claimed: &Claimed<f64>, frequency_rad_per_s: f64) -> f64 {
    let angle = frequency_rad_per_s * super::dead_time::ends(&claimed.dead_time)[0];
    let turned = portable::exp_complex(Complex64::new(0.0, -angle));
    let degree = claimed.u.iter().chain(&claimed.v).filter_map(InS::degree).max().unwrap_or(0);
    let value = |[own, late]: &[InS<f64>; 2]| match frequency_rad_per_s.is_finite() {
        true => at_frequency(own, frequency_rad_per_s) + at_frequency(late, frequency_rad_per_s) * turned,
        false => {
            let leading = |of: &InS<f64>| of.0.get(degree).map_or(0.0, number);
            // dead time turns what it multiplies without end
            Complex64::new(if leading(late) == 0.0 { leading(own) } else { f64::NAN }, 0.0)
        }
    };
    portable::magnitude(value(&claimed.v)) / portable::magnitude(value(&claimed.u))
}

/// The number that a polynomial is which depends on no variable.
fn number(of: &Polynomial<f64>) -> f64 {
    of.terms().map(|(_, value)| value).sum()
}

fn at_frequency(of: &InS<f64>, frequency_rad_per_s: f64) -> Complex64 {
    let s = Complex64::new(0.0, frequency_rad_per_s);
    of.0.iter().rev().fold(Complex64::new(0.0, 0.0), |sum, coefficient| sum * s + number(coefficient))
}
