//! Columns of a table of numbers.

use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Columns of the text of a table, by name: arrays of float64, and lists of texts where a cell is
/// not a number; an empty cell of a column of numbers is not a number.
#[pyfunction]
pub(crate) fn columns<'py>(py: Python<'py>, text: &[u8]) -> PyResult<Bound<'py, PyDict>> {
    let text = std::str::from_utf8(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let (names, cells) = py.detach(|| cells(text));
    let table = PyDict::new(py);
    for (name, cells) in names.into_iter().zip(cells) {
        let numbers: Option<Vec<f64>> = cells.iter().map(|cell| number(cell)).collect();
        match numbers {
            Some(numbers) => table.set_item(name, PyArray1::from_vec(py, numbers))?,
            None => table.set_item(name, cells)?,
        }
    }
    Ok(table)
}

/// Number in a cell; `None` if it is a text.
fn number(cell: &str) -> Option<f64> {
    if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() }
}

/// Names of the columns, and the cells of each.
fn cells(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut rows = text.lines();
    let names = rows.next().map(row).unwrap_or_default();
    let mut columns = vec![Vec::new(); names.len()];
    for line in rows {
        for (column, cell) in columns.iter_mut().zip(row(line)) {
            column.push(cell);
        }
    }
    (names, columns)
}

/// Cells of a row; a cell in quotation marks may contain commas, and a doubled mark is one.
fn row(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        let Some(cell) = cells.last_mut() else { break };
        match character {
            '"' if quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            _ => cell.push(character),
        }
    }
    cells
}
