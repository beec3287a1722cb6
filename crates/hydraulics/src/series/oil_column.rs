use phea_dynamics::scalar::Scalar;

/// The oil of a transmission, as the rod and the load feel it: springs of its compressibility, and
/// plugs of oil between them that friction holds to the fixed line. Units: N/m, kg, N s/m.
///
/// ```text
/// rod - k_1 - m - k_2 - m - ... - k_N+1 - load             each m damped by b against the ground
/// k_1 = k_N+1 = A^2/(C_e + C/2N),   k_j = A^2 N/C,   m = A^2 I/N,   b = A^2 R_0/N
/// f_j = k_j d_j = A (p_j-1 - p_0)                          u_j = q_j/A the velocity of plug j
/// ```
///
/// This is [`Transmission`](super::Transmission) with forces in place of pressures. Every part stores
/// or dissipates, so it is passive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilColumn<S = f64> {
    /// k of the first and the last spring.
    pub end_stiffness: S,
    /// k of those between two plugs.
    pub inner_stiffness: S,
    /// m of each plug.
    pub mass: S,
    /// b of each plug.
    pub damping: S,
    /// A of either piston in m2.
    pub piston_area: S,
    /// Gauge pressure p_0 in Pa at which no spring is loaded.
    pub filling_pressure: S,
    /// N, the number of plugs.
    pub segments: usize,
}

phea_dynamics::parameters! {
    OilColumn {
        end_stiffness, inner_stiffness, mass, damping, piston_area, filling_pressure,
        segments: kept,
    }
}

impl<S: Copy> OilColumn<S> {
    /// k of the spring behind this many plugs.
    #[inline(always)]
    pub(crate) fn stiffness_behind(&self, plugs: usize) -> S {
        if plugs == 0 || plugs == self.segments { self.end_stiffness } else { self.inner_stiffness }
    }
}

impl<S: Scalar> OilColumn<S> {
    /// Of all springs in series, in N/m: that of slow motions.
    pub fn stiffness(&self) -> S {
        let (one, inner) = (S::from(1.0), S::from((self.segments - 1) as f64));
        one / (S::from(2.0) / self.end_stiffness + inner / self.inner_stiffness)
    }

    /// Gauge pressure in Pa where a spring carries this force in N.
    #[inline(always)]
    pub fn pressure(&self, force: S) -> S {
        self.filling_pressure + force / self.piston_area
    }

    /// The force in N through each spring, from the rod on: that through the sensor, then those of
    /// the springs behind the plugs, from their deflections in m.
    pub(crate) fn forces(&self, sensed: S, deflections: impl Iterator<Item = S>) -> Vec<S> {
        let behind = deflections.enumerate();
        let behind = behind.map(|(plug, deflection)| self.stiffness_behind(plug + 1) * deflection);
        [sensed].into_iter().chain(behind).collect()
    }

    /// The force in N through each spring, from the rod on, where the first carries `force` and all
    /// oil moves at a velocity in m/s.
    pub(crate) fn steady_forces(&self, force: S, velocity: S) -> Vec<S> {
        let lost = |plugs: usize| S::from(plugs as f64) * self.damping * velocity;
        (0..=self.segments).map(|plugs| force - lost(plugs)).collect()
    }

    /// Frequency in rad/s that no mode of it between a sensor and a load lies above: that of one
    /// plug between its two springs, by twice.
    ///
    /// ```text
    /// w^2 <= 2 (k_j + k_j+1)/m                                          Gershgorin's circles of K over m
    /// ```
    pub(crate) fn fastest_rad_per_s(&self) -> S {
        let between = |plug: usize| self.stiffness_behind(plug) + self.stiffness_behind(plug + 1);
        let stiffest = (0..self.segments).map(between).fold(S::from(0.0), |most, one| most.maximum(one));
        (S::from(2.0) * stiffest / self.mass).sqrt()
    }
}
