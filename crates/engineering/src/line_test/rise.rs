//! Compliance from a slow rise of the pressure.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::order::ends;
use phea_dynamics::portable::{exp, ln};

use super::rise_noise::{Whitened, whitened};

/// Where a displaced volume is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeSource {
    /// The integral of a flow.
    Flow,
    /// It was recorded.
    Volume,
    /// A piston's position times its area.
    Position,
}

/// A slow test of a blocked line. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct RiseRecord {
    /// Where it is from.
    pub file: String,
    /// Where the volumes are from.
    pub source: VolumeSource,
    /// s; empty where no time was recorded.
    pub times: Vec<f64>,
    /// m3, displaced into the line since the first row.
    pub volumes: Vec<f64>,
    /// Pa.
    pub pressures: Vec<f64>,
}

/// The compliance that explains a slow test.
#[derive(Clone, Debug, PartialEq)]
pub struct RiseFit {
    /// What was recorded.
    pub record: RiseRecord,
    /// Pa, lowest and highest pressure.
    pub pressures: [f64; 2],
    /// m3, coefficients b_j.
    coefficients: DVector<f64>,
    /// Their covariance.
    covariance: DMatrix<f64>,
    /// m3/s that the meter shows or the line loses at standstill; none where the record does not
    /// separate it from the compliance.
    pub drift: Option<f64>,
    /// m3, at the first row.
    offset: f64,
    /// m3, root mean square of what differs from row to row.
    pub white_noise: f64,
    /// m3, by which the sum of a meter's noise grows from row to row, root mean square.
    pub walk: f64,
}

/// Least absolute t of a further coefficient: one in a thousand by chance.
const DECISIVE: f64 = 3.29;
/// Most terms of the volume over the pressure.
const MOST_TERMS: usize = 3;
/// Share of the compliance that its standard deviation may be for a drift to be taken as
/// determined.
const TOLD: f64 = 0.1;
/// Windows of a record over which pressures are smoothed.
const WINDOWS: usize = 100;
/// ln of the ratio of walk to white noise that is searched.
const RATIOS: [f64; 2] = [-23.0, 9.0];
/// Steps of the search over them, coarse and fine.
const STEPS: [usize; 2] = [16, 24];

/// Fits volume over pressure.
///
/// ```text
/// V_k = V_0 + sum b_j u_k^j/j + q_0 t_k + w_k + e_k        u = (p - p_m)/h,  p_m and h middle and half of the range
/// w_(k+1) = w_k + n_k,   variance of n over that of e by restricted likelihood           dV/dp = sum b_j u^(j-1)/h
/// ```
///
/// e is what is read wrong from row to row, w what the integral of a meter's noise has summed up
/// to, q_0 its zero error and any leakage. Where w dominates, only what changes from row to row
/// counts, and there the noise of the pressure is as large as its change: smoothed pressures are
/// instruments for the recorded ones, whose noise they hardly share. Harvey (1989), section 2.3,
/// for the local level; Patterson and Thompson (1971) for the likelihood.
pub(super) fn rise_fit(record: RiseRecord) -> Result<RiseFit, String> {
    let pressures = ends(record.pressures.iter().copied());
    let [low, high] = pressures;
    if low >= high {
        return Err(format!("{}: the pressure never moves", record.file));
    }
    let with_drift = !record.times.is_empty();
    let first = fitted(&record, pressures, 1, with_drift);
    let told = |fit: &TermsFit| {
        let deviation = fit.covariance.get((0, 0)).copied().unwrap_or(f64::INFINITY).max(0.0).sqrt();
        deviation < TOLD * fit.values.get(0).copied().unwrap_or(0.0).abs()
    };
    let keeps_drift = with_drift && first.as_ref().is_some_and(told);
    let mut best = if keeps_drift { first } else { fitted(&record, pressures, 1, false) };
    for terms in 2..=MOST_TERMS {
        let Some(next) = fitted(&record, pressures, terms, keeps_drift) else { break };
        let last = next.values.get(terms - 1).copied().unwrap_or(0.0);
        let variance = next.covariance.get((terms - 1, terms - 1)).copied().unwrap_or(f64::INFINITY);
        if last.abs() < DECISIVE * variance.max(0.0).sqrt() {
            break;
        }
        best = Some(next);
    }
    let fit = best.ok_or_else(|| format!("{}: volume and pressure do not move together", record.file))?;
    Ok(fit.into_rise(record, pressures, keeps_drift))
}

/// A fit with a fixed number of terms.
struct TermsFit {
    terms: usize,
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    offset: f64,
    white_variance: f64,
    ratio: f64,
}

impl TermsFit {
    fn into_rise(self, record: RiseRecord, pressures: [f64; 2], keeps_drift: bool) -> RiseFit {
        let terms = self.terms;
        RiseFit {
            record,
            pressures,
            coefficients: self.values.rows(0, terms).into_owned(),
            covariance: self.covariance.view((0, 0), (terms, terms)).into_owned(),
            drift: self.values.get(terms).copied().filter(|_| keeps_drift),
            offset: self.offset,
            white_noise: self.white_variance.sqrt(),
            walk: (self.ratio * self.white_variance).sqrt(),
        }
    }
}

/// Columns of the regression: instruments, what they stand for, and the volume.
fn columns(record: &RiseRecord, [low, high]: [f64; 2], terms: usize, drift: bool) -> Vec<Vec<f64>> {
    let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
    let smooth = smoothed(&record.pressures);
    let mut columns = Vec::new();
    for pressures in [&smooth, &record.pressures] {
        let of = |term: usize| {
            let power = |p: &f64| powered((p - middle) / half, term) / term as f64;
            pressures.iter().map(power).collect::<Vec<f64>>()
        };
        columns.extend((1..=terms).map(of));
        columns.extend(drift.then(|| record.times.clone()));
    }
    columns.push(record.volumes.clone());
    columns
}

/// Each value as the mean of those around it, over a hundredth of the record.
fn smoothed(values: &[f64]) -> Vec<f64> {
    let around = values.len() / WINDOWS / 2;
    let mean = |row: usize| {
        // as many on either side, so that the mean of a straight line is the line
        let around = around.min(row).min(values.len() - 1 - row);
        let near = values.get(row - around..=row + around).unwrap_or_default();
        near.iter().sum::<f64>() / near.len().max(1) as f64
    };
    (0..values.len()).map(mean).collect()
}

fn powered(value: f64, power: usize) -> f64 {
    (0..power).fold(1.0, |product, _| product * value)
}

/// The coefficients at the best ratio of walk to white noise.
fn fitted(record: &RiseRecord, pressures: [f64; 2], terms: usize, drift: bool) -> Option<TermsFit> {
    let columns = columns(record, pressures, terms, drift);
    let at = |ratio: f64| WhitenedSolution::of(&whitened(&columns, exp(ratio)));
    let cost = |ratio: f64| at(ratio).map_or(f64::INFINITY, |solved| solved.cost);
    let [least, most] = RATIOS;
    let [coarse, fine] = STEPS;
    let step = (most - least) / coarse as f64;
    let grid = (0..=coarse).map(|index| least + step * index as f64);
    let best = grid.map(|ratio| (ratio, cost(ratio))).min_by(|one, other| one.1.total_cmp(&other.1))?.0;
    // golden section between the neighbours of the best
    let golden = 0.618_033_988_749_895;
    let [mut low, mut high] = [best - step, best + step];
    for _ in 0..fine {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        if cost(left) < cost(right) {
            high = right;
        } else {
            low = left;
        }
    }
    let ratio = f64::midpoint(low, high);
    let solved = at(ratio)?;
    let of_first = |column: &Vec<f64>| column.first().copied().unwrap_or(0.0);
    let (volume, others) = columns.split_last()?;
    let shown = others.iter().skip(others.len() / 2);
    let explained: f64 = shown.zip(solved.values.iter()).map(|(x, b)| of_first(x) * b).sum();
    Some(TermsFit {
        terms,
        offset: of_first(volume) - explained,
        covariance: solved.covariance,
        values: solved.values,
        white_variance: solved.variance,
        ratio: exp(ratio),
    })
}

/// A regression of whitened columns.
struct WhitenedSolution {
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    variance: f64,
    /// Minus twice the restricted log-likelihood.
    cost: f64,
}

impl WhitenedSolution {
    /// ```text
    /// b = (Z'X)^-1 Z'y        cov = s^2 (Z'X)^-1 Z'Z (X'Z)^-1
    /// ```
    fn of(found: &Whitened) -> Option<WhitenedSolution> {
        let (volume, others) = found.columns.split_last()?;
        let count = others.len() / 2;
        let (instruments, shown) = others.split_at(count);
        let freedom = volume.len().checked_sub(count + 1)? as f64;
        let product = |one: &[f64], other: &[f64]| -> f64 { one.iter().zip(other).map(|(x, y)| x * y).sum() };
        let scales: Vec<f64> = instruments.iter().map(|z| product(z, z).sqrt()).collect();
        let scale = |index: usize| scales.get(index).copied().unwrap_or(1.0);
        let of = |ones: &[Vec<f64>], i: usize, others: &[Vec<f64>], j: usize| {
            let both = ones.get(i).zip(others.get(j));
            both.map_or(0.0, |(x, y)| product(x, y)) / (scale(i) * scale(j))
        };
        let own = DMatrix::from_fn(count, count, |i, j| of(instruments, i, instruments, j));
        let mixed = DMatrix::from_fn(count, count, |i, j| of(instruments, i, shown, j));
        let right =
            DVector::from_fn(count, |i, _| instruments.get(i).map_or(0.0, |z| product(z, volume)) / scale(i));
        let determinant = ln(own.determinant().max(f64::MIN_POSITIVE))
            + scales.iter().map(|scale| 2.0 * ln(*scale)).sum::<f64>();
        let inverse = mixed.try_inverse()?;
        let scaled = &inverse * right;
        let values = DVector::from_fn(count, |i, _| scaled[i] / scale(i));
        let left = volume.iter().enumerate().map(|(row, volume)| {
            let at = |x: &Vec<f64>| x.get(row).copied().unwrap_or(0.0);
            volume - shown.iter().zip(values.iter()).map(|(x, b)| at(x) * b).sum::<f64>()
        });
        let squares: f64 = left.map(|value| value * value).sum();
        let variance = squares.max(f64::MIN_POSITIVE) / freedom;
        let spread = &inverse * own * inverse.transpose() * variance;
        Some(WhitenedSolution {
            values,
            covariance: DMatrix::from_fn(count, count, |i, j| spread[(i, j)] / (scale(i) * scale(j))),
            variance,
            cost: freedom * ln(variance) + found.determinant + determinant,
        })
    }
}

impl RiseFit {
    /// Number of terms of the volume over the pressure: 1 for a compliance that does not change.
    pub fn terms(&self) -> usize {
        self.coefficients.len()
    }

    fn half(&self) -> f64 {
        let [low, high] = self.pressures;
        (high - low) / 2.0
    }

    fn scaled(&self, pressure: f64) -> f64 {
        let [low, high] = self.pressures;
        (pressure - f64::midpoint(low, high)) / self.half()
    }

    /// dV/dp in m3/Pa at a pressure in Pa, and its standard deviation.
    pub fn compliance(&self, pressure: f64) -> [f64; 2] {
        let u = self.scaled(pressure);
        self.combined(|term| powered(u, term) / self.half())
    }

    /// Change of volume over change of pressure between the ends, in m3/Pa, and its standard
    /// deviation.
    pub fn secant(&self) -> [f64; 2] {
        let odd = |term: usize| if term.is_multiple_of(2) { 1.0 / (term + 1) as f64 } else { 0.0 };
        self.combined(|term| odd(term) / self.half())
    }

    /// Slope of the compliance over the pressure at a pressure in Pa, in m3/Pa2, and its standard
    /// deviation.
    pub(crate) fn compliance_slope(&self, pressure: f64) -> [f64; 2] {
        let (u, half) = (self.scaled(pressure), self.half());
        self.combined(|term| term as f64 * powered(u, term.saturating_sub(1)) / (half * half))
    }

    fn combined(&self, weight: impl Fn(usize) -> f64) -> [f64; 2] {
        let weights = DVector::from_fn(self.coefficients.len(), |term, _| weight(term));
        let variance = (weights.transpose() * &self.covariance * &weights).x;
        [weights.dot(&self.coefficients), variance.max(0.0).sqrt()]
    }

    /// m3 that were displaced at a pressure in Pa, without drift.
    pub fn volume(&self, pressure: f64) -> f64 {
        let u = self.scaled(pressure);
        let terms = self.coefficients.iter().enumerate();
        self.offset + terms.map(|(index, b)| b * powered(u, index + 1) / (index + 1) as f64).sum::<f64>()
    }

    /// Pa and m3 of each row, the drift taken off.
    pub fn points(&self) -> Vec<(f64, f64)> {
        let drift = self.drift.unwrap_or(0.0);
        let rows = self.record.pressures.iter().zip(&self.record.volumes).enumerate();
        rows.map(|(row, (pressure, volume))| {
            let time = self.record.times.get(row).copied().unwrap_or(0.0);
            (*pressure, volume - drift * time)
        })
        .collect()
    }
}
