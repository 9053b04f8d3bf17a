//! Profiles on disk: what is read back, what is refused, runs that store at the same time.

use std::fs;

use renderer::component::{Component, PerComponent};
use renderer::schedule::{Cost, PictureCosts, Place, ProfileCache, ProfileError, RayKind};

fn learn(profile: &mut ProfileCache, rays: u64) {
    let spawned = PerComponent::from_fn(|component| rays / (1 + component as u64));
    profile.observe(RayKind::Primary, rays, rays as f64 * 1e-6);
    profile.observe(RayKind::Of(Component::Diffuse), rays, rays as f64 * 3e-6 + 1e-3);
    profile.observe_children("D", RayKind::Primary, rays, &spawned);
    profile.observe_children("T", RayKind::Of(Component::Diffuse), 2 * rays, &spawned);
    let mut costs = PictureCosts::new(profile, "T");
    let mut sprinkled = Cost::default();
    sprinkled.observe(100, 4e-4);
    costs.sprinkled(second(), &sprinkled);
    costs.ran(second(), rays, rays as f64 * 5e-6);
    let prediction = profile.predict(RayKind::Primary, 1000).expect("known");
    profile.record(&prediction, prediction.mean_s * 1.5);
}

/// The second run of a T.
fn second() -> Place {
    Place::new(Component::Transmitted, 0, 2)
}

#[test]
fn what_is_stored_is_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    let mut profile = ProfileCache::load(&path, "scene", "machine").expect("no file yet");
    assert_eq!(profile, ProfileCache::new("scene", "machine"));
    learn(&mut profile, 1000);
    learn(&mut profile, 70_000);
    profile.save(&path).expect("stored");
    let again = ProfileCache::load(&path, "scene", "machine").expect("read");
    for kind in RayKind::ALL {
        match (profile.cost(kind), again.cost(kind)) {
            (Some(one), Some(other)) => {
                assert_eq!((one.rays(), one.observations()), (other.rays(), other.observations()));
                assert_eq!(one.mean_s(), other.mean_s());
                assert!((one.spread_s() - other.spread_s()).abs() <= 1e-9 * one.spread_s());
            }
            (one, other) => assert_eq!(one, other),
        }
    }
    assert_eq!(again.calibration(), profile.calibration());
    let children = |profile: &ProfileCache| {
        let of = |(paths, family): (&str, _)| (paths.to_owned(), Vec::from_iter(family));
        format!("{:?}", Vec::from_iter(profile.children().map(of)))
    };
    assert_eq!(children(&again), children(&profile));
    assert_eq!((again.paths_seen("D"), again.paths_seen("T"), again.paths_seen("TD")), (71_000, 0, 0));
    assert_eq!(again.children_per_ray("T", RayKind::Of(Component::Diffuse), Component::Diffuse), 0.5);
    let place = |profile: &ProfileCache| {
        let known = *profile.place("T", second()).expect("learnt");
        assert!(profile.place("TT", second()).is_none() && profile.place("T", Place::PRIMARY).is_none());
        [known.rays, known.pace].map(|cost| (cost.rays(), cost.observations(), cost.mean_s().to_bits()))
    };
    assert_eq!(place(&again), place(&profile));
    assert_eq!(place(&again)[0].0, 71_000);
    // Stored again without news it says the same.
    let before = fs::read_to_string(&path).expect("text");
    ProfileCache::load(&path, "scene", "machine").expect("read").save(&path).expect("stored");
    let (before, after): (serde_json::Value, serde_json::Value) = (
        serde_json::from_str(&before).expect("JSON"),
        serde_json::from_str(&fs::read_to_string(&path).expect("text")).expect("JSON"),
    );
    assert_eq!(before["rays"]["D"]["rays"], after["rays"]["D"]["rays"]);
    assert_eq!(before["errors"], after["errors"]);
}

#[test]
fn runs_without_rays_leave_no_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    let mut profile = ProfileCache::new("scene", "machine");
    learn(&mut profile, 1000);
    let mut costs = PictureCosts::new(&mut profile, "T");
    let third = Place::new(Component::Transmitted, 0, 3);
    for (rays, seconds) in [(0, 1e-6), (5, -1.0), (5, f64::NAN), (5, f64::INFINITY)] {
        costs.ran(third, rays, seconds);
    }
    profile.save(&path).expect("stored");
    let again = ProfileCache::load(&path, "scene", "machine").expect("what was stored is a profile");
    assert!(again.place("T", third).is_none() && again.place("T", second()).is_some());
}

#[test]
fn another_scene_or_machine_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    let mut profile = ProfileCache::new("scene", "machine");
    learn(&mut profile, 1000);
    profile.save(&path).expect("stored");
    let before = fs::read(&path).expect("bytes");
    for (scene, machine, what) in [("other", "machine", "scene"), ("scene", "other", "machine")] {
        let error = ProfileCache::load(&path, scene, machine).expect_err("another's");
        assert!(matches!(&error, ProfileError::Other { what: found, .. } if *found == what), "{error}");
        assert!(error.to_string().contains("other"), "{error}");
        let mut stranger = ProfileCache::new(scene, machine);
        learn(&mut stranger, 5);
        stranger.save(&path).expect_err("another's");
    }
    assert_eq!(fs::read(&path).expect("bytes"), before);
}

#[test]
fn what_is_no_profile_is_refused_by_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    let head =
        "{\"format\": \"crex profile 3\", \"scene\": \"scene\", \"machine\": \"machine\", \"errors\": [],\n\"rays\": {";
    let cost = |mean: &str| {
        format!("{{\"rays\": 5, \"observations\": 1, \"effective\": 1, \"mean_s\": {mean}, \"spread_s\": 0}}")
    };
    for (text, line) in [
        (String::new(), 1),
        ("[]".to_owned(), 1),
        (format!("{head}\n\"D\": {}}}}}", cost("-1")), 3),
        (format!("{head}\n\n\"Q\": {}}}}}", cost("1")), 4),
        (format!("{head}\n\"D\": {}}}}}", cost("1e999")), 3),
        (format!("{head}\n\"D\": {}}}}}", cost("1").replace("\"spread_s\": 0", "\"spread_s\": 1e200")), 3),
        (format!("{head}\n\"D\": {{}}}}}}"), 3),
        (format!("{head}}},\n\"places\": {{\"D\": {{\n\"D@0 run 0\": {{\"rays\": {}}}}}}}}}", cost("1")), 4),
        (format!("{head}}},\n\"places\": {{\"D\": {{\n\"D@0 run 1\": {{\"rays\": {}}}}}}}}}", cost("-1")), 4),
        (format!("{head}}},\n\"children\": {{\"D\": {{\n\"Q\": {{\"parents\": 1, \"spawned\": {{}}}}}}}}}}"), 4),
        (format!("{head}}},\n\"children\": {{\"D\": {{\"D\": {{\"parents\": 1, \"spawned\":\n{{\"Q\": 1}}}}}}}}}}"), 4),
    ] {
        fs::write(&path, &text).expect("written");
        let error = ProfileCache::load(&path, "scene", "machine").expect_err("no profile");
        assert!(matches!(error, ProfileError::Broken { line: found, .. } if found == line), "{text}: {error}");
    }
    fs::write(&path, format!("{head}\n\"D\": {}}}}}", cost("1"))).expect("written");
    ProfileCache::load(&path, "scene", "machine").expect("a profile");
    // What an earlier program stored has other numbers in it.
    let earlier = fs::read_to_string(&path).expect("text").replace("crex profile 3", "crex profile 2");
    fs::write(&path, earlier).expect("written");
    let error = ProfileCache::load(&path, "scene", "machine").expect_err("another format");
    assert!(error.to_string().contains("format \"crex profile 2\", not \"crex profile 3\""), "{error}");
}

#[test]
fn runs_that_store_at_the_same_time_lose_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    const RUNS: u64 = 8;
    const FRAMES: u64 = 5;
    std::thread::scope(|scope| {
        for _ in 0..RUNS {
            scope.spawn(|| {
                let mut profile = ProfileCache::load(&path, "scene", "machine").expect("read");
                for _ in 0..FRAMES {
                    learn(&mut profile, 1000);
                    profile.save(&path).expect("stored");
                }
            });
        }
    });
    let profile = ProfileCache::load(&path, "scene", "machine").expect("read");
    let cost = profile.cost(RayKind::Primary).expect("learnt");
    assert_eq!((cost.rays(), cost.observations()), (RUNS * FRAMES * 1000, RUNS * FRAMES));
    assert!((cost.mean_s() - 1e-6).abs() < 1e-15);
    assert_eq!(profile.calibration().errors().count() as u64, RUNS * FRAMES);
    assert_eq!(profile.paths_seen("D"), RUNS * FRAMES * 1000);
    assert_eq!(profile.place("T", second()).map(|known| known.rays.rays()), Some(RUNS * FRAMES * 1000));
}

#[test]
fn a_run_that_died_while_storing_harms_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.json");
    let mut profile = ProfileCache::new("scene", "machine");
    learn(&mut profile, 1000);
    profile.save(&path).expect("stored");
    // What a run killed in the middle leaves: half a file beside it, and a lock that nobody holds.
    fs::write(folder.path().join(".profile.json.1.part"), "{\"format\": \"cr").expect("written");
    fs::write(folder.path().join("profile.json.lock"), "").expect("written");
    learn(&mut profile, 1000);
    profile.save(&path).expect("stored");
    let cost_rays =
        ProfileCache::load(&path, "scene", "machine").expect("read").cost(RayKind::Primary).map(|c| c.rays());
    assert_eq!(cost_rays, Some(2000));
}
