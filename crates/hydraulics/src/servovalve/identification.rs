//! Predicted results of static tests of a valve for given coefficients, with derivatives.

use std::borrow::Cow;

use phea_dynamics::scalar::{Dual, Parameters, Scalar};

use super::ports::KnownPorts;
use super::{
    Edges, LeakageModel, LeakageShape, OpeningLaw, OpeningShape, PortState, Servovalve, SlowSpool,
    SpoolImperfection, Supply, WarmOil, blocked_ports, connected_ports, edge_conductances, tare_flow,
};

/// Number of coefficients of a valve that static tests determine.
pub const STATIC_COEFFICIENTS: usize = 18;

/// Number with its derivatives with respect to all static coefficients.
pub type Sensitive = Dual<STATIC_COEFFICIENTS>;

/// Coefficients of a valve that static tests determine. Units: m3/(s Pa^0.5), m3/s, V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticCoefficients<S = f64> {
    /// Flow coefficients K_v3 to K_v6.
    pub flow_coefficients: Edges<S>,
    /// Leakage coefficients K_vin3 to K_vin6.
    pub leakage_coefficients: Edges<S>,
    /// Shape lambda of the leakage of each edge; that of edge 3 applies to all if
    /// [`ValveTerms::leakage_by_edge`] is not set.
    pub leakage_shapes: Edges<S>,
    /// Tare flow q_tare at the reference drop.
    pub tare_flow: S,
    /// Spool position U_0 at which the valve is at null.
    pub null_bias: S,
    /// Width of the hysteresis, positive.
    pub hysteresis_width: S,
    /// Lap and saturation of the edges.
    pub opening: OpeningShape<S>,
}

/// Optional properties of a valve under test, in addition to edges that open in proportion and leak
/// in one shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ValveTerms {
    /// True if the edges have a lap.
    pub lap: bool,
    /// True if the openings saturate.
    pub saturation: bool,
    /// True if the leakage of each edge has its own shape.
    pub leakage_by_edge: bool,
}

impl<S: Copy> StaticCoefficients<S> {
    /// Flow and leakage coefficients of edges 3, 4, 5, 6, the shape of edge 3, tare flow, null
    /// bias, hysteresis, both laps, saturation, and the shapes of edges 4, 5, 6.
    pub fn to_array(&self) -> [S; STATIC_COEFFICIENTS] {
        let [f3, f4, f5, f6] = self.flow_coefficients.to_array();
        let [l3, l4, l5, l6] = self.leakage_coefficients.to_array();
        let [s3, s4, s5, s6] = self.leakage_shapes.to_array();
        let [tare, bias, width] = [self.tare_flow, self.null_bias, self.hysteresis_width];
        let OpeningShape { lap_positive, lap_negative, saturation } = self.opening;
        [
            f3,
            f4,
            f5,
            f6,
            l3,
            l4,
            l5,
            l6,
            s3,
            tare,
            bias,
            width,
            lap_positive,
            lap_negative,
            saturation,
            s4,
            s5,
            s6,
        ]
    }

    /// Coefficients from numbers in this order.
    pub fn from_array(numbers: [S; STATIC_COEFFICIENTS]) -> StaticCoefficients<S> {
        let [f3, f4, f5, f6, l3, l4, l5, l6, s3, tare, bias, width, positive, negative, c, s4, s5, s6] =
            numbers;
        StaticCoefficients {
            flow_coefficients: Edges::from_array([f3, f4, f5, f6]),
            leakage_coefficients: Edges::from_array([l3, l4, l5, l6]),
            leakage_shapes: Edges::from_array([s3, s4, s5, s6]),
            tare_flow: tare,
            null_bias: bias,
            hysteresis_width: width,
            opening: OpeningShape { lap_positive: positive, lap_negative: negative, saturation: c },
        }
    }
}

/// Piping of the ports in a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortCircuit {
    /// Both ports shut.
    Blocked,
    /// Ports joined through a meter.
    Connected,
}

/// Conditions of one row of a test. Units: V, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestInput {
    /// Recorded command U_C.
    pub command: f64,
    /// Command without the noise of its record: the memories of the spool follow it.
    pub followed_command: f64,
    /// Command at which it reversed between the previous row and this one, if that lies beyond
    /// both, V.
    pub turn: Option<f64>,
    /// Supply and tank pressure.
    pub supply: Supply,
    /// Load pressure p_A - p_B across the meter, if the ports are joined.
    pub load_pressure: f64,
    /// Oil, relative to that for which the coefficients are stated.
    pub oil: WarmOil,
    /// Lag z of the torque motor's iron at the first row, V.
    pub memory: f64,
    /// Lag of the spool behind a moving command, V: [`super::ramp_delay`] times its rate.
    pub lag: f64,
}

impl TestInput {
    /// Row whose command is known without noise, with the oil for which the valve is stated.
    pub fn new(command: f64, supply: Supply, load_pressure: f64) -> TestInput {
        TestInput {
            command,
            followed_command: command,
            turn: None,
            supply,
            load_pressure,
            oil: WarmOil::STATED,
            memory: 0.0,
            lag: 0.0,
        }
    }
}

/// Results of one row of a test. Units: Pa, m3/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOutput<S = f64> {
    /// Pressure p_A.
    pub pressure_a: S,
    /// Pressure p_B.
    pub pressure_b: S,
    /// Flow from the supply, tare flow included.
    pub leak_flow: S,
    /// Flow from port A to port B.
    pub port_flow: S,
}

impl TestOutput<Sensitive> {
    /// Weighted sum of p_A, p_B, leakage and port flow.
    pub fn combined(&self, weights: [f64; 4]) -> Sensitive {
        let all = [self.pressure_a, self.pressure_b, self.leak_flow, self.port_flow];
        let shown = all.into_iter().zip(weights).filter(|(_, weight)| *weight != 0.0);
        shown.fold(Sensitive::from(0.0), |sum, (signal, weight)| sum + signal.times(weight))
    }

    /// Results without derivatives.
    pub fn values(&self) -> TestOutput {
        TestOutput {
            pressure_a: self.pressure_a.value(),
            pressure_b: self.pressure_b.value(),
            leak_flow: self.leak_flow.value(),
            port_flow: self.port_flow.value(),
        }
    }
}

/// Known data of a valve under test before its coefficients are identified. Units: V, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestedValve {
    /// Command of full opening U_Cn.
    pub nominal_voltage: f64,
    /// Drop below which an edge's flow is laminar.
    pub transition_pressure: f64,
    /// Drop at which the tare flow is stated.
    pub tare_reference_drop: f64,
    /// Meaning of lambda and the leakage coefficients away from null.
    pub leakage_model: LeakageModel,
    /// Optional properties in addition to edges that open in proportion.
    pub terms: ValveTerms,
}

impl TestedValve {
    /// Predicted results of a slow test row by row, starting from the spool memory stated in the
    /// first row.
    ///
    /// Equations: [`blocked_ports`], [`connected_ports`], [`tare_flow`],
    /// [`SpoolImperfection::slow_opening`].
    pub fn outputs(
        &self,
        coefficients: &StaticCoefficients,
        circuit: PortCircuit,
        inputs: &[TestInput],
    ) -> Vec<TestOutput> {
        let valve = self.servovalve(coefficients);
        let openings = openings(&valve.spool, inputs);
        let one = |(input, opening): (&TestInput, f64)| {
            let valve = valve_in(&valve, input.oil);
            let found = match circuit {
                PortCircuit::Blocked => blocked_ports(&valve, &input.supply, opening),
                PortCircuit::Connected => {
                    connected_ports(&valve, &input.supply, opening, input.load_pressure)
                }
            };
            let tare = tare_flow(&valve, &input.supply);
            let PortState { pressure_a, pressure_b, supply_flow, port_flow } = found;
            TestOutput { pressure_a, pressure_b, leak_flow: supply_flow + tare, port_flow }
        };
        inputs.iter().zip(openings).map(one).collect()
    }

    /// Results with derivatives with respect to all coefficients, in their order.
    ///
    /// Port states are found over plain numbers; one more Newton step over numbers with derivatives
    /// yields the derivatives.
    ///
    /// # Example
    /// The leakage contains the whole tare flow, at any spool position:
    /// ```
    /// use phea_hydraulics::servovalve::{
    ///     Edges, LeakageModel, OpeningShape, PortCircuit, StaticCoefficients, Supply, TestInput, TestedValve, ValveTerms,
    /// };
    /// let tested = TestedValve {
    ///     nominal_voltage: 10.0, transition_pressure: 1e3, tare_reference_drop: 70e5,
    ///     leakage_model: LeakageModel::EachEdge, terms: ValveTerms::default(),
    /// };
    /// let coefficients = StaticCoefficients {
    ///     flow_coefficients: Edges::equal(3e-7), leakage_coefficients: Edges::equal(2e-9),
    ///     leakage_shapes: Edges::equal(100.0),
    ///     tare_flow: 7.55e-6, null_bias: 0.0, hysteresis_width: 0.1, opening: OpeningShape::default(),
    /// };
    /// let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
    /// let inputs = [TestInput::new(0.3, supply, 0.0)];
    /// let found = tested.sensitive_outputs(&coefficients, PortCircuit::Blocked, &inputs);
    /// assert!((found[0].leak_flow.gradient()[9] - 1.0).abs() < 1e-12);
    /// ```
    pub fn sensitive_outputs(
        &self,
        coefficients: &StaticCoefficients,
        circuit: PortCircuit,
        inputs: &[TestInput],
    ) -> Vec<TestOutput<Sensitive>> {
        let known = self.outputs(coefficients, circuit, inputs);
        let mut index = 0;
        let open = coefficients.to_array().map(|value| {
            index += 1;
            Sensitive::variable(value, index - 1)
        });
        let open = StaticCoefficients::from_array(open);
        let valve = self.servovalve(&open);
        let one = |((input, known), opening): ((&TestInput, &TestOutput), Sensitive)| {
            let ports = KnownPorts {
                circuit,
                supply: input.supply,
                transition_pressure: self.transition_pressure,
                pressures: [known.pressure_a, known.pressure_b],
            };
            let valve = valve_in(&valve, input.oil);
            let edges = edge_conductances(&valve, opening).to_array();
            let [pressure_a, pressure_b, supply_flow, port_flow] = Sensitive::local(&ports, edges);
            let supply = input.supply.convert(&mut Sensitive::from);
            let tare = tare_flow(&valve, &supply);
            TestOutput { pressure_a, pressure_b, leak_flow: supply_flow + tare, port_flow }
        };
        inputs.iter().zip(&known).zip(openings(&valve.spool, inputs)).map(one).collect()
    }

    fn servovalve<S: Scalar>(&self, coefficients: &StaticCoefficients<S>) -> Servovalve<S> {
        let shapes = coefficients.leakage_shapes;
        Servovalve {
            flow_coefficients: coefficients.flow_coefficients,
            opening: match self.terms {
                ValveTerms { lap: false, saturation: false, .. } => OpeningLaw::Proportional,
                _ => OpeningLaw::Shaped(coefficients.opening),
            },
            leakage_coefficients: coefficients.leakage_coefficients,
            leakage_shape: match self.terms.leakage_by_edge {
                true => LeakageShape::ByEdge(shapes),
                false => LeakageShape::Common(shapes.supply_to_a),
            },
            leakage_model: self.leakage_model,
            tare_flow: coefficients.tare_flow,
            tare_reference_drop: S::from(self.tare_reference_drop),
            nominal_voltage: S::from(self.nominal_voltage),
            // a spool at rest has no dynamics
            natural_frequency: S::from(1.0),
            damping_ratio: S::from(1.0),
            transition_pressure: S::from(self.transition_pressure),
            spool: SpoolImperfection {
                null_bias: coefficients.null_bias,
                hysteresis_width: Some(coefficients.hysteresis_width),
                threshold: None,
                rate_limit: None,
            },
        }
    }
}

/// Valve with this oil: the valve itself if it is stated for this oil. A copy of it with
/// derivatives, row by row, takes a fifth of an identification.
fn valve_in<S: Scalar>(valve: &Servovalve<S>, oil: WarmOil) -> Cow<'_, Servovalve<S>> {
    if oil == WarmOil::STATED { Cow::Borrowed(valve) } else { Cow::Owned(oil.valve(valve)) }
}

/// Position of the edges in V row by row.
fn openings<S: Scalar>(spool: &SpoolImperfection<S>, inputs: &[TestInput]) -> Vec<S> {
    let mut memory = None;
    let begun = |input: &TestInput, followed| SlowSpool {
        magnetic_lag: S::from(input.memory),
        ..SlowSpool::at(followed)
    };
    let one = |input: &TestInput| {
        let followed = S::from(input.followed_command);
        let memory = memory.get_or_insert_with(|| begun(input, followed));
        if let Some(turn) = input.turn {
            spool.slow_opening(memory, S::from(turn));
        }
        let opening = spool.slow_opening(memory, followed);
        opening + S::from(input.command - input.followed_command - input.lag)
    };
    inputs.iter().map(one).collect()
}
