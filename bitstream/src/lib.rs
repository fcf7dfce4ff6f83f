//! XC2S200 bitstreams: what is in a `.bit` file, and what the device makes of it.
//!
//! Nothing of the robot is in here.
//!
//! ```
//! use bitstream::container::{Bitstream, BYTES, Fault};
//!
//! let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../generated/rac4i65.bit");
//! let bitstream = Bitstream::open(path.as_ref())?;
//! assert_eq!((bitstream.lanes().len(), bitstream.summary.crc_checks), (BYTES, 2));
//! // Taken apart and put together again it is the same file; a bit that fell over is noticed before a card is touched.
//! let mut file = std::fs::read(path)?;
//! assert_eq!(bitstream.encode(&bitstream.packets), file);
//! file[100_000] ^= 1;
//! assert!(matches!(Bitstream::parse(&file), Err(Fault::Crc { .. })));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "device")]
pub mod configuration;
pub mod container;
#[cfg(feature = "device")]
pub mod device;
#[cfg(feature = "device")]
pub mod element;
#[cfg(feature = "device")]
pub mod flow;
#[cfg(feature = "device")]
pub mod netlist;
#[cfg(feature = "device")]
pub mod report;
#[cfg(feature = "device")]
pub mod simulation;
#[cfg(feature = "device")]
pub mod verilog;
