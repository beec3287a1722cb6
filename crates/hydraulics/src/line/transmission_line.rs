use super::travelling_waves::WaveData;
use super::{Conduit, LineError, TravellingWaves};
use crate::parameter::Problems;

/// Default fraction of a line's compliance in each end volume.
pub const END_SHARE: f64 = 0.01;

/// Line with one wave in each direction, exact delay and frequency-dependent laminar friction.
pub type TransmissionLine<S = f64> = TravellingWaves<1, S>;

impl TransmissionLine {
    /// Transmission line of a conduit, with `end_share` of its compliance as a plain volume at each
    /// end.
    ///
    /// ```text
    /// C_end = f C      Z = Z_c/sqrt(1 - 2 f)      delay = T sqrt(1 - 2 f)
    /// ```
    ///
    /// The end volumes separate the line from the valve's edges, which avoids an algebraic loop,
    /// and give a chamber at its end stop a finite compliance. The part between them has all of the
    /// inertia and the resistance: compliance, inertance and steady resistance of the whole are
    /// exact for any fraction, and the waves tend to the exact ones as it tends to zero.
    ///
    /// # Errors
    /// Conduit that is impossible, has no length or is overdamped; a fraction not between 0 and
    /// 1/2.
    ///
    /// # Example
    /// 1.5 m of the thesis' hose.
    /// ```
    /// # use phea_hydraulics::line::{Conduit, END_SHARE, TransmissionLine};
    /// let conduit = Conduit {
    ///     length: 1.5, bore: 12.7e-3, density: 870.0, kinematic_viscosity: 46e-6, effective_bulk_modulus: 2.609e8,
    /// };
    /// let line = TransmissionLine::of_conduit(&conduit, END_SHARE)?;
    /// assert!((line.delays()[0] / (0.98_f64.sqrt() * conduit.delay()) - 1.0).abs() < 1e-12);
    /// # Ok::<(), phea_hydraulics::line::LineError>(())
    /// ```
    pub fn of_conduit(conduit: &Conduit, end_share: f64) -> Result<TransmissionLine, LineError> {
        conduit.check()?;
        check_end_share(end_share)?;
        let root = (1.0 - 2.0 * end_share).sqrt();
        let wave = WaveData {
            impedance: conduit.characteristic_impedance() / root,
            delay: conduit.delay() * root,
            dissipation: conduit.dissipation_number() * root,
        };
        TravellingWaves::new([wave], end_share * conduit.compliance(), conduit.steady_resistance())
    }
}

pub(super) fn check_end_share(end_share: f64) -> Result<(), LineError> {
    let mut problems = Problems::default();
    problems.key(super::motion_keys::END_SHARE_KEY, end_share);
    let problems = problems.into_vec();
    if problems.is_empty() { Ok(()) } else { Err(LineError::Impossible { problems }) }
}
