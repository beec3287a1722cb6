//! The panels of a band: its decades, and the ranges below and beyond them. With dead time, the
//! phase varies little over a panel, or its angle does not matter.

use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};

use super::certificate::Late;
use super::claimed::Claimed;
use super::dead_time::ends;
use super::points::PanelRange;
use super::polynomial::{BoxPolynomial, InS};
use super::walk::{ProofEffort, ProofRegion, WalkOutcome, walk};

/// Number of points per decade at which plants are evaluated.
const POINTS_PER_DECADE: f64 = 24.0;
/// Largest phase change due to dead time over a panel, to either side of its middle, rad.
const TURN: f64 = 1.0;
/// Fraction of that angle allowed for functions of the samples.
const SAMPLED_TURN: f64 = 0.5;
/// Greatest ratio of the ends of a panel over which a power of the frequency is expanded.
const POWER_PANEL: f64 = 1.6;
/// Ratio of the ends of a panel below which it is not divided further.
const NARROWEST: f64 = 1.02;
/// Effort for testing the influence of dead time: leaves and depth.
const TRIAL: (usize, usize) = (40, 24);

/// Searches for trees that prove |V| <= |U| over a band.
pub(super) fn walk_band(
    claimed: &Claimed<f64>,
    variables: usize,
    band: [f64; 2],
    effort: ProofEffort<'_>,
    watch: Watch<'_>,
) -> Result<WalkOutcome, Stopped> {
    let decades = decades(band, claimed);
    // the lowest last, since it is processed first
    let mut waiting: Vec<[f64; 2]> = decades.windows(2).map(|pair| [pair[0], pair[1]]).rev().collect();
    let mut shown = vec![];
    let sampled_turn = claimed.turn_s();
    while let Some([from, to]) = waiting.pop() {
        let turns = [from, to].map(|end| end * sampled_turn / SAMPLED_TURN);
        let is_wide = claimed.has_powers() && from > 0.0 && to > POWER_PANEL * from;
        let middle = match is_wide {
            true => Some(rounded((from * to).sqrt())),
            false => parted([from, to], turns).filter(|_| sampled_turn > 0.0),
        };
        if let Some(middle) = middle {
            waiting.extend([[middle, to], [from, middle]]);
            continue;
        }
        let mut over =
            |late: Late, effort| walk(claimed, variables, PanelRange { from, to, late }, effort, &mut *watch);
        let found = match ends(&claimed.dead_time) {
            _ if claimed.dead_time.value.is_zero() => over(Late::Not, effort)?,
            _ if to.is_infinite() => over(Late::Less, effort)?,
            dead_times => match any(&mut over, effort)? {
                Some(found) => found,
                None => {
                    let turn = angles([from, to], dead_times);
                    match parted([from, to], turn) {
                        Some(middle) => {
                            waiting.extend([[middle, to], [from, middle]]);
                            continue;
                        }
                        None => over(Late::Turns(rounded(0.5 * (turn[0] + turn[1]))), effort)?,
                    }
                }
            },
        };
        match found {
            WalkOutcome::Shown(panels) => shown.extend(panels),
            // the panels are processed in order: all from here on remain
            WalkOutcome::Open(region) if effort.budget.is_spent() => {
                let variables = vec![[0.0, 1.0]; variables];
                return Ok(WalkOutcome::Open(ProofRegion {
                    band_rad_per_s: [from, band[1]],
                    variables,
                    ..region
                }));
            }
            other => return Ok(other),
        }
    }
    Ok(WalkOutcome::Shown(shown))
}

/// Proves or refutes the claim for any angle of the dead time.
fn any<'a>(
    over: &mut impl FnMut(Late, ProofEffort<'a>) -> Result<WalkOutcome, Stopped>,
    effort: ProofEffort<'a>,
) -> Result<Option<WalkOutcome>, Stopped> {
    let (leaves, depth) = TRIAL;
    for late in [Late::Less, Late::More] {
        let found = over(late, ProofEffort { leaves, depth, ..effort })?;
        if matches!(found, WalkOutcome::Shown(_) | WalkOutcome::Wrong { .. }) {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// Range of frequency times dead time.
fn angles([from, to]: [f64; 2], [least, most]: [f64; 2]) -> [f64; 2] {
    [from * least, to * most]
}

/// Frequency that divides a panel over which dead time turns too far; `None` if it does not, or if
/// dividing no longer helps.
fn parted([from, to]: [f64; 2], [begin, end]: [f64; 2]) -> Option<f64> {
    let middle = if from > 0.0 { rounded((from * to).sqrt()) } else { rounded(0.1 * to) };
    let turns_little = end - begin <= 2.0 * TURN;
    let is_narrow = from > 0.0 && to / from < NARROWEST;
    (!turns_little && !is_narrow && from < middle && middle < to).then_some(middle)
}

/// The number rounded to few digits.
fn rounded(value: f64) -> f64 {
    portable::rounded(value, 5)
}

/// The ends of the panels without dead time.
fn decades([from, to]: [f64; 2], claimed: &Claimed<f64>) -> Vec<f64> {
    let mut bends = claimed.of_s().flat_map(bends).chain(beyond(claimed));
    let first = bends.next().unwrap_or(1.0);
    let [lowest, highest] = bends.fold([first, first], |[low, high], bend| [low.min(bend), high.max(bend)]);
    let [begin, end] = [portable::log10(lowest).floor() as i32, portable::log10(highest).ceil() as i32];
    let inner = (begin..=end.max(begin)).filter_map(|power| format!("1e{power}").parse::<f64>().ok());
    let mut ends: Vec<f64> = inner.filter(|inner| from < *inner && *inner < to).collect();
    // a panel to infinity begins above zero
    if ends.is_empty() && from == 0.0 && to.is_infinite() {
        ends.push(1.0);
    }
    ends.insert(0, from);
    ends.push(to);
    ends
}

/// Factor by which the delayed part is smaller than the rest at the start of a panel to infinity.
const LESS: f64 = 10.0;

/// Frequency beyond which the delayed part is negligible.
fn beyond(claimed: &Claimed<f64>) -> Option<f64> {
    let leading = |of: &InS<f64>| {
        let degree = of.degree()?;
        Some((degree as f64, of.0[degree].terms().map(|(_, value)| value).sum::<f64>().abs()))
    };
    let of = if claimed.u[1].is_empty() { &claimed.v } else { &claimed.u };
    let ([own, ..], [late, ..]) = (&of[0][..], &of[1][..]) else { return None };
    let ((own, fast), (late, slow)) = (leading(&own.of_s)?, leading(&late.of_s)?);
    (own > late).then(|| portable::pow(LESS * slow / fast, 1.0 / (own - late)))
}

/// The approximate frequency where the magnitudes of the terms of a polynomial are equal, at the
/// corner of the box where all variables are one.
fn bends(of: &InS<f64>) -> Vec<f64> {
    let size = |(power, coefficient): (usize, &BoxPolynomial<f64>)| {
        (power, coefficient.terms().map(|(_, value)| value).sum::<f64>().abs())
    };
    let sizes: Vec<(usize, f64)> =
        of.0.iter().enumerate().map(size).filter(|(_, size)| *size > 0.0).collect();
    let between = sizes.windows(2).map(|pair| {
        let [(one, low), (other, high)] = [pair[0], pair[1]];
        portable::exp(portable::ln(low / high) / (other - one) as f64)
    });
    between.filter(|bend| bend.is_finite() && *bend > 0.0).collect()
}

/// Frequencies at which plants are evaluated: the ends of the panels, and points in each decade.
pub(super) fn frequencies(band: [f64; 2], claimed: &Claimed<f64>) -> Vec<f64> {
    let ends = decades(band, claimed);
    let inner = ends.windows(2).flat_map(|pair| {
        let [low, high] = match (pair[0] > 0.0, pair[1].is_finite()) {
            (true, true) => [pair[0], pair[1]],
            (true, false) => [pair[0], 100.0 * pair[0]],
            (false, true) => [0.01 * pair[1], pair[1]],
            (false, false) => [0.01, 100.0],
        };
        let steps = (portable::log10(high / low) * POINTS_PER_DECADE).ceil().max(1.0);
        (0..=steps as usize)
            .map(move |step| low * portable::exp(portable::ln(high / low) * step as f64 / steps))
    });
    inner.chain(ends.iter().copied()).collect()
}
