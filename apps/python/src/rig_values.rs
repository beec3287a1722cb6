//! Stiffness and impedance of a rig as arrays.

use numpy::{Complex64, PyArray1};
use phea_workbench::rig_values::{PortValues, StiffnessCurveValues, impedance_values, stiffness_values};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::linear::factors;
use crate::project::HeldProject;

/// True for a rig that turns, positions, model and curves (nominal, minimum, maximum) of the
/// declared and of the other stiffness model, least and greatest stiffness with their positions,
/// and the operating position; `None` without a rig.
#[pyfunction]
pub(crate) fn stiffness<'py>(
    py: Python<'py>,
    project: &HeldProject,
) -> PyResult<Option<Bound<'py, PyTuple>>> {
    let found = py.detach(|| project.of_linear(stiffness_values))?;
    let Some(found) = found else { return Ok(None) };
    let array = |values: Vec<f64>| PyArray1::from_vec(py, values);
    let curve = |one: StiffnessCurveValues| {
        (one.model, array(one.nominal), array(one.minimum), array(one.maximum)).into_pyobject(py)
    };
    let [declared, other] = found.models;
    let values = (
        found.motion.is_rotary(),
        array(found.positions),
        curve(declared)?,
        curve(other)?,
        found.least,
        found.greatest,
        found.operating_position,
    );
    values.into_pyobject(py).map(Some)
}

/// True for a rig that turns, frequencies in rad/s, and factors and responses of the impedance of
/// the open and of the closed loop, the latter or `None`; `None` without a rig.
#[pyfunction]
pub(crate) fn impedance<'py>(
    py: Python<'py>,
    project: &HeldProject,
) -> PyResult<Option<Bound<'py, PyTuple>>> {
    let found = py.detach(|| project.of_linear(impedance_values))?;
    let Some(found) = found else { return Ok(None) };
    let port = |one: &PortValues| {
        let responses: Vec<_> = one.responses.iter().map(|&[re, im]| Complex64::new(re, im)).collect();
        (factors(py, &one.factors)?, PyArray1::from_vec(py, responses)).into_pyobject(py)
    };
    let closed = found.closed_loop.as_ref().map(port).transpose()?;
    let frequencies = PyArray1::from_vec(py, found.frequencies_rad_per_s);
    (found.motion.is_rotary(), frequencies, port(&found.open_loop)?, closed).into_pyobject(py).map(Some)
}
