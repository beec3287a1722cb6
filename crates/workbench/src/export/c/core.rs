//! Header and source of the controller.

use std::fmt::Write;

use phea_dynamics::controller::{AntiWindup, Converter, Section};
use phea_machine::Deployed;

use super::number::{ARITHMETIC, braces, constant};
use crate::export::DeployedSignal;

/// Names of the series of sections, with their sections; one without sections is left out.
fn series(deployed: &Deployed) -> Vec<(&'static str, &[Section])> {
    let controller = &deployed.controller;
    let all = [
        ("prefilter", controller.prefilter_sections()),
        ("feedback", controller.feedback_sections()),
        ("inner", controller.inner_sections()),
    ];
    all.into_iter().filter(|(_, sections)| !sections.is_empty()).collect()
}

/// Both converters, if the computer reads and writes their counts.
pub(super) fn converters(deployed: &Deployed) -> Option<[Converter; 2]> {
    Some([deployed.measurement_converter?, deployed.command_converter?])
}

/// Types and functions.
pub(super) fn header(deployed: &Deployed, name: &str) -> String {
    let guard = format!("{}_H", name.to_uppercase());
    let states: String = series(deployed)
        .iter()
        .map(|(series, sections)| format!("    double {series}[{}][2];\n", sections.len()))
        .collect();
    let members: String = DeployedSignal::of(deployed)
        .iter()
        .map(|signal| format!("    double {};\n", signal.name()))
        .collect();
    let counts = converters(deployed).map_or(String::new(), |_| {
        format!(
            "/* One sample from and to counts of the converters; `signals->measurement` is not read. */\n\
             long {name}_step_counts({name}_state *state, const {name}_signals *signals, long measurement);\n\n"
        )
    });
    format!(
        "#ifndef {guard}
#define {guard}

#ifdef __cplusplus
extern \"C\" {{
#endif

/* Everything that changes from sample to sample. */
typedef struct {{
{states}    double command;
}} {name}_state;

/* What is read at a sample. */
typedef struct {{
{members}}} {name}_signals;

/* What a sample gives. */
typedef struct {{
    double command;
    double unlimited;
    int limited;
    int invalid; /* 1 if a signal was no finite number: the state is unchanged, the command repeated */
}} {name}_output;

/* State at rest, with a command of zero. */
void {name}_reset({name}_state *state);

/* State at which these signals give this command: a bumpless start. An integral part then moves on
 * with the error, and a controller without one gives its response to the error instead. The command is
 * neither limited nor rounded. Unchanged if a signal or the command is no finite number. */
void {name}_hold({name}_state *state, const {name}_signals *signals, double command);

/* One sample. */
{name}_output {name}_step({name}_state *state, const {name}_signals *signals);

{counts}/* Runs the test vectors and returns how many outputs differ; `units` receives the largest difference
 * in units in the last place. In {name}_self_test.c. */
int {name}_self_test(unsigned long long *units);

#ifdef __cplusplus
}}
#endif

#endif
"
    )
}

const CLAMPED: &str = "
/* Value within a limit of its magnitude. */
static double clamped(double value, double limit) {
    double result = value;
    if (result < -limit) {
        result = -limit;
    }
    if (result > limit) {
        result = limit;
    }
    return result;
}
";

/// The source.
pub(super) fn source(deployed: &Deployed, name: &str) -> String {
    let relaxed = format!("{}_RELAXED", name.to_uppercase());
    let mut text = format!("#include \"{name}.h\"\n\n{ARITHMETIC}");
    let _ = writeln!(
        text,
        "/* Each product and sum is rounded by itself. {relaxed} lets the compiler fuse them. */
#ifdef {relaxed}
#define ROUNDED double
#else
#define ROUNDED volatile double
#endif

static double product(double a, double b) {{
    ROUNDED result = a * b;
    return result;
}}

static double sum(double a, double b) {{
    ROUNDED result = a + b;
    return result;
}}

static double difference(double a, double b) {{
    ROUNDED result = a - b;
    return result;
}}

/* Neither an infinity nor no number. */
static int is_finite(double value) {{
    return (value - value) >= 0.0;
}}
"
    );
    if deployed.controller.command_limit().is_finite() {
        text.push_str(CLAMPED);
    }
    text.push_str(&tables(deployed));
    text.push_str(&rounding(deployed));
    text.push_str(SECTIONS);
    text.push_str(&state_functions(deployed, name));
    text.push_str(&step(deployed, name));
    text
}

/// Coefficients b0, b1, b2, a1, a2 of each section, then its steady gain, or zero and one for one
/// that integrates.
fn tables(deployed: &Deployed) -> String {
    let mut text =
        "\n/* Sections in series: b0, b1, b2, a1, a2, steady gain, 1 if it integrates. */\n".to_string();
    for (series, sections) in series(deployed) {
        let _ = writeln!(text, "static const double {series}_table[{}][7] = {{", sections.len());
        for section in sections {
            let ([b0, b1, b2], [a1, a2]) = (section.numerator, section.denominator);
            let gain = section.steady_gain();
            let integrates = f64::from(u8::from(gain.is_none()));
            let row = braces(&[b0, b1, b2, a1, a2, gain.unwrap_or(0.0), integrates]);
            let _ = writeln!(text, "    {row},");
        }
        text.push_str("};\n");
    }
    text
}

/// Functions that round to levels; none if nothing is rounded.
fn rounding(deployed: &Deployed) -> String {
    let mut text = String::new();
    let resolution = (deployed.feed_forward != 0.0 && deployed.velocity_resolution > 0.0)
        .then_some(deployed.velocity_resolution);
    let converters =
        [("measured", deployed.measurement_converter), ("commanded", deployed.command_converter)];
    if resolution.is_none() && converters.iter().all(|(_, converter)| converter.is_none()) {
        return text;
    }
    text.push_str(
        "
/* Nearest whole number, halves away from zero. */
static double whole(double value) {
    double result = value;
    if ((value > -0.5) && (value < 0.5)) {
        result = value * 0.0;
    } else if ((value > -4503599627370496.0) && (value < 4503599627370496.0)) {
        result = (double)(long long)value;
        if ((value - result) >= 0.5) {
            result = result + 1.0;
        }
        if ((value - result) <= -0.5) {
            result = result - 1.0;
        }
    } else {
        /* every number of this size is whole */
    }
    return result;
}

/* Nearest multiple of a step. */
static double level(double value, double step) {
    ROUNDED quotient = value / step;
    return product(whole(quotient), step);
}
",
    );
    for (function, converter) in converters {
        let Some(converter) = converter else { continue };
        let [minimum, maximum] = converter.range().map(constant);
        let _ = write!(
            text,
            "
static double {function}(double value) {{
    double result = level(value, {});
    if (result < {minimum}) {{
        result = {minimum};
    }}
    if (result > {maximum}) {{
        result = {maximum};
    }}
    return result;
}}
",
            constant(converter.step())
        );
    }
    text
}

/// Functions of a section.
const SECTIONS: &str = "
/* Next state of a section, once its output is known. */
static void advance(const double table[7], double memory[2], double input, double output) {
    double first = sum(difference(product(table[1], input), product(table[3], output)), memory[1]);
    memory[1] = difference(product(table[2], input), product(table[4], output));
    memory[0] = first;
}

/* Output of a section and its next state. */
static double filtered(const double table[7], double memory[2], double input) {
    double output = sum(product(table[0], input), memory[0]);
    advance(table, memory, input, output);
    return output;
}

/* State of a section in which nothing changes; one that integrates gives the wanted output. */
static double settled(const double table[7], double memory[2], double input, double wanted) {
    double output = (table[6] > 0.5) ? wanted : product(table[5], input);
    double second = difference(product(table[2], input), product(table[4], output));
    memory[0] = sum(difference(product(table[1], input), product(table[3], output)), second);
    memory[1] = second;
    return output;
}
";

/// The value that the feedforward adds, as an expression.
fn added(deployed: &Deployed) -> Option<String> {
    let gain = constant(deployed.feed_forward);
    let resolution = deployed.velocity_resolution;
    (deployed.feed_forward != 0.0).then(|| match resolution > 0.0 {
        true => format!("product({gain}, level(signals->velocity, {}))", constant(resolution)),
        false => format!("product({gain}, signals->velocity)"),
    })
}

fn measurement(deployed: &Deployed) -> &'static str {
    match deployed.measurement_converter {
        Some(_) => "measured(signals->measurement)",
        None => "signals->measurement",
    }
}

/// A loop over the sections of a series that replaces a variable.
fn through(series: &str, sections: usize, call: &str) -> String {
    format!(
        "    for (index = 0; index < {sections}; index++) {{
        {call}({series}_table[index], state->{series}[index]"
    )
}

fn state_functions(deployed: &Deployed, name: &str) -> String {
    let controller = &deployed.controller;
    let signals = DeployedSignal::of(deployed);
    let finite = signals.iter().map(|signal| format!("is_finite(signals->{})", signal.name()));
    let mut text = format!(
        "
/* 1 if every signal is a finite number. */
static int usable(const {name}_signals *signals) {{
    return {};
}}

void {name}_reset({name}_state *state) {{
    int index;
",
        finite.collect::<Vec<_>>().join(" && ")
    );
    for (series, sections) in series(deployed) {
        let _ = write!(
            text,
            "    for (index = 0; index < {}; index++) {{
        state->{series}[index][0] = 0.0;
        state->{series}[index][1] = 0.0;
    }}
",
            sections.len()
        );
    }
    let _ = write!(
        text,
        "    state->command = 0.0;
}}

void {name}_hold({name}_state *state, const {name}_signals *signals, double command) {{
    int index;
    double signal = signals->reference;
    double held = command;
    if (!usable(signals) || !is_finite(command)) {{
        return;
    }}
"
    );
    let settled = |text: &mut String, series: &str, sections: usize, variable: &str, wanted: &str| {
        let call = through(series, sections, &format!("{variable} = settled"));
        let _ = write!(text, "{call}, {variable}, {wanted});\n    }}\n");
    };
    settled(&mut text, "prefilter", controller.prefilter_sections().len(), "signal", "0.0");
    let _ = writeln!(text, "    signal = difference(signal, {});", measurement(deployed));
    if controller.reads_inner() {
        text.push_str("    {\n        double back = signals->pressure;\n");
        settled(&mut text, "inner", controller.inner_sections().len(), "back", "0.0");
        text.push_str("        held = sum(held, back);\n    }\n");
    }
    if let Some(added) = added(deployed) {
        let _ = writeln!(text, "    held = difference(held, {added});");
    }
    settled(&mut text, "feedback", controller.feedback_sections().len(), "signal", "held");
    text.push_str("    state->command = command;\n}\n");
    text
}

fn step(deployed: &Deployed, name: &str) -> String {
    let controller = &deployed.controller;
    let sections = controller.feedback_sections().len();
    let mut text = start_of_step(deployed, name);
    let filtered = |text: &mut String, series: &str, sections: usize, variable: &str| {
        let call = through(series, sections, &format!("{variable} = filtered"));
        let _ = write!(text, "{call}, {variable});\n    }}\n");
    };
    filtered(&mut text, "prefilter", controller.prefilter_sections().len(), "signal");
    let _ = writeln!(text, "    error = difference(signal, {});", measurement(deployed));
    if let Some(added) = added(deployed) {
        let _ = writeln!(text, "    beside = {added};");
    }
    if controller.reads_inner() {
        text.push_str("    signal = signals->pressure;\n");
        filtered(&mut text, "inner", controller.inner_sections().len(), "signal");
        text.push_str("    beside = difference(beside, signal);\n");
    }
    text.push_str(&feedback(deployed, sections));
    let rounded = if deployed.command_converter.is_some() { "commanded(command)" } else { "command" };
    let _ = write!(
        text,
        "    state->command = {rounded};
    result.command = state->command;
    result.unlimited = wanted;
    result.limited = !((command >= wanted) && (command <= wanted));
    result.invalid = 0;
    return result;
}}
"
    );
    text.push_str(&step_counts(deployed, name));
    text
}

/// Variables of a step, and its end if a signal is not a finite number.
fn start_of_step(deployed: &Deployed, name: &str) -> String {
    let before = match deployed.controller.anti_windup() {
        AntiWindup::Clamping => {
            format!("    double before[{}][2];\n", deployed.controller.feedback_sections().len())
        }
        AntiWindup::None | AntiWindup::BackCalculation => String::new(),
    };
    format!(
        "
{name}_output {name}_step({name}_state *state, const {name}_signals *signals) {{
    {name}_output result;
    int index;
    double signal;
    double error;
    double beside = 0.0;
    double output;
    double continued;
    double wanted;
    double command;
{before}
    if (!usable(signals)) {{
        result.command = state->command;
        result.unlimited = state->command;
        result.limited = 0;
        result.invalid = 1;
        return result;
    }}
    signal = signals->reference;
"
    )
}

/// The step from and to counts of the converters; none without both.
fn step_counts(deployed: &Deployed, name: &str) -> String {
    let Some([measured, commanded]) = converters(deployed) else { return String::new() };
    format!(
        "
long {name}_step_counts({name}_state *state, const {name}_signals *signals, long measurement) {{
    {name}_signals read = *signals;
    {name}_output result;
    double counts;
    read.measurement = product((double)measurement, {});
    result = {name}_step(state, &read);
    counts = whole(result.command / {});
    return (long)counts;
}}
",
        constant(measured.step()),
        constant(commanded.step())
    )
}

/// The feedback compensator with the limit of the command.
fn feedback(deployed: &Deployed, sections: usize) -> String {
    let controller = &deployed.controller;
    let limit = controller.command_limit();
    let clamp = |variable: &str| match limit.is_finite() {
        true => format!("clamped({variable}, {})", constant(limit)),
        false => variable.to_string(),
    };
    let mut text = String::new();
    if controller.anti_windup() == AntiWindup::Clamping {
        let _ = write!(
            text,
            "    for (index = 0; index < {sections}; index++) {{
        before[index][0] = state->feedback[index][0];
        before[index][1] = state->feedback[index][1];
    }}
"
        );
    }
    let last = sections - 1;
    let before_last = match last {
        0 => String::new(),
        _ => format!("{}, signal);\n    }}\n", through("feedback", last, "signal = filtered")),
    };
    let continued = match controller.anti_windup() {
        AntiWindup::BackCalculation => {
            "    if (!((command >= wanted) && (command <= wanted))) {
        continued = difference(command, beside);
    }
"
        }
        AntiWindup::None | AntiWindup::Clamping => "",
    };
    let _ = write!(
        text,
        "    signal = error;
{before_last}    output = sum(product(feedback_table[{last}][0], signal), state->feedback[{last}][0]);
    wanted = sum(output, beside);
    command = {};
    continued = output;
{continued}    advance(feedback_table[{last}], state->feedback[{last}], signal, continued);
",
        clamp("wanted")
    );
    if controller.anti_windup() == AntiWindup::Clamping {
        let _ = write!(
            text,
            "    if (!((command >= wanted) && (command <= wanted)) && (product(wanted, error) > 0.0)) {{
        for (index = 0; index < {sections}; index++) {{
            state->feedback[index][0] = before[index][0];
            state->feedback[index][1] = before[index][1];
        }}
    }}
"
        );
    }
    text
}
