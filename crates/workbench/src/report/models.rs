//! The chapter on linear models: poles, Bode diagram of the models with their difference,
//! dominance.

use phea_engineering::linearize::{Linearization, frequency_grid, resonance};
use phea_engineering::setup::Setup;

use super::chapter::Chapter;
use crate::document::{Document, capital};
use crate::figure::{
    BodeDiagram, Figure, FrequencyMark, FrequencySeries, PoleMap, PoleMapScale, PoleSeries, Words,
};
use crate::linearize::{document, model_words};
use crate::quantity::MotionWords;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;

pub(super) fn chapter(setup: &Setup<'_>, linearization: &Linearization) -> Result<Chapter, LinearError> {
    let figures = figures(linearization)?;
    let mut out = Document::default();
    let held = match (linearization.load_yields, linearization.first_order_has_load) {
        (false, _) => "",
        (true, true) => {
            " These models hold the load still; (6.13) has its stiffness in series, and the plant its motion."
        }
        (true, false) => " These models hold the load still; the plant alone has its motion.",
    };
    let lumped = if setup.project.has_waves() { ", with its lines lumped" } else { "" };
    out.explanation(format!(
        "The plant is the one of every verdict{lumped}. The two-pressure model is the linearisation of the actuator as declared, its leakage included; the fifth-order model (6.7) takes one stiffness and one load pressure. \
         The resulting error is judged with derived parameters in both; everything else here uses the values in use. \
         (6.12) splits it into hydraulic, mechanical and valve part; (6.13) keeps the hydraulic part alone.{held}",
    ));
    out.left_out(setup);
    out.append(document(linearization, figures));
    Ok(Chapter::of("models", "Linear models", out))
}

/// Pole map, responses of the models, and the error of the model with one load pressure.
pub(super) fn figures(linearization: &Linearization) -> Result<Vec<Figure>, LinearError> {
    Ok(vec![poles(linearization), responses(linearization)?, reduction(linearization)?])
}

fn poles(linearization: &Linearization) -> Figure {
    let series = |name: &str, function: &TransferFunction| PoleSeries {
        name: model_words(linearization, name),
        poles: function.poles().to_vec(),
        zeros: function.zeros().to_vec(),
    };
    let mut all = vec![
        series("fifth order (6.7)", &linearization.full.command),
        series("decomposed (6.12), corrected", &linearization.decomposed[1]),
        series("two-pressure, derived parameters", &linearization.two_pressure.command),
        series("fifth order (6.7), derived parameters", &linearization.derived_full.command),
    ];
    if !linearization.plant_is_fifth_order {
        all.insert(0, series("plant", &linearization.plant.command));
    }
    let chart = PoleMap {
        series: all,
        scale: PoleMapScale::SignedLogarithmic,
        damping_ratios: vec![0.01, 0.1, 0.5, 0.9],
        natural_frequencies_rad_per_s: vec![1.0, 10.0, 100.0, 1000.0],
    };
    let load = if linearization.load_yields { ", and the load on its own spring" } else { "" };
    let MotionWords { force, piston, load_cell, .. } = linearization.motion.words();
    let caption = format!(
        "Poles from command to {force}: the slow hydraulic pole, the {piston} on the {load_cell}, the valve's spool{load}."
    );
    chart.draw(&Words::new("poles", "Pole map", &caption))
}

/// The models with the values in use; the plant, which may be the fifth-order model, is first.
fn responses(linearization: &Linearization) -> Result<Figure, LinearError> {
    let mut models = vec![
        ("fifth order (6.7)", &linearization.full.command),
        ("decomposed (6.12), corrected", &linearization.decomposed[1]),
        ("first order (6.13)", &linearization.first_order),
    ];
    let mut first = "the fifth-order model";
    if !linearization.plant_is_fifth_order {
        models.insert(0, ("plant", &linearization.plant.command));
        first = "the plant, which has load, leakage and both chambers";
    }
    let caption = format!(
        "{} over command of the models with the values in use, and the difference of each from {first}.",
        capital(linearization.motion.words().force)
    );
    let words = Words::new("bode", "Frequency response of the models", &caption);
    diagram(linearization, words, &models, &linearization.plant.command)
}

/// Relative difference of responses up to which they agree to within rounding.
const AGREE: f64 = 1e-10;

/// The error of the model with one load pressure: both models with derived parameters.
fn reduction(linearization: &Linearization) -> Result<Figure, LinearError> {
    let held = if linearization.load_yields { " and the load held still" } else { "" };
    let mut caption = format!(
        "The fifth-order model instead of the two-pressure model, both with derived parameters{held}."
    );
    let [both, one] = [&linearization.two_pressure.command, &linearization.derived_full.command];
    let differs =
        |at: &f64| portable::magnitude(one.at_frequency(*at) / both.at_frequency(*at) - 1.0) > AGREE;
    if !frequency_grid(both)?.iter().any(differs) {
        caption.push_str(" They agree to within rounding.");
    }
    let words = Words::new("bode-reduction", "What one load pressure leaves out", &caption);
    let models = [
        ("two-pressure, derived parameters", &linearization.two_pressure.command),
        ("fifth order (6.7), derived parameters", &linearization.derived_full.command),
    ];
    diagram(linearization, words, &models, &linearization.two_pressure.command)
}

/// A Bode diagram with the differences from the first model.
fn diagram(
    linearization: &Linearization,
    words: Words,
    models: &[(&str, &TransferFunction)],
    reference: &TransferFunction,
) -> Result<Figure, LinearError> {
    let grid = frequency_grid(reference)?;
    let series = models.iter().map(|(name, function)| {
        FrequencySeries::new(model_words(linearization, name), &grid, |at| function.at_frequency(at))
    });
    let resonance = resonance(reference)
        .map(|pole| FrequencyMark { label: "resonance".to_string(), frequency_rad_per_s: pole.im });
    let chart = BodeDiagram {
        quantity: linearization.motion.either("F_e/U_C", "T_e/U_C").to_string(),
        unit: linearization.motion.either("N/V", "N.m/V").to_string(),
        series: series.collect(),
        marks: resonance.into_iter().collect(),
    };
    Ok(chart.draw(&words))
}
