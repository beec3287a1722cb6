//! The chapter on stiffness over the stroke, Figure 6.4, in both models.

use phea_engineering::linearize::{
    Linearization, StiffnessOverForce, stiffness_at, stiffness_at_setting, stiffness_at_settings,
    stiffness_over_force,
};
use phea_engineering::rig::Rig;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::stiffness::StiffnessModel;

use super::chapter::Chapter;
use crate::document::Document;
use crate::figure::{Figure, StiffnessCurve, StiffnessDiagram, StiffnessOver, Words};
use crate::identify::is_valve_of_thesis;
use crate::linearize::stiffness_sentence;
use crate::project::DeclaredActuator;
use crate::quantity::{MotionWords, Units};
use crate::sizing::model_name;

/// Number of positions of a curve over the stroke.
const POSITIONS: u32 = 120;

pub(super) fn chapter(
    actuator: &DeclaredActuator,
    rig: &Rig,
    linearization: &Linearization,
    units: Units,
) -> Chapter {
    let declared = model_name(rig.actuator.components().stiffness_model);
    let mut out = Document::default();
    out.explanation(stiffness_sentence(linearization));
    out.explanation(format!("This project declares `{declared}`. {}", models_sentence(actuator)));
    out.figures(rig.actuator.components().cylinder.stroke.length().map(|stroke| figure(rig, stroke, units)));
    out.figures(stiffness_over_force(rig).map(|found| over_force(rig, found, units)));
    Chapter::of("stiffness", "Stiffness over the stroke", out)
}

/// Difference of the two models, for the lines of the rig.
fn models_sentence(actuator: &DeclaredActuator) -> String {
    let has_hose = [&actuator.line.a, &actuator.line.b].iter().any(|line| line.hose().is_some());
    let mut words = "`uniform` takes the effective bulk modulus of a line for the oil of its chamber too, `by_volume` takes each by itself".to_string();
    if has_hose {
        words.push_str(": a steel chamber does not become softer because a hose is screwed to it, and a hose swells as its data sheet states, so a rig behaves as in `by_volume`");
    }
    if is_valve_of_thesis(actuator) {
        words.push_str(". The tables of Ledezma (2019) are made with `uniform`");
    }
    format!("{words}.")
}

fn figure(rig: &Rig, stroke: f64, units: Units) -> Figure {
    let declared = rig.actuator.components().stiffness_model;
    let other = match declared {
        StiffnessModel::Uniform => StiffnessModel::ByVolume,
        StiffnessModel::ByVolume => StiffnessModel::Uniform,
    };
    let mut curves = vec![curve(rig, declared, stroke), curve(rig, other, stroke)];
    curves.extend(settings(rig, stroke));
    let chart = StiffnessDiagram {
        curves,
        operating_point: Some(rig.point.position),
        band_label: "dynamic stiffening from least to greatest".to_string(),
        units,
        ..StiffnessDiagram::default()
    };
    let MotionWords { piston, position, .. } = units.motion.words();
    let words = format!(
        "Hydraulic stiffness against {piston} {position}: the declared model with its band of dynamic stiffening, and the other model"
    );
    let gas = rig.actuator.components().gas;
    let caption = match gas.iter().flatten().all(|gas| gas.setting().is_none()) {
        true => format!("{words}."),
        false => format!(
            "{words}, both at the setting of rest, and the declared model at other settings of the accumulators, for slow motions."
        ),
    };
    chart.draw(&Words::new("stiffness", "Hydraulic stiffness over the stroke", caption))
}

/// Gas under pressure: the stiffness over the forces that the rig holds.
fn over_force(rig: &Rig, found: StiffnessOverForce, units: Units) -> Figure {
    let StiffnessOverForce { forces, at_rest, at_settings } = found;
    let curve = |name: String, stiffness_n_per_m: Vec<f64>| StiffnessCurve {
        name,
        places: forces.clone(),
        stiffness_n_per_m,
        ..StiffnessCurve::default()
    };
    let name = if at_settings.is_empty() { "with the gas" } else { "at the setting of rest" };
    let others =
        at_settings.into_iter().map(|(setting, values)| curve(format!("at setting {setting}"), values));
    let chart = StiffnessDiagram {
        curves: std::iter::once(curve(name.to_string(), at_rest)).chain(others).collect(),
        over: StiffnessOver::Force,
        operating_point: Some(rig.point.hydraulic_force),
        units,
        ..StiffnessDiagram::default()
    };
    let MotionWords { force, position, .. } = units.motion.words();
    let caption = format!(
        "Hydraulic stiffness for slow motions against the {force} that is held at standstill, at the {position} of the operating point: with more {force} the gas of chamber A becomes stiffer and that of chamber B softer. The curves end where the gas at a chamber is shut off, or at the nominal voltage."
    );
    chart.draw(&Words::new("stiffness-force", format!("Hydraulic stiffness over the {force}"), caption))
}

/// Positions of the curves over a stroke.
pub(crate) fn positions(stroke: f64) -> Vec<f64> {
    (0..=POSITIONS).map(|step| stroke * f64::from(step) / f64::from(POSITIONS)).collect()
}

/// The declared model at the settings to which the accumulators can be adjusted.
fn settings(rig: &Rig, stroke: f64) -> Vec<StiffnessCurve> {
    let of = |setting: f64| {
        let places = positions(stroke);
        StiffnessCurve {
            name: format!("at setting {setting}"),
            stiffness_n_per_m: places.iter().map(|x| stiffness_at_setting(rig, setting, *x)).collect(),
            places,
            ..StiffnessCurve::default()
        }
    };
    stiffness_at_settings(rig).into_iter().map(|(setting, _)| of(setting)).collect()
}

fn curve(rig: &Rig, model: StiffnessModel, stroke: f64) -> StiffnessCurve {
    let places = positions(stroke);
    let at = |member| places.iter().map(|x| stiffness_at(rig, model, member, *x)).collect::<Vec<f64>>();
    let (minimum, maximum) = (at(StiffeningMember::Minimum), at(StiffeningMember::Maximum));
    let uncertain = minimum != maximum;
    StiffnessCurve {
        name: model_name(model).to_string(),
        stiffness_n_per_m: at(StiffeningMember::Nominal),
        minimum_n_per_m: if uncertain { minimum } else { vec![] },
        maximum_n_per_m: if uncertain { maximum } else { vec![] },
        places,
    }
}
