//! A small study on disk, with generated pictures and their manifest.

use std::collections::BTreeMap;
use std::path::Path;

use image::{ImageFormat, Rgb, RgbImage};
use stimuli::{Manifest, PictureRecord, Sha256, Study};

/// Writes the study of the tests into `folder`, its text changed by `edit` first, and a picture for every stimulus.
pub(crate) fn write_study(folder: &Path, edit: impl FnOnce(String) -> String) -> Study {
    let text = edit(include_str!("../data/study.toml").to_owned());
    std::fs::create_dir_all(folder.join("pictures")).unwrap();
    std::fs::write(folder.join("study.toml"), text).unwrap();
    let study = Study::load(folder).unwrap_or_else(|error| panic!("{error}"));
    let mut manifest = Manifest { study: study.id.clone(), ..Manifest::default() };
    for (i, stimulus) in (0_u32..).zip(study.stimuli()) {
        let file = stimulus.file();
        let picture = picture(study.display.width_px, study.display.height_px, i);
        picture.save_with_format(folder.join(&file), ImageFormat::Png).unwrap();
        let record = PictureRecord {
            layout: stimulus.layout.clone(),
            quality: stimulus.quality.clone(),
            sha256: Sha256::of_file(&folder.join(&file)).unwrap(),
            file,
            request: study.request(&stimulus).unwrap(),
            inputs: BTreeMap::new(),
            rays: BTreeMap::new(),
            mean_luminance_cd_m2: 1.0,
            version: "test".to_owned(),
        };
        manifest.pictures.insert(stimulus.id(), record);
    }
    manifest.save(folder).unwrap();
    study
}

/// How often a test does what it does: few times in every run of the tests, as often as the environment says for a figure.
#[allow(dead_code, reason = "not every test file repeats anything")]
pub(crate) fn times(name: &str, otherwise: u32) -> u32 {
    std::env::var(name).map_or(otherwise, |times| times.parse().expect("a whole number of times"))
}

/// Every pixel differs from its neighbours, and every picture from the others: a shift by one pixel, a filter or a wrong
/// picture cannot pass unseen.
pub(crate) fn picture(width: u32, height: u32, number: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let mixed = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503) ^ number.wrapping_mul(97_531))
            .wrapping_mul(2_246_822_519);
        let [a, b, c, _] = (mixed ^ (mixed >> 15)).to_le_bytes();
        Rgb([a, b, c])
    })
}
