//! OpenVDB fog volumes from bytes.
