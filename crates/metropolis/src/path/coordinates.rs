//! Coordinates in which mutations are symmetric, and their Jacobians.
//!
//! A mutation that changes coordinates c of a path symmetrically has T(X|Y)/T(Y|X) = J(Y)/J(X), J = |dx/dc|: its ratio is f J(Y)/f J(X), a product over the
//! part of the path that changes (antwerpen-2011 eq. 6.7 to 6.11, with media). The density of x_1 per area of the film is 1/(d² cos³ A), across the ray:
//! antwerpen-2011 eq. 3.18 and 3.19 print the inverse, eq. 6.5 has it as here.

use super::{PathSite, PathState, PathWorld};
use fairflight_elementary::ln;
use std::ops::Range;

/// The way in which an edge of a proposal came to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Made {
    /// The vertex on the light's side was found along a direction from the other, or along a ray from the film.
    FromEye,
    /// The vertex on the camera's side was found along a direction from the other.
    FromLight,
    /// Both ends are given.
    Connected,
}

/// ln of f J over some edges and the scattering at all of their ends, but for colours. `is_scaled` says that vertices in the medium are found at a distance
/// whose logarithm is the coordinate, else the distance itself is.
///
/// With G = D(x) D(y)/r² the factor of an edge x → y is, by the coordinates in which y is found:
///
/// ```text
/// direction ω at x, y on a surface           dA(y) = r²/D(y) dω                  G T J = D(x) T
/// direction ω at x, distance r, y in medium  dV(y) = r² dω dr,  D(y) = 1         G T J = D(x) T
/// the same with ln r                         dr = r d ln r                       G T J = D(x) T r
/// x smooth: its direction is that before it, whose measure dω' |cos'| n'² = dω |cos| n² it keeps; f_s stands for a density
///     ratio · D(x) per dω towards the light, D(x)/ratio towards the camera       G T J = T/ratio, T · ratio
/// film, y = x_1                              dA⊥(x_1) = d² cos³ A d(film)        importance D(x_1) T J = T
/// film, distance                             the same times dr
/// both given                                 J = 1                               G T, of the pinhole importance D(x_1) T
/// ```
///
/// A constant A is left out. An infinitely far end has r = 1 and D = 1: its own coordinate is the direction.
#[inline]
pub(super) fn ln_product(
    world: &dyn PathWorld,
    path: &PathState,
    edges: Range<usize>,
    made: impl Fn(usize) -> Made,
    is_scaled: bool,
) -> f64 {
    let (mut product, mut ln_transmittance) = (1.0, 0.0);
    for i in edges.clone() {
        let edge = &path.edges[i];
        let [x, y] = [&path.vertices[i], &path.vertices[i + 1]];
        ln_transmittance += edge.ln_transmittance;
        let (start, found, is_from_eye) = match made(i) {
            Made::Connected => {
                product *= if i == 0 {
                    world.camera().importance(y.position) * y.facing(edge.direction)
                } else {
                    let squared = if edge.length.is_finite() { edge.length * edge.length } else { 1.0 };
                    x.facing(edge.direction) * y.facing(edge.direction) / squared
                };
                continue;
            }
            Made::FromEye => (x, y, true),
            Made::FromLight => (y, x, false),
        };
        product *= match start.site {
            PathSite::Smooth { ratio, .. } => {
                if is_from_eye {
                    1.0 / ratio
                } else {
                    ratio
                }
            }
            _ => start.facing(edge.direction),
        };
        if is_scaled && found.is_in_medium() {
            product *= edge.length;
        }
    }
    for i in edges.start.max(1)..=edges.end.min(path.len() - 1) {
        product *= path.vertices[i].scatter(world, path.edges[i - 1].direction, path.edges[i].direction);
    }
    ln(product) + ln_transmittance
}
