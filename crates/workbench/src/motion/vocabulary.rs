//! The words of linear motion, and those of rotary motion in their place.

/// What makes a text for people speak of torques and angles: whole words and units are replaced,
/// and nothing within a text of the user.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Vocabulary {
    words: &'static [(&'static str, &'static str)],
    /// Texts of the user, the longest first.
    kept: Vec<String>,
}

/// Words and units, each as it stands between characters of other kinds; the longer before those
/// that they begin with.
static ROTARY: &[(&str, &str)] = &[
    ("F_e/(s X_L)", "T_e/(s Θ_L)"),
    ("F_e/U_C", "T_e/U_C"),
    ("F_e/F_ref", "T_e/T_ref"),
    ("F_ref", "T_ref"),
    ("F_x", "T_x"),
    ("F_e", "T_e"),
    ("F_H", "T_H"),
    ("K_H/M", "K_θ/J"),
    ("K_H", "K_θ"),
    ("x_L", "θ_L"),
    ("x_p", "θ"),
    ("MN/m", "MN.m/rad"),
    ("kN/mm", "MN.m/rad"),
    ("N/mm", "kN.m/rad"),
    ("N.s/m", "N.m.s/rad"),
    ("N·s/m", "N·m·s/rad"),
    ("N s/m", "N m s/rad"),
    ("N/(s.V)", "N.m/(s.V)"),
    ("N/m", "N.m/rad"),
    ("N/V", "N.m/V"),
    ("N/N", "N.m/(N.m)"),
    ("mV/N", "mV/(N.m)"),
    ("V/N", "V/(N.m)"),
    ("V/kN", "V/(kN.m)"),
    ("MN", "MN.m"),
    ("kN", "kN.m"),
    ("N", "N.m"),
    ("load cells", "torque sensors"),
    ("load cell", "torque sensor"),
    ("Load cell", "Torque sensor"),
    ("force sensor's", "torque sensor's"),
    ("force sensor", "torque sensor"),
    ("moving mass", "inertia"),
    ("Moving mass", "Inertia"),
    ("the piston on the torque sensor", "the shaft on the torque sensor"),
    ("mass of that oil", "mass of that oil"),
    // what a wrong unit measures
    ("found a force", "found a force"),
    ("found a mass", "found a mass"),
    ("spool position", "spool position"),
    ("position of the spool", "position of the spool"),
    ("forces", "torques"),
    ("Forces", "Torques"),
    ("force's", "torque's"),
    ("force", "torque"),
    ("Force", "Torque"),
    ("newtons", "newton metres"),
    ("newton", "newton metre"),
    ("piston area", "displacement"),
    ("Piston area", "Displacement"),
    ("extending", "forward"),
    ("retracting", "reverse"),
    ("pistons", "shafts"),
    ("piston's", "shaft's"),
    ("piston", "shaft"),
    ("Piston", "Shaft"),
    ("rods", "shafts"),
    ("rod's", "shaft's"),
    ("rod", "shaft"),
    ("cylinder's", "motor's"),
    ("cylinder", "motor"),
    ("Cylinder", "Motor"),
    ("positions", "angles"),
    ("position", "angle"),
    ("Position", "Angle"),
    ("masses", "inertias"),
    ("mass", "inertia"),
];

impl Vocabulary {
    /// That of a rig that turns. `kept` are texts of the user: names, titles, paths.
    pub(crate) fn rotary(mut kept: Vec<String>) -> Vocabulary {
        // a name that is one of these words is printed as that word
        kept.retain(|text| !text.is_empty() && !ROTARY.iter().any(|(linear, _)| linear == text));
        kept.sort_by_key(|text| std::cmp::Reverse(text.len()));
        Vocabulary { words: ROTARY, kept }
    }

    /// Whether it leaves every text as it is.
    pub(crate) fn is_plain(&self) -> bool {
        self.words.is_empty()
    }

    /// The text in these words. What stands in backticks or in brackets is a key, and stays.
    pub(crate) fn of(&self, text: &str) -> String {
        if self.is_plain() {
            return text.to_string();
        }
        let (mut out, mut at) = (String::with_capacity(text.len()), 0);
        while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
            let (taken, shown) = self.next(text, at, rest);
            out.push_str(shown);
            at += taken;
        }
        out
    }

    /// How many bytes come next as one, and what is shown for them.
    fn next<'t>(&self, text: &str, at: usize, rest: &'t str) -> (usize, &'t str) {
        let before = text[..at].chars().next_back();
        let is_own =
            |own: &&String| rest.strip_prefix(own.as_str()).is_some_and(|after| is_whole(before, after));
        if let Some(own) = self.kept.iter().find(is_own) {
            return (own.len(), &rest[..own.len()]);
        }
        for (opens, closes) in [('`', '`'), ('[', ']'), ('"', '"')] {
            let closed = rest.strip_prefix(opens).and_then(|inside| inside.find(closes));
            // an interval in brackets has units, a table has none
            let is_key = |length: &usize| {
                let name = rest.get(opens.len_utf8()..opens.len_utf8() + length).unwrap_or_default();
                opens != '[' || name.chars().all(|c| c.is_alphabetic() || matches!(c, '_' | '.' | '['))
            };
            if let Some(length) = closed.filter(is_key) {
                let whole = length + opens.len_utf8() + closes.len_utf8();
                return (whole, &rest[..whole]);
            }
        }
        let word = self
            .words
            .iter()
            .find(|(linear, _)| rest.strip_prefix(linear).is_some_and(|after| is_whole(before, after)));
        match word {
            Some((linear, rotary)) => (linear.len(), rotary),
            None => {
                let length = rest.chars().next().map_or(1, char::len_utf8);
                (length, &rest[..length])
            }
        }
    }
}

/// Whether what stands between this character and these is a word of its own.
fn is_whole(before: Option<char>, after: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '/' | '·');
    let mut letters = after.chars();
    let (first, second) = (letters.next(), letters.next());
    let is_path = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    // a full stop ends a sentence, and a dot before a letter is that of a path or of a unit
    let ends = match first {
        Some('.') => !is_path(second),
        Some(c) => !part_of_name(c),
        None => true,
    };
    ends && before.is_none_or(|c| !part_of_name(c) && c != '.')
}

#[cfg(test)]
mod tests {
    use super::Vocabulary;

    /// Whole words and units are replaced, not keys, texts of the user and those on a cylinder.
    #[test]
    fn a_text_speaks_of_torques() {
        let words = Vocabulary::rotary(vec!["force step".to_string()]);
        for (linear, rotary) in [
            ("the force comes to 12 N in `force_sensor`", "the torque comes to 12 N.m in `force_sensor`"),
            ("force step: the piston stalls", "force step: the shaft stalls"),
            ("[force_sensor] in [-2 kN, 5 kN]", "[force_sensor] in [-2 kN.m, 5 kN.m]"),
            ("K_H at its least, and Z = -F_e/(s X_L)", "K_θ at its least, and Z = -T_e/(s Θ_L)"),
        ] {
            assert_eq!(words.of(linear), rotary);
        }
        assert_eq!(Vocabulary::rotary(vec!["k".to_string()]).of("12 kN"), "12 kN.m");
        assert_eq!(Vocabulary::default().of("12 kN"), "12 kN");
    }
}
