//! Scenes of the repository that reports compare methods on.

use super::replicas::Subject;
use fairflight_harness::Failure;

/// A scene on which one method is to show something that another does not.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) id: &'static str,
    /// Property of the scene, in words.
    pub(super) words: &'static str,
    json: &'static str,
    /// Exposure of its images.
    pub(super) exposure: f64,
    /// True if light is indirect there, where lafortune-1996 expects a gain.
    pub(super) is_indirect: bool,
}

pub(super) const BULB: Scene = Scene {
    id: "bulb",
    words: "a lamp in a globe of glass lights a hazy room: no connection reaches it",
    json: include_str!("../../scenes/bulb.json"),
    exposure: 1.0,
    is_indirect: true,
};

pub(super) const VOLUME_CAUSTIC: Scene = Scene {
    id: "volume-caustic",
    words: "a ball of glass under a small lamp, in haze",
    json: include_str!("../../scenes/volume-caustic.json"),
    exposure: 2.0,
    is_indirect: true,
};

pub(super) const DOOR: Scene = Scene {
    id: "door",
    words: "smoke in two rooms; the lamp of one lights the other through a slit",
    json: include_str!("../../scenes/door.json"),
    exposure: 8.0,
    is_indirect: true,
};

pub(super) const FIXTURE: Scene = Scene {
    id: "fixture",
    words: "a lamp in a black tube that is open towards the ceiling, in haze",
    json: include_str!("../../scenes/fixture.json"),
    exposure: 1.0,
    is_indirect: true,
};

pub(super) const MIXED: Scene = Scene {
    id: "mixed",
    words: "haze over a floor under a lamp that lights all of it: direct light",
    json: include_str!("../../scenes/mixed.json"),
    exposure: 1.0,
    is_indirect: false,
};

/// The same light from everywhere: no choice of directions is better than another.
pub(super) const UNIFORM_SKY: Scene = Scene {
    id: "uniform-sky",
    words: "haze over a floor under a sky that is alike in all directions",
    json: include_str!("../../scenes/uniform-sky.json"),
    exposure: 1.0,
    is_indirect: false,
};

pub(super) const MIRROR_ROOM: Scene = Scene {
    id: "mirror-room",
    words: "a lamp in a globe of glass lights a closed room that is seen in a mirror",
    json: include_str!("../../scenes/mirror-room.json"),
    exposure: 2.0,
    is_indirect: true,
};

/// A point light in haze.
pub(super) const POINT: &str = include_str!("../../scenes/point-in-haze.json");

impl Scene {
    /// The scene, square and gray.
    pub(super) fn subject(&self, side: u32) -> Result<Subject, Failure> {
        Subject::gray(self.json, [side; 2])
    }
}
