//! Views as rpict(1) takes them: `-vt -vp -vd -vu -vh -vv -vo -va -vs -vl`.

use std::fmt;

/// The projection, by the letter after `-vt`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ViewKind {
    /// `v`: perspective.
    #[default]
    Perspective,
    /// `l`: parallel.
    Parallel,
    /// `c`: cylindrical panorama.
    Cylindrical,
    /// `h`: hemispherical fisheye (orthographic projection of the sphere).
    Hemispherical,
    /// `a`: angular fisheye (equidistant).
    Angular,
    /// `s`: planispheric fisheye (stereographic).
    Planispheric,
}

impl ViewKind {
    /// The letter of `-vt`.
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::Perspective => 'v',
            Self::Parallel => 'l',
            Self::Cylindrical => 'c',
            Self::Hemispherical => 'h',
            Self::Angular => 'a',
            Self::Planispheric => 's',
        }
    }

    /// The projection of a letter of `-vt`.
    #[must_use]
    pub const fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'v' => Self::Perspective,
            'l' => Self::Parallel,
            'c' => Self::Cylindrical,
            'h' => Self::Hemispherical,
            'a' => Self::Angular,
            's' => Self::Planispheric,
            _ => return None,
        })
    }
}

/// A view's parameters as written, unchecked against each other (view direction along up, say, is for the builder of
/// the camera).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSpec {
    /// `-vt`: the projection.
    pub kind: ViewKind,
    /// `-vp`: the eye, or the centre of a parallel view.
    pub point: [f64; 3],
    /// `-vd`: the direction of view; its length is the focus distance.
    pub direction: [f64; 3],
    /// `-vu`: up.
    pub up: [f64; 3],
    /// `-vh`: horizontal size, degrees (a length for a parallel view).
    pub horizontal: f64,
    /// `-vv`: vertical size, degrees (a length for a parallel view).
    pub vertical: f64,
    /// `-vo`: distance of the fore clipping plane (radius for fisheyes); 0 is none.
    pub fore: f64,
    /// `-va`: distance of the aft clipping plane; 0 is none.
    pub aft: f64,
    /// `-vs`: shift to the right, in picture widths.
    pub shift: f64,
    /// `-vl`: lift upwards, in picture heights.
    pub lift: f64,
}

impl Default for ViewSpec {
    /// rpict's defaults (`rpict -defaults`).
    fn default() -> Self {
        Self {
            kind: ViewKind::Perspective,
            point: [0.0; 3],
            direction: [0.0, 1.0, 0.0],
            up: [0.0, 0.0, 1.0],
            horizontal: 45.0,
            vertical: 45.0,
            fore: 0.0,
            aft: 0.0,
            shift: 0.0,
            lift: 0.0,
        }
    }
}

impl fmt::Display for ViewSpec {
    /// All options, as they stand after `VIEW=` in a picture's header; every number reads back to the same bits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "-vt{}", self.kind.letter())?;
        for (option, [x, y, z]) in [("-vp", self.point), ("-vd", self.direction), ("-vu", self.up)] {
            write!(f, " {option} {x} {y} {z}")?;
        }
        for (option, value) in [
            ("-vh", self.horizontal),
            ("-vv", self.vertical),
            ("-vo", self.fore),
            ("-va", self.aft),
            ("-vs", self.shift),
            ("-vl", self.lift),
        ] {
            write!(f, " {option} {value}")?;
        }
        Ok(())
    }
}
