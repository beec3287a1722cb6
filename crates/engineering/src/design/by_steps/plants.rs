//! Plants whose steps lead a design, each with the known part of its response.

use std::cell::RefCell;
use std::sync::Arc;

use phea_dynamics::linear::LinearError;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::UncertainFamily;

use crate::linear_step::{CarriedDisturbance, KnownResponses, StepResponse, StepSignal, linear_step_knowing};

/// A plant with the known part of its response in loops of one timing and sensor.
pub(in crate::design) struct SteppedPlant {
    pub(super) values: Vec<f64>,
    member: Member,
    known: KnownResponses,
}

/// Plants common to all searches of a design: the response of one with waves costs far more than
/// its step in one more loop.
#[derive(Default)]
pub(in crate::design) struct SteppedPlants {
    plants: RefCell<Vec<Arc<SteppedPlant>>>,
}

impl SteppedPlant {
    /// Step of the plant over a time, s, with about this number of points; `None` if it cannot be
    /// computed.
    pub(super) fn step(&self, around: &Compensation, duration_s: f64, points: usize) -> Option<StepResponse> {
        linear_step_knowing(&self.member, StepSignal::Output, around, duration_s, points, &self.known).ok()
    }

    /// Command in such a step; `None` if it cannot be computed.
    pub(in crate::design) fn command(
        &self,
        around: &Compensation,
        duration_s: f64,
        points: usize,
    ) -> Option<StepResponse> {
        linear_step_knowing(&self.member, StepSignal::Command, around, duration_s, points, &self.known).ok()
    }

    /// Transfer of a disturbance from the loop of one controller to that of another, in this number
    /// of samples at this distance.
    pub(super) fn carried(&self, loops: [&Compensation; 2], step_s: f64, count: usize) -> CarriedDisturbance {
        CarriedDisturbance::new(&self.member, loops, step_s, count, &self.known)
    }
}

impl SteppedPlants {
    /// Plant of a family with these parameters, in a loop with the common timing and sensor of all
    /// loops of the design.
    pub(in crate::design) fn plant(
        &self,
        values: &[f64],
        family: &UncertainFamily,
        around: &Compensation,
    ) -> Result<Arc<SteppedPlant>, LinearError> {
        let mut plants = self.plants.borrow_mut();
        if let Some(known) = plants.iter().find(|known| known.values == values) {
            return Ok(known.clone());
        }
        let member = around.member_of(family.plant(), values)?;
        let plant = SteppedPlant { values: values.to_vec(), member, known: KnownResponses::default() };
        let plant = Arc::new(plant);
        plants.push(plant.clone());
        Ok(plant)
    }
}
