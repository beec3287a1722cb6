//! Other means for the stiffness of the hose: a pipe, gas at the chambers, a spring on the rod; and
//! a valve between the chambers that damps the mode of the load cell.

use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_hydraulics::accumulator::{Accumulator, ChamberGas};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use phea_hydraulics::line::{Line, Pipe, PipeWall, StiffeningMember};
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::series::{CoilPair, CoilWire, LEAST_ACTIVE_COILS, coil_pair};

use crate::project::OtherMeansRequirement;

/// Input for the sizing of the other means.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherMeansProblem {
    /// Request of the project.
    pub requirement: OtherMeansRequirement,
    /// Rig with the lines that it declares.
    pub actuator: Actuator,
    /// Linear parameters, with the stiffness of a series element in series with the force sensor.
    pub linear: LinearParameters,
    /// Position at the operating point, m.
    pub position: f64,
    /// Sum of stroke and `cylinder.dead_length`, m; `None` if the latter is not stated.
    pub length: Option<f64>,
}

/// The other means.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherMeans {
    /// Required K_H, N/m.
    pub stiffness: f64,
    /// Least K_H over the stroke of the chambers without a line, N/m.
    pub chambers: f64,
    /// Length of the actuator from mount to mount, retracted, with the hose and all means except
    /// the spring, m; `None` if `cylinder.dead_length` is not stated.
    pub actuator_length: Option<f64>,
    /// A pipe to each chamber.
    pub pipe: Result<SizedPipe, OtherMeansError>,
    /// Gas at both chambers.
    pub gas: Result<SizedGas, OtherMeansError>,
    /// A spring on the rod.
    pub spring: Result<SizedSpring, OtherMeansError>,
    /// A valve between the chambers: of the rig as declared, and of its chambers without a line.
    pub valves: Result<[SizedValve; 2], OtherMeansError>,
}

/// Reason why one of the other means is not sized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OtherMeansError {
    /// No means has to be softer than the chambers are.
    #[error("the chambers without any line are as soft")]
    ChambersAreAsSoft,
    /// No pipe is as soft.
    #[error("no length of it is as soft")]
    NoPipe,
    /// No gas is as soft.
    #[error("no volume is as soft")]
    NoGas,
    /// The forces of the gas are not stated.
    #[error("not stated: sizing.other_means.force_range")]
    NoForceRange,
    /// The rig cannot hold a force of the range.
    #[error("the rig does not hold every force of sizing.other_means.force_range")]
    ForceNotHeld,
    /// The lowest chamber pressure leaves no room for a precharge above the pressure of the tank.
    #[error("a chamber comes so near to the tank in this range that no precharge lies below it")]
    NoPrecharge,
    /// The damping ratio of the valve is not stated.
    #[error("not stated: sizing.other_means.damping_ratio")]
    NoDampingRatio,
}

/// Reason why the coils of a spring are not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoilUnknown {
    /// The wire is not stated.
    NotStated,
    /// There are fewer than two active coils, whose ends would decide the stiffness.
    TooFewCoils,
}

/// A pipe to each chamber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizedPipe {
    /// Bore, equal to that of the hose, m.
    pub bore: f64,
    /// Length of each, m.
    pub length: f64,
    /// Volume of oil in both, m3.
    pub oil: f64,
}

/// Equal accumulators at both chambers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizedGas {
    /// Volume of each at its precharge, m3.
    pub volume: f64,
    /// Precharge, gauge pressure, Pa.
    pub precharge: f64,
    /// Ratio of supply pressure to precharge, both absolute: for the maker's limit.
    pub pressure_ratio: f64,
    /// Softest and stiffest least K_H over the stroke, at forces within the range, N/m.
    pub stiffness: [f64; 2],
}

/// A spring between force sensor and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizedSpring {
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Travel to either side under the stall force, m.
    pub travel: f64,
    /// Winding of the spring, or the reason why it is not known.
    pub coil: Result<CoilPair, CoilUnknown>,
    /// Length of the actuator with the spring from mount to mount, retracted, m.
    pub actuator_length: Option<f64>,
}

/// A laminar valve between the chambers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizedValve {
    /// K_H of the rig that the valve damps, N/m.
    pub stiffness: f64,
    /// Damping ratio of the mode of the load cell without the valve.
    pub damping_ratio_without_valve: f64,
    /// Conductance at which the mode has the required damping, m3/(s Pa); `None` if there is none.
    pub conductance: Option<f64>,
    /// Greatest damping ratio of all conductances, and the conductance at which it occurs.
    pub most: [f64; 2],
    /// Power loss of the valve at the greatest force of the range, W; `None` without a range.
    pub loss: Option<f64>,
}

/// Number of bisections of every search: the interval is then at rounding level.
const HALVINGS: usize = 80;
/// Number of forces over the range at which gas is compared.
const FORCES: usize = 21;
/// Number of conductances that are compared, and their range to either side of the corner of the
/// chambers.
const CONDUCTANCES: usize = 400;
const DECADES: f64 = 4.0;

impl OtherMeansProblem {
    /// All other means, for a hose of this K_H, N/m, and bore, m.
    pub(super) fn solve(&self, hose_stiffness: f64, bore: f64) -> OtherMeans {
        let stiffness = self.requirement.stiffness.unwrap_or(hose_stiffness);
        let chambers = self.least(&rigid_pipe(bore, 0.0), None, [self.actuator.mean_pressure(); 2]);
        OtherMeans {
            stiffness,
            chambers,
            actuator_length: self.length,
            pipe: self.pipe(stiffness, chambers, bore),
            gas: self.gas(stiffness, chambers, bore),
            spring: self.spring(stiffness, chambers),
            valves: self.valves(chambers),
        }
    }

    /// Least K_H over the stroke with this line, and this gas, at both chambers, N/m.
    fn least(&self, line: &Line, gas: Option<Accumulator>, pressures: [f64; 2]) -> f64 {
        let components = Components {
            line_a: *line,
            line_b: *line,
            gas: [gas.map(ChamberGas::from); 2],
            ..*self.actuator.components()
        };
        components.chamber_compliance(pressures, StiffeningMember::Nominal).over_stroke().minimum
    }

    fn pipe(&self, stiffness: f64, chambers: f64, bore: f64) -> Result<SizedPipe, OtherMeansError> {
        softer(stiffness, chambers)?;
        let pressures = [self.actuator.mean_pressure(); 2];
        let length = falls_to(stiffness, |length| self.least(&rigid_pipe(bore, length), None, pressures))
            .ok_or(OtherMeansError::NoPipe)?;
        Ok(SizedPipe { bore, length, oil: 2.0 * rigid_pipe(bore, length).volume() })
    }

    /// ```text
    /// P_0 = share P_min,    max over F of K_H(V_0, p_A(F), p_B(F)) = K_H        P_min the lowest chamber pressure over F
    /// ```
    fn gas(&self, stiffness: f64, chambers: f64, bore: f64) -> Result<SizedGas, OtherMeansError> {
        let [low, high] = self.requirement.force_range.ok_or(OtherMeansError::NoForceRange)?;
        softer(stiffness, chambers)?;
        let held = |index: usize| {
            let force = low + (high - low) * index as f64 / (FORCES - 1) as f64;
            let condition = Condition::Load(SteadyLoad::Force(force));
            let point = operating_point(&self.actuator, self.position, condition);
            point.map(|point| [point.pressure_a, point.pressure_b])
        };
        let pressures: Result<Vec<[f64; 2]>, _> = (0..FORCES).map(held).collect();
        let pressures = pressures.map_err(|_| OtherMeansError::ForceNotHeld)?;
        let lowest = pressures.iter().flatten().fold(f64::INFINITY, |least, one| least.min(*one));
        let absolute = lowest + ATMOSPHERIC_PRESSURE_ABSOLUTE;
        let precharge = self.requirement.precharge_share * absolute - ATMOSPHERIC_PRESSURE_ABSOLUTE;
        if precharge <= 0.0 {
            return Err(OtherMeansError::NoPrecharge);
        }
        let none = rigid_pipe(bore, 0.0);
        let over_range = |volume: f64| {
            let gas = Accumulator {
                gas_volume: volume,
                precharge_pressure: precharge,
                polytropic_exponent: self.requirement.polytropic_exponent,
            };
            let of = |pressures: &[f64; 2]| self.least(&none, Some(gas), *pressures);
            pressures
                .iter()
                .map(of)
                .fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], one| [least.min(one), most.max(one)])
        };
        let volume =
            falls_to(stiffness, |volume| over_range(1e-6 * volume)[1]).ok_or(OtherMeansError::NoGas)? * 1e-6;
        let supply = self.actuator.components().supply.pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE;
        Ok(SizedGas {
            volume,
            precharge,
            pressure_ratio: supply / (precharge + ATMOSPHERIC_PRESSURE_ABSOLUTE),
            stiffness: over_range(volume),
        })
    }

    /// ```text
    /// 1/k = 1/K_H - 1/K_chambers,    travel F_stall/k
    /// ```
    fn spring(&self, stiffness: f64, chambers: f64) -> Result<SizedSpring, OtherMeansError> {
        softer(stiffness, chambers)?;
        let spring = 1.0 / (1.0 / stiffness - 1.0 / chambers);
        let Components { cylinder, supply, .. } = self.actuator.components();
        let [retracting, extending] = cylinder.stall_forces(supply);
        let stall = extending.max(-retracting);
        let coil = self.requirement.coil.map(|coil| {
            let wire = CoilWire {
                index: coil.index,
                allowed_shear_stress: coil.allowed_shear_stress,
                shear_modulus: coil.shear_modulus,
                density: coil.density,
            };
            coil_pair(spring, stall, &wire)
        });
        let coil = match coil {
            None => Err(CoilUnknown::NotStated),
            Some(pair) if pair.active_coils < LEAST_ACTIVE_COILS => Err(CoilUnknown::TooFewCoils),
            Some(pair) => Ok(pair),
        };
        let actuator_length = coil.ok().zip(self.length).map(|(pair, length)| length + pair.installed_length);
        Ok(SizedSpring { stiffness: spring, travel: stall / spring, coil, actuator_length })
    }

    fn valves(&self, chambers: f64) -> Result<[SizedValve; 2], OtherMeansError> {
        let wanted = self.requirement.damping_ratio.ok_or(OtherMeansError::NoDampingRatio)?;
        Ok([self.linear.hydraulic_stiffness, chambers].map(|stiffness| self.valve(stiffness, wanted)))
    }

    fn valve(&self, stiffness: f64, wanted: f64) -> SizedValve {
        let linear = LinearParameters { hydraulic_stiffness: stiffness, ..self.linear };
        let area = linear.useful_area;
        let mode = ((linear.hydraulic_stiffness + linear.sensor_stiffness) / linear.moving_mass).sqrt();
        let corner = mode * area * area / linear.hydraulic_stiffness;
        let damped = |conductance: f64| load_cell_damping(&linear, conductance);
        let at = |index: usize| {
            let exponent = DECADES * (2.0 * index as f64 / (CONDUCTANCES - 1) as f64 - 1.0);
            corner * phea_dynamics::portable::pow(10.0, exponent)
        };
        let all: Vec<[f64; 2]> = (0..CONDUCTANCES).map(|index| [damped(at(index)), at(index)]).collect();
        let most = all.iter().fold([0.0; 2], |most, one| if one[0] > most[0] { *one } else { most });
        let first = all.iter().position(|[ratio, _]| *ratio >= wanted);
        let conductance = first.map(|index| {
            let (mut less, mut more) = (if index == 0 { 0.0 } else { all[index - 1][1] }, all[index][1]);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (less + more);
                if damped(middle) < wanted { less = middle } else { more = middle }
            }
            more
        });
        let greatest = self.requirement.force_range.map(|[low, high]| low.abs().max(high.abs()));
        let loss = conductance
            .zip(greatest)
            .map(|(conductance, force)| conductance * (force / area) * (force / area));
        SizedValve { stiffness, damping_ratio_without_valve: damped(0.0), conductance, most, loss }
    }
}

/// Damping ratio of the mode of the load cell with a laminar conductance between the chambers,
/// m3/(s Pa); one if nothing oscillates.
///
/// ```text
/// (C s + K_c + G)(M s^2 + f_v s + K_S) + A^2 s = 0,    C = A^2/K_H                    4.25, 6.6 with the valve shut
/// ```
fn load_cell_damping(linear: &LinearParameters, conductance: f64) -> f64 {
    let square = linear.useful_area * linear.useful_area;
    let flow = Polynomial::new(vec![
        square / linear.hydraulic_stiffness,
        linear.flow_pressure_coefficient + conductance,
    ]);
    let held = Polynomial::new(vec![linear.moving_mass, linear.viscous_friction, linear.sensor_stiffness]);
    let closed = flow.product(&held).sum(&Polynomial::new(vec![square, 0.0]));
    let Ok(modes) = TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &closed) else {
        return f64::NAN;
    };
    let oscillates = modes.poles().iter().find(|pole| pole.im > 0.0);
    oscillates.map_or(1.0, |pole| -pole.re / pole.norm_sqr().sqrt())
}

/// A pipe with a rigid wall.
fn rigid_pipe(bore: f64, length: f64) -> Line {
    Line::Pipe { pipe: Pipe { bore, wall: PipeWall::Rigid }, length }
}

/// Checks that the required stiffness is below that of the chambers.
fn softer(stiffness: f64, chambers: f64) -> Result<(), OtherMeansError> {
    match stiffness < chambers {
        true => Ok(()),
        false => Err(OtherMeansError::ChambersAreAsSoft),
    }
}

/// Argument at which a falling function of a positive number reaches a value; `None` if there is
/// none up to a million.
fn falls_to(value: f64, of: impl Fn(f64) -> f64) -> Option<f64> {
    let mut most = 1e-3;
    while of(most) > value {
        most *= 2.0;
        if most > 1e6 {
            return None;
        }
    }
    let mut least = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (least + most);
        if of(middle) > value { least = middle } else { most = middle }
    }
    Some(most)
}
