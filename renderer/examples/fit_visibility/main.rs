//! Makes the table of coefficients in `renderer/src/propose/visibility.rs`.
//!
//! ```text
//! cargo run --release -p renderer --example fit_visibility -- measure SCENES.txt ROWS.csv    renders; takes a while
//! cargo run --release -p renderer --example fit_visibility -- fit ROWS.csv                   prints fits and their tests
//! ```
//!
//! A line of SCENES.txt is `group view-file ambient-r,g,b scene-file...`, files relative to its folder. Scenes of a group (two
//! layouts of one room) are left out together when a fit is tested. For every scene the rows are: direct light alone, each
//! component alone, each left out, one and two diffuse events. A row's predictors are those of the small profile, its loss is
//! what ColorVideoVDP finds between pictures 160 pixels wide with 16 samples and another seed, shown as wide as the paper's
//! display is.

mod least_squares;
mod measure;
mod predictors;
mod rows;

use std::path::Path;
use std::process::ExitCode;

use predictors::Predictors;
use renderer::propose::LEAST_LOSS_JOD;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["measure", scenes, rows] => measure::measure(Path::new(scenes), Path::new(rows)),
        ["fit", rows] => rows::read(Path::new(rows)).and_then(|rows| fit(&rows)),
        _ => Err("usage: fit_visibility measure SCENES.txt ROWS.csv | fit ROWS.csv".to_owned()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Fits every set of predictors and prints how well it does on scenes left out, the best first.
fn fit(rows: &[rows::Row]) -> Result<(), String> {
    let y: Vec<f64> = rows.iter().map(rows::Row::log_loss).collect();
    let losses: Vec<f64> = rows.iter().map(|row| row.loss_jod).collect();
    let groups: Vec<String> = rows.iter().map(|row| row.group.clone()).collect();
    let mut fits = Vec::new();
    for set in 1..1_u32 << Predictors::NAMES.len() {
        let x: Vec<Vec<f64>> = rows.iter().map(|row| row.logs(set)).collect();
        let (Some(coefficients), Some(predicted)) =
            (least_squares::fit(&x, &y), least_squares::left_out(&x, &y, &groups))
        else {
            continue;
        };
        let own: Vec<f64> = x.iter().map(|row| least_squares::apply(&coefficients, row)).collect();
        let jod = |logs: &[f64]| -> Vec<f64> {
            logs.iter().map(|log| (log.exp() - LEAST_LOSS_JOD).clamp(0.0, 9.0)).collect()
        };
        let error = (y.iter().zip(&predicted).map(|(y, p)| (y - p).powi(2)).sum::<f64>() / y.len() as f64).sqrt();
        fits.push((
            least_squares::r2(&y, &predicted),
            least_squares::r2(&losses, &jod(&predicted)),
            least_squares::r2(&y, &own),
            error.exp(),
            set,
            coefficients,
        ));
    }
    fits.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("{} rows, {} groups", rows.len(), {
        let mut names = groups;
        names.sort();
        names.dedup();
        names.len()
    });
    println!(
        "R2 of ln(loss), groups left out; R2 of loss, left out; R2 of ln(loss), own data; error as a factor; predictors"
    );
    for (out, loss, own, factor, set, coefficients) in &fits {
        let names: Vec<&str> =
            Predictors::NAMES.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1).map(|(_, name)| *name).collect();
        let numbers: Vec<String> = coefficients.iter().map(|value| format!("{value:.4}")).collect();
        println!("{out:.3} {loss:.3} {own:.3} {factor:.2} {} : {}", names.join("+"), numbers.join(" "));
    }
    Ok(())
}
