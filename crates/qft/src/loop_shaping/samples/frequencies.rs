//! The frequencies of a search.

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::order::{sort_numbers, sorted_distinct};
use phea_dynamics::portable;

use super::{FamilyPlant, SamplesError, around, plant_at};
use crate::family::{COARSE, tabulated};
use crate::loop_shaping::DesignProblem;
use crate::specification::Limit;
use crate::verification::PlantPoint;

/// Factor beyond roots and design frequencies up to which an unlimited band is sampled.
const BEYOND: f64 = 30.0;
/// Factor beyond which the grid is coarse.
const DENSE: f64 = 5.0;
/// Ratio of the coarse to the fine spacing.
const COARSENESS: f64 = 4.0;
/// Damping ratio below which the peak of a root could be missed by the grid.
const LIGHTLY_DAMPED: f64 = 0.2;
/// Largest number of peak frequencies that are added.
const PEAKS_MAXIMUM: usize = 80;

/// The frequencies at which these plants are evaluated: a logarithmic grid over all bands, the ends
/// of the bands, the design frequencies, and the lightly damped roots of the plants; increasing,
/// rad/s.
///
/// A band from 0 begins a factor 30 below the slowest root of a plant or a limit and the least
/// design frequency, and one to infinity ends equally far above the fastest; if every band ends,
/// the grid continues a factor 30 further, so that a search sees how close to instability the loop
/// comes there. Beyond a factor 5, the grid is four times as coarse. A sampled loop ends at pi/T.
/// Of crowded peaks some are omitted. If plants are given by their responses, the grid is limited
/// to the range that all of them cover.
///
/// # Errors
/// A point that is not a plant of the family; a loop that cannot be formed.
///
/// # Example
/// The samples include the ends of the band, the design frequency, and the undamped pole of
/// k/(s^2 + 4).
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_qft::design::DesignProblem;
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::loop_shaping::search_frequencies;
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::PlantPoint;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into(), 4.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// let problem = DesignProblem {
///     family: Family::Uncertain(UncertainFamily::new(plant, vec![], vec![], Extent::Box)?),
///     additional_plants: vec![],
///     sensor: TransferFunction::gain_only(1.0),
///     timing: Timing::default(),
///     specifications: vec![Specification {
///         requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
///         frequencies_rad_per_s: vec![1.0],
///         band_rad_per_s: [0.5, 10.0],
///     }],
///     minimum_delay_margin_s: 0.0,
/// };
/// let grid = search_frequencies(&problem, &[PlantPoint::Parameters(vec![1.0])], 20.0)?;
/// assert!(grid.is_sorted() && [0.5, 1.0, 10.0].iter().all(|frequency| grid.contains(frequency)));
/// assert!(grid.iter().any(|frequency| (frequency - 2.0).abs() < 1e-9));
/// # Ok(())
/// # }
/// ```
pub fn search_frequencies(
    problem: &DesignProblem,
    plants: &[PlantPoint],
    points_per_decade: f64,
) -> Result<Vec<f64>, SamplesError> {
    let highest = around(problem)?.highest_frequency_rad_per_s();
    let (mut sizes, mut peaks) = features(problem, plants)?;
    sizes.retain(|size| *size > 0.0 && size.is_finite());
    let slowest = sizes.iter().copied().fold(f64::INFINITY, f64::min).min(highest);
    let fastest = sizes.iter().copied().fold(0.0, f64::max).min(highest);
    let (slowest, fastest) = if sizes.is_empty() { (1.0, 1.0) } else { (slowest, fastest) };
    let bands = problem.specifications.iter().map(|specification| specification.band_rad_per_s);
    let bands: Vec<[f64; 2]> = bands.map(|[from, to]| [from, to.min(highest)]).collect();
    let ends = [slowest / BEYOND, slowest / DENSE, fastest * DENSE, fastest * BEYOND];
    let mut grid = spaced([ends[0], ends[1]], points_per_decade / COARSENESS);
    grid.extend(spaced([ends[1], ends[2]], points_per_decade));
    grid.extend(spaced([ends[2], ends[3]], points_per_decade / COARSENESS));
    thin(&mut peaks);
    grid.extend(peaks);
    let given = problem.specifications.iter().flat_map(|specification| &specification.frequencies_rad_per_s);
    grid.extend(given.chain(bands.iter().flatten()).filter(|frequency| frequency.is_finite()));
    let covered = bands.iter().fold(0.0, |covered: f64, [_, to]| covered.max(*to));
    let mut beyond = spaced([covered.max(ends[0]), (covered * BEYOND).max(ends[0])], points_per_decade);
    beyond.retain(|frequency| covered < *frequency && *frequency <= highest);
    grid.retain(|frequency| {
        *frequency > 0.0 && bands.iter().any(|[from, to]| from <= frequency && frequency <= to)
    });
    if covered.is_finite() {
        grid.extend(beyond);
    }
    let [first, last] = measured_by_all(problem, plants)?;
    grid.retain(|frequency| (first..=last).contains(frequency));
    Ok(sorted_distinct(grid))
}

/// The frequencies around which the response of one plant bends, rad/s: all of them, however
/// crowded.
pub(super) fn bends(problem: &DesignProblem, plant: &PlantPoint) -> Result<Vec<f64>, SamplesError> {
    let (_, mut peaks) = features(problem, std::slice::from_ref(plant))?;
    peaks.retain(|frequency| *frequency > 0.0 && frequency.is_finite());
    Ok(peaks)
}

/// The range of frequencies in which every measured plant has a response; unlimited if no plant is
/// measured.
fn measured_by_all(problem: &DesignProblem, plants: &[PlantPoint]) -> Result<[f64; 2], SamplesError> {
    let mut common = [0.0, f64::INFINITY];
    for plant in plants {
        if let FamilyPlant::Measured(plant) = plant_at(problem, plant)? {
            let frequencies = &plant.frequencies_rad_per_s;
            common[0] = frequencies.first().copied().unwrap_or(0.0).max(common[0]);
            common[1] = frequencies.last().copied().unwrap_or(0.0).min(common[1]);
        }
    }
    Ok(common)
}

/// The magnitudes of the roots of plants and limits with the design frequencies, and the
/// frequencies of peaks.
fn features(problem: &DesignProblem, plants: &[PlantPoint]) -> Result<(Vec<f64>, Vec<f64>), SamplesError> {
    let given = problem.specifications.iter().flat_map(|specification| &specification.frequencies_rad_per_s);
    let mut sizes: Vec<f64> = given.copied().collect();
    let mut peaks = Vec::new();
    let mut roots = Vec::new();
    for specification in &problem.specifications {
        let (lower, upper) = specification.requirement.limits();
        for limit in [lower, Some(upper)].into_iter().flatten() {
            if let Limit::Rational(function) = limit {
                roots.extend([function.zeros(), function.poles()].concat());
            }
        }
    }
    for plant in plants {
        match plant_at(problem, plant)? {
            FamilyPlant::Rational(plant) => {
                let paths = std::iter::once(&plant.command).chain(&plant.disturbance);
                for coefficients in paths.flat_map(|path| [&path.numerator, &path.denominator]) {
                    // a polynomial whose roots are not found contributes no peak
                    roots.extend(Polynomial::new(coefficients.clone()).roots().unwrap_or_default());
                }
            }
            FamilyPlant::Responding(plant) => {
                let range = plant.range_rad_per_s();
                peaks.extend(tabulated(plant.as_ref(), range, COARSE).frequencies_rad_per_s);
                sizes.extend(range);
            }
            FamilyPlant::Measured(plant) => {
                peaks.extend(&plant.frequencies_rad_per_s);
                sizes.extend(plant.frequencies_rad_per_s.first());
                sizes.extend(plant.frequencies_rad_per_s.last());
            }
        }
    }
    sizes.extend(roots.iter().map(|root| portable::magnitude(*root)));
    peaks.extend(roots.into_iter().flat_map(around_root));
    Ok((sizes, peaks))
}

/// The frequency of a lightly damped root, and those where its peak has fallen by 3 dB and by 7 dB.
fn around_root(root: Complex64) -> Vec<f64> {
    let (centre, width) = (root.im, root.re.abs());
    if centre <= 0.0 || width > LIGHTLY_DAMPED * centre {
        return Vec::new();
    }
    [-2.0, -1.0, 0.0, 1.0, 2.0].iter().map(|offset| centre + offset * width).collect()
}

/// Omits some frequencies where they are crowded.
fn thin(frequencies: &mut Vec<f64>) {
    sort_numbers(frequencies);
    let mut apart = 1e-3;
    loop {
        let mut last = 0.0;
        frequencies.retain(|&frequency| {
            let cache = frequency > last * (1.0 + apart);
            last = if cache { frequency } else { last };
            cache
        });
        if frequencies.len() <= PEAKS_MAXIMUM {
            return;
        }
        apart *= 2.0;
    }
}

fn spaced([from, to]: [f64; 2], per_decade: f64) -> Vec<f64> {
    let points = portable::log10(to / from) * per_decade;
    logarithmic_grid(from, to, points as usize + 2).unwrap_or_default()
}
