//! Commands of the scenarios' steps as rows of a search that is led by its steps.
//!
//! ```text
//! margin = 20 log10(limit/largest |u|)     of the step of each scenario, at the plants that the audits found worst
//! ```

use std::sync::Arc;

use phea_dynamics::frequency::decibels;
use phea_qft::closed_loop::Compensation;
use phea_qft::loop_shaping::MarginRow;
use phea_qft::verification::PlantPoint;

use super::plants::SteppedPlant;
use super::shaping::STEP;
use crate::design::ProjectDesign;
use crate::design::command_of_steps::ScenarioSteps;

/// Largest number of plants whose commands are rows.
const PLANTS: usize = 6;
/// Fraction of the limit above which the worst plant joins the search.
const NEAR: f64 = 0.8;
/// Number of points of a continuous response.
const POINTS: usize = 1000;

/// Steps of the scenarios, and plants whose commands are rows of a search.
#[derive(Clone, Default)]
pub(super) struct StepCommands {
    steps: Option<ScenarioSteps>,
    plants: Vec<Arc<SteppedPlant>>,
}

impl StepCommands {
    pub(super) fn new(steps: Option<ScenarioSteps>) -> StepCommands {
        StepCommands { steps, plants: vec![] }
    }

    /// Parameters of the worst plant of a design, if its command is near the limit and it is not
    /// among the rows.
    pub(super) fn unseen<'a>(&self, project_design: &'a ProjectDesign) -> Option<&'a [f64]> {
        let command = project_design.command_of_steps.as_ref()?;
        let PlantPoint::Parameters(values) = &command.plant else { return None };
        let is_known = self.plants.iter().any(|plant| plant.values == *values);
        let joins = !is_known && self.plants.len() < PLANTS && command.largest_v >= NEAR * command.limit_v;
        joins.then_some(values)
    }

    /// Multiplies the permitted command by a factor.
    pub(super) fn allow(&mut self, factor: f64) {
        if let Some(steps) = &mut self.steps {
            steps.limit_v *= factor;
        }
    }

    pub(super) fn take(&mut self, plant: Arc<SteppedPlant>) {
        self.plants.push(plant);
    }

    /// Margin of a plant, dB; negative infinity if its command cannot be computed.
    fn margin_db(&self, plant: &SteppedPlant, around: &Compensation) -> f64 {
        let Some(steps) = &self.steps else { return f64::INFINITY };
        let command = plant.command(around, (steps.duration_s, POINTS));
        command.map_or(f64::NEG_INFINITY, |command| decibels(steps.limit_v / steps.largest_v(&command)))
    }

    /// Least margin of all plants, dB.
    pub(super) fn least_db(&self, around: &Compensation) -> f64 {
        self.plants.iter().map(|plant| self.margin_db(plant, around)).fold(f64::INFINITY, f64::min)
    }

    /// Rows for all plants, numbered downwards from a sample.
    pub(super) fn rows(
        &self,
        around: &Compensation,
        beside: &[Option<Compensation>],
        last: usize,
    ) -> Vec<MarginRow> {
        let row = |(index, plant): (usize, &Arc<SteppedPlant>)| {
            let margin_db = self.margin_db(plant, around);
            let along = |moved: &Option<Compensation>| {
                moved.as_ref().map_or(0.0, |moved| (self.margin_db(plant, moved) - margin_db) / STEP)
            };
            let slopes = beside.iter().map(along).collect();
            MarginRow { sample: last - index, margin_db, rate: 1.0, slopes }
        };
        let is_finite =
            |row: &MarginRow| row.margin_db.is_finite() && row.slopes.iter().all(|slope| slope.is_finite());
        self.plants.iter().enumerate().map(row).filter(is_finite).collect()
    }
}
