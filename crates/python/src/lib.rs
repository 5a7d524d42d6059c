//! Python bindings of Fairflight: the native part of the package `fairflight`.
//!
//! A profile (a kind of the harness by its spec, nodes, or a Python callable) and an estimator by its spec go through the harness's own readers,
//! plans and laws: what comes back has the bits, and what is refused the words, of `harness estimate`. The package in front of it, in Python, turns
//! dictionaries into JSON and calls the program; users read its docstrings and its README.
//!
//! ```python
//! import fairflight
//!
//! cloud = fairflight.Profile(lambda s: 0.5 + 0.25 * s, length=2.0, majorant=1.0)
//! drawn = fairflight.draw(cloud, {"kind": "double_particle", "sigma_samp": 1.0}, samples=10_000, seed=1)
//! law = fairflight.moments(cloud, {"kind": "double_particle", "sigma_samp": 1.0})
//! assert fairflight.judge(drawn.values, law.mean, law.variance).sound is not False
//! ```

mod callable;
mod draws;
mod law;
mod profile;
mod spec;
mod verdict;

use pyo3::prelude::*;

/// The native part of the package `fairflight`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<profile::Profile>()?;
    module.add_class::<draws::Draws>()?;
    module.add_class::<law::Law>()?;
    module.add_class::<verdict::Verdict>()?;
    module.add_function(wrap_pyfunction!(draws::draw, module)?)?;
    module.add_function(wrap_pyfunction!(law::moments, module)?)?;
    module.add_function(wrap_pyfunction!(verdict::judge, module)?)
}
