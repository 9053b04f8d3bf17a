//! A screen to watch, and a study whose pictures have a white corner.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use image::{ImageFormat, Rgb, RgbImage};
use stimuli::{Manifest, PictureRecord, Sha256, Study};

/// An X server with a window manager; both end with it.
pub(crate) struct Stage {
    pub(crate) name: String,
    children: Vec<Child>,
}

impl Stage {
    pub(crate) fn new(size: [u32; 2]) -> crate::Result<Self> {
        let [width, height] = size;
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", &format!("{width}x{height}x24"), "-nolisten", "tcp"]);
        let mut server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
        let mut line = String::new();
        if let Some(told) = server.stdout.take() {
            BufReader::new(told).read_line(&mut line)?;
        }
        let name = format!(":{}", line.trim());
        let mut stage = Self { name, children: vec![server] };
        let mut manager = Command::new("openbox");
        manager.env("DISPLAY", &stage.name).stdout(Stdio::null()).stderr(Stdio::null());
        stage.children.push(manager.spawn()?);
        std::thread::sleep(std::time::Duration::from_secs(3));
        Ok(stage)
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        for child in self.children.iter_mut().rev() {
            let _gone = child.kill();
            let _status = child.wait();
        }
    }
}

/// Writes a study of `intervals` intervals of `seconds` in one session: practice pairs that ask nothing, then a critical
/// pair and a check.
pub(crate) fn write_study(folder: &Path, size: [u32; 2], seconds: f64, intervals: usize) -> crate::Result<()> {
    let pair =
        "[[practice]]\nfirst = { layout = \"a\", quality = \"HQ\" }\nsecond = { layout = \"b\", quality = \"HQ\" }\n";
    let text = include_str!("../../tests/data/study.toml");
    let (arms, practice) = (text.find("[[arms]]"), text.find("[[practice]]"));
    let check = text.find("[check]");
    let (Some(arms), Some(_), Some(check)) = (arms, practice, check) else { return Err("an unexpected study".into()) };
    let free = "[wording.free]\ninstructions = \"Look.\"\npractice = \"Look.\"\nready = \"Look.\"\n\n";
    let arm = "[[arms]]\nname = \"free\"\nqualities = [\"HQ\", \"CBQ\"]\nn = 4\nviewing = \"free\"\n\n";
    let text = format!("{}{free}{arm}{}\n{}", &text[..arms], pair.repeat(intervals / 2 - 2), &text[check..])
        .replace("width_px = 64", &format!("width_px = {}", size[0]))
        .replace("height_px = 48", &format!("height_px = {}", size[1]))
        .replace("fixation_s = 1.0", "fixation_s = 0.4")
        .replace("interval_s = 6.0", &format!("interval_s = {seconds:?}"));
    std::fs::create_dir_all(folder.join("pictures"))?;
    std::fs::write(folder.join("study.toml"), text)?;
    let study = Study::load(folder)?;
    let mut manifest = Manifest { study: study.id.clone(), ..Manifest::default() };
    for (number, stimulus) in (0_u32..).zip(study.stimuli()) {
        let file = stimulus.file();
        // Each picture has its own pattern, so that drawing one costs what a rendering costs.
        let picture = RgbImage::from_fn(size[0], size[1], |x, y| match (x, y) {
            (0..32, 0..32) => Rgb([255; 3]),
            _ => Rgb([(x ^ y) as u8 / 2, (x.wrapping_mul(7) ^ number) as u8 / 2, y as u8 / 2]),
        });
        picture.save_with_format(folder.join(&file), ImageFormat::Png)?;
        let record = PictureRecord {
            layout: stimulus.layout.clone(),
            quality: stimulus.quality.clone(),
            sha256: Sha256::of_file(&folder.join(&file))?,
            file,
            request: study.request(&stimulus).ok_or("a stimulus of no study")?,
            inputs: BTreeMap::new(),
            rays: BTreeMap::new(),
            mean_luminance_cd_m2: 1.0,
            version: "generated".to_owned(),
        };
        manifest.pictures.insert(stimulus.id(), record);
    }
    Ok(manifest.save(folder)?)
}
