//! The virtual robot: FPGAs behind one seam, the virtual card on its bus, the closed loop around them,
//! co-simulation with compiled Verilog, and the replay of measured logs.
//!
//! ```
//! use simulator::closed_loop::Drive;
//! use simulator::fpga::BitTrue;
//!
//! // The first 0.3 s of the paper's Fig. 6, by the loop that drives a real robot.
//! let drive = Drive { limit_s: 0.3, ..Drive::fig_6() };
//! let driven = drive.run(BitTrue::new(), |_| {})?;
//! assert_eq!(driven.run.wheel_count(), 3);
//! let (first, last) = (driven.track[0].1, driven.track[driven.track.len() - 1].1);
//! assert!(first.distance(last) > 1e-3, "it drives");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod blackout;
pub mod calibration;
pub mod chip;
pub mod circuit;
pub mod closed_loop;
pub mod cosim;
pub mod cross_check;
mod error;
pub mod eye;
pub mod fpga;
pub mod gateware;
pub mod imu;
pub mod replay;
pub mod virtual_card;
pub mod wave;
