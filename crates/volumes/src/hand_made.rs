//! Files made by hand, each with one lie in it: what must be refused, and that no memory is taken on the lie's word.

use crate::budget::Budget;
use crate::error::VdbError;
use crate::grid::{VoxelGrid, grids, read_within};

/// The parts of a file with one grid of root tiles only.
struct File {
    name: &'static str,
    class: Option<&'static str>,
    version: u32,
    has_offsets: u8,
    grid_count: u32,
    tree_type: &'static str,
    parent: &'static str,
    compression: u32,
    half: Option<bool>,
    voxel_count: Option<i64>,
    tree: Vec<u8>,
}

impl File {
    fn new(tree: Vec<u8>) -> Self {
        Self {
            name: "density",
            class: None,
            version: 224,
            has_offsets: 1,
            grid_count: 1,
            tree_type: "Tree_float_5_4_3",
            parent: "",
            compression: 0,
            half: None,
            voxel_count: None,
            tree,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes = [0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0].to_vec();
        bytes.extend(self.version.to_le_bytes());
        bytes.extend([10, 0, 0, 0, 0, 0, 0, 0, self.has_offsets]);
        bytes.extend([b'0'; 36]);
        bytes.extend(0_u32.to_le_bytes());
        bytes.extend(self.grid_count.to_le_bytes());
        self.append_grid(&mut bytes);
        bytes
    }

    /// Appends the grid with its descriptor.
    fn append_grid(&self, bytes: &mut Vec<u8>) {
        for name in [self.name, self.tree_type, self.parent] {
            text(bytes, name);
        }
        let mut grid = self.compression.to_le_bytes().to_vec();
        let entries = [self.half.is_some(), self.voxel_count.is_some(), self.class.is_some()];
        grid.extend(entries.map(u32::from).iter().sum::<u32>().to_le_bytes());
        if let Some(half) = self.half {
            entry(&mut grid, "is_saved_as_half_float", "bool", &[u8::from(half)]);
        }
        if let Some(count) = self.voxel_count {
            entry(&mut grid, "file_voxel_count", "int64", &count.to_le_bytes());
        }
        if let Some(class) = self.class {
            entry(&mut grid, "class", "string", class.as_bytes());
        }
        text(&mut grid, "TranslationMap");
        grid.extend([0; 24]);
        grid.extend(&self.tree);
        let start = bytes.len() + 24;
        let end = start + grid.len();
        for offset in [start, end, end] {
            bytes.extend((offset as u64).to_le_bytes());
        }
        bytes.extend(grid);
    }

    /// Reads the file, and asserts that reading took hardly more memory than the file has bytes.
    fn read(&self) -> Result<VoxelGrid, VdbError> {
        let bytes = self.bytes();
        let mut budget = Budget::for_file(bytes.len());
        let result = read_within(&bytes, None, &mut budget);
        assert!(budget.spent() < 20 * bytes.len() + 2000, "{} for {}", budget.spent(), bytes.len());
        result
    }

    fn corruption(&self) -> String {
        match self.read() {
            Err(VdbError::Corrupt { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    }
}

fn text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend(u32::try_from(text.len()).expect("short").to_le_bytes());
    bytes.extend(text.as_bytes());
}

fn entry(bytes: &mut Vec<u8>, name: &str, kind: &str, value: &[u8]) {
    text(bytes, name);
    text(bytes, kind);
    bytes.extend(u32::try_from(value.len()).expect("short").to_le_bytes());
    bytes.extend(value);
}

/// A tree's head: background 0.5 and the stated numbers of root tiles and nodes.
fn head(tiles: u32, nodes: u32) -> Vec<u8> {
    [1_u32.to_le_bytes(), 0.5_f32.to_le_bytes(), tiles.to_le_bytes(), nodes.to_le_bytes()].concat()
}

/// A tree of one upper node at the origin, up to its values: the bytes of its masks of children and of active tiles.
fn upper_node(children: u8, active: u8) -> Vec<u8> {
    [&head(0, 1)[..], &[0; 12], &[children; 4096], &[active; 4096], &[0]].concat()
}

fn tile(origin: [i32; 3], value: f32, active: bool) -> Vec<u8> {
    let mut bytes: Vec<u8> = origin.iter().flat_map(|coordinate| coordinate.to_le_bytes()).collect();
    bytes.extend(value.to_le_bytes());
    bytes.push(u8::from(active));
    bytes
}

/// A tree of root tiles.
fn tiles(tiles: &[([i32; 3], f32, bool)]) -> Vec<u8> {
    let mut tree = head(u32::try_from(tiles.len()).expect("few"), 0);
    tree.extend(tiles.iter().flat_map(|(origin, value, active)| tile(*origin, *value, *active)));
    tree
}

const ONE_TILE: ([i32; 3], f32, bool) = ([-4096, 0, 4096], 2.0, true);
const TILE_VOXELS: u64 = 1 << 36;

#[test]
fn an_honest_file_is_read() {
    let lowest = i32::MIN;
    let grid = File::new(tiles(&[ONE_TILE, ([lowest; 3], 1.0, true), ([i32::MAX - 4095; 3], 3.0, false)]))
        .read()
        .expect("honest");
    assert_eq!(grid.active_voxel_count(), 2 * TILE_VOXELS);
    assert_eq!(grid.active_sum(), 3.0 * TILE_VOXELS as f64);
    assert_eq!((grid.minimum(), grid.maximum()), (0.5, 3.0));
    assert_eq!(grid.active_bounds(), Some(([lowest; 3], [-1, 4095, 8191])));
    assert_eq!(grid.value(-1, 4095, 8191), 2.0);
    assert_eq!(grid.value(i32::MAX, i32::MAX, i32::MAX), 3.0);
    assert!(grid.is_active(-1, 0, 4096) && !grid.is_active(0, 0, 4096));
}

#[test]
fn stated_counts_do_not_decide_over_memory() {
    for (tiles, nodes) in [(u32::MAX, 0), (0, u32::MAX), (u32::MAX, u32::MAX), (1, 0), (0, 1)] {
        assert!(matches!(File::new(head(tiles, nodes)).read(), Err(VdbError::Truncated { .. })));
    }
    let many = File { grid_count: u32::MAX, ..File::new(tiles(&[])) };
    assert!(matches!(many.read(), Err(VdbError::Truncated { .. })));
}

#[test]
fn stated_children_do_not_decide_over_memory() {
    // All slots claim to be children; values are all omitted.
    let file = File { compression: 2, ..File::new(upper_node(0xff, 0)) };
    assert!(matches!(file.read(), Err(VdbError::Truncated { .. })));
}

#[test]
fn a_slot_is_not_child_and_tile_at_once() {
    let file = File::new(upper_node(0xff, 0xff));
    assert_eq!(file.corruption(), "a slot of a node is both a child and an active tile");
}

#[test]
fn root_slots_are_aligned_and_distinct() {
    assert!(File::new(tiles(&[([8, 0, 0], 1.0, true)])).corruption().contains("no multiple of 4096"));
    assert!(File::new(tiles(&[ONE_TILE, ONE_TILE])).corruption().contains("the same place"));
}

/// The answer to whoever names no grid of a file with these.
fn unasked(grids: &[File]) -> Result<String, VdbError> {
    let first = File { grid_count: u32::try_from(grids.len()).expect("few"), ..File::new(Vec::new()) };
    // The head of a file without its only grid.
    let mut nothing = Vec::new();
    first.append_grid(&mut nothing);
    let mut bytes = first.bytes();
    bytes.truncate(bytes.len() - nothing.len());
    grids.iter().for_each(|grid| grid.append_grid(&mut bytes));
    read_within(&bytes, None, &mut Budget::for_file(bytes.len())).map(|grid| grid.info().name.clone())
}

#[test]
fn who_names_no_grid_gets_the_density_or_the_only_one() {
    let float = |name| File { name, ..File::new(tiles(&[ONE_TILE])) };
    let other = |name, tree_type| File { tree_type, ..float(name) };
    let chosen = |grids: &[File]| unasked(grids).expect("there is no doubt");
    assert_eq!(chosen(&[float("temperature"), float("density")]), "density");
    assert_eq!(chosen(&[float("flames"), float("density"), float("heat")]), "density");
    assert_eq!(chosen(&[other("density", "Tree_vec3s_5_4_3"), float("smoke")]), "smoke");
    assert_eq!(chosen(&[other("v", "Tree_vec3s_5_4_3"), float("")]), "");
    assert_eq!(
        chosen(&[float("heat"), other("density", "Tree_float_5_4_3_HalfFloat")]),
        "density",
        "half floats are floats"
    );

    let several = |grids: &[File]| match unasked(grids) {
        Err(VdbError::SeveralFloatGrids { available }) => available.join(" "),
        other => panic!("{other:?}"),
    };
    assert_eq!(several(&[float("heat"), float("smoke")]), "heat smoke");
    assert_eq!(
        several(&[float("density\u{1e}0"), float("heat"), float("density\u{1e}1")]),
        "density[0] density[1]"
    );
    let instance = |name| File { parent: "smoke", ..float(name) };
    assert_eq!(several(&[float("smoke"), instance("haze")]), "smoke haze");

    // What is called density and cannot be read is not passed over for another grid.
    let double = other("density", "Tree_double_5_4_3");
    assert!(matches!(unasked(&[float("heat"), double]), Err(VdbError::WrongType { .. })));
    let shallow = other("density", "Tree_float_4_3");
    assert!(matches!(unasked(&[float("heat"), shallow]), Err(VdbError::WrongType { .. })));
    assert!(matches!(unasked(&[float("heat"), instance("density")]), Err(VdbError::Unsupported { .. })));
    assert!(matches!(unasked(&[]), Err(VdbError::NoFloatGrid { .. })));
}

#[test]
fn a_grid_whose_values_are_no_densities_is_refused_by_its_class() {
    let of = |class| File { class: Some(class), ..File::new(tiles(&[ONE_TILE])) };
    for class in ["level set", "Level Set", " level set ", "staggered"] {
        let expected = VdbError::NotAVolume { grid: "density".to_owned(), class: class.to_owned() };
        assert_eq!(of(class).read().err(), Some(expected), "{class}");
        // Also who asks for it by name cannot mean its distances.
        let bytes = of(class).bytes();
        let asked = read_within(&bytes, Some("density"), &mut Budget::for_file(bytes.len()));
        assert!(matches!(asked, Err(VdbError::NotAVolume { .. })), "{class}");
    }
    for class in ["fog volume", "unknown", "", "whatever"] {
        assert!(of(class).read().is_ok(), "{class}");
    }
}

#[test]
fn the_grid_ends_where_its_offsets_say() {
    let mut tree = tiles(&[ONE_TILE]);
    tree.push(0);
    assert!(File::new(tree).corruption().contains("does not end where its values begin"));
}

#[test]
fn values_are_finite() {
    for value in [f32::NAN, f32::INFINITY] {
        let error = File::new(tiles(&[([0, 4096, 0], value, false)])).read();
        assert!(matches!(error, Err(VdbError::NonFinite { index: [0, 4096, 0], .. })));
    }
    let mut background = tiles(&[]);
    background[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(File::new(background).corruption(), "the background is NaN");
}

#[test]
fn the_voxel_count_agrees_with_the_metadata() {
    let count = i64::try_from(TILE_VOXELS).expect("fits");
    let stating = |count| File { voxel_count: Some(count), ..File::new(tiles(&[ONE_TILE])) }.read();
    assert!(stating(count).is_ok());
    for wrong in [count + 1, -1] {
        assert_eq!(
            stating(wrong).err(),
            Some(VdbError::Inconsistent { expected: wrong, found: TILE_VOXELS })
        );
    }
}

#[test]
fn both_notes_of_the_width_agree() {
    let tree = || tiles(&[]);
    let half_type = "Tree_float_5_4_3_HalfFloat";
    assert!(File { half: Some(true), tree_type: half_type, ..File::new(tree()) }.read().is_ok());
    assert!(File { tree_type: half_type, ..File::new(tree()) }.read().is_ok());
    assert!(File { half: Some(true), ..File::new(tree()) }.corruption().contains("16 bits"));
    assert!(
        File { half: Some(false), tree_type: half_type, ..File::new(tree()) }
            .corruption()
            .contains("16 bits")
    );
}

#[test]
fn what_is_left_out_is_refused_by_name() {
    let tree = || tiles(&[]);
    let refusal = |file: File| file.read().expect_err("left out").to_string();
    for version in [221, 225] {
        let message = format!("OpenVDB file version {version} is not supported (222 to 224 are)");
        assert_eq!(refusal(File { version, ..File::new(tree()) }), message);
    }
    assert!(refusal(File { has_offsets: 0, ..File::new(tree()) }).contains("written as a stream"));
    assert_eq!(refusal(File { compression: 8, ..File::new(tree()) }), "compression not supported: flags 0x8");
    let mut buffers = tree();
    buffers[0] = 2;
    assert_eq!(refusal(File::new(buffers)), "not supported: a tree of 2 buffers");

    let instance = File { parent: "other", ..File::new(tree()) };
    assert!(
        matches!(instance.read(), Err(VdbError::Unsupported { .. })),
        "an instance of a density is not passed over for another grid"
    );
    let bytes = instance.bytes();
    let error =
        read_within(&bytes, Some("density"), &mut Budget::for_file(bytes.len())).expect_err("an instance");
    assert!(error.to_string().ends_with("it is an instance of \"other\""), "{error}");
    assert_eq!(grids(&bytes).expect("listed")[0].instance_of.as_deref(), Some("other"));
}
