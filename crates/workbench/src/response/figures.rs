use num_complex::Complex64;

use super::Compared;
use super::files::stem;
use crate::figure::{EstimatedResponse, Figure, FrequencySeries, Words};

/// A Bode diagram of each member.
pub(crate) fn pictures(found: &[Compared]) -> Vec<Figure> {
    found.iter().enumerate().map(|(index, compared)| picture(compared, &stem(found, index))).collect()
}

fn picture(compared: &Compared, stem: &str) -> Figure {
    let member = &compared.member;
    let [input, output] = member.signals;
    let frequencies: Vec<f64> = member.points.iter().map(|point| point.frequency).collect();
    let series = |name: &str, response: Vec<Complex64>| FrequencySeries {
        name: name.to_string(),
        frequencies_rad_per_s: frequencies.clone(),
        response,
    };
    let model = compared.plant.clone().map(|plant| series("linear plant of the project", plant));
    let caption = "Each point is a frequency of the record; the band around it holds the truth with 95 % confidence. Points below the dotted line of the coherence are left out.";
    let title = format!("{}: {output} over {input}", member.file);
    let chart = EstimatedResponse {
        quantity: format!("{output}/{input}"),
        unit: format!("{}/{}", member.units[1], member.units[0]),
        estimate: series("estimate", member.points.iter().map(|point| point.response).collect()),
        radii: member.points.iter().map(|point| point.radius).collect(),
        coherence: member.points.iter().map(|point| point.coherence).collect(),
        least_coherence: member.least_coherence,
        models: model.into_iter().collect(),
    };
    chart.draw(&Words::new(format!("{stem}.response"), title, caption))
}
