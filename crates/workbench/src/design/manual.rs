//! The designed controller in the terms of a controller's manual.

use std::f64::consts::{PI, TAU};

use phea_dynamics::controller::NamedStructure;
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::Discretization;
use phea_engineering::design::{ManualLaw, ManualPart, ProjectDesign};

use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// Digits of the settings, for people.
const DIGITS: usize = 4;

/// The parts of the controller with their settings; empty for a controller without a name or
/// settings.
pub(crate) fn document(view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    if view.design.name.is_none() && view.manual.is_err() {
        return out;
    }
    out.heading("In the words of a controller's manual");
    let words = match &view.manual {
        Ok(words) => words,
        Err(gap) => {
            out.sentences([format!("{gap}: its zeros and poles are its settings")]);
            return out;
        }
    };
    let of_gain = Gain::of(view);
    let row = |part: &ManualPart| [Cell::from(part_name(part)), settings(part, of_gain)];
    out.table(Table::new(["part", "settings"]).with(words.parts.iter().map(row)));
    out.explanation(
        "The parts act in series: PI is K_p (1 + 1/(T_i s)), PID is K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1)), the standard form (ISA) with one gain for all terms; a low pass is 1/(T_f s + 1); the depth of a notch is that of its magnitude at its frequency, its width the frequency times twice the damping ratio of its poles.",
    );
    out.sentences(remarks(view, words));
    out
}

/// Meaning of the settings, and notes that apply to them.
fn remarks(view: &ProjectDesign, words: &ManualLaw) -> Vec<String> {
    let form = |part: &ManualPart| match part {
        ManualPart::ProportionalIntegral { .. } => Some("PI is K_p (1 + 1/(T_i s))"),
        ManualPart::ProportionalIntegralDerivative { .. } => {
            Some("PID is K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1))")
        }
        _ => None,
    };
    let mut all: Vec<String> = words.parts.iter().find_map(form).map(str::to_string).into_iter().collect();
    let is_pid = |part: &ManualPart| matches!(part, ManualPart::ProportionalIntegralDerivative { .. });
    if view.design.name == Some(NamedStructure::Pid) && !words.parts.iter().any(is_pid) {
        all.push(
            "as a PID it would have no positive T_d, since its filter is slower than a zero: so it is a PI with a lag"
                .to_string(),
        );
    }
    let integrates = |part: &ManualPart| {
        matches!(
            part,
            ManualPart::Integral { .. }
                | ManualPart::ProportionalIntegral { .. }
                | ManualPart::ProportionalIntegralDerivative { .. }
        )
    };
    let follows = view.designed.problem.in_time.iter().any(|required| required.follows);
    if follows && !words.parts.iter().any(integrates) {
        let force = view.designed.problem.units.motion.words().force;
        all.push(format!(
            "it has no integral part: at rest the {force} is off its reference by what the gain of a plant at rest differs from that of the nominal one, and by what friction and the null of the valve make"
        ));
    }
    if let Some(sample_time_s) = view.designed.problem.compensation.sample_time_s() {
        let nyquist = PI / sample_time_s;
        let is_beyond = |part: &ManualPart| {
            matches!(part, ManualPart::Lead { zero_rad_per_s: one, pole_rad_per_s: other }
                | ManualPart::Lag { zero_rad_per_s: one, pole_rad_per_s: other } if one.max(*other) > nyquist)
        };
        if words.parts.iter().any(is_beyond) {
            all.push(format!(
                "a zero or pole lies beyond the Nyquist frequency, {} rad/s: take the sampled law, no block at this rate has it",
                significant(nyquist, 4)
            ));
        }
        let rule = match view.designed.controller.timing.discretization {
            Discretization::Tustin => "bilinear (Tustin)".to_string(),
            Discretization::PrewarpedTustin { frequency_rad_per_s } => {
                format!("bilinear (Tustin, prewarped at {} rad/s)", significant(frequency_rad_per_s, 3))
            }
            Discretization::ZeroOrderHold => "behind a zero-order hold".to_string(),
            Discretization::Matched => "by matched poles and zeros".to_string(),
        };
        all.push(format!("these are the settings of the continuous law, which is then sampled, {rule}"));
    }
    if view.declared_prefilter.is_some() {
        all.push(
            "the reference passes through the prefilter F(s) above first: the steps are those behind it"
                .to_string(),
        );
    }
    all
}

/// The unit of a gain.
#[derive(Clone, Copy)]
struct Gain {
    /// Unit of the measured quantity; `None` for a plant without units.
    per: Option<DisplayUnit>,
}

impl Gain {
    fn of(view: &ProjectDesign) -> Gain {
        Gain { per: view.gain_per }
    }

    fn cell(self, name: &str, gain: f64, then: &str) -> Cell {
        let in_si = self.per.map_or(1.0, |unit| 1.0 / unit.in_si);
        let number = Cell::number_in(gain, DIGITS, DisplayUnit { symbol: "1", in_si });
        let named = Cell::from(format!("{name} = ")).then(number);
        match self.per {
            Some(unit) => {
                let under =
                    if unit.symbol.contains('.') { format!("({})", unit.symbol) } else { unit.symbol.into() };
                named.then(Cell::unit(format!(" V/{under}{then}")))
            }
            None => named,
        }
    }
}

/// Name of a part in manuals.
pub(super) fn part_name(part: &ManualPart) -> &'static str {
    match part {
        ManualPart::Proportional { .. } => "P",
        ManualPart::Integral { .. } => "I",
        ManualPart::ProportionalIntegral { .. } => "PI",
        ManualPart::ProportionalIntegralDerivative { .. } => "PID with filter",
        ManualPart::LowPass { .. } => "low pass",
        ManualPart::SecondOrderLowPass { .. } => "low pass of second order",
        ManualPart::Lead { .. } => "lead",
        ManualPart::Lag { .. } => "lag",
        ManualPart::Notch { .. } => "notch",
    }
}

fn settings(part: &ManualPart, of_gain: Gain) -> Cell {
    let time = |name: &str, time_s: f64| {
        Cell::from(format!("{name} = ")).then(Cell::quantity(time_s, DIGITS, DisplayUnit::SECOND))
    };
    let hertz = |rad_per_s: f64| Cell::quantity(rad_per_s, DIGITS, DisplayUnit::HERTZ);
    let at = |rad_per_s: f64| {
        let number = Cell::quantity(rad_per_s, DIGITS, DisplayUnit::RADIAN_PER_SECOND);
        number.then(hertz(rad_per_s).between(" (", ")"))
    };
    match *part {
        ManualPart::Proportional { gain } => of_gain.cell("K_p", gain, ""),
        ManualPart::Integral { gain } => of_gain.cell("K_i", gain, "/s"),
        ManualPart::ProportionalIntegral { gain, integral_time_s } => {
            Cell::listed([of_gain.cell("K_p", gain, ""), time("T_i", integral_time_s)], ", ")
        }
        ManualPart::ProportionalIntegralDerivative {
            gain,
            integral_time_s,
            derivative_time_s,
            filter_time_s,
        } => {
            let times =
                [time("T_i", integral_time_s), time("T_d", derivative_time_s), time("T_f", filter_time_s)];
            Cell::listed([of_gain.cell("K_p", gain, "")].into_iter().chain(times), ", ")
        }
        ManualPart::LowPass { time_s } => time("T_f", time_s).then(", ").then(at(1.0 / time_s)),
        ManualPart::SecondOrderLowPass { frequency_rad_per_s, damping_ratio } => {
            at(frequency_rad_per_s).then(", damping ratio ").then(Cell::number(damping_ratio, DIGITS))
        }
        ManualPart::Lead { zero_rad_per_s, pole_rad_per_s }
        | ManualPart::Lag { zero_rad_per_s, pole_rad_per_s } => {
            at(zero_rad_per_s).between("zero at ", ", pole at ").then(at(pole_rad_per_s))
        }
        ManualPart::Notch {
            frequency_rad_per_s,
            pole_frequency_rad_per_s,
            zero_damping_ratio,
            pole_damping_ratio,
        } => {
            let depth = Cell::quantity(depth_db(part), 3, DisplayUnit::DECIBEL);
            let width = Cell::quantity(width_hz(part), DIGITS, DisplayUnit::IN_HERTZ);
            let [zeros, poles] =
                [zero_damping_ratio, pole_damping_ratio].map(|value| Cell::number(value, DIGITS));
            let poles_at = match frequency_rad_per_s == pole_frequency_rad_per_s {
                true => Cell::empty(),
                false => Cell::from(", its poles at ").then(at(pole_frequency_rad_per_s)),
            };
            let sizes = depth.between(", depth ", ", width ").then(width);
            let ratios = zeros.between(" (damping ratios ", " over ").then(poles).then(")");
            hertz(frequency_rad_per_s).then(sizes).then(ratios).then(poles_at)
        }
    }
}

pub(super) fn depth_db(part: &ManualPart) -> f64 {
    match part {
        ManualPart::Notch { zero_damping_ratio, pole_damping_ratio, .. } => {
            decibels(zero_damping_ratio / pole_damping_ratio)
        }
        _ => f64::NAN,
    }
}

pub(super) fn width_hz(part: &ManualPart) -> f64 {
    match part {
        ManualPart::Notch { pole_frequency_rad_per_s, pole_damping_ratio, .. } => {
            2.0 * pole_damping_ratio * pole_frequency_rad_per_s / TAU
        }
        _ => f64::NAN,
    }
}
