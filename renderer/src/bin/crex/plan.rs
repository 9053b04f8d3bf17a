//! `crex plan`: a crex explained, or what is wrong with it.

use renderer::crex::{self, PlanReport, Setting};

use crate::console::{self, Failure};

/// What `crex plan` takes.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The component regular expression, such as 'T{RSGM}'; an empty one is primary rays and direct light
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    crex: String,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let setting = Setting::default();
    if args.json {
        let report = PlanReport::new(&args.crex, &setting);
        console::print_json(&report)?;
        return if report.valid { Ok(()) } else { Err(Failure::Told) };
    }
    let ast = parse(&args.crex)?;
    for warning in crex::warnings(&ast, &setting) {
        console::say("warning", &warning.render(&args.crex));
    }
    console::print(&crex::explain(&ast))
}

/// Parses a crex; what is wrong is shown in the text, underlined.
pub(crate) fn parse(text: &str) -> Result<crex::Ast, Failure> {
    crex::parse(text).map_err(|errors| Failure::Input(errors.iter().map(|error| error.render(text)).collect()))
}
