use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::stiffness::{StiffnessModel, StrokeStiffness, line_fraction_for_stiffness};

use super::{HoseOption, Question, SizingProblem};

/// One trial of the iteration over the gain, steps f to j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainStep {
    /// Gain K_p, V/N.
    pub gain_v_per_n: f64,
    /// Stiffness K_H of equation 6.16, N/m; infinite at or below the pole.
    pub stiffness_n_per_m: f64,
    /// Length L_ho of line A for this stiffness, m: zero if no hose is needed.
    pub length_m: f64,
}

/// A hose with the length and gain that one branch of the flowchart found for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// True if the gain was given or searched for (left branch) and not the length (right branch).
    pub by_gain: bool,
    /// Stiffness model.
    pub model: StiffnessModel,
    /// Trials of the left branch.
    pub steps: Vec<GainStep>,
    /// Length of line A and of line B, m; zero if no hose is needed.
    pub lengths_m: [f64; 2],
    /// Stiffness over the stroke at that length.
    pub stiffness: StrokeStiffness,
    /// Gain for the desired time constant at the least stiffness, V/N.
    pub gain_v_per_n: f64,
}

/// Branches of the flowchart for one hose and one stiffness model.
pub(super) fn branches(
    problem: &SizingProblem,
    option: &HoseOption,
    model: StiffnessModel,
    question: Question,
) -> Vec<Branch> {
    match question {
        Question::Gain(gain) => vec![at_gain(problem, option, model, vec![], gain)],
        Question::Length(length) => vec![at_lengths(problem, option, model, [length; 2])],
        Question::Both => {
            let proportion = option.proportion(model, problem.fluid_modulus);
            let available = problem.available_length(proportion);
            vec![
                search(problem, option, model),
                at_lengths(problem, option, model, proportion.map(|fraction| fraction * available)),
            ]
        }
    }
}

/// Steps k and l: stiffness of these lengths, and the gain that it needs.
fn at_lengths(
    problem: &SizingProblem,
    option: &HoseOption,
    model: StiffnessModel,
    lengths_m: [f64; 2],
) -> Branch {
    let stiffness = problem.stroke_stiffness(option, lengths_m, model);
    let gain_v_per_n = problem.gain_for_stiffness(stiffness.minimum);
    Branch { by_gain: false, model, steps: vec![], lengths_m, stiffness, gain_v_per_n }
}

/// Steps g and h at one gain.
fn at_gain(
    problem: &SizingProblem,
    option: &HoseOption,
    model: StiffnessModel,
    mut steps: Vec<GainStep>,
    gain: f64,
) -> Branch {
    let step = gain_step(problem, option, model, gain);
    steps.push(step);
    let proportion = option.proportion(model, problem.fluid_modulus);
    let lengths_m =
        proportion.map(|fraction| if step.length_m == 0.0 { 0.0 } else { fraction * step.length_m });
    let stiffness = problem.stroke_stiffness(option, lengths_m, model);
    Branch { by_gain: true, model, steps, lengths_m, stiffness, gain_v_per_n: gain }
}

/// Steps f to j: the gain starts at the largest and is halved until the hose is acceptably short or
/// the gain at its least; then the largest gain whose hose is acceptable is between the last two
/// trials and is found by bisection.
fn search(problem: &SizingProblem, option: &HoseOption, model: StiffnessModel) -> Branch {
    let trial = |gain| gain_step(problem, option, model, gain);
    let available = problem.available_length(option.proportion(model, problem.fluid_modulus));
    let fits = |step: &GainStep| step.length_m <= available;
    let floor = problem.minimum_gain.min(problem.maximum_gain);
    let mut steps = Vec::new();
    let mut last = trial(problem.maximum_gain);
    while !fits(&last) && last.gain_v_per_n > floor {
        steps.push(last);
        last = trial((last.gain_v_per_n / 2.0).max(floor));
    }
    let gain = match steps.last() {
        Some(too_long) if fits(&last) => {
            largest_gain(last.gain_v_per_n, too_long.gain_v_per_n, |gain| fits(&trial(gain)))
        }
        _ => last.gain_v_per_n,
    };
    commercial(problem, option, at_gain(problem, option, model, steps, gain))
}

/// Largest gain that fits, between one that does and one that does not.
fn largest_gain(mut fitting: f64, mut too_large: f64, fits: impl Fn(f64) -> bool) -> f64 {
    // 40 bisections leave a relative interval of 1e-12.
    for _ in 0..40 {
        let middle = 0.5 * (fitting + too_large);
        if fits(middle) {
            fitting = middle;
        } else {
            too_large = middle;
        }
    }
    fitting
}

/// The hose cut to the next multiple of the increment that is still acceptable, with the gain for
/// that length.
fn commercial(problem: &SizingProblem, option: &HoseOption, exact: Branch) -> Branch {
    let proportion = option.proportion(exact.model, problem.fluid_modulus);
    let available = problem.available_length(proportion);
    let [length_a, _] = exact.lengths_m;
    let sound = length_a > 0.0 && length_a <= available;
    let Some(increment) = problem.length_increment.filter(|_| sound) else { return exact };
    let tolerance = 1e-9;
    let up = exact.lengths_m.map(|length| (length / increment - tolerance).ceil() * increment);
    let down = proportion.map(|fraction| (fraction * available / increment + tolerance).floor() * increment);
    if down.iter().any(|length| *length <= 0.0) {
        return exact;
    }
    let cut = at_lengths(problem, option, exact.model, [up[0].min(down[0]), up[1].min(down[1])]);
    Branch { by_gain: true, steps: exact.steps, ..cut }
}

fn gain_step(problem: &SizingProblem, option: &HoseOption, model: StiffnessModel, gain: f64) -> GainStep {
    let stiffness_n_per_m = problem.stiffness_for_gain(gain);
    let [line_a, line_b] = option.lines(option.proportion(model, problem.fluid_modulus));
    let length = line_fraction_for_stiffness(
        model,
        problem.fluid_modulus,
        &problem.cylinder,
        [&line_a, &line_b],
        StiffeningMember::Nominal,
        stiffness_n_per_m,
    );
    GainStep { gain_v_per_n: gain, stiffness_n_per_m, length_m: length.metres() }
}

impl Branch {
    /// True if both lines have equal lengths.
    pub fn is_alike(&self) -> bool {
        self.lengths_m[0] == self.lengths_m[1]
    }
}
