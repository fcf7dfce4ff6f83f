//! The virtual robot: FPGAs behind one seam, the virtual card on its bus, the closed loop around them,
//! co-simulation with compiled Verilog, and the replay of measured logs.

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
