//! Lines along which numbers on a grid have one value: marching squares (Lorensen and Cline 1987, in two dimensions), the ambiguous
//! squares decided as the bilinear interpolant is (Nielson and Hamann 1991).

/// The lines of a level, in units of columns and rows; a closed one ends where it begins.
///
/// The values are row by row, at least two in each direction for there to be a line. Between two of them a line is placed linearly.
/// A square with a corner that is NaN has no line; an infinite value attracts a line to its finite neighbour.
pub(crate) fn isolines(columns: usize, values: &[f64], level: f64) -> Vec<Vec<(f64, f64)>> {
    debug_assert!(columns > 0 && values.len().is_multiple_of(columns), "all rows are of the same length");
    let grid = Grid { columns, rows: values.len() / columns, values, level };
    let mut ends = vec![[None; 2]; 2 * values.len()];
    for row in 0..grid.rows.saturating_sub(1) {
        for column in 0..columns - 1 {
            for [from, to] in grid.segments(column, row).into_iter().flatten() {
                // An edge lies between two squares, and each has one segment that ends on it.
                for (edge, other) in [(from, to), (to, from)] {
                    let free = usize::from(ends[edge][0].is_some());
                    ends[edge][free] = Some(other);
                }
            }
        }
    }
    // Open lines first, from their ends; what remains is closed.
    let single =
        |ends: &[[Option<usize>; 2]], edge: usize| ends[edge][0].is_some() && ends[edge][1].is_none();
    let mut lines = Vec::new();
    for open in [true, false] {
        for edge in 0..ends.len() {
            if ends[edge][0].is_some() && (!open || single(&ends, edge)) {
                lines.push(grid.followed(&mut ends, edge));
            }
        }
    }
    lines
}

struct Grid<'a> {
    columns: usize,
    rows: usize,
    values: &'a [f64],
    level: f64,
}

/// Number of an edge: twice that of the vertex where it begins, one more if it goes to the next row.
type Edge = usize;

impl Grid<'_> {
    /// The pieces of the line in a square.
    fn segments(&self, column: usize, row: usize) -> [Option<[Edge; 2]>; 2] {
        let vertex = row * self.columns + column;
        // Around the square, beginning with the least column and row.
        let corners = [vertex, vertex + 1, vertex + 1 + self.columns, vertex + self.columns];
        let [a, b, c, d] = corners.map(|corner| self.values[corner] - self.level);
        if [a, b, c, d].iter().any(|x| x.is_nan()) {
            return [None, None];
        }
        let low = 2 * vertex;
        let (left, right) = (low + 1, low + 3);
        let high = 2 * (vertex + self.columns);
        let above = [a, b, c, d].map(|x| x >= 0.0);
        let case = above.iter().rev().fold(0, |bits, &above| 2 * bits + u8::from(above));
        match case {
            0 | 15 => [None, None],
            1 | 14 => [Some([left, low]), None],
            2 | 13 => [Some([low, right]), None],
            4 | 11 => [Some([right, high]), None],
            7 | 8 => [Some([high, left]), None],
            3 | 12 => [Some([left, right]), None],
            6 | 9 => [Some([low, high]), None],
            // The interpolant has its saddle above the level where the product of the corners above is the greater: then these
            // two are joined, and the other two cut off.
            _ => {
                let cut_off_a = if case == 5 { a * c < b * d } else { b * d >= a * c };
                if cut_off_a {
                    [Some([left, low]), Some([right, high])]
                } else {
                    [Some([low, right]), Some([high, left])]
                }
            }
        }
    }

    /// The line through an edge, taken out of the list.
    fn followed(&self, ends: &mut [[Option<Edge>; 2]], first: Edge) -> Vec<(f64, f64)> {
        let mut line = vec![self.place(first)];
        let mut here = first;
        while let Some(next) = take(&mut ends[here], None) {
            take(&mut ends[next], Some(here));
            line.push(self.place(next));
            here = next;
        }
        line
    }

    fn place(&self, edge: Edge) -> (f64, f64) {
        let vertex = edge / 2;
        let (column, row) = ((vertex % self.columns) as f64, (vertex / self.columns) as f64);
        let upwards = edge % 2 == 1;
        let end = if upwards { vertex + self.columns } else { vertex + 1 };
        let t = crossing(self.values[vertex] - self.level, self.values[end] - self.level);
        if upwards { (column, row + t) } else { (column + t, row) }
    }
}

/// Where a linear function between these ends of different sign is zero, as a fraction of the way; its limit for an infinite end.
fn crossing(from: f64, to: f64) -> f64 {
    match (from.is_infinite(), to.is_infinite()) {
        (false, false) => from / (from - to),
        (true, false) => 1.0,
        (false, true) => 0.0,
        (true, true) => 0.5,
    }
}

/// Takes this neighbour, or any.
fn take(neighbours: &mut [Option<Edge>; 2], which: Option<Edge>) -> Option<Edge> {
    let found = match which {
        Some(_) if neighbours[0] != which => neighbours[1].take(),
        _ => neighbours[0].take(),
    };
    if neighbours[0].is_none() {
        neighbours.swap(0, 1);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One square, its corners ±1 by the bits of the case, around from the least column and row.
    fn square(case: u8) -> [f64; 4] {
        let corner = |bit: u8| if case >> bit & 1 == 1 { 1.0 } else { -1.0 };
        [corner(0), corner(1), corner(3), corner(2)]
    }

    type Piece = [(f64, f64); 2];

    /// Pairs of ends, each pair and all of them in a fixed order.
    fn pieces(values: [f64; 4]) -> Vec<Piece> {
        let lines = isolines(2, &values, 0.0);
        let mut pieces: Vec<_> = lines.iter().map(|line| [line[0], line[1]]).collect();
        assert!(lines.iter().all(|line| line.len() == 2));
        for piece in &mut pieces {
            piece.sort_by(|p, q| p.partial_cmp(q).unwrap());
        }
        pieces.sort_by(|p, q| p.partial_cmp(q).unwrap());
        pieces
    }

    const LOW: (f64, f64) = (0.5, 0.0);
    const HIGH: (f64, f64) = (0.5, 1.0);
    const LEFT: (f64, f64) = (0.0, 0.5);
    const RIGHT: (f64, f64) = (1.0, 0.5);

    #[test]
    fn all_cases_of_a_square() {
        let expected: [(&[u8], &[Piece]); 7] = [
            (&[0, 15], &[]),
            (&[1, 14], &[[LEFT, LOW]]),
            (&[2, 13], &[[LOW, RIGHT]]),
            (&[4, 11], &[[HIGH, RIGHT]]),
            (&[8, 7], &[[LEFT, HIGH]]),
            (&[3, 12], &[[LEFT, RIGHT]]),
            (&[6, 9], &[[LOW, HIGH]]),
        ];
        let mut seen = 0;
        for (cases, lines) in expected {
            for &case in cases {
                assert_eq!(pieces(square(case)), lines, "case {case}");
                seen += 1;
            }
        }
        // The two saddles are the only others.
        assert_eq!(seen + 2, 16);
    }

    /// In units of the square the interpolant vanishes on a hyperbola; which corners it cuts off depends on its value at the saddle.
    #[test]
    fn saddles_are_decided_by_the_interpolant() {
        let around = |values: [f64; 4]| {
            let [a, b, d, c] = values;
            let saddle = (a * c - b * d) / (a + c - b - d);
            (saddle, pieces(values))
        };
        for (high, low) in [(3.0, -1.0), (1.0, -3.0)] {
            // Case 5: high corners first and third.
            let (saddle, lines) = around([high, low, low, high]);
            assert_eq!(saddle > 0.0, high > 1.0);
            let cuts_first =
                lines.iter().any(|piece| piece.contains(&(0.0, high / (high - low))) && piece[1].1 == 0.0);
            assert_eq!(lines.len(), 2);
            assert_eq!(
                cuts_first,
                saddle < 0.0,
                "the high corners are cut off where the saddle is low: {lines:?}"
            );
            // Case 10: low corners first and third.
            let (saddle, lines) = around([low, high, high, low]);
            assert_eq!(saddle > 0.0, high > 1.0);
            let cuts_first =
                lines.iter().any(|piece| piece.contains(&(0.0, low / (low - high))) && piece[1].1 == 0.0);
            assert_eq!(
                cuts_first,
                saddle > 0.0,
                "the low corners are cut off where the saddle is high: {lines:?}"
            );
        }
    }

    #[test]
    fn a_plane_has_one_straight_line() {
        let values: Vec<f64> = (0..5)
            .flat_map(|row| (0..7).map(move |column| f64::from(column) + 0.5 * f64::from(row)))
            .collect();
        let lines = isolines(7, &values, 3.2);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|(x, y)| (x + 0.5 * y - 3.2).abs() < 1e-12));
        let rows: Vec<f64> = lines[0].iter().map(|point| point.1).collect();
        assert!(rows.is_sorted() || rows.iter().rev().is_sorted());
        assert!(rows.contains(&0.0) && rows.contains(&4.0));
    }

    /// The error of linear interpolation of x² + y² on a unit grid is at most 1/4, which is the greatest error of the squared radius.
    #[test]
    fn a_circle_is_closed_and_where_it_must_be() {
        let square = |k: i32| f64::from((k - 10) * (k - 10));
        let values: Vec<f64> =
            (0..21).flat_map(|row| (0..21).map(move |column| square(row) + square(column))).collect();
        let lines = isolines(21, &values, 40.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        assert!(lines[0].len() > 40);
        for (x, y) in &lines[0] {
            let squared = (x - 10.0).powi(2) + (y - 10.0).powi(2);
            assert!((squared - 40.5).abs() <= 0.25, "{squared}");
        }
    }

    #[test]
    fn missing_corners_leave_gaps_and_infinite_ones_none() {
        let mut values: Vec<f64> = (0..20).map(|k| f64::from(k % 5)).collect();
        assert_eq!(isolines(5, &values, 1.5), [[(1.5, 0.0), (1.5, 1.0), (1.5, 2.0), (1.5, 3.0)]]);
        values[7] = f64::INFINITY;
        assert_eq!(isolines(5, &values, 1.5), [[(1.5, 0.0), (1.0, 1.0), (1.5, 2.0), (1.5, 3.0)]]);
        values[7] = f64::NAN;
        assert_eq!(isolines(5, &values, 1.5), [[(1.5, 2.0), (1.5, 3.0)]]);
        values[6] = f64::NEG_INFINITY;
        values[7] = f64::INFINITY;
        assert_eq!(isolines(5, &values, 1.5)[0][1], (1.5, 1.0));
    }

    #[test]
    fn a_single_row_or_column_has_no_lines() {
        assert!(isolines(3, &[0.0, 1.0, 2.0], 0.5).is_empty());
        assert!(isolines(1, &[0.0, 1.0, 2.0], 0.5).is_empty());
        assert!(isolines(1, &[], 0.5).is_empty());
    }
}
