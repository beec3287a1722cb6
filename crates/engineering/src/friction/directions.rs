//! Evidence for one friction in both directions, or for a separate one in each.

use phea_dynamics::least_squares::{Settings, negative_log_likelihood};
use phea_dynamics::portable;
use phea_hydraulics::friction::LuGre;

use super::SearchedFriction;
use super::problem::{FrictionChannel, FrictionProblem, MeasuredFriction};
use crate::identify::DECISIVE;

/// Model of friction in both directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectionModel {
    /// One set of levels for both directions, with a zero error of the force.
    SameBothWays,
    /// Coulomb, static and viscous friction of each direction, with instruments without zero error.
    DiffersByDirection,
}

impl DirectionModel {
    /// Name in JSON.
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
    /// Compared model.
    pub model: DirectionModel,
    /// Friction that explains the recordings best.
    pub lugre: LuGre,
    /// Zero error of the force for this friction, N.
    pub zero: f64,
    /// Information criterion; lower is better, its zero has no meaning.
    pub criterion: f64,
}

/// Comparison of both models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionEvidence {
    /// One friction for both directions, then one for each.
    pub models: [ExplainedByDirections; 2],
}

impl DirectionEvidence {
    /// Reduction of the criterion by separate levels for each direction.
    pub fn difference(&self) -> f64 {
        let [same, differs] = &self.models;
        same.criterion - differs.criterion
    }

    /// Model for the results: levels for each direction if the evidence for them is decisive.
    pub fn chosen(&self) -> DirectionModel {
        match self.difference() >= DECISIVE {
            true => DirectionModel::DiffersByDirection,
            false => DirectionModel::SameBothWays,
        }
    }

    /// Information criterion of Schwarz (1978) for both fits of these recordings.
    ///
    /// ```text
    /// BIC = m ln n - 2 ln L        ln L = -sum over signals of f (n_c ln s_c + sum rho(r/s_c)),   n = sum f n_c
    /// ```
    ///
    /// with s_c the likeliest scale of each signal, m the number of shared variables, and f the
    /// fraction of residuals that are independent with the levels for each direction. Terms common
    /// to both models are omitted.
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
            let MeasuredFriction { lugre, zero } = fit.problem.friction(&fit.minimum.variables);
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

/// Contribution of each signal to -ln L at its likeliest scale.
fn losses<'a>(problem: &'a FrictionProblem<'_>, residuals: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let beyond = Settings::default().robust_beyond;
    problem.channels.iter().map(move |channel| {
        let [from, to] = channel.residuals;
        let own = residuals.get(from..to).unwrap_or_default();
        // relative to the scale of the fit; no finer than an instrument resolves
        let unit = channel.effective_scale();
        let scales = rows_of(channel) * portable::ln(unit);
        negative_log_likelihood(own, channel.finest / unit, beyond) + scales
    })
}
