//! Before anybody sits down: the refresh is measured, and every picture is uploaded, drawn and held against its file.
//!
//! A picture is drawn and read back within one pass, and an even grey is drawn over it before the pass ends: so its first
//! showing is not its first drawing, and nobody sees it.

use std::sync::{Arc, Mutex};

use eframe::egui_glow::CallbackFn;
use egui::Ui;

use super::pixels::{Uploaded, window_px};
use crate::stimulus::Picture;

/// Draws a picture in this pass and counts the bytes of the framebuffer that are not the file's.
#[derive(Debug)]
pub(super) struct Reading {
    differing: Arc<Mutex<Option<u64>>>,
}

impl Reading {
    /// Draws `uploaded`, the picture of a file, reads it back and covers it with `even`.
    pub(super) fn begin(ui: &Ui, picture: Picture, uploaded: &Uploaded, even: &Uploaded) -> Self {
        let differing = Arc::new(Mutex::new(None));
        let found = Arc::clone(&differing);
        uploaded.draw(ui);
        let read = CallbackFn::new(move |info, painter| {
            let screen = painter.read_screen_rgba(info.screen_size_px);
            if let Ok(mut found) = found.lock() {
                *found = Some(differing_bytes(&screen, &picture));
            }
        });
        let rect = ui.ctx().content_rect();
        ui.painter().add(egui::PaintCallback { rect, callback: Arc::new(read) });
        even.draw(ui);
        Self { differing }
    }

    /// The bytes of red, green and blue that differ; `None` if the framebuffer was not read.
    pub(super) fn differing_bytes(&self) -> Option<u64> {
        self.differing.lock().ok().and_then(|found| *found)
    }
}

/// The bytes of red, green and blue in the middle of the screen that are not the picture's; all of them if it does not fit.
fn differing_bytes(screen: &egui::ColorImage, picture: &Picture) -> u64 {
    let [width, height] = [picture.width_px, picture.height_px].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let [across, down] = screen.size;
    if width > across || height > down {
        return picture.rgba.len() as u64 / 4 * 3;
    }
    let (left, top) = ((across - width) / 2, (down - height) / 2);
    let mut differing = 0;
    for (y, row) in picture.rgba.chunks_exact(4 * width).enumerate() {
        let shown = &screen.pixels[(top + y) * across + left..][..width];
        for (file, shown) in row.chunks_exact(4).zip(shown) {
            let shown = shown.to_array();
            differing += (0..3).filter(|&channel| file[channel] != shown[channel]).count() as u64;
        }
    }
    differing
}

/// Why a study cannot be shown in this window.
pub(super) fn does_not_fit(context: &egui::Context, wanted: [usize; 2]) -> Option<String> {
    let window = window_px(context);
    if window[0] < wanted[0] || window[1] < wanted[1] {
        return Some(format!(
            "The pictures have {} x {} pixels and the window only {} x {}. They are shown pixel for pixel or not at all: \
             use a larger display, or start a window manager, without which no window fills the screen.",
            wanted[0], wanted[1], window[0], window[1]
        ));
    }
    let most = context.input(|input| input.max_texture_side);
    wanted
        .iter()
        .any(|&side| side > most)
        .then(|| format!("This machine's graphics cannot hold a picture of more than {most} pixels a side."))
}

/// The characters of a study's texts that the window's font cannot draw, each once.
pub(super) fn undrawable(context: &egui::Context, texts: &[&str]) -> String {
    let font = egui::TextStyle::Body.resolve(&context.global_style());
    let mut missing: Vec<char> = texts.iter().flat_map(|text| text.chars()).filter(|c| !c.is_whitespace()).collect();
    missing.sort_unstable();
    missing.dedup();
    context.fonts_mut(|fonts| missing.retain(|&c| !fonts.has_glyph(&font, c)));
    missing.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stimuli::{Sha256, Stimulus};

    /// A screen of 5 x 4 with a picture of 2 x 2 in its middle.
    #[test]
    fn every_byte_of_the_picture_is_compared_and_none_beside_it() {
        let stimulus = Stimulus { layout: "a".to_owned(), quality: "HQ".to_owned() };
        let rgba: Vec<u8> = (0..16_u8).map(|i| if i % 4 == 3 { 255 } else { 10 * i }).collect();
        let picture = Picture { stimulus, sha256: Sha256::of(b""), width_px: 2, height_px: 2, rgba };
        let mut screen = egui::ColorImage::filled([5, 4], egui::Color32::from_rgb(9, 9, 9));
        for (i, pixel) in picture.rgba.chunks_exact(4).enumerate() {
            screen.pixels[(1 + i / 2) * 5 + 1 + i % 2] = egui::Color32::from_rgb(pixel[0], pixel[1], pixel[2]);
        }
        assert_eq!(differing_bytes(&screen, &picture), 0);
        screen.pixels[2 * 5 + 2] = egui::Color32::from_rgb(1, 2, 140);
        assert_eq!(differing_bytes(&screen, &picture), 2);
        screen.pixels[0] = egui::Color32::BLACK;
        assert_eq!(differing_bytes(&screen, &picture), 2);
        let small = egui::ColorImage::filled([1, 1], egui::Color32::BLACK);
        assert_eq!(differing_bytes(&small, &picture), 12);
    }
}
