use phea_dynamics::portable::ln;
use phea_hydraulics::linear::LinearParameters;

use super::assembly::{ExpansionPressures, VolumetricExpansion, hose, stiffening};
use super::numbers::Numbers;
use crate::catalogue::{Catalogue, CatalogueKind, DASH_SIZES};
use crate::project::{self, HoseProperties, SettlingTime, Speed};
use crate::quantity::significant;
use crate::setup::Setup;
use crate::sizing::{HoseOption, SizingProblem};

/// Recommended oil velocity of pressure lines, m/s (Rabie 2009, quoted in Ledezma 2019, section
/// 6.3.1.1).
const OIL_VELOCITY: [f64; 2] = [2.1, 4.6];
/// Smallest practical gain, V/N (Ledezma 2019, section 6.3.2, step j).
const MINIMUM_GAIN: f64 = 1e-4;
/// Gain at which the search starts, V/N (the same, step f: a unitary value).
const MAXIMUM_GAIN: f64 = 1.0;
/// Acceptable length of a line where the project states none, m.
const HOSE_LENGTH: [f64; 2] = [0.1, 10.0];

/// Why a project cannot be sized.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizingError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] super::RigError),
    /// There is nothing to size for.
    #[error(
        "the project has no [sizing]: add one with `time_constant`, or `settling_time` and `settling_band_percent`"
    )]
    Absent,
    /// No flow limits the bore.
    #[error("sizing needs the largest flow: `flow` in [supply], or `nominal_flow` in [valve]")]
    Flow,
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
    if components.accumulators.iter().any(Option::is_some) {
        return Err(SizingError::Accumulator);
    }
    if components.cross_port.is_some_and(|port| port.capacity.is_some()) {
        return Err(SizingError::Capacity);
    }
    let (time_constant, time_constant_origin) = time_constant(wish.speed);
    let (maximum_flow, maximum_flow_origin) = maximum_flow(actuator)?;
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
            ..rig.linear
        },
        fluid_modulus: components.fluid.modulus_at(rig.actuator.mean_pressure()),
        density: components.fluid.density,
        flow_pressure_coefficient_maximum: leakage
            .and_then(|parameter| parameter.bounds)
            .map(|bounds| bounds[1] + rig.internal_leakage),
        internal_leakage: rig.internal_leakage,
        time_constant,
        time_constant_origin,
        maximum_flow,
        maximum_flow_origin,
        oil_velocity: wish.oil_velocity.unwrap_or(OIL_VELOCITY),
        minimum_gain: wish.minimum_gain.unwrap_or(MINIMUM_GAIN),
        maximum_gain: wish.maximum_gain.unwrap_or(MAXIMUM_GAIN),
        length_increment: wish.length_increment,
        stock_length: wish.stock_length,
        hose_length: wish.hose_length.unwrap_or(HOSE_LENGTH),
        supply_pressure: actuator.supply.pressure,
        model: components.stiffness_model,
        hoses,
        market_bores: DASH_SIZES.iter().map(|(name, bore)| (name.to_string(), *bore)).collect(),
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

fn maximum_flow(actuator: &project::DeclaredActuator) -> Result<(f64, String), SizingError> {
    match (actuator.supply.flow(), actuator.valve.flow.rating().map(|rated| rated.flow)) {
        (Some(pump), Some(valve)) if pump <= valve => {
            Ok((pump, "the pump's, less than the valve's rated flow".to_string()))
        }
        (Some(_), Some(valve)) => Ok((valve, "the valve's rated flow, less than the pump's".to_string())),
        (Some(pump), None) => Ok((pump, "the pump's".to_string())),
        (None, Some(valve)) => Ok((valve, "the valve's rated flow".to_string())),
        (None, None) => Err(SizingError::Flow),
    }
}

/// The hoses of the catalogue, with the values that the project states for one of the same name;
/// its own hose if it has no name.
fn hoses(actuator: &project::DeclaredActuator, catalogue: &Catalogue) -> Vec<HoseOption> {
    let line = &actuator.line.a;
    let pressures = ExpansionPressures::of(actuator.supply.pressure, actuator.supply.tank_pressure);
    let option = |name: &str, properties: &HoseProperties| {
        let expansion = VolumetricExpansion::of(&properties.expansion, &Numbers::declared());
        let stiffening = stiffening(line.dynamic_stiffening, &Numbers::declared());
        HoseOption {
            name: name.to_string(),
            hose: hose(properties.bore, expansion, pressures, stiffening),
            working_pressure: properties.working_pressure,
            minimum_bend_radius: properties.minimum_bend_radius,
        }
    };
    let own = line.hose();
    let mut hoses: Vec<HoseOption> = catalogue
        .entries(CatalogueKind::Hose)
        .filter_map(|entry| {
            let own = own.filter(|_| line.hose_name() == Some(entry.name.as_str()));
            Some(option(&entry.name, own.or(entry.hose.as_ref())?))
        })
        .collect();
    let unnamed = own.filter(|_| line.hose_name().is_none());
    hoses.extend(unnamed.map(|own| option("the project's hose", own)));
    hoses
}
