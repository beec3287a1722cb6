use phea_dynamics::scalar::{Parameters, Scalar};
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::line::{Anchoring, Hose, Line, Pipe, PipeWall, Stiffening};
use phea_hydraulics::linkage::{Linkage, STANDARD_GRAVITY};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::series::{SeriesElement, SeriesSpring, SeriesTravel, Transmission};
use phea_hydraulics::servovalve::{
    Edges, LeakageShape, OpeningLaw, OpeningShape, Servovalve, SpoolImperfection, Supply,
    flow_coefficient_from_rating, leakage_coefficient_from_rating,
};
use phea_hydraulics::stroke::{ActuatorStroke, FURTHER_STAGES, PistonStage, Telescope};

use super::cross_port::cross_port;
use super::friction::friction;
use super::gas::chamber_gas;
use super::in_loop::velocity_gain;
use super::lines::line_model;
use super::supply::power_unit;
use crate::project::{
    self, Component, DeclaredSeries, DeclaredSpring, DeclaredTransmission, DeclaredWeight, HoseExpansion,
    LineVolume, NullLeakage, RatedFlow, ValveCoefficients, once_read,
};

/// Kinematic viscosity of ISO VG 46 oil at 40 degrees Celsius, m2/s: used where a project states
/// none.
pub(super) const KINEMATIC_VISCOSITY: f64 = 46e-6;

/// The declared rig as the components of `phea_hydraulics`.
///
/// # Errors
/// Every parameter that is impossible as physics.
pub fn actuator(declared: &project::DeclaredActuator) -> Result<Actuator, ActuatorError> {
    Actuator::new(components(declared, declared))
}

/// Components of the declared rig over any scalar, not yet checked. `plain` is the rig in its own
/// numbers: its linkage, whose geometry is never open, is reduced to polynomials over the stroke.
pub fn components<S: Scalar>(
    plain: &project::DeclaredActuator,
    declared: &project::DeclaredActuator<S>,
) -> Components<S> {
    let pressure = declared.supply.pressure;
    let tank_pressure = declared.supply.tank_pressure;
    let pressures = ExpansionPressures::of(pressure, tank_pressure);
    let fluid = fluid(&declared.fluid);
    Components {
        gas: [&declared.line.a, &declared.line.b]
            .map(|line| Some(chamber_gas(line.accumulator.as_ref()?, &fluid))),
        fluid,
        supply: Supply { pressure, tank_pressure },
        power_unit: power_unit(declared),
        valve: valve(&declared.valve, pressure - tank_pressure),
        line_a: line(&declared.line.a, pressures),
        line_b: line(&declared.line.b, pressures),
        line_models: [&plain.line.a, &plain.line.b].map(|line| line_model(&line.motion)),
        cross_port: cross_port(declared.cross_port.as_ref(), fluid.density),
        outward: OutwardFlow {
            external_leakage: declared.motor.as_ref().and_then(|motor| motor.case_leakage),
            port_valves: declared.port_valves.as_ref().map_or([None; 2], |valves| valves.components()),
        },
        cylinder: match &declared.motor {
            None => cylinder(&declared.cylinder),
            Some(motor) => motor_as_cylinder(motor),
        },
        friction: friction(declared.friction()),
        force_sensor: ForceSensor { stiffness: declared.force_sensor.stiffness },
        series: declared.series.as_ref().map(series),
        linkage: plain.linkage.as_ref().map(|geometry| {
            let weight = declared.linkage.as_ref().and_then(|linkage| linkage.weight);
            linkage(geometry, plain.cylinder.stroke, weight)
        }),
        load: declared.load,
        velocity_gain: velocity_gain(declared),
        stiffness_model: declared.line.compliance,
    }
}

/// The linkage over the declared stroke; [`Actuator::new`] refuses one that does not exist.
fn linkage<S: Scalar>(
    geometry: &project::DeclaredLinkage,
    stroke: f64,
    weight: Option<DeclaredWeight<S>>,
) -> Linkage<S> {
    let Ok(reduced) = geometry.reduced(stroke) else { return Linkage::impossible() };
    let Some(DeclaredWeight { mass, centre_distance, .. }) = weight else {
        return reduced.linkage.convert(&mut S::from);
    };
    let moment = mass * centre_distance;
    reduced.linkage.convert(&mut S::from).with_moment(moment * S::from(STANDARD_GRAVITY))
}

/// What lies between force sensor and load.
fn series<S: Scalar>(declared: &DeclaredSeries<S>) -> SeriesElement<S> {
    match declared {
        DeclaredSeries::Spring(declared) => SeriesElement::Spring(spring(declared)),
        DeclaredSeries::Transmission(declared) => SeriesElement::Transmission(transmission(declared)),
    }
}

/// The expansion of its hose is that at the filling pressure.
fn transmission<S: Scalar>(declared: &DeclaredTransmission<S>) -> Transmission<S> {
    let filling_pressure = declared.filling_pressure;
    let pressures = ExpansionPressures { working: filling_pressure, operating: filling_pressure };
    Transmission {
        piston_area: declared.piston_area,
        line: line(&declared.line, pressures),
        end_volume: declared.end_volume,
        filling_pressure,
        segments: declared.segments as usize,
    }
}

/// A damper, a mass or a progression of zero is left out.
fn spring<S: Scalar>(declared: &DeclaredSpring<S>) -> SeriesSpring<S> {
    SeriesSpring {
        stiffness: declared.stiffness,
        damping: declared.damping,
        mass: declared.mass,
        travel: declared.travel.map(|travel| SeriesTravel {
            travel,
            progression: declared.progression,
            ends: declared
                .stop_stiffness
                .map(|stiffness| Contact { stiffness, relative_damping: declared.stop_damping }),
        }),
        force_from: declared.force_from,
    }
}

fn fluid<S: Scalar>(declared: &project::DeclaredFluid<S>) -> Fluid<S> {
    Fluid {
        bulk_modulus: declared.bulk_modulus,
        density: declared.density,
        kinematic_viscosity: declared.kinematic_viscosity.unwrap_or(S::from(KINEMATIC_VISCOSITY)),
        entrained_air: declared.entrained_air.and_then(once_read).map(|volume_fraction| EntrainedAir {
            volume_fraction,
            polytropic_exponent: declared.polytropic_exponent,
        }),
        vapour_pressure_absolute: declared.vapour_pressure,
    }
}

/// ValveCoefficients as declared; without them, those of the data sheet, equal for all edges.
fn valve<S: Scalar>(declared: &project::Valve<S>, supply_drop: S) -> Servovalve<S> {
    let opening = opening(declared);
    let tare_flow = declared.tare_flow;
    let tare_drop = declared.tare_pressure.unwrap_or(supply_drop);
    Servovalve {
        flow_coefficients: match declared.flow {
            ValveCoefficients::Edges { edges: flow, .. } => flow,
            ValveCoefficients::Rated(RatedFlow { flow, pressure_drop }) => {
                let rated = flow_coefficient_from_rating(flow, pressure_drop);
                // the data sheet's flow is that of full travel
                let [positive, negative] = opening.full().map(|full| rated / full);
                Edges::from_array([positive, negative, negative, positive])
            }
        },
        opening,
        leakage_coefficients: match declared.leakage {
            ValveCoefficients::Edges { edges: leakage, .. } if is_shut(leakage) => Edges::vanishing(),
            ValveCoefficients::Edges { edges: leakage, .. } => leakage,
            ValveCoefficients::Rated(NullLeakage { flow, pressure, .. }) => {
                Edges::equal(leakage_coefficient_from_rating(flow, tare_flow, tare_drop, pressure))
            }
        },
        leakage_shape: match declared.leakage_shapes {
            Some(shapes) => LeakageShape::ByEdge(shapes),
            None => LeakageShape::Common(declared.leakage_shape),
        },
        leakage_model: declared.leakage_model,
        tare_flow,
        tare_reference_drop: tare_drop,
        nominal_voltage: declared.nominal_voltage,
        natural_frequency: declared.natural_frequency,
        damping_ratio: declared.damping_ratio,
        transition_pressure: declared.transition_pressure,
        spool: SpoolImperfection {
            null_bias: declared.null_bias,
            hysteresis_width: declared.hysteresis,
            threshold: declared.threshold,
            rate_limit: declared.rate_limit,
        },
    }
}

/// How the declared edges open: in proportion where neither lap nor saturation is stated.
fn opening<S: Scalar>(declared: &project::Valve<S>) -> OpeningLaw<S> {
    let project::Valve { lap, saturation, .. } = declared;
    if lap.is_none() && saturation.is_none() {
        return OpeningLaw::Proportional;
    }
    let lap = lap.unwrap_or_default();
    OpeningLaw::Shaped(OpeningShape {
        lap_positive: lap.positive,
        lap_negative: lap.negative,
        saturation: saturation.unwrap_or(S::from(0.0)),
    })
}

/// Whether no edge leaks: an ideal valve.
fn is_shut<S: Scalar>(leakage: Edges<S>) -> bool {
    leakage.to_array().into_iter().all(|edge| once_read(edge).is_none())
}

/// The line as physics.
fn line<S: Scalar>(declared: &project::DeclaredLine<S>, pressures: ExpansionPressures<S>) -> Line<S> {
    match &declared.component {
        Component::Volume(LineVolume { volume, effective_bulk_modulus }) => {
            Line::Volume { volume: *volume, effective_bulk_modulus: *effective_bulk_modulus }
        }
        Component::Pipe { pipe, length } => Line::Pipe { pipe: self::pipe(pipe), length: *length },
        Component::Hose { properties, length, .. } => {
            let expansion = VolumetricExpansion::of(&properties.expansion);
            let stiffening = stiffening(declared.dynamic_stiffening);
            Line::Hose { hose: hose(properties.bore, expansion, pressures, stiffening), length: *length }
        }
    }
}

/// Pressures in Pa at which the expansion of a hose is evaluated.
#[derive(Clone, Copy)]
pub(crate) struct ExpansionPressures<S = f64> {
    /// The supply's: the thesis refers the wall's modulus to it.
    working: S,
    /// Midway between supply and tank, the pressure in the chambers of an idle actuator.
    operating: S,
}

impl<S: Scalar> ExpansionPressures<S> {
    /// Those of a supply and its tank.
    pub(crate) fn of(supply: S, tank: S) -> ExpansionPressures<S> {
        ExpansionPressures { working: supply, operating: S::from(0.5) * (supply + tank) }
    }
}

/// The catalogue data of a hose's volumetric expansion, m3/m, Pa and m3/(m Pa).
#[derive(Clone, Copy)]
pub(crate) struct VolumetricExpansion<S = f64> {
    pub(crate) measured: Option<S>,
    pub(crate) at: Option<S>,
    pub(crate) slope: S,
}

impl<S: Scalar> VolumetricExpansion<S> {
    /// As it is declared.
    pub(crate) fn of(declared: &HoseExpansion<S>) -> VolumetricExpansion<S> {
        let measured = declared.measured();
        let pressure = declared.pressure();
        let slope = match (declared, measured, pressure) {
            (HoseExpansion::Measured { .. }, Some(measured), Some(pressure)) => measured / pressure,
            (HoseExpansion::Slope { slope, .. }, ..) => *slope,
            (HoseExpansion::Measured { .. }, ..) => S::from(0.0),
        };
        VolumetricExpansion { measured, at: pressure, slope }
    }

    /// The declared point and the slope from there, or the slope from zero, m3/m; a point without a
    /// pressure is assumed to be at the working pressure.
    fn at(self, pressure: S, working_pressure: S) -> S {
        match self.measured {
            Some(measured) => measured + self.slope * (pressure - self.at.unwrap_or(working_pressure)),
            None => self.slope * pressure,
        }
    }
}

pub(crate) fn hose<S: Scalar>(
    bore: S,
    expansion: VolumetricExpansion<S>,
    pressures: ExpansionPressures<S>,
    dynamic_stiffening: Stiffening<S>,
) -> Hose<S> {
    let ExpansionPressures { working, operating } = pressures;
    Hose {
        bore,
        volumetric_expansion: expansion.at(working, working),
        operating_expansion: expansion.at(operating, working),
        expansion_slope: expansion.slope,
        dynamic_stiffening,
    }
}

/// A ratio without a spread is one uncertain number, one with a spread has three.
pub(crate) fn stiffening<S: Scalar>(declared: Option<Stiffening<S>>) -> Stiffening<S> {
    declared.unwrap_or(Stiffening::certain(S::from(1.0)))
}

fn pipe<S: Scalar>(declared: &project::DeclaredPipe<S>) -> Pipe<S> {
    let wall = declared.wall.map_or(PipeWall::Rigid, |wall| PipeWall::Elastic {
        thickness: wall.thickness,
        youngs_modulus: wall.youngs_modulus,
        poisson_ratio: declared.poisson_ratio,
        anchoring: Anchoring::Throughout,
        thick: true,
    });
    Pipe { bore: declared.bore, wall }
}

fn cylinder<S: Scalar>(declared: &project::DeclaredCylinder<S>) -> Cylinder<S> {
    let [area_a, area_b] = match (declared.piston_areas, declared.piston_area) {
        (None, None) => {
            let piston = declared.piston_diameter.unwrap_or_default();
            let rods = on_both_sides(declared.rod_diameters, declared.rod_diameter);
            rods.map(|rod| annulus_area(piston, rod))
        }
        (areas, area) => on_both_sides(areas, area),
    };
    let [dead_volume_a, dead_volume_b] = on_both_sides(declared.dead_volumes, declared.dead_volume);
    Cylinder {
        area_a,
        area_b,
        stroke: stroke(declared, [area_a, area_b]),
        moving_mass: declared.moving_mass,
        dead_volume_a,
        dead_volume_b,
        internal_leakage: declared.internal_leakage,
        end_stops: declared.end_stops,
    }
}

/// The stroke with the stages of a telescopic piston, whose areas are those declared, also where
/// those of the first stage are uncertain.
fn stroke<S: Scalar>(
    declared: &project::DeclaredCylinder<S>,
    [first_a, first_b]: [S; 2],
) -> ActuatorStroke<S> {
    let stroke = declared.stroke;
    if declared.stages.is_empty() {
        return ActuatorStroke::Limited(stroke);
    }
    let mut stages = [None; FURTHER_STAGES];
    for (place, stage) in stages.iter_mut().zip(&declared.stages) {
        let [area_a, area_b] = on_both_sides(stage.piston_areas, stage.piston_area);
        *place = Some(PistonStage { from: stage.from, ratios: [area_a / first_a, area_b / first_b] });
    }
    ActuatorStroke::Telescopic(Telescope { stroke, stages, transition: declared.stage_transition })
}

/// A motor in the equations of a cylinder: its displacement is the area of both chambers.
fn motor_as_cylinder<S: Scalar>(declared: &project::DeclaredMotor<S>) -> Cylinder<S> {
    let displacement = declared.displacement;
    let [dead_volume_a, dead_volume_b] = on_both_sides(declared.dead_volumes, declared.dead_volume);
    Cylinder {
        area_a: displacement,
        area_b: displacement,
        stroke: declared.stroke.map_or(ActuatorStroke::Unlimited, ActuatorStroke::Limited),
        moving_mass: declared.inertia,
        dead_volume_a,
        dead_volume_b,
        internal_leakage: declared.internal_leakage,
        end_stops: declared.end_stops,
    }
}

/// Numbers of both sides: a pair, or one number for both.
fn on_both_sides<S: Scalar>(pair: Option<[S; 2]>, single: Option<S>) -> [S; 2] {
    pair.unwrap_or([single.unwrap_or_default(); 2])
}
