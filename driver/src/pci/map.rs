//! A window of the card in our memory: the one file with `unsafe` code of this crate.
//!
//! `memmap2` makes the mapping; what is left are volatile accesses through its pointer. They are sound
//! because every offset is checked against the length, words are aligned (the mapping starts at a page),
//! and nobody else has a reference into the mapping: it is only ever touched through raw pointers.
#![allow(unsafe_code)]

use memmap2::{MmapOptions, MmapRaw};
use std::fs::File;
use std::io;

/// A mapped window.
#[derive(Debug)]
pub(super) struct Mapping {
    memory: MmapRaw,
    start: usize,
    size: usize,
}

impl Mapping {
    /// Maps `size` bytes that begin `start` bytes into the first page of `file`.
    ///
    /// A window smaller than a page may begin anywhere in one, but the kernel maps whole pages.
    pub(super) fn new(file: &File, start: usize, size: usize) -> io::Result<Self> {
        let memory = MmapOptions::new().len(start + size).map_raw(file)?;
        Ok(Self { memory, start, size })
    }

    fn at(&self, offset: u32, width: usize) -> Result<*mut u8, &'static str> {
        let offset = offset as usize;
        if !offset.is_multiple_of(width) {
            return Err("the offset is not aligned");
        }
        if offset + width > self.size {
            return Err("the offset is beyond the window");
        }
        Ok(self.memory.as_mut_ptr().wrapping_add(self.start + offset))
    }

    /// One aligned 32-bit load.
    pub(super) fn read32(&self, offset: u32) -> Result<u32, &'static str> {
        let place = self.at(offset, 4)?.cast::<u32>();
        // SAFETY: `at` gives an aligned place inside the mapping, which lives as long as `self`.
        Ok(u32::from_le(unsafe { place.read_volatile() }))
    }

    /// One aligned 32-bit store.
    pub(super) fn write32(&self, offset: u32, data: u32) -> Result<(), &'static str> {
        let place = self.at(offset, 4)?.cast::<u32>();
        // SAFETY: as in `read32`.
        unsafe { place.write_volatile(data.to_le()) };
        Ok(())
    }

    /// One 8-bit store.
    pub(super) fn write8(&self, offset: u32, data: u8) -> Result<(), &'static str> {
        let place = self.at(offset, 1)?;
        // SAFETY: as in `read32`.
        unsafe { place.write_volatile(data) };
        Ok(())
    }
}
