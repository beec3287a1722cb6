use phea_dynamics::portable::ln;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::force_sensor::in_series;
use phea_hydraulics::line::ExpansionPressures;
use phea_hydraulics::linear::LinearParameters;

use super::{
    HoseName, HoseOption, OtherMeansProblem, SizedLoad, SizingProblem, SoonerRequirement, TimeConstantOrigin,
    UnlikeLines,
};
use crate::catalogue::{Catalogue, CatalogueKind, DASH_SIZES};
use crate::caveat::{acting_port_valves, overlap};
use crate::project::{self, HoseProperties, Load, Project, SettlingTime, Speed};
use crate::rig::{Rig, RigError, largest_flow};
use crate::setup::Setup;
use crate::simulate::time_requirements;

/// Recommended oil velocity of pressure lines, m/s (Rabie 2009, quoted in Ledezma 2019, section
/// 6.3.1.1).
const OIL_VELOCITY: [f64; 2] = [2.1, 4.6];
/// Smallest practical gain, V/N (Ledezma 2019, section 6.3.2, step j).
const MINIMUM_GAIN: f64 = 1e-4;
/// Gain at which the search starts, V/N (Ledezma 2019, section 6.3.2, step f: a unitary value).
const MAXIMUM_GAIN: f64 = 1.0;
/// Ratio of a settling time to the required one up to which they count as equal.
const ROUNDED: f64 = 1.001;
/// Acceptable length of a line if the project states none, m.
const HOSE_LENGTH: [f64; 2] = [0.1, 10.0];

/// Reason why a project cannot be sized.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizingError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The project does not request a sizing.
    #[error(
        "the project has no [sizing]: add one with `time_constant`, or `settling_time` and `settling_band_percent`"
    )]
    Absent,
    /// The gas of an accumulator would do part of the work of the hose.
    #[error(
        "sizing finds the hose that is soft enough by itself and counts no gas: size without [line] `accumulator`"
    )]
    Accumulator,
    /// A capacity between the chambers would do part of the work of the hose.
    #[error(
        "sizing finds the hose that is soft enough by itself and counts no capacity between the chambers: size without [cross_port] `kind` = \"dynamic_pressure_feedback\""
    )]
    Capacity,
    /// The procedure has one area over the stroke.
    #[error(
        "sizing has one area over the stroke, and the stages of a telescopic piston have several: size for one of them, without [[cylinder.stage]], with its areas and its share of the stroke"
    )]
    Stages,
    /// The catalogue contains no suitable hose.
    #[error("no hose with bore and volumetric expansion in the catalogue or the project")]
    NoHose,
}

/// Input of the sizing procedure, resolved from project, rig and catalogue.
///
/// # Errors
/// [`SizingError`] if the project does not state the target of the sizing.
pub fn sizing_problem(setup: &Setup<'_>, catalogue: &Catalogue) -> Result<SizingProblem, SizingError> {
    let (project, rig) = (setup.project, setup.rig()?);
    let requirement = project.sizing.as_ref().ok_or(SizingError::Absent)?;
    let actuator = project.actuator.as_ref().ok_or(SizingError::NoHose)?;
    let components = rig.actuator.components();
    refuse_what_no_hose_is_sized_for(components)?;
    let (time_constant, time_constant_origin) = time_constant(requirement.speed);
    let hoses = hoses(actuator, catalogue);
    if hoses.is_empty() {
        return Err(SizingError::NoHose);
    }
    // The valve at null, unless [linear] states its parameters; the nominal value of [uncertainty]
    // belongs to the plant of the controller.
    let outright = |name: &str, derived: f64| project.linear.get(name).unwrap_or(derived);
    let leakage = rig.parameters.iter().find(|parameter| parameter.name == "flow_pressure_coefficient");
    Ok(SizingProblem {
        cylinder: components.cylinder,
        linear: LinearParameters {
            flow_gain: requirement.flow_gain.unwrap_or(outright("flow_gain", rig.derived.flow_gain)),
            flow_pressure_coefficient: rig.internal_leakage
                + requirement
                    .flow_pressure_coefficient
                    .unwrap_or(outright("flow_pressure_coefficient", rig.derived.flow_pressure_coefficient)),
            ..against_load(actuator, rig)
        },
        sensor_without_load: rig.softened(&rig.linear).sensor_stiffness,
        load: sized_load(actuator, rig),
        dead_band: dead_band(setup, requirement.flow_gain)?,
        null_flow_gains: rig.null_flow_gains().filter(|_| {
            requirement
                .flow_gain
                .or(project.linear.get("flow_gain"))
                .or(project.operating_point.spool_side)
                .is_none()
        }),
        fluid_modulus: components.fluid.modulus_at(rig.actuator.mean_pressure()),
        density: components.fluid.density,
        flow_pressure_coefficient_maximum: leakage
            .and_then(|parameter| parameter.bounds)
            .map(|bounds| bounds[1] + rig.internal_leakage),
        internal_leakage: rig.internal_leakage,
        time_constant,
        time_constant_origin,
        sooner: sooner(project, time_constant),
        flow: largest_flow(components, &actuator.supply),
        oil_velocity: requirement.oil_velocity.unwrap_or(OIL_VELOCITY),
        minimum_gain: requirement.minimum_gain.unwrap_or(MINIMUM_GAIN),
        maximum_gain: requirement.maximum_gain.unwrap_or(MAXIMUM_GAIN),
        length_increment: requirement.length_increment,
        stock_length: requirement.stock_length,
        hose_length: requirement.hose_length.unwrap_or(HOSE_LENGTH),
        supply_pressure: actuator.supply.pressure,
        model: components.stiffness_model,
        unlike: unlike(actuator),
        port_valves: acting_port_valves(rig),
        hoses,
        other_means: other_means(requirement, actuator, rig),
        market_bores: DASH_SIZES.iter().map(|(name, bore)| (name.to_string(), *bore)).collect(),
    })
}

/// Rejects parts for which the procedure's model does not hold.
fn refuse_what_no_hose_is_sized_for(components: &Components) -> Result<(), SizingError> {
    if components.gas.iter().any(Option::is_some) {
        return Err(SizingError::Accumulator);
    }
    if components.cross_port.is_some_and(|port| port.capacity.is_some()) {
        return Err(SizingError::Capacity);
    }
    match components.cylinder.stroke.telescope() {
        Some(_) => Err(SizingError::Stages),
        None => Ok(()),
    }
}

/// Load for which a hose is sized: a wall is assumed to be in contact.
fn sized_load(declared: &project::DeclaredActuator, rig: &Rig) -> SizedLoad {
    match (&declared.load, rig.load_stiffness()) {
        (Load::Prescribed, _) => SizedLoad::Prescribed,
        (_, Some(stiffness)) => SizedLoad::Yielding { stiffness },
        (Load::Wall { stiffness, .. }, None) if declared.linkage.is_none() => {
            SizedLoad::Yielding { stiffness: *stiffness }
        }
        (_, None) => SizedLoad::HeldStill,
    }
}

/// Linear parameters in use, with series element and load in series with the force sensor.
fn against_load(declared: &project::DeclaredActuator, rig: &Rig) -> LinearParameters {
    let softened = rig.softened(&rig.linear);
    match sized_load(declared, rig) {
        SizedLoad::Yielding { stiffness } => {
            LinearParameters { sensor_stiffness: in_series(softened.sensor_stiffness, stiffness), ..softened }
        }
        SizedLoad::Prescribed | SizedLoad::HeldStill => softened,
    }
}

/// Input for the other means, if they are requested.
fn other_means(
    requirement: &project::DeclaredSizing,
    declared: &project::DeclaredActuator,
    rig: &Rig,
) -> Option<OtherMeansProblem> {
    let cylinder = &declared.cylinder;
    Some(OtherMeansProblem {
        requirement: requirement.other_means.clone()?,
        actuator: rig.actuator,
        linear: rig.leaking(),
        position: rig.point.position,
        length: cylinder.dead_length.map(|dead| cylinder.longest_stage_m() + dead),
    })
}

/// Time constant, s, and its origin: a first-order response enters a band of b percent after
/// ln(100/b) time constants.
fn time_constant(speed: Speed) -> (f64, TimeConstantOrigin) {
    match speed {
        Speed::TimeConstant(time) => (time, TimeConstantOrigin::Stated),
        Speed::Settling(SettlingTime { time, band_percent }) => {
            let constants = ln(100.0 / band_percent);
            let origin = TimeConstantOrigin::Settling { settling_time: time, band_percent, constants };
            (time / constants, origin)
        }
    }
}

/// Hoses of the catalogue, with the values that the project states for a hose of that name, on both
/// sides; and the project's hoses that have no name, or differ between its sides.
fn hoses(actuator: &project::DeclaredActuator, catalogue: &Catalogue) -> Vec<HoseOption> {
    let lines = [&actuator.line.a, &actuator.line.b];
    let own = lines.map(|line| line.hose());
    // a side without a hose takes the stiffening of the other
    let stiffenings = [0, 1].map(|side: usize| match (own[side], own[1 - side]) {
        (None, Some(_)) => lines[1 - side].dynamic_stiffening,
        _ => lines[side].dynamic_stiffening,
    });
    let pressures = ExpansionPressures::of(actuator.supply.pressure, actuator.supply.tank_pressure);
    let option = |name: HoseName, properties: [&HoseProperties; 2]| {
        let hoses = [0, 1].map(|side: usize| properties[side].component(pressures, stiffenings[side]));
        let [working_a, working_b] = properties.map(|hose| hose.working_pressure);
        let stated = properties.map(|hose| hose.expansion.pressure());
        let [radius_a, radius_b] = properties.map(|hose| hose.minimum_bend_radius);
        HoseOption {
            name,
            hoses,
            working_pressure: working_a.zip(working_b).map(|(one, other)| one.min(other)),
            expansion_stated_at: stated.into_iter().flatten().reduce(f64::min),
            minimum_bend_radius: [radius_a, radius_b].into_iter().flatten().reduce(f64::max),
        }
    };
    let declared = match own {
        [None, None] => None,
        [Some(a), Some(b)] => Some([a, b]),
        [Some(only), None] | [None, Some(only)] => Some([only; 2]),
    };
    let mut declared = declared.zip(own_hoses(actuator));
    let mut hoses: Vec<HoseOption> = Vec::new();
    for entry in catalogue.entries(CatalogueKind::Hose) {
        let name = HoseName::named(&entry.name);
        match declared.take_if(|(_, own)| *own == name) {
            Some((own, _)) => hoses.push(option(name, own)),
            None => hoses.extend(entry.hose.as_ref().map(|hose| option(name, [hose; 2]))),
        }
    }
    // a name of the catalogue is not one of the project's hoses
    let own = declared.filter(|(_, name)| !matches!(name, HoseName::Both(Some(_))));
    hoses.extend(own.map(|(own, name)| option(name, own)));
    hoses
}

/// Name of the hoses of a project among those to choose from; `None` if it has none.
pub(crate) fn own_hoses(actuator: &project::DeclaredActuator) -> Option<HoseName> {
    let lines = [&actuator.line.a, &actuator.line.b];
    let [name_a, name_b] = lines.map(|line| line.hose_name().map(str::to_string));
    match lines.map(|line| line.hose()) {
        [None, None] => None,
        [Some(_), None] => Some(HoseName::Both(name_a)),
        [None, Some(_)] => Some(HoseName::Both(name_b)),
        [Some(a), Some(b)] if a == b && name_a == name_b => Some(HoseName::Both(name_a)),
        [Some(_), Some(_)] => Some(HoseName::Each([name_a, name_b])),
    }
}

/// Difference between the declared lines.
fn unlike(actuator: &project::DeclaredActuator) -> Option<UnlikeLines> {
    let [line_a, line_b] = [&actuator.line.a, &actuator.line.b];
    match (line_a.hose(), line_b.hose()) {
        (Some(a), Some(b)) if a == b && line_a.dynamic_stiffening == line_b.dynamic_stiffening => None,
        (Some(_), Some(_)) => Some(UnlikeLines::HosesDiffer),
        (None, None) => None,
        (Some(_), None) => Some(UnlikeLines::LineBIsNoHose),
        (None, Some(_)) => Some(UnlikeLines::LineAIsNoHose),
    }
}

/// Requirement in time that needs the shortest time constant, if this time constant misses it.
///
/// ```text
/// t_s = tau_d ln(100/band)                    of a first-order response, the band in percent
/// ```
fn sooner(project: &Project, time_constant_s: f64) -> Option<SoonerRequirement> {
    let each = time_requirements(project).ok()?.into_iter().filter_map(|one| {
        let band_percent = one.step_limits.band_percent;
        let settles = time_constant_s * ln(100.0 / band_percent);
        let required = one.step_limits.settling_time_s.filter(|time_s| settles > ROUNDED * time_s)?;
        Some(SoonerRequirement { specification: one.number, band_percent, settles, required })
    });
    let beyond = |one: &SoonerRequirement| one.settles / one.required;
    each.max_by(|one, other| beyond(one).total_cmp(&beyond(other)))
}

/// Ratio of K_qU at null to that beyond the lap, for a valve whose edges overlap, if no K_qU is
/// stated.
fn dead_band(setup: &Setup<'_>, stated: Option<f64>) -> Result<Option<f64>, SizingError> {
    let components = setup.rig()?.actuator.components();
    let is_stated = stated.or(setup.project.linear.get("flow_gain")).is_some();
    let found = overlap::dead_band(&components.valve, &components.supply).map(|[_, _, fraction]| fraction);
    Ok(found.filter(|_| !is_stated))
}
