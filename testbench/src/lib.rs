//! Where hardware and reference meet: co-simulation and the virtual robot.

pub mod cosim;
pub mod fpga;
