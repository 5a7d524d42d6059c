//! Extinction fields, their profile along a ray, and what is known of them.
