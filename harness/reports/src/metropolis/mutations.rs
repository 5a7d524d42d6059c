//! Mutations of paths: how often each is accepted, and its part in all that are.

use super::equal_time::PATH_SPACE;
use crate::compared::Compared;
use crate::measured::Measured;
use crate::replicas::Moves;
use fairflight_document::{Cell, Section, Table};

pub(super) fn section(compared: &[Compared]) -> Section {
    let text = "Steps of the chains in path space above, each mutation as probable: the mean probability to accept one, and its part in all that were accepted. A path that a \
         mutation does not fit is a rejection. lens and scaling_lens move the point of the film with distances kept or scaled, lai_lens onto the places of smooth vertices, \
         caustic the direction towards the camera; scattering and propagation move a vertex in the medium, which a path of surfaces alone has not; bidirectional is a \
         fresh path. Which paths are bright follows from the scene: volume-caustic has caustics in the medium, door long paths of diffuse vertices, mirror-room and bulb chains \
         of smooth ones. Intervals are 95 %, from independent images.";
    let all: Vec<Vec<Moves>> =
        compared.iter().map(|scene| scene.entries[PATH_SPACE].images.moves()).collect();
    let table = |id: &str, title: &str, of: &dyn Fn(&Moves) -> Measured| {
        let columns = compared.iter().map(|scene| (scene.scene.id, "1"));
        let columns: Vec<(&str, &str)> = [("mutation", "")].into_iter().chain(columns).collect();
        let row = |k: usize| {
            let cells = all.iter().map(|moves| of(&moves[k]).cell());
            [Cell::text(all[0][k].kind)].into_iter().chain(cells).collect()
        };
        let rows = (0..all[0].len()).map(row).collect();
        Table { rows, ..Table::new(id, title, "", &columns) }
    };
    Section::new("mutations", "Mutations of paths")
        .with(text)
        .with(table("mutations-acceptance", "Acceptance", &|moves| moves.acceptance))
        .with(table("mutations-share", "Part of all accepted steps", &|moves| moves.share))
}
