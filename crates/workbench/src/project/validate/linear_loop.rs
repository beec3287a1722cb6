//! Controller, prefilter and sensor.

use super::Check;
use crate::project::{
    AntiWindup, Discretization, Element, ElementKind, Formula, Project, Quantization, Transfer, TransferForm,
    Variable,
};

/// Most zeros, poles or elements of a transfer function.
const MAXIMUM_ORDER: usize = 50;

pub(super) fn controllers(project: &Project, check: &mut Check<'_, '_>) {
    if let Some(controller) = &project.controller {
        let timing = ["sample_time", "delay", "discretization", "saturation", "anti_windup"];
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
        if let Some(declared) = &controller.quantization {
            quantization(declared, controller.sample_time, check);
        }
    }
    if let Some(prefilter) = &project.prefilter {
        transfer(&prefilter.transfer, "prefilter", prefilter.sample_time, false, check);
    }
}

fn quantization(declared: &Quantization, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
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
        if range.is_some_and(|[low, high]| low >= high) {
            check.error(
                &format!("{path}.{name}_range"),
                format!("`{name}_range` is empty or reversed: the lower value comes first"),
            );
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

fn is_discrete(transfer: &Transfer) -> bool {
    if transfer.domain == Some(Variable::Z) {
        return true;
    }
    let formulas = [&transfer.numerator, &transfer.denominator];
    formulas.into_iter().flatten().any(|formula| formula.variable() == Some(Variable::Z))
}

/// Without a law a controller that says when it acts is one to be designed.
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
    if polynomials {
        polynomial_form(transfer, path, sample_time, check);
    }
    if factors {
        if transfer.gain.is_none() {
            check.missing(path, "gain", "`zeros` and `poles` need `gain`, the leading coefficient");
        }
        if transfer.gain == Some(0.0) {
            check.error(&format!("{path}.gain"), "`gain` is zero");
        }
        sample_time_of_z(transfer, path, sample_time, check);
        conjugates(&transfer.zeros, &format!("{path}.zeros"), check);
        conjugates(&transfer.poles, &format!("{path}.poles"), check);
    }
    if transfer.domain.is_some() && !factors {
        let message =
            "`domain` belongs to `gain`, `zeros` and `poles`: formulas say `s` or `z`, elements are in `s`";
        check.error(&format!("{path}.domain"), message);
    }
    if transfer.elements.len() > MAXIMUM_ORDER {
        check.error(&format!("{path}.elements"), format!("more than {MAXIMUM_ORDER} elements"));
    }
    if excess(transfer).is_some_and(|excess| excess > 0) {
        let message =
            format!("[{path}] has more zeros than poles: it can be verified, but not simulated or sampled");
        check.warning(path, message);
    }
    for (index, element) in transfer.elements.iter().enumerate() {
        one_element(element, &format!("{path}.elements[{index}]"), check);
    }
}

fn polynomial_form(transfer: &Transfer, path: &str, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
    for (name, formula) in [("numerator", &transfer.numerator), ("denominator", &transfer.denominator)] {
        if formula.is_none() {
            check.missing(path, name, format!("missing `{name}` in [{path}]"));
        }
    }
    let (Some(numerator), Some(denominator)) = (&transfer.numerator, &transfer.denominator) else { return };
    if let (Some(over), Some(under)) = (numerator.variable(), denominator.variable())
        && over != under
    {
        check.error(&format!("{path}.denominator"), "numerator and denominator mix `s` and `z`");
    }
    sample_time_of_z(transfer, path, sample_time, check);
}

fn sample_time_of_z(transfer: &Transfer, path: &str, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
    if is_discrete(transfer) && sample_time.is_none() {
        let message = format!("missing `sample_time` in [{path}]: it is written in `z`");
        check.missing(path, "sample_time", message);
    }
}

/// Power of the numerator less that of the denominator, where both can be told.
fn excess(transfer: &Transfer) -> Option<i64> {
    let power = |count: usize| i64::try_from(count).ok();
    match transfer.form()? {
        TransferForm::Polynomials { numerator, denominator } => {
            Some(power(numerator.polynomial()?.len())? - power(denominator.polynomial()?.len())?)
        }
        TransferForm::Factors { zeros, poles, .. } => Some(power(zeros.len())? - power(poles.len())?),
        TransferForm::Elements(elements) => {
            Some(elements.iter().map(|element| i64::from(element_excess(element))).sum())
        }
    }
}

/// Zeros less poles of an element.
pub(super) fn element_excess(element: &Element) -> i32 {
    match element.kind {
        ElementKind::Gain | ElementKind::Lead | ElementKind::Notch => 0,
        ElementKind::Zero | ElementKind::Differentiator => 1,
        ElementKind::Pole | ElementKind::Integrator => -1,
        ElementKind::ComplexZeros => 2,
        ElementKind::ComplexPoles => -2,
    }
}

/// Complex numbers must come with their conjugates, since coefficients are real.
fn conjugates(roots: &[[f64; 2]], path: &str, check: &mut Check<'_, '_>) {
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

pub(super) fn one_element(element: &Element, path: &str, check: &mut Check<'_, '_>) {
    let needs: &[&str] = match element.kind {
        ElementKind::Gain => &["value"],
        ElementKind::Integrator | ElementKind::Differentiator => &[],
        ElementKind::Zero | ElementKind::Pole => &["frequency"],
        ElementKind::ComplexZeros | ElementKind::ComplexPoles => &["frequency", "damping_ratio"],
        ElementKind::Lead => &["zero_frequency", "pole_frequency"],
        ElementKind::Notch => &["frequency", "damping_ratio", "numerator_damping_ratio"],
    };
    let values = [
        ("value", element.value),
        ("frequency", element.frequency),
        ("damping_ratio", element.damping_ratio),
        ("numerator_damping_ratio", element.numerator_damping_ratio),
        ("zero_frequency", element.zero_frequency),
        ("pole_frequency", element.pole_frequency),
    ];
    for (name, value) in values {
        let needed = needs.contains(&name);
        if needed && value.is_none() {
            check.missing(path, name, format!("this element needs `{name}`"));
        }
        if !needed && value.is_some() {
            check.error(&format!("{path}.{name}"), format!("`{name}` has no meaning for this element"));
        }
    }
    if element.kind == ElementKind::Gain && element.value == Some(0.0) {
        check.error(&format!("{path}.value"), "a gain of zero");
    }
}
