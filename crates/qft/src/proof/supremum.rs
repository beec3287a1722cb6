//! The supremum of a ratio, enclosed: from below by points, from above by trees.

use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};

use super::certificate::{Certificate, Limited, Panel};
use super::claimed::Loop;
use super::points::{Points, Range};
use super::polynomial::InS;
use super::walk::{Effort, Place, Region, Walk, walk};

/// Points of a decade at which plants are looked at before anything is shown.
const POINTS_PER_DECADE: usize = 24;
/// Corners of the box that are looked at there.
const CORNERS_MAXIMUM: usize = 64;
/// How often a tree may be begun anew because the supremum turned out to be greater.
const RAISES_MAXIMUM: usize = 48;
/// What a ratio that is reached is lowered by, so that rounding does not hide it.
const ROUNDED: f64 = 1e-9;

/// What was found of a supremum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Enclosed {
    /// The greatest ratio that was seen, and where.
    pub(super) least: f64,
    pub(super) at: Place,
    /// A ratio that is not exceeded, with what shows it.
    pub(super) most: Option<(f64, Vec<Panel>)>,
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

/// Encloses the supremum of the ratio of a closed loop to its limit.
pub(super) fn enclose(
    certificate: &Certificate,
    limited: &Limited,
    hints: &[Place],
    wanted: Wanted,
    watch: Watch<'_>,
) -> Result<Option<Enclosed>, Stopped> {
    let Some(around) = Loop::<f64>::over_box(certificate) else { return Ok(None) };
    let Some([u, v]) = around.claimed(limited, 1.0) else { return Ok(None) };
    let ranges = ranges(limited.band_rad_per_s, &[&u, &v]);
    let Some((mut least, mut at)) = seen(certificate, limited, hints, &ranges) else { return Ok(None) };
    let mut open = None;
    let mut most = None;
    for _ in 0..RAISES_MAXIMUM {
        if wanted.only_points {
            break;
        }
        let near = least * wanted.width;
        let ratio = rounded(if least <= wanted.decisive { near.min(wanted.decisive) } else { near });
        let scaled = [u.scaled(ratio), v.clone()];
        match walk(&scaled, certificate.plant.variables, &ranges, wanted.effort, watch)? {
            Walk::Shown(panels) => {
                most = Some((ratio, panels));
                break;
            }
            Walk::Wrong { at: place, ratio: by } => (least, at) = (ratio * by, place),
            Walk::Open(region) => {
                open = Some(region);
                break;
            }
        }
    }
    Ok(Some(Enclosed { least: least * (1.0 - ROUNDED), at, most, open }))
}

/// A number of few digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.7e}").parse().unwrap_or(value)
}

/// The panels of a band: its decades, and what lies below and beyond them.
pub(super) fn ranges([from, to]: [f64; 2], of: &[&InS<f64>]) -> Vec<Range> {
    let mut bends = of.iter().flat_map(|one| bends(one));
    let first = bends.next().unwrap_or(1.0);
    let [lowest, highest] = bends.fold([first, first], |[low, high], bend| [low.min(bend), high.max(bend)]);
    let decade = |value: f64| portable::log10(value);
    let (begin, end) = (decade(lowest).floor() as i32, decade(highest).ceil() as i32);
    let inner = (begin..=end.max(begin)).filter_map(|power| format!("1e{power}").parse::<f64>().ok());
    let mut ends: Vec<f64> = inner.filter(|inner| from < *inner && *inner < to).collect();
    // a panel to infinity begins above zero
    if ends.is_empty() && from == 0.0 && to.is_infinite() {
        ends.push(1.0);
    }
    ends.insert(0, from);
    ends.push(to);
    ends.windows(2).map(|pair| Range { from: pair[0], to: pair[1] }).collect()
}

/// About where the magnitudes of the terms of a polynomial are equal, in the middle of the box.
fn bends(of: &InS<f64>) -> Vec<f64> {
    let sizes: Vec<(usize, f64)> = of
        .0
        .iter()
        .enumerate()
        .map(|(power, coefficient)| (power, coefficient.terms().map(|(_, value)| value).sum::<f64>().abs()))
        .filter(|(_, size)| *size > 0.0)
        .collect();
    let between = sizes.windows(2).map(|pair| {
        let [(one, low), (other, high)] = [pair[0], pair[1]];
        portable::exp(portable::ln(low / high) / (other - one) as f64)
    });
    between.filter(|bend| bend.is_finite() && *bend > 0.0).collect()
}

/// The greatest ratio at points: hints, and corners over the band.
fn seen(
    certificate: &Certificate,
    limited: &Limited,
    hints: &[Place],
    ranges: &[Range],
) -> Option<(f64, Place)> {
    let variables = certificate.plant.variables;
    let corners = (0..1_usize << variables.min(16)).take(CORNERS_MAXIMUM);
    let corner = |bits: usize| (0..variables).map(|axis| (bits >> axis & 1) as f64).collect::<Vec<f64>>();
    let mut members: Vec<Vec<f64>> = hints.iter().map(|hint| hint.member.clone()).collect();
    members.extend(corners.map(corner));
    members.dedup();
    let grid: Vec<f64> = ranges.iter().flat_map(frequencies).collect();
    let own = hints.iter().map(|hint| hint.frequency_rad_per_s);
    let frequencies: Vec<f64> = own.chain(grid).filter(|one| within(*one, limited.band_rad_per_s)).collect();
    let mut best: Option<(f64, Place)> = None;
    for member in members {
        let [u, v] = Loop::<f64>::at(certificate, &member)?.claimed(limited, 1.0)?;
        for &frequency in &frequencies {
            let ratio = ratio_at(&u, &v, frequency);
            if ratio.is_finite() && best.as_ref().is_none_or(|(known, _)| ratio > *known) {
                best = Some((ratio, Place { frequency_rad_per_s: frequency, member: member.clone() }));
            }
        }
    }
    best
}

fn within(frequency: f64, [from, to]: [f64; 2]) -> bool {
    from <= frequency && frequency <= to
}

fn frequencies(range: &Range) -> Vec<f64> {
    let [low, high] = match (range.from > 0.0, range.to.is_finite()) {
        (true, true) => [range.from, range.to],
        (true, false) => [range.from, 100.0 * range.from],
        (false, _) => [0.01 * range.to.min(100.0), range.to.min(100.0)],
    };
    let steps = (portable::log10(high / low) * POINTS_PER_DECADE as f64).ceil().max(1.0);
    let inner =
        (0..=steps as usize).map(|step| low * portable::exp(portable::ln(high / low) * step as f64 / steps));
    std::iter::once(range.from).chain(inner).chain(std::iter::once(range.to)).collect()
}

/// |V|/|U| at a frequency.
fn ratio_at(u: &InS<f64>, v: &InS<f64>, frequency_rad_per_s: f64) -> f64 {
    let range = match frequency_rad_per_s.is_finite() {
        true => Range { from: frequency_rad_per_s, to: frequency_rad_per_s },
        false => Range { from: 1.0, to: f64::INFINITY },
    };
    let points = Points::powers(u, v, 0).over(range);
    let Some([ur, ui, vr, vi]) = points.pairs().first() else { return f64::NAN };
    ((vr * vr + vi * vi) / (ur * ur + ui * ui)).sqrt()
}
