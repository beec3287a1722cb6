use std::f64::consts::FRAC_PI_4;

use num_complex::Complex64;
use phea_dynamics::portable::sqrt_complex;

use super::transmission_line::check_end_share;
use super::travelling_waves::WaveData;
use super::{BraidedWall, Conduit, Hose, LineError, LineResponse, StiffeningMember, TravellingWaves};
use crate::fluid::Fluid;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Hose along which two waves travel in each direction, coupled through fluid and wall, held at
/// both ends.
pub type TwoWaveLine<S = f64> = TravellingWaves<2, S>;

/// Hose whose wall moves along its axis, after Johnston (2006).
///
/// ```text
/// rho v_t = -p_x                 m u_t = F_x                  v, u velocities of fluid and wall
/// v_x = -(1/B + C_pp) p_t - C_pF F_t         u_x = A C_pF p_t + C_FF F_t
/// lambda = 1/c^2:  (lambda - lf)(lambda - lw) = A rho m C_pF^2,    lf = rho (1/B + C_pp),  lw = m C_FF
/// N_i = u/v = (lf - lambda_i)/(C_pF m)       N_1 N_2 = -rho A/m
/// v_1 = q/(A (1 - N_1/N_2)),  v_2 = q/(A (1 - N_2/N_1))        u = 0 at the ends; thesis (4.39), (4.40), corrected
/// p = p_1 + p_2,  Z_i = rho c_i/(A (1 - N_i/N_j))              thesis (4.36), (4.38) over the area
/// ```
///
/// With the wall held at both ends both waves have the same flow and their pressures add. So the
/// hose is calculated as two lines of impedances Z_i in series at both ends: [`TravellingWaves`].
/// Friction acts between fluid and wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoWaveHose {
    /// Length L, m.
    pub length: f64,
    /// Bore, m.
    pub bore: f64,
    /// Density of the fluid rho, kg/m3.
    pub density: f64,
    /// Kinematic viscosity of the fluid nu, m2/s.
    pub kinematic_viscosity: f64,
    /// Bulk modulus B of the fluid without wall, Pa.
    pub fluid_modulus: f64,
    /// Wall of the hose.
    pub wall: BraidedWall,
}

/// Wave of the hose, without friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoseWave {
    /// Speed c_i, m/s.
    pub speed: f64,
    /// Ratio N_i of wall velocity to fluid velocity; infinite for a wave of the wall only.
    pub modal_ratio: f64,
    /// Impedance rho c_i/(A (1 - N_i/N_j)) of the line that represents this wave, Pa s/m3.
    pub impedance: f64,
    /// Effect of the friction factor's excess N - 1 on this wave: lambda_i grows by (N - 1) times
    /// this fraction, to first order.
    pub friction_fraction: f64,
}

impl TwoWaveHose {
    /// Hose of this length filled with a fluid at a mean gauge pressure in Pa, with the bore of
    /// [`Hose::filled`]; `wall` for this `member`.
    pub fn new(hose: &Hose, length: f64, fluid: &Fluid, pressure: f64, wall: BraidedWall) -> TwoWaveHose {
        TwoWaveHose {
            length,
            bore: hose.filled().bore,
            density: fluid.density,
            kinematic_viscosity: fluid.kinematic_viscosity,
            fluid_modulus: fluid.modulus_at(pressure),
            wall,
        }
    }

    /// Hose with the assumed wall of a half-inch hose: [`BraidedWall::assumed`].
    pub fn assumed(
        hose: &Hose,
        length: f64,
        fluid: &Fluid,
        pressure: f64,
        member: StiffeningMember,
    ) -> TwoWaveHose {
        TwoWaveHose::new(hose, length, fluid, pressure, BraidedWall::assumed(hose, member))
    }

    /// Impossible parameters of this hose; empty if there are none. A length of zero is possible
    /// here.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("fluid_modulus", self.fluid_modulus);
        problems.component("wall", self.wall.problems());
        // Energy is positive only if pressure with fixed ends widens the hose.
        let modulus = self.fixed_end_conduit().effective_bulk_modulus;
        problems.require("fixed_end_modulus", modulus, modulus > 0.0, ParameterRequirement::PassiveWall);
        let mut all = problems.into_vec();
        let geometry = Conduit { effective_bulk_modulus: 1.0, ..self.fixed_end_conduit() };
        all.extend(geometry.problems());
        all
    }

    /// Conduit of this hose with one wave: its modulus at rest between fixed ends.
    ///
    /// ```text
    /// 1/beta_e = 1/B + C_pp - A C_pF^2/C_FF
    /// ```
    pub fn fixed_end_conduit(&self) -> Conduit {
        let BraidedWall { pressure_compliance, coupling_compliance, axial_compliance, .. } = self.wall;
        let fixed =
            pressure_compliance - self.area() * coupling_compliance * coupling_compliance / axial_compliance;
        Conduit {
            length: self.length,
            bore: self.bore,
            density: self.density,
            kinematic_viscosity: self.kinematic_viscosity,
            effective_bulk_modulus: 1.0 / (1.0 / self.fluid_modulus + fixed),
        }
    }

    fn area(&self) -> f64 {
        FRAC_PI_4 * self.bore * self.bore
    }

    /// Both waves without friction, the slower one first.
    ///
    /// # Example
    /// The modal ratios obey N_1 N_2 = -rho A/m.
    /// ```
    /// use phea_hydraulics::line::{StiffeningMember, TwoWaveHose};
    /// use phea_hydraulics::reference_rig::{components, hose, hose_line};
    /// use phea_hydraulics::stiffness::StiffnessModel;
    /// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
    /// let hose = TwoWaveHose::assumed(&hose(), 1.5, &fluid, 35e5, StiffeningMember::Nominal);
    /// let [slow, fast] = hose.waves();
    /// let masses = -870.0 * hose.fixed_end_conduit().area() / hose.wall.mass_per_length;
    /// assert!((slow.modal_ratio * fast.modal_ratio / masses - 1.0).abs() < 1e-12);
    /// assert!(slow.speed < 535.0 && fast.speed > 535.0);
    /// ```
    pub fn waves(&self) -> [HoseWave; 2] {
        let BraidedWall { mass_per_length, coupling_compliance, axial_compliance, .. } = self.wall;
        let (mass, fluid_mass) = (mass_per_length, self.density * self.area());
        let fluid = self.density * (1.0 / self.fluid_modulus + self.wall.pressure_compliance);
        let wall = mass * axial_compliance;
        let coupling = fluid_mass * mass * coupling_compliance * coupling_compliance;
        let spread = (0.25 * (fluid - wall) * (fluid - wall) + coupling).sqrt();
        let slower = 0.5 * (fluid + wall) + spread;
        // the product of both, without cancellation
        let faster = (fluid * wall - coupling) / slower;
        let wave = |own: f64, other: f64| {
            let is_of_the_fluid = (own - fluid).abs() <= (own - wall).abs();
            let modal_ratio = if is_of_the_fluid {
                -fluid_mass * coupling_compliance / (own - wall)
            } else {
                (fluid - own) / (coupling_compliance * mass)
            };
            let inverse = 1.0 / modal_ratio;
            let friction_fraction = if modal_ratio.abs() < 1.0 {
                fluid_mass * (1.0 - modal_ratio) * (1.0 - modal_ratio)
                    / (fluid_mass + mass * modal_ratio * modal_ratio)
            } else {
                fluid_mass * (inverse - 1.0) * (inverse - 1.0) / (fluid_mass * inverse * inverse + mass)
            };
            let speed = 1.0 / own.sqrt();
            let impedance = self.density * speed / self.area() * (fluid - other) / (own - other);
            HoseWave { speed, modal_ratio, impedance, friction_fraction }
        };
        [wave(slower, faster), wave(faster, slower)]
    }

    /// Response of the exact hose, both ends of its wall held, at s in rad/s, for this factor of
    /// the fluid's inertia: 1 without friction, [`super::friction_factor`] with it.
    pub fn response(&self, s: Complex64, factor: Complex64) -> LineResponse {
        let BraidedWall { mass_per_length, coupling_compliance, axial_compliance, .. } = self.wall;
        let area = self.area();
        let radial = 1.0 / self.fluid_modulus + self.wall.pressure_compliance;
        // inertia [m_vv m_vu; m_uv m_uu] of fluid and wall, friction couples the two
        let drag = self.density * (factor - 1.0);
        let (m_vv, m_vu) = (self.density + drag, -drag);
        let (m_uv, m_uu) = (-area * drag, mass_per_length + area * drag);
        let l_vv = radial * m_vv - coupling_compliance * m_uv;
        let l_vu = radial * m_vu - coupling_compliance * m_uu;
        let l_uv = -area * coupling_compliance * m_vv + axial_compliance * m_uv;
        let l_uu = -area * coupling_compliance * m_vu + axial_compliance * m_uu;
        let spread = sqrt_complex((l_vv - l_uu) * (l_vv - l_uu) / 4.0 + l_vu * l_uv);
        let middle = (l_vv + l_uu) / 2.0;
        let line = |own: Complex64, other: Complex64| {
            let slowness = sqrt_complex(own);
            let impedance = (m_vv * (other - l_vv) - m_vu * l_uv) / ((other - own) * slowness * area);
            LineResponse::of_wave(impedance, s * slowness * self.length)
        };
        let (one, two) = (line(middle + spread, middle - spread), line(middle - spread, middle + spread));
        LineResponse {
            in_phase: one.in_phase + two.in_phase,
            in_opposition: one.in_opposition + two.in_opposition,
        }
    }

    /// Hose in time, with `end_share` of its compliance at each end as a plain volume as in
    /// [`super::TransmissionLine::of_conduit`].
    ///
    /// The friction of wave i is that of a line with one wave whose dissipation number is nu
    /// T_i/R^2 times the square of [`HoseWave::friction_fraction`]: accurate to first order in the
    /// thickness of the boundary layer. The mixing of the waves by friction is omitted, so that the
    /// resonance of a wave in which the wall moves with the fluid, which friction hardly damps, is
    /// too sharp. The steady resistance is exact.
    ///
    /// # Errors
    /// Hose that is impossible, has no length, is overdamped, or whose wall is so light that
    /// friction mixes its waves ([`LineError::MixedByFriction`]); a fraction not between 0 and 1/2.
    pub fn in_time(&self, end_share: f64) -> Result<TwoWaveLine, LineError> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(LineError::Impossible { problems });
        }
        let conduit = self.fixed_end_conduit();
        conduit.check()?;
        check_end_share(end_share)?;
        let root = (1.0 - 2.0 * end_share).sqrt();
        let of_wave = |wave: HoseWave| {
            let delay = self.length / wave.speed * root;
            let friction = conduit.viscous_rate() * wave.friction_fraction * wave.friction_fraction;
            WaveData { impedance: wave.impedance / root, delay, dissipation: friction * delay }
        };
        // the steady resistance lags like the faster wave
        let [slower, faster] = self.waves().map(of_wave);
        let waves = [faster, slower];
        TravellingWaves::new(waves, end_share * conduit.compliance(), conduit.steady_resistance())
    }
}
