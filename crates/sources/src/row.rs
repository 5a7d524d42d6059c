//! Purposes of variates: what a source that replays a path must know of it.

/// A row of variates: those that a path draws at one vertex for one purpose, in order.
///
/// A flight that meets one collision more then moves no variate of any other row (raab-2008 section 4.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Row {
    /// The end of the path from which the vertex is counted.
    pub end: PathEnd,
    /// Number of the vertex: 0 is the pinhole, or the start on a light.
    pub vertex: u32,
    /// Use of the variates.
    pub purpose: Purpose,
}

/// An end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathEnd {
    /// The camera.
    Camera,
    /// The light.
    Light,
}

/// Use of variates, which says what a small step does to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// The way to the vertex: distances and collisions.
    Flight,
    /// The vertex itself, as far as it is an end, and the direction in which it is left: roulette, reflection or refraction, angles.
    Direction,
    /// What is joined with the vertex: points of lights, transmittance, roulette.
    Connection,
    /// A choice that small steps keep: the number of vertices.
    Kept,
    /// A choice that small steps keep with the probability 0.9, and else make anew: of a strategy among equals.
    Redrawn,
}

impl Row {
    /// The row that is open before any other: the film, or whatever is chosen first.
    pub const FIRST: Self = Self { end: PathEnd::Camera, vertex: 0, purpose: Purpose::Direction };

    const PER_VERTEX: usize = 10;

    /// Way to a vertex.
    #[inline]
    #[must_use]
    pub fn flight(end: PathEnd, vertex: u32) -> Self {
        Self { end, vertex, purpose: Purpose::Flight }
    }

    /// Direction in which a vertex is left.
    #[inline]
    #[must_use]
    pub fn direction(end: PathEnd, vertex: u32) -> Self {
        Self { end, vertex, purpose: Purpose::Direction }
    }

    /// Connections of a vertex.
    #[inline]
    #[must_use]
    pub fn connection(end: PathEnd, vertex: u32) -> Self {
        Self { end, vertex, purpose: Purpose::Connection }
    }

    /// A number of its own for each row, dense where paths are short.
    #[inline]
    pub(crate) fn index(self) -> usize {
        self.vertex as usize * Self::PER_VERTEX + 2 * self.purpose as usize + self.end as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_a_number_of_its_own() {
        let purposes =
            [Purpose::Flight, Purpose::Direction, Purpose::Connection, Purpose::Kept, Purpose::Redrawn];
        let mut numbers: Vec<usize> = (0..20)
            .flat_map(|vertex| purposes.map(|purpose| (vertex, purpose)))
            .flat_map(|(vertex, purpose)| {
                [PathEnd::Camera, PathEnd::Light].map(|end| Row { end, vertex, purpose }.index())
            })
            .collect();
        numbers.sort_unstable();
        assert!(numbers.into_iter().eq(0..20 * Row::PER_VERTEX));
    }
}
