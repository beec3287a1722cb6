use phea_engineering::estimate::Estimate;
use phea_engineering::line_test::{LineIdentification, ResponseFit, RiseFit};

use super::{because, misfit_in_words, numbers, remark};
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::project::LineSide;
use crate::quantity::{DisplayUnit, FLOW, PRESSURE, VOLUME, display};
use crate::response::resampling;

/// The numbers of the line, those that the recordings do not determine, and the quality of the fit.
pub(crate) fn document(found: &LineIdentification) -> Document {
    let mut out = Document::default();
    let rows = numbers(found).into_iter().filter_map(|(key, what, number)| {
        let Estimate { value, interval: [low, high] } = *number.as_ref().ok()?;
        let unit = unit(key);
        let shown = |value: f64| Cell::number_in(value, 4, unit);
        Some([Cell::from(what), shown(value), shown(low), shown(high), Cell::unit(unit.symbol)])
    });
    let pressure = display(found.pressure, &PRESSURE, 4);
    let title = format!("The line to chamber {} at {pressure}", chamber(found.known.side));
    out.section(title, Table::new(["quantity", "value", "95 % from", "to", "unit"]).with(rows));
    let open = numbers(found).into_iter().filter_map(|(_, what, number)| {
        let reason = number.err()?;
        Some(format!("Not determined: {what}: {}.", because(reason)))
    });
    out.sentences(open);
    out.sentences(remark(&found.known).map(str::to_string));
    out.sentences(found.rise.iter().flat_map(rise));
    out.sentences(found.response.iter().flat_map(response));
    out.sentences(found.misfits().iter().map(|one| format!("Misfit: {}.", misfit_in_words(one))));
    out
}

/// The chamber at the end of a line.
fn chamber(side: LineSide) -> &'static str {
    match side {
        LineSide::A => "A",
        LineSide::B => "B",
    }
}

/// Unit in which people read a key.
fn unit(key: &str) -> DisplayUnit {
    match key {
        "wave_speed_m_per_s" => DisplayUnit::METRE_PER_SECOND,
        "relaxation_time_s" => DisplayUnit::SECOND,
        "dynamic_stiffening" | "modulus_slope" => DisplayUnit::ONE,
        "entrained_air" => DisplayUnit::PERCENT,
        "density_kg_per_m3" => DisplayUnit { symbol: "kg/m3", in_si: 1.0 },
        _ => DisplayUnit::BAR,
    }
}

fn rise(fit: &RiseFit) -> Vec<String> {
    let [low, high] = fit.pressures.map(|pressure| display(pressure, &PRESSURE, 4));
    let terms = match fit.terms() {
        1 if fit.air_fraction().is_some() => {
            "free air in the oil and a compliance of oil and wall that does not change with the pressure"
                .to_string()
        }
        terms if fit.air_fraction().is_some() => {
            format!("free air in the oil and a compliance of oil and wall of {terms} terms in the pressure")
        }
        1 => "a compliance that does not change with the pressure".to_string(),
        terms => format!("a compliance of {terms} terms in the pressure"),
    };
    let drift = match fit.drift {
        Some(drift) => format!(
            "what flows at standstill, a meter's zero error or leakage, is {}",
            display(drift, &FLOW, 3)
        ),
        None => {
            "the record has no standstill that would show a meter's zero error or leakage: both are taken as zero"
                .to_string()
        }
    };
    let noise = display(fit.white_noise, &VOLUME, 2);
    vec![
        format!("{}: from {low} to {high}, explained by {terms}; {drift}.", fit.record.file),
        format!("Volumes differ from the fit by {noise} from row to row."),
    ]
}

fn response(fit: &ResponseFit) -> Vec<String> {
    let [misfit, _] = fit.misfit;
    let hertz = |frequency: Option<f64>| significant(DisplayUnit::HERTZ.of(frequency.unwrap_or(f64::NAN)), 4);
    let points = &fit.member.points;
    let [first, last] = [points.first(), points.last()].map(|point| hertz(point.map(|p| p.frequency)));
    let mut sentences = vec![format!(
        "{}: {} frequencies from {first} to {last} Hz; the squares of the residuals are {} times those of the noise.",
        fit.member.file,
        points.len(),
        significant(misfit, 3)
    )];
    if !fit.is_explained() {
        sentences.push(
            "The declared model of the line does not explain this response: the intervals are widened by the root of that. A wall that creeps (`line.relaxation_time`) or waves (`line.model`) may be missing."
                .to_string(),
        );
    }
    sentences.extend(resampling(&fit.member).map(|warning| format!("{warning}.")));
    sentences
}
