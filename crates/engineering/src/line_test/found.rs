use phea_dynamics::portable::{ln, pow};
use phea_dynamics::watch::Watch;
use phea_hydraulics::line::{Line, LineModel};

use super::rise::rise_fit;
use super::shaken::response_fit;
use super::{KnownLine, LineRecord, NotIdentifiableLine, ResponseFit, RiseFit, WideQuantity};
use crate::estimate::{Estimate, NORMAL_95};
use crate::identify_error::{IdentifyError, LineFitError};
use crate::response::{ResponseSettings, SampledPair, members};

/// A line as identified from recordings.
#[derive(Clone, Debug, PartialEq)]
pub struct LineIdentification {
    /// Known facts.
    pub known: KnownLine,
    /// Pressure for which all results hold, Pa.
    pub pressure: f64,
    /// Fit of the slow test.
    pub rise: Option<RiseFit>,
    /// Fit of the fast test.
    pub response: Option<ResponseFit>,
    /// Effective bulk modulus at rest, Pa.
    pub effective_bulk_modulus: Result<Estimate, NotIdentifiableLine>,
    /// Secant bulk modulus between both ends of the slow test, Pa.
    pub secant_bulk_modulus: Result<Estimate, NotIdentifiableLine>,
    /// Slope d beta/dp of the modulus at rest with respect to the pressure, dimensionless.
    pub modulus_slope: Result<Estimate, NotIdentifiableLine>,
    /// Bulk modulus under fast changes, Pa.
    pub dynamic_bulk_modulus: Result<Estimate, NotIdentifiableLine>,
    /// Dynamic stiffening r_beta of the wall of a hose.
    pub dynamic_stiffening: Result<Estimate, NotIdentifiableLine>,
    /// Relaxation time of the pressure at constant volume, s.
    pub relaxation_time: Result<Estimate, NotIdentifiableLine>,
    /// Speed of a fast wave, m/s.
    pub wave_speed: Result<Estimate, NotIdentifiableLine>,
    /// Volume of free air at atmospheric pressure as a fraction of that of the mixture.
    pub entrained_air: Result<Estimate, NotIdentifiableLine>,
    /// Density of the oil, kg/m3, from its inertance with the declared length and bore.
    pub density: Result<Estimate, NotIdentifiableLine>,
}

/// Standard deviation of a logarithm beyond which a number is not determined: a factor of one and a
/// half in either direction.
const NARROW: f64 = 0.2;
/// Largest standard deviation of the logarithm of a wave speed and of a relaxation time, which
/// follow from the response beyond a compliance: with less than five standard deviations it may be
/// absent.
const SHOWN: f64 = 0.1;
/// Fraction of the range of a pressure rise by which it may be extrapolated.
const BEYOND: f64 = 0.1;

/// Identifies a line from recordings: at most one slow test and one fast one.
///
/// ```text
/// beta_e = V/(dV/dp)       r_beta = (C_rest - V/beta_0)/(C_fast - V/beta_0)       c = L/sqrt(I C_fast)
/// ```
///
/// V is the volume of oil in the line at the operating pressure, beta_0 the modulus of the declared
/// fluid there, I the inertance of the fit. Units: Pa, m3, m3/Pa, m/s. Theory of the line: D'Souza
/// and Oldenburger (1964).
///
/// # Errors
/// [`IdentifyError`] for recordings that no line explains, for several of one kind, and after
/// cancellation.
///
/// # Example
/// A rigid volume of a litre filled by hand.
/// ```
/// use phea_engineering::line_test::{
///     KnownLine, LineRecord, NotIdentifiableLine, RiseRecord, VolumeSource, identify_line,
/// };
/// use phea_hydraulics::fluid::Fluid;
/// use phea_hydraulics::line::Line;
/// # use phea_project::{LineMotion, LineSide};
/// # let settings = phea_engineering::response::ResponseSettings::default();
/// let known = KnownLine {
///     side: LineSide::A,
///     differs_from_other: false,
///     line: Line::Volume { volume: 1e-3, effective_bulk_modulus: 1e9 },
///     fluid: Fluid {
///         bulk_modulus: 1.45e9, density: 870.0, kinematic_viscosity: 46e-6, entrained_air: None,
///         vapour_pressure_absolute: 0.0,
///     },
///     pressure: 35e5,
///     motion: LineMotion::Lumped,
///     piston_area: 0.0,
///     leaves_accumulator: false,
/// };
/// let pressures: Vec<f64> = (0..20).map(|row| 3e5 * f64::from(row)).collect();
/// let volumes = pressures.iter().map(|pressure| 1e-3 * pressure / 1.2e9).collect();
/// let record = RiseRecord { file: "hand.csv".to_string(), source: VolumeSource::Volume, times: vec![], volumes, pressures };
/// let found = identify_line(vec![LineRecord::Rise(record)], known, &settings, &mut |_| true).unwrap();
/// assert!((found.effective_bulk_modulus.unwrap().value / 1.2e9 - 1.0).abs() < 1e-9);
/// assert_eq!(found.wave_speed, Err(NotIdentifiableLine::NoResponse));
/// ```
pub fn identify_line(
    records: Vec<LineRecord>,
    known: KnownLine,
    settings: &ResponseSettings,
    watch: Watch<'_>,
) -> Result<LineIdentification, IdentifyError> {
    let (mut rises, mut responses) = (Vec::new(), Vec::new());
    for record in records {
        match record {
            LineRecord::Rise(rise) => rises.push(rise),
            LineRecord::Response(response) => responses.push(response),
        }
    }
    if rises.len() > 1 {
        return Err(LineFitError::SeveralRises(rises.len()).into());
    }
    if responses.len() > 1 {
        return Err(LineFitError::SeveralResponses(responses.len()).into());
    }
    let oil = known.aerated_oil();
    let rise = rises.pop().map(|record| rise_fit(record, oil)).transpose()?;
    let known = match rise.as_ref().and_then(RiseFit::air) {
        Some(air) => known.with_air(air),
        None => known,
    };
    let response = match responses.pop() {
        None => None,
        Some(record) => Some(shaken(&record, rise.as_ref(), &known, settings, watch)?),
    };
    if rise.is_none() && response.is_none() {
        return Err(LineFitError::NoRecording.into());
    }
    Ok(combined(known, rise, response))
}

/// Fit of a frequency response, together with the pressure rise.
fn shaken(
    record: &SampledPair,
    rise: Option<&RiseFit>,
    known: &KnownLine,
    settings: &ResponseSettings,
    watch: Watch<'_>,
) -> Result<ResponseFit, IdentifyError> {
    let pressure = record.output.iter().sum::<f64>() / record.output.len().max(1) as f64;
    let member = members(std::slice::from_ref(record), settings, watch)?.pop();
    let member = member.ok_or(LineFitError::NoRecord)?;
    let slow = rise.filter(|rise| rise.reaches(pressure)).map(|rise| {
        let [compliance, deviation] = rise.compliance(pressure);
        [ln(compliance), deviation / compliance]
    });
    let slow = slow.filter(|[value, deviation]| value.is_finite() && *deviation > 0.0);
    response_fit(member, pressure, known, slow, watch)
}

impl RiseFit {
    /// True if a pressure, Pa, is among those that were recorded, or near them.
    fn reaches(&self, pressure: f64) -> bool {
        let [low, high] = self.pressures;
        let beyond = BEYOND * (high - low);
        (low - beyond..=high + beyond).contains(&pressure)
    }
}

/// Results of both tests together.
fn combined(known: KnownLine, rise: Option<RiseFit>, response: Option<ResponseFit>) -> LineIdentification {
    let volume = known.volume();
    let pressure = match (&response, &rise) {
        (Some(response), _) => response.pressure,
        (None, Some(rise)) if rise.reaches(known.pressure) => known.pressure,
        (None, Some(rise)) => f64::midpoint(rise.pressures[0], rise.pressures[1]),
        (None, None) => known.pressure,
    };
    let at_rest = compliance_at_rest(&known, pressure, rise.as_ref(), response.as_ref());
    let fast = response.as_ref().ok_or(NotIdentifiableLine::NoResponse);
    let fast_compliance = fast.map(|fit| fit.of(|line| line.compliance));
    let slow = rise.as_ref().ok_or(NotIdentifiableLine::NoRise);
    let secant = slow.and_then(|rise| {
        let [value, deviation] = rise.secant();
        narrow(relative(value, deviation)?.under(volume), WideQuantity::SecantModulus)
    });
    LineIdentification {
        effective_bulk_modulus: at_rest
            .and_then(|compliance| narrow(compliance.under(volume), WideQuantity::ModulusAtRest)),
        secant_bulk_modulus: secant,
        entrained_air: slow.and_then(air),
        modulus_slope: slow.and_then(|rise| slope(rise, volume, pressure)),
        dynamic_bulk_modulus: fast_compliance
            .and_then(|compliance| narrow(compliance.under(volume), WideQuantity::DynamicModulus)),
        dynamic_stiffening: stiffening(&known, pressure, at_rest, response.as_ref())
            .and_then(|number| narrow(number, WideQuantity::DynamicStiffening)),
        relaxation_time: fast.and_then(|fit| relaxation(&known, fit)),
        density: fast.and_then(|fit| density(&known, fit)),
        wave_speed: fast.and_then(|fit| wave_speed(&known, fit)),
        pressure,
        known,
        rise,
        response,
    }
}

/// An estimate that is known to a factor of one and a half.
fn narrow(estimate: Estimate, quantity: WideQuantity) -> Result<Estimate, NotIdentifiableLine> {
    let deviation = estimate.deviation_of_logarithm();
    if deviation < NARROW { Ok(estimate) } else { Err(NotIdentifiableLine::Wide { quantity, deviation }) }
}

/// A number of this standard deviation, by its logarithm.
fn relative(value: f64, deviation: f64) -> Result<Estimate, NotIdentifiableLine> {
    if value > 0.0 && deviation.is_finite() {
        return Ok(Estimate::of_logarithm(ln(value), deviation / value));
    }
    Err(NotIdentifiableLine::PressureDoesNotRise { slope: value })
}

/// Compliance at rest, m3/Pa: for a creeping wall that of oil and wall after the creep. A line that
/// is not a hose yields at rest as it does in motion.
fn compliance_at_rest(
    known: &KnownLine,
    pressure: f64,
    rise: Option<&RiseFit>,
    response: Option<&ResponseFit>,
) -> Result<Estimate, NotIdentifiableLine> {
    let from_rise = rise.filter(|rise| rise.reaches(pressure)).map(|rise| {
        let [value, deviation] = rise.compliance(pressure);
        relative(value, deviation)
    });
    let is_hose = matches!(known.line, Line::Hose { .. });
    let in_motion = response.map(|fit| fit.of(|line| line.compliance));
    match (from_rise, response, in_motion) {
        (_, Some(fit), _) if fit.parameters.creep.is_some() => {
            Ok(fit.of(|line| line.compliance + line.creep.map_or(0.0, |[creep, _]| creep)))
        }
        (Some(Ok(rise)), _, Some(moving)) if !is_hose => Ok(Estimate::combined(rise, moving)),
        (None | Some(Err(_)), _, Some(moving)) if !is_hose => Ok(moving),
        (Some(rise), ..) => rise,
        (None, Some(_), _) => Err(NotIdentifiableLine::NoRiseOfHose),
        (None, None, _) => Err(NotIdentifiableLine::NoRise),
    }
}

/// Fraction of free air.
fn air(rise: &RiseFit) -> Result<Estimate, NotIdentifiableLine> {
    let [value, deviation] = rise.air_fraction().ok_or(NotIdentifiableLine::NoAir)?;
    let edge = NORMAL_95 * deviation;
    Ok(Estimate { value, interval: [(value - edge).max(0.0), value + edge] })
}

/// Slope d beta/dp at a pressure, if the compliance changes.
fn slope(rise: &RiseFit, volume: f64, pressure: f64) -> Result<Estimate, NotIdentifiableLine> {
    if rise.terms() < 2 && rise.air_fraction().is_none() {
        return Err(NotIdentifiableLine::ConstantCompliance);
    }
    let [compliance, _] = rise.compliance(pressure);
    let [slope, deviation] = rise.compliance_slope(pressure);
    let factor = -volume / (compliance * compliance);
    let (value, edge) = (factor * slope, NORMAL_95 * factor.abs() * deviation);
    Ok(Estimate { value, interval: [value - edge, value + edge] })
}

/// Dynamic stiffening r_beta of a hose.
fn stiffening(
    known: &KnownLine,
    pressure: f64,
    at_rest: Result<Estimate, NotIdentifiableLine>,
    response: Option<&ResponseFit>,
) -> Result<Estimate, NotIdentifiableLine> {
    if !matches!(known.line, Line::Hose { .. }) {
        return Err(NotIdentifiableLine::NoHose);
    }
    let fit = response.ok_or(NotIdentifiableLine::NoResponse)?;
    let rest = at_rest?;
    let oil = known.fluid_compliance(pressure).unwrap_or(0.0);
    let [fast, slow] = [fit.parameters.compliance - oil, rest.value - oil];
    if fast <= 0.0 || slow <= 0.0 {
        return Err(NotIdentifiableLine::StifferThanOil { wall: [fast, slow] });
    }
    if fit.parameters.creep.is_some() {
        return Ok(fit.of(|line| {
            let fast = line.compliance - oil;
            (fast + line.creep.map_or(0.0, |[creep, _]| creep)) / fast
        }));
    }
    let of_fast = fit.of(|line| line.compliance - oil).deviation_of_logarithm();
    let of_slow = rest.deviation_of_logarithm() * rest.value / slow;
    Ok(Estimate::of_logarithm(ln(slow / fast), pow(of_fast * of_fast + of_slow * of_slow, 0.5)))
}

/// Relaxation time tau of a creeping wall, with the declared oil.
fn relaxation(known: &KnownLine, fit: &ResponseFit) -> Result<Estimate, NotIdentifiableLine> {
    if fit.parameters.creep.is_none() {
        return Err(NotIdentifiableLine::NoCreep);
    }
    let oil = known.fluid_compliance(fit.pressure).unwrap_or(0.0);
    let of = |line: &super::LineParameters| {
        let fast = line.compliance - oil;
        line.creep.map_or(f64::NAN, |[creep, retardation]| retardation * fast / (fast + creep))
    };
    let found = fit.of(of);
    if !found.value.is_finite() {
        return Err(NotIdentifiableLine::NoWallCompliance);
    }
    let deviation = found.deviation_of_logarithm();
    if deviation < SHOWN { Ok(found) } else { Err(NotIdentifiableLine::AwayFromCreep { deviation }) }
}

/// Density of the oil, I A/L.
fn density(known: &KnownLine, fit: &ResponseFit) -> Result<Estimate, NotIdentifiableLine> {
    wave_speed(known, fit)?;
    let stated = known.inertance().unwrap_or(f64::NAN);
    Ok(fit.of(|line| known.fluid.density * line.inertance.unwrap_or(f64::NAN) / stated))
}

/// Speed c of a fast wave.
fn wave_speed(known: &KnownLine, fit: &ResponseFit) -> Result<Estimate, NotIdentifiableLine> {
    let Some([length, _]) = known.dimensions() else {
        return Err(NotIdentifiableLine::NoLength);
    };
    if matches!(known.declared_model(), LineModel::TwoWave { .. }) {
        return Err(NotIdentifiableLine::TwoWaves);
    }
    let highest = fit.member.points.last().map_or(0.0, |point| point.frequency);
    if fit.without_waves {
        return Err(NotIdentifiableLine::NoWave { highest });
    }
    let found = fit.of(|line| length / pow(line.inertance.unwrap_or(f64::NAN) * line.compliance, 0.5));
    if found.deviation_of_logarithm() < SHOWN {
        return Ok(found);
    }
    Err(NotIdentifiableLine::BelowQuarterWave { highest, quarter_wave: found.value / (4.0 * length) })
}
