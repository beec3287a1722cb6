//! Equation numbers of the thesis in the form in which comments cite them: "thesis (6.20)", "thesis
//! 6.1 to 6.4", "Ledezma (2019), equation 6.12".

/// Chapter and number.
pub(super) type Equation = (u32, u32);

const MARKS: [&str; 2] = ["thesis", "Ledezma (2019)"];

/// Words and signs that are allowed between the mark and the numbers, or between numbers.
const BETWEEN: [&str; 12] =
    ["equations", "equation", "'s", "'", "(", ")", ",", "and", "or", "both", "corrected", " "];

/// Equations that a line cites, with ranges expanded.
pub(super) fn cited(line: &str) -> Vec<Equation> {
    let after =
        |mark: &&str| line.match_indices(*mark).map(|(start, found)| start + found.len()).collect::<Vec<_>>();
    MARKS.iter().flat_map(after).flat_map(|start| numbers(&line[start..])).collect()
}

/// The equation numbers at the beginning of a text; `6.1 to 6.4` and `6.1-6.4` are ranges.
pub(super) fn numbers(text: &str) -> Vec<Equation> {
    let mut rest = text;
    let mut found: Vec<Equation> = Vec::new();
    let mut range = false;
    loop {
        let range_mark = rest.strip_prefix("to").or(rest.strip_prefix('-')).filter(|_| !found.is_empty());
        if let Some(((chapter, last), next)) = leading_equation(rest) {
            let before = found.last().filter(|before| range && before.0 == chapter);
            let first = before.map_or(last, |before| before.1 + 1);
            found.extend((first..=last).map(|number| (chapter, number)));
            (rest, range) = (next, false);
        } else if let Some(next) = range_mark {
            (rest, range) = (next, true);
        } else if let Some(next) = BETWEEN.iter().find_map(|word| rest.strip_prefix(word)) {
            rest = next;
        } else {
            return found;
        }
    }
}

/// `6.12`, but neither `6.12.1`, `6.5e3`, `12.7` nor `6.333`.
fn leading_equation(text: &str) -> Option<(Equation, &str)> {
    let (chapter, rest) = text.split_once('.')?;
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (number, next) = rest.split_at(digits);
    let goes_on = next.strip_prefix('.').is_some_and(|more| more.starts_with(|c: char| c.is_ascii_digit()));
    let is_longer = goes_on || next.starts_with(|c: char| c.is_alphabetic()) || digits > 2;
    let chapter = chapter.parse().ok().filter(|chapter| (3..=6).contains(chapter) && !is_longer)?;
    Some(((chapter, number.parse().ok()?), next))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_numbers_lists_and_ranges() {
        assert_eq!(cited("    dp/dt = ...          thesis (6.20), Merritt (1967)"), [(6, 20)]);
        assert_eq!(cited("/// thesis (4.27), (4.28)"), [(4, 27), (4, 28)]);
        assert_eq!(cited("thesis (6.21) to (6.24)"), [(6, 21), (6, 22), (6, 23), (6, 24)]);
        assert_eq!(cited("Ledezma (2019), equations 6.18 and 6.19."), [(6, 18), (6, 19)]);
        assert_eq!(cited("the thesis' 4.30, corrected: thesis 4.31"), [(4, 30), (4, 31)]);
    }

    #[test]
    fn tables_figures_sections_and_plain_numbers_are_no_equations() {
        let texts = "thesis Table 6.2; the thesis' 2.24e6; thesis section 6.4.1; thesis: 6.5 mm; thesis 12.7";
        assert_eq!(texts.split("; ").flat_map(cited).collect::<Vec<_>>(), []);
        assert_eq!(cited("thesis 6.4.1"), []);
    }
}
