//! Templates: responses of the plants of a family at a frequency, by phase and magnitude.

use num_complex::Complex64;
use phea_qft::template::Template;

use super::axis::Axis;
use super::bode::{decibel, unwrapped_degrees};
use super::colour::{Role, ramp_role};
use super::legend::LegendEntry;
use super::open_loop::{decibel_axis, phase_near};
use super::plot::{Mark, Marker, MarkerStyle, Panel};
use super::scene::{Fill, Stroke};
use super::ticks::plain;
use super::{Figure, Words};

/// Draws templates at several frequencies: outlines with the region known to be filled, plants, and
/// the nominal plant.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_qft::template::{Resolution, Template};
/// use phea_figure::{Words, templates};
/// let template = Template {
///     frequency_rad_per_s: 10.0,
///     nominal: Complex64::new(0.0, -1.0),
///     points: vec![],
///     outlines: vec![],
///     resolution: Resolution::Members,
/// };
/// let figure = templates(&Words::new("plants", "Templates", "Plants at 10 rad/s"), &[template]);
/// assert!(figure.to_svg_inline().contains(">10 rad/s<"));
/// ```
pub fn templates(words: &Words, templates: &[Template]) -> Figure {
    let placed: Vec<PlacedTemplate> = templates
        .iter()
        .enumerate()
        .map(|(index, template)| {
            let role = ramp_role(index, templates.len());
            PlacedTemplate::new(template, home(template.nominal), role)
        })
        .collect();
    let all = || placed.iter().flat_map(PlacedTemplate::extent);
    let x =
        Axis::fit_angle("Phase of the plant (°)", all().flat_map(|(phase, _)| [phase - ROOM, phase + ROOM]));
    let y = decibel_axis("Magnitude of the plant (dB)", all().map(|(_, magnitude)| magnitude));
    let mut marks: Vec<Mark> = placed.iter().flat_map(PlacedTemplate::marks).collect();
    marks.extend(placed.iter().map(|template| template.nominal_mark()));
    marks.extend(placed.iter().map(|template| template.label()));
    let panels = vec![Panel::new(y, 380.0, marks)];
    let mut legend = vec![LegendEntry::marker("nominal plant", NOMINAL)];
    if templates.iter().any(|template| template.points.len() > 1) {
        let dot = MarkerStyle { marker: Marker::Circle, role: Role::Muted, radius: 2.0 };
        legend.push(LegendEntry::marker("plants", dot));
    }
    if templates.iter().any(|template| !template.outlines.is_empty()) {
        let fill = Fill::tint(Role::Muted);
        let stroke = Some(Stroke::solid(Role::Muted, OUTLINE));
        legend.push(LegendEntry { stroke, ..LegendEntry::area("region filled by the family", fill) });
    }
    words.with_plot(x, panels, legend)
}

/// Margin between a template and the frame, degrees.
const ROOM: f64 = 2.0;
const OUTLINE: f64 = 1.2;

/// Marker of the nominal plant.
const NOMINAL: MarkerStyle = MarkerStyle { marker: Marker::Diamond, role: Role::Text, radius: 4.0 };

/// Phase within (-360, 0] degrees and magnitude in dB.
fn home(response: Complex64) -> (f64, f64) {
    let phase = phase_near(response, -180.0);
    (if phase > 0.0 { phase - 360.0 } else { phase }, decibel(response))
}

/// Template with its nominal plant at a given position of a chart.
pub(super) struct PlacedTemplate {
    name: String,
    role: Role,
    nominal: (f64, f64),
    plants: Vec<(f64, f64)>,
    outlines: Vec<Vec<(f64, f64)>>,
}

impl PlacedTemplate {
    /// Template moved so that its nominal plant is at (degrees, dB).
    pub(super) fn new(template: &Template, nominal: (f64, f64), role: Role) -> PlacedTemplate {
        let relative = |response: &Complex64| *response / template.nominal;
        let plants = template.points.iter().map(|plant| {
            let factor = relative(&plant.response);
            (nominal.0 + phase_near(factor, 0.0), nominal.1 + decibel(factor))
        });
        let outlines = template.outlines.iter().map(|outline| {
            let factors: Vec<Complex64> = outline.iter().map(relative).collect();
            let phases = unwrapped_degrees(&factors, Some(0.0));
            phases
                .into_iter()
                .zip(&factors)
                .map(|(phase, factor)| (nominal.0 + phase, nominal.1 + decibel(*factor)))
                .collect()
        });
        PlacedTemplate {
            name: format!("{} rad/s", plain(template.frequency_rad_per_s)),
            role,
            nominal,
            plants: plants.collect(),
            outlines: outlines.collect(),
        }
    }

    /// All positions of the template.
    pub(super) fn extent(&self) -> impl Iterator<Item = (f64, f64)> {
        let all = self.plants.iter().chain(self.outlines.iter().flatten()).copied();
        all.chain([self.nominal]).filter(|(phase, magnitude)| phase.is_finite() && magnitude.is_finite())
    }

    /// Marks of regions, outlines and plants.
    pub(super) fn marks(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        for outline in &self.outlines {
            marks.push(Mark::Area { corners: outline.clone(), fill: Fill::tint(self.role) });
            let around = outline.iter().chain(outline.first()).copied().collect();
            marks.push(Mark::Line { points: around, stroke: Stroke::solid(self.role, OUTLINE) });
        }
        marks.push(Mark::Dots { points: self.plants.clone(), role: self.role, radius: 0.9 });
        marks
    }

    /// Mark of the nominal plant, with a tooltip.
    fn nominal_mark(&self) -> Mark {
        let note = format!("nominal plant at {}", self.name);
        Mark::Markers {
            points: vec![(self.nominal.0, self.nominal.1, note)],
            style: MarkerStyle { role: self.role, ..NOMINAL },
        }
    }

    /// Label of the frequency at the nominal plant.
    fn label(&self) -> Mark {
        Mark::Callout { at: vec![self.nominal], text: self.name.clone(), role: Role::Text }
    }
}
