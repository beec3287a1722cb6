use phea_dynamics::scalar::Scalar;

use super::{Edges, Servovalve};

/// Temperature dependence of oil. Units: 1/degC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilLaw {
    /// Relative decrease of the dynamic viscosity per degree.
    pub viscosity_slope: f64,
    /// Relative decrease of the density per degree.
    pub density_slope: f64,
}

/// Oil at another temperature than that for which a valve is stated, as ratios; both are one at
/// that temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarmOil {
    /// Ratio of the density to that at the stated temperature.
    pub density_ratio: f64,
    /// Ratio of the dynamic viscosity to that at the stated temperature.
    pub viscosity_ratio: f64,
}

/// Mineral oil with the viscosity of ISO VG 46 near 40 degC.
impl Default for OilLaw {
    fn default() -> OilLaw {
        OilLaw { viscosity_slope: 0.045, density_slope: 7e-4 }
    }
}

impl OilLaw {
    /// Oil that is warmer by some degrees.
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
    /// Oil for which the valve is stated.
    pub const STATED: WarmOil = WarmOil { density_ratio: 1.0, viscosity_ratio: 1.0 };

    /// Factor by which a turbulent flow coefficient grows: sqrt(rho_0/rho).
    pub fn turbulent_ratio(&self) -> f64 {
        (1.0 / self.density_ratio).sqrt()
    }

    /// Ratio of the kinematic viscosity to that at the stated temperature.
    pub fn kinematic_viscosity_ratio(&self) -> f64 {
        self.viscosity_ratio / self.density_ratio
    }

    /// Valve with this oil.
    ///
    /// ```text
    /// K_vi, q_tare   proportional to sqrt(rho_0/rho)        turbulent
    /// K_vini         proportional to mu_0/mu                the clearances of the closed edges: laminar
    /// ```
    ///
    /// Flow through sharp edges and through the nozzles of the first stage is turbulent. Flow
    /// through the clearance around null is laminar (Merritt 1967, chapter 5): proportional to
    /// 1/mu. Its dependence on pressure remains that of the model.
    ///
    /// # Example
    /// A degree more changes the leakage sixty times as much as the flow:
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
