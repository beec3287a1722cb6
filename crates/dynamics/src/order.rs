//! Sorting of lists by numbers.
//!
//! The standard library compiles a sort anew for every closure that compares. Here all lists are
//! sorted by numbers, and numbers are sorted in one place.

/// Sorts items by a number, the least first; items with equal numbers stay in order.
///
/// Numbers compare by [`f64::total_cmp`], so that a negated number reverses it exactly. The number
/// of each item is computed once.
///
/// # Example
/// ```
/// use phea_dynamics::order::sort_by_number;
///
/// let mut modes = [("slow", 2.0), ("fast", 80.0), ("also slow", 2.0)];
/// sort_by_number(&mut modes, |mode| -mode.1);
/// assert_eq!(modes.map(|mode| mode.0), ["fast", "slow", "also slow"]);
/// ```
pub fn sort_by_number<T>(items: &mut [T], number: impl FnMut(&T) -> f64) {
    if items.len() < 2 {
        return;
    }
    for (one, other) in exchanges(items.iter().map(number).collect()) {
        items.swap(one, other);
    }
}

/// Pairs of positions; exchanging the items of one pair after another puts them in the order of
/// these numbers.
fn exchanges(numbers: Vec<f64>) -> Vec<(usize, usize)> {
    let mut order: Vec<(f64, usize)> = numbers.into_iter().zip(0..).collect();
    order.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut from: Vec<usize> = order.into_iter().map(|(_, place)| place).collect();
    let mut pairs = Vec::new();
    for first in 0..from.len() {
        let mut place = first;
        while from[place] != first {
            let next = std::mem::replace(&mut from[place], place);
            pairs.push((place, next));
            place = next;
        }
        from[place] = place;
    }
    pairs
}

/// Sorts numbers, the least first.
///
/// # Example
/// ```
/// use phea_dynamics::order::sort_numbers;
///
/// let mut numbers = [3.0, -f64::INFINITY, 1.0];
/// sort_numbers(&mut numbers);
/// assert_eq!(numbers, [-f64::INFINITY, 1.0, 3.0]);
/// ```
pub fn sort_numbers(numbers: &mut [f64]) {
    numbers.sort_by(f64::total_cmp);
}

/// Median of some numbers, the upper one for an even count; NaN if there are none.
///
/// # Example
/// ```
/// use phea_dynamics::order::median;
///
/// assert_eq!(median(vec![5.0, -1.0, 2.0]), 2.0);
/// assert!(median(vec![]).is_nan());
/// ```
pub fn median(mut numbers: Vec<f64>) -> f64 {
    sort_numbers(&mut numbers);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Least and greatest of numbers, NaN ignored; infinity and minus infinity if there are none.
///
/// # Example
/// ```
/// use phea_dynamics::order::ends;
///
/// assert_eq!(ends([2.0, f64::NAN, -1.0]), [-1.0, 2.0]);
/// assert_eq!(ends([]), [f64::INFINITY, f64::NEG_INFINITY]);
/// ```
pub fn ends(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    numbers.into_iter().fold(none, |[least, most], number| [least.min(number), most.max(number)])
}

/// Distinct numbers, the least first.
///
/// # Example
/// ```
/// use phea_dynamics::order::sorted_distinct;
///
/// assert_eq!(sorted_distinct(vec![3.0, 1.0, 3.0]), [1.0, 3.0]);
/// ```
#[must_use]
pub fn sorted_distinct(mut numbers: Vec<f64>) -> Vec<f64> {
    sort_numbers(&mut numbers);
    numbers.dedup();
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::uniform;

    #[test]
    fn items_lie_as_the_stable_sort_lays_them() {
        let mut state = 7;
        for count in 0..200 {
            let special = [0.0, -0.0, f64::NAN, -f64::NAN, f64::INFINITY, -f64::INFINITY, 1.0, -1.0];
            let drawn = |_| {
                let chosen = special.get((uniform(&mut state) * 12.0) as usize);
                chosen.copied().unwrap_or_else(|| uniform(&mut state))
            };
            let items: Vec<(f64, usize)> = (0..count).map(drawn).zip(0..).collect();
            let bits = |items: &[(f64, usize)]| -> Vec<(u64, usize)> {
                items.iter().map(|item| (item.0.to_bits(), item.1)).collect()
            };
            let (mut up, mut down) = (items.clone(), items.clone());
            sort_by_number(&mut up, |item| item.0);
            sort_by_number(&mut down, |item| -item.0);
            let (mut stable_up, mut stable_down) = (items.clone(), items);
            stable_up.sort_by(|one, other| one.0.total_cmp(&other.0));
            stable_down.sort_by(|one, other| other.0.total_cmp(&one.0));
            assert_eq!((bits(&up), bits(&down)), (bits(&stable_up), bits(&stable_down)));
        }
    }
}
