use super::{
    BraidedWall, Conduit, DynamicLine, Hose, LaminarFriction, Line, LineError, LineWall, Segments,
    StandardLinearSolid, StiffeningMember, TransmissionLine, TwoWaveHose,
};
use crate::fluid::Fluid;

/// Dynamic model of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LineModel {
    /// Elastic capacity at the chamber. Fits every line, including a plain volume and no line.
    #[default]
    Lumped,
    /// Capacity at the chamber with a creeping wall. Hoses only.
    Creeping {
        /// Relaxation time tau, s.
        relaxation_time: f64,
    },
    /// Pi segments, at least one.
    Segments {
        /// Number of segments.
        count: usize,
        /// Model of laminar friction.
        friction: LaminarFriction,
        /// Relaxation time of a creeping wall, s; hoses only.
        relaxation_time: Option<f64>,
    },
    /// Wave model with one wave in each direction.
    TransmissionLine {
        /// Fraction of the compliance at each end, normally [`super::END_SHARE`].
        end_share: f64,
    },
    /// Wave model with two waves in each direction. Hoses only.
    TwoWave {
        /// Fraction of the compliance at each end, normally [`super::END_SHARE`].
        end_share: f64,
        /// Wall.
        wall: LineWall,
    },
}

impl DynamicLine {
    /// Dynamic line filled with a fluid at a mean gauge pressure in Pa.
    ///
    /// # Errors
    /// Impossible parameters, and a line that the model does not fit: see [`LineError`].
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::reference_rig::{components, hose_line, pipe_line};
    /// # use phea_hydraulics::stiffness::StiffnessModel;
    /// use phea_hydraulics::line::{DynamicLine, END_SHARE, LineError, LineModel, StiffeningMember};
    /// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
    /// let of = |line, model| DynamicLine::new(&line, &fluid, 35e5, StiffeningMember::Nominal, &model);
    /// let lumped = of(hose_line(), LineModel::Lumped)?;
    /// assert_eq!(lumped.chamber_compliance(), hose_line().compliance(1.45e9, StiffeningMember::Nominal));
    /// let creeping = LineModel::Creeping { relaxation_time: 0.1 };
    /// assert_eq!(of(hose_line(), creeping)?.states(), 1);
    /// assert_eq!(of(pipe_line(), creeping), Err(LineError::NotAHose));
    /// assert_eq!(of(pipe_line(), LineModel::TransmissionLine { end_share: END_SHARE })?.delays().len(), 2);
    /// # Ok::<(), LineError>(())
    /// ```
    pub fn new(
        line: &Line,
        fluid: &Fluid,
        pressure: f64,
        member: StiffeningMember,
        model: &LineModel,
    ) -> Result<DynamicLine, LineError> {
        let conduit = || Conduit::of_line(line, fluid, pressure, member);
        match *model {
            LineModel::Lumped => {
                let mut problems = line.problems();
                problems.extend(fluid.problems().into_iter().map(|problem| problem.within("fluid")));
                if !problems.is_empty() {
                    return Err(LineError::Impossible { problems });
                }
                let compliance = line.compliance(fluid.modulus_at(pressure), member);
                Ok(DynamicLine::Segments(Segments::lumped(compliance)))
            }
            LineModel::Creeping { relaxation_time } => {
                let wall = StandardLinearSolid::of_hose(hose_of(line)?, member, relaxation_time);
                let capacity = Segments::new(&conduit()?, 0, LaminarFriction::Steady)?;
                Ok(DynamicLine::Segments(capacity.with_creep(&conduit()?, &wall)?))
            }
            LineModel::Segments { count: 0, .. } => Err(LineError::NoSegments),
            LineModel::Segments { count, friction, relaxation_time } => {
                let conduit = conduit()?;
                let segments = Segments::new(&conduit, count, friction)?;
                let Some(relaxation_time) = relaxation_time else {
                    return Ok(DynamicLine::Segments(segments));
                };
                let wall = StandardLinearSolid::of_hose(hose_of(line)?, member, relaxation_time);
                Ok(DynamicLine::Segments(segments.with_creep(&conduit, &wall)?))
            }
            LineModel::TransmissionLine { end_share } => {
                TransmissionLine::of_conduit(&conduit()?, end_share).map(DynamicLine::TransmissionLine)
            }
            LineModel::TwoWave { end_share, wall } => {
                let (hose, length) = (hose_of(line)?, conduit()?.length);
                let wall = BraidedWall::stated(hose, member, &wall);
                let hose = TwoWaveHose::new(hose, length, fluid, pressure, wall);
                hose.in_time(end_share).map(DynamicLine::TwoWave)
            }
        }
    }
}

fn hose_of(line: &Line) -> Result<&Hose, LineError> {
    match line {
        Line::Hose { hose, .. } => Ok(hose),
        Line::Pipe { .. } | Line::Volume { .. } => Err(LineError::NotAHose),
    }
}
