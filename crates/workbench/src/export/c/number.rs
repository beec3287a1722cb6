//! Numbers of a program in C.

/// A number as a hexadecimal constant of C99, which every compiler reads to the same bits.
pub(super) fn constant(value: f64) -> String {
    let bits = value.to_bits();
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    match (exponent, fraction) {
        (0, 0) => format!("{sign}0.0"),
        (0, _) => format!("{sign}0x0.{fraction:013x}p-1022"),
        _ => format!("{sign}0x1.{fraction:013x}p{}", exponent as i64 - 1023),
    }
}

/// Numbers in braces.
pub(super) fn braces(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| constant(*value)).collect();
    format!("{{{}}}", values.join(", "))
}
