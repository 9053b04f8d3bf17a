//! Eight `f32` at once, by the widest instructions that the processor at hand has. The only file that names pulp.
//!
//! Nothing exact is computed with these: the two ways round differently, and what is decided with them errs to the safe side.

use glam::Vec4;
use pulp::NullaryFnOnce;

/// Arithmetic on eight numbers at once.
pub(super) trait Lanes: Copy {
    /// Eight numbers.
    type Eight: Copy;

    fn splat(self, x: f32) -> Self::Eight;
    fn load(self, x: &[f32; 8]) -> Self::Eight;
    fn store(self, x: Self::Eight) -> [f32; 8];
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// a b + c, rounded once or twice.
    fn mul_add(self, a: Self::Eight, b: Self::Eight, c: Self::Eight) -> Self::Eight;
    /// c - a b, rounded once or twice.
    fn sub_mul(self, c: Self::Eight, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn abs(self, a: Self::Eight) -> Self::Eight;
    /// A bit for each lane where a is greater than b; none where either is no number.
    fn greater(self, a: Self::Eight, b: Self::Eight) -> u32;
    /// A bit for each lane where a is at least b; none where either is no number.
    fn at_least(self, a: Self::Eight, b: Self::Eight) -> u32;
}

/// What can be computed with lanes of either kind. An implementation should be `#[inline(always)]`: only what becomes part of
/// the caller is compiled for the processor's instructions.
pub(super) trait Task {
    type Answer;

    fn run<L: Lanes>(self, lanes: L) -> Self::Answer;
}

/// The instructions to use.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// What every processor has.
    Plain,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    V3(pulp::x86::V3),
}

impl Default for Level {
    fn default() -> Self {
        Self::best()
    }
}

impl Level {
    /// The best that this processor has.
    pub(super) fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = pulp::x86::V3::try_new() {
            return Self::V3(v3);
        }
        Self::Plain
    }

    /// Runs a task.
    #[inline(always)]
    pub(super) fn run<T: Task>(self, task: T) -> T::Answer {
        match self {
            Self::Plain => task.run(Plain),
            #[cfg(target_arch = "x86_64")]
            Self::V3(v3) => v3.vectorize(OnV3 { v3, task }),
        }
    }
}

#[cfg(target_arch = "x86_64")]
struct OnV3<T> {
    v3: pulp::x86::V3,
    task: T,
}

#[cfg(target_arch = "x86_64")]
impl<T: Task> NullaryFnOnce for OnV3<T> {
    type Output = T::Answer;

    #[inline(always)]
    fn call(self) -> T::Answer {
        self.task.run(self.v3)
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for pulp::x86::V3 {
    type Eight = pulp::f32x8;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::Eight {
        self.splat_f32x8(x)
    }

    #[inline(always)]
    fn load(self, x: &[f32; 8]) -> Self::Eight {
        pulp::cast(*x)
    }

    #[inline(always)]
    fn store(self, x: Self::Eight) -> [f32; 8] {
        pulp::cast(x)
    }

    #[inline(always)]
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.add_f32x8(a, b)
    }

    #[inline(always)]
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.sub_f32x8(a, b)
    }

    #[inline(always)]
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.mul_f32x8(a, b)
    }

    #[inline(always)]
    fn mul_add(self, a: Self::Eight, b: Self::Eight, c: Self::Eight) -> Self::Eight {
        self.mul_add_f32x8(a, b, c)
    }

    #[inline(always)]
    fn sub_mul(self, c: Self::Eight, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.negate_mul_add_f32x8(a, b, c)
    }

    #[inline(always)]
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.min_f32x8(a, b)
    }

    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.max_f32x8(a, b)
    }

    #[inline(always)]
    fn abs(self, a: Self::Eight) -> Self::Eight {
        self.abs_f32x8(a)
    }

    #[inline(always)]
    fn greater(self, a: Self::Eight, b: Self::Eight) -> u32 {
        self.avx._mm256_movemask_ps(pulp::cast(self.cmp_gt_f32x8(a, b))).cast_unsigned()
    }

    #[inline(always)]
    fn at_least(self, a: Self::Eight, b: Self::Eight) -> u32 {
        self.avx._mm256_movemask_ps(pulp::cast(self.cmp_ge_f32x8(a, b))).cast_unsigned()
    }
}

/// Two vectors of four.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain;

impl Lanes for Plain {
    type Eight = [Vec4; 2];

    #[inline(always)]
    fn splat(self, x: f32) -> Self::Eight {
        [Vec4::splat(x); 2]
    }

    #[inline(always)]
    fn load(self, x: &[f32; 8]) -> Self::Eight {
        [Vec4::from_slice(&x[..4]), Vec4::from_slice(&x[4..])]
    }

    #[inline(always)]
    fn store(self, [low, high]: Self::Eight) -> [f32; 8] {
        let ([a, b, c, d], [e, f, g, h]) = (low.to_array(), high.to_array());
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0] + b[0], a[1] + b[1]]
    }

    #[inline(always)]
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0] - b[0], a[1] - b[1]]
    }

    #[inline(always)]
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0] * b[0], a[1] * b[1]]
    }

    #[inline(always)]
    fn mul_add(self, a: Self::Eight, b: Self::Eight, c: Self::Eight) -> Self::Eight {
        self.add(self.mul(a, b), c)
    }

    #[inline(always)]
    fn sub_mul(self, c: Self::Eight, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.sub(c, self.mul(a, b))
    }

    #[inline(always)]
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0].min(b[0]), a[1].min(b[1])]
    }

    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0].max(b[0]), a[1].max(b[1])]
    }

    #[inline(always)]
    fn abs(self, a: Self::Eight) -> Self::Eight {
        [a[0].abs(), a[1].abs()]
    }

    #[inline(always)]
    fn greater(self, a: Self::Eight, b: Self::Eight) -> u32 {
        a[0].cmpgt(b[0]).bitmask() | a[1].cmpgt(b[1]).bitmask() << 4
    }

    #[inline(always)]
    fn at_least(self, a: Self::Eight, b: Self::Eight) -> u32 {
        a[0].cmpge(b[0]).bitmask() | a[1].cmpge(b[1]).bitmask() << 4
    }
}
