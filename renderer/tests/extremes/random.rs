//! Random scenes, written down at any size, place and turn.

use renderer::color::Rgb as Vector;

/// Random numbers (SplitMix64: Steele, Lea and Flood, OOPSLA 2014).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    }

    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> Vector {
        Vector::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    pub(crate) fn direction(&mut self) -> Vector {
        loop {
            let vector = self.vector(1.0);
            if (0.01..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }

    /// A number from the ends of a range, or its middle.
    pub(crate) fn extreme(&mut self, largest: f64) -> f64 {
        let sign = if self.below(4) == 0 { -1.0 } else { 1.0 };
        let value = match self.below(8) {
            0 => 0.0,
            1 => 5e-324,
            2 => 1e-160,
            3 => largest,
            4 => 10_f64.powf(self.within(-30.0, largest.log10())),
            5 => 1.0,
            _ => self.within(0.0, 3.0),
        };
        sign * value
    }

    /// A material that absorbs or passes on what it gets, and makes nothing.
    pub(crate) fn material(&mut self, name: &str) -> String {
        let color: Vec<String> = (0..3).map(|_| self.within(0.0, 1.0).to_string()).collect();
        let color = color.join(" ");
        let rough = [0.0, 1e-7, 1e-3, 0.05, 0.3][self.below(5) as usize];
        let (share, other, third) = (self.within(0.0, 1.0), self.within(0.0, 1.0), self.within(0.0, 1.0));
        match self.below(6) {
            0 => format!("void plastic {name} 0 0 5 {color} {share} {rough}\n"),
            1 => format!("void metal {name} 0 0 5 {color} {share} {rough}\n"),
            2 => format!("void trans {name} 0 0 7 {color} {share} {rough} {other} {third}\n"),
            3 => format!("void glass {name} 0 0 4 {color} {}\n", 1.0 + share),
            4 => format!("void dielectric {name} 0 0 5 1 1 1 {} 0\n", 1.0 + share),
            _ => format!("void mirror {name} 0 0 3 {color}\n"),
        }
    }

    pub(crate) fn shape(&mut self) -> Shape {
        let (a, b) = (self.vector(2.0), self.vector(2.0));
        let (r, s) = (self.within(0.1, 1.0), self.within(0.1, 1.0));
        match self.below(6) {
            0 => Shape { kind: "sphere", points: vec![a], vectors: vec![], lengths: vec![r] },
            1 => Shape { kind: "cylinder", points: vec![a, b], vectors: vec![], lengths: vec![r] },
            2 => Shape { kind: "cup", points: vec![a, b], vectors: vec![], lengths: vec![r, s] },
            3 => Shape { kind: "ring", points: vec![a], vectors: vec![self.direction()], lengths: vec![0.0, r] },
            4 => Shape { kind: "polygon", points: vec![a, b, self.vector(2.0)], vectors: vec![], lengths: vec![] },
            _ => {
                let c = self.vector(2.0);
                Shape { kind: "polygon", points: vec![a, b, c, a + c - b], vectors: vec![], lengths: vec![] }
            }
        }
    }
}

/// Where a scene is put: scaled, turned, shifted.
#[derive(Clone, Copy)]
pub(crate) struct Move {
    pub(crate) scale: f64,
    pub(crate) shift: Vector,
    pub(crate) axis: Vector,
    pub(crate) angle: f64,
}

impl Move {
    pub(crate) const STAY: Self = Self { scale: 1.0, shift: Vector::ZERO, axis: Vector::Z, angle: 0.0 };

    pub(crate) fn turn(axis: Vector, angle: f64) -> Self {
        Self { axis, angle, ..Self::STAY }
    }

    /// Rodrigues' formula.
    pub(crate) fn vector(&self, v: Vector) -> Vector {
        if self.angle == 0.0 {
            return v * self.scale;
        }
        let (sin, cos) = self.angle.sin_cos();
        let turned = v * cos + self.axis.cross(v) * sin + self.axis * (self.axis.dot(v) * (1.0 - cos));
        turned * self.scale
    }

    pub(crate) fn point(&self, p: Vector) -> Vector {
        self.vector(p) + self.shift
    }
}

/// A surface without its material.
pub(crate) struct Shape {
    kind: &'static str,
    points: Vec<Vector>,
    vectors: Vec<Vector>,
    lengths: Vec<f64>,
}

impl Shape {
    pub(crate) fn text(&self, modifier: &str, to: &Move) -> String {
        let vectors = self.vectors.iter().map(|&vector| to.vector(vector) / to.scale);
        let mut reals: Vec<f64> =
            self.points.iter().map(|&point| to.point(point)).chain(vectors).flat_map(|v| v.to_array()).collect();
        reals.extend(self.lengths.iter().map(|length| length * to.scale));
        let words: Vec<String> = reals.iter().map(|value| format!("{value:e}")).collect();
        format!("{modifier} {} s 0 0 {} {}\n", self.kind, words.len(), words.join(" "))
    }
}

/// A scene that can be written down anywhere.
pub(crate) struct Anywhere {
    materials: String,
    shapes: Vec<Shape>,
    lamp: Shape,
}

impl Anywhere {
    /// Its text after a move, its lamp `light` times as bright.
    pub(crate) fn text(&self, to: &Move, light: f64) -> String {
        let shapes = self.shapes.iter().enumerate().map(|(i, shape)| shape.text(&format!("m{i}"), to));
        let radiance = 1e14 * light;
        let lamp =
            format!("void light lamp 0 0 3 {radiance:e} {radiance:e} {radiance:e}\n{}", self.lamp.text("lamp", to));
        self.materials.clone() + &shapes.collect::<String>() + &lamp
    }
}

/// Some shapes around the origin, a lamp of radius 1e-7 (rough highlights differ from point to point of a larger one) above them.
pub(crate) fn any_scene(numbers: &mut Numbers) -> Anywhere {
    let count = 3 + numbers.below(4);
    let materials = (0..count).map(|i| numbers.material(&format!("m{i}"))).collect();
    let shapes = (0..count).map(|_| numbers.shape()).collect();
    let place = Vector::new(numbers.within(-1.0, 1.0), -2.0, 4.0);
    let lamp = Shape { kind: "sphere", points: vec![place], vectors: vec![], lengths: vec![1e-7] };
    Anywhere { materials, shapes, lamp }
}

/// A scene whose every argument may be as large or as small as the reader lets through.
pub(crate) fn wild_scene(numbers: &mut Numbers) -> String {
    let mut text = String::new();
    let materials = [
        ("plastic", "cccfr"),
        ("metal", "cccfr"),
        ("trans", "cccfrff"),
        ("glass", "ccci"),
        ("dielectric", "ccci0"),
        ("mirror", "ccc"),
        ("light", "ccc"),
        ("glow", "cccl"),
        ("spotlight", "cccalln"),
        ("illum", "ccc"),
        ("mist", "cccffff"),
        ("prism1", "cl"),
    ];
    let shapes = [
        ("polygon", "lllllllll"),
        ("polygon", "llllllllllll"),
        ("sphere", "llll"),
        ("bubble", "llll"),
        ("cone", "llllllpp"),
        ("cup", "llllllpp"),
        ("tube", "lllllll"),
        ("ring", "lllllnpp"),
        ("source", "llna"),
    ];
    let mut reals = |form: &str| {
        let words: Vec<String> = form
            .chars()
            .map(|letter| {
                let value = match letter {
                    'c' | 'r' => numbers.extreme(1e30).abs(),
                    'f' => numbers.extreme(1.0).abs().min(1.0),
                    'i' => (1.0 + numbers.extreme(999.0).abs()).min(1e3),
                    'a' => numbers.extreme(360.0).abs().clamp(1e-6, 360.0),
                    'p' => numbers.extreme(1e20).abs(),
                    'l' => numbers.extreme(1e20),
                    'n' => [5e-324, -1.0, 1e20][numbers.below(3) as usize],
                    _ => 0.0,
                };
                format!("{value:e}")
            })
            .collect();
        (words.len(), words.join(" "), numbers.below(u64::MAX))
    };
    let count = 6;
    for i in 0..count {
        let (_, _, bits) = reals("");
        let (kind, form) = materials[(bits % materials.len() as u64) as usize];
        let (length, words, _) = reals(form);
        let strings = match kind {
            "mist" => "3 s0 s1 s2",
            "prism1" => "5 A1 Dx+A2*Dz Dy Dz .",
            _ => "0",
        };
        text += &format!("void {kind} m{i} {strings} 0 {length} {words}\n");
        let (_, _, bits) = reals("");
        let (kind, form) = shapes[(bits % shapes.len() as u64) as usize];
        let (length, words, _) = reals(form);
        text += &format!("m{i} {kind} s{i} 0 0 {length} {words}\n");
    }
    text
}
