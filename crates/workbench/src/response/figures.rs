use num_complex::Complex64;

use super::Compared;
use super::files::stem;
use crate::figure::{EstimatedResponse, Figure, FrequencySeries, Words};

/// A Bode diagram of each member.
pub(crate) fn pictures(found: &[Compared]) -> Vec<Figure> {
    let picture = |(index, compared): (usize, &Compared)| {
        let others = found.iter().filter(|other| is_compared(compared, other)).collect();
        picture(compared, others, &stem(found, index))
    };
    found.iter().enumerate().map(picture).collect()
}

/// True for another record at the same operating point.
fn is_compared(one: &Compared, other: &Compared) -> bool {
    let [one, other] = [&one.member, &other.member];
    let is_at_one_point = one.operating_point.is_some() && one.operating_point == other.operating_point;
    is_at_one_point && one.signals == other.signals && one.file != other.file
}

fn picture(compared: &Compared, others: Vec<&Compared>, stem: &str) -> Figure {
    let member = &compared.member;
    let [input, output] = member.signals;
    let frequencies: Vec<f64> = member.points.iter().map(|point| point.frequency).collect();
    let series = |name: &str, response: Vec<Complex64>| FrequencySeries {
        name: name.to_string(),
        frequencies_rad_per_s: frequencies.clone(),
        response,
    };
    let model = compared.plant.clone().map(|plant| series("linear plant of the project", plant));
    let other = |other: &Compared| FrequencySeries {
        name: other.member.file.clone(),
        frequencies_rad_per_s: other.member.points.iter().map(|point| point.frequency).collect(),
        response: other.member.points.iter().map(|point| point.response).collect(),
    };
    let caption = "Each point is a frequency of the record; the band around it holds the truth with 95 % confidence. Points below the dotted line of the coherence are left out.";
    let title = format!("{}: {output} over {input}", member.file);
    let chart = EstimatedResponse {
        quantity: format!("{output}/{input}"),
        unit: format!("{}/{}", member.units[1], member.units[0]),
        estimate: series("estimate", member.points.iter().map(|point| point.response).collect()),
        radii: member.points.iter().map(|point| point.radius).collect(),
        coherence: member.points.iter().map(|point| point.coherence).collect(),
        least_coherence: member.least_coherence,
        models: model.into_iter().chain(others.into_iter().map(other)).collect(),
    };
    chart.draw(&Words::new(format!("{stem}.response"), title, caption))
}
