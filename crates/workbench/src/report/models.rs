//! The chapter on linear models: poles, Bode diagram of the models with their difference, dominance.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, place, table};
use crate::document::prose;
use crate::figure::{
    BodeInput, Figure, FrequencyMark, FrequencySeries, PoleMapInput, PoleMapScale, PoleSeries, Words, bode,
    pole_map,
};
use crate::linearize::{
    Linearization, comparisons, difference_text, frequency_grid, located, mode_words, models, resonance,
    root_list,
};
use phea_dynamics::linear::{LinearError, TransferFunction};

pub(super) fn chapter(linearization: &Linearization) -> Result<Chapter, LinearError> {
    let figures = vec![poles(linearization), responses(linearization)?, reduction(linearization)?];
    let body = html! {
        p {
            "The two-pressure model is the linearised truth of the rig as declared; the fifth-order model (6.7) takes one stiffness and one load pressure. "
            "What that leaves out is judged with derived parameters in both; everything else here uses the values that hold. "
            "(6.12) splits it into hydraulic, mechanical and valve part; (6.13) keeps the hydraulic part alone."
        }
        (pole_table(linearization))
        (place(&figures[0]))
        (place(&figures[1]))
        (place(&figures[2]))
        h3 { "Largest differences" }
        (difference_table(linearization))
        h3 { "Dominance" }
        p { "Share: greatest amplitude of the mode in the step response over its final value. The slowest mode rules when every other share is small." }
        (dominance_table(linearization))
    };
    Ok(Chapter { anchor: "models", title: "Linear models", body, figures })
}

fn pole_table(linearization: &Linearization) -> Markup {
    let rows: Vec<Vec<Markup>> = models(linearization)
        .iter()
        .map(|(model, equation, function)| {
            vec![cell(*model), cell(*equation), cell(root_list(function.poles()))]
        })
        .collect();
    table(&["model", "equation", "poles, rad/s"], 9, &rows)
}

fn difference_table(linearization: &Linearization) -> Markup {
    let rows: Vec<Vec<Markup>> = comparisons(linearization)
        .iter()
        .map(|(name, comparison)| {
            vec![cell(*name), prose(&difference_text(&comparison.low)), prose(&located(&comparison.all))]
        })
        .collect();
    table(&["model, instead of the fuller one", "below 1000 rad/s", "everywhere"], 9, &rows)
}

fn dominance_table(linearization: &Linearization) -> Markup {
    let rows: Vec<Vec<Markup>> = linearization
        .modes
        .iter()
        .map(|mode| {
            let [share, decay] = mode_words(mode);
            vec![cell(root_list(&[mode.pole])), prose(&share), cell(decay)]
        })
        .collect();
    table(&["mode, rad/s", "share of the step response", "times faster gone than the slowest"], 1, &rows)
}

fn poles(linearization: &Linearization) -> Figure {
    let series = |name: &str, function: &TransferFunction| PoleSeries {
        name: name.to_string(),
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
    let input = PoleMapInput {
        series: all,
        scale: PoleMapScale::SignedLogarithmic,
        damping_ratios: vec![0.01, 0.1, 0.5, 0.9],
        natural_frequencies_rad_per_s: vec![1.0, 10.0, 100.0, 1000.0],
    };
    let caption = "Poles from command to force: the slow hydraulic pole, the piston on the load cell, the valve's spool.";
    pole_map(Words::new("poles", "Pole map", caption), &input)
}

/// The models with the values that hold, the plant first, which may be the fifth order.
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
        "Force over command of the models with the values that hold, and how far each is from {first}."
    );
    let words = Words::new("bode", "Frequency response of the models", &caption);
    diagram(words, &models, &linearization.plant.command)
}

/// What one load pressure leaves out: both models with derived parameters.
fn reduction(linearization: &Linearization) -> Result<Figure, LinearError> {
    let caption = "The fifth-order model instead of the two-pressure model, both with derived parameters.";
    let words = Words::new("bode-reduction", "What one load pressure leaves out", caption);
    let models = [
        ("two-pressure, derived parameters", &linearization.two_pressure.command),
        ("fifth order (6.7), derived parameters", &linearization.derived_full.command),
    ];
    diagram(words, &models, &linearization.two_pressure.command)
}

/// A Bode diagram with the differences from the first model.
fn diagram(
    words: Words,
    models: &[(&str, &TransferFunction)],
    reference: &TransferFunction,
) -> Result<Figure, LinearError> {
    let grid = frequency_grid(reference)?;
    let series = models.iter().map(|(name, function)| FrequencySeries {
        name: name.to_string(),
        response: grid.iter().map(|frequency| function.at_frequency(*frequency)).collect(),
        frequencies_rad_per_s: grid.clone(),
    });
    let resonance = resonance(reference)
        .map(|pole| FrequencyMark { label: "resonance".to_string(), frequency_rad_per_s: pole.im });
    let input = BodeInput {
        quantity: "F_e/U_C".to_string(),
        unit: "N/V".to_string(),
        series: series.collect(),
        with_difference: true,
        marks: resonance.into_iter().collect(),
    };
    Ok(bode(words, &input))
}
