//! Controller, prefilter and sensor.

use super::Check;
use crate::{
    DeclaredController, DeclaredElement, DeclaredQuantization, ElementKind, Formula, Prefilter, Project,
    RationalFunction, Transfer, Variable,
};
use phea_dynamics::controller::AntiWindup;
use phea_dynamics::linear::Discretization;
use phea_quantity::{ANGULAR_FREQUENCY, display};

/// Largest number of zeros, poles or elements of a transfer function.
const MAXIMUM_ORDER: usize = 50;

pub(super) fn controllers(project: &Project, check: &mut Check<'_, '_>) {
    if let Some(controller) = &project.controller {
        let timing = [
            "sample_time",
            "delay",
            "discretization",
            "discretization_frequency",
            "saturation",
            "anti_windup",
            "impedance",
            "pressure_feedback",
        ];
        let only_timing = timing.iter().any(|name| check.declared(&format!("controller.{name}")));
        transfer(&controller.transfer, "controller", controller.sample_time, only_timing, check);
        if controller.anti_windup != AntiWindup::None && controller.saturation.is_none() {
            check.warning("controller.anti_windup", "`anti_windup` has no effect without `saturation`");
        }
        let discrete = is_discrete(&controller.transfer);
        let chosen = controller.discretization != Discretization::default();
        if chosen && (discrete || controller.sample_time.is_none()) {
            let why = if discrete { "the controller is in `z` already" } else { "there is no `sample_time`" };
            check.warning("controller.discretization", format!("`discretization` has no effect: {why}"));
        }
        exact_at(controller, discrete, check);
        if let Some(declared) = &controller.quantization {
            quantization(declared, controller.sample_time, check);
        }
    }
    if let Some(prefilter) = &project.prefilter {
        transfer(&prefilter.transfer, "prefilter", prefilter.sample_time, false, check);
        continuous_prefilter(project, prefilter, check);
    }
    let sample_time = project.controller.as_ref().and_then(|controller| controller.sample_time);
    let noise = project.actuator.as_ref().map_or(0.0, |actuator| actuator.force_sensor.noise);
    if noise > 0.0 && project.controller.is_some() && sample_time.is_none() {
        check.warning("force_sensor.noise", "`noise` has no effect on a continuous controller");
    }
    velocity_sensor(project, check);
}

/// Checks the frequency at which Tustin's rule is exact.
fn exact_at(controller: &DeclaredController, discrete: bool, check: &mut Check<'_, '_>) {
    let Some(frequency) = controller.discretization_frequency else { return };
    let place = "controller.discretization_frequency";
    let Some(sample_time) = controller.sample_time.filter(|_| !discrete) else {
        let why = if discrete { "the controller is in `z` already" } else { "there is no `sample_time`" };
        return check.warning(place, format!("`discretization_frequency` has no effect: {why}"));
    };
    if controller.discretization != Discretization::Tustin {
        let message =
            "`discretization_frequency` is that of `discretization = \"tustin\"`: the other rules have none";
        return check.error(place, message);
    }
    let highest = std::f64::consts::PI / sample_time;
    if frequency >= highest {
        let [frequency, highest] = [frequency, highest].map(|value| display(value, &ANGULAR_FREQUENCY, 4));
        let message = format!("{frequency} is not below {highest}, half the sampling frequency");
        check.error(place, message);
    }
}

fn velocity_sensor(project: &Project, check: &mut Check<'_, '_>) {
    let Some(sensor) = project.actuator.as_ref().and_then(|actuator| actuator.velocity_sensor.as_ref())
    else {
        return;
    };
    let place = "velocity_sensor";
    if sensor.filter_damping_ratio.is_some() && sensor.filter_frequency.is_none() {
        let message = "`filter_damping_ratio` is that of a filter: state its `filter_frequency`";
        check.error(&format!("{place}.filter_damping_ratio"), message);
    }
    let controller = project.controller.as_ref();
    if controller.is_none_or(|controller| controller.load_velocity_feed_forward.is_none()) {
        let message = "[velocity_sensor] has no effect: [controller] has no `load_velocity_feed_forward`";
        check.warning(place, message);
    } else if controller.is_some_and(|controller| controller.sample_time.is_none()) {
        for (name, value) in [("noise", sensor.noise), ("resolution", sensor.resolution)] {
            if value > 0.0 {
                let message = format!("`{name}` has no effect on a continuous controller");
                check.warning(&format!("{place}.{name}"), message);
            }
        }
    }
}

fn continuous_prefilter(project: &Project, prefilter: &Prefilter, check: &mut Check<'_, '_>) {
    if !prefilter.continuous {
        return;
    }
    if is_discrete(&prefilter.transfer) {
        check.error("prefilter.continuous", "a prefilter in `z` cannot be continuous");
    } else if project.controller.as_ref().is_none_or(|controller| controller.sample_time.is_none()) {
        check.warning("prefilter.continuous", "`continuous` has no effect with a continuous controller");
    }
}

fn quantization(declared: &DeclaredQuantization, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
    let path = "controller.quantization";
    if sample_time.is_none() {
        check.error(path, "only a sampled controller rounds: [controller] gives no `sample_time`");
    }
    for (name, bits, range) in [
        ("command", declared.command_bits, declared.command_range),
        ("measurement", declared.measurement_bits, declared.measurement_range),
    ] {
        if (bits > 0) != range.is_some() {
            check.error(path, format!("`{name}_bits` and `{name}_range` make a converter together"));
        }
        check.strictly_ascending(&format!("{path}.{name}_range"), range);
    }
    for (name, allowed, converter, bits) in [
        ("allowed_force_error", declared.allowed_force_error, "command", declared.command_bits),
        ("allowed_command_error", declared.allowed_command_error, "measurement", declared.measurement_bits),
    ] {
        if allowed.is_some() && bits == 0 {
            let message = format!(
                "`{name}` limits the converter of the {converter}, which is not declared: state `{converter}_bits` and `{converter}_range`"
            );
            check.error(&format!("{path}.{name}"), message);
        }
    }
}

pub(super) fn sensor(project: &Project, check: &mut Check<'_, '_>) {
    let Some(sensor) = &project.sensor else { return };
    let formulas = [&sensor.transfer.numerator, &sensor.transfer.denominator];
    if formulas.iter().any(|formula| formula.variable() == Some(Variable::Z)) {
        return check.error("sensor", "the sensor is written in `s`, not in `z`");
    }
    let constant =
        |formula: &Formula| formula.polynomial().and_then(|coefficients| coefficients.last().copied());
    let [Some(over), Some(under)] = formulas.map(constant) else { return };
    if over != under {
        let message =
            format!("[sensor] is {} at zero frequency, not 1: the loop follows what it shows", over / under);
        check.warning("sensor", message);
    }
}

pub(super) fn is_discrete(transfer: &Transfer) -> bool {
    transfer.ratio.is_sampled()
        || transfer.elements.iter().any(|element| element.enabled && element.is_sampled())
}

/// Checks a transfer function; a controller that states its timing but no transfer function must be
/// designed.
fn transfer(
    transfer: &Transfer,
    path: &str,
    sample_time: Option<f64>,
    may_be_designed: bool,
    check: &mut Check<'_, '_>,
) {
    let declared = |check: &Check<'_, '_>, name: &str| check.declared(&format!("{path}.{name}"));
    let polynomials = declared(check, "numerator") || declared(check, "denominator");
    let factors = ["gain", "zeros", "poles"].iter().any(|name| declared(check, name));
    let elements = declared(check, "elements");
    let forms = "`numerator` and `denominator`, or `gain` with `zeros` and `poles`, or `elements`";
    match [polynomials, factors, elements].iter().filter(|is| **is).count() {
        0 if may_be_designed => {}
        0 => check.missing(path, "numerator", format!("an empty [{path}]: it takes {forms}")),
        1 => {}
        _ => check.error(path, format!("more than one form in [{path}]: it takes either {forms}")),
    }
    rational_form(&transfer.ratio, path, sample_time, [polynomials, factors], check);
    if transfer.elements.len() > MAXIMUM_ORDER {
        check.error(&format!("{path}.elements"), format!("more than {MAXIMUM_ORDER} elements"));
    }
    if excess(transfer).is_some_and(|excess| excess > 0) {
        let message =
            format!("[{path}] has more zeros than poles: it can be verified, but not simulated or sampled");
        check.warning(path, message);
    }
    let sampled = is_discrete(transfer);
    for (index, element) in transfer.elements.iter().enumerate().take(MAXIMUM_ORDER) {
        let path = format!("{path}.elements[{index}]");
        one_element(element, &path, sample_time, check);
        if sampled
            && element.enabled
            && !matches!(element.kind, ElementKind::Gain { .. })
            && !element.is_sampled()
        {
            check.error(&path, "this element is in `s`, but another one is in `z`");
        }
    }
}

/// Checks polynomials or factors, whichever are written.
fn rational_form(
    ratio: &RationalFunction,
    path: &str,
    sample_time: Option<f64>,
    [polynomials, factors]: [bool; 2],
    check: &mut Check<'_, '_>,
) {
    if polynomials {
        polynomial_form(ratio, path, sample_time, check);
    }
    if factors {
        if ratio.gain.is_none() {
            check.missing(path, "gain", "`zeros` and `poles` need `gain`, the leading coefficient");
        }
        if ratio.gain == Some(0.0) {
            check.error(&format!("{path}.gain"), "`gain` is zero");
        }
        sample_time_of_z(ratio, path, sample_time, check);
        conjugates(&ratio.zeros, &format!("{path}.zeros"), check);
        conjugates(&ratio.poles, &format!("{path}.poles"), check);
    }
    if ratio.domain.is_some() && !factors {
        let message = "`domain` belongs to `gain`, `zeros` and `poles`: formulas say `s` or `z`";
        check.error(&format!("{path}.domain"), message);
    }
}

fn polynomial_form(
    ratio: &RationalFunction,
    path: &str,
    sample_time: Option<f64>,
    check: &mut Check<'_, '_>,
) {
    for (name, formula) in [("numerator", &ratio.numerator), ("denominator", &ratio.denominator)] {
        if formula.is_none() {
            check.missing(path, name, format!("missing `{name}` in [{path}]"));
        }
    }
    let (Some(numerator), Some(denominator)) = (&ratio.numerator, &ratio.denominator) else { return };
    if let (Some(over), Some(under)) = (numerator.variable(), denominator.variable())
        && over != under
    {
        check.error(&format!("{path}.denominator"), "numerator and denominator mix `s` and `z`");
    }
    sample_time_of_z(ratio, path, sample_time, check);
}

fn sample_time_of_z(
    ratio: &RationalFunction,
    path: &str,
    sample_time: Option<f64>,
    check: &mut Check<'_, '_>,
) {
    if ratio.is_sampled() && sample_time.is_none() {
        let table = path.split('.').next().unwrap_or(path);
        let message = format!("missing `sample_time` in [{table}]: it is written in `z`");
        check.missing(path, "sample_time", message);
    }
}

/// Excess of the numerator powers over the denominator powers, if known.
fn excess(transfer: &Transfer) -> Option<i64> {
    transfer.as_elements().iter().filter(|element| element.enabled).map(element_excess).sum()
}

/// Excess of zeros over poles of an element, if known.
pub(super) fn element_excess(element: &DeclaredElement) -> Option<i64> {
    let power = |count: usize| i64::try_from(count).ok();
    Some(match &element.kind {
        ElementKind::Gain { .. } | ElementKind::Lead { .. } | ElementKind::Lag { .. } => 0,
        ElementKind::Notch { .. } | ElementKind::ProportionalIntegral { .. } => 0,
        ElementKind::ProportionalIntegralDerivative { .. } => 0,
        ElementKind::Zero { .. } | ElementKind::Differentiator => 1,
        ElementKind::Pole { .. } | ElementKind::Integrator => -1,
        ElementKind::ComplexZeros { .. } => 2,
        ElementKind::ComplexPoles { .. } | ElementKind::RollOff { .. } => -2,
        ElementKind::General(ratio) => match (&ratio.numerator, &ratio.denominator) {
            (Some(numerator), Some(denominator)) => {
                power(numerator.polynomial()?.len())? - power(denominator.polynomial()?.len())?
            }
            _ => power(ratio.zeros.len())? - power(ratio.poles.len())?,
        },
    })
}

/// Rejects complex numbers without their conjugates, since coefficients are real.
pub(super) fn conjugates(roots: &[[f64; 2]], path: &str, check: &mut Check<'_, '_>) {
    if roots.len() > MAXIMUM_ORDER {
        return check.error(path, format!("more than {MAXIMUM_ORDER} roots"));
    }
    let count = |wanted: [f64; 2]| roots.iter().filter(|root| **root == wanted).count();
    for &[real, imaginary] in roots {
        if imaginary != 0.0 && count([real, imaginary]) != count([real, -imaginary]) {
            let message = format!("[{real}, {imaginary}] has no conjugate [{real}, {}]", -imaginary);
            return check.error(path, message);
        }
    }
}

/// Checks one element at `path`.
pub(super) fn one_element(
    element: &DeclaredElement,
    path: &str,
    sample_time: Option<f64>,
    check: &mut Check<'_, '_>,
) {
    let kind = format!("{path}.kind");
    if !check.declared(&kind) || check.refused(&kind) {
        return; // nothing follows from a kind that is not known
    }
    let missing = |check: &Check<'_, '_>, name: &str| !check.declared(&format!("{path}.{name}"));
    match element.kind {
        ElementKind::Gain { value: 0.0 } if !missing(check, "value") => {
            check.error(&format!("{path}.value"), "a gain of zero");
        }
        ElementKind::ProportionalIntegral { proportional_gain: 0.0, integral_gain: 0.0 }
        | ElementKind::ProportionalIntegralDerivative {
            proportional_gain: 0.0,
            integral_gain: 0.0,
            derivative_gain: 0.0,
            ..
        } if !missing(check, "proportional_gain") && !missing(check, "integral_gain") => {
            check.error(&format!("{path}.proportional_gain"), "a gain of zero");
        }
        ElementKind::Lag { zero_frequency, pole_frequency }
            if zero_frequency <= pole_frequency && !missing(check, "zero_frequency") =>
        {
            let message = "a lag has its zero above its pole";
            check.error_with_help(&format!("{path}.zero_frequency"), message, "write kind = \"lead\"");
        }
        ElementKind::General(ref ratio) => general(ratio, path, sample_time, check),
        _ => {}
    }
}

fn general(ratio: &RationalFunction, path: &str, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
    let declared = |check: &Check<'_, '_>, name: &str| check.declared(&format!("{path}.{name}"));
    let polynomials = ["numerator", "denominator"].iter().any(|name| declared(check, name));
    let factors = ["gain", "zeros", "poles"].iter().any(|name| declared(check, name));
    let forms = "`numerator` and `denominator`, or `gain` with `zeros` and `poles`";
    match [polynomials, factors] {
        [false, false] => check.missing(path, "numerator", format!("a general element takes {forms}")),
        [true, true] => {
            check.error(path, format!("more than one form: a general element takes either {forms}"))
        }
        _ => {}
    }
    rational_form(ratio, path, sample_time, [polynomials, factors], check);
}
