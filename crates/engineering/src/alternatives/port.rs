//! The impedance at the load, by which an alternative resists a load that moves it.

use phea_dynamics::portable;

use super::JudgedAlternative;
use super::columns::{AlternativeColumn, ColumnPart, column};
use crate::quantity::{DAMPING, fitting};

/// Frequencies at which the impedance is told where none are asked for, rad/s.
pub const IMPEDANCE_AT: [f64; 3] = [1.0, 10.0, 100.0];

impl JudgedAlternative {
    /// |Z(jw)| at each frequency, with the command held and under the designed controller.
    pub(super) fn impedances(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let each = self.impedance_at.iter().flat_map(|frequency| {
            let part = ColumnPart::Impedance(*frequency);
            self.impedance(*frequency).into_iter().map(move |column| (part.clone(), column))
        });
        each.collect()
    }

    fn impedance(&self, frequency: f64) -> [AlternativeColumn; 2] {
        let linearization = self.linearization.as_ref().map_err(Clone::clone);
        let open = linearization.clone().map(|found| &found.open_loop);
        let closed = linearization.and_then(|found| {
            let reason = || found.closed_loop_absent.clone().unwrap_or_default();
            found.closed_loop.as_ref().filter(|_| self.deployed.is_ok()).ok_or_else(reason)
        });
        let [open, closed] = [open, closed]
            .map(|view| view.map(|view| portable::magnitude(view.impedance.at_frequency(frequency))));
        let unit = |value: &Result<f64, String>| fitting(value.clone().unwrap_or_default(), &DAMPING);
        [
            column("impedance_open_n_s_per_m", "open loop", unit(&open), 3, open),
            column("impedance_closed_n_s_per_m", "closed loop", unit(&closed), 3, closed),
        ]
    }
}
