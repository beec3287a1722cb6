//! The lines of a rig in motion, as they are declared.

use phea_hydraulics::fluid::Fluid;
use phea_hydraulics::line::{
    BraidedWall, DynamicLine, END_SHARE, Hose, LaminarFriction, Line, LineError, LineModel, Member,
};

use crate::project::{self, LineFriction, LineMotion, LineWall};

/// These lines as the project says that they move, filled with a fluid at a mean pressure in Pa; `None` where both are lumped, and
/// nothing of them moves.
///
/// # Errors
/// A line that its model does not fit.
pub(crate) fn lines(
    declared: &project::Lines,
    lines: [&Line; 2],
    fluid: &Fluid,
    pressure: f64,
) -> Result<Option<[DynamicLine; 2]>, LineError> {
    let [a, b] = [&declared.a.motion, &declared.b.motion];
    if [a.model, b.model] == [project::LineModel::Lumped; 2] {
        return Ok(None);
    }
    let of = |line: &Line, motion: &LineMotion| {
        DynamicLine::new(line, fluid, pressure, Member::Nominal, &line_model(motion, line))
    };
    let [line_a, line_b] = lines;
    Ok(Some([of(line_a, a)?, of(line_b, b)?]))
}

fn line_model(motion: &LineMotion, line: &Line) -> LineModel {
    let end_share = motion.end_share.unwrap_or(END_SHARE);
    match motion.model {
        project::LineModel::Lumped => LineModel::Lumped,
        // a validated project states the relaxation time of a wall that creeps
        project::LineModel::Creeping => {
            LineModel::Creeping { relaxation_time: motion.relaxation_time.unwrap_or(f64::NAN) }
        }
        project::LineModel::Segments => LineModel::Segments {
            count: motion.segments.unwrap_or(LineMotion::SEGMENTS) as usize,
            friction: match motion.friction {
                Some(LineFriction::Steady) => LaminarFriction::Steady,
                Some(LineFriction::FrequencyDependent) | None => LaminarFriction::FrequencyDependent,
            },
            relaxation_time: motion.relaxation_time,
        },
        project::LineModel::TransmissionLine => LineModel::TransmissionLine { end_share },
        project::LineModel::TwoWave => {
            let hose = if let Line::Hose { hose, .. } = line { Some(hose) } else { None };
            let wall = motion.wall.as_ref().zip(hose).map(|(wall, hose)| braided_wall(wall, hose));
            LineModel::TwoWave { end_share, wall }
        }
    }
}

/// What is not stated is assumed, but for what follows from the rest: a braid at its neutral angle, and the catalogue's expansion.
fn braided_wall(declared: &LineWall, hose: &Hose) -> BraidedWall {
    let assumed = BraidedWall::assumed(hose, Member::Nominal);
    let axial_compliance = declared.axial_compliance.unwrap_or(assumed.axial_compliance);
    let coupling_compliance = declared.coupling_compliance.unwrap_or(-axial_compliance);
    let mass_per_length = declared.mass_per_length.unwrap_or(assumed.mass_per_length);
    let member = Member::Nominal;
    let wall = BraidedWall::of_hose(hose, member, axial_compliance, coupling_compliance, mass_per_length);
    BraidedWall {
        pressure_compliance: declared.pressure_compliance.unwrap_or(wall.pressure_compliance),
        ..wall
    }
}
