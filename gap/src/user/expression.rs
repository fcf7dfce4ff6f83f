//! Arithmetic expressions over named signals and parameters.
//!
//! Grammar: sums and products of numbers, names, `f(x)` and `f(x, y)`, parentheses, unary minus and
//! `^` for powers (right-associative, binds tighter than unary minus).

/// A parsed expression over an indexed list of names.
#[derive(Debug, Clone)]
pub enum Expression {
    /// A constant as it was written.
    Number(f64),
    /// The value at this index of the names.
    Name(usize),
    /// A function of one argument.
    Call1(fn(f64) -> f64, Box<Expression>),
    /// A function or operator of two arguments.
    Call2(fn(f64, f64) -> f64, Box<Expression>, Box<Expression>),
}

/// What is wrong in an expression, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpressionError {
    /// Character, from 0.
    pub at: usize,
    /// What is wrong.
    pub what: String,
}

impl ExpressionError {
    /// The expression with a caret below the fault.
    pub fn with_caret(&self, text: &str) -> String {
        format!("{}\n  {text}\n  {}^", self.what, " ".repeat(self.at))
    }
}

/// Deepest nesting, so that no input exhausts the stack.
const DEEPEST: usize = 100;

impl Expression {
    /// Parses a text in which `names` may occur.
    ///
    /// # Errors
    /// [`ExpressionError`] with the place.
    pub fn parse(text: &str, names: &[String]) -> Result<Self, ExpressionError> {
        let characters: Vec<char> = text.chars().collect();
        let mut parser = Parser { characters: &characters, at: 0, names, depth: 0 };
        let expression = parser.sum()?;
        parser.blanks();
        if parser.at < characters.len() {
            return Err(parser.fault(format!("`{}` does not belong here", characters[parser.at])));
        }
        Ok(expression)
    }

    /// Its value for values of the names.
    pub fn value(&self, values: &[f64]) -> f64 {
        match self {
            Self::Number(x) => *x,
            Self::Name(i) => values.get(*i).copied().unwrap_or(f64::NAN),
            Self::Call1(f, a) => f(a.value(values)),
            Self::Call2(f, a, b) => f(a.value(values), b.value(values)),
        }
    }
}

struct Parser<'a> {
    characters: &'a [char],
    at: usize,
    names: &'a [String],
    depth: usize,
}

impl Parser<'_> {
    fn fault(&self, what: impl Into<String>) -> ExpressionError {
        ExpressionError { at: self.at, what: what.into() }
    }

    fn blanks(&mut self) {
        while self.characters.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
    }

    fn take(&mut self, wanted: char) -> bool {
        self.blanks();
        let found = self.characters.get(self.at) == Some(&wanted);
        self.at += usize::from(found);
        found
    }

    fn sum(&mut self) -> Result<Expression, ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault("nested too deeply"));
        }
        let mut left = self.product()?;
        loop {
            let f: fn(f64, f64) -> f64 = if self.take('+') {
                |a, b| a + b
            } else if self.take('-') {
                |a, b| a - b
            } else {
                self.depth -= 1;
                return Ok(left);
            };
            left = Expression::Call2(f, Box::new(left), Box::new(self.product()?));
        }
    }

    fn product(&mut self) -> Result<Expression, ExpressionError> {
        let mut left = self.signed()?;
        loop {
            let f: fn(f64, f64) -> f64 = if self.take('*') {
                |a, b| a * b
            } else if self.take('/') {
                |a, b| a / b
            } else {
                return Ok(left);
            };
            left = Expression::Call2(f, Box::new(left), Box::new(self.signed()?));
        }
    }

    fn signed(&mut self) -> Result<Expression, ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault("nested too deeply"));
        }
        let negative = self.take('-');
        let inner = if negative { self.signed()? } else { self.power()? };
        self.depth -= 1;
        Ok(if negative { Expression::Call1(|x| -x, Box::new(inner)) } else { inner })
    }

    fn power(&mut self) -> Result<Expression, ExpressionError> {
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let exponent = self.signed()?;
        Ok(Expression::Call2(f64::powf, Box::new(base), Box::new(exponent)))
    }

    fn atom(&mut self) -> Result<Expression, ExpressionError> {
        self.blanks();
        let Some(first) = self.characters.get(self.at).copied() else {
            return Err(self.fault("something is missing here"));
        };
        if self.take('(') {
            let inner = self.sum()?;
            return if self.take(')') { Ok(inner) } else { Err(self.fault("a `)` is missing here")) };
        }
        let start = self.at;
        if first.is_ascii_digit() || first == '.' {
            let mut end = start;
            while self.characters.get(end).is_some_and(|c| {
                c.is_ascii_alphanumeric()
                    || *c == '.'
                    || ((*c == '-' || *c == '+') && matches!(self.characters[end - 1], 'e' | 'E'))
            }) {
                end += 1;
            }
            let text: String = self.characters[start..end].iter().collect();
            let number = text.parse().map_err(|_| self.fault(format!("`{text}` is no number")))?;
            self.at = end;
            return Ok(Expression::Number(number));
        }
        if !(first.is_alphabetic() || first == '_') {
            return Err(self.fault(format!("`{first}` does not belong here")));
        }
        let mut end = start;
        while self.characters.get(end).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
            end += 1;
        }
        let name: String = self.characters[start..end].iter().collect();
        self.at = end;
        if self.take('(') {
            return self.call(&name, start);
        }
        if let Some(i) = self.names.iter().position(|n| *n == name) {
            return Ok(Expression::Name(i));
        }
        if name == "pi" {
            return Ok(Expression::Number(std::f64::consts::PI));
        }
        let what = format!("`{name}` is no signal or parameter; known are {}", self.names.join(", "));
        Err(ExpressionError { at: start, what })
    }

    fn call(&mut self, name: &str, start: usize) -> Result<Expression, ExpressionError> {
        let one: Option<fn(f64) -> f64> = match name {
            "sin" => Some(f64::sin),
            "cos" => Some(f64::cos),
            "tan" => Some(f64::tan),
            "tanh" => Some(f64::tanh),
            "abs" => Some(f64::abs),
            "sqrt" => Some(f64::sqrt),
            "exp" => Some(f64::exp),
            "log" => Some(f64::ln),
            "sign" => Some(|x| if x == 0.0 { 0.0 } else { x.signum() }),
            "step" => Some(|x| f64::from(u8::from(x > 0.0))),
            _ => None,
        };
        let two: Option<fn(f64, f64) -> f64> = match name {
            "min" => Some(f64::min),
            "max" => Some(f64::max),
            "atan2" => Some(f64::atan2),
            _ => None,
        };
        let known = "sin, cos, tan, tanh, abs, sqrt, exp, log, sign, step, min, max, atan2";
        if one.is_none() && two.is_none() {
            return Err(ExpressionError { at: start, what: format!("`{name}` is no function; known are {known}") });
        }
        let first = self.sum()?;
        let expression = match (one, two) {
            (Some(f), _) => Expression::Call1(f, Box::new(first)),
            (None, Some(f)) => {
                if !self.take(',') {
                    return Err(self.fault(format!("`{name}` takes two arguments")));
                }
                Expression::Call2(f, Box::new(first), Box::new(self.sum()?))
            }
            (None, None) => first,
        };
        if self.take(')') { Ok(expression) } else { Err(self.fault("a `)` is missing here")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text, &["w".to_owned(), "c".to_owned()]).unwrap().value(&[2.0, 3.0])
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        assert_eq!(value("1 + 2 * w ^ 2"), 9.0);
        assert_eq!(value("-w^2"), -4.0);
        assert_eq!(value("2^3^0.0"), 2.0);
        assert_eq!(value("-c * w * abs(-w) / (1e1 + 2.0e-0)"), -1.0);
        assert_eq!(value("max(w, c) - min(w, c) - sign(-0.5) + step(w)"), 3.0);
    }

    #[test]
    fn faults_get_a_caret() {
        let table = [
            ("-c * ww", 5, "`ww` is no signal"),
            ("c *", 3, "something is missing"),
            ("sine(w)", 0, "`sine` is no function"),
            ("(w + 1", 6, "a `)` is missing"),
            ("w ? 2", 2, "`?` does not belong"),
            ("max(w)", 5, "takes two"),
            ("1.2.3", 0, "is no number"),
        ];
        for (text, at, what) in table {
            let e = Expression::parse(text, &["w".to_owned(), "c".to_owned()]).unwrap_err();
            assert!(e.at == at && e.what.contains(what), "{text}: {e:?}");
            assert!(e.with_caret(text).ends_with(&format!("\n  {}^", " ".repeat(at))));
        }
    }

    proptest! {
        #[test]
        fn nothing_panics(text in "[w c0-9+*/^().,a-z -]{0,400}") {
            if let Ok(e) = Expression::parse(&text, &["w".to_owned(), "c".to_owned()]) {
                let _ = e.value(&[1.0, 2.0]);
            }
            let _ = Expression::parse(&"(".repeat(text.len() * 100), &[]);
        }
    }
}
