//! Families for templates, and functions of their outlines.

use num_complex::Complex64;
use phea_dynamics::controller::Controller;
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{argument, cos, hypot, ln, log10, magnitude, sin};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::template::{BuiltTemplate, TemplateOptions, template};

/// Name, bounds, spacing; the nominal value is the lower bound.
pub(crate) type Range = (&'static str, f64, f64, Spacing);

pub(crate) fn coefficients<'t>(
    numerator: Vec<Recorded<'t>>,
    denominator: Vec<Recorded<'t>>,
) -> PlantCoefficients<Recorded<'t>> {
    let command = RationalCoefficients { numerator, denominator };
    PlantCoefficients { command, disturbance: None, dead_time_s: 0.0.into(), rate: None }
}

/// The family over a box with a grid of this number of points along each parameter.
pub(crate) fn family<F>(ranges: &[Range], points: usize, equations: F) -> UncertainFamily
where
    F: for<'t> FnMut(&[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>>,
{
    let parameter = |&(name, minimum, maximum, _): &Range| UncertainParameter {
        name: name.into(),
        nominal: minimum,
        minimum,
        maximum,
    };
    let plant = UncertainPlant::record(ranges.iter().map(parameter).collect(), equations).unwrap();
    let coordinate = |(index, &(_, _, _, spacing)): (usize, &Range)| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![spacing],
        points,
    };
    let coordinates: Vec<_> = ranges.iter().enumerate().map(coordinate).collect();
    let members = grid(&plant, &coordinates).unwrap();
    UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap()
}

/// A continuous loop without delay, with sensor 1.
pub(crate) fn plain_loop() -> Compensation {
    Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0)).unwrap()
}

pub(crate) fn built(family: &UncertainFamily, frequency: f64) -> BuiltTemplate {
    built_with(family, frequency, TemplateOptions::default())
}

pub(crate) fn built_with(
    family: &UncertainFamily,
    frequency: f64,
    options: TemplateOptions,
) -> BuiltTemplate {
    template(&Family::Uncertain(family.clone()), &plain_loop(), frequency, &options).unwrap()
}

pub(crate) fn polar(magnitude: f64, phase_rad: f64) -> Complex64 {
    Complex64::new(magnitude * cos(phase_rad), magnitude * sin(phase_rad))
}

/// Number of times a closed polygon winds around a point.
pub(crate) fn winding(outline: &[Complex64], point: Complex64) -> i32 {
    let next = outline.iter().cycle().skip(1);
    let turn: f64 = outline.iter().zip(next).map(|(a, b)| argument((b - point) / (a - point))).sum();
    (turn / std::f64::consts::TAU).round() as i32
}

/// Distance of a response from the region enclosed by the outlines, in tolerances (degrees and dB),
/// zero inside.
pub(crate) fn beyond(outlines: &[Vec<Complex64>], response: Complex64, options: &TemplateOptions) -> f64 {
    let inside = outlines.iter().any(|outline| winding(outline, response) != 0);
    if inside { 0.0 } else { from_rim(outlines, response, options) }
}

/// Distance of a response from the outlines, in tolerances.
pub(crate) fn from_rim(outlines: &[Vec<Complex64>], response: Complex64, options: &TemplateOptions) -> f64 {
    let mut least = f64::INFINITY;
    for outline in outlines {
        for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let along = to - from;
            let part = if *from == *to { 0.0 } else { ((response - from) / along).re.clamp(0.0, 1.0) };
            least = least.min(apart(from + along * part, response, options));
        }
    }
    least
}

/// Distance of two responses in tolerances.
pub(crate) fn apart(first: Complex64, second: Complex64, options: &TemplateOptions) -> f64 {
    let ratio = second / first;
    let decibel = 20.0 * log10(magnitude(ratio));
    hypot(argument(ratio).to_degrees() / options.phase_deg, decibel / options.magnitude_db)
}

/// Area of a polygon in the plane of ln|P| and phase, rad, which must not be wider than a turn.
pub(crate) fn logarithmic_area(outline: &[Complex64]) -> f64 {
    let mut place = (ln(magnitude(outline[0])), argument(outline[0]));
    let mut area = 0.0;
    for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let ratio = to / from;
        let next = (place.0 + ln(magnitude(ratio)), place.1 + argument(ratio));
        area += (place.0 - next.0) * (place.1 + next.1) / 2.0;
        place = next;
    }
    area.abs()
}

/// Parameter values at random points of the box, many of them on its faces.
pub(crate) fn random_values(family: &UncertainFamily, count: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Random(seed);
    let mut point = || {
        let fractions: Vec<f64> = family
            .coordinates()
            .iter()
            .map(|_| {
                let fraction = random.draw();
                if random.draw() < 0.4 { fraction.round() } else { fraction }
            })
            .collect();
        family.values(&fractions)
    };
    (0..count).map(|_| point()).collect()
}

/// A response over this number of parameters in -1 to 1 whose real and imaginary part at 1 rad/s
/// are quadratic, with random coefficients.
pub(crate) fn quadratic_family(dimension: usize, seed: u64) -> UncertainFamily {
    let names = ["a", "b", "c", "d"];
    let ranges: Vec<Range> =
        names.iter().take(dimension).map(|&name| (name, -1.0, 1.0, Spacing::Linear)).collect();
    let mut random = Random(seed);
    family(&ranges, 2, |p| {
        let mut quadratic = || {
            let mut sum = Recorded::from(8.0);
            for (index, &first) in p.iter().enumerate() {
                sum = sum + first * (random.draw() * 2.0 - 1.0).into();
                for &second in &p[index..] {
                    sum = sum + first * second * (random.draw() * 2.0 - 1.0).into();
                }
            }
            sum
        };
        let (imaginary, real) = (quadratic(), quadratic());
        coefficients(vec![imaginary, real], vec![1.0.into()])
    })
}

/// Reproducible numbers in [0, 1) (multiplicative congruence modulo 2^31 - 1; Park and Miller
/// 1988).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn draw(&mut self) -> f64 {
        self.0 = self.0 * 48271 % 2147483647;
        self.0 as f64 / 2147483647.0
    }
}
