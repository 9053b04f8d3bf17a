//! The language as a whole.

use super::{Dialect, EvaluationError, Evaluator, Functions, Nowhere, Surroundings};
use proptest::prelude::*;

fn ray() -> Functions {
    Functions::new(Dialect::Ray)
}

fn try_value(functions: &mut Functions, file: &str, text: &str) -> Result<f64, String> {
    let expression = functions.expression(file, text).map_err(|bad| bad.message)?;
    if let Some(problem) = functions.check(expression) {
        return Err(problem);
    }
    Evaluator::new(functions).value(expression, &Nowhere).map_err(|error| error.to_string())
}

fn value(text: &str) -> f64 {
    try_value(&mut ray(), ".", text).unwrap()
}

#[test]
fn operators_bind_as_in_the_grammar() {
    for (text, wanted) in [
        ("1 + 2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("8/4/2", 1.0),
        ("10-4-3", 3.0),
        ("2^3^2", 512.0),
        ("-2^2", 4.0),
        ("2*-3", -6.0),
        ("1 - -1", 2.0),
        ("1-(-1)", 2.0),
        ("2^-1", 0.5),
        ("{a comment} 1 {and {another}}", 1.0),
    ] {
        assert_eq!(value(text), wanted, "{text}");
    }
}

#[test]
fn outside_their_domain_operations_give_0() {
    for text in
        ["1/0", "0/0", "sqrt(-1)", "log(0)", "acos(2)", "exp(1000)", "(-8)^(1/3)", "0^-1", "10^400", "select(4, 1, 2)"]
    {
        assert_eq!(value(text), 0.0, "{text}");
    }
}

#[test]
fn the_library() {
    for (text, wanted) in [
        ("if(1, 2, 3)", 2.0),
        ("if(0, 2, 3)", 3.0),
        ("if(-1, 2, 3)", 3.0),
        ("select(2, 7, 8, 9)", 8.0),
        ("select(0, 7, 8, 9)", 3.0),
        ("select(2.6, 7, 8, 9)", 9.0),
        ("min(3, 1, 2)", 1.0),
        ("max(3, 1, 2) + max(-5)", -2.0),
        ("floor(-1.5) + ceil(-1.5)", -3.0),
        ("atan2(1, 1)*4 - PI", 0.0),
        ("mod(-1, 3)", 2.0),
        ("tri(5, 2)", 1.0),
        ("abs(-2) + sgn(-3) + sq(3)", 10.0),
        ("and(1, -1) + or(1, -1) + not(1)", -1.0),
        ("bound(0, 5, 2) + clip(-1) + noneg(-3)", 2.0),
        ("Acos(1.0000001)", 0.0),
        ("linterp(.25, 4, 8)", 5.0),
        ("hermite(1, 2, 0, 0, 1) + bezier(1, 0, 0, 5, 1)", 7.0),
        ("frac(-.25)", 0.75),
        ("erf(0) + erfc(0)", 1.0),
    ] {
        assert!((value(text) - wanted).abs() < 1e-15, "{text}: {}", value(text));
    }
    // Both forms of the splines agree: the generators' library and the definitions for rays.
    for spline in ["hermite(3,-2,.5,7,.3)", "bezier(3,-2,.5,7,.3)", "bspline(3,-2,.5,7,.3)"] {
        let other = try_value(&mut Functions::new(Dialect::Generator), ".", spline).unwrap();
        assert!((value(spline) - other).abs() < 1e-14, "{spline}");
    }
}

#[test]
fn arguments_are_evaluated_by_need() {
    let mut functions = ray();
    functions
        .define_file("f.cal", "loop(x) = loop(x); pick(a, b) = if(a, a, b); fact(n) = if(n-.5, n*fact(n-1), 1);")
        .unwrap();
    assert_eq!(try_value(&mut functions, "f.cal", "pick(2, loop(1))"), Ok(2.0));
    assert_eq!(try_value(&mut functions, "f.cal", "fact(10)"), Ok(3_628_800.0));
    assert!(try_value(&mut functions, "f.cal", "loop(1)").unwrap_err().contains("deeper than"));
    functions.define_file("g.cal", "wide(n) = if(n-.5, wide(n-1)+wide(n-1), 1);").unwrap();
    assert!(try_value(&mut functions, "g.cal", "wide(60)").unwrap_err().contains("more than"));
    functions.define_file("h.cal", "x = y + 1; y = x + 1;").unwrap();
    assert!(try_value(&mut functions, "h.cal", "x").unwrap_err().contains("deeper than"));
}

#[test]
fn functions_are_passed_and_handed_on() {
    let mut functions = ray();
    let text =
        "v(i) = select(i, 1, 2, 3); w(i) = select(i, 4, 5, 6); twice(f, x) = f(f(x)); add(f, x) = twice(f, x) + 1;";
    functions.define_file("f.cal", text).unwrap();
    assert_eq!(try_value(&mut functions, "f", "dot(v, w)"), Ok(32.0));
    assert_eq!(try_value(&mut functions, "f", "cross(3, v, w)"), Ok(-3.0));
    assert_eq!(try_value(&mut functions, "f", "add(sqrt, 16)"), Ok(3.0));
    assert!(try_value(&mut functions, "f", "twice(3, 16)").unwrap_err().contains("no function"));
}

#[test]
fn names_belong_to_their_file() {
    let mut functions = ray();
    functions.define_globally("all", "a = 1; b = 2;").unwrap();
    functions.define_file("x.cal", "a = 10; c = a + b; d = a` + `a; b` = 3;").unwrap();
    functions.define_file("folder/y-z.CAL", "c = a + b;").unwrap();
    assert_eq!(try_value(&mut functions, "x.cal", "c"), Ok(13.0));
    assert_eq!(try_value(&mut functions, "x.cal", "d"), Ok(11.0));
    assert_eq!(try_value(&mut functions, "folder/y-z.cal", "c"), Ok(4.0));
    assert_eq!(try_value(&mut functions, ".", "c`x`"), Ok(13.0));
    assert_eq!(try_value(&mut functions, ".", "c`folder_y_z`"), Ok(4.0));
    assert!(try_value(&mut functions, ".", "c").unwrap_err().contains("variable `c` is not defined"));
    // A definition that comes later holds for those who met the name before.
    functions.define_file("late.cal", "e = f + 1; f = 5; f = 6;").unwrap();
    assert_eq!(try_value(&mut functions, "late.cal", "e"), Ok(7.0));
    // A name of its own, part of the name.
    functions.define_file("p.cal", "k`P. = 7; m = k`P.;").unwrap();
    assert_eq!(try_value(&mut functions, "p.cal", "m"), Ok(7.0));
}

#[test]
fn a_file_may_hide_a_library_function() {
    let mut functions = ray();
    functions.define_file("s.cal", "sqrt(x) = 100; r = sqrt(4);").unwrap();
    assert_eq!(try_value(&mut functions, "s.cal", "r"), Ok(100.0));
    assert_eq!(try_value(&mut functions, ".", "sqrt(4)"), Ok(2.0));
}

#[test]
fn what_is_wrong_is_told() {
    for (text, message) in [
        ("1 +", "expected a number, a name or `(`, found the end"),
        ("(1", "expected an operator or `)`"),
        ("1 2", "expected an operator, found `2`"),
        ("f(1", "expected `,` or `)`"),
        ("nothing", "variable `nothing` is not defined"),
        ("nothing(1)", "function `nothing` is not defined"),
        ("atan2(1)", "`atan2` wants 2 arguments, found 1"),
        ("bound(1, 2)", "`bound` wants 3 arguments"),
        ("sqrt", "variable `sqrt` is not defined"),
        ("Px", "`Px` has no value here"),
        ("A3", "real argument 3 is missing"),
        ("$0", "number of a channel"),
        ("a § b", "`§`"),
    ] {
        let problem = try_value(&mut ray(), ".", text).unwrap_err();
        assert!(problem.contains(message), "{text}: {problem}");
    }
    let deep = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert!(try_value(&mut ray(), ".", &deep).unwrap_err().contains("nests more than"));
    let long = format!("1{}", "+1".repeat(1900));
    assert_eq!(value(&long), 1901.0);
}

#[test]
fn errors_in_files_have_lines() {
    let errors = ray().define_file("f.cal", "a = 1;\nb = 2 +;\nc(1) = 3;\nd = 4\ne = 5;\nf : 6").unwrap_err();
    let places: Vec<(usize, usize)> = errors.iter().map(|error| (error.line, error.column)).collect();
    assert_eq!(places, [(2, 8), (3, 3), (5, 1)]);
    let mut functions = ray();
    functions.define_file("g.cal", "\n\nx = 1 + yy;").unwrap();
    assert!(try_value(&mut functions, "g.cal", "x").unwrap_err().contains("`yy` is not defined (used at g.cal:3:9)"));
}

/// Answers channel n with 10 n, and has two arguments.
struct Somewhere;

impl Surroundings for Somewhere {
    fn channel(&self, n: u32) -> Option<f64> {
        Some(10.0 * f64::from(n))
    }

    fn count(&self) -> usize {
        2
    }

    fn argument(&self, n: usize) -> Option<f64> {
        [0.5, 0.25].get(n.checked_sub(1)?).copied()
    }
}

#[test]
fn a_hit_answers_by_name() {
    let mut functions = ray();
    let ask = |functions: &mut Functions, text: &str| {
        let expression = functions.expression(".", text).unwrap();
        Evaluator::new(functions).value(expression, &Somewhere)
    };
    // The channel numbers of Radiance's func.c.
    for (text, wanted) in [
        ("Dx", 10.0),
        ("Nz", 60.0),
        ("Pz", 90.0),
        ("T", 100.0),
        ("Rdot", 110.0),
        ("Kz", 240.0),
        ("Ts", 250.0),
        ("Lv", 270.0),
    ] {
        assert_eq!(ask(&mut functions, text), Ok(wanted));
    }
    assert_eq!(ask(&mut functions, "AC + A1 + arg(2)"), Ok(2.75));
    assert_eq!(ask(&mut functions, "arg(3)"), Err(EvaluationError::NoArgument(3)));
    assert_eq!(ask(&mut functions, "P(2) - D(1)"), Ok(70.0));
}

#[test]
fn variables_are_kept_until_the_place_changes() {
    struct Counting(std::cell::Cell<u32>);
    impl Surroundings for Counting {
        fn channel(&self, _: u32) -> Option<f64> {
            self.0.set(self.0.get() + 1);
            Some(f64::from(self.0.get()))
        }
        fn count(&self) -> usize {
            0
        }
        fn argument(&self, _: usize) -> Option<f64> {
            None
        }
    }
    let mut functions = ray();
    functions.define_file("f", "v = Px;").unwrap();
    let sum = functions.expression("f", "v + v + Px").unwrap();
    let (place, mut evaluator) = (Counting(Default::default()), Evaluator::new(&functions));
    assert_eq!(evaluator.value(sum, &place), Ok(3.0));
    assert_eq!(evaluator.value(sum, &place), Ok(3.0));
    evaluator.move_on();
    assert_eq!(evaluator.value(sum, &place), Ok(6.0));
}

#[test]
fn noise_is_smooth_and_0_at_integers() {
    assert_eq!(value("noise3(3, -4, 5)"), 0.0);
    assert_eq!(value("noise3(1e300, -1e300, 0)"), 0.0);
    for step in 0..200 {
        let at = -10.0 + 0.1 * f64::from(step);
        let here = value(&format!("noise3({at}, {at}*.3, .7)"));
        let near = value(&format!("noise3({at} + 1e-6, {at}*.3, .7)"));
        assert!(here.abs() <= 1.0 && (here - near).abs() < 1e-5);
        let fractal = value(&format!("fnoise3({at}, .2, {at}*.7)"));
        assert!(fractal.abs() < 2.5);
    }
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "([a-c(),;:=+*/^0-9.{}`$ \n-]|if|select|noise3|P.){0,60}") {
        let mut functions = ray();
        let _ = functions.define_file("any.cal", &text);
        if let Ok(expression) = functions.expression("any.cal", &text) && functions.check(expression).is_none() {
            let _ = Evaluator::new(&functions).value(expression, &Somewhere);
        }
    }

    #[test]
    fn arithmetic_is_that_of_the_machine(a in -1e6..1e6, b in -1e6..1e6, c in 0.1..10.0) {
        let found = value(&format!("({a}) + ({b})*{c} - ({a})/{c}"));
        prop_assert_eq!(found, a + b * c - a / c);
    }

    #[test]
    fn library_functions_are_finite(x in prop_oneof![-1e3..1e3, any::<f64>().prop_filter("finite", |x| x.is_finite())]) {
        for name in ["rand", "sqrt", "tan", "exp", "log", "erf", "erfc", "floor", "acos"] {
            let found = value(&format!("{name}({x:e})"));
            prop_assert!(found.is_finite());
        }
        for name in ["noise3", "noise3x", "fnoise3"] {
            let found = value(&format!("{name}({x:e}, -({x:e}), .5)"));
            prop_assert!(found.is_finite());
        }
        let hashed = value(&format!("rand({x:e})"));
        prop_assert!((0.0..1.0).contains(&hashed));
    }
}

/// A hit on the plane z = 0 from a distance of 2, as `data/make.py` traces it.
struct Hit {
    direction: [f64; 3],
    place: [f64; 2],
    reals: Vec<f64>,
}

impl Surroundings for Hit {
    fn channel(&self, n: u32) -> Option<f64> {
        Some(match n {
            1..=3 => self.direction[n as usize - 1],
            7 | 8 => self.place[n as usize - 7],
            10 | 25 => 2.0,
            11 => self.direction[2].abs(),
            6 => -self.direction[2].signum(),
            // S, Ix, Jy, Kz.
            12 | 16 | 20 | 24 => 1.0,
            4..=24 => 0.0,
            _ => return None,
        })
    }

    fn count(&self) -> usize {
        self.reals.len()
    }

    fn argument(&self, n: usize) -> Option<f64> {
        self.reals.get(n.checked_sub(1)?).copied()
    }
}

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let numbers: Vec<f64> = text.split(' ').map(|number| number.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

#[test]
fn values_are_those_of_the_real_evaluators() {
    let mut tried = 0;
    for line in include_str!("data/values.txt").lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split(';').collect();
        let [text, place, printed] = fields[..] else { panic!("{line}") };
        let printed: f64 = printed.parse().unwrap();
        let mut functions = ray();
        let expression = functions.expression(".", text).unwrap();
        let (place, digits) = if place == "-" { ([0.0; 2], 2e-9) } else { (numbers(place), 2e-5) };
        let at = Hit { direction: [0.0, 0.0, -1.0], place, reals: vec![0.5, 0.25] };
        let found = Evaluator::new(&functions).value(expression, &at).unwrap();
        assert!((found - printed).abs() <= digits * (printed.abs() + 1.0), "{line}: found {found}");
        tried += 1;
    }
    assert_eq!(tried, 163);
}

#[test]
fn shipped_files_give_the_values_of_their_namesakes() {
    let mut tried = 0;
    for line in include_str!("data/files.txt").lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split(';').collect();
        let [file, text, reals, direction, place, printed] = fields[..] else { panic!("{line}") };
        let printed: f64 = printed.parse().unwrap();
        let mut functions = ray();
        functions.define_file(file, super::shipped(file).unwrap()).unwrap();
        let expression = functions.expression(file, text).unwrap();
        assert_eq!(functions.check(expression), None, "{line}");
        let reals = reals.split(' ').map(|number| number.parse().unwrap()).collect();
        let at = Hit { direction: numbers(direction), place: numbers(place), reals };
        let found = Evaluator::new(&functions).value(expression, &at).unwrap();
        // Colours were printed with 4 added, to 7 digits.
        assert!((found - printed).abs() <= 2e-5 * (printed.abs() + 1.0), "{line}: found {found}");
        tried += 1;
    }
    assert_eq!(tried, 600);
}
