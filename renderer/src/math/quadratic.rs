//! Real roots of quadratic equations without cancellation.

/// The real roots of `a` t^2 + 2 `half_b` t + `c` = 0 in ascending order; a missing root is NaN.
///
/// Neither root loses digits by subtraction of nearly equal terms: the larger comes from the sum of like signs, the other from
/// their product `c / a` (Press et al., Numerical Recipes, 5.6). `a` = 0 gives the one root of the linear equation.
#[must_use]
pub fn roots(a: f64, half_b: f64, c: f64) -> [f64; 2] {
    let discriminant = half_b * half_b - a * c;
    if discriminant < 0.0 || !discriminant.is_finite() {
        return [f64::NAN; 2];
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    if q == 0.0 {
        // half_b = 0 and a c = 0: t^2 = 0, or nothing that depends on t.
        return if a == 0.0 { [f64::NAN; 2] } else { [0.0, 0.0] };
    }
    let far = q / a;
    let near = c / q;
    if !far.is_finite() {
        return [near, f64::NAN];
    }
    if near <= far { [near, far] } else { [far, near] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn small_roots_keep_their_digits() {
        // (t - 1e-9)(t - 1e9): the textbook formula loses the small root altogether.
        let [near, far] = roots(1.0, -(1e9 + 1e-9) / 2.0, 1.0);
        assert!((near / 1e-9 - 1.0).abs() < 1e-15, "{near}");
        assert!((far / 1e9 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn degenerate_equations() {
        assert_eq!(roots(0.0, 1.0, -4.0)[0], 2.0);
        assert!(roots(0.0, 1.0, -4.0)[1].is_nan());
        assert!(roots(1.0, 0.0, 1.0)[0].is_nan());
        assert!(roots(0.0, 0.0, 0.0)[0].is_nan());
        assert!(roots(0.0, 0.0, 3.0)[0].is_nan());
        assert_eq!(roots(2.0, 0.0, 0.0), [0.0, 0.0]);
        assert!(roots(f64::MAX, f64::MAX, f64::MAX)[0].is_nan());
    }

    proptest! {
        #[test]
        fn roots_are_found_at_all_scales(x in -1.0..1.0_f64, y in -1.0..1.0_f64, e in -12..12_i32, a in prop_oneof![0.1..10.0_f64, -10.0..-0.1_f64]) {
            let (x, y) = (x, y * 10_f64.powi(e));
            let [near, far] = roots(a, -a * (x + y) / 2.0, a * x * y);
            let size = x.abs().max(y.abs());
            if (x - y).abs() > 1e-6 * size {
                prop_assert!((near - x.min(y)).abs() <= 1e-9 * size);
                prop_assert!((far - x.max(y)).abs() <= 1e-9 * size);
            }
        }
    }
}
