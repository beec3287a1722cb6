use num_complex::Complex64;
use phea_dynamics::controller::VirtualImpedance;
use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::{closed_loop_impedance, open_loop_impedance};
use crate::linear::{LinearModel, transfer_functions};
use crate::plant::{LinearLoad, LinearPlant, LinearSeries, SeriesOutput};

/// Actuator at its port to the load: the measured force per volt, and the force on the load per
/// motion of the load, both with a prescribed load motion.
///
/// # Errors
/// Coefficients that are not finite.
///
/// # Example
/// A spring limits the impedance: the load never meets more than the spring's own stiffness.
/// ```
/// use phea_hydraulics::impedance::{open_loop_impedance, port};
/// use phea_hydraulics::plant::{LinearElement, LinearLoad, LinearPlant, LinearSeries, LinearSpring, SeriesOutput};
/// # let plain = LinearPlant::of_load_pressure(
/// #     &phea_hydraulics::reference_rig::nominal_plant(), 0.0, LinearLoad::Prescribed);
/// let spring = LinearSpring { stiffness: 1e5, damping: None, mass: Some(2.0) };
/// let series = LinearSeries { element: LinearElement::Spring(spring), output: SeriesOutput::Sensor };
/// let felt = open_loop_impedance(&port(&LinearPlant { series: Some(series), ..plain })?)?;
/// let stiffness = felt.at_frequency(3e4).norm_sqr().sqrt() * 3e4;
/// assert!((stiffness / 1e5 - 1.0).abs() < 1e-2);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn port(plant: &LinearPlant) -> Result<LinearModel, LinearError> {
    let alone = LinearPlant { load: LinearLoad::Prescribed, ..*plant };
    let measured = transfer_functions(&alone.coefficients())?;
    let Some(series) = alone.series else { return sharing_poles(&alone, measured) };
    let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
    let felt = transfer_functions(&LinearPlant { series: Some(on_load), ..alone }.coefficients())?;
    let both = LinearModel { command: measured.command, load_position: felt.load_position };
    sharing_poles(&alone, both)
}

/// Coefficients of 1/H_v of a velocity that is fed forward within the plant, 1 without one: the
/// denominator of the load-motion path has it in addition to that of the command path.
fn fed_forward_filter(plant: &LinearPlant) -> Vec<f64> {
    match plant.load_velocity_feed_forward {
        Some(_) => plant.velocity_sensor.filter.denominator(),
        None => vec![1.0],
    }
}

/// Load-motion path with the poles of the command path, digit by digit, in addition to those of the
/// filter of a velocity that is fed forward: a loop around them cancels the common ones.
fn sharing_poles(plant: &LinearPlant, model: LinearModel) -> Result<LinearModel, LinearError> {
    let filter = fed_forward_filter(plant);
    if filter.len() == 1 {
        return Ok(model);
    }
    let of_filter =
        TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &Polynomial::new(filter))?;
    let path = &model.load_position;
    let poles = [model.command.poles(), of_filter.poles()].concat();
    let load_position = TransferFunction::from_factors(path.gain(), path.zeros().to_vec(), poles)?;
    Ok(LinearModel { load_position, ..model })
}

/// Driving-point impedance with the measured force fed back through a controller G in V/N, N s/m.
///
/// ```text
/// measured force that reaches the load      [`closed_loop_impedance`]
/// force sensor before a mass or oil         -s Z = (F_L/X_L - G beta F_L/U_C)/(1 + G F_s/U_C)
/// ```
///
/// The second is the general one: the force that the sensor measures and the load does not receive,
/// [`LinearSeries::held_back`], accelerates a mass, beta = m s^2, or the oil of a transmission,
/// including the flow into its line. A virtual impedance Z_v adds the response of the loop to the
/// motion:
///
/// ```text
/// Z -> Z + (Z_v/s) G F_L/U_C/(1 + G F_s/U_C)                  about Z_v/s if the loop gain is high
/// ```
///
/// # Errors
/// Errors of [`closed_loop_impedance`].
pub fn closed_loop_port(
    plant: &LinearPlant,
    controller: &TransferFunction,
) -> Result<TransferFunction, LinearError> {
    if let Some(impedance) = plant.virtual_impedance {
        let alone = LinearPlant { virtual_impedance: None, ..*plant };
        return closed_loop_port(&alone, controller)?.parallel(&beside(&impedance, &alone, controller)?);
    }
    let shaken = plant.series.filter(|series| series.output == SeriesOutput::Sensor);
    let Some((series, held_back)) = shaken.and_then(|series| Some((series, series.held_back()?))) else {
        return closed_loop_impedance(&port(plant)?, controller);
    };
    let alone = LinearPlant { load: LinearLoad::Prescribed, ..*plant };
    let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
    let felt = LinearPlant { series: Some(on_load), ..alone }.coefficients();
    let Some(RationalCoefficients { numerator: moved, denominator }) = felt.disturbance else {
        return open_loop_impedance(&port(plant)?);
    };
    let of = |coefficients: Vec<f64>| Polynomial::new(coefficients);
    // the motion path has the filter of a velocity that is fed forward, the command path has not
    let filter = of(fed_forward_filter(plant));
    let [over, under] = [controller.numerator(), controller.denominator()];
    let accelerated = of(held_back).scaled(-1.0).product(&of(felt.command.numerator));
    let measured = of(alone.coefficients().command.numerator);
    let moved = of(moved).product(&under).sum(&accelerated.product(&over).product(&filter));
    let closed = of(denominator).product(&under).sum(&measured.product(&over).product(&filter));
    // at rest the load feels no motion: the factor s
    let without_origin = moved.coefficients().split_last().map_or(Vec::new(), |(_, rest)| rest.to_vec());
    TransferFunction::from_polynomials(&of(without_origin).scaled(-1.0), &closed)
}

/// Contribution of a loop with a virtual impedance at its port, N s/m.
fn beside(
    impedance: &VirtualImpedance,
    plant: &LinearPlant,
    controller: &TransferFunction,
) -> Result<TransferFunction, LinearError> {
    let LinearModel { command: measured, .. } = port(plant)?;
    let followed = controller.series(&measured)?.feedback(&TransferFunction::gain_only(1.0))?;
    let shaken =
        plant.series.filter(|series| series.output == SeriesOutput::Sensor && series.held_back().is_some());
    let followed = match shaken {
        None => followed,
        Some(series) => {
            // F_L in place of F_s, with common denominators
            let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
            let alone = LinearPlant { load: LinearLoad::Prescribed, series: Some(on_load), ..*plant };
            let felt = transfer_functions(&alone.coefficients())?.command;
            let zeros = [felt.zeros(), controller.zeros()].concat();
            let gain = followed.gain() * felt.gain() / measured.gain();
            TransferFunction::from_factors(gain, zeros, followed.poles().to_vec())?
        }
    };
    let integrated = TransferFunction::from_factors(1.0, vec![], vec![Complex64::new(0.0, 0.0)])?;
    impedance.transfer_function()?.series(&integrated)?.series(&followed)
}
