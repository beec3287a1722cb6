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

/// The arithmetic: each operation rounds once, whatever the compiler would fuse.
pub(super) const ARITHMETIC: &str = "#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && (__FINITE_MATH_ONLY__ != 0))
#error \"compile without -ffast-math: its results are not those that were verified\"
#endif
#include <float.h>
#if DBL_MANT_DIG != 53
#error \"a double of this compiler has not 53 bits: its results are not those that were verified\"
#endif
/* 0 and 1: doubles as they are; 16 to 64: likewise, with shorter types beside them */
#if (FLT_EVAL_METHOD < 0) || (FLT_EVAL_METHOD == 2) || (FLT_EVAL_METHOD > 64)
#error \"this compiler computes with more digits than a double has: its results are not those that were verified\"
#endif

";
