//! Stiffness over the stroke and driving-point impedance of a rig as plain numbers.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_engineering::linearize::{PortView, frequency_grid, linearize, stiffness_at, stroke_stiffness};
use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::stiffness::StiffnessModel;

use crate::command::CommandError;
use crate::plant_values::Factors;
use crate::project::Loaded;
use crate::quantity::MotionKind;
use crate::report::positions;
use crate::sizing::model_name;

/// Hydraulic stiffness over the stroke, in SI units of the motion: m and N/m, or rad and N m/rad.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessValues {
    /// Motion of the rig.
    pub motion: MotionKind,
    /// Positions of the curves; only the operating point for a motor that turns without end.
    pub positions: Vec<f64>,
    /// Stiffness by the model that the project declares, then by the other one.
    pub models: [StiffnessCurveValues; 2],
    /// Least stiffness over the stroke by the declared model, and its position, as `check` prints
    /// them.
    pub least: [f64; 2],
    /// Greatest stiffness over the stroke by the declared model, and its position.
    pub greatest: [f64; 2],
    /// Position of the operating point.
    pub operating_position: f64,
}

/// Stiffness at each position by one model.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessCurveValues {
    /// Word of the model in the project file.
    pub model: &'static str,
    /// With the nominal dynamic stiffening of the lines.
    pub nominal: Vec<f64>,
    /// With the least dynamic stiffening.
    pub minimum: Vec<f64>,
    /// With the greatest dynamic stiffening.
    pub maximum: Vec<f64>,
}

/// Driving-point impedance Z of a rig, in N s/m or N m s/rad.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpedanceValues {
    /// Motion of the rig.
    pub motion: MotionKind,
    /// Frequencies of the responses, rad/s: those of the figure in the report, which resolve each
    /// resonance.
    pub frequencies_rad_per_s: Vec<f64>,
    /// With the command at rest.
    pub open_loop: PortValues,
    /// With the controller of the project; `None` if there is none, or no closed form.
    pub closed_loop: Option<PortValues>,
}

/// Impedance of one loop.
#[derive(Clone, Debug, PartialEq)]
pub struct PortValues {
    /// Impedance as a transfer function.
    pub factors: Factors,
    /// Impedance at each frequency, as real and imaginary part.
    pub responses: Vec<[f64; 2]>,
}

/// Stiffness of the rig of a project; `None` for a project without a rig.
///
/// # Errors
/// [`CommandError`] for a rig that cannot be computed.
///
/// # Example
/// ```
/// use phea_workbench::project;
/// use phea_workbench::rig_values::stiffness_values;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let found = stiffness_values(&loaded)?.ok_or("a rig")?;
/// assert_eq!(found.positions.len(), 121);
/// assert!(found.models[0].nominal.iter().all(|value| (found.least[0]..=found.greatest[0]).contains(value)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn stiffness_values(loaded: &Loaded) -> Result<Option<StiffnessValues>, CommandError> {
    if loaded.project.actuator.is_none() {
        return Ok(None);
    }
    let rig = Setup::rig_of(&loaded.project)?;
    let components = rig.actuator.components();
    let positions = components.cylinder.stroke.length().map_or(vec![rig.point.position], positions);
    let stroke = stroke_stiffness(&rig, StiffeningMember::Nominal);
    let models = match components.stiffness_model {
        StiffnessModel::Uniform => [StiffnessModel::Uniform, StiffnessModel::ByVolume],
        StiffnessModel::ByVolume => [StiffnessModel::ByVolume, StiffnessModel::Uniform],
    };
    Ok(Some(StiffnessValues {
        motion: loaded.project.motion(),
        models: models.map(|model| curve(&rig, model, &positions)),
        positions,
        least: [stroke.minimum, stroke.minimum_position],
        greatest: [stroke.maximum, stroke.maximum_position],
        operating_position: rig.point.position,
    }))
}

fn curve(rig: &Rig, model: StiffnessModel, positions: &[f64]) -> StiffnessCurveValues {
    let at = |member| positions.iter().map(|place| stiffness_at(rig, model, member, *place)).collect();
    StiffnessCurveValues {
        model: model_name(model),
        nominal: at(StiffeningMember::Nominal),
        minimum: at(StiffeningMember::Minimum),
        maximum: at(StiffeningMember::Maximum),
    }
}

/// Driving-point impedance of the rig of a project; `None` for a project without a rig.
///
/// # Errors
/// [`CommandError`] for a rig that cannot be computed.
///
/// # Example
/// ```
/// use phea_workbench::project;
/// use phea_workbench::rig_values::impedance_values;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let found = impedance_values(&loaded)?.ok_or("a rig")?;
/// assert_eq!(found.open_loop.responses.len(), found.frequencies_rad_per_s.len());
/// assert!(found.closed_loop.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impedance_values(loaded: &Loaded) -> Result<Option<ImpedanceValues>, CommandError> {
    if loaded.project.actuator.is_none() {
        return Ok(None);
    }
    let setup = Setup::new(&loaded.project)?;
    let found = linearize(setup.rig()?, setup.controller.as_ref(), &setup.sensor)?;
    let grid = frequency_grid(&found.full.command)?;
    let port = |view: &PortView| port(&view.impedance, &grid);
    Ok(Some(ImpedanceValues {
        motion: found.motion,
        open_loop: port(&found.open_loop),
        closed_loop: found.closed_loop.as_ref().map(port),
        frequencies_rad_per_s: grid.clone(),
    }))
}

fn port(impedance: &TransferFunction, grid: &[f64]) -> PortValues {
    let pair = |value: Complex64| [value.re, value.im];
    PortValues {
        factors: Factors::of(impedance),
        responses: grid.iter().map(|at| pair(impedance.at_frequency(*at))).collect(),
    }
}
