//! The word that was probably meant. It knows spelling alone.

/// The candidate that differs least from a word, if it differs little: by a letter missing, added,
/// changed, or two swapped; by two of these in words of five letters and more. The first of equals.
pub fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.len() > MAX_WORD {
        return None;
    }
    let allowed = if word.len() < 5 { 1 } else { 2 };
    let by_distance = candidates.into_iter().filter(|candidate| candidate.len() <= MAX_WORD);
    let (distance, candidate) = by_distance
        .map(|candidate| (distance(word.as_bytes(), candidate.as_bytes()), candidate))
        .min_by_key(|(distance, _)| *distance)?;
    // A word of one or two letters resembles every other.
    let is_alike = distance <= allowed && distance < word.len();
    is_alike.then_some(candidate)
}

/// Longer words are not compared.
const MAX_WORD: usize = 64;

/// The number of edits between two words, a swap of neighbours counting as one; the case of letters
/// does not count.
fn distance(left: &[u8], right: &[u8]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in right.iter().enumerate() {
            let changed = usize::from(!a.eq_ignore_ascii_case(b));
            let mut least = (above[j] + changed).min(above[j + 1] + 1).min(row[j] + 1);
            let is_swap = i > 0 && j > 0 && left[i - 1] == *b && right[j - 1] == *a;
            if is_swap && changed == 1 {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut above, row);
    }
    above.last().copied().unwrap_or(left.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_found_and_a_stranger_is_not() {
        let words = ["while", "wait", "else", "times", "mm"];
        assert_eq!(nearest("esle", words), Some("else"));
        assert_eq!(nearest("whille", words), Some("while"));
        assert_eq!(nearest("tiems", words), Some("times"));
        assert_eq!(nearest("mmm", words), Some("mm"));
        assert_eq!(nearest("Wait", words), Some("wait"));
        assert_eq!(nearest("gripper", words), None);
        assert_eq!(nearest("x", words), None);
        assert_eq!(nearest("", words), None);
    }

    #[test]
    fn distances_are_those_of_edits() {
        assert_eq!(distance(b"abc", b"abc"), 0);
        assert_eq!(distance(b"abc", b"acb"), 1);
        assert_eq!(distance(b"", b"abc"), 3);
        assert_eq!(distance(b"kitten", b"sitting"), 3);
    }
}
