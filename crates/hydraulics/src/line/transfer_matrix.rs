use num_complex::Complex64;
use phea_dynamics::analytic::Analytic;

use super::DynamicLine;

/// Response of a line at one frequency, from its valve port to its chamber.
///
/// ```text
/// p_port  = a p_chamber + b q_chamber
/// q_valve = c p_chamber + d q_chamber           a d - b c = 1
/// ```
///
/// Flows count from the valve to the chamber. Units: 1, Pa s/m3, m3/(s Pa), 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferMatrix<A = Complex64> {
    /// Entry a.
    pub pressure: A,
    /// Entry b.
    pub impedance: A,
    /// Entry c.
    pub admittance: A,
    /// Entry d.
    pub flow: A,
}

impl<A: Analytic> TransferMatrix<A> {
    /// Matrix of no line.
    pub fn identity() -> TransferMatrix<A> {
        let (one, zero) = (A::from(1.0), A::from(0.0));
        TransferMatrix { pressure: one, impedance: zero, admittance: zero, flow: one }
    }

    /// Matrix of this line with a compliance at its chamber end.
    pub(super) fn across(&self, admittance: A) -> TransferMatrix<A> {
        TransferMatrix {
            pressure: self.pressure + self.impedance * admittance,
            admittance: self.admittance + self.flow * admittance,
            ..*self
        }
    }
}

impl DynamicLine {
    /// Transfer matrix at s in rad/s, or over a set of values of s: the Laplace transform of the
    /// line's equations. The end capacity that the line adds to the chamber
    /// ([`DynamicLine::chamber_compliance`]) belongs to the chamber.
    ///
    /// # Example
    /// A lumped line has all of its compliance at the chamber, and passes pressure and flow
    /// unchanged:
    /// ```
    /// use num_complex::Complex64;
    /// use phea_hydraulics::line::{DynamicLine, Segments, TransferMatrix};
    /// let line = DynamicLine::Segments(Segments::lumped(1e-12));
    /// assert_eq!(line.transfer_matrix(Complex64::new(0.0, 100.0)), TransferMatrix::identity());
    /// ```
    pub fn transfer_matrix<A: Analytic>(&self, s: A) -> TransferMatrix<A> {
        match self {
            DynamicLine::Segments(line) => line.transfer_matrix(s),
            DynamicLine::TransmissionLine(line) => line.transfer_matrix(s),
            DynamicLine::TwoWave(line) => line.transfer_matrix(s),
        }
    }

    /// Resistance to steady flow, Pa s/m3.
    pub fn resistance(&self) -> f64 {
        match self {
            DynamicLine::Segments(line) => line.resistance(),
            DynamicLine::TransmissionLine(line) => line.resistance(),
            DynamicLine::TwoWave(line) => line.resistance(),
        }
    }

    /// Immediate compliance of fluid and wall in m3/Pa, including the chamber end: the compliance
    /// of the lumped line. A wall that creeps yields more later.
    pub fn elastic_compliance(&self) -> f64 {
        match self {
            DynamicLine::Segments(line) => line.elastic_compliance(),
            DynamicLine::TransmissionLine(line) => line.elastic_compliance(),
            DynamicLine::TwoWave(line) => line.elastic_compliance(),
        }
    }

    /// Frequency above all modes of a line with finitely many modes, rad/s; 0 for a line with
    /// waves.
    pub(crate) fn fastest_rad_per_s(&self) -> f64 {
        match self {
            DynamicLine::Segments(line) => line.fastest_rad_per_s(),
            DynamicLine::TransmissionLine(_) | DynamicLine::TwoWave(_) => 0.0,
        }
    }

    /// Final compliance of fluid and wall: the immediate part, and the creep of the wall, m3/Pa.
    pub(crate) fn static_compliance(&self) -> f64 {
        match self {
            DynamicLine::Segments(line) => line.elastic_compliance() + line.creep_compliance(),
            DynamicLine::TransmissionLine(_) | DynamicLine::TwoWave(_) => self.elastic_compliance(),
        }
    }

    /// Line with fluid and wall stiffer by a factor: waves are faster by its root, inertia and
    /// steady friction are unchanged.
    pub fn stiffened(&self, factor: f64) -> DynamicLine {
        match self {
            DynamicLine::Segments(line) => DynamicLine::Segments(line.stiffened(factor)),
            DynamicLine::TransmissionLine(line) => DynamicLine::TransmissionLine(line.stiffened(factor)),
            DynamicLine::TwoWave(line) => DynamicLine::TwoWave(line.stiffened(factor)),
        }
    }
}
