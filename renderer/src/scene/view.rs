//! Views as `rpict(1)` has them: six projections, clipping planes, shift and lift, square pixels.

use glam::{DVec2, DVec3};

use crate::geometry::Ray;
use crate::rad::{ViewKind, ViewSpec};

/// Lengths beyond this are refused, as in scenes: their cubes would leave the range of `f64`.
const LARGEST: f64 = 1e75;

/// Why parameters give no view.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// A zero or unbounded direction.
    #[error("the view direction (-vd) must be a finite vector other than zero")]
    Direction,
    /// Up along the direction.
    #[error("the up vector (-vu) must be a finite vector that is not parallel to the view direction (-vd)")]
    Up,
    /// A size outside its range.
    #[error("the view's {option} is {value}, expected more than 0 and {limit}")]
    Size {
        /// Which of the two.
        option: &'static str,
        /// What it is.
        value: f64,
        /// The upper limit in words.
        limit: &'static str,
    },
    /// A clipping plane in front of where it may be.
    #[error("the fore plane (-vo) must not be negative, and the aft plane (-va) must be 0 or lie behind it")]
    Planes,
    /// A number out of range.
    #[error(
        "the view point, its clipping distances and what it is shifted and lifted by must be numbers of at most 1e75"
    )]
    TooLarge,
}

/// A view, ready to make rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    spec: ViewSpec,
    point: DVec3,
    direction: DVec3,
    right: DVec3,
    up: DVec3,
    /// Extent of the whole picture on the projection's own plane.
    extent: DVec2,
}

impl View {
    /// Checks a view as it was written and prepares it.
    pub fn new(spec: ViewSpec) -> Result<Self, ViewError> {
        let direction = unit(spec.direction).ok_or(ViewError::Direction)?;
        let up = unit(spec.up).ok_or(ViewError::Up)?;
        let right = direction.cross(up);
        // rpict takes vectors within 1e-6 of each other as parallel.
        let right = if right.length() > 1e-6 { right.normalize() } else { return Err(ViewError::Up) };
        let point = DVec3::from(spec.point);
        if !(spec.fore >= 0.0
            && spec.fore.is_finite()
            && (spec.aft == 0.0 || spec.aft > spec.fore)
            && spec.aft.is_finite())
        {
            return Err(ViewError::Planes);
        }
        let extent = DVec2::new(
            extent(spec.kind, "width (-vh)", spec.horizontal, spec.kind == ViewKind::Cylindrical)?,
            extent(spec.kind, "height (-vv)", spec.vertical, false)?,
        );
        let offsets = (DVec2::new(spec.shift, spec.lift).abs() + 1.0) * extent;
        let lengths = DVec2::new(spec.fore, spec.aft);
        // NaN is in no range.
        let within = |length: f64| length <= LARGEST;
        if !(point.to_array().into_iter().chain(offsets.to_array()).chain(lengths.to_array())).all(|x| within(x.abs()))
        {
            return Err(ViewError::TooLarge);
        }
        Ok(Self { spec, point, direction, right, up: right.cross(direction), extent })
    }

    /// What it was made of.
    #[must_use]
    pub fn spec(&self) -> &ViewSpec {
        &self.spec
    }

    /// The eye.
    #[must_use]
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// Unit vector along which the eye looks.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Height of the picture over its width, on the projection's own plane.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        self.extent.y / self.extent.x
    }

    /// The largest picture within `width` x `height` whose pixels are `pixel_aspect` times as high as wide
    /// (`rpict(1)`, `-pa`): the larger side is reduced. 0 keeps both.
    #[must_use]
    pub fn resolution(&self, width: usize, height: usize, pixel_aspect: f64) -> (usize, usize) {
        let aspect = self.aspect();
        let (x, y) = (width as f64, height as f64);
        if pixel_aspect <= 0.0 {
            (width, height)
        } else if aspect * x > pixel_aspect * y {
            ((((y / aspect * pixel_aspect) + 0.5) as usize).max(1), height)
        } else {
            (width, (((x * aspect / pixel_aspect) + 0.5) as usize).max(1))
        }
    }

    /// The ray through a point of the picture: `x` from 0 at the left edge to 1 at the right, `y` from 0 at the **top** to
    /// 1 at the bottom. It starts on the fore plane and ends on the aft one. `None` outside the image of a fisheye.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64) -> Option<Ray> {
        let ViewSpec { kind, fore, aft, shift, lift, .. } = self.spec;
        let point = self.point;
        let across = (x - 0.5 + shift) * self.extent.x;
        let upward = (0.5 - y + lift) * self.extent.y;
        if kind == ViewKind::Parallel {
            let origin = point + self.direction * fore + self.right * across + self.up * upward;
            let ray = Ray::new(origin, self.direction);
            return Some(if aft > 0.0 { ray.up_to(aft - fore) } else { ray });
        }
        let radius_squared = across * across + upward * upward;
        let (ahead, across, upward) = match kind {
            ViewKind::Perspective | ViewKind::Parallel => (1.0, across, upward),
            ViewKind::Cylindrical => (across.cos(), across.sin(), upward),
            ViewKind::Hemispherical => {
                let ahead_squared = 1.0 - radius_squared;
                if ahead_squared < 0.0 {
                    return None;
                }
                (ahead_squared.sqrt(), across, upward)
            }
            ViewKind::Angular => {
                let angle = radius_squared.sqrt();
                if angle > std::f64::consts::PI {
                    return None;
                }
                let stretch = if angle == 0.0 { 1.0 } else { angle.sin() / angle };
                (angle.cos(), across * stretch, upward * stretch)
            }
            ViewKind::Planispheric => {
                let ahead = (1.0 - radius_squared) / (1.0 + radius_squared);
                (ahead, across * (1.0 + ahead), upward * (1.0 + ahead))
            }
        };
        // Not yet of length 1 for flat and cylindrical pictures: there a plane's distance is measured along the axis.
        let towards = self.direction * ahead + self.right * across + self.up * upward;
        let length = towards.length();
        let ray = Ray::new(point + towards * fore, towards / length);
        Some(if aft > 0.0 { ray.up_to((aft - fore) * length) } else { ray })
    }
}

impl View {
    /// Whether it may have a lens of some width.
    #[must_use]
    pub fn takes_lens(&self) -> bool {
        self.spec.kind == ViewKind::Perspective
    }

    /// A ray of the view as one through a point of a lens: it meets the ray in the plane at the focus distance, the length
    /// of `-vd` (`rpict(1)`, `-pd`). `lens` is a point of the unit disc, `diameter` the lens's; of perspectives only.
    /// `None` if the numbers leave the range of `f64`.
    #[must_use]
    pub fn through_lens(&self, ray: &Ray, diameter: f64, lens: DVec2) -> Option<Ray> {
        let focus = DVec3::from(self.spec.direction).length();
        let ahead = ray.dir.dot(self.direction);
        let aside = (self.right * lens.x + self.up * lens.y) * (0.5 * diameter);
        let towards = (ray.dir * (focus / ahead) - aside).try_normalize()?;
        let stretch = 1.0 / towards.dot(self.direction);
        let origin = self.point + aside + towards * (self.spec.fore * stretch);
        let ray = Ray::new(origin, towards);
        let usable = stretch.is_finite() && origin.is_finite();
        usable.then(|| if self.spec.aft > 0.0 { ray.up_to((self.spec.aft - self.spec.fore) * stretch) } else { ray })
    }
}

fn unit(vector: [f64; 3]) -> Option<DVec3> {
    let vector = DVec3::from(vector);
    let scale = vector.abs().max_element();
    (scale > 0.0 && vector.is_finite()).then(|| (vector / scale).normalize())
}

/// Extent of one side of the picture on the projection's plane.
fn extent(kind: ViewKind, option: &'static str, size: f64, around: bool) -> Result<f64, ViewError> {
    let half = 0.5 * size.to_radians();
    let (largest, limit, extent) = match kind {
        ViewKind::Parallel => (f64::MAX, "finite", size),
        ViewKind::Cylindrical if around => (360.0, "at most 360 degrees", 2.0 * half),
        ViewKind::Perspective | ViewKind::Cylindrical => (179.999_999, "less than 180 degrees", 2.0 * half.tan()),
        ViewKind::Hemispherical => (180.0, "at most 180 degrees", 2.0 * half.sin()),
        ViewKind::Angular => (360.0, "at most 360 degrees", 2.0 * half),
        ViewKind::Planispheric => (359.999_999, "less than 360 degrees", 2.0 * half.sin() / (1.0 + half.cos())),
    };
    if size > 0.0 && size <= largest { Ok(extent) } else { Err(ViewError::Size { option, value: size, limit }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view(kind: char, size: [f64; 2]) -> View {
        let [horizontal, vertical] = size;
        let kind = ViewKind::from_letter(kind).unwrap();
        View::new(ViewSpec { kind, horizontal, vertical, ..ViewSpec::default() }).unwrap()
    }

    /// Directions at the middle of the right edge and of the top edge, by the definition of each projection.
    #[test]
    fn edges_of_the_picture_lie_where_each_projection_says() {
        // (projection, sizes, angle from the axis at the right edge, at the top edge), degrees
        let table = [
            ('v', [90.0, 60.0], 45.0, 30.0),
            ('v', [0.001, 179.99], 0.0005, 89.995),
            ('c', [360.0, 90.0], 180.0, 45.0),
            ('c', [90.0, 20.0], 45.0, 10.0),
            ('h', [180.0, 120.0], 90.0, 60.0),
            ('a', [180.0, 90.0], 90.0, 45.0),
            ('a', [360.0, 360.0], 180.0, 180.0),
            ('s', [180.0, 100.0], 90.0, 50.0),
            ('s', [300.0, 300.0], 150.0, 150.0),
        ];
        for (letter, size, right, top) in table {
            let view = view(letter, size);
            // Default axes: forward +y, right +x, up +z.
            let at_right = view.ray(1.0, 0.5).unwrap().dir;
            let at_top = view.ray(0.5, 0.0).unwrap().dir;
            let angle = |side: f64, forward: f64| side.atan2(forward).to_degrees();
            assert!((angle(at_right.x, at_right.y) - right).abs() < 1e-6, "{letter} {size:?}: {at_right}");
            assert!((angle(at_top.z, at_top.y) - top).abs() < 1e-6, "{letter} {size:?}: {at_top}");
            assert!(view.ray(0.5, 0.5).unwrap().dir.abs_diff_eq(DVec3::Y, 1e-15));
        }
    }

    #[test]
    fn a_parallel_view_moves_the_origin() {
        let view = view('l', [4.0, 2.0]);
        let ray = view.ray(1.0, 0.0).unwrap();
        assert_eq!((ray.origin, ray.dir), (DVec3::new(2.0, 0.0, 1.0), DVec3::Y));
        assert_eq!(view.resolution(400, 400, 1.0), (400, 200));
    }

    #[test]
    fn fisheyes_end_at_their_circle() {
        for (letter, size) in [('h', 180.0), ('a', 360.0)] {
            let view = view(letter, [size; 2]);
            assert!(view.ray(0.01, 0.01).is_none());
            assert!(view.ray(0.5, 0.001).is_some());
        }
    }

    #[test]
    fn clipping_planes_are_flat_in_perspective_and_round_in_fisheyes() {
        let clipped = |kind, x, y| {
            let size = 90.0;
            let spec = ViewSpec { kind, horizontal: size, vertical: size, fore: 2.0, aft: 5.0, ..ViewSpec::default() };
            View::new(spec).unwrap().ray(x, y).unwrap()
        };
        for (x, y) in [(0.5, 0.5), (0.9, 0.2), (1.0, 1.0)] {
            let ray = clipped(ViewKind::Perspective, x, y);
            assert!((ray.origin.y - 2.0).abs() < 1e-14 && (ray.at(ray.t_max).y - 5.0).abs() < 1e-13);
            let ray = clipped(ViewKind::Angular, x, y);
            assert!((ray.origin.length() - 2.0).abs() < 1e-14 && (ray.at(ray.t_max).length() - 5.0).abs() < 1e-13);
            let ray = clipped(ViewKind::Parallel, x, y);
            assert!(ray.origin.y == 2.0 && ray.at(ray.t_max).y == 5.0);
            let ray = clipped(ViewKind::Cylindrical, x, y);
            assert!((ray.origin.truncate().length() - 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn shift_and_lift_are_in_pictures() {
        let spec = ViewSpec { shift: 0.5, lift: -0.5, horizontal: 60.0, vertical: 40.0, ..ViewSpec::default() };
        let shifted = View::new(spec).unwrap();
        let plain = view('v', [60.0, 40.0]);
        // The shifted picture's left top corner is the plain one's centre: half a picture right and down.
        assert!(shifted.ray(0.0, 0.0).unwrap().dir.abs_diff_eq(plain.ray(0.5, 0.5).unwrap().dir, 1e-15));
    }

    #[test]
    fn the_larger_side_is_reduced() {
        let four_by_three = view('v', [2.0 * 2_f64.atan().to_degrees(), 2.0 * 1.5_f64.atan().to_degrees()]);
        assert_eq!(four_by_three.resolution(512, 512, 1.0), (512, 384));
        assert_eq!(four_by_three.resolution(512, 100, 1.0), (133, 100));
        assert_eq!(four_by_three.resolution(512, 512, 0.0), (512, 512));
        // Pixels twice as high as wide: half as many rows.
        assert_eq!(four_by_three.resolution(512, 512, 2.0), (512, 192));
        assert_eq!(view('v', [179.99, 0.001]).resolution(100, 100, 1.0), (100, 1));
    }

    #[test]
    fn bad_parameters_are_named() {
        let base = ViewSpec::default();
        let error = |spec| View::new(spec).unwrap_err();
        assert_eq!(error(ViewSpec { direction: [0.0; 3], ..base }), ViewError::Direction);
        assert_eq!(error(ViewSpec { direction: [f64::NAN; 3], ..base }), ViewError::Direction);
        assert_eq!(error(ViewSpec { up: [0.0, 3.0, 0.0], ..base }), ViewError::Up);
        assert_eq!(error(ViewSpec { aft: 1.0, fore: 2.0, ..base }), ViewError::Planes);
        assert_eq!(error(ViewSpec { point: [f64::INFINITY; 3], ..base }), ViewError::TooLarge);
        assert!(error(ViewSpec { horizontal: 180.0, ..base }).to_string().contains("-vh"));
        assert!(error(ViewSpec { vertical: 0.0, ..base }).to_string().contains("-vv"));
        assert!(error(ViewSpec { vertical: f64::NAN, ..base }).to_string().contains("-vv"));
        // Only the direction counts, not the length, even where its square is out of range.
        assert!(View::new(ViewSpec { direction: [0.0, 1e-200, 0.0], ..base }).is_ok());
    }

    proptest! {
        #[test]
        fn rays_are_unit_and_the_picture_keeps_its_handedness(
            letter in prop::sample::select(vec!['v', 'l', 'c', 'h', 'a', 's']),
            size in 1.0..170.0_f64, x in 0.2..0.8_f64, y in 0.2..0.8_f64,
            vd in prop::array::uniform3(-1.0..1.0_f64), vu in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let (direction, up) = (DVec3::from(vd), DVec3::from(vu));
            prop_assume!(direction.cross(up).length() > 1e-3);
            let kind = ViewKind::from_letter(letter).unwrap();
            let view = View::new(ViewSpec { kind, direction: vd, up: vu, horizontal: size, vertical: size, ..ViewSpec::default() }).unwrap();
            let step = 1e-5;
            if let (Some(here), Some(right), Some(below)) = (view.ray(x, y), view.ray(x + step, y), view.ray(x, y + step)) {
                prop_assert!((here.dir.length() - 1.0).abs() < 1e-14);
                let to_right = right.origin + right.dir - here.origin - here.dir;
                let to_below = below.origin + below.dir - here.origin - here.dir;
                // Right, below and forward make a right-handed system.
                prop_assert!(to_right.cross(to_below).dot(here.dir) > 0.0);
            }
        }
    }
}
