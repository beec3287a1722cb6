use phea_dynamics::portable::ln;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::force_sensor::in_series;
use phea_hydraulics::linear::LinearParameters;

use super::{HoseOption, OtherMeansProblem, SizedLoad, SizingProblem};
use crate::catalogue::{Catalogue, CatalogueKind, DASH_SIZES};
use crate::caveat::overlap;
use crate::project::{self, HoseProperties, Load, Project, SettlingTime, Speed};
use crate::quantity::significant;
use crate::rig::{
    ExpansionPressures, Numbers, Rig, RigError, VolumetricExpansion, hose, largest_flow, stiffening,
};
use crate::setup::Setup;
use crate::simulate::time_requirements;

/// Recommended oil velocity of pressure lines, m/s (Rabie 2009, quoted in Ledezma 2019, section
/// 6.3.1.1).
const OIL_VELOCITY: [f64; 2] = [2.1, 4.6];
/// Smallest practical gain, V/N (Ledezma 2019, section 6.3.2, step j).
const MINIMUM_GAIN: f64 = 1e-4;
/// Gain at which the search starts, V/N (the same, step f: a unitary value).
const MAXIMUM_GAIN: f64 = 1.0;
/// A settling time that is longer by less is that which is required.
const ROUNDED: f64 = 1.001;
/// Acceptable length of a line where the project states none, m.
const HOSE_LENGTH: [f64; 2] = [0.1, 10.0];

/// Why a project cannot be sized.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizingError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// There is nothing to size for.
    #[error(
        "the project has no [sizing]: add one with `time_constant`, or `settling_time` and `settling_band_percent`"
    )]
    Absent,
    /// The gas of an accumulator would share the work of the hose.
    #[error(
        "sizing finds the hose that is soft enough by itself and counts no gas: size without [line] `accumulator`"
    )]
    Accumulator,
    /// A capacity between the chambers would share the work of the hose.
    #[error(
        "sizing finds the hose that is soft enough by itself and counts no capacity between the chambers: size without [cross_port] `kind` = \"dynamic_pressure_feedback\""
    )]
    Capacity,
    /// The procedure has one area.
    #[error(
        "sizing has one area over the stroke, and the stages of a telescopic piston have several: size for one of them, without [[cylinder.stage]], with its areas and its share of the stroke"
    )]
    Stages,
    /// The catalogue contains nothing to choose from.
    #[error("no hose with bore and volumetric expansion in the catalogue or the project")]
    NoHose,
}

/// Everything the sizing procedure needs, resolved from project, rig and catalogue.
///
/// # Errors
/// [`SizingError`] if the project does not state what to size for.
pub fn sizing_problem(setup: &Setup<'_>, catalogue: &Catalogue) -> Result<SizingProblem, SizingError> {
    let (project, rig) = (setup.project, setup.rig()?);
    let wish = project.sizing.as_ref().ok_or(SizingError::Absent)?;
    let actuator = project.actuator.as_ref().ok_or(SizingError::NoHose)?;
    let components = rig.actuator.components();
    refuse_what_no_hose_is_sized_for(components)?;
    let (time_constant, time_constant_origin) = time_constant(wish.speed);
    let time_constant_origin = match sooner(project, time_constant) {
        Some(required) => format!("{time_constant_origin}; {required}"),
        None => time_constant_origin,
    };
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
            flow_gain: wish.flow_gain.unwrap_or(outright("flow_gain", rig.derived.flow_gain)),
            flow_pressure_coefficient: rig.internal_leakage
                + wish
                    .flow_pressure_coefficient
                    .unwrap_or(outright("flow_pressure_coefficient", rig.derived.flow_pressure_coefficient)),
            ..against_load(actuator, rig)
        },
        sensor_alone: rig.softened(&rig.linear).sensor_stiffness,
        load: sized_load(actuator, rig),
        dead_band: dead_band(setup, wish.flow_gain)?,
        null_flow_gains: rig.null_flow_gains().filter(|_| {
            wish.flow_gain
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
        flow: largest_flow(components, &actuator.supply),
        oil_velocity: wish.oil_velocity.unwrap_or(OIL_VELOCITY),
        minimum_gain: wish.minimum_gain.unwrap_or(MINIMUM_GAIN),
        maximum_gain: wish.maximum_gain.unwrap_or(MAXIMUM_GAIN),
        length_increment: wish.length_increment,
        stock_length: wish.stock_length,
        hose_length: wish.hose_length.unwrap_or(HOSE_LENGTH),
        supply_pressure: actuator.supply.pressure,
        model: components.stiffness_model,
        unlike: unlike(actuator),
        hoses,
        other_means: other_means(wish, actuator, rig),
        market_bores: DASH_SIZES.iter().map(|(name, bore)| (name.to_string(), *bore)).collect(),
    })
}

/// Parts beside which the procedure's model does not hold.
fn refuse_what_no_hose_is_sized_for(components: &Components) -> Result<(), SizingError> {
    if components.accumulators.iter().any(Option::is_some) {
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

/// What the specimen is to a hose that is sized: the wall that is sized for is touched.
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

/// The linear parameters in use, with series element and load in series with the force sensor.
fn against_load(declared: &project::DeclaredActuator, rig: &Rig) -> LinearParameters {
    let softened = rig.softened(&rig.linear);
    match sized_load(declared, rig) {
        SizedLoad::Yielding { stiffness } => {
            LinearParameters { sensor_stiffness: in_series(softened.sensor_stiffness, stiffness), ..softened }
        }
        SizedLoad::Prescribed | SizedLoad::HeldStill => softened,
    }
}

/// What the other means are sized from, where somebody asks.
fn other_means(
    wish: &project::DeclaredSizing,
    declared: &project::DeclaredActuator,
    rig: &Rig,
) -> Option<OtherMeansProblem> {
    let cylinder = &declared.cylinder;
    Some(OtherMeansProblem {
        wish: wish.other_means.clone()?,
        actuator: rig.actuator,
        linear: rig.leaking(),
        position: rig.point.position,
        length: cylinder.dead_length.map(|dead| cylinder.longest_stage_m() + dead),
    })
}

/// s, and where it comes from: a first-order response enters a band of b percent after ln(100/b)
/// time constants.
fn time_constant(speed: Speed) -> (f64, String) {
    match speed {
        Speed::TimeConstant(time) => (time, "stated".to_string()),
        Speed::Settling(SettlingTime { time, band_percent }) => {
            let constants = ln(100.0 / band_percent);
            let origin = format!(
                "{} s to {band_percent} % is {} time constants of a first-order response (the thesis takes four whatever the band: for its numbers state `time_constant`)",
                significant(time, 4),
                significant(constants, 3)
            );
            (time / constants, origin)
        }
    }
}

/// The hoses of the catalogue, with the values that the project states for one of the same name, on
/// both sides; its own that have no name, or differ between its sides.
fn hoses(actuator: &project::DeclaredActuator, catalogue: &Catalogue) -> Vec<HoseOption> {
    let lines = [&actuator.line.a, &actuator.line.b];
    let own = lines.map(|line| line.hose());
    // a side without a hose takes the stiffening of the other
    let stiffenings = [0, 1].map(|side: usize| match (own[side], own[1 - side]) {
        (None, Some(_)) => lines[1 - side].dynamic_stiffening,
        _ => lines[side].dynamic_stiffening,
    });
    let pressures = ExpansionPressures::of(actuator.supply.pressure, actuator.supply.tank_pressure);
    let option = |name: &str, properties: [&HoseProperties; 2]| {
        let hoses = [0, 1].map(|side: usize| {
            let expansion = VolumetricExpansion::of(&properties[side].expansion, &Numbers::declared());
            let stiffening = stiffening(stiffenings[side], &Numbers::declared());
            hose(properties[side].bore, expansion, pressures, stiffening)
        });
        let [working_a, working_b] = properties.map(|hose| hose.working_pressure);
        let stated = properties.map(|hose| hose.expansion.pressure());
        let [radius_a, radius_b] = properties.map(|hose| hose.minimum_bend_radius);
        HoseOption {
            name: name.to_string(),
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
    let name = own_hoses(actuator);
    let mut declared = declared.zip(name.as_deref());
    let mut hoses: Vec<HoseOption> = Vec::new();
    for entry in catalogue.entries(CatalogueKind::Hose) {
        match declared.filter(|(_, name)| *name == entry.name) {
            Some((own, name)) => {
                hoses.push(option(name, own));
                declared = None;
            }
            None => hoses.extend(entry.hose.as_ref().map(|hose| option(&entry.name, [hose; 2]))),
        }
    }
    // a name of the catalogue is none of the project's own
    let of_catalogue = |name: &str| lines.iter().any(|line| line.hose_name() == Some(name));
    hoses.extend(declared.filter(|(_, name)| !of_catalogue(name)).map(|(own, name)| option(name, own)));
    hoses
}

/// What the hoses of a project are called among those to choose from; `None` where it has none.
pub(crate) fn own_hoses(actuator: &project::DeclaredActuator) -> Option<String> {
    let lines = [&actuator.line.a, &actuator.line.b];
    let named = |line: &project::DeclaredLine| line.hose_name().unwrap_or("the project's hose").to_string();
    match lines.map(|line| line.hose()) {
        [None, None] => None,
        [Some(_), None] => Some(named(lines[0])),
        [None, Some(_)] => Some(named(lines[1])),
        [Some(a), Some(b)] if a == b && lines[0].hose_name() == lines[1].hose_name() => Some(named(lines[0])),
        [Some(_), Some(_)] => Some(format!("{} in line A, {} in line B", named(lines[0]), named(lines[1]))),
    }
}

/// What differs between the declared lines, and what is made of it.
fn unlike(actuator: &project::DeclaredActuator) -> Option<String> {
    let [line_a, line_b] = [&actuator.line.a, &actuator.line.b];
    match (line_a.hose(), line_b.hose()) {
        (Some(a), Some(b)) if a == b && line_a.dynamic_stiffening == line_b.dynamic_stiffening => None,
        (Some(_), Some(_)) => {
            Some("the lines differ: each is sized so that both have the same compliance".to_string())
        }
        (None, None) => None,
        (Some(_), None) => {
            Some("line B is not declared as a hose: hoses are sized for both lines".to_string())
        }
        (None, Some(_)) => {
            Some("line A is not declared as a hose: hoses are sized for both lines".to_string())
        }
    }
}

/// The requirement in time that asks for more than this time constant reaches, in words.
///
/// ```text
/// t_s = tau_d ln(100/band)                    of a first-order response, the band in percent
/// ```
fn sooner(project: &Project, time_constant_s: f64) -> Option<String> {
    let required = time_requirements(project).ok()?;
    let each = required.iter().filter_map(|one| {
        let settles_s = time_constant_s * ln(100.0 / one.wish.band_percent);
        let required_s = one.wish.settling_time_s.filter(|time_s| settles_s > ROUNDED * time_s)?;
        Some((settles_s / required_s, one, settles_s))
    });
    let (_, one, settles_s) = each.max_by(|one, other| one.0.total_cmp(&other.0))?;
    Some(format!(
        "that settles within {} % in {} s, and specification {} requires it in {} s",
        one.wish.band_percent,
        significant(settles_s, 4),
        one.number,
        one.wish.settling_time_s?
    ))
}

/// K_qU at null over that beyond the lap of a valve whose edges overlap, where no K_qU is stated.
fn dead_band(setup: &Setup<'_>, stated: Option<f64>) -> Result<Option<f64>, SizingError> {
    let components = setup.rig()?.actuator.components();
    let is_stated = stated.or(setup.project.linear.get("flow_gain")).is_some();
    let found = overlap::dead_band(&components.valve, &components.supply).map(|[_, _, share]| share);
    Ok(found.filter(|_| !is_stated))
}
