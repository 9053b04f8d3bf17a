//! A picture on the screen, one of its pixels for one of the display's.

use egui::{Color32, ColorImage, Context, Mesh, Pos2, Rect, Shape, TextureHandle, TextureOptions, Vec2};

use crate::stimulus::Picture;

/// A picture in the graphics memory.
#[derive(Clone)]
pub(super) struct Uploaded {
    texture: TextureHandle,
    size_px: [usize; 2],
}

impl std::fmt::Debug for Uploaded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Uploaded({}, {:?})", self.texture.name(), self.size_px)
    }
}

impl Uploaded {
    /// Uploads a picture, unfiltered. It reaches the graphics memory when this pass is painted.
    pub(super) fn new(context: &Context, picture: &Picture) -> Self {
        let size_px = [picture.width_px, picture.height_px].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        let pixels = picture.rgba.chunks_exact(4).map(|p| Color32::from_rgb(p[0], p[1], p[2])).collect();
        Self::of(context, &picture.stimulus.id(), ColorImage::new(size_px, pixels))
    }

    /// An even picture of the same size: what stands in a picture's place before and after it costs as much to draw, so
    /// that a change of screens is not early or late by the difference.
    pub(super) fn even(context: &Context, size_px: [usize; 2], colour: Color32) -> Self {
        Self::of(context, "even", ColorImage::filled(size_px, colour))
    }

    fn of(context: &Context, name: &str, image: ColorImage) -> Self {
        let size_px = image.size;
        Self { texture: context.load_texture(name, image, TextureOptions::NEAREST), size_px }
    }

    /// Draws it in the middle of the window, on whole pixels.
    pub(super) fn draw(&self, ui: &egui::Ui) {
        let scale = ui.ctx().pixels_per_point();
        let rect = place(window_px(ui.ctx()), self.size_px, scale);
        let mut mesh = Mesh::with_texture(self.texture.id());
        mesh.add_rect_with_uv(rect, Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0)), Color32::WHITE);
        ui.painter().add(Shape::mesh(mesh));
    }
}

/// The window's size in physical pixels.
pub(super) fn window_px(context: &Context) -> [usize; 2] {
    let size = context.content_rect().size() * context.pixels_per_point();
    [size.x, size.y].map(|side| side.round().max(0.0) as usize)
}

/// The points that a picture covers in the middle of a window, so that its corners lie on corners of pixels.
fn place(window_px: [usize; 2], picture_px: [usize; 2], scale: f32) -> Rect {
    let corner = |axis: usize| (window_px[axis].saturating_sub(picture_px[axis]) / 2) as f32;
    let corner_px = Vec2::new(corner(0), corner(1));
    let size_px = Vec2::new(picture_px[0] as f32, picture_px[1] as f32);
    Rect::from_min_size((corner_px / scale).to_pos2(), size_px / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_lie_on_pixels_at_any_scale() {
        for scale in [1.0, 1.25, 1.5, 1.75, 2.0, 2.625] {
            for window in [[1920, 1080], [1281, 1025], [2559, 1439], [3840, 2160]] {
                let rect = place(window, [1280, 1024], scale);
                for (found, whole) in [
                    (rect.min.x * scale, ((window[0] - 1280) / 2) as f32),
                    (rect.min.y * scale, ((window[1] - 1024) / 2) as f32),
                    (rect.width() * scale, 1280.0),
                    (rect.height() * scale, 1024.0),
                ] {
                    // A pixel's colour is taken at its centre, half a pixel from where another would be taken.
                    assert!((found - whole).abs() < 0.01, "{found} {whole} at scale {scale}");
                }
            }
        }
    }
}
