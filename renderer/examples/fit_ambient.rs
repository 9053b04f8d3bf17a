//! Fits the ambient value `-av` of a layout: the one value for all qualities with which two of them are equally bright on the
//! display, so that they differ by their components and not by their light.
//!
//! ```text
//! crex render SCENE... -vf VIEW --crex '(TRSGMD)*' -av 1 1 1 -o full.exr
//! crex render SCENE... -vf VIEW --crex 'T{RSGM}' --importance MAP -av 1 1 1 -o fewer.exr
//! cargo run --release -p renderer --example fit_ambient -- full.exr fewer.exr EXPOSURE
//! ```
//!
//! Both pictures are linear in the ambient value, and their ambient layers are its coefficient. So the value is sought per
//! channel, by bisection, with which the means of clamp(exposure x radiance) are the same.

use std::path::Path;
use std::process::ExitCode;

use renderer::picture::{self, Picture};

/// No interior's indirect radiance lies above this, W/(sr m2).
const MOST: f64 = 100.0;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [full, fewer, exposure] = words.as_slice() else {
        eprintln!("usage: fit_ambient FULL.exr FEWER.exr EXPOSURE");
        return ExitCode::from(2);
    };
    match fit(full, fewer, exposure) {
        Ok(av) => {
            println!("{:.5} {:.5} {:.5}", av[0], av[1], av[2]);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn fit(full: &str, fewer: &str, exposure: &str) -> Result<[f64; 3], String> {
    let exposure: f64 = exposure.parse().map_err(|_| format!("`{exposure}` is no exposure"))?;
    let full = Split::read(full)?;
    let fewer = Split::read(fewer)?;
    let mut av = [0.0; 3];
    for (channel, value) in av.iter_mut().enumerate() {
        // What the fewer components lack grows smaller as the ambient value grows.
        let lacks = |av: f64| full.mean(channel, av, exposure) - fewer.mean(channel, av, exposure);
        if lacks(0.0) < 0.0 || lacks(MOST) > 0.0 {
            return Err(format!("channel {channel}: no ambient value from 0 to {MOST} makes the two equally bright"));
        }
        let (mut low, mut high) = (0.0, MOST);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if lacks(middle) > 0.0 { low = middle } else { high = middle }
        }
        *value = f64::midpoint(low, high);
    }
    Ok(av)
}

/// A picture rendered with `-av 1 1 1`, as what does not depend on the ambient value and what grows with it.
struct Split {
    fixed: Vec<[f64; 3]>,
    growing: Vec<[f64; 3]>,
}

impl Split {
    fn read(file: &str) -> Result<Self, String> {
        let picture = picture::read(Path::new(file)).map_err(|error| error.to_string())?;
        let growing = ambient(&picture);
        let fixed = picture
            .beauty
            .values()
            .iter()
            .zip(&growing)
            .map(|(beauty, growing)| std::array::from_fn(|i| f64::from(beauty[i]) - growing[i]))
            .collect();
        Ok(Self { fixed, growing })
    }

    /// The mean of what the display shows in a channel, 1 being its white.
    fn mean(&self, channel: usize, av: f64, exposure: f64) -> f64 {
        let shown = |(fixed, growing): (&[f64; 3], &[f64; 3])| {
            (exposure * (fixed[channel] + av * growing[channel])).clamp(0.0, 1.0)
        };
        self.fixed.iter().zip(&self.growing).map(shown).sum::<f64>() / self.fixed.len() as f64
    }
}

/// The ambient layer; an absent one is zero.
fn ambient(picture: &Picture) -> Vec<[f64; 3]> {
    match picture.layer("ambient") {
        Some(layer) => layer.values().iter().map(|pixel| pixel.map(f64::from)).collect(),
        None => vec![[0.0; 3]; picture.beauty.values().len()],
    }
}
