use num_complex::Complex64;

use super::DynamicLine;

/// What a line does at one frequency, from its valve port to its chamber.
///
/// ```text
/// p_port  = a p_chamber + b q_chamber
/// q_valve = c p_chamber + d q_chamber           a d - b c = 1
/// ```
///
/// Flows count from the valve to the chamber. Units: 1, Pa s/m3, m3/(s Pa), 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferMatrix {
    /// a
    pub pressure: Complex64,
    /// b
    pub impedance: Complex64,
    /// c
    pub admittance: Complex64,
    /// d
    pub flow: Complex64,
}

impl TransferMatrix {
    /// No line.
    pub const IDENTITY: TransferMatrix = TransferMatrix {
        pressure: Complex64::ONE,
        impedance: Complex64::ZERO,
        admittance: Complex64::ZERO,
        flow: Complex64::ONE,
    };

    /// This line, and at its chamber's end what takes up flow.
    pub(super) fn across(&self, admittance: Complex64) -> TransferMatrix {
        TransferMatrix {
            pressure: self.pressure + self.impedance * admittance,
            admittance: self.admittance + self.flow * admittance,
            ..*self
        }
    }

    /// This line, and at its chamber's end what takes up pressure.
    pub(super) fn along(&self, impedance: Complex64) -> TransferMatrix {
        TransferMatrix {
            impedance: self.impedance + self.pressure * impedance,
            flow: self.flow + self.admittance * impedance,
            ..*self
        }
    }

    /// This line, and then another.
    pub(super) fn then(&self, [[a, b], [c, d]]: &[[Complex64; 2]; 2]) -> TransferMatrix {
        TransferMatrix {
            pressure: self.pressure * a + self.impedance * c,
            impedance: self.pressure * b + self.impedance * d,
            admittance: self.admittance * a + self.flow * c,
            flow: self.admittance * b + self.flow * d,
        }
    }
}

impl DynamicLine {
    /// The line at s in rad/s: its equations in time, transformed. The end that it adds to the chamber
    /// ([`DynamicLine::chamber_compliance`]) belongs to the chamber.
    ///
    /// # Example
    /// A lumped line has all of its compliance at the chamber, and does nothing else.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_hydraulics::line::{DynamicLine, Segments, TransferMatrix};
    /// let line = DynamicLine::Segments(Segments::lumped(1e-12));
    /// assert_eq!(line.transfer_matrix(Complex64::new(0.0, 100.0)), TransferMatrix::IDENTITY);
    /// ```
    pub fn transfer_matrix(&self, s: Complex64) -> TransferMatrix {
        match self {
            DynamicLine::Segments(line) => line.transfer_matrix(s),
            DynamicLine::TransmissionLine(line) => line.transfer_matrix(s),
            DynamicLine::TwoWave(line) => line.transfer_matrix(s),
        }
    }

    /// What fluid and wall yield at once, in m3/Pa, the end at the chamber included: the compliance of the lumped line. A wall that
    /// creeps yields more later.
    pub fn elastic_compliance(&self) -> f64 {
        match self {
            DynamicLine::Segments(line) => line.elastic_compliance(),
            DynamicLine::TransmissionLine(line) => line.elastic_compliance(),
            DynamicLine::TwoWave(line) => line.elastic_compliance(),
        }
    }

    /// The same line, fluid and wall stiffer by a factor: waves are faster by its root, inertia and steady friction stay.
    pub fn stiffened(&self, factor: f64) -> DynamicLine {
        match self {
            DynamicLine::Segments(line) => DynamicLine::Segments(line.stiffened(factor)),
            DynamicLine::TransmissionLine(line) => DynamicLine::TransmissionLine(line.stiffened(factor)),
            DynamicLine::TwoWave(line) => DynamicLine::TwoWave(line.stiffened(factor)),
        }
    }
}
