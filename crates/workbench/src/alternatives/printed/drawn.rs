//! The impedance of an alternative, as it is drawn.

use num_complex::Complex64;
use phea_engineering::alternatives::JudgedAlternative;
use phea_engineering::linearize::frequency_grid;
use serde::{Deserialize, Serialize};

use crate::figure::FrequencySeries;

/// The impedance at the load, under the designed controller if that is continuous.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DrawnImpedance {
    name: String,
    frequencies_rad_per_s: Vec<f64>,
    /// Real and imaginary part at each frequency, SI.
    response: Vec<[f64; 2]>,
}

impl DrawnImpedance {
    pub(super) fn of(one: &JudgedAlternative) -> Option<DrawnImpedance> {
        let models = one.linearization.as_ref().ok()?;
        let (port, name) = match models.closed_loop.as_ref().filter(|_| one.deployed.is_ok()) {
            Some(closed) => (closed, one.name.clone()),
            None => (&models.open_loop, format!("{}, open loop", one.name)),
        };
        let frequencies_rad_per_s = frequency_grid(&port.impedance).ok()?;
        let at = |frequency: &f64| port.impedance.at_frequency(*frequency);
        let response = frequencies_rad_per_s.iter().map(at).map(|found| [found.re, found.im]).collect();
        Some(DrawnImpedance { name, frequencies_rad_per_s, response })
    }

    /// The series of the figure.
    pub(crate) fn series(&self) -> FrequencySeries {
        FrequencySeries {
            name: self.name.clone(),
            frequencies_rad_per_s: self.frequencies_rad_per_s.clone(),
            response: self.response.iter().map(|[re, im]| Complex64::new(*re, *im)).collect(),
        }
    }
}
