//! Integrators to given words, through the registers alone.
//!
//! With kp = 0 and ki = 1 a tick at rest adds the set point's word to the integral, LSB for LSB; a
//! change of gains makes no bump (`fixed_kin::pi`). So one tick sets it, and the proper gains follow.

use crate::closed_loop::LoopError;
use crate::fpga::Fpga;
use driver::{Board, BoardError, BusError, Registers, Scale};
use fixed_kin::AXES;
use fixed_kin::control::Configuration;
use fixed_kin::format::{Duty, IntegralGain, Speed};
use fixed_kin::pi::PiGains;
use fixed_kin::registers as map;
use fixed_kin::slew::SlewLimits;

/// Sets the integrators of an armed card in wheel mode whose encoders rest at `positions`.
pub(super) fn preload<F: Fpga>(
    board: &mut Board<F>,
    scale: &Scale,
    integrals: &[i32; AXES],
    positions: &[f64; AXES],
) -> Result<(), LoopError> {
    let gains = PiGains { ki: IntegralGain::ONE, lower: -Duty::ONE, upper: Duty::ONE, ..PiGains::default() };
    let counting = Configuration { gains: [gains; AXES], slew: [SlewLimits::NONE; AXES], ..Configuration::default() };
    commit_configuration(&mut board.bus, &counting).map_err(BoardError::from)?;
    board.set_wheel_speeds(&integrals.map(Speed::from_bits))?;
    board.bus.advance(positions)?;
    commit_configuration(&mut board.bus, scale.configuration()).map_err(BoardError::from)?;
    Ok(())
}

fn commit_configuration<R: Registers>(bus: &mut R, configuration: &Configuration) -> Result<(), BusError> {
    let mut sum = map::CHECKSUM_SEED;
    for (index, word) in configuration.to_words().into_iter().enumerate() {
        let offset = map::CONFIGURATION.at(index);
        bus.write(offset, word as u32)?;
        sum = map::checksum(sum, offset / 4, word as u32);
    }
    bus.write(map::COMMIT_CONFIGURATION.offset, sum)
}
