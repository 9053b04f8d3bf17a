//! Transforms as xform(1) writes them: `-t -rx -ry -rz -s -mx -my -mz -i`, applied from left to right.

use glam::{DAffine3, DMat3, DVec3};

use super::number::{integer, real};

/// A transform that keeps shapes: translations, rotations, mirrors, uniform scaling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Maps a point of the object to the scene.
    pub affine: DAffine3,
    /// By what lengths are multiplied; negative if the transform mirrors.
    pub scale: f64,
}

/// What is wrong with a transform's words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadTransform {
    /// Which of the words; past the last if one is missing.
    pub word: usize,
    /// What was expected.
    pub message: String,
}

impl Transform {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self { affine: DAffine3::IDENTITY, scale: 1.0 };

    /// Reads transform options from the front of `words`, up to the first word that is none; gives how many words they
    /// take.
    ///
    /// # Errors
    /// An option whose values are missing or no finite numbers, or a scaling by 0.
    pub fn take<S: AsRef<str>>(words: &[S]) -> Result<(Self, usize), BadTransform> {
        let mut total = Self::IDENTITY;
        let (mut step, mut times) = (Self::IDENTITY, 1);
        let mut next = 0;
        while let Some(option) = words.get(next).map(S::as_ref).filter(|word| is_option(word)) {
            let values = &words[next + 1..];
            let at = next;
            let bad = |(word, message): (usize, String)| BadTransform { word: at + word, message };
            next += 1;
            let then = match option {
                "-t" => {
                    let [x, y, z] = reals(option, values).map_err(bad)?;
                    next += 3;
                    Self { affine: DAffine3::from_translation(DVec3::new(x, y, z)), scale: 1.0 }
                }
                "-rx" | "-ry" | "-rz" => {
                    let [degrees] = reals(option, values).map_err(bad)?;
                    next += 1;
                    Self { affine: DAffine3::from_mat3(rotation(option, degrees)), scale: 1.0 }
                }
                "-s" => {
                    let [factor] = reals(option, values).map_err(bad)?;
                    if factor == 0.0 {
                        return Err(bad((1, "`-s` by 0 leaves nothing".to_owned())));
                    }
                    next += 1;
                    Self { affine: DAffine3::from_scale(DVec3::splat(factor)), scale: factor }
                }
                "-i" => {
                    let count = values.first().map(S::as_ref).map(integer);
                    let Some(Ok(count)) = count else {
                        return Err(bad((1, "`-i` wants how often the transform after it is repeated".to_owned())));
                    };
                    next += 1;
                    total = total.then(&step.power(times));
                    (step, times) = (Self::IDENTITY, count);
                    continue;
                }
                _ => Self { affine: DAffine3::from_scale(mirror(option)), scale: -1.0 },
            };
            step = step.then(&then);
        }
        Ok((total.then(&step.power(times)), next))
    }

    /// This transform, then another.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self { affine: next.affine * self.affine, scale: self.scale * next.scale }
    }

    /// Repeated; not at all for a count below 1.
    fn power(&self, times: i64) -> Self {
        let (mut total, mut square, mut left) = (Self::IDENTITY, *self, times.max(0));
        while left > 0 {
            if left & 1 == 1 {
                total = total.then(&square);
            }
            left >>= 1;
            if left > 0 {
                square = square.then(&square);
            }
        }
        total
    }

    /// The transform that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { affine: self.affine.inverse(), scale: 1.0 / self.scale }
    }
}

/// Whether a word starts a transform option (a number like `-1` does not).
pub(super) fn is_option(word: &str) -> bool {
    matches!(word, "-t" | "-rx" | "-ry" | "-rz" | "-s" | "-mx" | "-my" | "-mz" | "-i")
}

fn mirror(option: &str) -> DVec3 {
    match option {
        "-mx" => DVec3::new(-1.0, 1.0, 1.0),
        "-my" => DVec3::new(1.0, -1.0, 1.0),
        _ => DVec3::new(1.0, 1.0, -1.0),
    }
}

/// Counter-clockwise about an axis that points at the observer. Quarter turns are exact: no 6e-17 where 0 is meant.
fn rotation(option: &str, degrees: f64) -> DMat3 {
    let (sin, cos) = match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        turn => turn.to_radians().sin_cos(),
    };
    // Columns: where the axes go.
    let (x, y, z) = match option {
        "-rx" => (DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos)),
        "-ry" => (DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos)),
        _ => (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z),
    };
    DMat3::from_cols(x, y, z)
}

/// The numbers after an option; errors give the word's place relative to the option's.
fn reals<const N: usize, S: AsRef<str>>(option: &str, words: &[S]) -> Result<[f64; N], (usize, String)> {
    let mut numbers = [0.0; N];
    for (index, number) in numbers.iter_mut().enumerate() {
        let place = index + 1;
        let Some(word) = words.get(index).map(S::as_ref) else {
            return Err((place, format!("`{option}` wants {N} numbers, found {index}")));
        };
        *number = real(word).map_err(|_| (place, format!("`{option}` wants {N} numbers, found `{word}`")))?;
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn transform(words: &str) -> Transform {
        let words: Vec<&str> = words.split_whitespace().collect();
        let (transform, used) = Transform::take(&words).unwrap();
        assert_eq!(used, words.len());
        transform
    }

    fn close(found: DVec3, wanted: [f64; 3]) {
        assert!((found - DVec3::from(wanted)).length() < 1e-12, "{found} is not {wanted:?}");
    }

    #[test]
    fn rotations_are_right_handed() {
        for (words, from, to) in [
            ("-rx 90", DVec3::Y, [0.0, 0.0, 1.0]),
            ("-ry 90", DVec3::Z, [1.0, 0.0, 0.0]),
            ("-rz 90", DVec3::X, [0.0, 1.0, 0.0]),
            ("-rz -270", DVec3::X, [0.0, 1.0, 0.0]),
            ("-rz 45", DVec3::X, [0.5f64.sqrt(), 0.5f64.sqrt(), 0.0]),
        ] {
            close(transform(words).affine.transform_point3(from), to);
        }
    }

    #[test]
    fn options_apply_from_left_to_right() {
        let there = transform("-t 1 0 0 -rz 90 -s 2 -mz -t 0 0 5");
        close(there.affine.transform_point3(DVec3::new(0.0, 0.0, 1.0)), [0.0, 2.0, 3.0]);
        assert_eq!(there.scale, -2.0);
    }

    #[test]
    fn repetition_spans_to_the_next_one() {
        close(
            transform("-t 1 0 0 -i 3 -t 0 1 0 -s 2 -i 1 -t 0 0 1").affine.transform_point3(DVec3::ZERO),
            [8.0, 14.0, 1.0],
        );
        assert_eq!(transform("-i 0 -t 1 1 1"), Transform::IDENTITY);
        assert_eq!(transform("-i 1000000000000 -rz 90"), Transform::IDENTITY);
    }

    #[test]
    fn it_ends_at_the_first_other_word() {
        let (transform, used) = Transform::take(&["-t", "1", "2", "3", "file", "-s", "2"]).unwrap();
        assert_eq!((transform.scale, used), (1.0, 4));
    }

    #[test]
    fn bad_words_are_named() {
        for (words, word) in [("-t 1 2", 3), ("-t 1 x 2", 2), ("-s 0", 1), ("-s", 1), ("-i 1.5", 1), ("-rx 1e999", 1)] {
            let words: Vec<&str> = words.split_whitespace().collect();
            assert_eq!(Transform::take(&words).unwrap_err().word, word, "{words:?}");
        }
    }

    proptest! {
        #[test]
        fn the_inverse_undoes(x in -1e3..1e3, degrees in -720.0..720.0, factor in 0.01..100.0) {
            let there = transform(&format!("-t {x} 1 2 -rx {degrees} -s {factor} -my -rz {degrees} -t 3 {x} 1"));
            let back = there.then(&there.inverse());
            prop_assert!(back.affine.abs_diff_eq(DAffine3::IDENTITY, 1e-8));
            prop_assert!((back.scale - 1.0).abs() < 1e-12);
        }
    }
}
