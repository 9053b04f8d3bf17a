//! Guesses what a misspelt word was meant to be.

/// The candidate within a third of the word's length in edits (insert, delete, replace), the nearest first; ties go to
/// the alphabet, so that a message does not depend on the order of the candidates.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = word.chars().count();
    // Long words are data, not slips of the keyboard, and cost the square of their length.
    if length > 64 {
        return None;
    }
    candidates
        .filter(|candidate| candidate.len() <= 3 * length + 3)
        .map(|candidate| (edits(word, candidate), candidate))
        .filter(|&(distance, _)| distance <= (length / 3).max(1))
        .min()
        .map(|(_, candidate)| candidate)
}

/// Levenshtein's distance.
fn edits(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (line, letter) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = line + 1;
        for (column, other) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[column + 1];
            row[column + 1] = replaced.min(diagonal + 1).min(row[column] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("abc", "abc"), 0);
    }

    #[test]
    fn slips_are_recognised_and_strangers_are_not() {
        let known = ["plastic", "metal", "plasfunc"];
        assert_eq!(nearest("plastik", known.into_iter()), Some("plastic"));
        assert_eq!(nearest("wood", known.into_iter()), None);
    }
}
