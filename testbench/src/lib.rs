//! Where hardware and reference meet: co-simulation and the virtual robot.

pub mod blind;
pub mod calibration;
pub mod closed_loop;
pub mod cosim;
pub mod cross_check;
pub mod faults;
pub mod formal;
pub mod fpga;
pub mod netlist;
pub mod open_board;
pub mod place;
pub mod qemu;
pub mod replay;
pub mod virtual_card;
pub mod wave;
