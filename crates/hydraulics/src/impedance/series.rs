use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::{closed_loop_impedance, open_loop_impedance};
use crate::linear::{LinearModel, transfer_functions};
use crate::plant::{LinearLoad, LinearPlant, LinearSeries, SeriesOutput};

/// The actuator as its load meets it: the measured force per volt, and the force on the load per
/// motion of the load, both at a load whose motion is prescribed.
///
/// # Errors
/// Coefficients that are not finite.
///
/// # Example
/// A spring is felt through: the load never meets more than the spring's own stiffness.
/// ```
/// use phea_hydraulics::impedance::{open_loop_impedance, port};
/// use phea_hydraulics::plant::{LinearLoad, LinearPlant, LinearSeries, SeriesOutput};
/// # let plain = LinearPlant::of_load_pressure(
/// #     &phea_hydraulics::reference_rig::nominal_plant(), 0.0, LinearLoad::Prescribed);
/// let series = LinearSeries { stiffness: 1e5, damping: None, mass: Some(2.0), output: SeriesOutput::Sensor };
/// let felt = open_loop_impedance(&port(&LinearPlant { series: Some(series), ..plain })?)?;
/// let stiffness = felt.at_frequency(3e4).norm_sqr().sqrt() * 3e4;
/// assert!((stiffness / 1e5 - 1.0).abs() < 1e-2);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn port(plant: &LinearPlant) -> Result<LinearModel, LinearError> {
    let alone = LinearPlant { load: LinearLoad::Prescribed, ..*plant };
    let measured = transfer_functions(&alone.coefficients())?;
    let Some(series) = alone.series else { return Ok(measured) };
    let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
    let felt = transfer_functions(&LinearPlant { series: Some(on_load), ..alone }.coefficients())?;
    Ok(LinearModel { command: measured.command, load_position: felt.load_position })
}

/// Driving-point impedance in N s/m with the measured force fed back through a controller G in V/N.
///
/// ```text
/// measured force that reaches the load      [`closed_loop_impedance`]
/// force sensor before a mass m              -s Z = (F_L/X_L - G m s^2 F_L/U_C)/(1 + G F_s/U_C)
/// ```
///
/// The second is the general one: what the sensor measures and the load does not feel is the
/// acceleration of the mass.
///
/// # Errors
/// As [`closed_loop_impedance`].
pub fn closed_loop_port(
    plant: &LinearPlant,
    controller: &TransferFunction,
) -> Result<TransferFunction, LinearError> {
    let shaken = plant.series.filter(|series| series.output == SeriesOutput::Sensor);
    let Some((series, mass)) = shaken.and_then(|series| Some((series, series.mass?))) else {
        return closed_loop_impedance(&port(plant)?, controller);
    };
    let alone = LinearPlant { load: LinearLoad::Prescribed, ..*plant };
    let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
    let felt = LinearPlant { series: Some(on_load), ..alone }.coefficients();
    let Some(RationalCoefficients { numerator: moved, denominator }) = felt.disturbance else {
        return open_loop_impedance(&port(plant)?);
    };
    let of = |coefficients: Vec<f64>| Polynomial::new(coefficients);
    let [over, under] = [controller.numerator(), controller.denominator()];
    let accelerated = of(vec![-mass, 0.0, 0.0]).product(&of(felt.command.numerator));
    let measured = of(alone.coefficients().command.numerator);
    let moved = of(moved).product(&under).sum(&accelerated.product(&over));
    let closed = of(denominator).product(&under).sum(&measured.product(&over));
    // at rest no motion is felt: the factor s
    let without_origin = moved.coefficients().split_last().map_or(Vec::new(), |(_, rest)| rest.to_vec());
    TransferFunction::from_polynomials(&of(without_origin).scaled(-1.0), &closed)
}
