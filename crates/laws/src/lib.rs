//! The laws of the estimators as functions, their wrong twins and the hard cases as data.
