//! Mergeable moments, tests of a mean and a variance, and their verdicts.
