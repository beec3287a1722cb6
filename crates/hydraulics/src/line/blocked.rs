use num_complex::Complex64;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::System;

use super::{DynamicLine, Line, LineError, LineModel, StiffeningMember};
use crate::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid, bulk_modulus_with_air};

/// Line on a test stand: flow enters at its valve end, its other end is blocked.
///
/// ```text
/// C_end(p) dp/dt = q_end        q_end from DynamicLine, p the pressure at the blocked end
/// C_end(p) = C_end + V (1/beta(p) - 1/beta(p_m))          a lumped line whose fluid contains air
/// ```
///
/// As in the machine, air makes a lumped line softer at low pressure, and a line with inertance or
/// waves has the modulus at its mean pressure p_m. The input is the flow in m3/s, followed by the
/// arriving waves; its states are the pressure at the blocked end in Pa and those of the line.
///
/// # Example
/// The compliance takes up a slow flow:
/// ```
/// use num_complex::Complex64;
/// use phea_hydraulics::line::{BlockedLine, LineModel, StiffeningMember};
/// # use phea_hydraulics::reference_rig::{components, hose_line};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
/// let model = LineModel::TransmissionLine { end_share: 0.01 };
/// let line = BlockedLine::new(&hose_line(), &fluid, 35e5, StiffeningMember::Nominal, &model)?;
/// let slow = Complex64::new(0.0, 0.1);
/// let taken = (line.impedance(slow) * slow).inv().re;
/// let compliance = hose_line().compliance(1.45e9, StiffeningMember::Nominal);
/// assert!((taken / compliance - 1.0).abs() < 1e-6);
/// assert!((line.static_compliance(20e5) / compliance - 1.0).abs() < 1e-12);
/// # Ok::<(), phea_hydraulics::line::LineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockedLine {
    line: DynamicLine,
    air: Option<AeratedFluid>,
}

/// Fluid of a lumped line that contains air.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AeratedFluid {
    volume: f64,
    bulk_modulus: f64,
    air: EntrainedAir,
    /// Compliance of the fluid at the mean pressure, which the line already includes.
    counted: f64,
}

/// Absolute pressure in Pa below which the modulus is that at this pressure.
const LEAST_ABSOLUTE_PRESSURE: f64 = 1.0;

impl BlockedLine {
    /// Line filled with a fluid at a mean gauge pressure in Pa.
    ///
    /// # Errors
    /// Errors of [`DynamicLine::new`].
    pub fn new(
        line: &Line,
        fluid: &Fluid,
        pressure: f64,
        member: StiffeningMember,
        model: &LineModel,
    ) -> Result<BlockedLine, LineError> {
        let moving = DynamicLine::new(line, fluid, pressure, member, model)?;
        let is_lumped = matches!(model, LineModel::Lumped | LineModel::Creeping { .. });
        let holds_fluid = !matches!(line, Line::Volume { .. });
        let volume = line.filled().volume();
        let air = fluid.entrained_air.filter(|_| is_lumped && holds_fluid).map(|air| AeratedFluid {
            volume,
            bulk_modulus: fluid.bulk_modulus,
            air,
            counted: volume / fluid.modulus_at(pressure),
        });
        Ok(BlockedLine { line: moving, air })
    }

    /// Blocked line with this dynamic model.
    pub fn of(line: DynamicLine) -> BlockedLine {
        BlockedLine { line, air: None }
    }

    /// Ratio of pressure to flow at the open end, at s in rad/s and the mean pressure, Pa s/m3.
    ///
    /// ```text
    /// Z = (a + b s C_end)/(c + d s C_end)            ->  Z_c coth(Gamma) of the exact line
    /// ```
    pub fn impedance(&self, s: Complex64) -> Complex64 {
        let line = self.line.transfer_matrix(s);
        let end = s * self.line.chamber_compliance();
        (line.pressure + line.impedance * end) / (line.admittance + line.flow * end)
    }

    /// Static compliance of the line at a gauge pressure in Pa, m3/Pa.
    pub fn static_compliance(&self, pressure: f64) -> f64 {
        self.line.static_compliance() + self.air.map_or(0.0, |fluid| fluid.excess(pressure))
    }

    /// State and arriving waves at rest, at a gauge pressure in Pa.
    pub fn rest(&self, pressure: f64) -> (Vec<f64>, Vec<f64>) {
        let (line, waves) = self.line.steady_state(pressure, 0.0);
        ([vec![pressure], line].concat(), waves)
    }

    /// Pressure at the open end, Pa.
    pub fn open_end(&self, state: &[f64]) -> f64 {
        match state {
            [blocked, line @ ..] => self.line.port_pressure(line, *blocked),
            [] => f64::NAN,
        }
    }
}

impl AeratedFluid {
    /// Compliance in excess of that at the mean pressure, m3/Pa.
    fn excess<T: Scalar + From<f64>>(&self, pressure: T) -> T {
        let constant = |value: f64| <T as From<f64>>::from(value);
        let absolute = pressure + constant(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let modulus = bulk_modulus_with_air(
            constant(self.bulk_modulus),
            constant(self.air.volume_fraction),
            constant(self.air.polytropic_exponent),
            absolute.maximum(constant(LEAST_ABSOLUTE_PRESSURE)),
        );
        constant(self.volume) / modulus - constant(self.counted)
    }
}

impl System<f64> for BlockedLine {
    fn states(&self) -> usize {
        1 + self.line.states()
    }

    fn inputs(&self) -> usize {
        1 + self.line.delays().len()
    }

    fn scales(&self) -> Vec<f64> {
        // tens of bar and a litre per minute
        let [pressure, flow] = [1e6, 1e-5];
        [vec![pressure], self.line.scales(pressure, flow)].concat()
    }

    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let (blocked, own) = (state[0], &state[1..]);
        let (first, rest) = rates.split_at_mut(1);
        let flow = self.line.rates(inputs[0], blocked, own, &inputs[1..], rest);
        let mut compliance = <T as From<f64>>::from(self.line.chamber_compliance());
        if let Some(fluid) = &self.air {
            compliance = compliance + fluid.excess(blocked);
        }
        first[0] = flow / compliance;
    }

    fn delays(&self) -> Vec<f64> {
        self.line.delays()
    }

    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        self.line.outgoing(state[0], &state[1..], &inputs[1..], waves);
    }
}
