//! The bound of one requirement at one frequency, as a function of phase.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::ceiling::{CeilingPiece, CeilingPlant, contenders, greatest};
use super::fill::{Edge, inside};
use super::inequality::{InequalityForm, Ray, WeightedPlant};
use super::interval::GainIntervals;
use super::phases::{PhaseGrid, sampled};
use super::rule::Rule;
use super::tree::Tree;
use super::{Bound, BoundError, TemplateFill};
use crate::specification::Requirement;
use crate::template::{Template, TemplatePoint};

/// The gains of the nominal loop L0 = g e^(j phi) forbidden at one frequency so that every plant of
/// a template satisfies one requirement: exact at any phase.
///
/// With q = P0 H0/(P H), so that L = L0/q, each closed loop is a quotient of distances in the
/// q-plane:
///
/// ```text
/// |L/(1+L)| = g/|q + L0|               |1/(1+L)| = |q|/|q + L0|          |P/(1+L)| = |P| |q|/|q + L0|
/// |G/(1+L)| = g/(|P H| |q + L0|)       |Pd/(1+L)| = |Pd| |q|/|q + L0|    |P G/(1+L)| = g/(|H| |q + L0|)    thesis 3.14 to 3.18
/// ```
///
/// and along a ray |q + L0|^2 = g^2 + 2 g Re(conj(q) e^(j phi)) + |q|^2, so that each plant forbids
/// the gains where a quadratic is negative (Chait and Yaniv 1993). Tracking is assessed by its
/// spread, max|T|/min|T| <= upper/lower, since the prefilter sets the level: the plant of min|T| is
/// the one farthest from -L0, a corner of the convex hull, found piece by piece along the ray, and
/// all plants are compared with it; no pairs are formed.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_qft::bound::{BoundFunction, TemplateFill};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement};
/// use phea_qft::template::{Resolution, Template, TemplatePoint};
/// let one = Complex64::new(1.0, 0.0);
/// let plant = TemplatePoint { member: Some(0), values: vec![], response: one, load_motion: one, sensor: one };
/// let template = Template {
///     frequency_rad_per_s: 1.0, nominal: one, points: vec![plant], outlines: vec![], resolution: Resolution::Members,
/// };
/// let limit = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(2.0));
/// let bound = BoundFunction::new(&template, &limit, TemplateFill::Points)?;
/// let forbidden = bound.forbidden(-std::f64::consts::PI);
/// let [low, high] = forbidden.intervals()[0];
/// assert!((low - 2.0 / 3.0).abs() < 1e-14 && (high - 2.0).abs() < 1e-14); // g/|1 - g| = 2 at 2/3 and at 2
/// # Ok::<(), phea_qft::bound::BoundError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundFunction {
    frequency_rad_per_s: f64,
    form: InequalityForm,
    /// Plants; `None` if the limit is infinite.
    plants: Option<Tree>,
    /// Candidates for the least |T|; the origin in forms other than `Spread`.
    others: Vec<CeilingPlant>,
    edges: Vec<Edge>,
    /// Outlines in the q-plane.
    polygons: Vec<Vec<Complex64>>,
}

impl BoundFunction {
    /// Prepares the plants of a template for a requirement.
    ///
    /// `TemplateFill::Filled` counts every point of the template's outlines as a plant and forbids
    /// -L0 inside them. H and Pd, which an outline does not contain, are taken from the plant
    /// nearest to each of its corners.
    ///
    /// # Errors
    /// [`BoundError`] for a template without plants, a response that is zero or not finite, or a
    /// limit that is not a valid magnitude or does not cover the template's frequency.
    pub fn new(
        template: &Template,
        requirement: &Requirement,
        fill: TemplateFill,
    ) -> Result<BoundFunction, BoundError> {
        let rule = Rule::new(requirement, template)?;
        let frequency_rad_per_s = template.frequency_rad_per_s;
        let form = rule.form();
        let origin = CeilingPlant { inverse: Complex64::new(0.0, 0.0), modulus: 0.0, weight: 1.0 };
        let mut function = BoundFunction {
            frequency_rad_per_s,
            form,
            plants: None,
            others: vec![origin],
            edges: Vec::new(),
            polygons: Vec::new(),
        };
        if template.points.is_empty() {
            return Err(BoundError::NoPlants { frequency_rad_per_s });
        }
        if rule.is_idle() {
            return Ok(function);
        }
        let mut plants = judged(&rule, &template.points, frequency_rad_per_s)?;
        let mut others: Vec<CeilingPlant> = match form {
            InequalityForm::Spread => {
                pairs(&plants, &template.points).map(|(plant, point)| rule.candidate(plant, point)).collect()
            }
            InequalityForm::Complementary | InequalityForm::Sensitivity => Vec::new(),
        };
        if fill == TemplateFill::Filled {
            for outline in &template.outlines {
                let corners = corners(&rule, template, outline);
                let ours = judged(&rule, &corners, frequency_rad_per_s)?;
                if form == InequalityForm::Spread {
                    others.extend(pairs(&ours, &corners).map(|(plant, point)| rule.candidate(plant, point)));
                }
                let sides = pairs(&ours, &corners).zip(pairs(&ours, &corners).cycle().skip(1));
                function.edges.extend(sides.map(|(from, to)| rule.edge([from.0, to.0], [from.1, to.1])));
                function.polygons.push(ours.iter().map(|plant| plant.inverse).collect());
                plants.extend(ours);
            }
        }
        if form == InequalityForm::Spread {
            function.others = contenders(others);
        }
        function.plants = Some(Tree::new(form, &plants));
        Ok(function)
    }

    /// The gains |L0| that are forbidden at a phase of L0 in rad, as ratios.
    pub fn forbidden(&self, phase_rad: f64) -> GainIntervals {
        self.forbidden_towards(Complex64::new(portable::cos(phase_rad), portable::sin(phase_rad)))
    }

    /// The bound over all phases.
    pub fn bound(&self, grid: &PhaseGrid) -> Bound {
        let samples = sampled(grid, &[self]);
        Bound {
            frequency_rad_per_s: self.frequency_rad_per_s,
            phases_rad: samples.iter().map(|sample| sample.phase_rad).collect(),
            forbidden: samples.into_iter().filter_map(|sample| sample.forbidden.into_iter().next()).collect(),
        }
    }

    /// Arcs of phases in [-2 pi, 0], `[from, to]`, all of which some plant forbids at some gain and
    /// which are narrower than the spacing.
    ///
    /// ```text
    /// |phi - arg(-q)| <= arcsin(r/W)                                           limits of T and S alike, where r < W
    /// |phi - arg(-q)| <= arcsin(R/((1 + D) |q|)),  D = greatest W_i/r_k        tracking, R the distance of the farthest corner
    /// ```
    ///
    /// The second is the disc around -q in which L0 is D times closer to it than to that corner.
    pub(super) fn narrow_arcs(&self, spacing_rad: f64) -> Vec<[f64; 2]> {
        let turn = std::f64::consts::TAU;
        let mut arcs = Vec::new();
        let widest = portable::sin(spacing_rad.min(1.5) / 2.0);
        let weakest = self.others.iter().map(|other| other.weight).fold(f64::INFINITY, f64::min);
        for plant in self.plants.iter().flat_map(Tree::plants) {
            let sine = match self.form {
                InequalityForm::Complementary | InequalityForm::Sensitivity => plant.weight / plant.limit,
                InequalityForm::Spread => {
                    let apart = |other: &CeilingPlant| (other.inverse - plant.inverse).norm_sqr();
                    let farthest = self.others.iter().map(apart).fold(0.0, f64::max).sqrt();
                    farthest / (1.0 + plant.limit / weakest) / plant.modulus
                }
            };
            if sine > 0.0 && sine < widest {
                // The arc is halved, so that the phase does not only touch the plant's arc.
                let half = portable::asin(sine) / 2.0;
                let middle = portable::argument(-plant.inverse);
                let middle = if middle > 0.0 { middle - turn } else { middle };
                arcs.push([(middle - half).max(-turn), (middle + half).min(0.0)]);
            }
        }
        arcs
    }

    /// The result of [`BoundFunction::forbidden`] in the direction e^(j phi).
    pub(super) fn forbidden_towards(&self, direction: Complex64) -> GainIntervals {
        let mut union = GainIntervals::default();
        let Some(plants) = &self.plants else {
            return union;
        };
        for CeilingPiece { candidate, window } in greatest(direction, &self.others) {
            let ray = Ray {
                form: self.form,
                direction,
                other: candidate.inverse,
                other_modulus: candidate.modulus,
                other_weight: candidate.weight,
                window,
            };
            plants.collect(&ray, &mut union);
            self.edges.iter().for_each(|edge| edge.forbidden(&ray, &mut union));
        }
        for polygon in &self.polygons {
            inside(polygon, direction).intervals().iter().for_each(|&interval| union.insert(interval));
        }
        union
    }
}

fn pairs<'a>(
    plants: &'a [WeightedPlant],
    points: &'a [TemplatePoint],
) -> impl Iterator<Item = (&'a WeightedPlant, &'a TemplatePoint)> + Clone {
    plants.iter().zip(points)
}

/// The plants of these points under a rule.
fn judged(
    rule: &Rule,
    points: &[TemplatePoint],
    frequency_rad_per_s: f64,
) -> Result<Vec<WeightedPlant>, BoundError> {
    points
        .iter()
        .enumerate()
        .map(|(index, point)| rule.plant(point).ok_or(BoundError::Response { frequency_rad_per_s, index }))
        .collect()
}

/// The corners of an outline as plants, each with the sensor and load-motion path of its nearest
/// plant, if needed.
fn corners(rule: &Rule, template: &Template, outline: &[Complex64]) -> Vec<TemplatePoint> {
    let distance = |point: &TemplatePoint, corner: Complex64| (point.response - corner).norm_sqr();
    let like = |corner: Complex64| {
        let all = template.points.iter();
        let nearest = || all.min_by(|a, b| distance(a, corner).total_cmp(&distance(b, corner)));
        let source = if rule.needs_paths() { nearest() } else { template.points.first() };
        source.map(|point| TemplatePoint {
            member: None,
            values: Vec::new(),
            response: corner,
            ..point.clone()
        })
    };
    outline.iter().filter_map(|&corner| like(corner)).collect()
}
