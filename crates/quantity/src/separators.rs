//! Numbers with thousands separators, or with a decimal comma.

use super::error::{QuantityError, QuantityFault, QuantityHint};

/// Signs that occur between digits.
const SIGNS: [char; 8] = ['.', ',', '\'', '\u{2019}', '_', ' ', '\u{a0}', '\u{202f}'];

/// Number and the signs between its digits.
struct SeparatedNumber<'a> {
    /// Sign and digits before the first sign.
    first: &'a str,
    /// Each sign with the digits after it.
    groups: Vec<(char, &'a str)>,
    /// Position of the number in the text.
    start: usize,
    end: usize,
}

/// Rejects a number with signs that have more than one meaning: `20.000` is 20 in one country and
/// 20000 in another, an error that no other check detects. A point before exactly three digits that
/// end in zero counts as ambiguous; `1.234` and `0.870` do not.
///
/// # Errors
/// [`QuantityError`] with the possible readings.
pub(crate) fn refuse_thousands(text: &str) -> Result<(), QuantityError> {
    let found = SeparatedNumber::of(text);
    let rest = text.get(found.end..).unwrap_or_default();
    let Some(readings) = found.readings(rest) else { return Ok(()) };
    let written = text.get(found.start..found.end).unwrap_or_default();
    let has_comma = found.groups.iter().any(|(sign, _)| *sign == ',');
    let fault = match readings.as_slice() {
        [one, other] => QuantityFault::TwoReadings {
            written: written.to_string(),
            readings: Box::new([one.clone(), other.clone()]),
        },
        _ if has_comma => QuantityFault::Comma,
        _ => QuantityFault::SignBetweenDigits,
    };
    let written_out: Vec<String> = readings.iter().map(|number| format!("{number}{rest}")).collect();
    let help = match written_out.is_empty() {
        true => QuantityHint::NoSeparators,
        false => QuantityHint::WriteOneOf(written_out),
    };
    let range = match (readings.len(), written.find(',')) {
        (0 | 1, Some(comma)) => found.start + comma..found.start + comma + 1,
        _ => found.start..found.end,
    };
    Err(QuantityError::new(fault, range).help(help))
}

impl<'a> SeparatedNumber<'a> {
    fn of(text: &'a str) -> SeparatedNumber<'a> {
        let start = text.len() - text.trim_start().len();
        let signed = start + usize::from(text[start..].starts_with(['+', '-']));
        let digits = |from: usize| {
            let rest = text.get(from..).unwrap_or_default();
            from + rest.bytes().take_while(u8::is_ascii_digit).count()
        };
        let mut end = digits(signed);
        let first = &text[start..end];
        let mut groups = Vec::new();
        while let Some(sign) = text[end..].chars().next().filter(|sign| SIGNS.contains(sign)) {
            let from = end + sign.len_utf8();
            let to = digits(from);
            // a space may come before a unit that begins with 1
            if to == from || (sign.is_whitespace() && to - from != 3) {
                break;
            }
            groups.push((sign, &text[from..to]));
            end = to;
        }
        SeparatedNumber { first, groups, start, end }
    }

    /// Possible readings; `None` for a plain decimal.
    fn readings(&self, rest: &str) -> Option<Vec<String>> {
        let digits = self.first.trim_start_matches(['+', '-']);
        let is_led = (1..=3).contains(&digits.len()) && !digits.starts_with('0');
        let joined = |groups: &[(char, &str)]| {
            groups.iter().fold(self.first.to_string(), |all, (_, digits)| all + digits)
        };
        let decimal = |whole: String, fraction: &str| match fraction.trim_end_matches('0') {
            "" => whole,
            fraction => format!("{whole}.{fraction}"),
        };
        let are_thousands =
            |groups: &[(char, &str)]| is_led && groups.iter().all(|(_, group)| group.len() == 3);
        match self.groups.as_slice() {
            [] => None,
            [('.', fraction)] => {
                let is_power = rest.starts_with(['e', 'E']);
                let is_open = are_thousands(&self.groups) && fraction.ends_with('0') && !is_power;
                is_open.then(|| vec![decimal(self.first.to_string(), fraction), joined(&self.groups)])
            }
            [(',', fraction)] if are_thousands(&self.groups) => {
                Some(vec![decimal(self.first.to_string(), fraction), joined(&self.groups)])
            }
            [(',', fraction)] => Some(vec![decimal(self.first.to_string(), fraction)]),
            [before @ .., (sign, fraction)] => {
                let other = before.first().map_or(*sign, |(other, _)| *other);
                let is_one_kind = before.iter().all(|(one, _)| *one == other);
                if *sign == other && is_one_kind {
                    return Some(
                        are_thousands(&self.groups).then(|| joined(&self.groups)).into_iter().collect(),
                    );
                }
                let is_decimal = matches!(sign, '.' | ',') && is_one_kind && are_thousands(before);
                Some(is_decimal.then(|| decimal(joined(before), fraction)).into_iter().collect())
            }
        }
    }
}
