//! Parsed expressions and their values.

use super::function::FieldFunction;
use super::scope::Scope;
use signorini_geometry::Real;
use signorini_geometry::height_field::{self, HeightField};
use std::sync::Arc;

/// Deepest nesting of an expression: deeper ones are refused, so that no input exhausts the stack.
pub const MAX_DEPTH: usize = 100;
/// Most words of an expression, for the same reason.
pub const MAX_TOKENS: usize = 4000;

/// A parsed expression.
#[derive(Clone, Debug)]
pub struct Expression {
    pub(super) root: Node,
}

#[derive(Clone, Debug)]
pub(super) enum Node {
    Number(f64),
    Position(usize),
    Time,
    Negate(Box<Node>),
    Binary(Binary, Box<Node>, Box<Node>),
    Compare(Compare, Box<Node>, Box<Node>),
    Not(Box<Node>),
    Call(Function, Box<Node>),
    Pair(PairFunction, Box<Node>, Box<Node>),
    If(Box<Node>, Box<Node>, Box<Node>),
    User(Arc<Definition>, Box<Node>),
    /// A height over x and y that no expression states.
    Height(Arc<dyn HeightField>),
    /// A function of the program.
    Field(FieldFunction),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compare {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

/// Functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Floor,
    Ceil,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PairFunction {
    Min,
    Max,
    Atan2,
    Hypot,
}

/// A user's function of one argument, named `t` in its definition.
#[derive(Debug)]
pub enum Definition {
    Formula(Expression),
    /// Piecewise linear between the points, constant beyond them.
    Table {
        t: Vec<f64>,
        value: Vec<f64>,
    },
}

impl Definition {
    fn evaluate<R: Real>(&self, argument: R) -> R {
        match self {
            Definition::Formula(body) => {
                let nothing = R::constant(f64::NAN);
                body.evaluate(&Scope { position: [nothing; 3], time: argument })
            }
            Definition::Table { t, value } => {
                let x = argument.value();
                let last = t.len() - 1;
                if x.is_nan() || x <= t[0] || last == 0 {
                    return R::constant(if x.is_nan() { x } else { value[0] });
                }
                if x >= t[last] {
                    return R::constant(value[last]);
                }
                let i = t.partition_point(|v| *v <= x).clamp(1, last) - 1;
                let slope = (value[i + 1] - value[i]) / (t[i + 1] - t[i]);
                argument.chain(value[i] + slope * (x - t[i]), slope, 0.0)
            }
        }
    }
}

impl Expression {
    /// An expression that is a number.
    pub fn number(value: f64) -> Self {
        Self { root: Node::Number(value) }
    }

    /// A height over x and y that no expression states.
    pub fn height(height: Arc<dyn HeightField>) -> Self {
        Self { root: Node::Height(height) }
    }

    /// A function of the program.
    pub fn function(function: FieldFunction) -> Self {
        Self { root: Node::Field(function) }
    }

    /// The height that the expression is, if no expression states it.
    pub fn as_height(&self) -> Option<&dyn HeightField> {
        match &self.root {
            Node::Height(height) => Some(&**height),
            _ => None,
        }
    }

    /// The expression multiplied by a number: a unit.
    pub fn scaled(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let product = Node::Binary(Binary::Multiply, Box::new(self.root), Box::new(Node::Number(factor)));
        Self { root: product.folded() }
    }

    /// The expression plus a number: the zero of a scale.
    #[must_use]
    pub fn shifted(self, by: f64) -> Self {
        if by == 0.0 {
            return self;
        }
        let sum = Node::Binary(Binary::Add, Box::new(self.root), Box::new(Node::Number(by)));
        Self { root: sum.folded() }
    }

    /// Value, and derivatives where the scope holds jets.
    pub fn evaluate<R: Real>(&self, scope: &Scope<R>) -> R {
        self.root.evaluate(scope)
    }

    /// The value if the expression contains neither position nor time.
    pub fn constant(&self) -> Option<f64> {
        match self.root {
            Node::Number(v) => Some(v),
            _ => None,
        }
    }

    /// Whether the expression depends on time.
    pub fn uses_time(&self) -> bool {
        self.root.any(&|n| match n {
            Node::Time => true,
            Node::Field(f) => f.varies(),
            _ => false,
        })
    }

    /// Whether the expression depends on a coordinate (0, 1, 2).
    pub fn uses_position(&self, axis: usize) -> bool {
        self.root.any(&|n| match n {
            Node::Position(k) => *k == axis,
            Node::Height(_) => axis < 2,
            Node::Field(_) => true,
            _ => false,
        })
    }

    /// Whether the value says yes or no: a comparison, or what is put together from such.
    pub fn is_condition(&self) -> bool {
        self.root.is_condition()
    }

    /// The expression at a fixed time.
    pub fn at_time(&self, time: f64) -> Self {
        Self { root: self.root.with_time(time).folded() }
    }
}

impl Node {
    fn children(&self) -> Vec<&Node> {
        match self {
            Node::Number(_) | Node::Position(_) | Node::Time | Node::Height(_) | Node::Field(_) => vec![],
            Node::Negate(a) | Node::Not(a) | Node::Call(_, a) | Node::User(_, a) => vec![a],
            Node::Binary(_, a, b) | Node::Compare(_, a, b) | Node::Pair(_, a, b) => vec![a, b],
            Node::If(a, b, c) => vec![a, b, c],
        }
    }

    fn is_condition(&self) -> bool {
        match self {
            Node::Compare(Compare::And | Compare::Or, a, b) | Node::If(_, a, b) => a.is_condition() && b.is_condition(),
            // Products and sums of conditions are used as `and` and `or`.
            Node::Binary(Binary::Multiply | Binary::Add, a, b)
            | Node::Pair(PairFunction::Min | PairFunction::Max, a, b) => a.is_condition() && b.is_condition(),
            Node::Not(a) => a.is_condition(),
            Node::Compare(..) | Node::Field(_) => true,
            Node::User(f, _) => matches!(&**f, Definition::Formula(body) if body.is_condition()),
            _ => false,
        }
    }

    fn any(&self, test: &impl Fn(&Node) -> bool) -> bool {
        test(self) || self.children().into_iter().any(|c| c.any(test))
    }

    fn map(&self, f: &impl Fn(&Node) -> Node) -> Node {
        let sub = |n: &Node| Box::new(f(n));
        match self {
            Node::Number(_) | Node::Position(_) | Node::Time | Node::Height(_) | Node::Field(_) => self.clone(),
            Node::Negate(a) => Node::Negate(sub(a)),
            Node::Not(a) => Node::Not(sub(a)),
            Node::Call(g, a) => Node::Call(*g, sub(a)),
            Node::User(g, a) => Node::User(g.clone(), sub(a)),
            Node::Binary(o, a, b) => Node::Binary(*o, sub(a), sub(b)),
            Node::Compare(o, a, b) => Node::Compare(*o, sub(a), sub(b)),
            Node::Pair(g, a, b) => Node::Pair(*g, sub(a), sub(b)),
            Node::If(a, b, c) => Node::If(sub(a), sub(b), sub(c)),
        }
    }

    fn with_time(&self, time: f64) -> Node {
        match self {
            Node::Time => Node::Number(time),
            Node::Field(f) => Node::Field(f.at_time(time)),
            other => other.map(&|n| n.with_time(time)),
        }
    }

    /// Parts without position and time replaced by their value.
    pub(super) fn folded(self) -> Node {
        if self.any(&|n| matches!(n, Node::Position(_) | Node::Time | Node::Height(_) | Node::Field(_))) {
            return self.map(&|n| n.clone().folded());
        }
        Node::Number(self.evaluate(&Scope { position: [f64::NAN; 3], time: f64::NAN }))
    }

    fn evaluate<R: Real>(&self, scope: &Scope<R>) -> R {
        match self {
            Node::Number(v) => R::constant(*v),
            Node::Position(k) => scope.position[*k],
            Node::Time => scope.time,
            Node::Negate(a) => -a.evaluate(scope),
            Node::Not(a) => R::constant(f64::from(a.evaluate(scope).value() == 0.0)),
            Node::Binary(o, a, b) => binary(*o, a.evaluate(scope), b.evaluate(scope)),
            Node::Compare(o, a, b) => {
                R::constant(f64::from(compare(*o, a.evaluate(scope).value(), b.evaluate(scope).value())))
            }
            Node::Call(f, a) => call(*f, a.evaluate(scope)),
            Node::Pair(f, a, b) => pair(*f, a.evaluate(scope), b.evaluate(scope)),
            // Only the branch that holds is evaluated: the other may be undefined here.
            Node::If(c, a, b) => {
                let branch = if c.evaluate(scope).value() != 0.0 { a } else { b };
                branch.evaluate(scope)
            }
            Node::User(f, a) => f.evaluate(a.evaluate(scope)),
            Node::Height(height) => height_field::evaluate(&**height, scope.position[0], scope.position[1]),
            Node::Field(f) => f.evaluate(scope),
        }
    }
}

pub(super) fn binary<R: Real>(o: Binary, a: R, b: R) -> R {
    match o {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Power => power(a, b),
    }
}

pub(super) fn power<R: Real>(a: R, b: R) -> R {
    // A constant exponent leaves negative bases their real powers.
    if b.is_constant() { a.powf(b.value()) } else { call(Function::Exp, b * call(Function::Log, a)) }
}

pub(super) fn compare(o: Compare, a: f64, b: f64) -> bool {
    match o {
        Compare::Less => a < b,
        Compare::LessEqual => a <= b,
        Compare::Greater => a > b,
        Compare::GreaterEqual => a >= b,
        Compare::Equal => a == b,
        Compare::NotEqual => a != b,
        Compare::And => a != 0.0 && b != 0.0,
        Compare::Or => a != 0.0 || b != 0.0,
    }
}

pub(super) fn call<R: Real>(f: Function, a: R) -> R {
    let x = a.value();
    let (v, d, dd) = match f {
        Function::Sin => (x.sin(), x.cos(), -x.sin()),
        Function::Cos => (x.cos(), -x.sin(), -x.cos()),
        Function::Tan => {
            let t = x.tan();
            (t, 1.0 + t * t, 2.0 * t * (1.0 + t * t))
        }
        Function::Asin => {
            let c = (1.0 - x * x).sqrt();
            (x.asin(), 1.0 / c, x / c.powi(3))
        }
        Function::Acos => {
            let c = (1.0 - x * x).sqrt();
            (x.acos(), -1.0 / c, -x / c.powi(3))
        }
        Function::Atan => {
            let r = 1.0 / (1.0 + x * x);
            (x.atan(), r, -2.0 * x * r * r)
        }
        Function::Sinh => (x.sinh(), x.cosh(), x.sinh()),
        Function::Cosh => (x.cosh(), x.sinh(), x.cosh()),
        Function::Tanh => {
            let t = x.tanh();
            (t, 1.0 - t * t, -2.0 * t * (1.0 - t * t))
        }
        Function::Exp => (x.exp(), x.exp(), x.exp()),
        Function::Log => (x.ln(), 1.0 / x, -1.0 / (x * x)),
        Function::Log10 => {
            let c = std::f64::consts::LOG10_E;
            (x.log10(), c / x, -c / (x * x))
        }
        Function::Sqrt => {
            let r = x.sqrt();
            (r, 0.5 / r, -0.25 / (r * x))
        }
        Function::Abs => (x.abs(), if x < 0.0 { -1.0 } else { 1.0 }, 0.0),
        Function::Sign => (if x == 0.0 { 0.0 } else { x.signum() }, 0.0, 0.0),
        Function::Floor => (x.floor(), 0.0, 0.0),
        Function::Ceil => (x.ceil(), 0.0, 0.0),
    };
    a.chain(v, d, dd)
}

pub(super) fn pair<R: Real>(f: PairFunction, a: R, b: R) -> R {
    match f {
        // A number that is not one is not swallowed.
        PairFunction::Min => {
            if a.value().is_nan() || a.value() < b.value() {
                a
            } else {
                b
            }
        }
        PairFunction::Max => {
            if a.value().is_nan() || a.value() > b.value() {
                a
            } else {
                b
            }
        }
        PairFunction::Hypot => call(Function::Sqrt, a * a + b * b),
        PairFunction::Atan2 => {
            // The angle of (b, a), by the quotient that is regular there; the branch only adds a constant.
            let (y, x) = (a.value(), b.value());
            if x == 0.0 && y == 0.0 {
                return a.chain(y.atan2(x), f64::NAN, f64::NAN);
            }
            let angle = if x.abs() > y.abs() { call(Function::Atan, a / b) } else { -call(Function::Atan, b / a) };
            angle + R::constant(y.atan2(x) - angle.value())
        }
    }
}
