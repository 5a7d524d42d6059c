//! Shadow rays of a scene between the bounds of a grid through voxels: unbiased, also in the planes between them.

use crate::common::fixture;
use fairflight_harness::estimator::{EstimatorSpec, InScene, Shadow, Unlawful};
use fairflight_harness::field::{AnyMedium, MediumLibrary, MediumSpec, VoxelLattice};
use fairflight_harness::reader::Node;
use fairflight_media::{Bounds, Clip, Line, Medium, OpticalThickness, Ray, Voxels};
use fairflight_paths::RayTransmittance;
use fairflight_sources::Seeded;
use fairflight_stats::Moments;
use glam::{DVec3, dvec3};
use serde_json::{Value, json};
use std::cell::Cell;
use std::sync::Arc;

struct Cloud {
    media: MediumLibrary,
    spec: MediumSpec,
    medium: Arc<Voxels<VoxelLattice>>,
    bounds: Bounds,
}

fn cloud() -> Cloud {
    scaled_cloud(1.0)
}

/// The same voxels times a factor.
fn scaled_cloud(scale: f64) -> Cloud {
    let media = MediumLibrary::default();
    let json = json!({ "kind": "vdb", "file": fixture("eq21_64.vdb"), "scale": scale });
    let spec = MediumSpec::read(&Node::root(&json)).unwrap();
    let (medium, bounds) = spec.kind().build(&media, "medium").unwrap();
    let AnyMedium::Voxels(medium) = medium else { panic!("no voxels") };
    Cloud { media, spec, medium, bounds }
}

impl Cloud {
    fn shadow(&self, estimator: &Value) -> Shadow {
        let spec = EstimatorSpec::read_for_all_rays(&Node::root(estimator)).unwrap();
        let medium = AnyMedium::Voxels(Arc::clone(&self.medium));
        let scene = InScene {
            medium: &medium,
            spec: Some(&self.spec),
            bounds: &self.bounds,
            rays: Vec::new(),
            media: &self.media,
        };
        spec.kind().for_all_rays(&scene, "estimator").unwrap()
    }

    /// Rays in a plane between voxels, along an edge, through corners, and across; each from outside, and from a point inside.
    fn rays(&self) -> Vec<Clip> {
        let world = self.medium.lattice().0.world_from_index();
        let (low, high) = self.bounds.corners();
        let middle =
            self.medium.local(Line { origin: 0.5 * (low + high), direction: DVec3::X }).origin.round();
        let mut rays = Vec::new();
        for (offset, direction) in [
            (DVec3::ZERO, dvec3(0.0, 0.6, -0.8)),
            (dvec3(8.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0)),
            (DVec3::ZERO, dvec3(1.0, -1.0, 1.0)),
            (dvec3(0.3, -5.2, 4.7), dvec3(0.3, 0.2, 1.0)),
        ] {
            let point = DVec3::from_array(world.apply_point((middle + offset).to_array()));
            let direction = DVec3::from_array(world.apply_vector(direction.to_array())).normalize();
            rays.extend(self.bounds.clip(point - 100.0 * direction, direction, None).unwrap());
            rays.push(self.bounds.clip_inside(Line { origin: point, direction }));
        }
        rays
    }
}

fn estimators() -> [Value; 4] {
    [
        json!({ "kind": "residual_cells", "cells": 8 }),
        json!({ "kind": "residual_cells", "cells": 64, "rate": 2.0 }),
        json!({ "kind": "jittered_ratio", "cells": 8, "epsilon": 0.5 }),
        json!({ "kind": "jittered_ratio", "cells": 13, "epsilon": 1.0 }),
    ]
}

#[test]
fn shadow_rays_through_the_boxes_of_voxels_are_unbiased() {
    let (cloud, unlawful) = (cloud(), Cell::<Option<Unlawful>>::new(None));
    let rays = cloud.rays();
    assert_eq!(rays.len(), 8);
    for estimator in estimators() {
        let shadow = cloud.shadow(&estimator);
        for clip in &rays {
            let ray = Ray::new(&*cloud.medium, clip);
            let exact = (-ray.optical_thickness(0.0, clip.length)).exp();
            assert!(exact > 0.0 && exact < 0.95, "{exact}");
            for seed in 0..3 {
                let (mut worker, mut source) = (shadow.worker(&unlawful), Seeded::new(seed));
                let mut moments = Moments::default();
                (0..4000).for_each(|_| moments.push(worker.estimate(&ray, &mut source)));
                let (mean, error) = (moments.mean().unwrap(), moments.standard_error().unwrap());
                // Of ninety-six: a false alarm in ten thousand, by the normal law.
                let z = (mean - exact) / error;
                assert!(z.abs() < 4.9, "{estimator}, {clip:?}, seed {seed}: {mean} for {exact}, z = {z}");
            }
        }
    }
    assert_eq!(unlawful.get(), None);
}

/// The wrong twins of the law above: bounds of another medium, which some look-up leaves, and its transmittance, which the same
/// number of estimates rejects.
#[test]
fn bounds_and_transmittance_of_another_medium_are_noticed() {
    let (cloud, denser) = (cloud(), scaled_cloud(1.1));
    for estimator in estimators() {
        let (shadow, unlawful) = (cloud.shadow(&estimator), Cell::<Option<Unlawful>>::new(None));
        let mut rejected = 0;
        for clip in &cloud.rays() {
            let (ray, other) = (Ray::new(&*cloud.medium, clip), Ray::new(&*denser.medium, clip));
            let (mut worker, mut source) = (shadow.worker(&unlawful), Seeded::new(0));
            let mut moments = Moments::default();
            (0..4000).for_each(|_| moments.push(worker.estimate(&ray, &mut source)));
            assert_eq!(unlawful.get(), None, "{estimator}");
            let wrong = (-other.optical_thickness(0.0, clip.length)).exp();
            let z = (moments.mean().unwrap() - wrong) / moments.standard_error().unwrap();
            rejected += usize::from(z.abs() > 4.9);
        }
        assert!(rejected > 0, "{estimator}: no ray tells the two media apart");
        for clip in &cloud.rays() {
            let (mut worker, mut source) = (shadow.worker(&unlawful), Seeded::new(0));
            let ray = Ray::new(&*denser.medium, clip);
            (0..200).for_each(|_| {
                worker.estimate(&ray, &mut source);
            });
        }
        assert!(
            unlawful.get().is_some(),
            "{estimator}: the bounds of the thinner medium hold of the denser one"
        );
    }
}

#[test]
fn a_ray_of_no_length_is_not_attenuated() {
    let (cloud, unlawful) = (cloud(), Cell::new(None));
    let clip = Clip::empty(cloud.bounds.corners().0, DVec3::X);
    for estimator in estimators().into_iter().chain([
        json!({ "kind": "hybrid" }),
        json!({ "kind": "p_series", "version": "cmf" }),
        json!({ "kind": "p_series", "version": "ratio" }),
        json!({ "kind": "unbiased_ray_marching" }),
        json!({ "kind": "jittered_ratio", "epsilon": 0.5 }),
    ]) {
        let shadow = cloud.shadow(&estimator);
        let mut worker = shadow.worker(&unlawful);
        let estimate = worker.estimate(&Ray::new(&*cloud.medium, &clip), &mut Seeded::new(1));
        assert_eq!((estimate, unlawful.get()), (1.0, None), "{estimator}");
    }
}

#[test]
fn a_grid_is_built_once_and_its_look_ups_are_told() {
    let cloud = cloud();
    let [one, other] = [0, 2].map(|i| cloud.shadow(&estimators()[i]));
    let [one, other] = [&one, &other].map(|shadow| shadow.preparation().unwrap());
    assert_eq!(one, other);
    assert_eq!(one.purpose, "bounds of the medium in 8 x 8 x 8 boxes");
    // A value for each voxel in the bounds, and one beyond where rounding has it there.
    let side = (one.lookups as f64).cbrt();
    assert!((60.0..72.0).contains(&side), "{side}");
}
