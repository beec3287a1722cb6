use phea_dynamics::scalar::Scalar;

use super::{Edges, Servovalve};

/// How oil changes with its temperature. Units: 1/degC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilLaw {
    /// Share by which the dynamic viscosity falls with each degree.
    pub viscosity_slope: f64,
    /// Share by which the density falls with each degree.
    pub density_slope: f64,
}

/// Oil at another temperature than the one that a valve is stated at, as ratios; both are one at
/// that temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarmOil {
    /// Density over that of the stated temperature.
    pub density_ratio: f64,
    /// Dynamic viscosity over that of the stated temperature.
    pub viscosity_ratio: f64,
}

/// That of mineral oil, with the viscosity of ISO VG 46 near 40 degC.
impl Default for OilLaw {
    fn default() -> OilLaw {
        OilLaw { viscosity_slope: 0.045, density_slope: 7e-4 }
    }
}

impl OilLaw {
    /// The oil that is warmer by some degrees.
    ///
    /// ```text
    /// rho/rho_0 = 1 - alpha (t - t_0)        mu/mu_0 = exp(-lambda_mu (t - t_0))             Merritt (1967), chapter 2
    /// ```
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::servovalve::OilLaw;
    /// let oil = OilLaw { viscosity_slope: 0.045, density_slope: 7e-4 }.warmer(10.0);
    /// assert!((oil.density_ratio - 0.993).abs() < 1e-12);
    /// assert!((oil.viscosity_ratio - 0.6376281516217733).abs() < 1e-12);
    /// ```
    pub fn warmer(&self, degrees: f64) -> WarmOil {
        WarmOil {
            density_ratio: 1.0 - self.density_slope * degrees,
            viscosity_ratio: Scalar::exp(-self.viscosity_slope * degrees),
        }
    }
}

impl WarmOil {
    /// The oil that the valve is stated at.
    pub const STATED: WarmOil = WarmOil { density_ratio: 1.0, viscosity_ratio: 1.0 };

    /// By what a turbulent flow coefficient grows: sqrt(rho_0/rho).
    pub fn turbulent_ratio(&self) -> f64 {
        (1.0 / self.density_ratio).sqrt()
    }

    /// Kinematic viscosity over that of the stated temperature.
    pub fn kinematic_viscosity_ratio(&self) -> f64 {
        self.viscosity_ratio / self.density_ratio
    }

    /// The valve as this oil flows through it.
    ///
    /// ```text
    /// K_vi, q_tare   proportional to sqrt(rho_0/rho)        turbulent
    /// K_vini         proportional to mu_0/mu                the clearances of the closed edges: laminar
    /// ```
    ///
    /// Flow through sharp edges and through the nozzles of the first stage is turbulent. What
    /// passes the clearance around null is laminar (Merritt 1967, chapter 5): in proportion to
    /// 1/mu. Its dependence on pressure stays that of the model.
    ///
    /// # Example
    /// A degree more changes the leakage sixty times as much as the flow.
    /// ```
    /// use phea_hydraulics::reference_rig::valve;
    /// use phea_hydraulics::servovalve::OilLaw;
    /// let warm = OilLaw { viscosity_slope: 0.045, density_slope: 7e-4 }.warmer(1.0).valve(&valve());
    /// assert!((warm.flow_coefficients.supply_to_a / 3.2e-7 - 1.00035).abs() < 1e-6);
    /// assert!((warm.leakage_coefficients.supply_to_a / valve().leakage_coefficients.supply_to_a - 1.046).abs() < 1e-4);
    /// ```
    pub fn valve<S: Scalar>(&self, valve: &Servovalve<S>) -> Servovalve<S> {
        let times = |edges: &Edges<S>, factor: f64| {
            Edges::from_array(edges.to_array().map(|coefficient| coefficient.times(factor)))
        };
        Servovalve {
            flow_coefficients: times(&valve.flow_coefficients, self.turbulent_ratio()),
            leakage_coefficients: times(&valve.leakage_coefficients, 1.0 / self.viscosity_ratio),
            tare_flow: valve.tare_flow.times(self.turbulent_ratio()),
            ..*valve
        }
    }
}
