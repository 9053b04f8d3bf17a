//! Estimates of whole crexes against trees whose counts are known in closed form.

use renderer::component::{Component, PerComponent};
use renderer::crex::compile;
use renderer::schedule::{Estimate, ProfileCache, RayKind, estimate};

/// A primary ray spawns one ray of each component, every other ray `children` rays of each on average; a ray takes a
/// microsecond.
fn profile(children: f64) -> ProfileCache {
    let mut profile = ProfileCache::new("scene", "machine");
    let rays = 1_000_000;
    for kind in RayKind::ALL {
        let rate = if kind == RayKind::Primary { 1.0 } else { children };
        let spawned = PerComponent::from_fn(|_| (rays as f64 * rate) as u64);
        profile.observe(kind, rays, 1.0);
        profile.observe_children("paths", kind, rays, &spawned);
    }
    profile
}

fn estimated(crex: &str, share: impl Fn(f32) -> f64, profile: &ProfileCache) -> Estimate {
    estimate(&compile(crex).expect(crex), None, 1000, share, (profile, "paths")).expect("own thresholds")
}

fn rays(estimate: &Estimate, component: Component) -> f64 {
    estimate.components[component].rays
}

#[test]
fn runs_follow_the_geometric_series() {
    let profile = profile(0.5);
    let all = |_| 1.0;
    // T2: 1000 + 500. T*: up to 2000, but for the tail below half a ray.
    assert_eq!(rays(&estimated("T2", all, &profile), Component::Transmitted), 1500.0);
    let star = estimated("T*", all, &profile);
    assert!((rays(&star, Component::Transmitted) - 2000.0).abs() < 2.0 && !star.endless);
    // <TR>T: T and R of the primary hits, then the T of both.
    let held = estimated("<TR>T", all, &profile);
    assert_eq!((rays(&held, Component::Transmitted), rays(&held, Component::Reflected)), (2000.0, 1000.0));
    // TR: R also runs what T spawned.
    assert_eq!(rays(&estimated("TR", all, &profile), Component::Reflected), 1500.0);
}

#[test]
fn seconds_add_up() {
    let estimate = estimated("TD", |_| 1.0, &profile(0.5));
    assert!((estimate.primary.seconds.mean_s - 1e-3).abs() < 1e-12);
    assert!((estimate.total.seconds.mean_s - (1000.0 + 1000.0 + 1500.0) * 1e-6).abs() < 1e-12);
    assert_eq!(estimate.total.rays, 3500.0);
    assert!(estimate.total.bound_s > estimate.total.seconds.mean_s);
}

#[test]
fn braces_count_the_pixels_that_reach_them() {
    // Importance spread evenly over [0, 1]: two thirds reach 1/3, one third reaches 2/3.
    let even = |threshold: f32| 1.0 - f64::from(threshold);
    let estimate = estimated("{TR}T", even, &profile(0.5));
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-3, "{found} {expected}");
    // R: its own on a third, and what T spawned there. Then T: the third below, and the children of both.
    close(rays(&estimate, Component::Reflected), 1000.0 / 3.0 * 1.5);
    close(rays(&estimate, Component::Transmitted), 1000.0 + 0.5 * 2000.0 / 3.0 + 0.5 * 500.0);
}

#[test]
fn what_is_unknown_or_endless_is_said() {
    let mut primary_only = ProfileCache::new("scene", "machine");
    primary_only.observe(RayKind::Primary, 10, 1.0);
    let spawned = PerComponent::from_fn(|c| u64::from(c == Component::Glossy));
    primary_only.observe_children("paths", RayKind::Primary, 10, &spawned);
    let estimate = estimated("GD", |_| 1.0, &primary_only);
    assert!(estimate.unknown[Component::Glossy], "100 rays of unknown cost");
    assert!(!estimate.unknown[Component::Diffuse], "no ray, no cost");
    assert!(estimated("(TRSGMD)*", |_| 1.0, &profile(0.5)).endless, "three children a ray");
    assert!(estimated("T*", |_| 1.0, &profile(1.0)).endless, "one child a ray, for ever");
}
