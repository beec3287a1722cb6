//! Linear values of a project: transfer functions by their factors, and the plants of a family.

use std::sync::Mutex;

use numpy::{Complex64, PyArray1, PyArray2};
use phea_workbench::linear_values::{self, Factors, FamilyValues, MeasuredValues};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::project::HeldProject;

/// Gain, zeros, poles, dead time in s, and sample time in s or `None`.
pub(crate) fn factors<'py>(py: Python<'py>, found: &Factors) -> PyResult<Bound<'py, PyTuple>> {
    let roots = |pairs: &[[f64; 2]]| {
        let roots = pairs.iter().map(|&[re, im]| Complex64::new(re, im)).collect();
        PyArray1::<Complex64>::from_vec(py, roots)
    };
    (found.gain, roots(&found.zeros), roots(&found.poles), found.dead_time_s, found.sample_time_s)
        .into_pyobject(py)
}

/// The transfer functions of a project by their names.
#[pyfunction]
pub(crate) fn transfer_functions<'py>(
    py: Python<'py>,
    project: &HeldProject,
) -> PyResult<Bound<'py, PyDict>> {
    let found = py.detach(|| project.of_linear(linear_values::transfer_functions))?;
    let named = PyDict::new(py);
    for (name, function) in &found {
        named.set_item(name, factors(py, function)?)?;
    }
    Ok(named)
}

/// The family of plants of a project.
#[pyclass(frozen, module = "phea._native", name = "Family")]
pub(crate) struct PlantFamily {
    family: Mutex<FamilyValues>,
}

#[pymethods]
impl PlantFamily {
    #[new]
    fn new(py: Python<'_>, project: &HeldProject) -> PyResult<PlantFamily> {
        let family = py.detach(|| project.family())?;
        Ok(PlantFamily { family: Mutex::new(family) })
    }

    /// Names of the parameters.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.with(|family| family.parameters().into_iter().map(str::to_string).collect())
    }

    /// Values of the parameters of each member, a row each; the nominal plant is the first.
    #[getter]
    fn members<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let members = self.with(|family| family.members());
        PyArray2::from_vec2(py, &members).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The plant with these values by its factors; `None` without polynomials.
    fn member<'py>(&self, py: Python<'py>, values: Vec<f64>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        self.check(&values)?;
        let found = self.with(|family| family.member(&values));
        found.map(|found| factors(py, &found)).transpose()
    }

    /// Parts of the loop around the plant with these values, by their names; `None` without a
    /// controller or without polynomials.
    #[pyo3(name = "loop")]
    fn in_loop<'py>(&self, py: Python<'py>, values: Vec<f64>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.check(&values)?;
        let Some(found) = self.with(|family| family.in_loop(&values)) else { return Ok(None) };
        let parts = PyDict::new(py);
        parts.set_item("controller", factors(py, &found.controller)?)?;
        parts.set_item("prefilter", factors(py, &found.prefilter)?)?;
        parts.set_item("plant", factors(py, &found.plant)?)?;
        parts.set_item("plant_and_sensor", factors(py, &found.plant_and_sensor)?)?;
        Ok(Some(parts))
    }

    /// Responses of the plant with these values at frequencies in rad/s.
    fn response<'py>(
        &self,
        py: Python<'py>,
        values: Vec<f64>,
        frequencies: Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        self.check(&values)?;
        let found: Option<Vec<Complex64>> = py.detach(|| {
            self.with(|family| {
                let at = |frequency: &f64| {
                    family.response(&values, *frequency).map(|[re, im]| Complex64::new(re, im))
                };
                frequencies.iter().map(at).collect()
            })
        });
        let found = found.ok_or_else(|| PyValueError::new_err("no plant exists with these values"))?;
        Ok(PyArray1::from_vec(py, found))
    }

    /// Name, frequencies in rad/s and responses of each measured plant.
    fn measured<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyTuple>>> {
        let plants = self.with(FamilyValues::measured);
        let arrays = |plant: MeasuredValues| {
            let responses = plant.responses.iter().map(|&[re, im]| Complex64::new(re, im)).collect();
            let frequencies = PyArray1::<f64>::from_vec(py, plant.frequencies_rad_per_s);
            (plant.name, frequencies, PyArray1::<Complex64>::from_vec(py, responses)).into_pyobject(py)
        };
        plants.into_iter().map(arrays).collect()
    }
}

impl PlantFamily {
    fn with<T>(&self, read: impl FnOnce(&FamilyValues) -> T) -> T {
        read(&self.family.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
    }

    fn check(&self, values: &[f64]) -> PyResult<()> {
        let expected = self.with(|family| family.parameters().len());
        if values.len() == expected {
            return Ok(());
        }
        let message = format!("{} values for {expected} parameters", values.len());
        Err(PyValueError::new_err(message))
    }
}
