//! Evidence for one friction in both directions, or for one in each.

use phea_dynamics::least_squares::{Settings, negative_log_likelihood};
use phea_dynamics::portable;
use phea_hydraulics::friction::LuGre;

use super::SearchedFriction;
use super::problem::{FrictionChannel, FrictionProblem};
use crate::identify::DECISIVE;

/// Model of friction in both directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectionModel {
    /// One set of levels for both directions, next to a zero error of the force.
    SameBothWays,
    /// Coulomb, static and viscous friction of each direction, the instruments without zero error.
    DiffersByDirection,
}

impl DirectionModel {
    /// In JSON.
    pub fn name(self) -> &'static str {
        match self {
            DirectionModel::SameBothWays => "same_both_ways",
            DirectionModel::DiffersByDirection => "differs_by_direction",
        }
    }
}

/// A model with its fit and criterion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplainedByDirections {
    /// Which.
    pub model: DirectionModel,
    /// The friction that does it best.
    pub lugre: LuGre,
    /// N, zero error of the force that goes with it.
    pub zero: f64,
    /// Information criterion; the lower the better, its zero has no meaning.
    pub criterion: f64,
}

/// Both models compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionEvidence {
    /// One friction for both directions, then one for each.
    pub models: [ExplainedByDirections; 2],
}

impl DirectionEvidence {
    /// By how much the criterion is lower with levels of each direction.
    pub fn difference(&self) -> f64 {
        let [same, differs] = &self.models;
        same.criterion - differs.criterion
    }

    /// The model of the numbers: levels of each direction where the evidence for them is decisive.
    pub fn chosen(&self) -> DirectionModel {
        match self.difference() >= DECISIVE {
            true => DirectionModel::DiffersByDirection,
            false => DirectionModel::SameBothWays,
        }
    }

    /// The information criterion of Schwarz (1978) for both fits of the same recordings.
    ///
    /// ```text
    /// BIC = m ln n - 2 ln L        ln L = -sum over signals of f (n_c ln s_c + sum rho(r/s_c)),   n = sum f n_c
    /// ```
    ///
    /// with s_c the likeliest scale of each signal, m the number of shared variables, and f the
    /// fraction of residuals that are independent with the levels of each direction. Terms that
    /// both models share are left out.
    pub(super) fn of(fits: [&SearchedFriction<'_>; 2]) -> DirectionEvidence {
        let [_, differs] = fits;
        let fractions: Vec<f64> =
            differs.problem.channels.iter().map(|channel| channel.independent).collect();
        let rows: f64 = differs
            .problem
            .channels
            .iter()
            .zip(&fractions)
            .map(|(channel, fraction)| fraction * rows_of(channel))
            .sum();
        let models = fits.map(|fit| {
            let (lugre, zero) = fit.problem.friction(&fit.minimum.variables);
            let loss: f64 = losses(&fit.problem, &fit.minimum.linearised.residuals)
                .zip(&fractions)
                .map(|(loss, fraction)| loss * fraction)
                .sum();
            let searched = (super::problem::SHARED - fit.problem.known_variables().len()) as f64;
            let criterion = searched * portable::ln(rows) + 2.0 * loss;
            ExplainedByDirections { model: fit.problem.directions, lugre, zero, criterion }
        });
        DirectionEvidence { models }
    }
}

fn rows_of(channel: &FrictionChannel) -> f64 {
    let [from, to] = channel.residuals;
    (to - from) as f64
}

/// The contribution of each signal to -ln L at its likeliest scale.
fn losses<'a>(problem: &'a FrictionProblem<'_>, residuals: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let beyond = Settings::default().robust_beyond;
    problem.channels.iter().map(move |channel| {
        let [from, to] = channel.residuals;
        let own = residuals.get(from..to).unwrap_or_default();
        // over the scale of the fit; no finer than an instrument resolves
        let unit = channel.effective_scale();
        let scales = rows_of(channel) * portable::ln(unit);
        negative_log_likelihood(own, channel.finest / unit, beyond) + scales
    })
}
