//! The physical numbers of an actuator that reach its linear model by a formula, open to any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid, bulk_modulus_with_air};
use phea_hydraulics::line::{Line, LineError, Member, PipeWall, Stiffening};
use phea_hydraulics::plant::{BehindLines, LinearLoad};
use phea_hydraulics::servovalve::ChamberCoefficients;
use phea_hydraulics::stiffness::{chamber_compliance, compliance_at};
use phea_hydraulics::two_pressure::TwoPressureLinearParameters;

use crate::project::{self, Project};
use crate::rig::{Rig, YieldingLoad, lines};

/// Units: Pa, 1, m2, m, kg, m3, N s/m, N/m, rad/s, m3/(s Pa).
#[derive(Clone, Debug)]
pub(super) struct Machine<S = f64> {
    bulk_modulus: S,
    /// Volume fraction and polytropic index.
    air: Option<(S, S)>,
    polytropic_exponent: S,
    /// Diameters of the piston and of the rods in both chambers, where areas follow from them.
    diameters: Option<(S, [S; 2])>,
    cylinder: Cylinder<S>,
    lines: [Line<S>; 2],
    /// Position of the piston; mid stroke where none is declared.
    position: Option<S>,
    viscous_friction: S,
    sensor_stiffness: S,
    natural_frequency: S,
    damping_ratio: S,
    internal_leakage: S,
    /// `None` where its motion is prescribed.
    load: Option<YieldingLoad<S>>,
}

impl Machine {
    pub(super) fn new(project: &Project, rig: &Rig) -> Machine {
        let components = rig.actuator.components();
        let declared = project.actuator.as_ref();
        let diameters = declared.and_then(|actuator| {
            let cylinder = &actuator.cylinder;
            let by_diameter = cylinder.piston_area.is_none() && cylinder.piston_areas.is_none();
            cylinder
                .piston_diameter
                .filter(|_| by_diameter)
                .map(|piston| (piston, cylinder.rod_diameters_m()))
        });
        let air = components.fluid.entrained_air;
        Machine {
            bulk_modulus: components.fluid.bulk_modulus,
            air: air.map(|EntrainedAir { volume_fraction, polytropic_index }| {
                (volume_fraction, polytropic_index)
            }),
            polytropic_exponent: declared.map_or(1.0, |actuator| actuator.fluid.polytropic_exponent),
            diameters,
            cylinder: components.cylinder,
            lines: [components.line_a, components.line_b],
            position: project.operating_point.position,
            viscous_friction: rig.model.viscous_friction,
            sensor_stiffness: components.force_sensor.stiffness,
            natural_frequency: components.valve.natural_frequency,
            damping_ratio: components.valve.damping_ratio,
            internal_leakage: rig.internal_leakage,
            load: rig.load,
        }
    }

    /// What the chambers consist of where lines move; `None` where both are lumped.
    ///
    /// # Errors
    /// A line that its model does not fit.
    pub(super) fn behind_lines(
        &self,
        declared: &project::Lines,
        rig: &Rig,
    ) -> Result<Option<BehindLines>, LineError> {
        let fluid = Fluid {
            bulk_modulus: self.bulk_modulus,
            entrained_air: self.air.map(|(volume_fraction, polytropic_index)| EntrainedAir {
                volume_fraction,
                polytropic_index,
            }),
            ..rig.actuator.components().fluid
        };
        let of_member = self.lines.map(stiffened_alike);
        let [line_a, line_b] = &of_member;
        let Some(lines) = lines(declared, [line_a, line_b], &fluid, rig.actuator.mean_pressure())? else {
            return Ok(None);
        };
        let compliances = |machine: &Machine| machine.linear_parameters(rig).compliances;
        let bare = Machine { lines: self.lines.map(without_volume), ..self.clone() };
        Ok(Some(BehindLines { lines, chambers: compliances(&bare), lumped: compliances(self) }))
    }

    /// The same numbers as constants of another scalar.
    pub(super) fn map<S: Scalar>(&self) -> Machine<S> {
        let diameters = self.diameters.map(|(piston, rods)| (S::from(piston), rods.map(S::from)));
        Machine {
            bulk_modulus: S::from(self.bulk_modulus),
            air: self.air.map(|(fraction, index)| (S::from(fraction), S::from(index))),
            polytropic_exponent: S::from(self.polytropic_exponent),
            diameters,
            cylinder: self.cylinder.map(),
            lines: self.lines.map(|line| line.map()),
            position: self.position.map(S::from),
            viscous_friction: S::from(self.viscous_friction),
            sensor_stiffness: S::from(self.sensor_stiffness),
            natural_frequency: S::from(self.natural_frequency),
            damping_ratio: S::from(self.damping_ratio),
            internal_leakage: S::from(self.internal_leakage),
            load: self.load.map(|load| load.map()),
        }
    }
}

impl<S: Scalar> Machine<S> {
    /// Gives the number at a path of the project another value; `false` if no formula carries it into the linear model.
    pub(super) fn set(&mut self, path: &str, value: S) -> bool {
        let slot = match path {
            "fluid.bulk_modulus" => &mut self.bulk_modulus,
            "fluid.entrained_air" => {
                self.air = Some((value, self.polytropic_exponent));
                return true;
            }
            "fluid.polytropic_exponent" => {
                self.polytropic_exponent = value;
                self.air = self.air.map(|(fraction, _)| (fraction, value));
                return true;
            }
            "cylinder.piston_area" => {
                self.cylinder.area_b = value;
                &mut self.cylinder.area_a
            }
            "cylinder.piston_diameter" | "cylinder.rod_diameter" => return self.set_diameter(path, value),
            "cylinder.stroke" => &mut self.cylinder.stroke,
            "cylinder.moving_mass" => &mut self.cylinder.moving_mass,
            "cylinder.dead_volume" => {
                self.cylinder.dead_volume_b = value;
                &mut self.cylinder.dead_volume_a
            }
            "cylinder.friction.viscous" => &mut self.viscous_friction,
            "cylinder.internal_leakage" => &mut self.internal_leakage,
            "force_sensor.stiffness" => &mut self.sensor_stiffness,
            "valve.natural_frequency" => &mut self.natural_frequency,
            "valve.damping_ratio" => &mut self.damping_ratio,
            _ => return self.set_load(path, value) || self.set_line(path, value),
        };
        *slot = value;
        true
    }

    fn set_diameter(&mut self, path: &str, value: S) -> bool {
        let Some((piston, rods)) = &mut self.diameters else { return false };
        if path == "cylinder.piston_diameter" {
            *piston = value;
        } else {
            *rods = [value; 2];
        }
        let [area_a, area_b] = rods.map(|rod| annulus_area(*piston, rod));
        (self.cylinder.area_a, self.cylinder.area_b) = (area_a, area_b);
        true
    }

    fn set_load(&mut self, path: &str, value: S) -> bool {
        let Some(load) = &mut self.load else { return false };
        let slot = match (path, &mut load.stiffness) {
            ("load.mass", _) => &mut load.mass,
            ("load.damping", _) => &mut load.damping,
            ("load.stiffness", Some(stiffness)) => stiffness,
            _ => return false,
        };
        *slot = value;
        true
    }

    /// What the force sensor pushes on.
    pub(super) fn load(&self) -> LinearLoad<S> {
        self.load.as_ref().map_or(LinearLoad::Prescribed, YieldingLoad::linear)
    }

    /// Leakage across the piston in m3/(s Pa).
    pub(super) fn internal_leakage(&self) -> S {
        self.internal_leakage
    }

    /// `line.KEY` is of both sides, `line.a.KEY` and `line.b.KEY` of one.
    fn set_line(&mut self, path: &str, value: S) -> bool {
        let Some(key) = path.strip_prefix("line.") else { return false };
        let [line_a, line_b] = &mut self.lines;
        match (key.strip_prefix("a."), key.strip_prefix("b.")) {
            (Some(key), _) => set_of_line(line_a, key, value),
            (_, Some(key)) => set_of_line(line_b, key, value),
            _ => set_of_line(line_a, key, value) && set_of_line(line_b, key, value),
        }
    }

    /// Bulk modulus of the fluid in both chambers.
    fn moduli(&self, rig: &Rig) -> [S; 2] {
        [rig.point.pressure_a, rig.point.pressure_b].map(|pressure| match self.air {
            None => self.bulk_modulus,
            Some((fraction, index)) => {
                let absolute = S::from(pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE);
                bulk_modulus_with_air(self.bulk_modulus, fraction, index, absolute)
            }
        })
    }

    /// The linearised two-pressure model, the edges as they are at the operating point of the rig, which none of these
    /// numbers moves.
    pub(super) fn linear_parameters(&self, rig: &Rig) -> TwoPressureLinearParameters<S> {
        let moduli = self.moduli(rig);
        let model = rig.actuator.components().stiffness_model;
        let [line_a, line_b] = &self.lines;
        let chambers = chamber_compliance(model, moduli, &self.cylinder, [line_a, line_b], Member::Nominal);
        let position = self.position.unwrap_or(self.cylinder.stroke / S::from(2.0));
        let ChamberCoefficients { flow_gain_a, flow_pressure_a, flow_gain_b, flow_pressure_b } =
            rig.two_pressure.chambers;
        TwoPressureLinearParameters {
            areas: [self.cylinder.area_a, self.cylinder.area_b],
            compliances: compliance_at(&chambers, position),
            chambers: ChamberCoefficients {
                flow_gain_a: S::from(flow_gain_a),
                flow_pressure_a: S::from(flow_pressure_a),
                flow_gain_b: S::from(flow_gain_b),
                flow_pressure_b: S::from(flow_pressure_b),
            },
            moving_mass: self.cylinder.moving_mass,
            viscous_friction: self.viscous_friction,
            sensor_stiffness: self.sensor_stiffness,
            valve_natural_frequency: self.natural_frequency,
            valve_damping_ratio: self.damping_ratio,
        }
    }
}

/// A hose of one stiffening: what a member has for it is its own, and need not lie in the declared interval.
fn stiffened_alike(line: Line) -> Line {
    match line {
        Line::Hose { mut hose, length } => {
            let nominal = hose.dynamic_stiffening.nominal;
            hose.dynamic_stiffening = Stiffening { nominal, minimum: nominal, maximum: nominal };
            Line::Hose { hose, length }
        }
        Line::Pipe { .. } | Line::Volume { .. } => line,
    }
}

/// The same line, holding nothing.
fn without_volume(mut line: Line) -> Line {
    match &mut line {
        Line::Hose { length, .. } | Line::Pipe { length, .. } => *length = 0.0,
        Line::Volume { volume, .. } => *volume = 0.0,
    }
    line
}

fn set_of_line<S: Scalar>(line: &mut Line<S>, key: &str, value: S) -> bool {
    let slot = match (line, key) {
        (Line::Hose { length, .. } | Line::Pipe { length, .. }, "length") => length,
        (Line::Hose { hose, .. }, "bore") => &mut hose.bore,
        (Line::Hose { hose, .. }, "dynamic_stiffening" | "dynamic_stiffening.nominal") => {
            &mut hose.dynamic_stiffening.nominal
        }
        (Line::Pipe { pipe, .. }, "pipe.bore") => &mut pipe.bore,
        (Line::Pipe { pipe, .. }, "pipe.wall_thickness" | "pipe.youngs_modulus" | "pipe.poisson_ratio") => {
            match (&mut pipe.wall, key) {
                (PipeWall::Elastic { thickness, .. }, "pipe.wall_thickness") => thickness,
                (PipeWall::Elastic { youngs_modulus, .. }, "pipe.youngs_modulus") => youngs_modulus,
                (PipeWall::Elastic { poisson_ratio, .. }, _) => poisson_ratio,
                (PipeWall::Rigid, _) => return false,
            }
        }
        (Line::Volume { volume, .. }, "volume") => volume,
        (Line::Volume { effective_bulk_modulus, .. }, "effective_bulk_modulus") => effective_bulk_modulus,
        _ => return false,
    };
    *slot = value;
    true
}
