//! A boxed or borrowed FPGA is an FPGA.

use super::{Fpga, FpgaError, Kind};
use crate::imu::VirtualImu;
use fixed_kin::AXES;

macro_rules! forward {
    ($($fpga:ty),*) => {$(
        impl<F: Fpga + ?Sized> Fpga for $fpga {
            fn kind(&self) -> Kind {
                (**self).kind()
            }
            fn advance(&mut self, positions: &[f64; AXES]) -> Result<(), FpgaError> {
                (**self).advance(positions)
            }
            fn imu(&mut self) -> Option<&mut VirtualImu> {
                (**self).imu()
            }
            fn quiet_clocks(&self) -> u32 {
                (**self).quiet_clocks()
            }
            fn duties(&mut self) -> Result<[f64; AXES], FpgaError> {
                (**self).duties()
            }
        }
    )*};
}
forward!(&mut F, Box<F>);
