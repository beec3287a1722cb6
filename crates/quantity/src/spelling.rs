//! Nearest valid name for a misspelt one.

/// Most likely candidate for a misspelt name, or none if every one is too different.
///
/// A name that differs only in case wins; otherwise the fewest insertions, deletions, substitutions
/// and swaps of neighbours, at most a third of the name's length (one for two or three characters,
/// two from four on). Ties go to the earlier one. A synonym of a candidate selects it. If none is
/// near, the shortest candidate that begins with all words of the name is returned.
///
/// # Example
/// ```
/// use phea_quantity::spelling::nearest;
/// assert_eq!(nearest("presure", ["flow", "pressure"]), Some("pressure"));
/// assert_eq!(nearest("BAR", ["mbar", "bar"]), Some("bar"));
/// assert_eq!(nearest("gaussian", ["uniform", "normal"]), Some("normal"));
/// assert_eq!(nearest("temperature", ["flow", "pressure"]), None);
/// assert_eq!(nearest("settling", ["settling_band_percent", "settling_time"]), Some("settling_time"));
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: Vec<char> = name.chars().take(MAXIMUM_LENGTH).flat_map(char::to_lowercase).collect();
    let allowed = match wanted.len() {
        0 | 1 => 0,
        2 | 3 => 1,
        length => (length / 3).max(2),
    };
    let mut best: Option<(usize, &str)> = None;
    let mut begun: Option<&str> = None;
    let lowered: String = wanted.iter().collect();
    for candidate in candidates.into_iter().take(MAXIMUM_CANDIDATES) {
        if OTHER_WORDS.contains(&(lowered.as_str(), candidate)) {
            return Some(candidate);
        }
        let is_begun = candidate.strip_prefix(name).is_some_and(|rest| rest.starts_with('_'));
        if is_begun && allowed > 1 && begun.is_none_or(|known| candidate.len() < known.len()) {
            begun = Some(candidate);
        }
        let letters: Vec<char> = candidate.chars().flat_map(char::to_lowercase).collect();
        if letters.len().abs_diff(wanted.len()) > allowed {
            continue;
        }
        let distance = distance(&wanted, &letters);
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate).or(begun)
}

/// Synonyms of names.
const OTHER_WORDS: [(&str, &str); 2] = [("gauss", "normal"), ("gaussian", "normal")];

/// Largest number of candidates that are compared.
const MAXIMUM_CANDIDATES: usize = 1000;
/// Length up to which names are compared; only the beginning of longer ones counts.
const MAXIMUM_LENGTH: usize = 64;

/// Optimal string alignment distance.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for (i, &from) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, &to) in b.iter().enumerate() {
            let substituted = previous[j] + usize::from(from != to);
            let mut least = substituted.min(previous[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && from == b[j - 1] && a[i - 1] == to {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut previous, row);
    }
    previous.last().copied().unwrap_or(0)
}
