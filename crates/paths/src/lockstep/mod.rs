//! Importons of many pixels side by side, in the widest registers that the machine has: the twin of `ParticleTracer::radiance`.
//!
//! A lane is a stream of variates with the importon that draws from it, so that nothing passes between lanes and every operation is the one of the scalar walk. The
//! law of this module is equality, bit for bit; its theory is that of [`Walk`](crate::Walk). All importons fly at once, each to its next collision; those that
//! are scattered there, a few of many, are then gathered into full lanes of their own.

mod connections;
mod flights;

use crate::{ParticleTracer, SamplingExtinction};
use fairflight_collision::SingleParticle;
use fairflight_elementary::lanes::LANES;
use fairflight_elementary::{InstructionSet, LaneWork};
use fairflight_media::lanes::{set_vector, splat, vector};
use fairflight_media::{Clip, Line, Medium, PhaseFunction, Ray};
use fairflight_scene::{Camera, Spectrum};
use fairflight_sources::{Seeded, UniformSource};
use flights::{Event, Flights};
use glam::DVec3;

/// An importon, apart from its flight.
#[derive(Clone, Copy)]
struct Particle<C> {
    /// Number of its pixel, and its column and row.
    pixel: usize,
    place: [f64; 2],
    /// Estimates that the pixel still lacks, the one of this importon included.
    samples: u32,
    /// Ratio of each channel's energy to that of the walk.
    colour: C,
    /// Radiance that its path has gathered so far \[radiance\].
    radiance: C,
}

/// Lanes by what is to be done for them.
struct Outcomes {
    /// The importon has ended, and the pixel lacks estimates.
    idle: Vec<usize>,
    /// The pixel has all its estimates.
    done: Vec<usize>,
    /// The importon was scattered.
    scattered: Vec<usize>,
}

impl Outcomes {
    /// So many lanes, none of which flies.
    fn of(count: usize) -> Self {
        let room = || Vec::with_capacity(count);
        Self { idle: Vec::from_iter(0..count), done: room(), scattered: room() }
    }
}

/// Some lanes of a group.
struct Few {
    lanes: [u8; LANES],
    count: usize,
}

impl Few {
    const NONE: Self = Self { lanes: [0; LANES], count: 0 };

    #[inline(always)]
    fn add_if(&mut self, lane: usize, condition: bool) {
        // All of them are less than the lanes of a group: the mask tells that to the compiler.
        self.lanes[self.count % LANES] = lane as u8;
        self.count += usize::from(condition);
    }

    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = usize> {
        self.lanes[..self.count].iter().map(|&lane| usize::from(lane))
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> ParticleTracer<'_, M, P, C, R> {
    /// Draws so many estimates \[radiance\] for each of `pixels`, each pixel from a stream of its own, in lanes. `take` sees each estimate with the number of its
    /// pixel.
    ///
    /// **Law.** A pixel's estimates, in turn, are bit for bit those of [`radiance`](crate::Integrator::radiance) for the rays of `camera` that two variates
    /// before each choose; the streams are left where those leave them. Estimates of different pixels come in any order.
    pub fn trace(
        &mut self,
        camera: &Camera,
        (pixels, samples): (&[[u32; 2]], u32),
        streams: &mut [Seeded],
        take: impl FnMut(usize, C),
    ) {
        self.trace_by(InstructionSet::widest(), camera, (pixels, samples), streams, take);
    }

    /// Draws as [`trace`](Self::trace), by an instruction set: the same bits on all.
    pub fn trace_by(
        &mut self,
        set: InstructionSet,
        camera: &Camera,
        (pixels, samples): (&[[u32; 2]], u32),
        streams: &mut [Seeded],
        take: impl FnMut(usize, C),
    ) {
        debug_assert_eq!(pixels.len(), streams.len(), "a stream for each pixel");
        set.run(Trace { tracer: self, camera, pixels, samples, streams, take });
    }

    /// Sends importons of the idle lanes on their way, behind all rays that miss the medium. Lanes whose pixel has all its estimates are put to `done`.
    #[inline(always)]
    fn enter(
        &self,
        camera: &Camera,
        (particles, flights): (&mut [Particle<C>], &mut Flights),
        Outcomes { idle, done, .. }: &mut Outcomes,
        take: &mut impl FnMut(usize, C),
    ) {
        let mut lanes = [0; LANES];
        while !idle.is_empty() {
            let count = idle.len().min(LANES);
            let (mut columns, mut rows) = ([0.0; LANES], [0.0; LANES]);
            for i in 0..count {
                lanes[i] = idle[idle.len() - count + i];
                let mut source = flights.stream(lanes[i]);
                let [column, row] = particles[lanes[i]].place;
                (columns[i], rows[i]) = (column + source.next_uniform(), row + source.next_uniform());
                flights.set_stream(lanes[i], &source);
            }
            idle.truncate(idle.len() - count);
            let directions = camera.directions(&columns, &rows);
            let clips = self.volume.enter_lanes(&splat(camera.origin()), &directions);
            for (i, &lane) in lanes[..count].iter().enumerate() {
                let particle = &mut particles[lane];
                if clips.lengths[i] > 0.0 {
                    let ray = Clip { line: clips.line(i), entry_distance: 0.0, length: clips.lengths[i] };
                    flights.start(lane, &Ray::new(&self.volume.medium, &ray));
                    (particle.colour, particle.radiance) = (C::splat(1.0), C::ZERO);
                    continue;
                }
                take(particle.pixel, self.lights.background.radiance(vector(&directions, i)));
                particle.samples -= 1;
                if particle.samples > 0 { &mut *idle } else { &mut *done }.push(lane);
            }
        }
    }

    /// All importons fly to their next collision: lanes whose importon has ended, and those where one was scattered.
    #[inline(always)]
    fn fly(
        &mut self,
        model: &SingleParticle,
        (particles, flights): (&mut [Particle<C>], &mut Flights),
        Outcomes { idle, done, scattered }: &mut Outcomes,
        take: &mut impl FnMut(usize, C),
    ) {
        let Self { volume, lights, walk, truncated } = self;
        let count = particles.len();
        for (first, flight) in flights.in_groups(count) {
            let events = flight.fly(&volume.medium, walk, model);
            // Sorted without a branch, which could not be foreseen.
            let (mut some_scattered, mut some_ended) = (Few::NONE, Few::NONE);
            for (i, event) in events.into_iter().enumerate().take(count - first) {
                some_scattered.add_if(i, event == Event::Scattered);
                some_ended.add_if(i, event != Event::Scattered && event != Event::Transmitted);
            }
            scattered.extend(some_scattered.iter().map(|i| first + i));
            for i in some_ended.iter() {
                let lane = first + i;
                let particle = &mut particles[lane];
                if events[i] == Event::Escaped {
                    let energy = particle.colour * flight.weight(i);
                    particle.radiance += energy * lights.background.radiance(flight.line(i).direction);
                }
                *truncated += u64::from(events[i] == Event::Truncated);
                take(particle.pixel, particle.radiance);
                particle.samples -= 1;
                if particle.samples > 0 { &mut *idle } else { &mut *done }.push(lane);
            }
        }
    }

    /// New directions for the importons of at most as many lanes as walk at once.
    #[inline(always)]
    fn scatter(&self, lanes: &[usize], flights: &mut Flights) {
        let volume = self.volume;
        let (mut points, mut incident) = ([[0.0; LANES]; 3], splat(DVec3::Z));
        let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
        for (i, &lane) in lanes.iter().enumerate() {
            let mut source = flights.stream(lane);
            let (Line { direction, .. }, point, _) = flights.vertex(lane);
            (u[i], v[i]) = (source.next_uniform(), source.next_uniform());
            flights.set_stream(lane, &source);
            set_vector(&mut points, i, point);
            set_vector(&mut incident, i, direction);
        }
        let directions = volume.phase.sample_lanes(&incident, &u, &v);
        let lengths = volume.bounds.exit_distance_lanes(&points, &directions);
        for (i, &lane) in lanes.iter().enumerate() {
            let line = Line { origin: vector(&points, i), direction: vector(&directions, i) };
            flights.turn(lane, &volume.medium, line, lengths[i]);
        }
    }
}

/// Work of [`ParticleTracer::trace_by`].
struct Trace<'t, 's, M, P, C, R, T> {
    tracer: &'t mut ParticleTracer<'s, M, P, C, R>,
    camera: &'t Camera,
    pixels: &'t [[u32; 2]],
    samples: u32,
    streams: &'t mut [Seeded],
    take: T,
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction, T: FnMut(usize, C)> LaneWork
    for Trace<'_, '_, M, P, C, R, T>
{
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { tracer, camera, pixels, samples, streams, mut take } = self;
        if samples == 0 {
            return;
        }
        let (model, ratio) = tracer.walk.collisions(tracer.volume);
        let mut flights = Flights::of(streams);
        let mut particles = Vec::with_capacity(pixels.len());
        for (pixel, place) in pixels.iter().enumerate() {
            let place = place.map(f64::from);
            particles.push(Particle { pixel, place, samples, colour: C::ZERO, radiance: C::ZERO });
        }
        let mut outcomes = Outcomes::of(pixels.len());
        while !particles.is_empty() {
            tracer.enter(camera, (&mut particles, &mut flights), &mut outcomes, &mut take);
            // From the last one on: where one leaves, the last one takes its place, which flies.
            outcomes.done.sort_unstable();
            while let Some(lane) = outcomes.done.pop() {
                streams[particles[lane].pixel] = flights.stream(lane);
                particles.swap_remove(lane);
                flights.leave(particles.len(), lane);
            }
            tracer.fly(&model, (&mut particles, &mut flights), &mut outcomes, &mut take);
            for &lane in &outcomes.scattered {
                particles[lane].colour = particles[lane].colour * ratio;
            }
            for light in &tracer.lights.sources {
                tracer.connect_lanes(light, &outcomes.scattered, (&mut particles, &mut flights));
            }
            for lanes in outcomes.scattered.chunks(LANES) {
                tracer.scatter(lanes, &mut flights);
            }
            outcomes.scattered.clear();
        }
    }
}

#[cfg(test)]
mod tests;
