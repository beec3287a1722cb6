//! Groups items by equal keys.

/// Items by their keys, both in the order of first sight.
pub(crate) fn grouped<Key: PartialEq, Item>(
    all: impl IntoIterator<Item = (Key, Item)>,
) -> Vec<(Key, Vec<Item>)> {
    let mut groups: Vec<(Key, Vec<Item>)> = Vec::new();
    for (key, item) in all {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, items)) => items.push(item),
            None => groups.push((key, vec![item])),
        }
    }
    groups
}
