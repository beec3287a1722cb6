//! Symbols and equations of a cylinder, and their counterparts for a motor.

use std::borrow::Cow;

/// Symbols and their combinations, each delimited by characters of other kinds; a longer one
/// precedes its own beginnings. A motor has one displacement for both areas.
static OF_A_MOTOR: [(&str, &str); 30] = [
    ("A_u (A_A K_{qA}/C_A + A_B K_{qB}/C_B)", "D^2 (K_{qA}/C_A + K_{qB}/C_B)"),
    ("A_u^2/K_c = A_A^2/K_{cA} + A_B^2/K_{cB}", "1/K_c = 1/K_{cA} + 1/K_{cB}"),
    ("A_A^2/C_A + A_B^2/C_B", "D^2 (1/C_A + 1/C_B)"),
    ("A_A p_A - A_B p_B", "D (p_A - p_B)"),
    ("A_A p_S - A_B p_T", "D (p_S - p_T)"),
    ("dK_H/dx", "dK_θ/dθ"),
    ("dF_e/dt", "dT_e/dt"),
    ("A_A", "D"),
    ("A_B", "D"),
    ("A_u", "D"),
    ("K_H", "K_θ"),
    ("K_{Hmin}", "K_{θmin}"),
    ("F_{max}", "T_{max}"),
    ("F_{min}", "T_{min}"),
    ("F_{ref}", "T_{ref}"),
    ("F_ref", "T_ref"),
    ("F_max", "T_max"),
    ("F_min", "T_min"),
    ("F_e", "T_e"),
    ("F_H", "T_H"),
    ("F_S", "T_S"),
    ("F_C", "T_C"),
    ("X_L", "Θ_L"),
    ("x_L", "θ_L"),
    ("x_p", "θ"),
    ("v_{max}", "ω_{max}"),
    ("v_max", "ω_max"),
    ("x", "θ"),
    ("v", "ω"),
    ("M", "J"),
];

/// Formula in the symbols of a motor.
pub(super) fn of_a_motor(formula: &str) -> Cow<'_, str> {
    let (mut out, mut at) = (String::with_capacity(formula.len()), 0);
    while let Some(rest) = formula.get(at..).filter(|rest| !rest.is_empty()) {
        let before = formula[..at].chars().next_back();
        let found = OF_A_MOTOR.iter().filter(|_| !before.is_some_and(is_of_symbol)).find(|(linear, _)| {
            rest.strip_prefix(linear).is_some_and(|after| !after.starts_with(is_of_symbol))
        });
        match (found, rest.chars().next()) {
            (Some((linear, rotary)), _) => {
                out.push_str(rotary);
                at += linear.len();
            }
            (None, Some(letter)) => {
                out.push(letter);
                at += letter.len_utf8();
            }
            (None, None) => break,
        }
    }
    if out == formula { Cow::Borrowed(formula) } else { Cow::Owned(out) }
}

/// True if a character belongs to the adjacent symbol.
fn is_of_symbol(letter: char) -> bool {
    letter.is_alphanumeric() || matches!(letter, '_' | '{' | '}' | '\'')
}
