//! Bias compensation for bounded virtual point lights, exact and approximate.
//!
//! | part | source | what |
//! |---|---|---|
//! | [`Compensation`] | raab-2008 eq. 15, engelhardt-2013 4 | the recursion, for every choice of [`CompensationOptions`] |
//! | [`TruncatedExponential`] | engelhardt-2013 eq. 4 and 5 | distances within the bounding region |
//! | [`LocalMean`] | engelhardt-2013 4.2 | the extinction that those take for granted |
//! | [`Brightness`] | raab-2008 4.2 | a bound from the scene |

mod bound;
mod compensation;
mod local_mean;
mod options;
mod place;
mod truncated_exponential;

pub use bound::Brightness;
pub use compensation::Compensation;
pub use local_mean::LocalMean;
pub use options::{CompensationOptions, OptionsError, Placement, Strategy, TransmittanceUse, Visibility};
pub use truncated_exponential::TruncatedExponential;
