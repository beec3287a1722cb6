//! The shaping of a loop by margins of steps beside those of its limits, as a problem of a search.

use phea_dynamics::linear::TransferFunction;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::design::{Design, LoopDesignError};
use phea_qft::family::Family;
use phea_qft::loop_shaping::{Judgement, MarginRow, SampledMargin, SearchProblem, Shaping, Slopes};
use phea_qft::verification::PlantPoint;

use super::{DesignError, ProjectDesign};
use crate::audit::TimeOutcome;
use crate::linear_step::{KnownResponses, StepResponse, linear_step_knowing};
use crate::robust::RobustProblem;
use crate::simulate::TrackingWish;

/// Margin to be left to every limit on a frequency response, dB.
pub(super) const RESERVE_DB: f64 = 0.02;
/// Most plants whose steps are rows of the search.
const PLANTS: usize = 12;
/// Only margins of steps within this much of the worst one have their slopes computed, dB.
const NEAR_DB: f64 = 0.1;
/// Duration of a step, in settling times that are required, and the points of a continuous one.
const SETTLING_TIMES: f64 = 3.0;
const POINTS: usize = 600;
/// dB of 1 + d for a small deviation d.
const DB: f64 = 20.0 / std::f64::consts::LN_10;
/// Change of a free number for a slope.
const STEP: f64 = 1e-4;
/// Most swings of a step that are rows of the search.
const SWINGS: usize = 4;

/// The shaping of a loop with margins of steps beside those of its limits.
pub(super) struct StepShaping {
    /// The limits and their samples.
    pub(super) shaping: Shaping,
    /// The requirement that every step is to keep.
    wish: TrackingWish,
    sensor: TransferFunction,
    plants: Vec<SteppedPlant>,
}

/// A plant whose steps are rows of the search.
struct SteppedPlant {
    values: Vec<f64>,
    member: Member,
    known: KnownResponses,
}

impl StepShaping {
    /// Without plants whose steps are looked at.
    pub(super) fn new(shaping: Shaping, wish: TrackingWish, sensor: TransferFunction) -> StepShaping {
        StepShaping { shaping, wish, sensor, plants: vec![] }
    }

    /// The loop at x.
    fn around(&self, x: &[f64]) -> Option<Compensation> {
        Compensation::new(&self.shaping.controller(x), self.sensor.clone()).ok()
    }

    /// The step of a plant; `None` where it cannot be computed.
    fn step(&self, plant: &SteppedPlant, around: &Compensation) -> Option<StepResponse> {
        let duration = (SETTLING_TIMES * self.wish.horizon_s, POINTS);
        linear_step_knowing(&plant.member, around, duration, &plant.known).ok()
    }

    /// The margin of a step to what is required of it there, dB of 1 plus the deviation.
    fn margin(&self, step: &StepResponse, place: StepPlace) -> f64 {
        let band = self.wish.band_percent / 100.0;
        let value = |sample: usize| step.values.get(sample).copied().unwrap_or(f64::INFINITY);
        match place {
            StepPlace::Over(sample) => {
                let most = self.wish.overshoot_percent.unwrap_or(f64::INFINITY);
                DB * (1.0 + most / 100.0 - value(sample))
            }
            StepPlace::Late(sample) => DB * (band - (value(sample) - 1.0).abs()),
            StepPlace::Rise => {
                let reached = |level: f64| {
                    step.times_s.get(step.values.iter().position(|value| *value >= level)?).copied()
                };
                let rise_s = reached(0.1).zip(reached(0.9)).map_or(f64::INFINITY, |(low, high)| high - low);
                DB * band * (1.0 - rise_s / self.wish.rise_time_s.unwrap_or(f64::INFINITY))
            }
        }
    }

    /// The places at which a step is nearest to what is required, one of each swing, with the
    /// margins there.
    fn places(&self, step: &StepResponse) -> Vec<(StepPlace, f64)> {
        let last = step.values.len().saturating_sub(1);
        let from =
            self.wish.settling_time_s.map(|time_s| step.times_s.partition_point(|known| *known < time_s));
        let deviation = |sample: usize| step.values.get(sample).map_or(0.0, |value| (value - 1.0).abs());
        let is_peak = |sample: usize| {
            let beside = [sample.saturating_sub(1), (sample + 1).min(last)];
            beside.into_iter().all(|other| deviation(sample) >= deviation(other))
        };
        let over = (0..=last).filter(|sample| {
            self.wish.overshoot_percent.is_some() && is_peak(*sample) && step.values.get(*sample) > Some(&1.0)
        });
        let late = from.map_or(last + 1..=last, |from| from..=last);
        let late = late.filter(|sample| Some(*sample) == from || is_peak(*sample));
        let rise = self.wish.rise_time_s.map(|_| StepPlace::Rise);
        let each = over.map(StepPlace::Over).chain(late.map(StepPlace::Late)).chain(rise);
        let mut places: Vec<(StepPlace, f64)> = each.map(|place| (place, self.margin(step, place))).collect();
        places.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        places.truncate(SWINGS);
        places
    }

    /// The least margin of each plant's step; negative infinity where it cannot be computed.
    fn least_margin(&self, x: &[f64]) -> f64 {
        let Some(around) = self.around(x) else { return f64::NEG_INFINITY };
        let least = |plant: &SteppedPlant| {
            let step = self.step(plant, &around);
            let places = step.map(|step| self.places(&step));
            places
                .map_or(f64::NEG_INFINITY, |places| places.first().map_or(f64::INFINITY, |(_, least)| *least))
        };
        self.plants.iter().map(least).fold(f64::INFINITY, f64::min)
    }

    /// The margins at these places of a plant's step with their slopes, from the loops beside x.
    fn rows(
        &self,
        index: usize,
        plant: &SteppedPlant,
        places: &[(StepPlace, f64)],
        beside: &[Option<Compensation>],
    ) -> Vec<MarginRow> {
        if places.is_empty() {
            return vec![];
        }
        let moved: Vec<Option<StepResponse>> =
            beside.iter().map(|around| self.step(plant, around.as_ref()?)).collect();
        let row = |(rank, (place, margin_db)): (usize, &(StepPlace, f64))| {
            let along = |step: &Option<StepResponse>| {
                step.as_ref().map_or(0.0, |step| (self.margin(step, *place) - margin_db) / STEP)
            };
            MarginRow {
                sample: usize::MAX - SWINGS * index - rank,
                margin_db: *margin_db,
                rate: 1.0,
                slopes: moved.iter().map(along).collect(),
            }
        };
        let is_finite =
            |row: &MarginRow| row.margin_db.is_finite() && row.slopes.iter().all(|slope| slope.is_finite());
        places.iter().enumerate().map(row).filter(is_finite).collect()
    }

    /// The least margin to a limit of the samples.
    pub(super) fn least_of_limits(&self, x: &[f64]) -> Option<SampledMargin> {
        let margins = self.shaping.margins(x).into_iter();
        margins.min_by(|one, other| one.margin_db.total_cmp(&other.margin_db))
    }

    /// Adds the plants and frequencies at which an audit finds the least margins; true where one is
    /// new.
    pub(super) fn take_worst(&mut self, design: &Design) -> Result<bool, DesignError> {
        let mut is_new = false;
        for finding in &design.audit.specifications {
            let bands = finding.violations.iter().map(|band| &band.worst);
            for case in finding.worst.iter().chain(&finding.interior).chain(bands) {
                let frequency = case.frequency_rad_per_s;
                if case.margin_db < RESERVE_DB && frequency > 0.0 && frequency.is_finite() {
                    let plants: Vec<PlantPoint> =
                        std::iter::once(&case.plant).chain(&case.other).cloned().collect();
                    is_new |= self.shaping.add(&plants, frequency).map_err(LoopDesignError::from)?;
                }
            }
        }
        Ok(is_new)
    }

    /// Adds the plants with the worst steps of a design; true where one is new.
    pub(super) fn take_steps(&mut self, told: &ProjectDesign) -> Result<bool, DesignError> {
        let mut is_new = false;
        for finding in &told.designed.view.in_time {
            let TimeOutcome::Searched { overshoot, settling, rise, .. } = &finding.outcome else { continue };
            for worst in [overshoot, settling, rise].into_iter().flatten() {
                if let PlantPoint::Parameters(values) = &worst.plant {
                    is_new |= self.take(values, &told.designed.problem)?;
                }
            }
        }
        Ok(is_new)
    }

    fn take(&mut self, values: &[f64], problem: &RobustProblem) -> Result<bool, DesignError> {
        let Family::Uncertain(family) = &problem.family else { return Ok(false) };
        if self.plants.iter().any(|known| known.values == values) || self.plants.len() >= PLANTS {
            return Ok(false);
        }
        let member = problem.compensation.member_of(family.plant(), values)?;
        self.plants.push(SteppedPlant { values: values.to_vec(), member, known: KnownResponses::default() });
        Ok(true)
    }
}

impl SearchProblem for StepShaping {
    fn bounds(&self) -> &[[f64; 2]] {
        self.shaping.bounds()
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let judgement = self.shaping.judge(x);
        if !judgement.stable {
            return judgement;
        }
        let steps = self.least_margin(x);
        Judgement { worst_margin_db: judgement.worst_margin_db.min(steps), ..judgement }
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let mut slopes = self.shaping.slopes(x);
        let Some(around) = self.around(x) else { return slopes };
        let steps: Vec<Option<StepResponse>> =
            self.plants.iter().map(|plant| self.step(plant, &around)).collect();
        let places: Vec<Vec<(StepPlace, f64)>> =
            steps.iter().map(|step| step.as_ref().map_or(vec![], |step| self.places(step))).collect();
        let worst = places.iter().flatten().map(|(_, margin)| *margin).fold(f64::INFINITY, f64::min);
        let near = worst.max(0.0) + NEAR_DB;
        let beside: Vec<Option<Compensation>> = (0..x.len())
            .map(|place| {
                let moved: Vec<f64> = x
                    .iter()
                    .enumerate()
                    .map(|(own, value)| value + if own == place { STEP } else { 0.0 })
                    .collect();
                self.around(&moved)
            })
            .collect();
        for (index, (plant, places)) in self.plants.iter().zip(&places).enumerate() {
            let near: Vec<(StepPlace, f64)> =
                places.iter().copied().filter(|(_, margin)| *margin <= near).collect();
            slopes.margins.extend(self.rows(index, plant, &near, &beside));
        }
        slopes
    }
}

/// A place at which a step is held against what is required of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum StepPlace {
    /// A sample beyond the reference.
    Over(usize),
    /// A sample after the settling time.
    Late(usize),
    /// The rise as a whole.
    Rise,
}
