//! The stack machine that evaluates a formula.

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unary {
    Negate,
    Sin,
    Cos,
    Tan,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Floor,
    Ceil,
}

impl Unary {
    #[inline]
    fn apply(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
        }
    }
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
}

impl Binary {
    #[inline]
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => a.powf(b),
            // Unlike `f64::min` and `f64::max` these pass NaN on, from either side.
            Self::Min => {
                if a < b || a.is_nan() {
                    a
                } else {
                    b
                }
            }
            Self::Max => {
                if a > b || a.is_nan() {
                    a
                } else {
                    b
                }
            }
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Instruction {
    Number(f64),
    Variable(usize),
    Unary(Unary),
    /// The operands are the two topmost results.
    Binary(Binary),
    /// The second operand is a number, or a variable, that needs not go over the stack.
    BinaryNumber(Binary, f64),
    BinaryVariable(Binary, usize),
}

/// A formula in postfix order.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    instructions: Vec<Instruction>,
    /// Number of intermediate results after the instructions so far.
    height: usize,
}

impl Program {
    /// The greatest number of intermediate results. Terms in a row need one more than each of them; only nesting on the
    /// right needs many.
    pub(super) const HEIGHT: usize = 32;

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn number(&mut self, value: f64) {
        self.instructions.push(Instruction::Number(value));
        self.height += 1;
    }

    pub(super) fn variable(&mut self, index: usize) {
        self.instructions.push(Instruction::Variable(index));
        self.height += 1;
    }

    pub(super) fn unary(&mut self, function: Unary) {
        match self.instructions.last_mut() {
            Some(Instruction::Number(x)) => *x = function.apply(*x),
            _ => self.instructions.push(Instruction::Unary(function)),
        }
    }

    pub(super) fn binary(&mut self, operation: Binary) {
        self.height -= 1;
        // What ends in an operation ends in an instruction for it: a number or a variable at the end is the whole second
        // operand, and two numbers are both operands.
        let fused = match self.instructions[..] {
            [.., Instruction::Number(a), Instruction::Number(b)] => {
                self.instructions.pop();
                Instruction::Number(operation.apply(a, b))
            }
            [.., Instruction::Number(b)] => Instruction::BinaryNumber(operation, b),
            [.., Instruction::Variable(index)] => Instruction::BinaryVariable(operation, index),
            _ => {
                self.instructions.push(Instruction::Binary(operation));
                return;
            }
        };
        self.instructions.pop();
        self.instructions.push(fused);
    }

    /// The value of the formula.
    #[inline]
    pub(super) fn eval(&self, variables: &[f64]) -> f64 {
        // The topmost result is kept beside the stack, where an operation needs no memory for it.
        let mut stack = [0.0; Self::HEIGHT];
        let mut below = 0;
        let mut top = 0.0;
        for instruction in &self.instructions {
            match *instruction {
                Instruction::Number(value) => {
                    stack[below] = std::mem::replace(&mut top, value);
                    below += 1;
                }
                Instruction::Variable(index) => {
                    stack[below] = std::mem::replace(&mut top, variables[index]);
                    below += 1;
                }
                Instruction::Unary(function) => top = function.apply(top),
                Instruction::Binary(operation) => {
                    below -= 1;
                    top = operation.apply(stack[below], top);
                }
                Instruction::BinaryNumber(operation, value) => top = operation.apply(top, value),
                Instruction::BinaryVariable(operation, index) => top = operation.apply(top, variables[index]),
            }
        }
        top
    }
}

/// Operations on one kind of value, besides numbers, over which a formula can be evaluated.
pub(super) trait Algebra {
    /// Type of operands and results.
    type Value: Clone;
    fn number(&mut self, value: f64) -> Self::Value;
    fn variable(&mut self, index: usize) -> Self::Value;
    fn unary(&mut self, function: Unary, operand: Self::Value) -> Self::Value;
    fn binary(&mut self, operation: Binary, left: Self::Value, right: Self::Value) -> Self::Value;
    /// A power whose exponent is a number of the formula.
    fn power(&mut self, base: Self::Value, exponent: f64) -> Self::Value;
}

impl Program {
    /// The value of the formula in another algebra.
    pub(super) fn eval_in<A: Algebra>(&self, algebra: &mut A) -> A::Value {
        let mut stack: Vec<A::Value> = Vec::with_capacity(self.height + 1);
        let pop = |stack: &mut Vec<A::Value>| stack.pop().expect("the parser has counted the operands");
        for instruction in &self.instructions {
            let result = match *instruction {
                Instruction::Number(value) => algebra.number(value),
                Instruction::Variable(index) => algebra.variable(index),
                Instruction::Unary(function) => {
                    let operand = pop(&mut stack);
                    algebra.unary(function, operand)
                }
                Instruction::Binary(operation) => {
                    let right = pop(&mut stack);
                    let left = pop(&mut stack);
                    algebra.binary(operation, left, right)
                }
                Instruction::BinaryNumber(Binary::Power, exponent) => {
                    let base = pop(&mut stack);
                    algebra.power(base, exponent)
                }
                Instruction::BinaryNumber(operation, value) => {
                    let (left, right) = (pop(&mut stack), algebra.number(value));
                    algebra.binary(operation, left, right)
                }
                Instruction::BinaryVariable(operation, index) => {
                    let (left, right) = (pop(&mut stack), algebra.variable(index));
                    algebra.binary(operation, left, right)
                }
            };
            stack.push(result);
        }
        pop(&mut stack)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn postfix_order() {
        let mut program = Program::default();
        program.variable(0);
        program.variable(1);
        program.number(2.0);
        program.binary(Binary::Power);
        program.binary(Binary::Subtract);
        program.unary(Unary::Abs);
        assert_eq!(program.height(), 1);
        assert_eq!(program.eval(&[1.0, 3.0]), 8.0);
    }

    #[test]
    fn constants_are_folded() {
        let mut program = Program::default();
        program.number(2.0);
        program.number(3.0);
        program.binary(Binary::Multiply);
        program.unary(Unary::Negate);
        assert!(matches!(program.instructions[..], [Instruction::Number(-6.0)]));
        program.variable(0);
        program.number(1.0);
        program.binary(Binary::Add);
        assert_eq!(program.instructions.len(), 3);
        assert_eq!(program.eval(&[2.0]), 3.0);
    }

    #[test]
    fn nan_passes_through_min_and_max() {
        for operation in [Binary::Min, Binary::Max] {
            assert!(operation.apply(f64::NAN, 1.0).is_nan());
            assert!(operation.apply(1.0, f64::NAN).is_nan());
        }
        assert_eq!((Binary::Min.apply(1.0, 2.0), Binary::Max.apply(1.0, 2.0)), (1.0, 2.0));
    }
}
