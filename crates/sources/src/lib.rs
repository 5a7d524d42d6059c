//! Uniform variates: seeded, scripted, counting.
