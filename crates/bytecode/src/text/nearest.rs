//! The name that was probably meant. It knows spelling alone.

/// Longer names are not compared, nor are more than so many.
const MAX_NAME: usize = 64;
const MAX_CANDIDATES: usize = 1024;

/// The candidate with the fewest letters added, left out or changed, if they are few; of equals the
/// first.
#[must_use]
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let allowed = name.len().div_ceil(4).min(3);
    candidates
        .into_iter()
        .take(MAX_CANDIDATES)
        .filter(|candidate| name.len() <= MAX_NAME && candidate.len() <= MAX_NAME)
        .map(|candidate| (distance(name.as_bytes(), candidate.as_bytes()), candidate))
        .filter(|(distance, _)| *distance <= allowed && *distance < name.len())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn distance(left: &[u8], right: &[u8]) -> usize {
    let mut above: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in right.iter().enumerate() {
            let changed = above[j] + usize::from(a != b);
            row.push(changed.min(above[j + 1] + 1).min(row[j] + 1));
        }
        above = row;
    }
    above.last().copied().unwrap_or(left.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_found_and_a_stranger_is_not() {
        let names = ["push.int", "push.item", "halt", "x"];
        assert_eq!(nearest("pus.int", names), Some("push.int"));
        assert_eq!(nearest("push.intt", names), Some("push.int"));
        assert_eq!(nearest("hlat", names), None);
        assert_eq!(nearest("hal", names), Some("halt"));
        assert_eq!(nearest("y", names), None);
        assert_eq!(nearest("", names), None);
        assert_eq!(nearest("gripper", names), None);
    }

    #[test]
    fn long_names_are_not_compared() {
        let (longest, longer) = ("x".repeat(64), "x".repeat(65));
        let (a, b) = (longest.as_str(), longer.as_str());
        assert_eq!(nearest(&longest[1..], [a]), Some(a));
        assert_eq!(nearest(a, [&longest[1..]]), Some(&longest[1..]));
        assert_eq!((nearest(a, [b]), nearest(b, [a])), (None, None));
    }

    #[test]
    fn distances_are_those_of_edits() {
        assert_eq!(distance(b"kitten", b"sitting"), 3);
        assert_eq!(distance(b"", b"abc"), 3);
        assert_eq!(distance(b"abc", b""), 3);
        assert_eq!(distance(b"abc", b"abc"), 0);
        assert_eq!(distance(b"abc", b"xabc"), 1);
        assert_eq!(distance(b"abc", b"abcxy"), 2);
        assert_eq!(distance(b"xabc", b"abc"), 1);
        assert_eq!(distance(b"abcxy", b"abc"), 2);
    }
}
