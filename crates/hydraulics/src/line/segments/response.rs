use std::f64::consts::PI;

use phea_dynamics::analytic::Analytic;
use phea_dynamics::portable::cos;

use super::Segments;
use crate::line::TransferMatrix;
use crate::line::laminar_friction::UNSTEADY_FRICTION;

impl Segments {
    /// Transfer matrix as in [`crate::line::DynamicLine::transfer_matrix`]: N equal sections, each
    /// an impedance z along the line between two halves of an admittance y across it, with the
    /// Chebyshev polynomials T_N and U_(N-1) by their roots:
    ///
    /// ```text
    /// x = 1 + z y/2:     a = d = T_N(x),   b = z U_(N-1)(x),   c = y (1 + z y/4) U_(N-1)(x)
    /// T_N(x) = 1/2 product of 2 (x - cos((2 k - 1) pi/(2 N))),     U_(N-1)(x) = product of 2 (x - cos(k pi/N))
    /// ```
    ///
    /// The last half of the elastic capacity belongs to the chamber.
    pub(in crate::line) fn transfer_matrix<A: Analytic>(&self, s: A) -> TransferMatrix<A> {
        let creeping = self.creep_admittance(s);
        if self.count == 0 {
            return TransferMatrix::identity().across(creeping);
        }
        let sections = self.count as f64;
        let along = self.impedance(s).scaled(1.0 / sections);
        let across = s.scaled(self.fraction()) + creeping.scaled(1.0 / sections);
        let product = along * across;
        let one = A::from(1.0);
        let x = one + product.scaled(0.5);
        // cos(j pi/(2 N)) by cos((j + 1) a) = 2 cos(a) cos(j a) - cos((j - 1) a): roots of T_N and
        // U_(N-1) alternately
        let first = cos(PI / (2.0 * sections));
        let (mut before, mut root) = (1.0, first);
        let (mut own, mut other) = (A::from(0.5), one);
        for j in 1..2 * self.count {
            let polynomial = if j % 2 == 1 { &mut own } else { &mut other };
            *polynomial = *polynomial * (x - A::from(root)).scaled(2.0);
            (before, root) = (root, 2.0 * first * root - before);
        }
        let whole = TransferMatrix {
            pressure: own,
            impedance: along * other,
            admittance: across * (one + product.scaled(0.25)) * other,
            flow: own,
        };
        whole.across(s.scaled(-0.5 * self.fraction()))
    }

    /// Inertance and friction of the whole length, Pa s/m3.
    fn impedance<A: Analytic>(&self, s: A) -> A {
        let mut sum = s.scaled(self.inertance) + A::from(self.resistance);
        for (corner, weight) in UNSTEADY_FRICTION.into_iter().take(self.lags()) {
            let behind = s / (s + A::from(corner * self.viscous_rate));
            sum = sum + behind.scaled(4.0 * weight * self.inertance * self.viscous_rate);
        }
        sum
    }

    /// Flow into the creeping wall, over the pressure.
    fn creep_admittance<A: Analytic>(&self, s: A) -> A {
        let Some(creep) = self.creep else { return A::from(0.0) };
        s.scaled(creep.compliance) / (A::from(1.0) + s.scaled(creep.retardation_time))
    }

    /// Steady resistance of the line, Pa s/m3.
    pub(in crate::line) fn resistance(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.resistance }
    }

    /// Immediate compliance, m3/Pa.
    pub(in crate::line) fn elastic_compliance(&self) -> f64 {
        self.compliance
    }

    /// Frequency above all modes of the line, 2 N/sqrt(I C), rad/s.
    pub(in crate::line) fn fastest_rad_per_s(&self) -> f64 {
        let product = self.inertance * self.compliance;
        if self.count > 0 && product > 0.0 { 2.0 * self.count as f64 / product.sqrt() } else { 0.0 }
    }

    /// Delayed compliance of a creeping wall, m3/Pa.
    pub(in crate::line) fn creep_compliance(&self) -> f64 {
        self.creep.map_or(0.0, |creep| creep.compliance)
    }

    /// Line with fluid and wall stiffer by a factor.
    pub(in crate::line) fn stiffened(mut self, factor: f64) -> Segments {
        self.compliance /= factor;
        if let Some(creep) = &mut self.creep {
            creep.compliance /= factor;
        }
        self
    }
}
