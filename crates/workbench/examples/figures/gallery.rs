//! Figures with numbers near those of Ledezma (2019): stiffness 2.2 to 4.1 MN/m over 0.5 m, mechanical resonance at
//! 2938 rad/s, valve at 1099 rad/s.

use num_complex::Complex64;
use phea_dynamics::portable::pow;
use phea_workbench::figure::*;

/// Every figure once.
pub(crate) fn all() -> Vec<Figure> {
    vec![bode_of_models()]
}

fn frequencies(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from * pow(to / from, i as f64 / (count - 1) as f64)).collect()
}

fn second_order(s: Complex64, natural_frequency: f64, damping_ratio: f64) -> Complex64 {
    let w2 = natural_frequency * natural_frequency;
    w2 / (s * s + 2.0 * damping_ratio * natural_frequency * s + w2)
}

/// F_e/U_C of the full, the decomposed and the first-order model.
pub(crate) fn bode_of_models() -> Figure {
    let w = frequencies(1e-2, 1e4, 800);
    let gain = 5.4e-5 * 1.5e7 / 1.583e-3;
    let response = |model: usize| -> Vec<Complex64> {
        w.iter()
            .map(|&w| {
                let s = Complex64::new(0.0, w);
                let first = gain / (s + 0.336);
                let damping = if model == 0 { 0.00396 } else { 0.00404 };
                match model {
                    2 => first,
                    _ => first * second_order(s, 2938.0, damping) * second_order(s, 1099.0, 0.9),
                }
            })
            .collect()
    };
    let names = ["Full (6.7)", "Decomposed (6.12), corrected", "First order (6.13)"];
    let series = names
        .iter()
        .enumerate()
        .map(|(model, name)| FrequencySeries {
            name: (*name).to_string(),
            frequencies_rad_per_s: w.clone(),
            response: response(model),
        })
        .collect();
    bode(&BodeInput {
        name: "bode".into(),
        title: "Frequency response of the linear models".into(),
        caption: "Force over valve voltage at mid stroke.".into(),
        quantity: "F_e/U_C".into(),
        unit: "N/V".into(),
        series,
        with_difference: true,
        marks: vec![
            FrequencyMark { label: "valve".into(), frequency_rad_per_s: 1099.0 },
            FrequencyMark { label: "piston on load cell".into(), frequency_rad_per_s: 2938.0 },
        ],
    })
}
