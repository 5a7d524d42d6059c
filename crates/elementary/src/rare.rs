//! Functions that no inner loop needs: those of the crate `libm`, the same on every machine too.

macro_rules! of_libm {
    ($($(#[$docs:meta])* $name:ident($($argument:ident),+) = $function:ident;)*) => {
        $(
            $(#[$docs])*
            #[inline]
            #[must_use]
            pub fn $name($($argument: f64),+) -> f64 {
                libm::$function($($argument),+)
            }
        )*
    };
}

of_libm! {
    /// x to the power y.
    pow(x, y) = pow;
    /// 2 to the power x.
    exp2(x) = exp2;
    /// The logarithm to the base 2.
    log2(x) = log2;
    /// The logarithm to the base 10.
    log10(x) = log10;
    /// The cube root.
    cbrt(x) = cbrt;
    /// √(x² + y²) without overflow.
    hypot(x, y) = hypot;
    /// The hyperbolic sine.
    sinh(x) = sinh;
    /// The tangent.
    tan(x) = tan;
    /// The angle in [−π/2, π/2] of this sine.
    asin(x) = asin;
    /// The angle in [0, π] of this cosine.
    acos(x) = acos;
    /// The angle in [−π/2, π/2] of this tangent.
    atan(x) = atan;
    /// The angle of the point (x, y) in [−π, π].
    atan2(y, x) = atan2;
}
