//! An affine map of space: the type in which a grid hands out its transform, so that callers may use any vector library.

/// The map p -> A p + t, as the images of the three axes and of the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// The images of the unit vectors x, y, z (the columns of A), then the translation t.
    pub columns: [[f64; 3]; 4],
}

impl Affine {
    /// A scale along the axes followed by a translation.
    #[must_use]
    pub fn scale_translate(scale: [f64; 3], translation: [f64; 3]) -> Self {
        let [x, y, z] = scale;
        Self { columns: [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z], translation] }
    }

    /// The image of a point.
    #[must_use]
    pub fn apply_point(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.apply_vector(point);
        let t = self.columns[3];
        [x + t[0], y + t[1], z + t[2]]
    }

    /// The image of a vector: the translation does not take part.
    #[must_use]
    pub fn apply_vector(&self, vector: [f64; 3]) -> [f64; 3] {
        let [a, b, c, _] = self.columns;
        std::array::from_fn(|row| a[row] * vector[0] + b[row] * vector[1] + c[row] * vector[2])
    }

    /// The determinant of A: the volume of a unit cube's image, negative where the map mirrors.
    #[must_use]
    pub fn determinant(&self) -> f64 {
        let [a, b, c, _] = self.columns;
        dot(a, cross(b, c))
    }

    /// The inverse map; none if A is singular, or so nearly that the inverse is not finite.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let [a, b, c, t] = self.columns;
        // The rows of the inverse are the cross products of the columns over the determinant (Cramer's rule).
        let determinant = self.determinant();
        let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|entry| entry / determinant));
        let column = |n: usize| [rows[0][n], rows[1][n], rows[2][n]];
        let inverse = Self { columns: [column(0), column(1), column(2), rows.map(|row| -dot(row, t))] };
        let finite = inverse.columns.iter().flatten().all(|entry| entry.is_finite());
        (determinant != 0.0 && finite).then_some(inverse)
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::Affine;

    #[test]
    fn inverse_undoes_the_map() {
        let map = Affine { columns: [[0.0, 2.0, 0.0], [-3.0, 0.0, 0.0], [0.5, 0.0, 4.0], [1.0, 2.0, 3.0]] };
        assert_eq!(map.determinant(), 24.0);
        let inverse = map.inverse().expect("invertible");
        let back = inverse.apply_point(map.apply_point([0.3, -7.0, 11.0]));
        for (found, expected) in back.iter().zip([0.3, -7.0, 11.0]) {
            assert!((found - expected).abs() < 1e-14, "{back:?}");
        }
        assert_eq!(map.apply_vector([1.0, 0.0, 0.0]), [0.0, 2.0, 0.0]);
    }

    #[test]
    fn singular_maps_have_no_inverse() {
        assert_eq!(Affine::scale_translate([1.0, 0.0, 1.0], [0.0; 3]).inverse(), None);
        assert_eq!(Affine::scale_translate([f64::NAN; 3], [0.0; 3]).inverse(), None);
        assert_eq!(
            Affine::scale_translate([1e-300; 3], [0.0; 3]).inverse(),
            None,
            "the determinant underflows"
        );
    }
}
