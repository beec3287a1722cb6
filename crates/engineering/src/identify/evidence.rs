//! Evidence of the recordings for each model of the leakage.

use phea_dynamics::least_squares::{Settings, negative_log_likelihood};
use phea_dynamics::portable;
use phea_hydraulics::servovalve::{LeakageModel, StaticCoefficients};

use super::fit::Fit;

/// Difference of the criterion beyond which the evidence is decisive: odds of 150 to 1 (Kass and
/// Raftery 1995, "very strong").
pub const DECISIVE: f64 = 10.0;

/// Greatest correlation of neighbours that is used: one row in two hundred counts.
const MOST_CORRELATED: f64 = 0.99;

/// A model of the leakage with its fit and criterion.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedBy {
    /// Compared model.
    pub model: LeakageModel,
    /// Coefficients that explain the recordings best.
    pub coefficients: StaticCoefficients,
    /// Information criterion; lower is better, its zero has no meaning.
    pub criterion: f64,
    /// Root mean square of all residuals, each divided by the range of its signal.
    pub residual_rms: f64,
}

/// Comparison of the models of the leakage.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelEvidence {
    /// Both models, the one that explains the recordings better first.
    pub models: [ExplainedBy; 2],
}

impl ModelEvidence {
    /// Difference of the criteria of the better and the worse model.
    pub fn difference(&self) -> f64 {
        let [better, worse] = &self.models;
        worse.criterion - better.criterion
    }

    /// The better model, if the difference is decisive.
    pub fn preferred(&self) -> Option<LeakageModel> {
        (self.difference() >= DECISIVE).then_some(self.models[0].model)
    }

    /// Both fits compared by the [`criteria`].
    pub(super) fn of(fits: [&Fit<'_>; 2]) -> ModelEvidence {
        let criteria = criteria(fits);
        let explained = |fit: &Fit<'_>, criterion: f64| ExplainedBy {
            model: fit.together.tested.leakage_model,
            coefficients: fit.coefficients(),
            criterion,
            residual_rms: super::residual_rms(&fit.signals()),
        };
        let mut models = [explained(fits[0], criteria[0]), explained(fits[1], criteria[1])];
        if models[1].criterion < models[0].criterion {
            models.reverse();
        }
        ModelEvidence { models }
    }
}

/// Information criterion of Schwarz (1978) for both fits of these recordings.
///
/// ```text
/// BIC = m ln n - 2 ln L        ln L = -sum over signals of f (n_c ln s_c + sum rho(r/s_c)),   n = sum f n_c
/// ```
///
/// with s_c the likeliest scale of each signal, m the number of coefficients and scales, and f the
/// fraction of rows that are independent, (1 - c)/(1 + c) with c the correlation of neighbouring
/// residuals of the better model (Bayley and Hammersley 1946). A constant common to both models is
/// omitted.
pub(super) fn criteria(fits: [&Fit<'_>; 2]) -> [f64; 2] {
    let signals = fits.map(Fit::signals);
    let losses = fits.map(losses);
    let sum = |losses: &[f64], fractions: &[f64]| -> f64 {
        losses.iter().zip(fractions).map(|(loss, fraction)| loss * fraction).sum()
    };
    let all = vec![1.0; losses[0].len()];
    let second_is_better = sum(&losses[1], &all) < sum(&losses[0], &all);
    let [first, second] = &signals;
    let better = if second_is_better { second } else { first };
    let fractions: Vec<f64> = better.iter().map(|signal| independent_fraction(signal.correlation)).collect();
    let independent_rows: f64 =
        better.iter().zip(&fractions).map(|(signal, fraction)| fraction * signal.rows as f64).sum();
    let of = |index: usize| {
        let numbers = fits[index].together.variables.count() + fractions.len();
        numbers as f64 * portable::ln(independent_rows) + 2.0 * sum(&losses[index], &fractions)
    };
    [of(0), of(1)]
}

/// Fraction of independent rows if neighbouring residuals have this correlation.
pub(super) fn independent_fraction(correlation: f64) -> f64 {
    let correlation = correlation.clamp(0.0, MOST_CORRELATED);
    (1.0 - correlation) / (1.0 + correlation)
}

/// Contribution of each signal to -ln L at its likeliest scale.
fn losses(fit: &Fit<'_>) -> Vec<f64> {
    let beyond = Settings::default().robust_beyond;
    let residuals = fit.together.by_channel(&fit.minimum.linearised.residuals);
    let of = |(channel, own): (&super::channels::Channel, &[f64])| {
        // relative to the scale of the fit; no finer than an instrument resolves
        let least = channel.least_scale() / channel.scale;
        let scales = fit.together.scales(channel).map(portable::ln).sum::<f64>();
        negative_log_likelihood(own, least, beyond) + scales
    };
    fit.together.channels.iter().zip(residuals).map(of).collect()
}
