//! The lines of a rig in motion, as they are declared.

use std::f64::consts::FRAC_PI_2;

use phea_hydraulics::actuator::Components;
use phea_hydraulics::line::{Conduit, Line, LineError, StiffeningMember};
use phea_hydraulics::plant::{LineChambers, LinearPlant, PlantInMotion};
use phea_hydraulics::servovalve::ChamberCoefficients;
use phea_hydraulics::stiffness::compliance_at;

use super::Rig;
use super::at_point::RigAtPoint;
use super::plant::without_branches;

impl RigAtPoint {
    /// Plant with lines in motion in place of the lumped ones; `None` if both are lumped.
    ///
    /// # Errors
    /// A line that its model cannot describe.
    pub(crate) fn in_motion(&self, plant: &LinearPlant) -> Result<Option<PlantInMotion>, LineError> {
        let RigAtPoint { components, point, chambers, .. } = self;
        let [line_a, line_b] = [components.line_a, components.line_b].map(Line::stiffened_alike);
        let moving = Components { line_a, line_b, ..*components };
        let moving = moving.lines_in_motion(StiffeningMember::Nominal)?;
        let [line_a, line_b] = [line_a, line_b].map(Line::without_volume);
        let bare = Components { line_a, line_b, ..*components };
        let bare = bare.chamber_compliance([point.pressure_a, point.pressure_b], StiffeningMember::Nominal);
        let pressures = [point.pressure_a, point.pressure_b];
        let own = |compliances| match plant.gas {
            [None, None] => compliances,
            _ => without_branches(components, pressures, compliances),
        };
        let chambers_only = own(compliance_at(&bare, point.position));
        let outward = self.model.outward_slopes(pressures).unwrap_or([0.0; 2]);
        // in the limit of an ideal valve both coefficients would vanish
        let ChamberCoefficients { flow_pressure_a, flow_pressure_b, .. } = self.leaking;
        let leaking = [outward[0] / flow_pressure_a, outward[1] / flow_pressure_b];
        Ok(moving.map(|lines| {
            let lumped = own(chambers.compliances);
            let behind = LineChambers { lines, chambers: chambers_only, lumped, leaking };
            PlantInMotion::new(plant, &behind)
        }))
    }
}

/// Where the slower line of a rig is a quarter of a wave long, rad/s; `None` without lines.
pub(crate) fn quarter_wave(rig: &Rig) -> Option<f64> {
    let components = rig.actuator.components();
    quarter_wave_of(rig, [&components.line_a, &components.line_b].into_iter())
}

/// pi/(2 T), T the longest time that a wave takes through one of these lines.
pub(crate) fn quarter_wave_of<'a>(rig: &'a Rig, lines: impl Iterator<Item = &'a Line>) -> Option<f64> {
    let fluid = &rig.actuator.components().fluid;
    let delay = |line| Conduit::of_line(line, fluid, rig.actuator.mean_pressure(), StiffeningMember::Nominal);
    let delays = lines.filter_map(|line| delay(line).ok());
    let longest = delays.map(|conduit| conduit.delay()).fold(0.0, f64::max);
    (longest > 0.0).then(|| FRAC_PI_2 / longest)
}
