//! A grid's map from index to world space, as the file stores it.
//!
//! Scale maps store the scale first, then quantities derived from it, which are stepped over. Affine maps store a 4x4 matrix
//! for row vectors, row by row: its first three rows are the images of the axes, the fourth is the translation.

use crate::affine::Affine;
use crate::cursor::Cursor;
use crate::error::VdbError;

/// Vectors derived from a scale that follow it in the file: voxel size, inverse, inverse square, half the inverse.
const DERIVED_FROM_SCALE: usize = 4;

const WHAT: &str = "the transform";

/// The map from index to world space and its inverse.
pub(crate) fn read(cursor: &mut Cursor<'_>) -> Result<(Affine, Affine), VdbError> {
    let kind = cursor.name(WHAT)?;
    let unsupported = |why: &str| VdbError::UnsupportedTransform { what: format!("{kind}{why}") };
    let world_from_index = match kind.as_str() {
        "UniformScaleMap" | "ScaleMap" => {
            let scale = vector(cursor)?;
            for _ in 0..DERIVED_FROM_SCALE {
                vector(cursor)?;
            }
            Affine::scale_translate(scale, [0.0; 3])
        }
        "UniformScaleTranslateMap" | "ScaleTranslateMap" => {
            let (translation, scale) = (vector(cursor)?, vector(cursor)?);
            for _ in 0..DERIVED_FROM_SCALE {
                vector(cursor)?;
            }
            Affine::scale_translate(scale, translation)
        }
        "TranslationMap" => Affine::scale_translate([1.0; 3], vector(cursor)?),
        "AffineMap" | "UnitaryMap" => {
            let mut columns = [[0.0; 3]; 4];
            for (row, column) in columns.iter_mut().enumerate() {
                *column = vector(cursor)?;
                let homogeneous = cursor.f64(WHAT)?;
                if homogeneous != if row == 3 { 1.0 } else { 0.0 } {
                    return Err(unsupported(" with a perspective part"));
                }
            }
            Affine { columns }
        }
        "NonlinearFrustumMap" => return Err(unsupported(" (a camera frustum) is not affine")),
        _ => return Err(unsupported("")),
    };
    if !world_from_index.columns.iter().flatten().all(|entry| entry.is_finite()) {
        return Err(unsupported(" is not finite"));
    }
    let inverse = world_from_index.inverse().ok_or_else(|| unsupported(" is singular"))?;
    Ok((world_from_index, inverse))
}

fn vector(cursor: &mut Cursor<'_>) -> Result<[f64; 3], VdbError> {
    Ok([cursor.f64(WHAT)?, cursor.f64(WHAT)?, cursor.f64(WHAT)?])
}

#[cfg(test)]
mod tests {
    use super::read;
    use crate::cursor::Cursor;
    use crate::error::VdbError;

    fn map(kind: &str, numbers: &[f64]) -> Vec<u8> {
        let mut bytes = u32::try_from(kind.len()).expect("short").to_le_bytes().to_vec();
        bytes.extend(kind.as_bytes());
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        bytes
    }

    fn refusal(kind: &str, numbers: &[f64]) -> String {
        match read(&mut Cursor::new(&map(kind, numbers), 0)) {
            Err(VdbError::UnsupportedTransform { what }) => what,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn scale_maps_are_read_to_their_end() {
        let mut numbers = vec![1.0, 2.0, 3.0, 0.5, 0.25, 2.0];
        numbers.extend([9.0; 12]);
        let bytes = map("ScaleTranslateMap", &numbers);
        let mut cursor = Cursor::new(&bytes, 0);
        let (world_from_index, _) = read(&mut cursor).expect("supported");
        assert_eq!(world_from_index.apply_point([2.0, 4.0, 1.0]), [2.0, 3.0, 5.0]);
        assert_eq!(cursor.remaining(), 0);
    }

    #[test]
    fn maps_without_an_affine_inverse_are_refused_by_name() {
        assert_eq!(refusal("ScaleMap", &[0.0; 15]), "ScaleMap is singular");
        assert_eq!(refusal("ScaleMap", &[f64::NAN; 15]), "ScaleMap is not finite");
        assert_eq!(
            refusal("NonlinearFrustumMap", &[]),
            "NonlinearFrustumMap (a camera frustum) is not affine"
        );
        assert_eq!(refusal("AffineMap", &[1.0; 16]), "AffineMap with a perspective part");
        assert_eq!(refusal("CompoundMap", &[]), "CompoundMap");
    }
}
