use super::Expression;
use proptest::prelude::*;

fn value(source: &str) -> f64 {
    Expression::parse(source, &[("L", 0.04)])
        .unwrap_or_else(|e| panic!("{e}"))
        .eval(&[2.0, 3.0, 5.0], 7.0)
}

#[test]
fn precedence_and_association() {
    assert_eq!(value("-x^2"), -4.0);
    assert_eq!(value("2^3^2"), 512.0);
    assert_eq!(value("2^-x"), 0.25);
    assert_eq!(value("10 - x - y"), 5.0);
    assert_eq!(value("-x*y"), -6.0);
    assert_eq!(value("1 + x*y == 7 && !(t < z)"), 1.0);
    assert_eq!(value("1 || 0 && 0"), 1.0);
    assert_eq!(value("x > 3 ? 1 : y > 2 ? 20 : 3"), 20.0);
    assert_eq!(value("if(x < 3, t, 1/0)"), 7.0);
    assert_eq!(value("max(x, y, z) - min(x,y)"), 3.0);
    assert_eq!(value("step(0) + step(-1e-300) + sign(0) + sign(-3)"), 0.0);
    assert_eq!(value("clamp(t, x, y)"), 3.0);
    assert_eq!(value("hypot(y, 4)"), 5.0);
    assert_eq!(value("ln(e) + log10(1000)"), 4.0);
}

#[test]
fn what_it_depends_on() {
    let parse = |s| Expression::parse(s, &[("L", 0.04)]).unwrap();
    assert_eq!(parse("2*L + sin(pi/2)").as_constant(), Some(1.08));
    assert_eq!(parse("x").as_constant(), None);
    assert!(parse("x + t").depends_on_time() && !parse("x").depends_on_time());
    assert!(parse("x + t").depends_on_position() && !parse("t").depends_on_position());
    assert_eq!(parse(" x ").source(), " x ");
    assert_eq!(Expression::constant(-2.5).as_constant(), Some(-2.5));
}

/// The message, what the caret marks, and the help.
fn failure(source: &str) -> (String, String, String) {
    let error = Expression::parse(source, &[("speed", 1.0)]).expect_err(source);
    (
        error.message,
        source[error.span].to_string(),
        error.help.unwrap_or_default(),
    )
}

#[test]
fn errors_name_the_place_and_the_cure() {
    for (source, message, marked, help) in [
        ("", "the expression is empty", "", ""),
        ("1 +", "ends too early", "", ""),
        ("2*sine(x)", "unknown name \"sine\"", "sine", "\"sin\""),
        ("sped*t", "unknown name", "sped", "\"speed\""),
        ("qwerty", "unknown name", "qwerty", "known names"),
        ("2 x", "expected an operator", "x", "`*`"),
        ("x = 1", "expected an operator", "=", "`==`"),
        ("x ** 2", "not an operator", "**", "`^`"),
        ("0 < x < 1", "do not chain", "<", "&&"),
        ("(x", "expected `)`", "", ""),
        ("x)", "closes nothing", ")", ""),
        ("sin x", "after the function sin", "x", ""),
        ("atan2(x)", "takes 2 arguments, not 1", "atan2(x)", ""),
        ("sin()", "takes 1 argument, not 0", "sin()", ""),
        ("min(x)", "takes 2 or more arguments, not 1", "min(x)", ""),
        ("x ? 1", "expected `:`", "", ""),
        ("x + µ", "unexpected character", "µ", ""),
        ("1 + .", "is not a number", ".", ""),
        ("x & y", "expected an operator", "&", ""),
        ("12,5", "decimal point, not a comma", ",", "write 12.5"),
        (
            "1,5 MPa",
            "decimal point, not a comma",
            ",",
            "write 1.5 MPa",
        ),
        ("5 MPa", "expected an operator", "MPa", "`*`"),
    ] {
        let (got_message, got_marked, got_help) = failure(source);
        assert!(got_message.contains(message), "{source}: {got_message}");
        assert_eq!(got_marked, marked, "{source}");
        assert!(got_help.contains(help), "{source}: {got_help}");
    }
}

#[test]
fn the_caret_stands_under_the_culprit() {
    let error = Expression::parse("µ", &[]).unwrap_err();
    assert_eq!(error.to_string(), "unexpected character `µ`\n  µ\n  ^");
    let error = Expression::parse("1 +\n 2*sine(x)", &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "unknown name \"sine\"\n   2*sine(x)\n     ^^^^\nhelp: did you mean \"sin\"?"
    );
}

#[test]
fn deep_nesting_is_refused_not_fatal() {
    for (open, close) in [
        ("(", ")"),
        ("-", ""),
        ("x^", ""),
        ("sin(", ")"),
        ("1?x:", ""),
        ("x+(", ")"),
        ("1?", ":1"),
    ] {
        let source = format!("{}x{}", open.repeat(10_000), close.repeat(10_000));
        let message = Expression::parse(&source, &[]).unwrap_err().message;
        assert!(
            message.contains("nested more than") || message.contains("wait for"),
            "{open}: {message}"
        );
    }
    assert_eq!(value(&format!("x{}", "+x".repeat(10_000))), 20_002.0);
}

/// A tree to compare the compiled program with.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Axis(usize),
    Time,
    Negate(Box<Tree>),
    Call(&'static str, fn(f64) -> f64, Box<Tree>),
    Binary(&'static str, fn(f64, f64) -> f64, Box<Tree>, Box<Tree>),
    Choice(Box<Tree>, Box<Tree>, Box<Tree>),
}

impl Tree {
    fn write(&self) -> String {
        match self {
            Tree::Number(v) => format!("{v}"),
            Tree::Axis(a) => ["x", "y", "z"][*a].into(),
            Tree::Time => "t".into(),
            Tree::Negate(a) => format!("-({})", a.write()),
            Tree::Call(name, _, a) => format!("{name}({})", a.write()),
            Tree::Binary(name, _, a, b) => format!("({}) {name} ({})", a.write(), b.write()),
            Tree::Choice(a, b, c) => format!("({}) ? ({}) : ({})", a.write(), b.write(), c.write()),
        }
    }
    fn value(&self, x: &[f64; 3], t: f64) -> f64 {
        match self {
            Tree::Number(v) => *v,
            Tree::Axis(a) => x[*a],
            Tree::Time => t,
            Tree::Negate(a) => -a.value(x, t),
            Tree::Call(_, f, a) => f(a.value(x, t)),
            Tree::Binary(_, f, a, b) => f(a.value(x, t), b.value(x, t)),
            Tree::Choice(a, b, c) => {
                if a.value(x, t) != 0.0 {
                    b.value(x, t)
                } else {
                    c.value(x, t)
                }
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0.0..9.0f64).prop_map(Tree::Number),
        (0usize..3).prop_map(Tree::Axis),
        Just(Tree::Time),
    ];
    leaf.prop_recursive(4, 40, 3, |inner| {
        let call = prop_oneof![
            Just(("sin", libm::sin as fn(f64) -> f64)),
            Just(("exp", libm::exp as fn(f64) -> f64)),
            Just(("sqrt", f64::sqrt as fn(f64) -> f64)),
            Just(("log", libm::log as fn(f64) -> f64)),
            Just(("floor", f64::floor as fn(f64) -> f64)),
        ];
        let binary = prop_oneof![
            Just(("+", (|a, b| a + b) as fn(f64, f64) -> f64)),
            Just(("-", (|a, b| a - b) as fn(f64, f64) -> f64)),
            Just(("*", (|a, b| a * b) as fn(f64, f64) -> f64)),
            Just(("/", (|a, b| a / b) as fn(f64, f64) -> f64)),
            Just(("^", libm::pow as fn(f64, f64) -> f64)),
            Just(("<", (|a, b| f64::from(a < b)) as fn(f64, f64) -> f64)),
            Just((
                "&&",
                (|a, b| f64::from(a != 0.0 && b != 0.0)) as fn(f64, f64) -> f64
            )),
        ];
        prop_oneof![
            inner.clone().prop_map(|a| Tree::Negate(a.into())),
            (call, inner.clone()).prop_map(|((n, f), a)| Tree::Call(n, f, a.into())),
            (binary, inner.clone(), inner.clone()).prop_map(|((n, f), a, b)| Tree::Binary(
                n,
                f,
                a.into(),
                b.into()
            )),
            (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| Tree::Choice(
                a.into(),
                b.into(),
                c.into()
            )),
        ]
    })
}

proptest! {
    #[test]
    fn the_program_computes_the_tree(tree in tree(), x in prop::array::uniform3(-3.0..3.0f64), t in 0.0..5.0f64) {
        let compiled = Expression::parse(&tree.write(), &[]).unwrap();
        let (got, expected) = (compiled.eval(&x, t), tree.value(&x, t));
        prop_assert!(got == expected || got.is_nan() && expected.is_nan(), "{got} {expected} {}", tree.write());
    }

    #[test]
    fn any_text_is_parsed_or_refused(text in "\\PC*") {
        if let Err(error) = Expression::parse(&text, &[]) {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    #[test]
    fn any_tokens_are_parsed_or_refused(
        tokens in prop::collection::vec(prop::sample::select(vec![
            "x", "t", "1", "e", "1e", ".5", "sin", "min", "if", "(", ")", ",", "+", "-", "*", "^", "?", ":", "!", "<=", "&&", "\n",
        ]), 0..200),
    ) {
        if let Ok(expression) = Expression::parse(&tokens.join(" "), &[]) {
            expression.eval(&[1.0, 2.0, 3.0], 4.0);
        }
    }
}
