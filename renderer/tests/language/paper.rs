//! Every crex of the paper's text, tables and figures.
//!
//! The scene: one primary ray, every hit spawns one ray of each of the six components, words have at most two letters.
//! So a run of X traces the X ray of the primary hit, if it still waits, and one for every single-letter word traced
//! before whose X still waits. The counts are worked out by hand from that; over k letters a `( )*` must come to
//! k + k^2 rays.

use renderer::crex::parse;

use crate::scene::{Scene, run};

/// Where it stands, the crex, its canonical text, its stages with the rays that each traces.
const CREXES: &[(&str, &str, &str, &str)] = &[
    ("3.2", "(DGS)G", "(DGS)G", "D1 G2 S3 G2"),
    ("3.2", "<DGS>G", "<DGS>G", "D1 G1 S1 G3"),
    ("3.4, Fig. 2 left", "T*", "T*", "T1 T1 T0"),
    ("Fig. 2 middle-left", "(TRS)*", "(TRS)*", "T1 R2 S3 T3 R2 S1 T0 R0 S0"),
    ("Fig. 2 middle-right", "(TD)*", "(TD)*", "T1 D2 T2 D1 T0 D0"),
    ("Fig. 2 right", "(TRSGD)*", "(TRSGD)*", "T1 R2 S3 G4 D5 T5 R4 S3 G2 D1 T0 R0 S0 G0 D0"),
    ("3.4", "<MRSGD>", "<MRSGD>", "M1 R1 S1 G1 D1"),
    ("Fig. 3 left", "<MRSGD>T*", "<MRSGD>T*", "M1 R1 S1 G1 D1 T6 T1 T0"),
    ("Fig. 3 middle", "(<MRSGD>T*)2", "(<MRSGD>T*)2", "M1 R1 S1 G1 D1 T6 T1 T0 M6 R6 S6 G6 D6 T0"),
    ("Fig. 3 right", "(<MRSGD>T*)*", "(<MRSGD>T*)*", "M1 R1 S1 G1 D1 T6 T1 T0 M6 R6 S6 G6 D6 T0 M0 R0 S0 G0 D0 T0"),
    ("4.2, Fig. 5", "T{RSGM}", "T{RSGM}", "T1 R2 S3 G4 M5"),
    ("5.3, Fig. 6 left", "(TTMRGD)*", "(TTMRGD)*", "T1 T1 M2 R3 G4 D5 T4 T0 M4 R3 G2 D1 T0 T0 M0 R0 G0 D0"),
    ("5.3", "TTMRGD", "TTMRGD", "T1 T1 M2 R3 G4 D5"),
    ("5.3", "TTMRG", "TTMRG", "T1 T1 M2 R3 G4"),
    ("Fig. 6 middle", "(TTMRG)*", "(TTMRG)*", "T1 T1 M2 R3 G4 T3 T0 M3 R2 G1 T0 T0 M0 R0 G0"),
    ("Fig. 6 right, Fig. 8 middle", "TTM", "TTM", "T1 T1 M2"),
    ("5.3, Fig. 7", "(TT[RS]G)*D", "(TT[RS]G)*D", "T1 T1 R2 S2 G4 T3 T0 R3 S3 G1 T0 T0 R0 S0 G0 D5"),
    ("Fig. 7 left", "(TT[RS]G)*", "(TT[RS]G)*", "T1 T1 R2 S2 G4 T3 T0 R3 S3 G1 T0 T0 R0 S0 G0"),
    ("Fig. 7 middle", "TT[RS]", "TT[RS]", "T1 T1 R2 S2"),
    ("Fig. 7 right", "TT", "TT", "T1 T1"),
    ("5.3", "TTMRS GD", "TTMRSGD", "T1 T1 M2 R3 S4 G5 D6"),
    ("Fig. 8 left", "TTMRSGD", "TTMRSGD", "T1 T1 M2 R3 S4 G5 D6"),
    ("Fig. 8 right, primary rays only", "", "", ""),
    ("Table 1", "( D )", "(D)", "D1"),
    ("Table 1", "< S >", "<S>", "S1"),
    ("Table 1", "{ G }", "{G}", "G1"),
    ("Table 1", "[ T ]", "[T]", "T1"),
    ("Table 1", "R 3", "R3", "R1 R1 R0"),
    ("Table 1", "M *", "M*", "M1 M1 M0"),
    ("Table 2", "(<TR>2{S}[GD]M10)*", "(<TR>2{S}[GD]M10)*", FULL),
];

/// Table 2 in one crex: T and R see each other's rays in their second run; S those of T and R in both runs; and so on.
const FULL: &str = "T1 R1 T2 R2 S3 G4 D4 M6 M1 M0 M0 M0 M0 M0 M0 M0 M0 \
                    T4 R4 T0 R0 S4 G3 D3 M0 M0 M0 M0 M0 M0 M0 M0 M0 M0 \
                    T0 R0 T0 R0 S0 G0 D0 M0 M0 M0 M0 M0 M0 M0 M0 M0 M0";

#[test]
fn every_crex_of_the_paper_runs_as_worked_out_by_hand() {
    let scene = Scene::each(2);
    for &(place, crex, canonical, counts) in CREXES {
        let ast = parse(crex).unwrap_or_else(|errors| panic!("{place}: {crex}: {errors:?}"));
        assert_eq!(ast.to_string(), canonical, "{place}");
        assert_eq!(run(crex, &scene).counts(), counts, "{place}: {crex}");
    }
}

#[test]
fn the_equivalents_that_the_paper_names_run_the_same_rays() {
    // Fig. 6: what ran of the full crex under each bound is a beginning of it.
    let scene = Scene::each(3);
    for (full, part) in [("(TTMRGD)*", "TTMRG"), ("(TTMRGD)*", "TTM"), ("(TT[RS]G)*D", "TT[RS]"), ("TTMRSGD", "TTM")] {
        let (full, part) = (run(full, &scene).counts(), run(part, &scene).counts());
        assert!(full.starts_with(&part), "{part} does not begin {full}");
    }
}
