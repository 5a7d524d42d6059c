//! A source that replays the variates of a path, all of them or changed a little: states of Metropolis sampling in primary sample space.

use crate::{Purpose, Row, SmallStep, UniformSource};

/// The variates of a state and of what was proposed last (kelemen-2002, antwerpen-2011 section 6.6).
///
/// A state is what its path drew, no more: a proposal changes a variate that the state has by a small step, and draws one that it has not
/// afresh. What the proposal does not draw is forgotten when it is accepted. The density of a fresh variate is 1, forwards and
/// backwards, so that a proposal is as probable from the state as the state from the proposal: the ratio of acceptance is that of
/// the targets alone, however many variates either draws. Nothing is remembered of what a path might have drawn, and no step of the past
/// is made up for.
///
/// Variates belong to the [`Row`] that was opened before they were drawn. A row that is opened again goes on where it was left.
///
/// ```
/// use fairflight_sources::{Layout, Seeded, SmallStep, Step, UniformSource, Variates};
///
/// let (mut variates, mut source) = (Variates::new(Layout::Rows), Seeded::new(1));
/// let first = variates.step(Step::Large, &mut source).next_uniform();
/// variates.accept();
/// // A small step from it, which is rejected: the state is what it was.
/// let second = variates.step(Step::Small(SmallStep::default()), &mut source).next_uniform();
/// assert!(second != first);
/// assert_eq!(variates.step(Step::Again, &mut source).next_uniform(), first);
/// ```
#[derive(Clone, Debug)]
pub struct Variates {
    layout: Layout,
    state: Record,
    proposal: Record,
    /// The variates of the state after a small step each: made all at once, since one by one a path would wait for each of them.
    changed: Vec<f64>,
    open: Open,
    /// The row to be opened when something is drawn.
    next: Option<Row>,
}

/// Order in which variates belong to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// By rows.
    #[default]
    Rows,
    /// One after the other as they are drawn, whatever for: one collision more moves all that follow. For comparison.
    Flat,
}

/// Kind of a proposal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A large step: each variate is drawn afresh.
    Large,
    /// Those that the state has changed a little.
    Small(SmallStep),
    /// Those of the state themselves.
    Again,
}

/// Variates of one path, in the order in which they were drawn, and the rows that they belong to.
#[derive(Clone, Debug)]
struct Record {
    /// Differs from that of any other record, so that the slots of those are seen to be empty.
    generation: u64,
    variates: Vec<f64>,
    chunks: Vec<Chunk>,
    slots: Vec<Slot>,
}

/// Variates that were drawn together.
#[derive(Clone, Copy, Debug)]
struct Chunk {
    start: usize,
    end: usize,
    /// The next one of the same row.
    next: Option<u32>,
}

/// A row: its first and its last chunk, and how far the state's row was read when it was left.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    generation: u64,
    first: u32,
    last: u32,
    read: Cursor,
}

/// A place in a row of the state: variates that come next, and the chunk behind them.
#[derive(Clone, Copy, Debug, Default)]
struct Cursor {
    at: usize,
    end: usize,
    next: Option<u32>,
}

/// The row that is open.
#[derive(Clone, Copy, Debug)]
struct Open {
    slot: usize,
    purpose: Purpose,
    /// The first variate of the proposal that belongs to it.
    start: usize,
    read: Cursor,
}

impl Record {
    /// A few hundred variates.
    const ROOM: usize = 512;

    fn new(generation: u64) -> Self {
        let slots = vec![Slot::default(); Self::ROOM];
        let (variates, chunks) = (Vec::with_capacity(Self::ROOM), Vec::with_capacity(Self::ROOM));
        Self { generation, variates, chunks, slots }
    }

    fn clear(&mut self, generation: u64) {
        self.generation = generation;
        self.variates.clear();
        self.chunks.clear();
    }

    fn slot(&self, index: usize) -> Option<&Slot> {
        self.slots.get(index).filter(|slot| slot.generation == self.generation)
    }

    fn behind(&self, chunk: u32) -> Cursor {
        let Chunk { start, end, next } = self.chunks[chunk as usize];
        Cursor { at: start, end, next }
    }

    /// The index of the variate at a place, and the place behind it.
    #[inline]
    fn read(&self, cursor: &mut Cursor) -> Option<usize> {
        while cursor.at == cursor.end {
            *cursor = self.behind(cursor.next?);
        }
        cursor.at += 1;
        Some(cursor.at - 1)
    }
}

impl Variates {
    /// No variates: the first step is a large one, whatever it is called.
    #[must_use]
    pub fn new(layout: Layout) -> Self {
        let open =
            Open { slot: Row::FIRST.index(), purpose: Row::FIRST.purpose, start: 0, read: Cursor::default() };
        let (state, proposal) = (Record::new(1), Record::new(2));
        Self { layout, state, proposal, changed: Vec::with_capacity(Record::ROOM), open, next: None }
    }

    /// The source of a proposal, made from the state and, where it has to be fresh, from `source`. A proposal before that was not accepted is
    /// forgotten.
    pub fn step<'v, S: UniformSource + ?Sized>(
        &'v mut self,
        step: Step,
        source: &'v mut S,
    ) -> Replayed<'v, S> {
        let generation = 1 + self.state.generation.max(self.proposal.generation);
        self.proposal.clear(generation);
        (self.open.start, self.next) = (0, None);
        self.turn_to(Row::FIRST, step);
        if let Step::Small(small) = step {
            self.changed.clear();
            self.changed.extend(self.state.variates.iter().map(|&u| small.from(u, source.next_uniform())));
        }
        Replayed { variates: self, step, source }
    }

    /// Makes the proposal the state.
    pub fn accept(&mut self) {
        self.close();
        std::mem::swap(&mut self.state, &mut self.proposal);
    }

    /// Number of variates of the state.
    #[must_use]
    pub fn len(&self) -> usize {
        self.state.variates.len()
    }

    /// Returns true if the state has no variates.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.state.variates.is_empty()
    }

    /// Turns to a row, at the place where it was left.
    fn turn_to(&mut self, row: Row, step: Step) {
        self.open.purpose = row.purpose;
        self.open.slot = if self.layout == Layout::Rows { row.index() } else { Row::FIRST.index() };
        self.open.start = self.proposal.variates.len();
        let slot = self.open.slot;
        self.open.read = match (self.proposal.slot(slot), self.state.slot(slot)) {
            (Some(left), _) => left.read,
            (None, Some(first)) if step != Step::Large => self.state.behind(first.first),
            _ => Cursor::default(),
        };
    }

    /// Notes what was drawn of the open row.
    fn close(&mut self) {
        let Self { proposal, open, .. } = self;
        let (start, end) = (open.start, proposal.variates.len());
        if start == end {
            return;
        }
        let chunk = proposal.chunks.len() as u32;
        proposal.chunks.push(Chunk { start, end, next: None });
        if open.slot >= proposal.slots.len() {
            proposal.slots.resize(open.slot + 1, Slot::default());
        }
        let slot = &mut proposal.slots[open.slot];
        if slot.generation == proposal.generation {
            proposal.chunks[slot.last as usize].next = Some(chunk);
        } else {
            (slot.generation, slot.first) = (proposal.generation, chunk);
        }
        (slot.last, slot.read) = (chunk, open.read);
        open.start = end;
    }
}

/// The source of one proposal.
///
/// **Law.** Over a uniform state, that of [`UniformSource`], whatever rows are opened: a small step of a uniform variate is uniform, and so is
/// a fresh one.
#[derive(Debug)]
pub struct Replayed<'v, S: ?Sized> {
    variates: &'v mut Variates,
    step: Step,
    source: &'v mut S,
}

impl<S: UniformSource + ?Sized> UniformSource for Replayed<'_, S> {
    fn next_uniform(&mut self) -> f64 {
        if let Some(row) = self.variates.next.take() {
            self.variates.close();
            self.variates.turn_to(row, self.step);
        }
        let Self { variates: Variates { state, proposal, changed, open, .. }, step, source } = self;
        let u = match (state.read(&mut open.read), *step) {
            (None, _) | (_, Step::Large) => source.next_uniform(),
            (Some(index), Step::Again) => state.variates[index],
            (Some(index), Step::Small(_)) => match open.purpose {
                Purpose::Redrawn if source.next_uniform() < 0.1 => source.next_uniform(),
                Purpose::Kept | Purpose::Redrawn => state.variates[index],
                Purpose::Flight | Purpose::Direction | Purpose::Connection => changed[index],
            },
        };
        proposal.variates.push(u);
        u
    }

    #[inline]
    fn row(&mut self, row: Row) {
        self.variates.next = Some(row);
    }
}

#[cfg(test)]
mod tests;
