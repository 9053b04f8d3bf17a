//! Names of objects as people write them: `*` stands for any characters, `?` for one.

/// Whether the whole of `name` fits `pattern`. Time follows the product of their lengths at worst.
#[must_use]
pub fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    // Where the last `*` stands, and how much of the name it takes so far: only the last can have been too short.
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&wanted) if wanted == '?' || wanted == name[n] => {
                p += 1;
                n += 1;
            }
            _ => {
                let Some((at, taken)) = star else { return false };
                star = Some((at, taken + 1));
                p = at + 1;
                n = taken + 1;
            }
        }
    }
    pattern[p..].iter().all(|&rest| rest == '*')
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stars_and_question_marks() {
        for (pattern, name, fits) in [
            ("exit_sign", "exit_sign", true),
            ("exit_sign", "exit_sign.1", false),
            ("exit_sign.*", "exit_sign.1.face", true),
            ("*", "", true),
            ("?", "", false),
            ("*sign*", "hydrant_sign.2", true),
            ("a*b*c", "axxbyybzzc", true),
            ("a*b*c", "axxbyybzz", false),
            ("l?mp.?", "lamp.2", true),
            ("**", "x", true),
            ("\u{e9}?", "\u{e9}\u{e9}", true),
        ] {
            assert_eq!(matches(pattern, name), fits, "{pattern} {name}");
        }
    }

    /// The definition, by recursion.
    fn defined(pattern: &[char], name: &[char]) -> bool {
        match pattern.split_first() {
            None => name.is_empty(),
            Some(('*', rest)) => (0..=name.len()).any(|taken| defined(rest, &name[taken..])),
            Some((wanted, rest)) => {
                name.first().is_some_and(|first| *wanted == '?' || first == wanted) && defined(rest, &name[1..])
            }
        }
    }

    proptest! {
        #[test]
        fn equals_the_definition(pattern in "[ab?*]{0,8}", name in "[ab]{0,10}") {
            let (p, n): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
            prop_assert_eq!(matches(&pattern, &name), defined(&p, &n));
        }
    }
}
