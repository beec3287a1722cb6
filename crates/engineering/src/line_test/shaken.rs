//! Compliance, creep and inertance from the frequency response of a blocked line.

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::least_squares::{Linearised, Minimum, Settings, minimise};
use phea_dynamics::portable::{exp, ln};
use phea_dynamics::spectrum::SpectralPoint;
use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_hydraulics::line::{
    BlockedLine, Conduit, DynamicLine, LineModel, Segments, StandardLinearSolid, TransmissionLine,
    friction_factor,
};

use super::KnownLine;
use super::known::EXACT;
use super::response_noise::smoothed_deviations;
use crate::estimate::{Estimate, NORMAL_95};
use crate::identify_error::{IdentifyError, LineFitError};
use crate::response::ResponseMember;

/// Parameters of the response of a blocked line, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineParameters {
    /// Immediate compliance of oil and wall, m3/Pa.
    pub compliance: f64,
    /// Delayed compliance of the wall, m3/Pa, and its time constant, s.
    pub creep: Option<[f64; 2]>,
    /// Inertance, Pa s2/m3; absent for a plain volume.
    pub inertance: Option<f64>,
}

/// Parameters that explain a response.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseFit {
    /// Response of pressure over flow.
    pub member: ResponseMember,
    /// Mean of the recorded pressure, Pa.
    pub pressure: f64,
    /// Parameters of the line.
    pub parameters: LineParameters,
    /// Standard deviation of the response at each frequency.
    pub deviations: Vec<f64>,
    /// Sum of squares relative to that of noise, and degrees of freedom.
    pub misfit: [f64; 2],
    /// Model of the fit.
    pub model: LineModel,
    /// Covariance of the logarithms of the parameters, in their order.
    covariance: DMatrix<f64>,
    /// True if the inertance ended at its least value in the search.
    pub without_waves: bool,
}

/// Compliance at one frequency, C = Im(q/p)/w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliancePoint {
    /// Frequency, rad/s.
    pub frequency: f64,
    /// Measured compliance, m3/Pa.
    pub measured: f64,
    /// Half width of the 95 % interval, m3/Pa.
    pub edge: f64,
    /// Compliance of the fitted line, m3/Pa.
    pub model: f64,
    /// Squared coherence of the record at this frequency.
    pub coherence: f64,
}

/// Ratios to the inertance of the declared oil at which the search begins.
const STARTS: [f64; 5] = [1.0, 0.6, 1.6, 0.3, 3.0];
/// Least and greatest ratio.
const RATIOS: [f64; 2] = [1e-3, 30.0];
/// Initial ratios of the whole to the immediate compliance of a wall that creeps.
const STIFFENINGS: [f64; 3] = [3.0, 1.3, 8.0];
/// Step of the derivatives in the logarithm.
const STEP: f64 = 1e-5;
/// Largest factor by which a parameter may change in the search.
const RANGE: f64 = 1e4;

/// Fits the model of the line to a response. `slow` is the logarithm of the whole compliance, with
/// its standard deviation, if a pressure rise determines it.
pub(super) fn response_fit(
    member: ResponseMember,
    pressure: f64,
    known: &KnownLine,
    slow: Option<[f64; 2]>,
    watch: Watch<'_>,
) -> Result<ResponseFit, IdentifyError> {
    let model = known.sought_model();
    let deviations = smoothed_deviations(&member.points);
    let sought = SoughtLine { known, model, points: &member.points, deviations: &deviations, slow };
    let best = sought.best(watch)?;
    let best = best.ok_or_else(|| LineFitError::NoSuchResponse { file: member.file.clone() })?;
    let parameters = sought.parameters(&best.variables);
    let count = best.variables.len();
    let rows = best.linearised.residuals.len();
    let jacobian = DMatrix::from_row_slice(rows, count, &best.linearised.jacobian);
    let freedom = rows.saturating_sub(count) as f64;
    let misfit = 2.0 * best.cost / freedom.max(1.0);
    let inverse = (jacobian.transpose() * &jacobian).try_inverse();
    let covariance = inverse.unwrap_or_else(|| DMatrix::from_element(count, count, f64::INFINITY));
    let grown = if misfit > most_misfit(freedom) { misfit } else { 1.0 };
    let without_waves = match (parameters.inertance, known.inertance()) {
        (Some(found), Some(stated)) => found < 1.01 * RATIOS[0] * stated,
        _ => false,
    };
    Ok(ResponseFit {
        covariance: covariance * grown,
        misfit: [misfit, freedom],
        parameters,
        deviations,
        pressure,
        model,
        without_waves,
        member,
    })
}

/// Bound of the mean square of residuals relative to their noise by chance: four standard
/// deviations.
pub(super) fn most_misfit(freedom: f64) -> f64 {
    1.0 + 4.0 * (2.0 / freedom.max(1.0)).sqrt()
}

/// Model and response of a search.
struct SoughtLine<'a> {
    known: &'a KnownLine,
    model: LineModel,
    points: &'a [SpectralPoint],
    deviations: &'a [f64],
    slow: Option<[f64; 2]>,
}

impl SoughtLine<'_> {
    fn creeps(&self) -> Option<f64> {
        match self.model {
            LineModel::Segments { relaxation_time, .. } => relaxation_time,
            LineModel::Creeping { relaxation_time } => Some(relaxation_time),
            _ => None,
        }
    }

    /// Parameters from the logarithms of compliance, creep and retardation, inertance, if the model
    /// has them.
    fn parameters(&self, variables: &[f64]) -> LineParameters {
        let mut values = variables.iter().map(|variable| exp(*variable));
        let mut next = || values.next().unwrap_or(f64::NAN);
        LineParameters {
            compliance: next(),
            creep: self.creeps().map(|_| [next(), next()]),
            inertance: self.known.inertance().map(|_| next()),
        }
    }

    /// Best minimum from several starts, or the first that explains the response.
    fn best(&self, watch: Watch<'_>) -> Result<Option<Minimum>, Stopped> {
        let inertances: &[f64] = if self.known.inertance().is_some() { &STARTS } else { &[1.0] };
        let stiffenings: &[f64] = if self.creeps().is_some() { &STIFFENINGS } else { &[1.0] };
        let starts: Vec<[f64; 2]> =
            inertances.iter().flat_map(|one| stiffenings.iter().map(|other| [*one, *other])).collect();
        let mut best: Option<Minimum> = None;
        for (index, start) in starts.iter().enumerate() {
            report_progress(watch, "blocked line", index, starts.len())?;
            let found = self.from(*start)?;
            let rows = found.linearised.residuals.len();
            let freedom = rows.saturating_sub(found.variables.len()) as f64;
            let is_explained = 2.0 * found.cost <= most_misfit(freedom) * freedom;
            if found.cost.is_finite() && best.as_ref().is_none_or(|best| found.cost < best.cost) {
                best = Some(found);
            }
            if is_explained {
                break;
            }
        }
        Ok(best)
    }

    /// Minimum of a search from the compliance at the lowest frequency, with this ratio of
    /// inertance and of stiffening.
    fn from(&self, [factor, stiffening]: [f64; 2]) -> Result<Minimum, Stopped> {
        let lowest = self.points.first();
        let whole = lowest.map_or(f64::NAN, |point| point.response.inv().im / point.frequency).abs();
        let mut start = vec![ln(whole / stiffening)];
        if let Some(time) = self.creeps() {
            start.extend([ln(whole * (1.0 - 1.0 / stiffening)), ln(time * stiffening)]);
        }
        let mut bounds: Vec<[f64; 2]> =
            start.iter().map(|value| [value - ln(RANGE), value + ln(RANGE)]).collect();
        if let Some(inertance) = self.known.inertance() {
            start.push(ln(factor * inertance));
            bounds.push(RATIOS.map(|ratio| ln(ratio * inertance)));
        }
        let settings = Settings { robust_beyond: f64::INFINITY, ..Settings::default() };
        minimise(&start, &bounds, settings, &mut |variables| Ok(self.linearised(variables)))
    }

    fn linearised(&self, variables: &[f64]) -> Option<Linearised> {
        let residuals = self.residuals(variables)?;
        let count = variables.len();
        let mut jacobian = vec![0.0; residuals.len() * count];
        for index in 0..count {
            let moved = |by: f64| {
                let mut moved = variables.to_vec();
                moved.iter_mut().skip(index).take(1).for_each(|value| *value += by);
                self.residuals(&moved)
            };
            let (more, less) = (moved(STEP)?, moved(-STEP)?);
            let slopes = more.iter().zip(&less).map(|(more, less)| (more - less) / (2.0 * STEP));
            for (row, slope) in jacobian.chunks_exact_mut(count).zip(slopes) {
                row.iter_mut().skip(index).take(1).for_each(|value| *value = slope);
            }
        }
        Some(Linearised { residuals, jacobian })
    }

    /// Real and imaginary part of each point divided by their standard deviation, and the deviation
    /// of the whole compliance divided by that of the pressure rise.
    fn residuals(&self, variables: &[f64]) -> Option<Vec<f64>> {
        let parameters = self.parameters(variables);
        let line = SoughtImpedance::of(self.known, self.model, &parameters)?;
        let mut residuals = Vec::with_capacity(2 * self.points.len() + 1);
        for (point, deviation) in self.points.iter().zip(self.deviations) {
            let model = line.at(point.frequency);
            let wrong = (model - point.response) * (std::f64::consts::SQRT_2 / deviation);
            residuals.extend([wrong.re, wrong.im]);
        }
        if let (Some([expected, deviation]), Some([creep, _])) = (self.slow, parameters.creep) {
            residuals.push((ln(parameters.compliance + creep) - expected) / deviation);
        }
        residuals.iter().all(|value| value.is_finite()).then_some(residuals)
    }
}

/// Pressure divided by flow at the open end of a blocked line.
enum SoughtImpedance {
    /// Line of a model that a machine computes.
    Model(BlockedLine),
    /// Exact line.
    Exact(Conduit),
}

impl SoughtImpedance {
    /// Impedance of these parameters; `None` if their model does not exist.
    fn of(known: &KnownLine, model: LineModel, parameters: &LineParameters) -> Option<SoughtImpedance> {
        let LineParameters { compliance, inertance, .. } = *parameters;
        let conduit = inertance.and_then(|inertance| known.conduit(compliance, inertance));
        match (model, conduit) {
            (LineModel::TransmissionLine { end_share: EXACT }, Some(conduit)) => {
                Some(SoughtImpedance::Exact(conduit))
            }
            _ => blocked(known, model, parameters).map(SoughtImpedance::Model),
        }
    }

    /// Impedance at a frequency, rad/s, in Pa s/m3.
    ///
    /// ```text
    /// Z_c coth(Gamma) of the exact line with laminar friction
    /// ```
    fn at(&self, frequency: f64) -> Complex64 {
        let s = Complex64::new(0.0, frequency);
        match self {
            SoughtImpedance::Model(line) => line.impedance(s),
            SoughtImpedance::Exact(conduit) => {
                let factor = friction_factor(s / conduit.viscous_rate());
                let [[straight, _], [admittance, _]] = conduit.response(s, factor).transfer_matrix();
                straight / admittance
            }
        }
    }
}

/// Blocked line of these parameters; `None` if its model does not exist.
fn blocked(known: &KnownLine, model: LineModel, parameters: &LineParameters) -> Option<BlockedLine> {
    let LineParameters { compliance, creep, inertance } = *parameters;
    let Some(conduit) = inertance.and_then(|inertance| known.conduit(compliance, inertance)) else {
        return Some(BlockedLine::of(DynamicLine::Segments(Segments::lumped(compliance))));
    };
    match model {
        LineModel::TransmissionLine { end_share } => {
            let line = TransmissionLine::of_conduit(&conduit, end_share).ok()?;
            Some(BlockedLine::of(DynamicLine::TransmissionLine(line)))
        }
        LineModel::Segments { count, friction, .. } => {
            let mut segments = Segments::new(&conduit, count, friction).ok()?;
            if let Some([creep, retardation]) = creep {
                // any division into oil and wall has this creep: the whole immediate compliance is
                // assigned to the wall
                let volume = known.volume();
                let [fast, slow] = [volume / compliance, volume / (compliance + creep)];
                let wall = StandardLinearSolid {
                    static_modulus: slow,
                    dynamic_modulus: fast,
                    relaxation_time: retardation * slow / fast,
                };
                segments = segments.with_creep(&conduit, &wall).ok()?;
            }
            Some(BlockedLine::of(DynamicLine::Segments(segments)))
        }
        LineModel::Lumped | LineModel::Creeping { .. } | LineModel::TwoWave { .. } => None,
    }
}

impl ResponseFit {
    /// Estimate of a positive function of the parameters.
    pub(super) fn of(&self, function: impl Fn(&LineParameters) -> f64) -> Estimate {
        let LineParameters { compliance, creep, inertance } = self.parameters;
        let mut values = vec![compliance];
        values.extend(creep.into_iter().flatten());
        values.extend(inertance);
        let at = |values: &[f64]| {
            let mut values = values.iter().copied();
            let mut next = || values.next().unwrap_or(f64::NAN);
            ln(function(&LineParameters {
                compliance: next(),
                creep: creep.map(|_| [next(), next()]),
                inertance: inertance.map(|_| next()),
            }))
        };
        let slope = |index: usize| {
            let moved = |factor: f64| {
                let mut moved = values.clone();
                moved.iter_mut().skip(index).take(1).for_each(|value| *value *= factor);
                at(&moved)
            };
            (moved(exp(STEP)) - moved(exp(-STEP))) / (2.0 * STEP)
        };
        let slopes = nalgebra::DVector::from_fn(values.len(), |index, _| slope(index));
        let variance = (slopes.transpose() * &self.covariance * &slopes).x;
        Estimate::of_logarithm(at(&values), variance.max(0.0).sqrt())
    }

    /// Response of the model at a frequency, rad/s, pressure over flow.
    pub fn model_response(&self, known: &KnownLine, frequency: f64) -> Option<Complex64> {
        Some(SoughtImpedance::of(known, self.model, &self.parameters)?.at(frequency))
    }

    /// Compliance as a function of the frequency.
    ///
    /// ```text
    /// C(w) = Im(1/Z)/w        sigma_C = sigma_Z/(sqrt(2) |Z|^2 w)
    /// ```
    pub fn compliances(&self, known: &KnownLine) -> Vec<CompliancePoint> {
        let rows = self.member.points.iter().zip(&self.deviations);
        let of = |(point, deviation): (&SpectralPoint, &f64)| {
            let over = |response: Complex64| response.inv().im / point.frequency;
            let spread = deviation / (std::f64::consts::SQRT_2 * point.response.norm_sqr() * point.frequency);
            CompliancePoint {
                frequency: point.frequency,
                measured: over(point.response),
                edge: NORMAL_95 * spread,
                model: self.model_response(known, point.frequency).map_or(f64::NAN, over),
                coherence: point.coherence,
            }
        };
        rows.map(of).collect()
    }

    /// True if the residuals are as large as noise makes them.
    pub fn is_explained(&self) -> bool {
        let [misfit, freedom] = self.misfit;
        misfit <= most_misfit(freedom)
    }
}
