//! The fit of a prefilter into its band, as a search problem.

use num_complex::Complex64;
use phea_dynamics::controller::Timing;
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;

use super::PrefilterBand;
use super::band::RESOLVED_DB;
use crate::loop_shaping::{Judgement, MarginRow, SearchProblem, Slopes, Structure, StructureResponse};

/// Decibels per neper.
const DECIBELS_PER_NEPER: f64 = 20.0 / std::f64::consts::LN_10;

/// A structure to be fitted into a band: its margins to both edges at each frequency, divided by
/// their unit ([`super::PrefilterBandPoint::rate`]).
///
/// ```text
/// m = (|F| - least)/rate  and  (greatest - |F|)/rate        magnitudes in dB
/// dm/dx = +-(20/ln 10) Re(d ln F/dx)/rate
/// ```
///
/// After this scaling every rate is 1, and there is no objective: the aim is the greatest worst
/// margin, which is in the middle of the band where it is narrow.
#[derive(Clone, Debug)]
pub struct PrefilterFit {
    structure: Structure,
    bounds: Vec<[f64; 2]>,
    response: StructureResponse,
    targets: Vec<Target>,
}

/// The band at one frequency, dB.
#[derive(Clone, Copy, Debug)]
struct Target {
    least: f64,
    greatest: f64,
    rate: f64,
}

impl PrefilterFit {
    /// The fit of a structure, sampled as the loop samples its prefilter. If the edges of the band
    /// have crossed by no more than the tolerance (dB) at each edge, the band is widened by it.
    ///
    /// # Errors
    /// [`LinearError`] for a structure that cannot be sampled in this way.
    pub fn new(
        band: &PrefilterBand,
        structure: Structure,
        timing: &Timing,
        tolerance_db: f64,
    ) -> Result<PrefilterFit, LinearError> {
        let points: Vec<_> = band.points.iter().filter(|point| point.frequency_rad_per_s > 0.0).collect();
        let frequencies: Vec<f64> = points.iter().map(|point| point.frequency_rad_per_s).collect();
        let target = |width: f64, least: f64, greatest: f64, rate: f64| {
            if width > 2.0 * RESOLVED_DB {
                return Target { least, greatest, rate };
            }
            let rate = (width / 2.0 + tolerance_db).max(RESOLVED_DB);
            Target { least: least - tolerance_db, greatest: greatest + tolerance_db, rate }
        };
        let targets = points
            .iter()
            .map(|point| target(point.width_db(), point.least_db, point.greatest_db, point.rate()))
            .collect();
        let response = structure.response(&timing.of_prefilter(), &frequencies)?;
        Ok(PrefilterFit { bounds: structure.bounds(), structure, response, targets })
    }

    /// Structure that is fitted.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Least of the margins over their rates; minus infinity if the structure has no value.
    fn worst(&self, x: &[f64]) -> f64 {
        let Ok(values) = self.response.values(x) else { return f64::NEG_INFINITY };
        let margins = self.targets.iter().zip(&values).map(|(target, value)| {
            let [above, below] = target.margins(*value);
            above.min(below)
        });
        let worst = margins.fold(f64::INFINITY, |worst, margin| if margin >= worst { worst } else { margin });
        if worst.is_nan() { f64::NEG_INFINITY } else { worst }
    }
}

impl Target {
    fn margins(&self, value: Complex64) -> [f64; 2] {
        let magnitude = decibels(portable::magnitude(value));
        [(magnitude - self.least) / self.rate, (self.greatest - magnitude) / self.rate]
    }

    /// Both margins with their slopes; a margin to an edge at infinity is omitted.
    fn rows(&self, point: usize, value: Complex64, slopes: &[Complex64]) -> Vec<MarginRow> {
        let scale = DECIBELS_PER_NEPER / self.rate;
        let sides = self.margins(value).into_iter().zip([scale, -scale]).enumerate();
        let row = |(side, (margin_db, scale)): (usize, (f64, f64))| MarginRow {
            sample: 2 * point + side,
            margin_db,
            rate: 1.0,
            slopes: slopes.iter().map(|slope| scale * slope.re).collect(),
        };
        sides.map(row).filter(|row| row.margin_db < f64::INFINITY).collect()
    }
}

impl SearchProblem for PrefilterFit {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        Judgement { objective_db: 0.0, worst_margin_db: self.worst(x), stable: true, instability: 0.0 }
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let rows = match (self.response.values(x), self.response.slopes(x)) {
            (Ok(values), Ok(slopes)) => {
                let points = self.targets.iter().zip(values).zip(slopes).enumerate();
                points
                    .flat_map(|(point, ((target, value), slopes))| target.rows(point, value, &slopes))
                    .collect()
            }
            _ => Vec::new(),
        };
        Slopes { objective_db: 0.0, objective_slopes: vec![0.0; x.len()], margins: rows }
    }
}
