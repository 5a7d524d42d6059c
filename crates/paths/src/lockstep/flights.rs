//! Flights of particles side by side: the twin of `Walk::fly`.

use crate::{ROULETTE_BELOW, SamplingExtinction, Walk};
use fairflight_collision::SingleParticle;
use fairflight_elementary::lanes::{LANES, Lanes, mask};
use fairflight_media::lanes::{points, set_vector, vector};
use fairflight_media::{Extinction, Line, Medium, Ray};
use fairflight_sources::{Seeded, SeededLanes, UniformSource};
use fairflight_transmittance::lockstep::Products;
use glam::DVec3;

/// Where particles are on their rays, whereto they fly, and where their streams stand.
pub(super) struct Flights {
    groups: Vec<Group>,
}

/// As many of them as have lanes.
#[derive(Clone)]
pub(super) struct Group {
    /// Origins and directions of the rays in world space, and in the medium's own coordinates.
    world: [[Lanes; 3]; 2],
    local: [[Lanes; 3]; 2],
    /// Distances from there \[length\].
    s: Lanes,
    /// Lengths of the rays \[length\].
    length: Lanes,
    /// Energies, by the greatest albedo.
    weight: Lanes,
    /// Numbers of collisions, where there is a greatest one.
    collisions: [u64; LANES],
    streams: SeededLanes,
}

/// Outcome of one flight.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Event {
    /// A null collision: the importon keeps its direction.
    Transmitted,
    Scattered,
    Escaped,
    Absorbed,
    Truncated,
}

impl Group {
    /// No particle anywhere.
    pub(super) const IDLE: Self = Self {
        world: [[[0.0; LANES]; 3]; 2],
        local: [[[0.0; LANES]; 3]; 2],
        s: [0.0; LANES],
        length: [0.0; LANES],
        weight: [1.0; LANES],
        collisions: [0; LANES],
        streams: SeededLanes::IDLE,
    };

    pub(super) fn line(&self, lane: usize) -> Line {
        Line { origin: vector(&self.world[0], lane), direction: vector(&self.world[1], lane) }
    }

    pub(super) fn weight(&self, lane: usize) -> f64 {
        self.weight[lane]
    }

    /// Flies to the next collisions; tells what comes of each.
    #[inline(always)]
    pub(super) fn fly<M: Medium, R: SamplingExtinction>(
        &mut self,
        medium: &M,
        walk: &Walk<R>,
        model: &SingleParticle,
    ) -> [Event; LANES] {
        let (mut collides, sigma_samp) = self.advance(walk.sampling());
        let mut events = [Event::Escaped; LANES];
        if walk.max_collisions() < u64::MAX {
            self.cut(walk.max_collisions(), &mut collides, &mut events);
        }
        let r = self.ratios(medium, &collides, &sigma_samp);
        let u = self.streams.next_uniforms_of(&collides.map(mask));
        let (energies, are_scattered) = model.collide_lanes(&r, &u);
        let mut some_are_weak = false;
        for i in 0..LANES {
            let weight = self.weight[i] * energies[i];
            some_are_weak |= collides[i] & ((weight.abs() < ROULETTE_BELOW) | (energies[i] == 0.0));
            self.weight[i] = if collides[i] { weight } else { self.weight[i] };
        }
        for i in 0..LANES {
            let survives = if are_scattered[i] { Event::Scattered } else { Event::Transmitted };
            events[i] = if collides[i] { survives } else { events[i] };
        }
        if some_are_weak {
            self.end_weak(&collides, &energies, &mut events);
        }
        events
    }

    /// Flies to the next collisions of shadow rays, and multiplies their transmittance by what passes (`Ratio`); tells which of them met one.
    #[inline(always)]
    pub(super) fn attenuate<M: Medium, R: SamplingExtinction>(
        &mut self,
        medium: &M,
        sampling: &R,
        transmittance: &mut Products,
    ) -> [bool; LANES] {
        let (collides, sigma_samp) = self.advance(sampling);
        let r = self.ratios(medium, &collides, &sigma_samp);
        let mut factors = [1.0; LANES];
        for i in 0..LANES {
            factors[i] = if collides[i] { 1.0 - r[i] } else { 1.0 };
        }
        transmittance.multiply(&factors);
        collides
    }

    /// Goes on to the next collisions: whether there is one, and σ_samp there.
    #[inline(always)]
    fn advance<R: SamplingExtinction>(&mut self, sampling: &R) -> ([bool; LANES], Lanes) {
        let depth = self.streams.next_exponentials();
        let [to, sigma_samp] = sampling.fly_lanes(|lane| self.line(lane), [&self.s, &self.length, &depth]);
        let mut collides = [false; LANES];
        for i in 0..LANES {
            collides[i] = to[i] < f64::INFINITY;
            // Where nothing is looked up any place will do.
            self.s[i] = if to[i] < f64::INFINITY { to[i] } else { self.s[i] };
        }
        (collides, sigma_samp)
    }

    /// r = σ_t/σ_samp of the lanes that collide.
    #[inline(always)]
    fn ratios<M: Medium>(&self, medium: &M, collides: &[bool; LANES], sigma_samp: &Lanes) -> Lanes {
        let places = points(&self.local[0], &self.local[1], &self.s);
        let sigma_t = medium.sigma_t_local_where(&places, collides);
        let mut r = [0.0; LANES];
        for i in 0..LANES {
            r[i] = sigma_t[i] / sigma_samp[i];
        }
        r
    }

    /// Puts a particle at the start of a ray.
    #[inline(always)]
    fn set_ray(&mut self, lane: usize, (world, local, length): (Line, Line, f64)) {
        for (lines, line) in [(&mut self.world, world), (&mut self.local, local)] {
            set_vector(&mut lines[0], lane, line.origin);
            set_vector(&mut lines[1], lane, line.direction);
        }
        (self.s[lane], self.length[lane]) = (0.0, length);
    }

    /// A shadow ray, with the stream of its particle.
    #[inline(always)]
    pub(super) fn start<M: Medium>(&mut self, lane: usize, ray: &Ray<&M>, stream: &Seeded) {
        self.set_ray(lane, (*ray.world_line(), *ray.local_line(), ray.length()));
        self.streams.set(lane, stream);
    }

    /// The stream of a lane, which does not fly any more.
    #[inline(always)]
    pub(super) fn end(&mut self, lane: usize) -> Seeded {
        (self.s[lane], self.length[lane]) = (0.0, 0.0);
        self.streams.get(lane)
    }

    /// Counts collisions, but for those beyond the greatest number.
    #[inline(never)]
    fn cut(&mut self, most: u64, collides: &mut [bool; LANES], events: &mut [Event; LANES]) {
        for ((collides, event), count) in collides.iter_mut().zip(events).zip(&mut self.collisions) {
            if *collides && *count == most {
                (*collides, *event) = (false, Event::Truncated);
            }
            *count += u64::from(*collides);
        }
    }

    /// Absorption, and roulette.
    #[cold]
    #[inline(never)]
    fn end_weak(&mut self, collides: &[bool; LANES], energies: &Lanes, events: &mut [Event; LANES]) {
        for lane in (0..LANES).filter(|&lane| collides[lane]) {
            let weight = &mut self.weight[lane];
            if energies[lane] == 0.0 {
                events[lane] = Event::Absorbed;
            } else if weight.abs() < ROULETTE_BELOW {
                let mut source = self.streams.get(lane);
                if source.next_uniform() * ROULETTE_BELOW >= weight.abs() {
                    events[lane] = Event::Absorbed;
                }
                *weight = ROULETTE_BELOW.copysign(*weight);
                self.streams.set(lane, &source);
            }
        }
    }
}

impl Flights {
    /// One for each stream, none of them on its way.
    pub(super) fn of(streams: &[Seeded]) -> Self {
        let mut flights = Self { groups: vec![Group::IDLE; streams.len().div_ceil(LANES)] };
        for (lane, stream) in streams.iter().enumerate() {
            flights.set_stream(lane, stream);
        }
        flights
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> (&Group, usize) {
        (&self.groups[lane / LANES], lane % LANES)
    }

    #[inline(always)]
    fn at_mut(&mut self, lane: usize) -> (&mut Group, usize) {
        (&mut self.groups[lane / LANES], lane % LANES)
    }

    /// Groups of the first `count` lanes, with the number of their first lane.
    #[inline(always)]
    pub(super) fn in_groups(&mut self, count: usize) -> impl Iterator<Item = (usize, &mut Group)> {
        let groups = self.groups[..count.div_ceil(LANES)].iter_mut();
        groups.enumerate().map(|(number, group)| (number * LANES, group))
    }

    #[inline(always)]
    pub(super) fn stream(&self, lane: usize) -> Seeded {
        let (group, i) = self.at(lane);
        group.streams.get(i)
    }

    #[inline(always)]
    pub(super) fn set_stream(&mut self, lane: usize, stream: &Seeded) {
        let (group, i) = self.at_mut(lane);
        group.streams.set(i, stream);
    }

    /// The ray of a particle, the point of its collision, and its energy behind that.
    #[inline(always)]
    pub(super) fn vertex(&self, lane: usize) -> (Line, DVec3, f64) {
        let (group, i) = self.at(lane);
        let line = group.line(i);
        (line, line.at(group.s[i]), group.weight[i])
    }

    /// A particle of energy 1 at the start of a ray.
    #[inline(always)]
    pub(super) fn start<M: Medium>(&mut self, lane: usize, ray: &Ray<&M>) {
        self.set_ray(lane, (*ray.world_line(), *ray.local_line(), ray.length()));
        let (group, i) = self.at_mut(lane);
        (group.weight[i], group.collisions[i]) = (1.0, 0);
    }

    /// A particle goes on along another line, which leaves the volume after `length`.
    #[inline(always)]
    pub(super) fn turn<M: Medium>(&mut self, lane: usize, medium: &M, line: Line, length: f64) {
        self.set_ray(lane, (line, medium.local(line), length));
    }

    #[inline(always)]
    fn set_ray(&mut self, lane: usize, ray: (Line, Line, f64)) {
        let (group, i) = self.at_mut(lane);
        group.set_ray(i, ray);
    }

    /// Puts a flight into another lane, or nowhere if it is its own; the lane that it leaves does not fly any more.
    pub(super) fn leave(&mut self, from: usize, to: usize) {
        let (source, (group, i)) = (self.stream(from), self.at(from));
        let (world, weight, collisions) = (group.line(i), group.weight[i], group.collisions[i]);
        let local = Line { origin: vector(&group.local[0], i), direction: vector(&group.local[1], i) };
        let (s, length) = (group.s[i], group.length[i]);
        self.set_ray(to, (world, local, length));
        self.set_stream(to, &source);
        let (group, i) = self.at_mut(to);
        (group.s[i], group.weight[i], group.collisions[i]) = (s, weight, collisions);
        let (group, i) = self.at_mut(from);
        group.end(i);
    }
}
