//! Driving-point impedance: the resistance to a load that moves the actuator.
//!
//! ```text
//! Z(s) = -F_e/(s X_L)                          passive: Re Z(jw) >= 0 (thesis 2.2, with this sign)
//! open loop      Z = K_S (b_4 s^4 + ... + b_0)/D(s)                        second half of thesis (6.7)
//! closed loop    Z = K_S (b_4 s^4 + ... + b_0)/(D(s) + G(s) c_0)           second half of thesis (6.8)
//! ```

mod asymptote;
mod series;

pub use asymptote::{Asymptote, AsymptoteKind, compliance_hidden_above, impedance_asymptotes, through_oil};
pub use series::{closed_loop_port, port};

use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, TransferFunction};

use crate::linear::LinearModel;

/// Driving-point impedance Z = -F_e/(s X_L) at a constant valve command, N s/m.
///
/// # Errors
/// Load path without the zero at the origin that makes Z finite there.
///
/// # Example
/// The impedance to a slow load is the damper A_u^2/K_c of the valve's leakage plus the viscous
/// friction:
/// ```
/// use phea_hydraulics::impedance::open_loop_impedance;
/// use phea_hydraulics::linear::linear_model;
/// use phea_hydraulics::reference_rig::nominal_plant;
/// let plant = nominal_plant();
/// let impedance = open_loop_impedance(&linear_model(&plant)?)?;
/// let damper = plant.useful_area.powi(2) / plant.flow_pressure_coefficient;
/// assert!((impedance.dc_gain() / (damper + plant.viscous_friction) - 1.0).abs() < 1e-9);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn open_loop_impedance(model: &LinearModel) -> Result<TransferFunction, LinearError> {
    let origin = Complex64::new(0.0, 0.0);
    let motion = &model.load_position;
    let mut zeros = motion.zeros().to_vec();
    let mut poles = motion.poles().to_vec();
    match zeros.iter().position(|&zero| zero == origin) {
        Some(index) => drop(zeros.remove(index)),
        None => poles.push(origin),
    }
    TransferFunction::from_factors(-motion.gain(), zeros, poles)
}

/// Driving-point impedance with the force fed back through a controller G in V/N, U_C = G (F_ref -
/// F_e), N s/m.
///
/// ```text
/// Z = Z_open/(1 + G P)                                                 thesis (6.8)
/// ```
///
/// P and Z_open have common poles, those of the open loop, which cancel exactly.
///
/// # Errors
/// Controller that is sampled or has dead time: the impedance is then not a rational function.
///
/// # Example
/// A gain G divides the resistance to a slow load by 1 + G P(0):
/// ```
/// use phea_dynamics::linear::TransferFunction;
/// use phea_hydraulics::impedance::{closed_loop_impedance, open_loop_impedance};
/// use phea_hydraulics::linear::linear_model;
/// use phea_hydraulics::reference_rig::nominal_plant;
/// let model = linear_model(&nominal_plant())?;
/// let [open, closed] =
///     [open_loop_impedance(&model)?, closed_loop_impedance(&model, &TransferFunction::gain_only(1e-4))?];
/// let divided = open.dc_gain() / (1.0 + 1e-4 * model.command.dc_gain());
/// assert!((closed.dc_gain() / divided - 1.0).abs() < 1e-9);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn closed_loop_impedance(
    model: &LinearModel,
    controller: &TransferFunction,
) -> Result<TransferFunction, LinearError> {
    let open = open_loop_impedance(model)?;
    let forward = controller.series(&model.command)?;
    let closed = forward.feedback(&TransferFunction::gain_only(1.0))?;
    let mut zeros = open.zeros().to_vec();
    zeros.extend_from_slice(controller.poles());
    // 1/(1 + G P) has leading coefficient 1 unless G P is not strictly proper
    let sensitivity_gain = if forward.gain() == 0.0 { 1.0 } else { closed.gain() / forward.gain() };
    let mut poles = closed.poles().to_vec();
    for &pole in open.poles() {
        // poles of the load path only (of a plant whose two paths have different denominators) stay
        if !model.command.poles().contains(&pole) {
            poles.push(pole);
        }
    }
    TransferFunction::from_factors(open.gain() * sensitivity_gain, zeros, poles)
}

/// Force per load position of an impedance, -s Z, N/m; with the loop closed, second half of thesis
/// (6.8) times s.
///
/// # Errors
/// Factors that are not finite.
pub fn load_motion_of(impedance: &TransferFunction) -> Result<TransferFunction, LinearError> {
    let differentiator = TransferFunction::from_factors(-1.0, vec![Complex64::new(0.0, 0.0)], Vec::new())?;
    let product = impedance.series(&differentiator)?;
    Ok(product.without_common_factors(0.0))
}

/// Force that remains long after the load has stepped by `step` in m, N: zero by Proposition 6.2.
///
/// ```text
/// F_e(inf) = lim s (F_e/X_L) x_L0/s = (F_e/X_L)(0) x_L0                thesis (6.9) to (6.11)
/// ```
///
/// `None` when the path is unstable and there is no final value. The proposition needs leakage or
/// feedback: with K_c = 0 and a constant command the denominator vanishes at the origin as well,
/// and K_eq x_L0 stays.
///
/// # Example
/// Leakage of the valve releases the force, although its command is constant.
/// ```
/// use phea_hydraulics::impedance::final_force_after_load_step;
/// use phea_hydraulics::linear::linear_model;
/// use phea_hydraulics::reference_rig::nominal_plant;
/// let model = linear_model(&nominal_plant())?;
/// assert_eq!(final_force_after_load_step(&model.load_position, 1e-3), Some(0.0));
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn final_force_after_load_step(load_path: &TransferFunction, step: f64) -> Option<f64> {
    let path = load_path.without_common_factors(0.0);
    path.is_stable().then(|| path.dc_gain() * step)
}
