use nalgebra::DMatrix;
use phea_dynamics::linear::{LinearError, StateSpace, TimeDomain};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};

use super::TwoPressureModel;
use crate::linear::polynomial::{product, scaled, shifted, sum};
use crate::operating_point::OperatingPoint;
use crate::servovalve::{ChamberCoefficients, SpoolDirection, chamber_coefficients};
use crate::stiffness::compliance_at;

/// Linearised two-pressure model: all parameters of its transfer functions. Units: m2, m3/Pa, m3/(s
/// V), m3/(s Pa), kg, N s/m, N/m, rad/s, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPressureLinearParameters<S = f64> {
    /// Piston areas A_A and A_B.
    pub areas: [S; 2],
    /// Compliances C_A and C_B at the position.
    pub compliances: [S; 2],
    /// Derivatives of the chamber flows.
    pub chambers: ChamberCoefficients<S>,
    /// Moving mass M.
    pub moving_mass: S,
    /// Viscous friction f_v.
    pub viscous_friction: S,
    /// Sensor stiffness K_S.
    pub sensor_stiffness: S,
    /// Natural frequency of the spool.
    pub valve_natural_frequency: S,
    /// Damping ratio of the spool.
    pub valve_damping_ratio: S,
}

/// Coefficients of the linearised model at an operating point; `direction` selects the edges that
/// open at null.
///
/// Areas and compliances are those of the position and constant: the other terms that depend on the
/// position are the net flow into the chambers, which vanishes at an equilibrium, and within a
/// transition of a telescopic piston
/// [`Cylinder::area_stiffness`](crate::cylinder::Cylinder::area_stiffness).
pub fn two_pressure_linear_parameters<S: Scalar>(
    model: &TwoPressureModel<S>,
    point: &OperatingPoint<S>,
    direction: SpoolDirection<S>,
) -> TwoPressureLinearParameters<S> {
    let OperatingPoint { position, command, pressure_a, pressure_b, .. } = *point;
    TwoPressureLinearParameters {
        areas: model.chambers.areas_at(position),
        compliances: compliance_at(&model.chambers, position),
        chambers: chamber_coefficients(
            &model.valve,
            &model.supply,
            command,
            pressure_a,
            pressure_b,
            direction,
        )
        .leaking(model.outward_slopes([pressure_a, pressure_b])),
        moving_mass: model.moving_mass,
        viscous_friction: model.viscous_friction,
        sensor_stiffness: model.sensor_stiffness,
        valve_natural_frequency: model.valve.natural_frequency,
        valve_damping_ratio: model.valve.damping_ratio,
    }
}

/// Linearised model as state space.
///
/// States as in [`super::TwoPressureState`]; inputs command U_C and load velocity v_L; outputs
/// force F_e, p_A and p_B; all deviations from the operating point.
///
/// # Errors
/// Coefficient that is not finite.
pub fn linearize(parameters: &TwoPressureLinearParameters) -> Result<StateSpace, LinearError> {
    let [area_a, area_b] = parameters.areas;
    let [compliance_a, compliance_b] = parameters.compliances;
    let ChamberCoefficients { flow_gain_a, flow_pressure_a, flow_gain_b, flow_pressure_b } =
        parameters.chambers;
    let (mass, stiffness) = (parameters.moving_mass, parameters.sensor_stiffness);
    let frequency = parameters.valve_natural_frequency;
    let square = frequency * frequency;
    let spool_damping = 2.0 * parameters.valve_damping_ratio * frequency;
    let friction = parameters.viscous_friction;
    #[rustfmt::skip]
    let a = DMatrix::from_row_slice(6, 6, &[
        0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
        -square, -spool_damping, 0.0, 0.0, 0.0, 0.0,
        flow_gain_a / compliance_a, 0.0, -flow_pressure_a / compliance_a, 0.0, 0.0, -area_a / compliance_a,
        -flow_gain_b / compliance_b, 0.0, 0.0, -flow_pressure_b / compliance_b, 0.0, area_b / compliance_b,
        0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
        0.0, 0.0, area_a / mass, -area_b / mass, -stiffness / mass, -friction / mass,
    ]);
    #[rustfmt::skip]
    let b = DMatrix::from_row_slice(6, 2, &[
        0.0, 0.0,
        square, 0.0,
        0.0, 0.0,
        0.0, 0.0,
        0.0, -1.0,
        0.0, 0.0,
    ]);
    #[rustfmt::skip]
    let c = DMatrix::from_row_slice(3, 6, &[
        0.0, 0.0, 0.0, 0.0, stiffness, 0.0,
        0.0, 0.0, 1.0, 0.0, 0.0, 0.0,
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
    ]);
    StateSpace::new(a, b, c, DMatrix::zeros(3, 2), TimeDomain::Continuous)
}

/// Linearised model as rational functions, F_e/U_C and F_e/X_L, over any scalar.
///
/// ```text
/// Y_A = C_A s + K_cA        Y_B = C_B s + K_cB        v(s) = s^2 + 2 xi_v w_nv s + w_nv^2
/// F_e = K_S (w_nv^2 (A_A K_qA Y_B + A_B K_qB Y_A) U_C
///            - v ((M s + f_v) Y_A Y_B + A_A^2 Y_B + A_B^2 Y_A) s X_L)
///       / (v ((M s^2 + f_v s + K_S) Y_A Y_B + s (A_A^2 Y_B + A_B^2 Y_A)))
/// ```
///
/// From the equations at the top of [`crate::two_pressure`]; sixth order. At mid stroke of a
/// symmetric cylinder with equal edges Y_A = Y_B is a common factor, and the remainder is thesis
/// (6.7).
///
/// # Example
/// With a stationary load the flow of each chamber is zero, and its pressure K_q/K_c per volt: the
/// force per volt is A_A K_qA/K_cA + A_B K_qB/K_cB:
/// ```
/// use phea_hydraulics::actuator::Actuator;
/// use phea_hydraulics::line::StiffeningMember;
/// use phea_hydraulics::linear::transfer_functions;
/// use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// use phea_hydraulics::reference_rig::{components, hose_line};
/// use phea_hydraulics::servovalve::SpoolDirection;
/// use phea_hydraulics::stiffness::StiffnessModel;
/// use phea_hydraulics::two_pressure::{
///     TwoPressureModel, linearize, two_pressure_coefficients, two_pressure_linear_parameters,
/// };
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let pressures = [point.pressure_a, point.pressure_b];
/// let model = TwoPressureModel::new(&actuator, pressures, StiffeningMember::Nominal, 100.0);
/// let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
/// let ([area_a, area_b], chambers) = (parameters.areas, parameters.chambers);
/// let expected = area_a * chambers.flow_gain_a / chambers.flow_pressure_a
///     + area_b * chambers.flow_gain_b / chambers.flow_pressure_b;
/// let rational = transfer_functions(&two_pressure_coefficients(&parameters))?.command;
/// assert!((rational.dc_gain() / expected - 1.0).abs() < 1e-9);
/// // the matrices say the same
/// let [command, force] = [0, 0];
/// let matrices = linearize(&parameters)?.at_frequency(0.0, command, force)?;
/// assert!((matrices.re / expected - 1.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn two_pressure_coefficients<S: Scalar>(
    parameters: &TwoPressureLinearParameters<S>,
) -> PlantCoefficients<S> {
    let (zero, one) = (S::from(0.0), S::from(1.0));
    let [area_a, area_b] = parameters.areas;
    let [compliance_a, compliance_b] = parameters.compliances;
    let coefficients = &parameters.chambers;
    let admittance_a = [compliance_a, coefficients.flow_pressure_a];
    let admittance_b = [compliance_b, coefficients.flow_pressure_b];
    let both = product(&admittance_a, &admittance_b);
    let driving = sum(
        &scaled(area_a * coefficients.flow_gain_a, &admittance_b),
        &scaled(area_b * coefficients.flow_gain_b, &admittance_a),
    );
    let spring = sum(&scaled(area_a.squared(), &admittance_b), &scaled(area_b.squared(), &admittance_a));
    let (mass, friction) = (parameters.moving_mass, parameters.viscous_friction);
    let (stiffness, frequency) = (parameters.sensor_stiffness, parameters.valve_natural_frequency);
    let square = frequency.squared();
    let spool = [one, S::from(2.0) * parameters.valve_damping_ratio * frequency, square];
    let piston = sum(&product(&[mass, friction], &both), &spring);
    let sensed = sum(&product(&[mass, friction, stiffness], &both), &shifted(&spring));
    let denominator = product(&spool, &sensed);
    let disturbance = shifted(&scaled(-stiffness, &product(&spool, &piston)));
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: scaled(stiffness * square, &driving),
            denominator: denominator.clone(),
        },
        disturbance: Some(RationalCoefficients { numerator: disturbance, denominator }),
        dead_time_s: zero,
        rate: None,
    }
}
