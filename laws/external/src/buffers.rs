//! The numbers that a library reads and writes, between guards that detect writes outside the buffers.

use std::cell::RefCell;
use std::ops::Range;

/// Numbers of a guard on each side of a buffer.
const GUARD: usize = 8;
/// Value of guards, a number that no behaviour computes.
const CANARY: u64 = 0x7ff4_dead_beef_cafe;

/// A buffer: the range of its numbers, and true if the library may write them.
#[derive(Clone)]
pub(crate) struct Buffer {
    place: Range<usize>,
    may_write: bool,
}

/// All buffers of a call in one allocation: a write beyond the end of a buffer overwrites a guard.
#[derive(Default)]
pub(crate) struct Buffers {
    numbers: Vec<f64>,
    all: Vec<Buffer>,
    /// Copy of the numbers of the buffers that the library may only read.
    given: Vec<f64>,
}

thread_local! {
    static KEPT: RefCell<Buffers> = RefCell::default();
}

impl Buffers {
    /// Creates empty buffers in the memory of the last call of this thread.
    pub fn empty() -> Buffers {
        let mut own = KEPT.take();
        own.numbers.clear();
        own.all.clear();
        own.given.clear();
        own.guard();
        own
    }

    /// Stores the memory for the next call of this thread.
    pub fn keep(self) {
        KEPT.set(self);
    }

    fn guard(&mut self) {
        self.numbers.extend([f64::from_bits(CANARY); GUARD]);
    }

    /// Adds a buffer that the library reads.
    pub fn read(&mut self, numbers: &[f64]) -> Buffer {
        self.given.extend_from_slice(numbers);
        self.add(numbers, false)
    }

    /// Adds a buffer that the library writes.
    pub fn write(&mut self, numbers: &[f64]) -> Buffer {
        self.add(numbers, true)
    }

    fn add(&mut self, numbers: &[f64], may_write: bool) -> Buffer {
        let start = self.numbers.len();
        self.numbers.extend_from_slice(numbers);
        let buffer = Buffer { place: start..self.numbers.len(), may_write };
        self.guard();
        self.all.push(buffer.clone());
        buffer
    }

    /// Returns the address of a buffer; valid until the next buffer is added.
    pub fn pointer(&mut self, buffer: &Buffer) -> *mut f64 {
        // The pointer comes from the whole vector, so that it may move over all guards.
        self.numbers.as_mut_ptr().wrapping_add(buffer.place.start)
    }

    /// Returns the numbers of a buffer.
    pub fn numbers(&self, buffer: &Buffer) -> &[f64] {
        &self.numbers[buffer.place.clone()]
    }

    /// Returns the rule that the library has broken.
    pub fn misused(&self) -> Option<&'static str> {
        let mut end = 0;
        let mut given = self.given.iter();
        for buffer in &self.all {
            if !is_guard(&self.numbers[end..buffer.place.start]) {
                return Some("the external behaviour writes outside of its buffers");
            }
            end = buffer.place.end;
            let mut own = self.numbers(buffer).iter();
            if !buffer.may_write && !own.all(|x| given.next().is_some_and(|y| x.to_bits() == y.to_bits())) {
                return Some("the external behaviour changes numbers that it may only read");
            }
        }
        (!is_guard(&self.numbers[end..])).then_some("the external behaviour writes outside of its buffers")
    }
}

fn is_guard(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.to_bits() == CANARY)
}
