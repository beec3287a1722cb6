//! Names for programs, and SI units.

use std::borrow::Cow;

/// SI units of linear motion, and their rotary counterparts.
static SYMBOLS: [(&str, &str); 10] = [
    ("N", "N.m"),
    ("m", "rad"),
    ("m/s", "rad/s"),
    ("kg", "kg.m2"),
    ("N/m", "N.m/rad"),
    ("N.s/m", "N.m.s/rad"),
    ("N/V", "N.m/V"),
    ("N/(s.V)", "N.m/(s.V)"),
    ("V/N", "V/(N.m)"),
    ("m2", "m3/rad"),
];

/// Endings of names that state a unit; a longer one precedes its own endings.
static ENDINGS: [(&str, &str); 8] = [
    ("_v_per_n", "_v_per_n_m"),
    ("_n_s_per_m", "_n_m_s_per_rad"),
    ("_n_per_m", "_n_m_per_rad"),
    ("_n_per_v", "_n_m_per_v"),
    ("_m_per_s", "_rad_per_s"),
    ("_kg", "_kg_m2"),
    ("_n", "_n_m"),
    ("_m", "_rad"),
];

/// Words in such names.
static WORDS: [(&str, &str); 4] =
    [("force", "torque"), ("position", "angle"), ("distance", "angle"), ("mass", "inertia")];

/// Beginnings of the names of lengths, speeds and masses that belong to oil, hoses, pipes and
/// housings, for either motion.
static OF_OIL: [&str; 12] = [
    "actuator_length",
    "bore",
    "length",
    "hose",
    "line_",
    "lines_",
    "oil",
    "wave_",
    "sized_length",
    "diameter",
    "wall_",
    "parts_",
];

pub(super) fn symbol(of: &'static str) -> &'static str {
    SYMBOLS.iter().find(|(linear, _)| *linear == of).map_or(of, |(_, rotary)| rotary)
}

pub(super) fn name(of: &str) -> Cow<'_, str> {
    // a reason follows the name of the value that it explains
    let (bare, reason) = of.strip_suffix("_reason").map_or((of, ""), |bare| (bare, "_reason"));
    let is_of_oil = OF_OIL.iter().any(|beginning| of.starts_with(beginning));
    let ending = ENDINGS.iter().filter(|_| !is_of_oil).find_map(|(linear, rotary)| {
        Some((bare.strip_suffix(linear).filter(|stem| !stem.is_empty())?, rotary))
    });
    let Some((stem, ending)) = ending else { return Cow::Borrowed(of) };
    let turned = |word| WORDS.iter().find(|(linear, _)| *linear == word).map_or(word, |(_, rotary)| *rotary);
    let words: Vec<&str> = stem.split('_').map(turned).collect();
    Cow::Owned(format!("{}{ending}{reason}", words.join("_")))
}
