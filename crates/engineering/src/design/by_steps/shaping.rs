//! Shaping of a loop by margins of steps in addition to those of its limits, as a problem of a
//! search.

use std::sync::Arc;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::time_response::{StepBaseline, step_metrics};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{Design, LoopDesignError};
use phea_qft::family::Family;
use phea_qft::loop_shaping::{Judgement, MarginRow, SearchProblem, Shaping, Slopes};
use phea_qft::verification::{PlantPoint, SpecificationMargin};

use super::commands::StepCommands;
use super::plants::{SteppedPlant, SteppedPlants};
use crate::audit::TimeOutcome;
use crate::design::added_by_rig::{AddedByRig, added_to};
use crate::design::command_of_steps::ScenarioSteps;
use crate::design::{DesignError, ProjectDesign};
use crate::linear_step::StepResponse;
use crate::robust::RobustProblem;
use crate::side_by_side::of_each;
use crate::simulate::{ReachedStep, StepLimits};

/// Margin to be left to every limit on a frequency response, dB.
pub(super) const RESERVE_DB: f64 = 0.02;
/// Largest number of plants whose steps are rows of the search.
const PLANTS: usize = 24;
/// Largest number of them that join it at once.
const TAKEN: usize = 3;
/// Distance from the worst margin of a step within which slopes are computed, dB.
const NEAR_DB: f64 = 0.1;
/// Duration of a step in required settling times, and number of points of a continuous step.
const SETTLING_TIMES: f64 = 3.0;
const POINTS: usize = 600;
/// Factor from a small deviation d to 1 + d in dB.
const DB: f64 = 20.0 / std::f64::consts::LN_10;
/// Change of a free number for a slope.
pub(super) const STEP: f64 = 1e-4;
/// Range of a search around a design: natural logarithm of a ratio of zeros, poles and gains.
const BESIDE: f64 = 0.3;
/// Largest number of swings of a step that are rows of the search, and largest number of rows of a
/// plant.
const SWINGS: usize = 4;
const ROWS: usize = 64;

/// Shaping of a loop with margins of steps in addition to those of its limits.
#[derive(Clone)]
pub(in crate::design) struct StepShaping<'a> {
    /// Limits and their samples.
    pub(in crate::design) shaping: Shaping,
    /// Requirements of every step: that of the linear loop, and that including the contribution of
    /// the rig.
    aimed_limits: AimedStepLimits,
    added: Vec<AddedByRig>,
    sensor: TransferFunction,
    plants: Vec<LedPlant>,
    /// Commands of the scenarios' steps.
    commands: StepCommands,
    /// Plants that are common to all searches of a design.
    all: &'a SteppedPlants,
    /// Least and greatest value of each free number.
    bounds: Vec<[f64; 2]>,
}

/// Requirements of steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct AimedStepLimits {
    /// Requirements of the steps of the linear loop.
    pub(super) linear: StepLimits,
    /// Requirements of the steps including the contribution of the nonlinear rig.
    pub(super) with_rig: StepLimits,
}

/// A step that is judged, and its requirements.
struct JudgedStep {
    response: StepResponse,
    step_limits: StepLimits,
}

/// Margin of a step at one of its places, with the index of the step, dB.
type PlacedMargin = (usize, StepPlace, f64);

/// A plant whose steps are rows of the search.
#[derive(Clone)]
struct LedPlant {
    plant: Arc<SteppedPlant>,
    /// Contribution of the rig to its steps.
    added: Option<AddedByRig>,
}

impl StepShaping<'_> {
    /// Shaping without plants whose steps are judged.
    pub(super) fn new(
        shaping: Shaping,
        (aimed_limits, added): (AimedStepLimits, Vec<AddedByRig>),
        sensor: TransferFunction,
        all: &SteppedPlants,
    ) -> StepShaping<'_> {
        let bounds = shaping.bounds().to_vec();
        let commands = StepCommands::default();
        StepShaping { shaping, aimed_limits, added, sensor, plants: vec![], commands, all, bounds }
    }

    /// The shaping with limits on the command of the scenarios' steps.
    pub(super) fn with_commands(self, steps: Option<ScenarioSteps>) -> Self {
        StepShaping { commands: StepCommands::new(steps), ..self }
    }

    /// Multiplies the allowed command by a factor.
    pub(super) fn allow_commands(&mut self, factor: f64) {
        self.commands.allow(factor);
    }

    /// The shaping with other requirements of its steps.
    pub(super) fn with_step_limits(mut self, changed: impl Fn(StepLimits) -> StepLimits) -> Self {
        let AimedStepLimits { linear, with_rig } = self.aimed_limits;
        self.aimed_limits = AimedStepLimits { linear: changed(linear), with_rig: changed(with_rig) };
        self.bounds = self.shaping.bounds().to_vec();
        self
    }

    /// Limits the free numbers to the neighbourhood of these.
    pub(super) fn stay_near(&mut self, free_numbers: &[f64]) {
        for ([low, high], own) in self.bounds.iter_mut().zip(free_numbers) {
            (*low, *high) = (low.max(own - BESIDE), high.min(own + BESIDE));
        }
    }

    /// The loop at x.
    fn around(&self, x: &[f64]) -> Option<Compensation> {
        Compensation::new(&self.shaping.controller(x), self.sensor.clone()).ok()
    }

    /// Least margin of the steps of all plants; negative infinity if they cannot be computed.
    fn least_margin(&self, x: &[f64]) -> f64 {
        let Some(around) = self.around(x) else { return f64::NEG_INFINITY };
        let of_commands = self.commands.least_db(&around);
        let aimed_limits = self.aimed_limits;
        let each = of_each(&self.plants, |plant| aimed_limits.least_of(plant, &around));
        each.into_iter().fold(of_commands, f64::min)
    }

    /// Largest ratio of a property of the steps, including the contribution of the rig, to the
    /// required one: at most 1 if all are within it; zero if nothing is known of the rig.
    pub(super) fn excess_with_rig(&self, x: &[f64], required: &StepLimits) -> f64 {
        let Some(around) = self.around(x) else { return f64::INFINITY };
        let of = |step: &JudgedStep| {
            let StepResponse { times_s, values } = &step.response;
            let metrics = step_metrics(times_s, values, StepBaseline::unit(), required.band_percent).ok()?;
            Some(required.excess(&ReachedStep {
                overshoot_percent: metrics.overshoot_percent,
                settling_time_s: metrics.settling.time_s().unwrap_or(f64::INFINITY),
                rise_time_s: metrics.rise_time_10_90_s.unwrap_or(f64::INFINITY),
            }))
        };
        let worst = |plant: &LedPlant| match self.aimed_limits.steps(plant, &around) {
            Some(steps) => {
                steps.iter().skip(1).map(|step| of(step).unwrap_or(f64::INFINITY)).fold(0.0, f64::max)
            }
            None => f64::INFINITY,
        };
        self.plants.iter().map(worst).fold(0.0, f64::max)
    }

    /// Least margin of the samples to a limit.
    pub(super) fn least_of_limits(&self, x: &[f64]) -> Option<SpecificationMargin> {
        let margins = self.shaping.margins(x).into_iter();
        margins.min_by(|one, other| one.margin_db.total_cmp(&other.margin_db))
    }

    /// Adds the plants and frequencies at which an audit finds the least margins; true if one is
    /// new.
    pub(super) fn take_worst(&mut self, design: &Design) -> Result<bool, DesignError> {
        let mut is_new = false;
        for finding in &design.audit.specifications {
            for case in finding.worst_margins() {
                let frequency = case.frequency_rad_per_s;
                if case.margin_db < RESERVE_DB && frequency > 0.0 && frequency.is_finite() {
                    let plants: Vec<PlantPoint> = case.plants().cloned().collect();
                    is_new |= self.shaping.add(&plants, frequency).map_err(LoopDesignError::from)?;
                }
            }
        }
        Ok(is_new)
    }

    /// Adds the plants with the worst steps of a design; true if one is new.
    pub(super) fn take_steps(&mut self, project_design: &ProjectDesign) -> Result<bool, DesignError> {
        let mut is_new = false;
        for finding in &project_design.designed.view.in_time {
            let TimeOutcome::Searched { overshoot, settling, rise, .. } = &finding.outcome else { continue };
            for worst in [overshoot, settling, rise].into_iter().flatten() {
                if let PlantPoint::Parameters(values) = &worst.plant {
                    is_new |= self.take(values, &project_design.designed.problem)?;
                }
            }
        }
        if let (Some(values), Family::Uncertain(family)) =
            (self.commands.unseen(project_design), &project_design.designed.problem.family)
        {
            let around = &project_design.designed.problem.compensation;
            self.commands.take(self.all.plant(values, (family, around))?);
            is_new = true;
        }
        Ok(is_new)
    }

    /// Adds the worst of these plants whose steps leave less than the reserve; true if there is
    /// one.
    pub(super) fn take_unseen(
        &mut self,
        x: &[f64],
        (problem, plants): (&RobustProblem, &[Vec<f64>]),
    ) -> Result<bool, DesignError> {
        let Some(around) = self.around(x) else { return Ok(false) };
        let mut missed: Vec<(f64, LedPlant)> = Vec::new();
        for values in plants {
            let Some(plant) = self.unseen(values, problem)? else { continue };
            let least_db = self.aimed_limits.least_of(&plant, &around);
            if least_db < RESERVE_DB - 1e-3 {
                missed.push((least_db, plant));
            }
        }
        missed.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let room = PLANTS.saturating_sub(self.plants.len()).min(TAKEN);
        let is_new = !missed.is_empty() && room > 0;
        self.plants.extend(missed.into_iter().take(room).map(|(_, plant)| plant));
        Ok(is_new)
    }

    fn take(&mut self, values: &[f64], problem: &RobustProblem) -> Result<bool, DesignError> {
        if self.plants.len() >= PLANTS {
            return Ok(false);
        }
        let plant = self.unseen(values, problem)?;
        let is_new = plant.is_some();
        self.plants.extend(plant);
        Ok(is_new)
    }

    /// Plant with these parameters, unless the search already contains it.
    fn unseen(&self, values: &[f64], problem: &RobustProblem) -> Result<Option<LedPlant>, DesignError> {
        let Family::Uncertain(family) = &problem.family else { return Ok(None) };
        if self.plants.iter().any(|known| known.plant.values == values) {
            return Ok(None);
        }
        let plant = self.all.plant(values, (family, &problem.compensation))?;
        Ok(Some(LedPlant { plant, added: added_to(family, &self.added, values).cloned() }))
    }
}

impl AimedStepLimits {
    /// Steps of a plant, that of the linear loop first; `None` if one cannot be computed.
    fn steps(&self, plant: &LedPlant, around: &Compensation) -> Option<Vec<JudgedStep>> {
        let duration = (SETTLING_TIMES * self.linear.horizon_s, POINTS);
        let linear = plant.plant.step(around, duration)?;
        let mut steps: Vec<JudgedStep> = Vec::new();
        if let (Some(added), [first, second, ..]) = (&plant.added, linear.times_s.as_slice()) {
            let samples = (second - first, linear.times_s.len());
            let carried = plant.plant.carried([&added.around, around], samples);
            let with_rig = |added: &StepResponse| {
                let added = carried.of(&added.at_times(&linear.times_s));
                let values = linear.values.iter().zip(added).map(|(value, added)| value + added);
                let response = StepResponse { times_s: linear.times_s.clone(), values: values.collect() };
                JudgedStep { response, step_limits: self.with_rig }
            };
            steps.extend(added.steps.iter().map(with_rig));
        }
        steps.insert(0, JudgedStep { response: linear, step_limits: self.linear });
        Some(steps)
    }

    /// Least margin of a plant's steps; negative infinity if they cannot be computed.
    fn least_of(&self, plant: &LedPlant, around: &Compensation) -> f64 {
        let least = |steps: Vec<JudgedStep>| {
            places(&steps).iter().map(|(_, _, margin_db)| *margin_db).fold(f64::INFINITY, f64::min)
        };
        self.steps(plant, around).map_or(f64::NEG_INFINITY, least)
    }

    /// Margins at these places of a plant's steps with their slopes, from the loops next to x.
    fn rows(
        &self,
        index: usize,
        plant: &LedPlant,
        places: &[PlacedMargin],
        beside: &[Option<Compensation>],
    ) -> Vec<MarginRow> {
        if places.is_empty() {
            return vec![];
        }
        let moved: Vec<Option<Vec<JudgedStep>>> =
            beside.iter().map(|around| self.steps(plant, around.as_ref()?)).collect();
        let row = |(rank, (step, place, margin_db)): (usize, &PlacedMargin)| {
            let along = |steps: &Option<Vec<JudgedStep>>| {
                let moved = steps.as_ref().and_then(|steps| steps.get(*step));
                moved.map_or(0.0, |moved| (moved.margin(*place) - margin_db) / STEP)
            };
            MarginRow {
                sample: usize::MAX - ROWS * index - rank,
                margin_db: *margin_db,
                rate: 1.0,
                slopes: moved.iter().map(along).collect(),
            }
        };
        let is_finite =
            |row: &MarginRow| row.margin_db.is_finite() && row.slopes.iter().all(|slope| slope.is_finite());
        places.iter().enumerate().map(row).filter(is_finite).collect()
    }
}

impl SearchProblem for StepShaping<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
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
        let aimed_limits = self.aimed_limits;
        let of = |plant: &LedPlant| aimed_limits.steps(plant, &around).map(|steps| places(&steps));
        let each = of_each(&self.plants, |plant| of(plant).unwrap_or_default());
        let worst = each.iter().flatten().map(|one| one.2).fold(f64::INFINITY, f64::min);
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
        let placed: Vec<(usize, &LedPlant, Vec<PlacedMargin>)> = (self.plants.iter().zip(each).enumerate())
            .map(|(index, (plant, places))| {
                (index, plant, places.into_iter().filter(|one| one.2 <= near).collect())
            })
            .collect();
        let rows = of_each(&placed, |(index, plant, near)| aimed_limits.rows(*index, plant, near, &beside));
        slopes.margins.extend(rows.into_iter().flatten());
        let last = usize::MAX - ROWS * PLANTS;
        slopes.margins.extend(self.commands.rows(&around, &beside, last));
        slopes
    }
}

/// Place at which a step is compared with its requirement.
#[derive(Clone, Copy, Debug, PartialEq)]
enum StepPlace {
    /// Sample above the reference.
    Over(usize),
    /// Sample after the settling time.
    Late(usize),
    /// Rise as a whole.
    Rise,
}

impl JudgedStep {
    /// Margin to the requirement at this place, dB of 1 plus the deviation.
    fn margin(&self, place: StepPlace) -> f64 {
        let JudgedStep { response, step_limits } = self;
        let band = step_limits.band_percent / 100.0;
        let value = |sample: usize| response.values.get(sample).copied().unwrap_or(f64::INFINITY);
        match place {
            StepPlace::Over(sample) => {
                let most = step_limits.overshoot_percent.unwrap_or(f64::INFINITY);
                DB * (1.0 + most / 100.0 - value(sample))
            }
            StepPlace::Late(sample) => DB * (band - (value(sample) - 1.0).abs()),
            StepPlace::Rise => {
                let reached = |level: f64| response.first_at(level);
                let rise_s = reached(0.1).zip(reached(0.9)).map_or(f64::INFINITY, |(low, high)| high - low);
                DB * band * (1.0 - rise_s / step_limits.rise_time_s.unwrap_or(f64::INFINITY))
            }
        }
    }

    /// Places at which the step is nearest to its requirements, one for each swing, with the
    /// margins there.
    fn places(&self) -> Vec<(StepPlace, f64)> {
        let JudgedStep { response: StepResponse { times_s, values }, step_limits } = self;
        let last = values.len().saturating_sub(1);
        let from = step_limits.settling_time_s.map(|time_s| times_s.partition_point(|known| *known < time_s));
        let deviation = |sample: usize| values.get(sample).map_or(0.0, |value| (value - 1.0).abs());
        let is_peak = |sample: usize| {
            let beside = [sample.saturating_sub(1), (sample + 1).min(last)];
            beside.into_iter().all(|other| deviation(sample) >= deviation(other))
        };
        let over = (0..=last).filter(|sample| {
            step_limits.overshoot_percent.is_some() && is_peak(*sample) && values.get(*sample) > Some(&1.0)
        });
        let late = from.map_or(last + 1..=last, |from| from..=last);
        let late = late.filter(|sample| Some(*sample) == from || is_peak(*sample));
        let rise = step_limits.rise_time_s.map(|_| StepPlace::Rise);
        let each = over.map(StepPlace::Over).chain(late.map(StepPlace::Late)).chain(rise);
        let mut places: Vec<(StepPlace, f64)> = each.map(|place| (place, self.margin(place))).collect();
        places.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        places.truncate(SWINGS);
        places
    }
}

/// Places of the steps of a plant, with their margins.
fn places(steps: &[JudgedStep]) -> Vec<PlacedMargin> {
    let of = |(index, step): (usize, &JudgedStep)| {
        step.places().into_iter().map(move |(place, margin_db)| (index, place, margin_db)).collect::<Vec<_>>()
    };
    steps.iter().enumerate().flat_map(of).take(ROWS).collect()
}
