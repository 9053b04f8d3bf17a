//! Every rule of the language's execution table, and every case that tells its forms apart, as ray counts.
//!
//! Counts are worked out by hand as `paper.rs` says: on `Scene::each(n)` every hit spawns one ray of each component and
//! words have at most n letters.

use renderer::component::Component;
use renderer::crex::{STAR_LIMIT, compile};
use renderer::work::Work;

use crate::scene::{Scene, Spawning, execute, run};

fn assert_counts(scene: &Scene, cases: &[(&str, &str)]) {
    for &(crex, counts) in cases {
        assert_eq!(run(crex, scene).counts(), counts, "{crex}");
    }
}

/// Sorted rays, to compare what two crexes trace whatever the order.
fn assert_same_rays(one: &str, other: &str, scene: &Scene) {
    assert_eq!(run(one, scene).sorted(), run(other, scene).sorted(), "{one} against {other}");
}

#[test]
fn parentheses_inherit_and_angles_hold() {
    assert_counts(
        &Scene::each(2),
        &[
            ("DG", "D1 G2"),
            ("(DG)", "D1 G2"),
            ("(DG)G", "D1 G2 G1"),
            ("<DG>G", "D1 G1 G2"),
            ("<DGG>", "D1 G1 G0"),
            ("<DD>", "D1 D0"),
            ("<DD>D", "D1 D0 D1"),
        ],
    );
}

#[test]
fn the_first_g_also_runs_what_d_spawned_or_leaves_it_to_the_last() {
    // (DG)G: the first G traces both G and DG. <DG>G: the last one traces DG and GG.
    let inherit = run("(DG)G", &Scene::each(2));
    let hold = run("<DG>G", &Scene::each(2));
    assert_eq!(inherit.words(), hold.words(), "in the end both have traced D, G, DG and GG");
    assert_eq!(inherit.rows[1].report.rays, 2);
    assert_eq!(hold.rows[1].report.rays, 1);
    // A third bounce tells them apart for good: G runs DGG only after DG has run.
    let inherit = run("(DG)G", &Scene::each(3));
    let hold = run("<DG>G", &Scene::each(3));
    assert!(inherit.words().contains_key("DGG"));
    assert!(!hold.words().contains_key("DGG"));
}

#[test]
fn nothing_spawned_inside_is_visible_before_the_outermost_group_ends() {
    for length in 1..=3 {
        let scene = Scene::each(length);
        for (one, other) in [
            ("<(DG)G>", "<DGG>"),
            ("<(TR)*>", "<TR>"),
            ("<<TR>T>", "<TRT>"),
            ("<[TR]T>", "<TRT>"),
            ("[<TR>T]", "[TRT]"),
            ("[(TR)3T]", "[TRT]"),
            ("[D3]", "<D>"),
            ("<D2>", "<D>"),
            ("<{TR}T>", "<TRT>"),
        ] {
            assert_same_rays(one, other, &scene);
        }
    }
    assert_counts(&Scene::each(2), &[("<(DG)G>", "D1 G1 G0"), ("<(TR)*>", "T1 R1 T0 R0"), ("[D3]", "D1 D0 D0")]);
}

#[test]
fn multipliers_repeat_the_item_before_them() {
    assert_counts(
        &Scene::each(3),
        &[
            ("D1", "D1"),
            ("D2", "D1 D1"),
            ("<D>2", "D1 D1"),
            ("<D2>", "D1 D0"),
            ("D 2 2", "D1 D1 D1 D0"),
            ("T007", "T1 T1 T1 T0 T0 T0 T0"),
            ("T12", "T1 T1 T1 T0 T0 T0 T0 T0 T0 T0 T0 T0"),
            ("TD2", "T1 D2 D2"),
            ("(TD)2", "T1 D2 T3 D4"),
            ("T*", "T1 T1 T1 T0"),
            ("T2*", "T1 T1 T1 T0 T0 T0"),
            ("T*2", "T1 T1 T1 T0 T0"),
            ("T**", "T1 T1 T1 T0 T0"),
        ],
    );
}

#[test]
fn brackets_without_a_time_limit_are_angles() {
    for length in 1..=3 {
        let scene = Scene::each(length);
        for (one, other) in
            [("TT[RS]G", "TT<RS>G"), ("[RS]3", "<RS>3"), ("([RS]T)*", "(<RS>T)*"), ("[R(ST)2]", "<R(ST)2>")]
        {
            assert_eq!(run(one, &scene).counts(), run(other, &scene).counts(), "{one} against {other}");
            assert_same_rays(one, other, &scene);
        }
    }
}

#[test]
fn a_star_on_panes_ends_with_the_deepest_stack() {
    // Panes that only transmit: the stack is as deep as the longest word.
    let panes = Scene { importance: vec![1.0], spawning: Spawning::Each { length: 5 } };
    assert_eq!(run("T*", &panes).counts(), "T1 T1 T1 T1 T1 T0");
}

#[test]
fn a_star_that_never_ends_stops_after_a_million_runs() {
    let scene = Scene { importance: vec![1.0], spawning: Spawning::Endless(Component::Transmitted) };
    for (crex, runs) in [("T*", 1), ("(T*)*", 1), ("(T*D)*R3", 2)] {
        let program = compile(crex).expect("a crex");
        let mut cursor = renderer::crex::Cursor::new(&program);
        let mut letters = [0u64; 6];
        while let Some(work) = cursor.next() {
            if let Work::Run(stage) = work {
                letters[stage.component as usize] += 1;
                cursor.report(u64::from(stage.component == Component::Transmitted));
            }
        }
        assert_eq!(letters[Component::Transmitted as usize], u64::from(STAR_LIMIT), "{crex}");
        assert_eq!(letters[Component::Diffuse as usize], u64::from(runs == 2), "{crex}");
        // What follows the stopped star and the repeats around it runs as ever.
        assert_eq!(letters[Component::Reflected as usize], if runs == 2 { 3 } else { 0 }, "{crex}");
        let stopped: Vec<_> = cursor.stopped().iter().map(|span| span.start).collect();
        assert_eq!(stopped, [crex.find('*').expect("a star")], "{crex}");
    }
    assert_eq!(run("D*", &scene).stopped, 0);
}

/// Pixels of importance 0, .1, .. 1; every hit spawns one ray of each component.
fn ramp(length: usize) -> Scene {
    Scene { importance: (0..=10u8).map(|i| f32::from(i) / 10.0).collect(), spawning: Spawning::Each { length } }
}

#[test]
fn members_of_braces_need_their_threshold() {
    // T{RSGM}: .2, .4, .6, .8 of importance: 9, 7, 5 and 3 of the 11 pixels.
    assert_counts(
        &ramp(1),
        &[("T{RSGM}", "T11 R9 S7 G5 M3"), ("{T}", "T6"), ("{TR}", "T7 R4"), ("{(TR)S}", "T7 R7 S4")],
    );
    // An item with its multipliers is one member; groups in it share its threshold.
    assert_counts(&ramp(2), &[("{T2R}", "T7 T7 R8"), ("{<TT>R}", "T7 T0 R8"), ("{[TR]S}", "T7 R7 S12")]);
}

#[test]
fn half_the_map_at_nothing_halves_the_braces_alone() {
    let scene = Scene { importance: vec![0.0, 1.0, 0.0, 1.0], spawning: Spawning::Each { length: 2 } };
    // As T R2 S3 G4 M5 for a pixel, on two pixels of the four behind T.
    assert_counts(&scene, &[("T{RSGM}", "T4 R4 S6 G8 M10")]);
}

#[test]
fn rays_below_the_threshold_stay_and_remain_visible() {
    // {R} runs the R of 6 pixels; the R outside runs the other 5 pixels', and what R has spawned of R.
    assert_counts(&ramp(1), &[("{R}R", "R6 R5")]);
    assert_counts(&ramp(2), &[("{R}R", "R6 R11")]);
    assert_eq!(run("{R}", &ramp(1)).left[Component::Reflected], 5);
}

#[test]
fn a_star_around_braces_ends_although_rays_stay_below() {
    let execution = run("(T{RS})*", &ramp(3));
    assert!(execution.left[Component::Reflected] > 0, "pixels below the threshold keep their rays");
    let last = &execution.rows[execution.rows.len() - 3..];
    assert!(last.iter().all(|row| row.report.rays == 0), "the run that traced nothing ends it");
}

#[test]
fn given_thresholds_replace_the_spaced_ones_left_to_right() {
    let program = compile("{TR}M{S}").expect("a crex");
    assert_eq!(program.thresholds(), [1.0 / 3.0, 2.0 / 3.0, 0.5]);
    let scene = ramp(1);
    let execution = execute(&program, Some(&[0.0, 1.0, 0.85]), &scene, 0..11);
    assert_eq!(execution.counts(), "T11 R1 M11 S2");
    for wrong in [&[0.5, 0.5][..], &[0.5; 4], &[], &[0.1, 0.2, f32::NAN], &[-0.1, 0.2, 0.3], &[0.1, 0.2, 1.5]] {
        let error = renderer::schedule::Scheduler::new(&program, Some(wrong)).expect_err("wrong thresholds");
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn thresholds_meet_grey_codes_of_the_same_value() {
    // A pixel of code 51 of 255 has importance 1/5 and so reaches the first of four thresholds, although neither is
    // exact in binary.
    for n in 1..=60u16 {
        let crex = format!("{{{}}}", "T".repeat(n.into()));
        let program = compile(&crex).expect("a crex");
        for (i, &threshold) in (1u16..).zip(program.thresholds()) {
            let code = 255 * i / (n + 1);
            if code * (n + 1) == 255 * i {
                assert_eq!(f32::from(code) / 255.0, threshold, "{i} of {n}");
            }
        }
    }
}

#[test]
fn absent_components_run_and_trace_nothing() {
    let scene = Scene { importance: vec![1.0], spawning: Spawning::Endless(Component::Transmitted) };
    assert_counts(&scene, &[("TSM*D2", "T1 S0 M0 D0 D0")]);
}

#[test]
fn stages_say_where_they_stand() {
    let text = "T([R S]{G})2";
    let program = compile(text).expect("a crex");
    let execution = run(text, &Scene::each(2));
    let rows: Vec<_> = execution
        .rows
        .iter()
        .map(|row| {
            let stage = &row.stage;
            let letter = &text[stage.span.0..stage.span.1];
            assert_eq!(letter, stage.component.to_string());
            let group = stage.group.map(|group| program.group_text(group));
            (letter, stage.run, stage.held, group, stage.threshold)
        })
        .collect();
    let once = |run| {
        [
            ("R", run, true, Some("[R S]"), None),
            ("S", run, true, Some("[R S]"), None),
            ("G", run, false, None, Some(0.5)),
        ]
    };
    let expected: Vec<_> = [("T", 1, false, None, None)].into_iter().chain(once(1)).chain(once(2)).collect();
    assert_eq!(rows, expected);
    assert!(execution.rows.is_sorted_by(|a, b| a.stage.key < b.stage.key));
}

#[test]
fn huge_multipliers_cost_what_their_rays_cost() {
    let scene = Scene::each(3);
    for crex in [
        "T4294967295",
        "(T4294967295)4294967295",
        "((T4294967295R4294967295)4294967295S)4294967295",
        "<(TR4294967295)4294967295>4294967295",
        "[T4294967295]4294967295",
        "({RS4294967295}4294967295T)*",
    ] {
        let small = crex.replace("4294967295", "5");
        let (large, small) = (run(crex, &scene), run(&small, &scene));
        assert_eq!(large.sorted(), small.sorted(), "{crex}");
        // A run that traces anything may be followed by up to a thousand stages that do not, and no more.
        assert!(large.rows.len() <= 1000 * (large.traced.len() + 2), "{crex}: {} rows", large.rows.len());
    }
    for k in [1, 2, 3, 4, 999, 1000] {
        assert_eq!(run(&format!("T{k}"), &scene).rows.len(), k);
    }
    assert_eq!(run("T1001", &scene).rows.len(), 1000);
}

#[test]
fn a_deep_run_of_real_rays_is_never_cut() {
    let deep = Scene { importance: vec![1.0], spawning: Spawning::Endless(Component::Transmitted) };
    assert_eq!(run("T2500", &deep).rows.len(), 2500);
    assert_eq!(run("(T50)50", &deep).traced.len(), 2500);
}

#[test]
fn the_crex_that_an_execution_amounts_to_is_named() {
    let scene = Scene::each(2);
    for (crex, amounts_to) in [
        ("(TT[RS]G)*D", "T2<RS>GT<RS>GD"),
        ("(<MRSGD>T*)*", "<MRSGD>T2<MRSGD>"),
        ("T*", "T2"),
        ("<TT>3", "<T><T>"),
        ("T{RS2}", "T{R}{S2}"),
        ("", ""),
    ] {
        let program = compile(crex).expect("a crex");
        let executed = renderer::schedule::executed(&program, &run(crex, &scene).rows);
        assert_eq!(executed.crex, amounts_to, "{crex}");
    }
}
