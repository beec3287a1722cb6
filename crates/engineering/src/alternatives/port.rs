//! Impedance at the load, by which an alternative resists a moving load.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::columns::{AlternativeColumn, ColumnPart, column};
use super::{ColumnKey, JudgedAlternative, NoNumber};
use crate::quantity::{DAMPING, fitting};

/// Frequencies at which the impedance is reported if none are requested, rad/s.
pub const IMPEDANCE_AT: [f64; 3] = [1.0, 10.0, 100.0];

impl JudgedAlternative {
    /// Magnitude |Z(jw)| at each frequency, with the command held, under the designed controller,
    /// and as required by a virtual impedance.
    pub(super) fn impedances(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let each = self.impedance_at.iter().flat_map(|frequency| {
            let part = ColumnPart::Impedance(*frequency);
            self.impedance(*frequency).into_iter().map(move |column| (part.clone(), column))
        });
        each.collect()
    }

    fn impedance(&self, frequency: f64) -> Vec<AlternativeColumn> {
        let linearization = self.linearization.as_ref().map_err(|reason| NoNumber::from(reason.clone()));
        let damping = self.loaded.project.motion().dimension(&DAMPING);
        let open = linearization.clone().map(|found| &found.open_loop);
        let closed = linearization.clone().and_then(|found| {
            let reason = || NoNumber::NoClosedLoop(found.closed_loop_absent);
            found.closed_loop.as_ref().filter(|_| self.deployed.is_ok()).ok_or_else(reason)
        });
        let required_impedance =
            linearization.as_ref().ok().and_then(|found| found.required_impedance.as_ref());
        let required_impedance = required_impedance.map(|required_impedance| {
            let s = Complex64::new(0.0, frequency);
            let required_impedance = portable::magnitude(required_impedance.unfiltered().response(s) / s);
            column(
                ColumnKey::ImpedanceRequired,
                fitting(required_impedance, damping),
                3,
                Ok(required_impedance),
            )
        });
        let [open, closed] = [open, closed]
            .map(|view| view.map(|view| portable::magnitude(view.impedance.at_frequency(frequency))));
        let unit = |value: &Result<f64, NoNumber>| fitting(value.clone().unwrap_or_default(), damping);
        let found = [
            column(ColumnKey::ImpedanceOpen, unit(&open), 3, open),
            column(ColumnKey::ImpedanceClosed, unit(&closed), 3, closed),
        ];
        found.into_iter().chain(required_impedance).collect()
    }
}
