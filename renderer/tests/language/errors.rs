//! Every error and every warning of the language: what is said, about which bytes, and that the advice holds.

use renderer::component::{Component, ComponentSet};
use renderer::crex::{ErrorKind, Group, MAX_ERRORS, MAX_NESTING, PlanReport, Setting, parse, warnings};

use ErrorKind::{
    Empty, ImportanceInside, Mismatched, NothingToMultiply, StarInside, TooDeep, TooLarge, Unclosed, UnknownCharacter,
    Unopened, Zero,
};
use Group::{Hold, Importance, Inherit, Timed};

fn lower(suggestion: &str) -> ErrorKind {
    ErrorKind::LowerCase { suggestion: suggestion.to_owned() }
}

fn mismatched(found: Group, open: Group, opened_at: usize) -> ErrorKind {
    Mismatched { found, open, opened_at }
}

#[test]
fn every_mistake_is_named_where_it_stands() {
    let cases: Vec<(&str, Vec<(ErrorKind, &str)>)> = vec![
        ("X", vec![(UnknownCharacter, "X")]),
        ("T+R", vec![(UnknownCharacter, "+")]),
        ("T,R;S", vec![(UnknownCharacter, ","), (UnknownCharacter, ";")]),
        ("T-1", vec![(UnknownCharacter, "-")]),
        ("T²", vec![(UnknownCharacter, "²")]),
        ("D٣", vec![(UnknownCharacter, "٣")]),
        ("T\u{0}", vec![(UnknownCharacter, "\u{0}")]),
        ("héllo", vec![(UnknownCharacter, "héllo")]),
        ("trs", vec![(lower("TRS"), "trs")]),
        ("Td2", vec![(lower("D"), "d")]),
        ("(T", vec![(Unclosed(Inherit), "(")]),
        ("<(T{R", vec![(Unclosed(Hold), "<"), (Unclosed(Inherit), "("), (Unclosed(Importance), "{")]),
        ("[", vec![(Unclosed(Timed), "[")]),
        ("T)", vec![(Unopened(Inherit), ")")]),
        ("T>]", vec![(Unopened(Hold), ">"), (Unopened(Timed), "]")]),
        ("(T>", vec![(mismatched(Hold, Inherit, 0), ">")]),
        ("T[R}", vec![(mismatched(Importance, Timed, 1), "}")]),
        ("(<T)R", vec![(Unclosed(Hold), "<")]),
        ("(<)R", vec![(Unclosed(Hold), "<")]),
        ("()", vec![(Empty(Inherit), "()")]),
        ("T< >", vec![(Empty(Hold), "< >")]),
        ("{}[ ]", vec![(Empty(Importance), "{}"), (Empty(Timed), "[ ]")]),
        ("(()T)", vec![(Empty(Inherit), "()")]),
        ("*", vec![(NothingToMultiply, "*")]),
        ("2", vec![(NothingToMultiply, "2")]),
        ("T(3R)", vec![(NothingToMultiply, "3")]),
        ("< *>", vec![(NothingToMultiply, "*")]),
        ("T0", vec![(Zero, "0")]),
        ("T000R", vec![(Zero, "000")]),
        ("T4294967296", vec![(TooLarge, "4294967296")]),
        ("T99999999999999999999999999", vec![(TooLarge, "99999999999999999999999999")]),
        ("{T*}", vec![(StarInside(Importance), "*")]),
        ("[T*]", vec![(StarInside(Timed), "*")]),
        ("{(T(R*))}", vec![(StarInside(Importance), "*")]),
        ("[<T(RS)*>]", vec![(StarInside(Timed), "*")]),
        ("{[T*]}", vec![(StarInside(Importance), "*")]),
        ("{T{R}}", vec![(ImportanceInside(Importance), "{")]),
        ("{(T<{R}>)}", vec![(ImportanceInside(Importance), "{")]),
        ("[T{R}]", vec![(ImportanceInside(Timed), "{")]),
        ("[<T{R}>]", vec![(ImportanceInside(Timed), "{")]),
        (
            "x(T0{r*})9999999999 ]",
            vec![
                (UnknownCharacter, "x"),
                (Zero, "0"),
                (lower("R"), "r"),
                (StarInside(Importance), "*"),
                (TooLarge, "9999999999"),
                (Unopened(Timed), "]"),
            ],
        ),
    ];
    for (text, expected) in cases {
        let errors = parse(text).expect_err(text);
        let found: Vec<_> = errors.iter().map(|error| (error.kind.clone(), error.span.of(text))).collect();
        assert_eq!(found, expected, "{text:?}");
        for error in errors {
            assert!(!error.message().is_empty() && !error.expected().is_empty());
            assert!(parse(&error.example()).is_ok(), "{text:?}: the example {:?} does not parse", error.example());
        }
    }
}

#[test]
fn what_stands_on_the_border_is_allowed() {
    for text in [
        "",
        " \t\n",
        "T4294967295",
        "T0004294967295",
        "{T}*",
        "[T]*",
        "({T})*",
        "{T}{R}",
        "{[T]}",
        "<{T}>",
        "[[T]<(T)>]",
    ] {
        assert!(parse(text).is_ok(), "{text:?}: {:?}", parse(text));
    }
}

#[test]
fn nesting_ends_at_64() {
    let nested = |depth: usize| format!("{}T{}", "(".repeat(depth), ")".repeat(depth));
    assert_eq!(MAX_NESTING, 64);
    assert!(parse(&nested(64)).is_ok());
    let errors = parse(&nested(65)).expect_err("too deep");
    assert_eq!(errors.len(), 1);
    assert_eq!((&errors[0].kind, errors[0].span.start), (&TooDeep, 64));
    // T2* is (T2)*: sixty-four multipliers behind the first are as many groups.
    let multiplied = |times: usize| format!("T{}", "*".repeat(times));
    assert!(parse(&multiplied(65)).is_ok());
    assert_eq!(parse(&multiplied(66)).expect_err("too deep")[0].kind, TooDeep);
    let both = |multipliers: usize| format!("{}{}", nested(60), "2 ".repeat(multipliers));
    assert!(parse(&both(5)).is_ok());
    assert_eq!(parse(&both(6)).expect_err("too deep")[0].kind, TooDeep);
}

#[test]
fn long_texts_full_of_mistakes_are_read_in_time() {
    for text in ["(", "(]", ")", "<(", "{[", "x ", "(<)", "T0", "[*", "(2", "Té"] {
        let errors = parse(&text.repeat(200_000)).expect_err(text);
        assert!(errors.len() <= MAX_ERRORS);
        for error in errors {
            assert!(error.render(&text.repeat(200_000)).len() < 2000);
        }
    }
    assert!(parse(&"T2".repeat(200_000)).is_ok());
    assert!(parse(&format!("T{}", "2".repeat(200_000))).is_err());
}

#[test]
fn the_span_is_underlined() {
    let shown = |text: &str| parse(text).expect_err(text)[0].render(text);
    assert_eq!(
        shown("T{RS*}"),
        "error: `*` cannot stand inside `{ }`\n  1:5: T{RS*}\n           ^\nexpected: a whole number instead, or the `*` \
         behind the closing bracket\nexample:  (T{RS3})*\n"
    );
    // Second line, characters of more than one byte before it, a tab.
    let text = "T\nR\té";
    assert!(shown(text).contains("  2:3: R é\n         ^\n"), "{}", shown(text));
    // Carets stay with the line and under the characters.
    let text = format!("{}tt{}", "T".repeat(300), "R".repeat(300));
    let report = shown(&text);
    let lines: Vec<_> = report.lines().collect();
    let at = lines[2].find("^^").expect("carets");
    assert_eq!(lines[1].chars().skip(at).take(2).collect::<String>(), "tt", "{report}");
    assert!(lines[1].chars().count() < 130);
}

#[test]
fn multipliers_that_do_nothing_draw_a_warning() {
    let cases: &[(&str, &[&str])] = &[
        ("T2R*(TR)3", &[]),
        ("<D>2", &[]),
        ("(T{RS})*", &[]),
        ("<(TR)*>", &["*"]),
        ("<D2>", &["2"]),
        ("[D3]", &["3"]),
        ("(<D>2)3", &[]),
        ("<<D>2>", &["2"]),
        ("[R(S<T2>3)]4", &["2", "3"]),
        ("T1", &["1"]),
        ("T*2", &["2"]),
        ("T**", &["*"]),
        ("(T*)3", &["3"]),
        ("(T*R)3", &[]),
        ("T2*", &[]),
    ];
    for &(text, expected) in cases {
        let ast = parse(text).expect(text);
        let found = warnings(&ast, &Setting::default());
        assert_eq!(found.iter().map(|warning| warning.span.of(text)).collect::<Vec<_>>(), expected, "{text}");
        assert!(found.iter().all(|warning| warning.render(text).contains('^')));
    }
}

#[test]
fn a_setting_draws_warnings_of_its_own() {
    let text = "T{RS}[DG]*";
    let ast = parse(text).expect("a crex");
    let spans = |setting: Setting| -> Vec<&str> {
        warnings(&ast, &setting).iter().map(|warning| warning.span.of(text)).collect()
    };
    let some: ComponentSet = [Component::Diffuse, Component::Transmitted, Component::Specular].into_iter().collect();
    assert_eq!(spans(Setting { components: Some(some), ..Setting::default() }), ["R", "G"]);
    assert_eq!(spans(Setting { components: Some(ComponentSet::ALL), ..Setting::default() }), [""; 0]);
    assert_eq!(spans(Setting { importance_map: Some(false), ..Setting::default() }), ["{RS}"]);
    assert_eq!(spans(Setting { time_limit: Some(false), ..Setting::default() }), ["[DG]"]);
    assert_eq!(spans(Setting { time_limit: Some(true), importance_map: Some(true), components: None }), [""; 0]);
}

#[test]
fn the_plan_in_json_has_its_shape() {
    let json = |text: &str| serde_json::to_value(PlanReport::new(text, &Setting::default())).expect("JSON");
    assert_eq!(
        json("T{RS2}[D]3*"),
        serde_json::json!({
            "crex": "T{RS2}[D]3*", "valid": true, "errors": [], "warnings": [],
            "tree": {"sequence": [
                {"component": "T"},
                {"group": "{}", "items": [{"component": "R"}, {"repeat": 2, "item": {"component": "S"}}]},
                {"repeat": "*", "item": {"repeat": 3, "item": {"group": "[]", "items": [{"component": "D"}]}}},
            ]},
        })
    );
    assert_eq!(json("")["tree"], serde_json::json!({"sequence": []}));
    let wrong = json("Té<");
    assert_eq!((&wrong["valid"], &wrong["tree"]), (&serde_json::json!(false), &serde_json::Value::Null));
    let spans: Vec<_> =
        wrong["errors"].as_array().expect("errors").iter().map(|e| (e["start"].clone(), e["end"].clone())).collect();
    assert_eq!(spans, [(1.into(), 3.into()), (3.into(), 4.into())]);
    assert_eq!(json("<D2>")["warnings"].as_array().map(Vec::len), Some(1));
}
