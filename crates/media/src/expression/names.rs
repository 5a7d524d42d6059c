//! The names that every formula may use.

use super::program::Binary;

/// A function of one argument or of two.
#[derive(Clone, Copy)]
pub(super) enum Function {
    Unary(fn(f64) -> f64),
    Binary(Binary),
}

pub(super) const FUNCTIONS: [(&str, Function); 11] = [
    ("sin", Function::Unary(f64::sin)),
    ("cos", Function::Unary(f64::cos)),
    ("tan", Function::Unary(f64::tan)),
    ("exp", Function::Unary(f64::exp)),
    ("ln", Function::Unary(f64::ln)),
    ("sqrt", Function::Unary(f64::sqrt)),
    ("abs", Function::Unary(f64::abs)),
    ("floor", Function::Unary(f64::floor)),
    ("ceil", Function::Unary(f64::ceil)),
    ("min", Function::Binary(Binary::Min)),
    ("max", Function::Binary(Binary::Max)),
];

pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// The entry of a table under a name.
pub(super) fn find<T: Copy>(table: &[(&str, T)], name: &str) -> Option<T> {
    table.iter().find(|(known, _)| *known == name).map(|&(_, value)| value)
}
