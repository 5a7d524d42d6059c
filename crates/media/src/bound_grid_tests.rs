use super::*;
use crate::voxels::tests::{Dense, SIZE};
use crate::{
    AnalyticCosine, BoundedInCells, Bounds, EmptySpace, Extinction, Homogeneous, InCells, Lattice, Medium,
    Ray, Voxels,
};
use glam::{DAffine3, dvec3};
use proptest::prelude::*;

/// Values in [1, 3] in a background of 0.5.
fn voxels() -> Voxels<Dense> {
    Voxels::new(Dense::new(), DAffine3::IDENTITY, 2.0).unwrap()
}

/// Corners of the grid, from one voxel before the first to one behind the last: beyond there is background alone.
fn whole() -> (DVec3, DVec3) {
    (DVec3::NEG_ONE, DVec3::from_array(SIZE.map(|n| n as f64)))
}

/// Checks that every look-up is within its cell, and that the cells are lawful.
fn check<M: BoxBounds>(
    medium: &M,
    grid: &BoundGrid,
    line: Line,
    length: f64,
    at: &[f64],
) -> Result<(), String> {
    let mut cells = Vec::new();
    grid.cells_along(&medium.local(line), length, &mut cells);
    let clip = crate::Clip { line, entry_distance: 0.0, length };
    let field = InCells::new(Ray::new(medium, &clip), cells.as_slice())
        .map_err(|error| format!("{error}: {cells:?}"))?;
    let ends = cells.iter().flat_map(|cell| [cell.to, cell.to.next_down(), cell.to.next_up().min(length)]);
    for s in at.iter().map(|t| t * length).chain(ends).chain([0.0]) {
        let sigma_t = field.sigma_t(s);
        // Where both bounds are the same value, the look-up of it may be off by its own rounding.
        let known = |cell: &BoundCell| {
            cell.range() == 0.0 && (sigma_t - cell.majorant).abs() <= 1e-15 * sigma_t.abs()
        };
        let at = cells.partition_point(|cell| cell.to < s);
        if !field.cells_admit(s, sigma_t) && !cells[at..].iter().take(2).any(known) {
            return Err(format!("{sigma_t} at {s} of {line:?} in {cells:?}"));
        }
    }
    Ok(())
}

fn sorted(fractions: &[f64]) -> Vec<f64> {
    (0..200).map(|i| f64::from(i) / 200.0).chain(fractions.iter().copied()).collect()
}

proptest! {
    #[test]
    fn every_look_up_of_a_random_line_is_within_its_cell(
        origin in prop::array::uniform3(-3.0..9.0_f64),
        direction in prop::array::uniform3(-1.0..1.0_f64),
        length in 0.0..20.0_f64,
        resolution in prop::array::uniform3(1..9_usize),
        at in prop::collection::vec(0.0..1.0_f64, 30),
    ) {
        let medium = voxels();
        let direction = DVec3::from_array(direction).try_normalize().unwrap_or(DVec3::X);
        let grid = BoundGrid::build(&medium, whole(), resolution).unwrap();
        let line = Line { origin: origin.into(), direction };
        prop_assert_eq!(check(&medium, &grid, line, length, &sorted(&at)), Ok(()));
        // As a scene does it: clipped to the box, from far away.
        let bounds = Bounds::aligned_box(whole().0, whole().1).unwrap();
        if let Some(clip) = bounds.clip(line.origin - 100.0 * direction, direction, None).unwrap() {
            prop_assert_eq!(check(&medium, &grid, clip.line, clip.length, &sorted(&at)), Ok(()));
        }
    }

    /// Coordinates and directions of few values: in faces, along edges, through corners, along axes with either zero.
    #[test]
    fn every_look_up_of_a_line_on_the_lattice_is_within_its_cell(
        origin in prop::array::uniform3(-2..8_i8),
        direction in prop::array::uniform3(prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, -0.5, 1e-17, -1e-300, 1e-320])),
        resolution in prop::array::uniform3(prop::sample::select(vec![1_usize, 2, 3, 4, 7, 8])),
        shift in prop::sample::select(vec![0.0, 0.5]),
    ) {
        let medium = voxels();
        let direction = DVec3::from_array(direction);
        let direction = direction.try_normalize().unwrap_or(DVec3::NEG_X);
        let grid = BoundGrid::build(&medium, whole(), resolution).unwrap();
        let origin = DVec3::from_array(origin.map(f64::from)) + shift;
        prop_assert_eq!(check(&medium, &grid, Line { origin, direction }, 12.0, &sorted(&[])), Ok(()));
    }

    #[test]
    fn the_analytic_medium_is_within_its_boxes(
        origin in prop::array::uniform3(-8.0..8.0_f64),
        direction in prop::array::uniform3(-1.0..1.0_f64),
        scale in prop::sample::select(vec![1.0, -3.0]),
        at in prop::collection::vec(0.0..1.0_f64, 30),
    ) {
        let medium = AnalyticCosine::new(scale).unwrap();
        let (min, max) = AnalyticCosine::default_bounds().corners();
        let grid = BoundGrid::build(&medium, (min, max), [20, 20, 40]).unwrap();
        let direction = DVec3::from_array(direction).try_normalize().unwrap_or(DVec3::Z);
        let line = Line { origin: DVec3::from_array(origin) + dvec3(0.0, 0.0, 10.0), direction };
        prop_assert_eq!(check(&medium, &grid, line, 25.0, &sorted(&at)), Ok(()));
    }
}

#[test]
fn one_pass_finds_what_each_box_finds_by_itself() {
    let medium = voxels();
    let (min, max) = whole();
    for resolution in [[8, 6, 7], [1, 1, 1], [3, 2, 5], [16, 12, 14]] {
        let grid = BoundGrid::build(&medium, (min, max), resolution).unwrap();
        let boxes = Boxes::new(min, max, resolution);
        let mut index = 0;
        for x in 0..resolution[0] {
            for y in 0..resolution[1] {
                for z in 0..resolution[2] {
                    let corner = |x, y, z| dvec3(boxes.plane(0, x), boxes.plane(1, y), boxes.plane(2, z));
                    let (low, high) = medium.bounds_in(corner(x, y, z), corner(x + 1, y + 1, z + 1));
                    let found = grid.bounds[index];
                    // But for the slack, of some 1e-14.
                    assert!(found.0 <= low && low - found.0 < 1e-12, "{found:?} {low}");
                    assert!(found.1 >= high && found.1 - high < 1e-12, "{found:?} {high}");
                    index += 1;
                }
            }
        }
        assert_eq!(grid.bytes(), 16 * index);
    }
}

#[test]
fn a_line_in_a_plane_between_boxes_meets_the_values_of_that_plane() {
    // 0 for x < 2, 1 at x = 2, more beyond: in the plane x = 2 every value is 1.
    struct Steps;
    impl Lattice for Steps {
        fn trilinear(&self, x: f64, _y: f64, _z: f64) -> f64 {
            (x - 1.0).clamp(0.0, 3.0)
        }
        fn maximum(&self) -> f64 {
            3.0
        }
        fn minimum(&self) -> f64 {
            0.0
        }
    }
    let medium = Voxels::new(Steps, DAffine3::IDENTITY, 1.0).unwrap();
    let grid = BoundGrid::build(&medium, (DVec3::ZERO, DVec3::splat(4.0)), [4, 4, 4]).unwrap();
    for direction in [DVec3::Y, dvec3(0.0, -0.0, 1.0), dvec3(-0.0, 0.6, 0.8), -DVec3::Z] {
        let line = Line { origin: dvec3(2.0, 2.0, 2.0), direction };
        let mut cells = Vec::new();
        grid.cells_along(&line, 1.5, &mut cells);
        assert!(cells.iter().all(|cell| cell.admits(1.0)), "{direction}: {cells:?}");
        assert_eq!(cells.last().map(|cell| cell.to), Some(1.5));
    }
}

#[test]
fn a_line_beside_a_face_by_rounding_is_within_the_bounds() {
    // Hardly anything up to x = 200, the face of the box, and steep beyond.
    struct Cliff;
    impl Lattice for Cliff {
        fn trilinear(&self, x: f64, _y: f64, _z: f64) -> f64 {
            1.0 + 1e-9 * (x.clamp(199.0, 200.0) - 199.0) + 1e3 * (x.clamp(200.0, 201.0) - 200.0)
        }
        fn maximum(&self) -> f64 {
            self.trilinear(201.0, 0.0, 0.0)
        }
        fn minimum(&self) -> f64 {
            1.0
        }
    }
    let medium = Voxels::new(Cliff, DAffine3::IDENTITY, 1.0).unwrap();
    let grid = BoundGrid::build(&medium, (DVec3::ZERO, DVec3::splat(200.0)), [200, 2, 2]).unwrap();
    for ulps in 0..8 {
        let x = (0..ulps).fold(200.0_f64, |x, _| x.next_up());
        let line = Line { origin: dvec3(x, 1.0, 1.0), direction: DVec3::Y };
        assert_eq!(check(&medium, &grid, line, 199.0, &[]), Ok(()));
        let mut cells = Vec::new();
        grid.cells_along(&line, 199.0, &mut cells);
        assert!(cells.iter().all(|cell| cell.majorant < 2.0), "inside: {cells:?}");
    }
}

#[test]
fn widths_sum_to_the_length_and_equal_neighbours_are_one_cell() {
    let grid = BoundGrid::build(&voxels(), whole(), [8, 6, 7]).unwrap();
    let line = Line { origin: dvec3(-3.0, 1.25, 2.5), direction: DVec3::X };
    let mut cells = Vec::new();
    grid.cells_along(&line, 14.0, &mut cells);
    let ends: Vec<f64> = cells.iter().map(|cell| cell.to).collect();
    // Planes between boxes are exact, the faces of the whole have the slack.
    assert_eq!(ends[1..8], [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    assert!((ends[0] - 2.0).abs() < 1e-13 && (ends[8] - 10.0).abs() < 1e-13, "{ends:?}");
    assert_eq!(ends[9..], [14.0]);
    let empty = BoundGrid::build(&EmptySpace, whole(), [8, 6, 7]).unwrap();
    empty.cells_along(&line, 14.0, &mut cells);
    assert_eq!(cells, [BoundCell { to: 14.0, minorant: 0.0, majorant: 0.0 }]);
    let uniform = BoundGrid::build(&Homogeneous::new(0.5).unwrap(), whole(), [8, 6, 7]).unwrap();
    uniform.with_outside(0.0, 0.0).cells_along(&line, 14.0, &mut cells);
    assert_eq!(cells.len(), 3);
    grid.cells_along(&line, 0.0, &mut cells);
    assert_eq!(cells, []);
}

#[test]
fn a_second_line_does_not_allocate() {
    let grid = BoundGrid::build(&voxels(), whole(), [8, 6, 7]).unwrap();
    let mut cells = Vec::with_capacity(64);
    let before = (cells.as_ptr(), cells.capacity());
    for i in 0..100 {
        let direction = dvec3(1.0, 0.01 * f64::from(i), 0.3).normalize();
        grid.cells_along(&Line { origin: DVec3::NEG_ONE, direction }, 20.0, &mut cells);
        assert!(cells.len() > 5);
    }
    assert_eq!((cells.as_ptr(), cells.capacity()), before);
}

#[test]
fn what_is_refused() {
    let build = |corners, resolution| BoundGrid::build(&voxels(), corners, resolution).map(|_| ());
    let (min, max) = whole();
    assert!(matches!(build((min, min), [1, 1, 1]), Err(FieldError::Degenerate { .. })));
    assert!(matches!(build((min, DVec3::NAN), [1, 1, 1]), Err(FieldError::NotFinite { .. })));
    assert!(matches!(build((min, max), [1, 0, 1]), Err(FieldError::TooFew { .. })));
    assert!(matches!(build((min, max), [usize::MAX, 2, 1]), Err(FieldError::TooMany { .. })));
    assert!(matches!(build((min, 1e6 * max), [1, 1, 1]), Err(FieldError::TooMany { .. })));
    // Outside of the box nothing is known: the cells say so, and a field in such cells is refused.
    struct Unknown;
    impl Medium for Unknown {
        fn sigma_t_local(&self, _point: DVec3) -> f64 {
            1.0
        }
        fn upper_bound(&self) -> Option<f64> {
            None
        }
        fn lower_bound(&self) -> Option<f64> {
            None
        }
    }
    impl BoxBounds for Unknown {
        fn bounds_in(&self, _min: DVec3, _max: DVec3) -> (f64, f64) {
            (1.0, 1.0)
        }
    }
    let grid = BoundGrid::build(&Unknown, whole(), [2, 2, 2]).unwrap();
    let inside = Line { origin: DVec3::ZERO, direction: DVec3::X };
    assert_eq!(check(&Unknown, &grid, inside, 2.0, &[]), Ok(()));
    assert!(check(&Unknown, &grid, inside, 20.0, &[]).unwrap_err().contains("must be finite"));
}

/// Voxels far from the origin of the world, small there, and turned: a point is off by more than the roundings of an index.
#[test]
fn rays_that_are_clipped_to_the_bounds_of_far_voxels_stay_within_their_cells() {
    let size = 0.01;
    let far = dvec3(1000.0, -2000.0, 500.0);
    let turned = DAffine3::from_rotation_z(0.3) * DAffine3::from_translation(-far);
    for index_from_world in [
        DAffine3::from_scale(DVec3::splat(1.0 / size)) * DAffine3::from_translation(-far),
        DAffine3::from_scale(DVec3::splat(1.0 / size)) * turned,
    ] {
        let medium = Voxels::new(Dense::new(), index_from_world, 2.0).unwrap();
        let extent = size * DVec3::from_array(SIZE.map(|n| n as f64 - 1.0));
        let bounds = Bounds::aligned_box(far, far + extent).unwrap();
        let grid = BoundGrid::around(&medium, &bounds, 6).unwrap();
        assert!(grid.lookups() > 0);
        for i in 0..60 {
            let t = f64::from(i);
            let at = far + extent * (0.5 + 0.5 * dvec3(t.sin(), (1.7 * t).sin(), (0.6 * t).cos()));
            // In a face of the bounds, along an edge, and anywhere.
            for (at, direction) in [
                (dvec3(far.x, at.y, at.z), dvec3(0.0, 0.6, -0.8)),
                (dvec3(at.x, far.y + extent.y, far.z), DVec3::X),
                (at, dvec3((0.9 * t).cos(), (1.1 * t).sin(), (2.3 * t).sin()).normalize()),
            ] {
                let clip = bounds.clip(at - 3.0 * direction, direction, None).unwrap();
                let Some(clip) = clip.filter(|clip| clip.length > 0.0) else { continue };
                assert_eq!(check(&medium, &grid, clip.line, clip.length, &sorted(&[])), Ok(()));
            }
        }
    }
}

#[test]
fn a_grid_around_bounds_has_about_cubes_and_its_hull_outside() {
    let medium = AnalyticCosine::new(1.0).unwrap();
    let bounds = Bounds::aligned_box(dvec3(-1.0, -2.0, 0.0), dvec3(1.0, 2.0, 10.0)).unwrap();
    let grid = BoundGrid::around(&medium, &bounds, 20).unwrap();
    assert_eq!((grid.resolution(), grid.lookups()), ([4, 8, 20], 0));
    let mut cells = Vec::new();
    grid.cells_along(&Line { origin: dvec3(50.0, 0.0, 0.0), direction: DVec3::Z }, 3.0, &mut cells);
    let (minorant, majorant) = grid.hull();
    assert_eq!(cells, [BoundCell { to: 3.0, minorant, majorant }]);
    // Edges that differ by roundings have as many boxes.
    let cube = Bounds::aligned_box(DVec3::splat(0.1), dvec3(0.4, 0.7, 0.4)).unwrap();
    assert_eq!(BoundGrid::around(&medium, &cube, 8).unwrap().resolution(), [4, 8, 4]);
    // Flat bounds are a thin box; a point is none.
    let flat = Bounds::aligned_box(dvec3(-1.0, -2.0, 5.0), dvec3(1.0, 2.0, 5.0)).unwrap();
    assert_eq!(BoundGrid::around(&medium, &flat, 8).unwrap().resolution(), [4, 8, 1]);
    let point = Bounds::sphere(DVec3::ZERO, 0.0).unwrap();
    assert!(matches!(BoundGrid::around(&medium, &point, 8), Err(FieldError::Degenerate { .. })));
}
