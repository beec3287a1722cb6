//! Self test of the controller on its target, and an example of its use.

use std::fmt::Write;

use phea_machine::Deployed;

use super::number::constant;
use crate::export::{DeployedSignal, TestVector, VectorOperation};

/// A number as a constant; infinity and no number by division.
fn number(value: f64) -> String {
    match value {
        value if value.is_nan() => "NOT_A_NUMBER".to_string(),
        value if value.is_infinite() => "INFINITE".to_string(),
        value => constant(value),
    }
}

/// Rows of the table of test vectors.
fn rows(deployed: &Deployed, vectors: &[TestVector]) -> String {
    let signals = DeployedSignal::of(deployed);
    let mut rows = String::new();
    for vector in vectors {
        let operation = match vector.operation {
            VectorOperation::Step => 0,
            VectorOperation::ResetAndStep => 1,
            VectorOperation::HoldAndStep => 2,
        };
        let values: Vec<String> =
            signals.iter().map(|signal| number(signal.value(&vector.signals))).collect();
        let executed = &vector.executed;
        let _ = writeln!(
            rows,
            "    {{{operation}, {{{}}}, {}, {}, {}, {}, {}}},",
            values.join(", "),
            number(vector.held_v),
            number(executed.command_v),
            number(executed.output.wanted),
            u8::from(executed.output.limited),
            u8::from(!executed.is_valid),
        );
    }
    rows
}

/// The self test with its vectors.
pub(super) fn source(deployed: &Deployed, name: &str, vectors: &[TestVector]) -> String {
    let (types, rows) = (types(name, vectors.len()), rows(deployed, vectors));
    format!(
        "{types}
int {name}_self_test(unsigned long long *units) {{
    static const test_vector vectors[VECTORS] = {{
{rows}    }};
    {name}_state state;
    {name}_output output;
    unsigned long long distance;
    int differing = 0;
    int index;
    *units = 0ULL;
    {name}_reset(&state);
    for (index = 0; index < VECTORS; index++) {{
        const test_vector *expected = &vectors[index];
        if (expected->operation == 1) {{
            {name}_reset(&state);
        }}
        if (expected->operation == 2) {{
            {name}_hold(&state, &expected->signals, expected->held);
        }}
        output = {name}_step(&state, &expected->signals);
        distance = apart(output.command, expected->command);
        if (distance < apart(output.unlimited, expected->unlimited)) {{
            distance = apart(output.unlimited, expected->unlimited);
        }}
        if (distance > *units) {{
            *units = distance;
        }}
        if ((distance > 0ULL) || (output.limited != expected->limited) || (output.invalid != expected->invalid)) {{
            differing = differing + 1;
        }}
    }}
    return differing;
}}
"
    )
}

/// Types of the self test, and the difference of two numbers.
fn types(name: &str, vectors: usize) -> String {
    format!(
        "#include \"{name}.h\"

#define VECTORS {vectors}
/* No finite numbers, without a library. */
#define INFINITE (1e300 * 1e300)
#define NOT_A_NUMBER (INFINITE - INFINITE)

/* One sample: 0 a step, 1 a step after a reset, 2 a step after holding a command. */
typedef struct {{
    int operation;
    {name}_signals signals;
    double held;
    double command;
    double unlimited;
    int limited;
    int invalid;
}} test_vector;

/* Bits of a number. */
typedef union {{
    double value;
    unsigned long long bits;
}} number_bits;

/* Difference of two numbers in units in the last place. */
static unsigned long long apart(double one, double other) {{
    number_bits first;
    number_bits second;
    unsigned long long sign = 1ULL << 63;
    first.value = one;
    second.value = other;
    first.bits = ((first.bits & sign) != 0ULL) ? (sign - (first.bits & ~sign)) : (sign + first.bits);
    second.bits = ((second.bits & sign) != 0ULL) ? (sign - (second.bits & ~sign)) : (sign + second.bits);
    return (first.bits > second.bits) ? (first.bits - second.bits) : (second.bits - first.bits);
}}
"
    )
}

/// A program that runs the self test.
pub(super) fn example(name: &str) -> String {
    format!(
        "#include \"{name}.h\"

#include <stdio.h>

/* Runs the test vectors on this machine; a controller in use calls {name}_step once per sample. */
int main(void) {{
    unsigned long long units;
    int differing = {name}_self_test(&units);
    printf(\"%d outputs differ, by at most %llu units in the last place\\n\", differing, units);
    return differing == 0 ? 0 : 1;
}}
"
    )
}
