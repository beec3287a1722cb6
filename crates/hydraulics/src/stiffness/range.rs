use super::{ChamberCompliance, StiffnessModel, chamber_compliance, compliance_at, hydraulic_stiffness};
use crate::cylinder::Cylinder;
use crate::line::{Line, StiffeningMember};
use crate::stroke::{ActuatorStroke, Telescope};

/// Least and greatest hydraulic stiffness over the stroke. Units: N/m, m.
///
/// For a symmetric cylinder with equal lines, in the model `uniform`:
///
/// ```text
/// K_Hmax = beta_e A^2 (A L + 2 V)/(V (A L + V))        at both ends        thesis (6.18)
/// K_Hmin = 4 beta_e A^2/(A L + 2 V)                    at mid stroke       thesis (6.19)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeStiffness {
    /// Least stiffness.
    pub minimum: f64,
    /// Position of the least stiffness; mid stroke for a symmetric cylinder with equal lines.
    pub minimum_position: f64,
    /// Greatest stiffness.
    pub maximum: f64,
    /// Position of the greatest stiffness, at one of the ends.
    pub maximum_position: f64,
}

impl ChamberCompliance<f64> {
    /// Least and greatest stiffness over the stroke, exactly.
    ///
    /// ```text
    /// dK_H/dx = 0   <=>   A_A sqrt(slope_a)/C_A(x) = A_B sqrt(slope_b)/C_B(x)        (linear in x)
    /// ```
    ///
    /// K_H is convex in x, so the greatest value is at an end, and the least at the root if that is
    /// inside the stroke, otherwise at an end. A telescopic piston is searched on a grid, which
    /// finds the least and the greatest to one part in 100,000. With neither dead volume nor line
    /// the stiffness at the ends is infinite.
    ///
    /// # Example
    /// The larger side is the softer: an asymmetric cylinder is softest on the rod's side of mid
    /// stroke:
    /// ```
    /// use phea_hydraulics::{stiffness::ChamberCompliance, stroke::ActuatorStroke};
    /// let steel = 1.0 / 1.45e9;
    /// let range = ChamberCompliance {
    ///     area_a: 2e-3, area_b: 1.5e-3, stroke: ActuatorStroke::Limited(0.5),
    ///     constant_a: 1e-5 * steel, slope_a: 2e-3 * steel, constant_b: 1e-5 * steel, slope_b: 1.5e-3 * steel,
    /// }.over_stroke();
    /// assert!(range.minimum_position > 0.25 && range.minimum_position < 0.5);
    /// ```
    pub fn over_stroke(&self) -> StrokeStiffness {
        let (weight_a, weight_b) = (self.area_a * self.slope_a.sqrt(), self.area_b * self.slope_b.sqrt());
        let [start_a, start_b] = compliance_at(self, 0.0);
        let stroke = match self.stroke {
            ActuatorStroke::Limited(stroke) => stroke,
            ActuatorStroke::Telescopic(telescope) => return self.over_stages(&telescope),
            ActuatorStroke::Unlimited => {
                let everywhere = hydraulic_stiffness(self, 0.0);
                return StrokeStiffness {
                    minimum: everywhere,
                    minimum_position: 0.0,
                    maximum: everywhere,
                    maximum_position: 0.0,
                };
            }
        };
        let root =
            (weight_a * start_b - weight_b * start_a) / (weight_a * self.slope_b + weight_b * self.slope_a);
        let minimum_position = if root.is_finite() { root.max(0.0).min(stroke) } else { 0.0 };
        let (start, end) = (hydraulic_stiffness(self, 0.0), hydraulic_stiffness(self, stroke));
        let (maximum, maximum_position) = if start >= end { (start, 0.0) } else { (end, stroke) };
        StrokeStiffness {
            minimum: hydraulic_stiffness(self, minimum_position),
            minimum_position,
            maximum,
            maximum_position,
        }
    }

    /// Least and greatest stiffness of a telescopic piston, on a grid over the stroke and over its
    /// transitions, where K_H changes most.
    fn over_stages(&self, telescope: &Telescope) -> StrokeStiffness {
        let over = |from: f64, width: f64| {
            (0..=STEPS_OVER_STAGES).map(move |step| from + width * step as f64 / STEPS_OVER_STAGES as f64)
        };
        let width = telescope.transition;
        let transitions = telescope.stages.iter().flatten();
        let within = transitions.flat_map(|stage| over(stage.from - 0.5 * width, width));
        let positions = over(0.0, telescope.stroke).chain(within);
        let found = positions.map(|x| (x, hydraulic_stiffness(self, x)));
        let start = hydraulic_stiffness(self, 0.0);
        let begun =
            StrokeStiffness { minimum: start, minimum_position: 0.0, maximum: start, maximum_position: 0.0 };
        found.fold(begun, |known, (x, stiffness)| StrokeStiffness {
            minimum: known.minimum.min(stiffness),
            minimum_position: if stiffness < known.minimum { x } else { known.minimum_position },
            maximum: known.maximum.max(stiffness),
            maximum_position: if stiffness > known.maximum { x } else { known.maximum_position },
        })
    }
}

/// Steps of the grid over a stroke of several stages, and over each transition.
const STEPS_OVER_STAGES: usize = 2000;

/// Comparison of the two stiffness models. Units: N/m, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelDifference {
    /// Stiffness with one modulus for line and chamber.
    pub uniform: StrokeStiffness,
    /// Stiffness with separate moduli of the volumes.
    pub by_volume: StrokeStiffness,
    /// Ratio of the least stiffness by volume to the least stiffness uniform.
    pub minimum_ratio: f64,
    /// Ratio of the greatest stiffness by volume to the greatest stiffness uniform.
    pub maximum_ratio: f64,
    /// Fraction of the fluid in the chambers and not in the lines (piston at the softest position),
    /// for which `uniform` has the wrong modulus.
    pub chamber_volume_fraction: f64,
    /// Fraction of the compliance, by volume, from the lines at this position, which sizing the
    /// lines can change.
    pub line_compliance_fraction: f64,
    /// Fraction of the compliance, by volume, from the gas of accumulators at this position.
    pub gas_compliance_fraction: f64,
}

/// Both stiffness models of one cylinder and its lines, and their difference; the fluid's modulus
/// on either side in Pa, the compliance of an accumulator's gas there in m3/Pa.
///
/// # Example
/// For 1.5 m of the thesis' hose, the thesis' model has less than half the true stiffness:
/// ```
/// # use phea_hydraulics::{cylinder::*, line::*, stiffness::*, stroke::ActuatorStroke};
/// # let cylinder = Cylinder { area_a: 1.58336e-3, area_b: 1.58336e-3, stroke: ActuatorStroke::Limited(0.5), moving_mass: 13.1,
/// #     dead_volume_a: 0.0, dead_volume_b: 0.0, internal_leakage: None, end_stops: None };
/// # let dynamic_stiffening = Stiffening::certain(5.0);
/// # let hose = Hose { bore: 12.7e-3, volumetric_expansion: 1.56e-5, operating_expansion: 7.774e-6,
/// #     expansion_slope: 2.236e-12, dynamic_stiffening };
/// # let line = Line::Hose { hose, length: 1.5 };
/// let difference = model_difference([1.45e9; 2], &cylinder, [&line, &line], [None; 2], StiffeningMember::Nominal);
/// assert!((difference.minimum_ratio - 2.07).abs() < 0.005);
/// ```
pub fn model_difference(
    fluid_moduli: [f64; 2],
    cylinder: &Cylinder,
    lines: [&Line; 2],
    gas: [Option<f64>; 2],
    member: StiffeningMember,
) -> ModelDifference {
    let of = |model| chamber_compliance(model, fluid_moduli, cylinder, lines, member).with_gas(gas);
    let (uniform, chambers) = (of(StiffnessModel::Uniform).over_stroke(), of(StiffnessModel::ByVolume));
    let by_volume = chambers.over_stroke();
    let total_compliance: f64 = compliance_at(&chambers, by_volume.minimum_position).iter().sum();
    let line_compliance: f64 =
        lines.iter().zip(fluid_moduli).map(|(line, modulus)| line.compliance(modulus, member)).sum();
    let gas_compliance: f64 = gas.into_iter().flatten().sum();
    let line_volume: f64 = lines.iter().map(|line| line.volume()).sum();
    let chamber_volume: f64 =
        crate::cylinder::chamber_volumes(cylinder, by_volume.minimum_position).iter().sum();
    ModelDifference {
        uniform,
        by_volume,
        minimum_ratio: by_volume.minimum / uniform.minimum,
        maximum_ratio: by_volume.maximum / uniform.maximum,
        chamber_volume_fraction: chamber_volume / (chamber_volume + line_volume),
        line_compliance_fraction: line_compliance / total_compliance,
        gas_compliance_fraction: gas_compliance / total_compliance,
    }
}
