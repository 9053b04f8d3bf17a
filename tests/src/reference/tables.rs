//! The tables of `data/reference`: 16 x 16 block means of luminance, by picture and by path word.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Blocks on a side of a table's grid.
pub(crate) const GRID: usize = 16;

/// Mean luminance of every block, in rows from the top left.
pub(crate) type Blocks = Vec<f64>;

/// A converged picture.
pub(crate) struct Picture {
    /// RMS over 8x8 pixel blocks of the relative noise, as its makers give it.
    pub(crate) block_noise: f64,
    pub(crate) blocks: Blocks,
}

pub(crate) fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data")
}

fn rows(name: &str) -> impl Iterator<Item = (String, Vec<f64>)> {
    let path = data().join("reference").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let rows: Vec<_> = text
        .lines()
        .skip(1)
        .map(|line| {
            let mut cells = line.split(',');
            let name = cells.next().unwrap_or_default().to_owned();
            (name, cells.map(|cell| cell.parse().expect("tables hold numbers")).collect())
        })
        .collect();
    rows.into_iter()
}

/// The picture `name` of `pictures.csv`.
pub(crate) fn picture(name: &str) -> Picture {
    picture_of("pictures.csv", name)
}

/// The picture `name` of `rendered.csv`.
pub(crate) fn rendered(name: &str) -> Picture {
    picture_of("rendered.csv", name)
}

fn picture_of(table: &str, name: &str) -> Picture {
    let (_, mut cells) = rows(table).find(|(row, _)| row == name).expect("the table holds the picture");
    let block_noise = cells.remove(0);
    assert_eq!(cells.len(), GRID * GRID);
    Picture { block_noise, blocks: cells }
}

/// The pictures of the words of `words_{scene}.csv`, with letters of the crex language: the smooth, rough and diffuse
/// transmission of trans (t, g, d) are T, G and D; the empty word is "".
pub(crate) fn words(scene: &str) -> BTreeMap<String, Blocks> {
    let mut words: BTreeMap<String, Blocks> = BTreeMap::new();
    for (word, cells) in rows(&format!("words_{scene}.csv")) {
        let word = word.replace('_', "").to_uppercase();
        let sum = words.entry(word).or_insert_with(|| vec![0.0; GRID * GRID]);
        sum.iter_mut().zip(&cells).for_each(|(sum, cell)| *sum += cell);
    }
    words
}

/// How far a picture lies from a converged one.
pub(crate) struct Difference {
    /// Mean over mean, minus 1.
    pub(crate) mean: f64,
    /// Share of the blocks that agree; blocks under a thousandth of the mean are left out.
    pub(crate) agreeing: f64,
    /// The worst block, relative.
    pub(crate) worst: f64,
}

/// Compares block means; a block agrees within `relative` of its value or `absolute`, whichever is larger.
pub(crate) fn difference(found: &[f64], expected: &[f64], relative: f64, absolute: f64) -> Difference {
    assert_eq!(found.len(), expected.len());
    let mean = |blocks: &[f64]| blocks.iter().sum::<f64>() / blocks.len() as f64;
    let dark = 1e-3 * mean(expected);
    let mut counted = 0_usize;
    let mut agreeing = 0_usize;
    let mut worst = 0.0_f64;
    for (&found, &expected) in found.iter().zip(expected).filter(|(_, expected)| **expected >= dark) {
        counted += 1;
        agreeing += usize::from((found - expected).abs() <= (relative * expected).max(absolute));
        worst = worst.max((found / expected - 1.0).abs());
    }
    assert!(counted > 0, "a picture has blocks that are not dark");
    Difference { mean: mean(found) / mean(expected) - 1.0, agreeing: agreeing as f64 / counted as f64, worst }
}
