//! An allocator for tests that counts large allocations and fails one of them.

use std::alloc::{GlobalAlloc, Layout, System};
use std::backtrace::Backtrace;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// The system's allocator, but for one large allocation that fails: the system gives nothing for it.
///
/// Growing an allocation to a large size counts as one.
#[derive(Debug)]
pub struct Failing {
    /// What is large, in bytes; `usize::MAX` while nothing is counted.
    large: AtomicUsize,
    count: AtomicUsize,
    which: AtomicUsize,
    /// Whether the one that fails says where it was asked for.
    is_traced: AtomicBool,
}

impl Failing {
    /// Nothing is counted, nothing fails.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            large: AtomicUsize::new(usize::MAX),
            count: AtomicUsize::new(0),
            which: AtomicUsize::new(usize::MAX),
            is_traced: AtomicBool::new(false),
        }
    }

    /// Counts allocations of at least `large` bytes from now on, from 0, and fails the one with the number
    /// `which`; where `is_traced`, that one prints its backtrace.
    pub fn fail(&self, which: usize, large: usize, is_traced: bool) {
        self.count.store(0, Relaxed);
        self.which.store(which, Relaxed);
        self.is_traced.store(is_traced, Relaxed);
        self.large.store(large, Relaxed);
    }

    /// Ends that, and says how many there were.
    pub fn stop(&self) -> usize {
        self.large.store(usize::MAX, Relaxed);
        self.count.load(Relaxed)
    }

    fn fails(&self, size: usize) -> bool {
        let large = self.large.load(Relaxed);
        let is_failing = size >= large && self.count.fetch_add(1, Relaxed) == self.which.load(Relaxed);
        if is_failing && self.is_traced.load(Relaxed) {
            // What the backtrace takes does not count.
            self.large.store(usize::MAX, Relaxed);
            eprintln!("{}", Backtrace::force_capture());
            self.large.store(large, Relaxed);
        }
        is_failing
    }
}

impl Default for Failing {
    fn default() -> Self {
        Self::new()
    }
}

// SAFETY: every request goes to the system's allocator as it is, or is answered by null,
// which the trait permits.
unsafe impl GlobalAlloc for Failing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if self.fails(layout.size()) {
            return std::ptr::null_mut();
        }
        System.alloc(layout)
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if self.fails(layout.size()) {
            return std::ptr::null_mut();
        }
        System.alloc_zeroed(layout)
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size > layout.size() && self.fails(size) {
            return std::ptr::null_mut();
        }
        System.realloc(old, layout, size)
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        System.dealloc(old, layout);
    }
}
