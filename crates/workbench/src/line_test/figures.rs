use phea_dynamics::portable::{exp, ln};
use phea_engineering::line_test::{LineIdentification, ResponseFit, RiseFit};

use crate::figure::{Curve, CurveChart, CurvePanel, CurveStyle, Figure, Words};
use crate::quantity::DisplayUnit;

/// Points of a fitted curve.
const POINTS: usize = 200;
/// Most recorded points that are drawn.
const MOST: usize = 600;
/// m3 in a millilitre.
const MILLILITRE: f64 = 1e-6;

/// Volume over pressure, and compliance over frequency, each with the fit.
pub(crate) fn pictures(found: &LineIdentification) -> Vec<Figure> {
    let response = found.response.as_ref().map(|fit| compliance_over_frequency(found, fit));
    found.rise.as_ref().map(volume_over_pressure).into_iter().chain(response).collect()
}

fn volume_over_pressure(fit: &RiseFit) -> Figure {
    let [low, high] = fit.pressures;
    let bar = |pressure: f64| DisplayUnit::BAR.of(pressure);
    let points = fit.points();
    let shown = || points.iter().step_by(points.len().div_ceil(MOST).max(1));
    let at = |index: usize| low + (high - low) * index as f64 / (POINTS - 1) as f64;
    let fitted = (0..POINTS).map(|index| (bar(at(index)), fit.volume(at(index)) / MILLILITRE));
    let left =
        shown().map(|(pressure, volume)| (bar(*pressure), (volume - fit.volume(*pressure)) / MILLILITRE));
    let recorded = shown().map(|(pressure, volume)| (bar(*pressure), volume / MILLILITRE));
    let both = vec![Curve::dots(recorded, 0), Curve::line(fitted, 1)];
    let panels = vec![
        CurvePanel::new("Volume (mL)", 220.0, both),
        CurvePanel::new("Residual (mL)", 100.0, vec![Curve::dots(left, 0)]).with_zero_line(),
    ];
    let caption = "Each point is a row of the record, drift taken off; the slope of the line is the compliance at rest. What is left wanders where the noise of a flow meter is summed up, and has two branches where the wall creeps.";
    let words =
        Words::new("line.pressure_rise", format!("{}: volume over pressure", fit.record.file), caption);
    CurveChart {
        x_title: "Pressure (bar)".to_string(),
        x_range: [bar(low), bar(high)],
        panels,
        legend: legend(),
    }
    .draw(&words)
}

fn compliance_over_frequency(found: &LineIdentification, fit: &ResponseFit) -> Figure {
    let points = fit.compliances(&found.known);
    let hertz = |frequency: f64| DisplayUnit::HERTZ.of(frequency);
    // points beyond the resonances of a line are drawn with it, and would hide the rest
    let per_bar = |compliance: f64| compliance * 1e5 / MILLILITRE;
    let [first, last] = [points.first(), points.last()].map(|p| p.map_or(1.0, |p| p.frequency));
    let ratio = ln(last / first) / (POINTS - 1) as f64;
    let at = |index: usize| first * exp(ratio * index as f64);
    let fitted = (0..POINTS).filter_map(|index| {
        let compliance = fit.model_response(&found.known, at(index))?.inv().im / at(index);
        Some((hertz(at(index)), per_bar(compliance)))
    });
    let bar = |p: &phea_engineering::line_test::CompliancePoint| {
        let end = |sign: f64| (hertz(p.frequency), per_bar(p.measured + sign * p.edge));
        Curve::line([end(-1.0), end(1.0)], 0)
    };
    let coherence = points.iter().map(|point| (hertz(point.frequency), point.coherence));
    let measured = points.iter().map(|point| (hertz(point.frequency), per_bar(point.measured)));
    let mut compliances = vec![Curve::line(fitted, 1)];
    compliances.extend(points.iter().map(bar));
    compliances.push(Curve::dots(measured, 0));
    let panels = vec![
        CurvePanel::new("Compliance (mL/bar)", 240.0, compliances).with_zero_line(),
        CurvePanel::new("Coherence γ²", 90.0, vec![Curve::dots(coherence, 0)]),
    ];
    let mut legend = legend();
    legend.push(("95 % confidence".to_string(), CurveStyle::Line(0)));
    let caption = "Imaginary part of flow over pressure, divided by the frequency: the compliance, as long as the line is short compared with the wavelength. It grows towards the quarter wave, beyond which the line behaves as an inertance.";
    let title = format!("{}: compliance over frequency", fit.member.file);
    CurveChart { x_title: "Frequency (Hz)".to_string(), x_range: [first, last].map(hertz), panels, legend }
        .draw_over_decades(&Words::new("line.frequency_response", title, caption))
}

fn legend() -> Vec<(String, CurveStyle)> {
    vec![("recorded".to_string(), CurveStyle::Dots(0)), ("fit".to_string(), CurveStyle::Line(1))]
}
