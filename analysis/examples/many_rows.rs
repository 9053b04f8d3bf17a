//! Writes a log of simulated observers to standard output, as long as is asked for, to time the report with:
//!
//! ```text
//! cargo run --release -p analysis --example many_rows -- 1000000 > many.csv
//! time crex-report many.csv -o many.html
//! ```
//!
//! Sessions have four rows: practice, critical, informed, and the obvious pair. Everybody guesses but for that pair.

use std::io::{BufWriter, Write};

use analysis::trial_log::{Interval, OnsetSource, Phase, Trial, header_line, row_line};

fn main() -> std::io::Result<()> {
    let rows: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1_000_000);
    let mut out = BufWriter::new(std::io::stdout().lock());
    out.write_all(header_line().as_bytes())?;
    for i in 0..rows {
        out.write_all(row_line(&trial(i / 4, (i % 4) as u32)).as_bytes())?;
    }
    out.flush()
}

/// A number without pattern from another (Steele, Lea and Flood 2014).
fn mixed(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn trial(session: u64, at: u32) -> Trial {
    let phase = [Phase::Practice, Phase::Critical, Phase::Informed, Phase::Check][at as usize];
    let draw = mixed(4 * session + u64::from(at));
    let lower = if (session / 2).is_multiple_of(2) { Interval::Second } else { Interval::First };
    let told = phase == Phase::Check || draw & 1 == 0;
    let asked = phase != Phase::Practice;
    let told_arm = session.is_multiple_of(2);
    let counted = |true_count: u32, by: u32| Some(true_count - (draw >> by & 1) as u32);
    let quality = |here: Interval| if asked && told_arm && here == lower { "CBQ" } else { "HQ" };
    Trial {
        study: "many".into(),
        session_id: format!("s{session:07}"),
        participant: format!("p{session:07}"),
        arm: if told_arm { "HQ/CBQ" } else { "HQ/HQ" }.into(),
        simulated: true,
        phase,
        trial: at + 1,
        first_stimulus: format!("a_{}", quality(Interval::First)),
        second_stimulus: format!("b_{}", quality(Interval::Second)),
        first_layout: "a".into(),
        second_layout: "b".into(),
        first_quality: quality(Interval::First).into(),
        second_quality: quality(Interval::Second).into(),
        first_count: Some(11),
        second_count: Some(9),
        first_count_answer: counted(11, 1),
        second_count_answer: counted(9, 2),
        worse_answer: asked.then_some(if told { lower } else { lower.other() }),
        correct: (asked && told_arm).then_some(told),
        confidence: asked.then_some(1 + (draw >> 3 & 3) as u8),
        rt_s: asked.then_some(1.0 + (draw >> 8 & 1023) as f64 / 512.0),
        first_onset_s: Some(30.0 + 20.0 * f64::from(at)),
        first_duration_s: Some(6.0 + (draw >> 20 & 255) as f64 * 1e-5),
        second_onset_s: Some(37.0 + 20.0 * f64::from(at)),
        second_duration_s: Some(6.0 + (draw >> 30 & 255) as f64 * 1e-5),
        onset_source: OnsetSource::Estimated,
        known_task: (phase == Phase::Check).then_some(draw >> 40 & 31 == 0),
        seed: session,
        plan_hash: "ab".repeat(32),
        stimuli_hash: "01".repeat(32),
        version: env!("CARGO_PKG_VERSION").into(),
        started_utc: "2005-11-29T09:30:00Z".into(),
        ..Trial::default()
    }
}
