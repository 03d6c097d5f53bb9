//! A Pratt parser for expressions: one pass, a span in every error.

use super::tree::{Binary, Compare, Definition, Expression, Function, MAX_DEPTH, MAX_TOKENS, Node, PairFunction};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// What an expression may refer to besides position and time.
#[derive(Clone, Debug, Default)]
pub struct Names {
    pub constants: BTreeMap<String, f64>,
    pub functions: BTreeMap<String, Arc<Definition>>,
    /// Names of variables that are known here; `x`, `y`, `z`, `t` in most places.
    pub variables: Vec<&'static str>,
}

/// An expression that cannot be read.
#[derive(Clone, Debug, PartialEq)]
pub struct ParseError {
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
    /// Where, in bytes of the expression.
    pub span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Symbol(&'static str),
    End,
}

/// Reads an expression.
pub fn parse(text: &str, names: &Names) -> Result<Expression, ParseError> {
    let tokens = tokenize(text)?;
    let mut parser = Parser { tokens, at: 0, names, depth: 0 };
    let root = parser.expression(0)?;
    let (token, span) = parser.peek();
    if *token != Token::End {
        let help = match token {
            Token::Name(_) | Token::Number(_) => Some("is an operator such as * missing before it?".into()),
            Token::Symbol(")") => Some("there is no opening parenthesis for it".into()),
            _ => None,
        };
        return Err(ParseError { message: format!("unexpected {}", describe(token)), help, span: span.clone() });
    }
    Ok(Expression { root: root.folded() })
}

const SYMBOLS: [&str; 20] =
    ["<=", ">=", "==", "!=", "&&", "||", "**", "<", ">", "+", "-", "*", "/", "^", "(", ")", ",", "!", "·", "−"];

fn tokenize(text: &str) -> Result<Vec<(Token, Range<usize>)>, ParseError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let Some(c) = rest.chars().next() else { break };
        if c.is_whitespace() {
            at += c.len_utf8();
            continue;
        }
        let begin = at;
        let token = if c.is_ascii_digit() || (c == '.' && rest[1..].starts_with(|d: char| d.is_ascii_digit())) {
            let length = number_length(rest);
            at += length;
            match rest[..length].parse::<f64>() {
                Ok(v) => Token::Number(v),
                Err(_) => return Err(error(format!("`{}` is not a number", &rest[..length]), begin..at)),
            }
        } else if c.is_alphabetic() || c == '_' {
            let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            at += length;
            Token::Name(rest[..length].to_string())
        } else if let Some(symbol) = SYMBOLS.iter().find(|s| rest.starts_with(**s)) {
            at += symbol.len();
            Token::Symbol(symbol)
        } else {
            return Err(error(format!("unexpected character `{c}`"), begin..begin + c.len_utf8()));
        };
        tokens.push((token, begin..at));
        // A long chain of operators is as deep a tree as nested parentheses are.
        if tokens.len() > MAX_TOKENS {
            return Err(error(format!("longer than {MAX_TOKENS} words"), begin..at));
        }
    }
    tokens.push((Token::End, text.len()..text.len()));
    Ok(tokens)
}

/// Length of the number at the start: digits, a point, an exponent.
pub fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while i < bytes.len() && bytes[i].is_ascii_digit() {
            i += 1;
        }
        i
    };
    let mut i = digits(0);
    if bytes.get(i) == Some(&b'.') {
        i = digits(i + 1);
    }
    if matches!(bytes.get(i), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(i + 1), Some(b'+' | b'-')));
        let end = digits(i + 1 + sign);
        // A lone `e` is Euler's number, not an exponent.
        if end > i + 1 + sign {
            i = end;
        }
    }
    i
}

fn error(message: String, span: Range<usize>) -> ParseError {
    ParseError { message, help: None, span }
}

fn describe(token: &Token) -> String {
    match token {
        Token::Number(v) => format!("number {v}"),
        Token::Name(n) => format!("name `{n}`"),
        Token::Symbol(s) => format!("`{s}`"),
        Token::End => "end of the expression".into(),
    }
}

struct Parser<'a> {
    tokens: Vec<(Token, Range<usize>)>,
    at: usize,
    names: &'a Names,
    depth: usize,
}

/// Binding powers of the infix operators, weakest first.
fn binding(symbol: &str) -> Option<(u8, u8)> {
    Some(match symbol {
        "||" => (1, 2),
        "&&" => (3, 4),
        "==" | "!=" | "<" | "<=" | ">" | ">=" => (5, 6),
        "+" | "-" | "−" => (7, 8),
        "*" | "/" | "·" => (9, 10),
        // To the right, and tighter than a minus before it: -2^2 is -4.
        "^" | "**" => (14, 13),
        _ => return None,
    })
}

const PREFIX: u8 = 11;

impl Parser<'_> {
    fn peek(&self) -> &(Token, Range<usize>) {
        &self.tokens[self.at]
    }

    fn next(&mut self) -> (Token, Range<usize>) {
        let token = self.tokens[self.at].clone();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        token
    }

    fn expression(&mut self, least: u8) -> Result<Node, ParseError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(error(format!("nested more than {MAX_DEPTH} deep"), self.peek().1.clone()));
        }
        let mut left = self.prefix()?;
        while let (Token::Symbol(symbol), _) = self.peek() {
            let symbol = *symbol;
            let Some((l, r)) = binding(symbol) else { break };
            if l < least {
                break;
            }
            self.next();
            let right = self.expression(r)?;
            left = infix(symbol, left, right);
        }
        self.depth -= 1;
        Ok(left)
    }

    fn prefix(&mut self) -> Result<Node, ParseError> {
        let (token, span) = self.next();
        match token {
            Token::Number(v) => Ok(Node::Number(v)),
            Token::Symbol("-" | "−") => Ok(Node::Negate(Box::new(self.expression(PREFIX)?))),
            Token::Symbol("+") => self.expression(PREFIX),
            Token::Symbol("!") => Ok(Node::Not(Box::new(self.expression(PREFIX)?))),
            Token::Symbol("(") => {
                let inner = self.expression(0)?;
                self.close(&span)?;
                Ok(inner)
            }
            Token::Name(name) if self.peek().0 == Token::Symbol("(") => self.call(&name, &span),
            Token::Name(name) => self.name(&name, span),
            other => Err(ParseError {
                message: format!("expected a number, a name or `(`, found {}", describe(&other)),
                help: None,
                span,
            }),
        }
    }

    fn close(&mut self, open: &Range<usize>) -> Result<(), ParseError> {
        let (token, span) = self.next();
        if token == Token::Symbol(")") {
            return Ok(());
        }
        Err(ParseError {
            message: format!("expected `)`, found {}", describe(&token)),
            help: Some(format!("the parenthesis opened at character {} is not closed", open.start + 1)),
            span,
        })
    }

    fn name(&self, name: &str, span: Range<usize>) -> Result<Node, ParseError> {
        if let Some(v) = self.names.constants.get(name) {
            return Ok(Node::Number(*v));
        }
        if let Some(variable) = self.names.variables.iter().find(|v| **v == name) {
            return Ok(match *variable {
                // A yarn is where its angle from the meridian and its radius are; a curve, where its parameter is; a voxel,
                // at its value.
                "x" | "angle" | "u" | "value" => Node::Position(0),
                "y" | "r" => Node::Position(1),
                "z" => Node::Position(2),
                _ => Node::Time,
            });
        }
        match name {
            "pi" | "π" => return Ok(Node::Number(std::f64::consts::PI)),
            "e" => return Ok(Node::Number(std::f64::consts::E)),
            _ => {}
        }
        let constants = self.names.constants.keys().map(String::as_str);
        let known: Vec<&str> = self.names.variables.iter().copied().chain(constants).chain(["pi", "e"]).collect();
        let is_function = function(name).is_some() || self.names.functions.contains_key(name);
        let help = if is_function {
            format!("`{name}` is a function: write {name}(…)")
        } else if ["r", "radius"].contains(&name) {
            "the radius is `x` in an axisymmetric case, and `hypot(x, y)` in the plane".into()
        } else {
            crate::suggestion(name, &known)
        };
        Err(ParseError { message: format!("unknown name `{name}`"), help: Some(help), span })
    }

    fn call(&mut self, name: &str, span: &Range<usize>) -> Result<Node, ParseError> {
        let (_, open) = self.next();
        let mut arguments = vec![self.expression(0)?];
        while self.peek().0 == Token::Symbol(",") {
            self.next();
            arguments.push(self.expression(0)?);
        }
        self.close(&open)?;
        let count = arguments.len();
        let mut arguments = arguments.into_iter().map(Box::new);
        let mut next = || arguments.next().unwrap_or_else(|| Box::new(Node::Number(f64::NAN)));
        let wrong = |expected: &str| Err(error(format!("`{name}` takes {expected}, not {count}"), span.clone()));
        if let Some(definition) = self.names.functions.get(name) {
            return if count == 1 { Ok(Node::User(definition.clone(), next())) } else { wrong("one argument") };
        }
        if let Some(f) = function(name) {
            return if count == 1 { Ok(Node::Call(f, next())) } else { wrong("one argument") };
        }
        let pair = match name {
            "min" => PairFunction::Min,
            "max" => PairFunction::Max,
            "atan2" => PairFunction::Atan2,
            "hypot" => PairFunction::Hypot,
            "pow" if count == 2 => return Ok(Node::Binary(Binary::Power, next(), next())),
            "pow" => return wrong("two arguments"),
            "if" if count == 3 => return Ok(Node::If(next(), next(), next())),
            "if" => return wrong("three arguments: if(condition, a, b)"),
            _ => {
                let mut known: Vec<&str> = function_names().collect();
                known.extend(self.names.functions.keys().map(String::as_str));
                return Err(ParseError {
                    message: format!("unknown function `{name}`"),
                    help: Some(crate::suggestion(name, &known)),
                    span: span.clone(),
                });
            }
        };
        match (pair, count) {
            (PairFunction::Min | PairFunction::Max, 2..) => {
                let first = next();
                Ok(*(1..count).fold(first, |acc, _| Box::new(Node::Pair(pair, acc, next()))))
            }
            (PairFunction::Min | PairFunction::Max, _) => wrong("two arguments or more"),
            (_, 2) => Ok(Node::Pair(pair, next(), next())),
            _ => wrong("two arguments"),
        }
    }
}

fn infix(symbol: &str, left: Node, right: Node) -> Node {
    let (a, b) = (Box::new(left), Box::new(right));
    match symbol {
        "+" => Node::Binary(Binary::Add, a, b),
        "-" | "−" => Node::Binary(Binary::Subtract, a, b),
        "*" | "·" => Node::Binary(Binary::Multiply, a, b),
        "/" => Node::Binary(Binary::Divide, a, b),
        "<" => Node::Compare(Compare::Less, a, b),
        "<=" => Node::Compare(Compare::LessEqual, a, b),
        ">" => Node::Compare(Compare::Greater, a, b),
        ">=" => Node::Compare(Compare::GreaterEqual, a, b),
        "==" => Node::Compare(Compare::Equal, a, b),
        "!=" => Node::Compare(Compare::NotEqual, a, b),
        "&&" => Node::Compare(Compare::And, a, b),
        "||" => Node::Compare(Compare::Or, a, b),
        _ => Node::Binary(Binary::Power, a, b),
    }
}

const FUNCTIONS: [(&str, Function); 18] = [
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("sinh", Function::Sinh),
    ("cosh", Function::Cosh),
    ("tanh", Function::Tanh),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("log10", Function::Log10),
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("sign", Function::Sign),
    ("floor", Function::Floor),
    ("ceil", Function::Ceil),
];

/// Functions of several arguments.
const OF_SEVERAL: [&str; 6] = ["min", "max", "atan2", "hypot", "pow", "if"];

/// The names of all functions.
pub fn function_names() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|f| f.0).chain(OF_SEVERAL)
}

fn function(name: &str) -> Option<Function> {
    FUNCTIONS.iter().find(|(n, _)| *n == name).map(|(_, f)| *f)
}

#[cfg(test)]
mod tests {
    use super::super::Scope;
    use super::*;
    use proptest::prelude::*;
    use signorini_geometry::{Jet, Real};

    fn names() -> Names {
        let mut names = Names { variables: vec!["x", "y", "z", "t"], ..Names::default() };
        names.constants.insert("R".into(), 2.0);
        names
            .functions
            .insert("cycle".into(), Arc::new(Definition::Table { t: vec![0., 1., 2.], value: vec![0., 1., 0.] }));
        names
    }

    fn value(text: &str, x: f64, y: f64) -> f64 {
        parse(text, &names()).unwrap().evaluate(&Scope { position: [x, y, 0.0], time: 1.5 })
    }

    #[test]
    fn arithmetic_follows_the_usual_rules() {
        for (text, expected) in [
            ("1e-3*x + 2", 2.0005),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("2^3^2", 512.0),
            ("(1 - 2) - 3", -4.0),
            ("8/4/2", 1.0),
            ("if(x > 0.4 && y < 0, 1, sqrt(-1))", 1.0),
            ("max(x, R, y) + min(1, pi)", 3.0),
            ("cycle(t)", 0.5),
            ("2*e", 2.0 * std::f64::consts::E),
            ("atan2(y, x)", (-1.0f64).atan2(0.5)),
            ("x^2 + abs(y)", 1.25),
        ] {
            assert!((value(text, 0.5, -1.0) - expected).abs() < 1e-14, "{text}");
        }
        assert!(value("sqrt(x)", -1.0, 0.0).is_nan());
        assert!(value("min(sqrt(x), 1)", -1.0, 0.0).is_nan());
    }

    #[test]
    fn errors_point_at_the_character() {
        for (text, start, word) in [
            ("2*(x+1", 6, "expected `)`"),
            ("2*x y", 4, "unexpected name"),
            ("2 $ x", 2, "unexpected character"),
            ("coss(x)", 0, "unknown function"),
            ("1 + q", 4, "unknown name"),
            ("", 0, "expected a number"),
            ("sin(x, y)", 0, "takes one argument"),
            ("x)", 1, "unexpected `)`"),
        ] {
            let error = parse(text, &names()).unwrap_err();
            assert!(error.span.start == start && error.message.contains(word), "{text}: {error:?}");
        }
        assert!(parse("coss(x)", &names()).unwrap_err().help.unwrap().contains("`cos`"));
        assert!(parse("r^2", &names()).unwrap_err().help.unwrap().contains("hypot"));
        let deep = "(".repeat(1000);
        assert!(parse(&deep, &names()).unwrap_err().message.contains("nested"));
        assert!(parse(&"1+".repeat(100_000), &names()).is_err());
    }

    #[test]
    fn jets_of_every_function_agree_with_differences() {
        for text in [
            "sin(x*y)",
            "cos(x)*tan(y)",
            "asin(x/3)",
            "acos(x*y/3)",
            "atan(x+y)",
            "sinh(x)*cosh(y)",
            "tanh(x-y)",
            "exp(x*y)",
            "log(x+2)",
            "log10(y+3)",
            "sqrt(x^2+y^2)",
            "abs(x*y)*x",
            "atan2(y, x)",
            "atan2(x, y)",
            "hypot(x, y)",
            "(x+2)^(y)",
            "x^3*y",
            "max(x, y)^2",
            "if(x > y, x^2, y^3)",
            "x/(y+3)",
            "cycle(x*y)^2",
        ] {
            let e = parse(text, &names()).unwrap();
            let at = |x: f64, y: f64| e.evaluate(&Scope { position: [x, y, 0.0], time: 0.0 });
            let (x, y, d) = (0.7, 0.9, 1e-4);
            let jet: Jet<2> = e.evaluate(&Scope {
                position: [Jet::variable(x, 0), Jet::variable(y, 1), Jet::constant(0.0)],
                time: Jet::constant(0.0),
            });
            assert!((jet.value - at(x, y)).abs() < 1e-13, "{text}");
            let gx = (at(x + d, y) - at(x - d, y)) / (2.0 * d);
            let gy = (at(x, y + d) - at(x, y - d)) / (2.0 * d);
            assert!((jet.gradient[0] - gx).abs() < 1e-6 && (jet.gradient[1] - gy).abs() < 1e-6, "{text}");
            let hxx = (at(x + d, y) - 2.0 * at(x, y) + at(x - d, y)) / (d * d);
            let hxy = (at(x + d, y + d) - at(x + d, y - d) - at(x - d, y + d) + at(x - d, y - d)) / (4.0 * d * d);
            assert!((jet.hessian[(0, 0)] - hxx).abs() < 1e-5 && (jet.hessian[(0, 1)] - hxy).abs() < 1e-5, "{text}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn no_text_makes_the_parser_panic(text in "\\PC{0,60}") {
            let _ = parse(&text, &names());
        }
        #[test]
        fn no_sequence_of_its_own_words_makes_the_parser_panic(
            words in proptest::collection::vec(prop::sample::select(vec![
                "x", "y", "t", "1", "2.5e-3", ".5", "(", ")", ",", "+", "-", "*", "/", "^", "sin", "if", "min", "<", "&&", "!", "R", "cycle", "é",
            ]), 0..40)
        ) {
            if let Ok(e) = parse(&words.join(" "), &names()) {
                let _: Jet<2> = e.evaluate(&Scope {
                    position: [Jet::variable(0.3, 0), Jet::variable(0.2, 1), Jet::constant(0.0)],
                    time: Jet::constant(0.0),
                });
            }
        }
    }
}
