//! Tiles that run a crex each by itself add up to one execution over the whole picture.

use proptest::prelude::*;
use renderer::crex::compile;
use renderer::schedule::{StageRow, merge_rows};

use crate::scene::{Scene, Spawning, execute};
use crate::trees::{Forms, sequence, text};

/// A picture of up to 12 pixels, and the tile of each.
fn tiled() -> impl Strategy<Value = (Scene, Vec<usize>)> {
    (prop::collection::vec(((0..=8u8).prop_map(|i| f32::from(i) / 8.0), 0..4usize), 1..12), any::<u64>(), 1..6usize)
        .prop_map(|(pixels, seed, length)| {
            let (importance, tiles) = pixels.into_iter().unzip();
            (Scene { importance, spawning: Spawning::Random { seed, length } }, tiles)
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn merged_rows_are_those_of_the_whole_picture(items in sequence(3, 3, Forms::ALL), (scene, tiles) in tiled()) {
        let crex = text(&items);
        check(&crex, &scene, &tiles)?;
    }

    /// The same where repeats are cut short because they trace nothing.
    #[test]
    fn huge_multipliers_merge_too(items in sequence(2, 2, Forms::ALL), k in 300..1500u32, (scene, tiles) in tiled()) {
        let crex = format!("(({}){k}T)2", text(&items));
        check(&crex, &scene, &tiles)?;
    }
}

fn check(crex: &str, scene: &Scene, tiles: &[usize]) -> Result<(), TestCaseError> {
    let program = compile(crex).map_err(|errors| TestCaseError::fail(format!("{crex}: {errors:?}")))?;
    let whole = execute(&program, None, scene, 0..tiles.len() as u32);
    let parts: Vec<Vec<StageRow>> = (0..4)
        .map(|tile| {
            let pixels = (0u32..).zip(tiles).filter(|(_, of)| **of == tile).map(|(pixel, _)| pixel);
            execute(&program, None, scene, pixels).rows
        })
        .collect();
    prop_assert_eq!(merge_rows(parts), whole.rows, "{}", crex);
    Ok(())
}
