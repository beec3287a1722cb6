//! Compliance from a slow rise of the pressure.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::minimum::golden_section;
use phea_dynamics::order::ends;
use phea_dynamics::portable::{exp, ln};
use phea_hydraulics::fluid::EntrainedAir;

use super::rise_air::AeratedOil;
use super::rise_noise::{Whitened, whitened};
use crate::identify_error::LineFitError;

/// Source of a displaced volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeSource {
    /// The integral of a flow.
    Flow,
    /// A recorded volume.
    Volume,
    /// Position of a piston times its area.
    Position,
}

/// A slow test of a blocked line, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct RiseRecord {
    /// Path of the file.
    pub file: String,
    /// Source of the volumes.
    pub source: VolumeSource,
    /// Times, s; empty if none were recorded.
    pub times: Vec<f64>,
    /// Volumes displaced into the line since the first row, m3.
    pub volumes: Vec<f64>,
    /// Pressures, Pa.
    pub pressures: Vec<f64>,
}

/// The compliance that explains a slow test.
#[derive(Clone, Debug, PartialEq)]
pub struct RiseFit {
    /// Recorded rise.
    pub record: RiseRecord,
    /// Lowest and highest pressure, Pa.
    pub pressures: [f64; 2],
    /// Coefficients b_j, m3; then the fraction of air, if there is some.
    coefficients: DVector<f64>,
    /// Oil, if the record shows air in it.
    oil: Option<AeratedOil>,
    /// Covariance of the coefficients.
    covariance: DMatrix<f64>,
    /// Zero error of the meter or leakage of the line at standstill, m3/s; absent if the record
    /// does not separate it from the compliance.
    pub drift: Option<f64>,
    /// Volume at the first row, m3.
    offset: f64,
    /// White noise from row to row, m3, root mean square.
    pub white_noise: f64,
    /// Growth of the sum of a meter's noise from row to row, m3, root mean square.
    pub walk: f64,
}

/// Least absolute t of a further coefficient: exceeded by chance in one of a thousand cases.
const DECISIVE: f64 = 3.29;
/// Largest number of terms of the volume as a function of the pressure.
const MOST_TERMS: usize = 3;
/// Largest standard deviation of the compliance, as a fraction of it, at which a drift counts as
/// determined.
const DETERMINED: f64 = 0.1;
/// Number of windows of a record over which pressures are smoothed.
const WINDOWS: usize = 100;
/// Range of the logarithm of the ratio of walk to white noise that is searched.
const RATIOS: [f64; 2] = [-23.0, 9.0];
/// Number of steps of this search, coarse and fine.
const STEPS: [usize; 2] = [16, 24];

/// Fraction of air at which its search begins, and number of steps.
const FIRST_AIR: f64 = 0.01;
const AIR_STEPS: usize = 8;

/// Fits volume as a function of pressure.
///
/// ```text
/// V_k = V_0 + sum b_j u_k^j/j + q_0 t_k + w_k + e_k        u = (p - p_m)/h,  p_m and h middle and half of the range
/// w_(k+1) = w_k + n_k,   variance of n over that of e by restricted likelihood           dV/dp = sum b_j u^(j-1)/h
/// ```
///
/// e is the reading error from row to row, w the accumulated integral of a meter's noise, q_0 its
/// zero error and any leakage. If w dominates, only the changes from row to row count, and there
/// the noise of the pressure is as large as its change: smoothed pressures are instruments for the
/// recorded ones, with whose noise they have hardly anything in common. Harvey (1989), section 2.3,
/// for the local level; Patterson and Thompson (1971) for the likelihood.
///
/// Air in `oil` competes with the terms: the fit with the lower criterion of Schwarz (1978) is
/// used.
///
/// ```text
/// V_k = ... + V (-ln((1 - a) V_liquid(p_k) + a V_gas(p_k)) - p_k/beta_0)          a the fraction of free air
/// ```
pub(super) fn rise_fit(record: RiseRecord, oil: Option<AeratedOil>) -> Result<RiseFit, LineFitError> {
    let pressures = ends(record.pressures.iter().copied());
    let [low, high] = pressures;
    if low >= high {
        return Err(LineFitError::PressureNeverMoves { file: record.file });
    }
    let with_drift = !record.times.is_empty();
    let of = |terms: usize, drift: bool| fitted(&record, pressures, RiseModel { terms, drift, air: None });
    let first = of(1, with_drift);
    let is_determined = |fit: &TermsFit| {
        let deviation = fit.covariance.get((0, 0)).copied().unwrap_or(f64::INFINITY).max(0.0).sqrt();
        deviation < DETERMINED * fit.values.get(0).copied().unwrap_or(0.0).abs()
    };
    let drift = with_drift && first.as_ref().is_some_and(is_determined);
    let mut best = if drift { first } else { of(1, false) };
    for terms in 2..=MOST_TERMS {
        match of(terms, drift).filter(|fit| fit.is_decisive(terms - 1)) {
            Some(next) => best = Some(next),
            None => break,
        }
    }
    let aerated = oil.and_then(|oil| with_air(&record, pressures, oil, drift));
    let criterion = |fit: &Option<TermsFit>| fit.as_ref().map_or(f64::INFINITY, |fit| fit.criterion);
    if criterion(&aerated) < criterion(&best) {
        best = aerated;
    }
    let fit = best.ok_or_else(|| LineFitError::Unrelated { file: record.file.clone() })?;
    Ok(fit.into_rise(record, pressures))
}

/// Fit with air in the oil; `None` if there is no visible air.
fn with_air(record: &RiseRecord, pressures: [f64; 2], oil: AeratedOil, drift: bool) -> Option<TermsFit> {
    let of = |terms: usize| {
        let mut fraction = FIRST_AIR;
        let mut found = None;
        for _ in 0..AIR_STEPS {
            let model = RiseModel { terms, drift, air: Some((oil, fraction)) };
            let fit = fitted(record, pressures, model)?;
            let next = AeratedOil::possible(fit.values.get(terms).copied().unwrap_or(0.0));
            let is_there = (next - fraction).abs() <= 1e-6;
            fraction = next;
            found = Some(fit);
            if is_there {
                break;
            }
        }
        found.filter(|fit| fit.is_decisive(terms) && fraction > 0.0)
    };
    let constant = of(1)?;
    match of(2).filter(|fit| fit.is_decisive(1) && fit.criterion < constant.criterion) {
        Some(changing) => Some(changing),
        None => Some(constant),
    }
}

/// Law by which volumes follow from pressures.
#[derive(Clone, Copy)]
struct RiseModel {
    terms: usize,
    /// True if a constant flow is estimated.
    drift: bool,
    /// Air, and the fraction around which it is estimated.
    air: Option<(AeratedOil, f64)>,
}

impl RiseModel {
    /// Number of coefficients without the drift.
    fn count(&self) -> usize {
        self.terms + usize::from(self.air.is_some())
    }
}

/// A fit with a fixed number of terms.
struct TermsFit {
    model: RiseModel,
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    offset: f64,
    white_variance: f64,
    ratio: f64,
    /// Information criterion: lower is better.
    criterion: f64,
}

impl TermsFit {
    /// True if a coefficient is larger than by chance.
    fn is_decisive(&self, index: usize) -> bool {
        let value = self.values.get(index).copied().unwrap_or(0.0);
        let variance = self.covariance.get((index, index)).copied().unwrap_or(f64::INFINITY);
        value.abs() >= DECISIVE * variance.max(0.0).sqrt()
    }

    fn into_rise(self, record: RiseRecord, pressures: [f64; 2]) -> RiseFit {
        let terms = self.model.count();
        RiseFit {
            oil: self.model.air.map(|(oil, _)| oil),
            record,
            pressures,
            coefficients: self.values.rows(0, terms).into_owned(),
            covariance: self.covariance.view((0, 0), (terms, terms)).into_owned(),
            drift: self.values.get(terms).copied().filter(|_| self.model.drift),
            offset: self.offset,
            white_noise: self.white_variance.sqrt(),
            walk: (self.ratio * self.white_variance).sqrt(),
        }
    }
}

/// Columns of the regression: instruments, the regressors that they represent, and the volume.
fn columns(record: &RiseRecord, [low, high]: [f64; 2], model: RiseModel) -> Vec<Vec<f64>> {
    let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
    let smooth = smoothed(&record.pressures);
    let mut columns = Vec::new();
    for pressures in [&smooth, &record.pressures] {
        let of = |term: usize| {
            let power = |p: &f64| powered((p - middle) / half, term) / term as f64;
            pressures.iter().map(power).collect::<Vec<f64>>()
        };
        columns.extend((1..=model.terms).map(of));
        columns.extend(
            model.air.map(|(oil, air)| pressures.iter().map(|p| oil.taken_up_slope(air, *p)).collect()),
        );
        columns.extend(model.drift.then(|| record.times.clone()));
    }
    // the volume of air is linear in its fraction around the given one
    let beyond =
        |p: f64| model.air.map_or(0.0, |(oil, air)| oil.taken_up(air, p) - air * oil.taken_up_slope(air, p));
    let rows = record.volumes.iter().zip(&record.pressures);
    columns.push(rows.map(|(volume, pressure)| volume - beyond(*pressure)).collect());
    columns
}

/// Each value replaced by the mean of those around it, over a hundredth of the record.
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

/// Coefficients at the best ratio of walk to white noise.
fn fitted(record: &RiseRecord, pressures: [f64; 2], model: RiseModel) -> Option<TermsFit> {
    let columns = columns(record, pressures, model);
    let spread = if model.air.is_some() { NoiseSpread::DiffersByRow } else { NoiseSpread::Even };
    let at = |ratio: f64| WhitenedSolution::of(&whitened(&columns, exp(ratio)), spread);
    let cost = |ratio: f64| at(ratio).map_or(f64::INFINITY, |solved| solved.cost);
    let [least, most] = RATIOS;
    let [coarse, fine] = STEPS;
    let step = (most - least) / coarse as f64;
    let grid = (0..=coarse).map(|index| least + step * index as f64);
    let best = grid.map(|ratio| (ratio, cost(ratio))).min_by(|one, other| one.1.total_cmp(&other.1))?.0;
    let ratio = golden_section([best - step, best + step], fine, cost);
    let solved = at(ratio)?;
    let of_first = |column: &Vec<f64>| column.first().copied().unwrap_or(0.0);
    let (volume, others) = columns.split_last()?;
    let shown = others.iter().skip(others.len() / 2);
    let explained: f64 = shown.zip(solved.values.iter()).map(|(x, b)| of_first(x) * b).sum();
    // the wander of a volume that was not integrated from a flow is no noise
    let compared = if record.source == VolumeSource::Flow { ratio } else { least };
    let likelihood = at(compared)?.likelihood;
    let rows = record.volumes.len() as f64;
    let numbers = solved.values.len() as f64;
    Some(TermsFit {
        model,
        criterion: likelihood + numbers * ln(rows),
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
    /// Minus twice the log-likelihood.
    likelihood: f64,
}

/// Spread of the noise of a volume over the rows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NoiseSpread {
    Even,
    /// The noise of the pressure has more effect where air makes the line soft.
    DiffersByRow,
}

impl WhitenedSolution {
    /// ```text
    /// b = (Z'X)^-1 Z'y        cov = s^2 (Z'X)^-1 Z'Z (X'Z)^-1        or with sum e^2 z z' for s^2 Z'Z (White 1980)
    /// ```
    fn of(found: &Whitened, noise: NoiseSpread) -> Option<WhitenedSolution> {
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
        let left: Vec<f64> = left.collect();
        let squares: f64 = left.iter().map(|value| value * value).sum::<f64>().max(f64::MIN_POSITIVE);
        let variance = squares / freedom;
        let scatter = match noise {
            NoiseSpread::Even => own * variance,
            NoiseSpread::DiffersByRow => DMatrix::from_fn(count, count, |i, j| {
                let both = instruments.get(i).zip(instruments.get(j));
                let rows = both.into_iter().flat_map(|(x, y)| x.iter().zip(y)).zip(&left);
                let sum: f64 = rows.map(|((x, y), left)| x * y * left * left).sum();
                sum / (scale(i) * scale(j)) * volume.len() as f64 / freedom
            }),
        };
        let spread = &inverse * scatter * inverse.transpose();
        let rows = volume.len() as f64;
        Some(WhitenedSolution {
            values,
            covariance: DMatrix::from_fn(count, count, |i, j| spread[(i, j)] / (scale(i) * scale(j))),
            variance,
            cost: freedom * ln(variance) + found.determinant + determinant,
            likelihood: rows * ln(squares / rows) + found.determinant,
        })
    }
}

impl RiseFit {
    /// Number of terms of the volume as a function of the pressure: 1 for a constant compliance,
    /// without that of air.
    pub fn terms(&self) -> usize {
        self.coefficients.len() - usize::from(self.oil.is_some())
    }

    /// Fraction of free air at atmospheric pressure, and its standard deviation; absent if the
    /// record shows none.
    pub fn air_fraction(&self) -> Option<[f64; 2]> {
        let last = self.terms();
        let variance = self.covariance.get((last, last)).copied().unwrap_or(f64::INFINITY);
        self.oil.map(|_| [self.coefficients[last], variance.max(0.0).sqrt()])
    }

    /// Air that the record shows.
    pub(super) fn air(&self) -> Option<EntrainedAir> {
        self.oil.zip(self.air_fraction()).map(|(oil, [fraction, _])| oil.air(fraction))
    }

    fn half(&self) -> f64 {
        let [low, high] = self.pressures;
        (high - low) / 2.0
    }

    fn scaled(&self, pressure: f64) -> f64 {
        let [low, high] = self.pressures;
        (pressure - f64::midpoint(low, high)) / self.half()
    }

    /// Compliance of air at a pressure, Pa, in m3/Pa, with the derivatives with respect to its
    /// fraction and to the pressure.
    fn of_air(&self, pressure: f64) -> [f64; 3] {
        let both = self.oil.zip(self.air_fraction());
        both.map_or([0.0; 3], |(oil, [fraction, _])| oil.compliance(fraction, pressure))
    }

    /// Volume that the air takes up at a gauge pressure, Pa, in m3, and the derivative with respect
    /// to its fraction.
    fn taken_by_air(&self, pressure: f64) -> [f64; 2] {
        let both = self.oil.zip(self.air_fraction());
        both.map_or([0.0; 2], |(oil, [fraction, _])| {
            [oil.taken_up(fraction, pressure), oil.taken_up_slope(fraction, pressure)]
        })
    }

    /// Compliance dV/dp at a pressure, Pa, in m3/Pa, and its standard deviation.
    pub fn compliance(&self, pressure: f64) -> [f64; 2] {
        let u = self.scaled(pressure);
        let [air, by_fraction, _] = self.of_air(pressure);
        self.combined(|term| powered(u, term) / self.half(), [air, by_fraction])
    }

    /// Change of volume divided by change of pressure between the ends, m3/Pa, and its standard
    /// deviation.
    pub fn secant(&self) -> [f64; 2] {
        let odd = |term: usize| if term.is_multiple_of(2) { 1.0 / (term + 1) as f64 } else { 0.0 };
        let [low, high] = self.pressures.map(|pressure| self.taken_by_air(pressure));
        let between = |index: usize| (high[index] - low[index]) / (2.0 * self.half());
        self.combined(|term| odd(term) / self.half(), [between(0), between(1)])
    }

    /// Slope of the compliance with respect to the pressure, at a pressure, Pa, in m3/Pa2, and its
    /// standard deviation.
    pub(crate) fn compliance_slope(&self, pressure: f64) -> [f64; 2] {
        let (u, half) = (self.scaled(pressure), self.half());
        let [_, _, by_pressure] = self.of_air(pressure);
        // the slope of the volume of air is nearly linear in its fraction
        let by_fraction = self.air_fraction().map_or(0.0, |[fraction, _]| by_pressure / fraction);
        self.combined(
            |term| term as f64 * powered(u, term.saturating_sub(1)) / (half * half),
            [by_pressure, by_fraction],
        )
    }

    /// Sum over the terms with these weights, with the contribution of air, and its derivative with
    /// respect to the fraction of air.
    fn combined(&self, weight: impl Fn(usize) -> f64, [air, by_fraction]: [f64; 2]) -> [f64; 2] {
        let terms = self.terms();
        let of = |term: usize| if term < terms { weight(term) } else { by_fraction };
        let weights = DVector::from_fn(self.coefficients.len(), |term, _| of(term));
        let variance = (weights.transpose() * &self.covariance * &weights).x;
        let all = self.coefficients.iter().take(terms).enumerate();
        let sum: f64 = all.map(|(term, coefficient)| weight(term) * coefficient).sum();
        [sum + air, variance.max(0.0).sqrt()]
    }

    /// Volume displaced at a pressure, Pa, in m3, without drift.
    pub fn volume(&self, pressure: f64) -> f64 {
        let u = self.scaled(pressure);
        let [air, _] = self.taken_by_air(pressure);
        let terms = self.coefficients.iter().take(self.terms()).enumerate();
        let sum: f64 = terms.map(|(index, b)| b * powered(u, index + 1) / (index + 1) as f64).sum();
        self.offset + air + sum
    }

    /// Pressure, Pa, and volume, m3, of each row, without the drift.
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
