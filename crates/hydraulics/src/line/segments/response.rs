use num_complex::Complex64;

use super::Segments;
use crate::line::TransferMatrix;
use crate::line::laminar_friction::UNSTEADY_FRICTION;

impl Segments {
    /// See [`crate::line::DynamicLine::transfer_matrix`]: every node a capacity across the line, every segment an impedance along it.
    pub(in crate::line) fn transfer_matrix(&self, s: Complex64) -> TransferMatrix {
        let segments = self.count.max(1) as f64;
        let along = self.impedance(s) / segments;
        let mut matrix = TransferMatrix::IDENTITY;
        for node in 0..self.count {
            let capacity = self.share() / if node == 0 { 2.0 } else { 1.0 };
            matrix = matrix.across(s * capacity + self.creep_admittance(node, s)).along(along);
        }
        matrix.across(self.creep_admittance(self.count, s))
    }

    /// Inertance and friction of the whole length, in Pa s/m3.
    fn impedance(&self, s: Complex64) -> Complex64 {
        let unsteady = UNSTEADY_FRICTION.into_iter().take(self.lags()).map(|(corner, weight)| {
            let behind = s / (s + corner * self.viscous_rate);
            4.0 * weight * self.inertance * self.viscous_rate * behind
        });
        s * self.inertance + self.resistance + unsteady.sum::<Complex64>()
    }

    /// Flow that the creeping wall takes up at a node, over the pressure there.
    fn creep_admittance(&self, node: usize, s: Complex64) -> Complex64 {
        let Some(creep) = self.creep else { return Complex64::ZERO };
        let ends = if self.count > 0 && (node == 0 || node == self.count) { 2.0 } else { 1.0 };
        creep.compliance / (ends * self.count.max(1) as f64) * s / (1.0 + creep.retardation_time * s)
    }

    /// What yields at once, in m3/Pa.
    pub(in crate::line) fn elastic_compliance(&self) -> f64 {
        self.compliance
    }

    /// The same line, fluid and wall stiffer by a factor.
    pub(in crate::line) fn stiffened(mut self, factor: f64) -> Segments {
        self.compliance /= factor;
        if let Some(creep) = &mut self.creep {
            creep.compliance /= factor;
        }
        self
    }
}
