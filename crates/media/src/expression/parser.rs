//! Parser from the text of a formula to its program.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = { "+" | "-" } power
//! power   = operand [ "^" signed ]
//! operand = number | constant | variable | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```

use super::ExpressionError;
use super::names::{CONSTANTS, FUNCTIONS, Function, find};
use super::program::{Binary, Program, Unary};

/// The program of `expression` in the named variables, which `eval` takes in this order.
pub(super) fn parse(expression: &str, variables: &[&str]) -> Result<Program, ExpressionError> {
    let mut parser = Parser { text: expression, at: 0, variables, program: Program::default(), nesting: 0 };
    parser.sum()?;
    match parser.peek() {
        None => Ok(parser.program),
        Some(')') => Err(parser.error(parser.at, "this ')' closes nothing")),
        Some(_) => Err(parser.expected("an operator")),
    }
}

/// Greatest depth to which parentheses, signs and exponents may nest, so that no text exhausts the stack of the parser.
const DEEPEST: usize = 64;

struct Parser<'a> {
    text: &'a str,
    /// The next character, as an offset in bytes.
    at: usize,
    variables: &'a [&'a str],
    program: Program,
    nesting: usize,
}

type Parsed = Result<(), ExpressionError>;

impl Parser<'_> {
    fn sum(&mut self) -> Parsed {
        self.chain(Self::product, &[('+', Binary::Add), ('-', Binary::Subtract)])
    }

    fn product(&mut self) -> Parsed {
        self.chain(Self::signed, &[('*', Binary::Multiply), ('/', Binary::Divide)])
    }

    /// Operands with operators of one precedence between them, from left to right.
    fn chain(&mut self, operand: fn(&mut Self) -> Parsed, operators: &[(char, Binary)]) -> Parsed {
        operand(self)?;
        while let Some(&(_, operation)) = operators.iter().find(|(sign, _)| self.peek() == Some(*sign)) {
            self.at += 1;
            operand(self)?;
            self.program.binary(operation);
        }
        Ok(())
    }

    /// All recursion passes here: a parenthesis, an exponent.
    fn signed(&mut self) -> Parsed {
        let mut negative = false;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            negative ^= sign == '-';
            self.at += 1;
        }
        if self.nesting == DEEPEST {
            return Err(self.error(self.at, "the formula is nested too deeply here"));
        }
        self.nesting += 1;
        self.power()?;
        self.nesting -= 1;
        // The sign comes after the power: -s^2 is -(s^2).
        if negative {
            self.program.unary(Unary::Negate);
        }
        Ok(())
    }

    fn power(&mut self) -> Parsed {
        self.operand()?;
        if self.peek() == Some('^') {
            self.at += 1;
            // The exponent takes further powers with it: 2^3^2 is 2^(3^2).
            self.signed()?;
            self.program.binary(Binary::Power);
        }
        Ok(())
    }

    fn operand(&mut self) -> Parsed {
        let peeked = self.peek();
        if self.program.height() == Program::HEIGHT {
            return Err(self.error(self.at, "too many operations wait for this operand"));
        }
        match peeked {
            Some('(') => {
                let opened = self.at;
                match self.parenthesis()? {
                    1 => Ok(()),
                    count => Err(self.error(opened, format!("a list of {count} has no value"))),
                }
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if is_name(c) => self.name(),
            _ => Err(self.expected("a number, a name or '('")),
        }
    }

    /// Parses one or more sums in parentheses, separated by commas; returns their number.
    fn parenthesis(&mut self) -> Result<usize, ExpressionError> {
        let opened = self.at;
        self.at += 1;
        let mut count = 0;
        loop {
            self.sum()?;
            count += 1;
            match self.peek() {
                Some(')') => break,
                Some(',') => self.at += 1,
                None => return Err(self.error(opened, "this '(' is never closed")),
                Some(_) => return Err(self.expected("an operator or ')'")),
            }
        }
        self.at += 1;
        Ok(count)
    }

    fn number(&mut self) -> Parsed {
        let start = self.at;
        self.skip(|c| c.is_ascii_digit());
        if self.text[self.at..].starts_with('.') {
            self.at += 1;
            self.skip(|c| c.is_ascii_digit());
        }
        // An exponent counts as one only if digits follow; else the letter starts a name, which is out of place.
        if let Some(rest) = self.text[self.at..].strip_prefix(['e', 'E']) {
            let digits = rest.strip_prefix(['+', '-']).unwrap_or(rest);
            if digits.starts_with(|c: char| c.is_ascii_digit()) {
                self.at = self.text.len() - digits.len();
                self.skip(|c| c.is_ascii_digit());
            }
        }
        match self.text[start..self.at].parse() {
            Ok(value) if f64::is_finite(value) => {
                self.program.number(value);
                Ok(())
            }
            Ok(_) => Err(self.error(start, "this number is too large")),
            Err(_) => Err(self.error(start, "a number needs a digit")),
        }
    }

    fn name(&mut self) -> Parsed {
        let start = self.at;
        self.skip(is_name);
        let text = self.text;
        let name = &text[start..self.at];
        if let Some(index) = self.variables.iter().position(|variable| *variable == name) {
            self.program.variable(index);
            Ok(())
        } else if let Some(value) = find(&CONSTANTS, name) {
            self.program.number(value);
            Ok(())
        } else if let Some(function) = find(&FUNCTIONS, name) {
            self.call(start, name, function)
        } else {
            let (variables, functions) =
                (self.variables.join(", "), FUNCTIONS.map(|(known, _)| known).join(", "));
            let known = format!("the variables are {variables}; besides there are pi, e, {functions}");
            Err(self.error(start, format!("unknown name '{name}': {known}")))
        }
    }

    fn call(&mut self, start: usize, name: &str, function: Function) -> Parsed {
        if self.peek() != Some('(') {
            return Err(self.expected(&format!("'(' after '{name}'")));
        }
        let found = self.parenthesis()?;
        let expected = match function {
            Function::Unary(_) => 1,
            Function::Binary(_) => 2,
        };
        if found != expected {
            return Err(self.error(start, format!("'{name}' takes {expected} argument(s), found {found}")));
        }
        match function {
            Function::Unary(function) => self.program.unary(function),
            Function::Binary(operation) => self.program.binary(operation),
        }
        Ok(())
    }

    /// The next character that is not a space; none at the end.
    fn peek(&mut self) -> Option<char> {
        self.skip(char::is_whitespace);
        self.text[self.at..].chars().next()
    }

    fn skip(&mut self, belongs: impl Fn(char) -> bool) {
        let rest = &self.text[self.at..];
        self.at += rest.find(|c| !belongs(c)).unwrap_or(rest.len());
    }

    fn expected(&self, what: &str) -> ExpressionError {
        let message = match self.text[self.at..].chars().next() {
            Some(found) => format!("expected {what}, found '{found}'"),
            None => format!("expected {what}, found the end"),
        };
        self.error(self.at, message)
    }

    fn error(&self, at: usize, message: impl Into<String>) -> ExpressionError {
        ExpressionError {
            expression: self.text.to_owned(),
            column: self.text[..at].chars().count() + 1,
            message: message.into(),
        }
    }
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(expression: &str) -> f64 {
        parse(expression, &["s"]).unwrap().eval(&[3.0])
    }

    fn error(expression: &str) -> (usize, String) {
        let error = parse(expression, &["s"]).unwrap_err();
        assert_eq!(error.expression, expression);
        (error.column, error.message)
    }

    #[test]
    fn precedence_and_associativity() {
        let cases = [
            ("1-2-3", -4.0),
            ("1-2+3", 2.0),
            ("8/4*2", 4.0),
            ("8/4/2", 1.0),
            ("2+3*4", 14.0),
            ("(2+3)*4", 20.0),
            ("-s^2", -9.0),
            ("(-s)^2", 9.0),
            ("2^3^2", 512.0),
            ("(2^3)^2", 64.0),
            ("2^-1", 0.5),
            ("2^-s^2", 2f64.powi(-9)),
            ("2*-s", -6.0),
            ("1--+-s", -2.0),
            ("-2*s", -6.0),
            ("2^s*5", 40.0),
            ("6/2^-1", 12.0),
        ];
        for (expression, expected) in cases {
            assert_eq!(value(expression), expected, "{expression}");
        }
    }

    #[test]
    fn numbers_constants_and_spaces() {
        let cases = [
            ("1e-3", 1e-3),
            ("1.5E+2", 150.0),
            (".5", 0.5),
            ("2.", 2.0),
            ("2.e1", 20.0),
            ("0", 0.0),
            (" 3\t+\n s ", 6.0),
            ("pi", std::f64::consts::PI),
            ("2*e", 2.0 * std::f64::consts::E),
            ("1e1*e", 10.0 * std::f64::consts::E),
        ];
        for (expression, expected) in cases {
            assert_eq!(value(expression), expected, "{expression}");
        }
    }

    #[test]
    fn functions() {
        let cases = [
            ("sin(s)", 3f64.sin()),
            ("cos (s)", 3f64.cos()),
            ("tan(s)", 3f64.tan()),
            ("exp(-s)", (-3f64).exp()),
            ("ln(s)", 3f64.ln()),
            ("sqrt(s)", 3f64.sqrt()),
            ("abs(-s)", 3.0),
            ("floor(-s/2)", -2.0),
            ("ceil(-s/2)", -1.0),
            ("max(1, min(2, s))", 2.0),
            ("min(max(s,1),min(9,4))", 3.0),
            ("-min(s,1)*2", -2.0),
            ("sin(s)^2+cos(s)^2", 3f64.sin().powf(2.0) + 3f64.cos().powf(2.0)),
            ("0.3 + 0.25*sin(7*s)*exp(-0.2*s)", 0.3 + 0.25 * 21f64.sin() * (-0.2 * 3f64).exp()),
        ];
        for (expression, expected) in cases {
            assert_eq!(value(expression), expected, "{expression}");
        }
    }

    #[test]
    fn what_has_no_value_is_not_finite() {
        for expression in ["ln(-s)", "sqrt(-s)", "0/(s-3)", "(-s)^0.5", "min(ln(-s), 1)", "max(1, ln(-1))"] {
            assert!(value(expression).is_nan(), "{expression}");
        }
        assert_eq!(value("1/(s-3)"), f64::INFINITY);
    }

    #[test]
    fn the_column_of_the_first_offence() {
        let cases = [
            ("", 1, "expected a number, a name or '(', found the end"),
            ("1 +", 4, "found the end"),
            ("1 + * 2", 5, "found '*'"),
            ("2 s", 3, "expected an operator, found 's'"),
            ("2e", 2, "expected an operator, found 'e'"),
            ("1.2.3", 4, "expected an operator"),
            ("(1)(2)", 4, "expected an operator"),
            ("s(2)", 2, "expected an operator"),
            ("2 * (s + 1", 5, "never closed"),
            ("sin(s", 4, "never closed"),
            ("(1 2)", 4, "expected an operator or ')'"),
            ("1 + s) * 2", 6, "closes nothing"),
            ("()", 2, "expected a number"),
            ("1, 2", 2, "expected an operator, found ','"),
            ("s # 2", 3, "found '#'"),
            ("s ** 2", 4, "found '*'"),
            ("σ + t", 1, "unknown name 'σ'"),
            ("µ²", 1, "unknown name"),
            ("1 + é", 5, "unknown name"),
            ("0.3 + 2*x", 9, "unknown name 'x': the variables are s"),
            ("PI", 1, "unknown name 'PI'"),
            ("sin s", 5, "expected '(' after 'sin'"),
            ("1 + min(1)", 5, "'min' takes 2 argument(s), found 1"),
            ("sin(1, 2)", 1, "'sin' takes 1 argument(s), found 2"),
            (".", 1, "a number needs a digit"),
            ("s + .e1", 5, "a number needs a digit"),
            ("1e999", 1, "too large"),
            ("(1, 2)", 1, "a list of 2 has no value"),
        ];
        for (expression, column, message) in cases {
            let found = error(expression);
            assert_eq!(found.0, column, "{expression}: {found:?}");
            assert!(found.1.contains(message), "{expression}: {found:?}");
        }
    }

    #[test]
    fn long_and_deep_formulas() {
        assert_eq!(value(&vec!["s"; 10_000].join("+")), 30_000.0);
        assert_eq!(value(&format!("{}s{}", "(".repeat(40), ")".repeat(40))), 3.0);
        assert_eq!(value(&format!("{}s", "-".repeat(100_000))), 3.0);
        assert_eq!(error(&"(".repeat(100_000)), (65, "the formula is nested too deeply here".to_owned()));
        assert_eq!(error(&"1^".repeat(100_000)).0, 65);
        assert_eq!(error(&"1+(".repeat(60)), (96, "too many operations wait for this operand".to_owned()));
    }

    proptest! {
        #[test]
        fn no_text_panics(expression in "[-+*/^(),. es0-9a-zσ]{0,40}") {
            match parse(&expression, &["s"]) {
                Ok(program) => { program.eval(&[0.5]); }
                Err(error) => prop_assert!((1..=expression.chars().count() + 1).contains(&error.column)),
            }
        }
    }
}
