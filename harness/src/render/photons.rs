//! Photons: all pixels at once.

use super::batch::Batch;
use super::canvas::Spent;
use super::draw::Draw;
use super::replicas::{REPLICA_STREAM, Replica};
use crate::plan::WalkPlan;
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::Medium;
use fairflight_paths::PhotonTracer;
use fairflight_scene::Spectrum;
use fairflight_sources::{Seeded, derive_seed};

impl<C: Spectrum> Draw<'_, C> {
    /// The light of scattered photons in `count` replicas, and what it cost.
    ///
    /// # Errors
    /// If a look-up is not lawful, or a contribution not finite: that of the first replica where it happens.
    pub(super) fn photons<M: Medium + Copy + Sync>(
        &self,
        medium: M,
        walk: &WalkPlan,
        count: u32,
    ) -> Result<(Batch<C>, Spent), Failure> {
        let replica = |index, samples| self.replica(medium, walk, (index, samples));
        let (layer, spent) = self.layer(&self.replicas((0..count, count), &replica)?);
        Ok((Batch { replicas: Some(layer), ..Batch::none() }, spent))
    }

    fn replica<M: Medium>(
        &self,
        medium: M,
        walk: &WalkPlan,
        (index, samples): (u32, u32),
    ) -> Result<Replica<C>, Failure> {
        let clock = ThreadTime::now();
        let [columns, rows] = self.plan.camera.resolution();
        let volume = self.volume(medium);
        let mut tracer = PhotonTracer::new(&self.plan.camera, &volume, &self.radiant.lights, walk.walk());
        // As many as pixels are one sample for each.
        let photons = u64::from(columns) * u64::from(rows);
        let mut source = Seeded::for_batch(derive_seed(self.seed, REPLICA_STREAM), u64::from(index));
        let mut pixels = vec![C::ZERO; photons as usize];
        let mut bad = None;
        for sample in 0..samples {
            interrupt::check()?;
            for photon in 0..photons {
                tracer.trace(&mut source, |[column, row], radiance| {
                    if !radiance.is_finite() && bad.is_none() {
                        bad = Some((column, row, u64::from(sample) * photons + photon, radiance.rgb()));
                    }
                    pixels[row as usize * columns as usize + column as usize] += radiance;
                });
            }
            (self.advance)(photons);
        }
        let truncated = tracer.truncated();
        self.judge(&volume.medium)?;
        if let Some((column, row, photon, radiance)) = bad {
            return Err(Failure::refused(format!(
                "what photon {photon} of replica {index}, seed {}, adds to pixel (column {column}, row {row}) is \
                 {radiance:?}",
                self.seed
            )));
        }
        let scale = 1.0 / (f64::from(samples) * photons as f64);
        pixels.iter_mut().for_each(|pixel| *pixel = *pixel * scale);
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let cost = Spent { lookups: volume.medium.lookups(), cpu_seconds, truncated, ..Spent::default() };
        Ok(Replica { number: index, pixels, samples, cost, chains: None, experience: None })
    }
}
