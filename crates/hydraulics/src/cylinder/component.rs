//! Cylinder from its table, and motor in the equations of a cylinder.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredCylinder, DeclaredStage};
use super::motor_keys::DeclaredMotor;
use super::{Cylinder, annulus_area};
use crate::stroke::{ActuatorStroke, FURTHER_STAGES, PistonStage, Telescope};

impl<S: Scalar> DeclaredCylinder<S> {
    /// Cylinder with its declared areas, or with those that follow from its diameters.
    pub fn component(&self) -> Cylinder<S> {
        let [area_a, area_b] = self.effective_areas_m2();
        let [dead_volume_a, dead_volume_b] = on_both_sides(self.dead_volumes, self.dead_volume);
        Cylinder {
            area_a,
            area_b,
            stroke: self.stroke_with_stages([area_a, area_b]),
            moving_mass: self.moving_mass,
            dead_volume_a,
            dead_volume_b,
            internal_leakage: self.internal_leakage,
            end_stops: self.end_stops,
        }
    }

    /// Effective areas in chambers A and B, m2: declared, or those of the piston less the rod.
    pub fn effective_areas_m2(&self) -> [S; 2] {
        match (self.piston_areas, self.piston_area) {
            (None, None) => {
                let piston = self.piston_diameter.unwrap_or_default();
                self.rod_diameters_m().map(|rod| annulus_area(piston, rod))
            }
            (areas, area) => on_both_sides(areas, area),
        }
    }

    /// Diameters of the rods in chambers A and B, m.
    pub fn rod_diameters_m(&self) -> [S; 2] {
        on_both_sides(self.rod_diameters, self.rod_diameter)
    }

    /// Stroke with the stages of a telescopic piston, whose areas are those declared, also where
    /// those of the first stage are uncertain.
    fn stroke_with_stages(&self, [first_a, first_b]: [S; 2]) -> ActuatorStroke<S> {
        let stroke = self.stroke;
        if self.stages.is_empty() {
            return ActuatorStroke::Limited(stroke);
        }
        let mut stages = [None; FURTHER_STAGES];
        for (place, stage) in stages.iter_mut().zip(&self.stages) {
            let [area_a, area_b] = stage.areas_m2();
            *place = Some(PistonStage { from: stage.from, ratios: [area_a / first_a, area_b / first_b] });
        }
        ActuatorStroke::Telescopic(Telescope { stroke, stages, transition: self.stage_transition })
    }
}

impl<S: Scalar> DeclaredStage<S> {
    /// Effective areas in chambers A and B, m2.
    pub fn areas_m2(&self) -> [S; 2] {
        on_both_sides(self.piston_areas, self.piston_area)
    }
}

impl<S: Scalar> DeclaredMotor<S> {
    /// Motor in the equations of a cylinder: its displacement is the area of both chambers.
    pub fn component(&self) -> Cylinder<S> {
        let displacement = self.displacement;
        let [dead_volume_a, dead_volume_b] = on_both_sides(self.dead_volumes, self.dead_volume);
        Cylinder {
            area_a: displacement,
            area_b: displacement,
            stroke: self.stroke.map_or(ActuatorStroke::Unlimited, ActuatorStroke::Limited),
            moving_mass: self.inertia,
            dead_volume_a,
            dead_volume_b,
            internal_leakage: self.internal_leakage,
            end_stops: self.end_stops,
        }
    }
}

/// Numbers of both sides: a pair, or one number for both.
fn on_both_sides<S: Scalar>(pair: Option<[S; 2]>, single: Option<S>) -> [S; 2] {
    pair.unwrap_or([single.unwrap_or_default(); 2])
}
