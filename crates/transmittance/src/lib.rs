//! Estimators of exp(-optical thickness), each beside its closed-form moments.
