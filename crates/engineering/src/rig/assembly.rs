use phea_dynamics::scalar::{Parameters, Scalar};
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::line::{Anchoring, Hose, Line, Pipe, PipeWall, Stiffening};
use phea_hydraulics::linkage::{Linkage, STANDARD_GRAVITY};
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
use super::load::load;
use super::numbers::Numbers;
use super::supply::power_unit;
use crate::project::{
    self, BoundedNumber, Component, DeclaredSeries, DeclaredSpring, DeclaredTransmission, DeclaredWeight,
    EdgeCoefficients, HoseExpansion, LineVolume, NullLeakage, RatedFlow, ValveCoefficients,
};

/// Kinematic viscosity of ISO VG 46 oil at 40 degrees Celsius, m2/s: used where a project states
/// none.
pub(super) const KINEMATIC_VISCOSITY: f64 = 46e-6;

/// The declared rig as the components of `phea_hydraulics`.
///
/// # Errors
/// Every parameter that is impossible as physics.
pub fn actuator(declared: &project::DeclaredActuator) -> Result<Actuator, ActuatorError> {
    Actuator::new(components(declared, &Numbers::declared()))
}

/// The same over any scalar, before it is checked: each number of the project is looked up by its
/// path.
pub fn components<S: Scalar>(
    declared: &project::DeclaredActuator,
    numbers: &Numbers<'_, S>,
) -> Components<S> {
    let pressure = numbers.at("supply.pressure", declared.supply.pressure);
    let tank_pressure = numbers.at("supply.tank_pressure", declared.supply.tank_pressure);
    let pressures = ExpansionPressures::of(pressure, tank_pressure);
    let line = |side, declared: &project::DeclaredLine| line(declared, &numbers.of_line(side), pressures);
    let fluid = fluid(&declared.fluid, numbers);
    Components {
        gas: [("a", &declared.line.a), ("b", &declared.line.b)].map(|(side, line)| {
            Some(chamber_gas(line.accumulator.as_ref()?, &numbers.of_line(side), &fluid))
        }),
        fluid,
        supply: Supply { pressure, tank_pressure },
        power_unit: power_unit(declared, numbers),
        valve: valve(&declared.valve, numbers, pressure - tank_pressure),
        line_a: line("a", &declared.line.a),
        line_b: line("b", &declared.line.b),
        line_models: [&declared.line.a, &declared.line.b].map(|line| line_model(&line.motion)),
        cross_port: cross_port(declared.cross_port.as_ref(), numbers, fluid.density),
        cylinder: match &declared.motor {
            None => cylinder(&declared.cylinder, numbers),
            Some(motor) => motor_as_cylinder(motor, numbers),
        },
        friction: friction(declared.friction(), &numbers.within(declared.moving_part())),
        force_sensor: ForceSensor {
            stiffness: numbers.at("force_sensor.stiffness", declared.force_sensor.stiffness),
        },
        series: declared.series.as_ref().map(|series| self::series(series, &numbers.within("series"))),
        linkage: declared.linkage.as_ref().map(|linkage| {
            self::linkage(linkage, declared.cylinder.stroke, &numbers.within("linkage.weight"))
        }),
        load: load(&declared.load, numbers),
        velocity_gain: velocity_gain(declared, numbers),
        stiffness_model: declared.line.compliance,
    }
}

/// The linkage over the declared stroke; [`Actuator::new`] refuses one that does not exist.
fn linkage<S: Scalar>(
    declared: &project::DeclaredLinkage,
    stroke: f64,
    numbers: &Numbers<'_, S>,
) -> Linkage<S> {
    let Ok(reduced) = declared.reduced(stroke) else { return Linkage::impossible() };
    let Some(DeclaredWeight { mass, centre_distance, .. }) = declared.weight else {
        return reduced.linkage.convert(&mut S::from);
    };
    let moment = numbers.at("mass", mass) * numbers.at("centre_distance", centre_distance);
    reduced.linkage.convert(&mut S::from).with_moment(moment * S::from(STANDARD_GRAVITY))
}

/// What lies between force sensor and load.
fn series<S: Scalar>(declared: &DeclaredSeries, numbers: &Numbers<'_, S>) -> SeriesElement<S> {
    match declared {
        DeclaredSeries::Spring(declared) => SeriesElement::Spring(spring(declared, numbers)),
        DeclaredSeries::Transmission(declared) => {
            SeriesElement::Transmission(transmission(declared, numbers))
        }
    }
}

/// The expansion of its hose is that at the filling pressure.
fn transmission<S: Scalar>(declared: &DeclaredTransmission, numbers: &Numbers<'_, S>) -> Transmission<S> {
    let at = |key: &str, value: f64| numbers.at(key, value);
    let filling_pressure = at("filling_pressure", declared.filling_pressure);
    let pressures = ExpansionPressures { working: filling_pressure, operating: filling_pressure };
    Transmission {
        piston_area: at("piston_area", declared.piston_area),
        line: line(&declared.line, &numbers.within("line"), pressures),
        end_volume: at("end_volume", declared.end_volume),
        filling_pressure,
        segments: declared.segments as usize,
    }
}

/// A damper, a mass or a progression of zero is left out.
fn spring<S: Scalar>(declared: &DeclaredSpring, numbers: &Numbers<'_, S>) -> SeriesSpring<S> {
    let at = |key: &str, value: f64| numbers.at(key, value);
    let where_any =
        |key: &str, value: f64| (value > 0.0 || numbers.is_open(key)).then(|| numbers.at(key, value));
    SeriesSpring {
        stiffness: at("stiffness", declared.stiffness),
        damping: where_any("damping", declared.damping),
        mass: where_any("mass", declared.mass),
        travel: declared.travel.map(|travel| SeriesTravel {
            travel: at("travel", travel),
            progression: where_any("progression", declared.progression),
            ends: declared.stop_stiffness.map(|stiffness| Contact {
                stiffness: at("stop_stiffness", stiffness),
                relative_damping: at("stop_damping", declared.stop_damping),
            }),
        }),
        force_from: declared.force_from,
    }
}

fn fluid<S: Scalar>(declared: &project::DeclaredFluid, numbers: &Numbers<'_, S>) -> Fluid<S> {
    let numbers = numbers.within("fluid");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let holds = |fraction: &f64| *fraction > 0.0 || numbers.is_open("fluid.entrained_air");
    Fluid {
        bulk_modulus: at("bulk_modulus", declared.bulk_modulus),
        density: at("density", declared.density),
        kinematic_viscosity: at(
            "kinematic_viscosity",
            declared.kinematic_viscosity.unwrap_or(KINEMATIC_VISCOSITY),
        ),
        entrained_air: declared.entrained_air.filter(holds).map(|fraction| EntrainedAir {
            volume_fraction: at("entrained_air", fraction),
            polytropic_exponent: at("polytropic_exponent", declared.polytropic_exponent),
        }),
        vapour_pressure_absolute: at("vapour_pressure", declared.vapour_pressure),
    }
}

/// ValveCoefficients as declared; without them, those of the data sheet, equal for all edges.
fn valve<S: Scalar>(declared: &project::Valve, numbers: &Numbers<'_, S>, supply_drop: S) -> Servovalve<S> {
    let numbers = numbers.within("valve");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let edges = |table: &'static str, edges: EdgeCoefficients| {
        let [supply_to_a, a_to_tank, supply_to_b, b_to_tank] = edges.in_order();
        let numbers = numbers.within(table);
        let at = |key: &str, value: f64| numbers.at(key, value);
        Edges {
            supply_to_a: at("supply_to_a", supply_to_a),
            a_to_tank: at("a_to_tank", a_to_tank),
            supply_to_b: at("supply_to_b", supply_to_b),
            b_to_tank: at("b_to_tank", b_to_tank),
        }
    };
    let opening = opening(declared, &numbers);
    let tare_flow = at("tare_flow", declared.tare_flow);
    let tare_drop = declared.tare_pressure.map_or(supply_drop, |drop| at("tare_pressure", drop));
    Servovalve {
        flow_coefficients: match declared.flow {
            ValveCoefficients::Edges { edges: flow, .. } => edges("flow_coefficients", flow),
            ValveCoefficients::Rated(RatedFlow { flow, pressure_drop }) => {
                let drop = at("nominal_pressure_drop", pressure_drop);
                let rated = flow_coefficient_from_rating(at("nominal_flow", flow), drop);
                // the data sheet's flow is that of full travel
                let [positive, negative] = opening.full().map(|full| rated / full);
                Edges::from_array([positive, negative, negative, positive])
            }
        },
        opening,
        leakage_coefficients: match declared.leakage {
            ValveCoefficients::Edges { edges: leakage, .. } if is_shut(leakage) => Edges::vanishing(),
            ValveCoefficients::Edges { edges: leakage, .. } => edges("leakage_coefficients", leakage),
            ValveCoefficients::Rated(NullLeakage { flow, pressure, .. }) => {
                let (leakage, pressure) = (at("null_leakage", flow), at("null_leakage_pressure", pressure));
                Edges::equal(leakage_coefficient_from_rating(leakage, tare_flow, tare_drop, pressure))
            }
        },
        leakage_shape: match declared.leakage_shapes {
            Some(shapes) => LeakageShape::ByEdge(edges("leakage_shapes", shapes)),
            None => LeakageShape::Common(at("leakage_shape", declared.leakage_shape)),
        },
        leakage_model: declared.leakage_model,
        tare_flow,
        tare_reference_drop: tare_drop,
        nominal_voltage: at("nominal_voltage", declared.nominal_voltage),
        natural_frequency: at("natural_frequency", declared.natural_frequency),
        damping_ratio: at("damping_ratio", declared.damping_ratio),
        transition_pressure: at("transition_pressure", declared.transition_pressure),
        spool: SpoolImperfection {
            null_bias: at("null_bias", declared.null_bias),
            hysteresis_width: declared.hysteresis.map(|width| at("hysteresis", width)),
            threshold: declared.threshold.map(|threshold| at("threshold", threshold)),
            rate_limit: declared.rate_limit.map(|limit| at("rate_limit", limit)),
        },
    }
}

/// How the declared edges open: in proportion where neither lap nor saturation is stated.
fn opening<S: Scalar>(declared: &project::Valve, numbers: &Numbers<'_, S>) -> OpeningLaw<S> {
    let saturates = declared.saturation != 0.0 || numbers.is_open("saturation");
    if declared.lap.is_none() && !saturates {
        return OpeningLaw::Proportional;
    }
    let lap = declared.lap.unwrap_or_default();
    OpeningLaw::Shaped(OpeningShape {
        lap_positive: numbers.at("lap.positive", lap.positive),
        lap_negative: numbers.at("lap.negative", lap.negative),
        saturation: numbers.at("saturation", declared.saturation),
    })
}

/// Whether no edge leaks: an ideal valve.
fn is_shut(leakage: EdgeCoefficients) -> bool {
    leakage.in_order().iter().all(|edge| *edge == 0.0)
}

/// The line as physics.
fn line<S: Scalar>(
    declared: &project::DeclaredLine,
    numbers: &Numbers<'_, S>,
    pressures: ExpansionPressures<S>,
) -> Line<S> {
    let at = |key: &str, value: f64| numbers.at(key, value);
    match &declared.component {
        Component::Volume(LineVolume { volume, effective_bulk_modulus }) => Line::Volume {
            volume: at("volume", *volume),
            effective_bulk_modulus: at("effective_bulk_modulus", *effective_bulk_modulus),
        },
        Component::Pipe { pipe, length } => {
            Line::Pipe { pipe: self::pipe(pipe, numbers), length: at("length", *length) }
        }
        Component::Hose { properties, length, .. } => {
            let expansion = VolumetricExpansion::of(&properties.expansion, numbers);
            let stiffening = stiffening(declared.dynamic_stiffening, numbers);
            Line::Hose {
                hose: hose(at("bore", properties.bore), expansion, pressures, stiffening),
                length: at("length", *length),
            }
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
    pub(crate) fn of(declared: &HoseExpansion, numbers: &Numbers<'_, S>) -> VolumetricExpansion<S> {
        let measured = declared.measured().map(|value| numbers.at("volumetric_expansion", value));
        let pressure = declared.pressure().map(|value| numbers.at("volumetric_expansion_pressure", value));
        let slope = match (declared, measured, pressure) {
            (HoseExpansion::Measured { .. }, Some(measured), Some(pressure)) => measured / pressure,
            _ => numbers.at("volumetric_expansion_slope", declared.slope()),
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
pub(crate) fn stiffening<S: Scalar>(
    declared: Option<BoundedNumber>,
    numbers: &Numbers<'_, S>,
) -> Stiffening<S> {
    let BoundedNumber { nominal, minimum, maximum } = declared.unwrap_or(BoundedNumber::exactly(1.0));
    let at = |part: &str, value: f64| {
        let whole = numbers.get("dynamic_stiffening");
        whole.unwrap_or_else(|| numbers.within("dynamic_stiffening").at(part, value))
    };
    Stiffening {
        nominal: at("nominal", nominal),
        minimum: at("minimum", minimum),
        maximum: at("maximum", maximum),
    }
}

fn pipe<S: Scalar>(declared: &project::DeclaredPipe, numbers: &Numbers<'_, S>) -> Pipe<S> {
    let numbers = numbers.within("pipe");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let wall = declared.wall.map_or(PipeWall::Rigid, |wall| PipeWall::Elastic {
        thickness: at("wall_thickness", wall.thickness),
        youngs_modulus: at("youngs_modulus", wall.youngs_modulus),
        poisson_ratio: at("poisson_ratio", declared.poisson_ratio),
        anchoring: Anchoring::Throughout,
        thick: true,
    });
    Pipe { bore: at("bore", declared.bore), wall }
}

fn cylinder<S: Scalar>(declared: &project::DeclaredCylinder, numbers: &Numbers<'_, S>) -> Cylinder<S> {
    let numbers = numbers.within("cylinder");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let both = |pair, key: &str, single| on_both_sides(pair, key, single, &numbers);
    let [area_a, area_b] = match (declared.piston_areas, declared.piston_area) {
        (None, None) => {
            let piston = at("piston_diameter", declared.piston_diameter.unwrap_or(0.0));
            let rods = both(declared.rod_diameters, "rod_diameter", declared.rod_diameter);
            rods.map(|rod| annulus_area(piston, rod))
        }
        (areas, area) => both(areas, "piston_area", area),
    };
    let [dead_volume_a, dead_volume_b] = both(declared.dead_volumes, "dead_volume", declared.dead_volume);
    Cylinder {
        area_a,
        area_b,
        stroke: stroke(declared, [area_a, area_b], &at),
        moving_mass: at("moving_mass", declared.moving_mass),
        dead_volume_a,
        dead_volume_b,
        internal_leakage: declared.internal_leakage.map(|value| at("internal_leakage", value)),
        external_leakage: None,
        end_stops: end_stops(declared.end_stops, &numbers),
    }
}

/// The stroke with the stages of a telescopic piston, whose areas are those declared, also where
/// those of the first stage are uncertain.
fn stroke<S: Scalar>(
    declared: &project::DeclaredCylinder,
    [first_a, first_b]: [S; 2],
    at: &impl Fn(&str, f64) -> S,
) -> ActuatorStroke<S> {
    let stroke = at("stroke", declared.stroke);
    if declared.stages.is_empty() {
        return ActuatorStroke::Limited(stroke);
    }
    let mut stages = [None; FURTHER_STAGES];
    for (index, (place, stage)) in stages.iter_mut().zip(&declared.stages).enumerate() {
        let at = |key: &str, value: f64| at(&format!("stage[{index}].{key}"), value);
        let [area_a, area_b] = match stage.piston_areas {
            Some(areas) => areas.map(S::from),
            None => [at("piston_area", stage.areas_m2()[0]); 2],
        };
        *place =
            Some(PistonStage { from: at("from", stage.from), ratios: [area_a / first_a, area_b / first_b] });
    }
    ActuatorStroke::Telescopic(Telescope {
        stroke,
        stages,
        transition: at("stage_transition", declared.stage_transition),
    })
}

/// A motor in the equations of a cylinder: its displacement is the area of both chambers.
fn motor_as_cylinder<S: Scalar>(declared: &project::DeclaredMotor, numbers: &Numbers<'_, S>) -> Cylinder<S> {
    let numbers = numbers.within("motor");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let displacement = at("displacement", declared.displacement);
    let [dead_volume_a, dead_volume_b] =
        on_both_sides(declared.dead_volumes, "dead_volume", declared.dead_volume, &numbers);
    Cylinder {
        area_a: displacement,
        area_b: displacement,
        stroke: declared
            .stroke
            .map_or(ActuatorStroke::Unlimited, |stroke| ActuatorStroke::Limited(at("stroke", stroke))),
        moving_mass: at("inertia", declared.inertia),
        dead_volume_a,
        dead_volume_b,
        internal_leakage: declared.internal_leakage.map(|value| at("internal_leakage", value)),
        external_leakage: declared.case_leakage.map(|value| at("case_leakage", value)),
        end_stops: end_stops(declared.end_stops, &numbers),
    }
}

/// Two numbers in one key are never uncertain; one number for both sides can be.
fn on_both_sides<S: Scalar>(
    pair: Option<[f64; 2]>,
    key: &str,
    single: Option<f64>,
    numbers: &Numbers<'_, S>,
) -> [S; 2] {
    match pair {
        Some(pair) => pair.map(S::from),
        None => [numbers.at(key, single.unwrap_or(0.0)); 2],
    }
}

fn end_stops<S: Scalar>(declared: Option<project::EndStops>, numbers: &Numbers<'_, S>) -> Option<Contact<S>> {
    declared.map(|stops| Contact {
        stiffness: numbers.at("end_stops.stiffness", stops.stiffness),
        relative_damping: numbers.at("end_stops.relative_damping", stops.relative_damping),
    })
}
