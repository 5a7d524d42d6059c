//! The part of an entry of the catalogue that is run.

use fairflight_laws::Run;
use std::fmt::{Debug, Formatter, Result};

/// A function of a run. To a reader of a debug print it is a function.
pub(crate) struct Function<T>(Box<dyn Fn(Run) -> T + Send + Sync>);

impl<T> Function<T> {
    pub(crate) fn new(function: impl Fn(Run) -> T + Send + Sync + 'static) -> Self {
        Self(Box::new(function))
    }

    pub(crate) fn run(&self, run: Run) -> T {
        (self.0)(run)
    }
}

impl<T> Debug for Function<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("Fn(Run)")
    }
}

/// The lists that functions of one name give in each of some modules, joined in this order.
macro_rules! joined {
    ($function:ident of $($module:ident),+) => {{
        let mut all = Vec::new();
        $(all.extend($module::$function());)+
        all
    }};
}
pub(crate) use joined;
