//! The virtual 4I65: bridge, configuration port, local bus, FPGA, robot.
//!
//! ```text
//!            BAR 0, 1 ──► bridge ──GPIO──► configuration port ──┐ frames, decoded
//!  host ─────┤                                                  ▼
//!            BAR 2..5 ──► local bus ──bytes──┘   registers ──► FPGA ──duty──► motors, wheels, body
//!                                                               ▲──encoders──┘
//! ```
//!
//! Two fronts: in process it is a [`PciCard`]; `qemu` puts it on the PCI bus of a virtual machine. Its time is
//! simulated (every access takes some), told by the virtual machine, or the host's.

mod bridge;
mod live;
mod machine;
mod pins;
mod select_map;
mod shared;
mod wiring;

pub use bridge::{Bridge, Eeprom};
pub use live::{BitTrueLive, Live};
pub use machine::Machine;
pub use pins::PinsLive;
pub use select_map::{DeviceCrc, SelectMap};
pub use shared::{CameraAbove, SharedCard};
pub use wiring::Wiring;

use crate::circuit::{committed, decode};
use crate::error::FpgaError;
use bitstream::container::packets::Packets;
use driver::pci::{Bar, PciCard, PciError};
use fixed_kin::registers::NOMINAL_CLOCK_HZ;
use runs::geometry::GeometryError;
use runs::robot::Robot;
use std::fmt;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// What an access takes in simulated time: a read waits for its answer, a write is posted.
const READ_TIME: Duration = Duration::from_nanos(900);
const WRITE_TIME: Duration = Duration::from_nanos(300);
/// Clocks of the local bus that a register access takes besides.
const BUS_CLOCKS: f64 = 10.0;
/// Longest step of a robot whose FPGA is not configured.
const IDLE_STEP_S: f64 = 1e-3;

/// Puts the design in place that was written to the configuration port.
pub type Fabric = Box<dyn FnMut(&SelectMap) -> Result<Box<dyn Live>, FpgaError> + Send>;

/// The circuit that was written, decoded from its bits.
///
/// # Errors
/// Frames that make no circuit.
pub fn decoded(device: &SelectMap) -> Result<Box<dyn Live>, FpgaError> {
    Ok(Box::new(PinsLive::decoded(&decode(&device.packets())?)?))
}

/// The committed bitstream as the bit-true model, which keeps up with real time and is proven to be the same; every
/// other as [`decoded`].
///
/// # Errors
/// As [`decoded`].
pub fn fast(device: &SelectMap) -> Result<Box<dyn Live>, FpgaError> {
    static COMMITTED: OnceLock<Packets> = OnceLock::new();
    if device.has(COMMITTED.get_or_init(|| committed().packets)) {
        return Ok(Box::new(BitTrueLive::new()));
    }
    decoded(device)
}

/// What is broken on purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Nothing answers: all ones, writes vanish.
    pub absent: bool,
    /// The same from this access on.
    pub absent_after: Option<u64>,
    /// INIT never rises.
    pub init_low: bool,
    /// DONE never rises.
    pub done_low: bool,
    /// DONE never falls.
    pub done_high: bool,
    /// WRITE does not reach the FPGA: it stays high.
    pub write_high: bool,
    /// This byte of a bitstream, from 0, is lost.
    pub lost_byte: Option<u64>,
    /// This byte comes twice.
    pub doubled_byte: Option<u64>,
    /// These bits of this byte are flipped.
    pub flipped_byte: Option<(u64, u8)>,
    /// So many loads are hurt by the three above; later ones go well.
    pub hurt_loads: u32,
    /// The local bus clock stands still.
    pub clock_still: bool,
}

#[derive(Clone, Copy, Debug)]
enum Time {
    Simulated(Duration),
    /// Accesses take some too, but never reach the time that will be told next.
    Told {
        now: Duration,
        limit: Duration,
    },
    Host(Instant),
}

/// See the module.
pub struct VirtualCard {
    /// What is broken on purpose.
    pub faults: Faults,
    bridge: Bridge,
    device: SelectMap,
    fabric: Fabric,
    fpga: Option<Box<dyn Live>>,
    configured_at: Duration,
    machine: Machine,
    /// The robot has been stepped so far while no FPGA was configured.
    idle_until: Duration,
    time: Time,
    clock_hz: f64,
    accesses: u64,
    bytes: u64,
    loads: u32,
    /// Kicks of the designs before this one.
    kicks: u32,
    /// Why what was loaded is no design: nothing answers, as on silicon.
    misfit: Option<String>,
    /// Why the simulation behind the card failed.
    failure: Option<String>,
}

impl fmt::Debug for VirtualCard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VirtualCard").field("configured", &self.fpga.is_some()).finish_non_exhaustive()
    }
}

impl VirtualCard {
    /// An unconfigured card with this robot, in simulated time; what is loaded runs as [`fast`] says.
    ///
    /// # Errors
    /// A robot whose wheels cannot drive it.
    pub fn new(robot: &Robot) -> Result<Self, GeometryError> {
        Ok(Self {
            faults: Faults::default(),
            bridge: Bridge::new(Eeprom::default()),
            device: SelectMap::new(Duration::ZERO),
            fabric: Box::new(fast),
            fpga: None,
            configured_at: Duration::ZERO,
            machine: Machine::new(robot)?,
            idle_until: Duration::ZERO,
            time: Time::Simulated(Duration::ZERO),
            clock_hz: f64::from(NOMINAL_CLOCK_HZ),
            accesses: 0,
            bytes: 0,
            loads: 0,
            kicks: 0,
            misfit: None,
            failure: None,
        })
    }

    /// Another EEPROM on the card.
    #[must_use]
    pub fn with_eeprom(mut self, eeprom: Eeprom) -> Self {
        self.bridge = Bridge::new(eeprom);
        self
    }

    /// Another local bus clock than the nominal one, Hz.
    #[must_use]
    pub fn with_clock(mut self, clock_hz: f64) -> Self {
        self.clock_hz = clock_hz;
        self
    }

    /// Another FPGA.
    #[must_use]
    pub fn with_fabric(mut self, fabric: Fabric) -> Self {
        self.fabric = fabric;
        self
    }

    /// Whatever is loaded runs as its own bits, decoded, the committed design too.
    #[must_use]
    pub fn with_decoded_bits(self) -> Self {
        self.with_fabric(Box::new(decoded))
    }

    /// The compiled Verilog as FPGA; it takes only the bitstream that is made of it.
    ///
    /// # Errors
    /// A missing Verilator, by the name of its package, or a compilation that fails.
    pub fn with_verilog(self) -> Result<Self, FpgaError> {
        // The first to be configured; it also proves that there will be more.
        let mut first = Some(PinsLive::compiled()?);
        let made_of_it = committed().packets;
        Ok(self.with_fabric(Box::new(move |device| {
            if !device.has(&made_of_it) {
                return Err(FpgaError::NoCircuit("another bitstream than that of the compiled Verilog".into()));
            }
            Ok(Box::new(first.take().map_or_else(PinsLive::compiled, Ok)?))
        })))
    }

    /// In the time that [`VirtualCard::tell`] tells.
    #[must_use]
    pub fn in_told_time(mut self) -> Self {
        self.time = Time::Told { now: Duration::ZERO, limit: Duration::ZERO };
        self
    }

    /// Tells a card [in told time](Self::in_told_time) that it is `at`, and that it will be told again `within`
    /// this time. A time that is past is left out: a clock does not go back.
    pub fn tell(&mut self, at: Duration, within: Duration) {
        if let Time::Told { now, limit } = &mut self.time
            && at >= *now
        {
            (*now, *limit) = (at, at + within);
            self.settle();
        }
    }

    /// In the host's time from now on.
    #[must_use]
    pub fn in_host_time(mut self) -> Self {
        self.time = Time::Host(Instant::now());
        self
    }

    /// Accesses so far.
    #[must_use]
    pub fn accesses(&self) -> u64 {
        self.accesses
    }

    /// The robot as it is now.
    pub fn machine(&mut self) -> &Machine {
        self.settle();
        &self.machine
    }

    /// Lifts the robot, and sets it down elsewhere; its wheels stay as they are.
    pub fn stand(&mut self, pose: runs::frames::Pose) {
        self.settle();
        self.machine.stand(pose);
    }

    /// A design runs.
    #[must_use]
    pub fn configured(&self) -> bool {
        self.fpga.is_some()
    }

    /// Kicks that the kicker's trigger has seen.
    #[must_use]
    pub fn kicks(&self) -> u32 {
        self.kicks + self.fpga.as_ref().map_or(0, |fpga| fpga.kicks())
    }

    /// Why the simulation behind the card failed, if it did; the card then reads all ones.
    #[must_use]
    pub fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Why what was loaded is no design, if it is none: its bits make no circuit.
    #[must_use]
    pub fn misfit(&self) -> Option<&str> {
        self.misfit.as_deref()
    }

    /// A register as it is, without an access over the bus and without side effects on the host's time.
    pub fn peek(&mut self, offset: u16) -> Option<u32> {
        self.settle();
        self.fpga.as_mut()?.read(offset).ok()
    }

    /// A PCI reset: the bridge forgets, the FPGA runs on.
    pub fn reset(&mut self) {
        self.bridge.reset();
        self.follow_lines();
    }

    fn elapsed(&self) -> Duration {
        match self.time {
            Time::Simulated(now) | Time::Told { now, .. } => now,
            Time::Host(begun) => begun.elapsed(),
        }
    }

    /// An access reaches the FPGA's registers.
    fn spend_bus_cycle(&mut self) {
        self.spend(Duration::from_secs_f64(BUS_CLOCKS / self.clock_hz));
    }

    fn spend(&mut self, time: Duration) {
        match &mut self.time {
            Time::Simulated(now) => *now += time,
            Time::Told { now, limit } => *now = (*now + time).min(*limit).max(*now),
            Time::Host(_) => {}
        }
    }

    /// Brings FPGA and robot up to now.
    fn settle(&mut self) {
        let now = self.elapsed();
        if let Some(fpga) = &mut self.fpga {
            if self.faults.clock_still {
                return;
            }
            let clock = ((now.saturating_sub(self.configured_at)).as_secs_f64() * self.clock_hz) as u64;
            if let Err(error) = fpga.run_to(clock, self.clock_hz, &mut self.machine) {
                self.failure.get_or_insert(error.to_string());
            }
            self.idle_until = now;
            return;
        }
        while now.saturating_sub(self.idle_until).as_secs_f64() >= IDLE_STEP_S {
            self.machine.step(&[0.0; fixed_kin::AXES], IDLE_STEP_S);
            self.idle_until += Duration::from_secs_f64(IDLE_STEP_S);
        }
    }

    /// The FPGA sees what the bridge's lines do.
    fn follow_lines(&mut self) {
        let now = self.elapsed();
        let program = self.bridge.program();
        self.device.program(program, now);
        if !self.device.done(now)
            && let Some(fpga) = self.fpga.take()
        {
            self.kicks += fpga.kicks();
        }
        if !program {
            self.bytes = 0;
            self.misfit = None;
        }
    }

    fn start_design(&mut self) {
        let now = self.elapsed();
        if self.fpga.is_none() && self.misfit.is_none() && self.device.done(now) && !self.faults.done_low {
            self.machine.restart_encoders();
            self.configured_at = now;
            match (self.fabric)(&self.device) {
                Ok(design) => self.fpga = Some(design),
                Err(error) => self.misfit = Some(error.to_string()),
            }
        }
    }

    fn present(&mut self) -> bool {
        self.accesses += 1;
        !self.faults.absent
            && self.faults.absent_after.is_none_or(|from| self.accesses < from)
            && self.failure.is_none()
    }

    /// A read of 1, 2 or 4 bytes, as the bus makes it.
    pub fn bus_read(&mut self, bar: Bar, offset: u32, size: u32) -> u32 {
        let ones = u32::MAX >> (32 - 8 * size.clamp(1, 4));
        self.spend(READ_TIME);
        self.settle();
        if !self.present() {
            return ones;
        }
        let now = self.elapsed();
        match bar {
            Bar::Bridge | Bar::BridgePorts => {
                let done = (self.device.done(now) || self.faults.done_high) && !self.faults.done_low;
                let init = self.device.init(now) && !self.faults.init_low;
                self.bridge.read(offset, size, done, init)
            }
            Bar::Memory32 | Bar::Ports32 => {
                self.start_design();
                self.spend_bus_cycle();
                let Some(fpga) = &mut self.fpga else { return ones };
                let word = if self.bridge.waits(bar.index() - 2) {
                    match fpga.read((offset & 0xFFFC) as u16) {
                        Ok(word) => word,
                        Err(error) => {
                            self.failure = Some(error.to_string());
                            return ones;
                        }
                    }
                } else {
                    // Too early: the bus still carries the address.
                    offset & 0xFFFC
                };
                word >> (8 * (offset & 3)) & ones
            }
            // The 16-bit spaces split every word; nobody reads registers through them.
            Bar::Ports16 | Bar::Memory16 => ones,
        }
    }

    /// A write of 1, 2 or 4 bytes, as the bus makes it.
    pub fn bus_write(&mut self, bar: Bar, offset: u32, size: u32, data: u32) {
        self.spend(WRITE_TIME);
        self.settle();
        if !self.present() {
            return;
        }
        match bar {
            Bar::Bridge | Bar::BridgePorts => {
                self.bridge.write(offset, size, data);
                self.follow_lines();
            }
            _ if self.fpga.is_none() && !self.device.done(self.elapsed()) => self.configure(offset, data),
            Bar::Memory32 | Bar::Ports32 => {
                self.start_design();
                self.spend_bus_cycle();
                if let Some(fpga) = &mut self.fpga
                    && let Err(error) = fpga.write((offset & 0xFFFC) as u16, data)
                {
                    self.failure = Some(error.to_string());
                }
            }
            Bar::Ports16 | Bar::Memory16 => {}
        }
    }

    /// A byte for the configuration port, on lane 0 or on none.
    fn configure(&mut self, offset: u32, data: u32) {
        if self.bridge.write_line() || self.faults.write_high {
            return;
        }
        let now = self.elapsed();
        let lane = if offset.is_multiple_of(4) { data as u8 } else { 0xFF };
        let index = self.bytes;
        self.bytes += 1;
        if index == 0 {
            self.loads += 1;
        }
        let hurt = self.loads <= self.faults.hurt_loads;
        let at = |byte: Option<u64>| hurt && byte == Some(index);
        if at(self.faults.lost_byte) {
            return;
        }
        let flips = self.faults.flipped_byte.filter(|(byte, _)| at(Some(*byte))).map_or(0, |(_, bits)| bits);
        self.device.strobe(lane ^ flips, now);
        if at(self.faults.doubled_byte) {
            self.device.strobe(lane ^ flips, now);
        }
    }
}

impl PciCard for VirtualCard {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        check(bar, offset, 4).map_err(|cause| PciError::read(bar, offset, cause))?;
        Ok(self.bus_read(bar, offset, 4))
    }

    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        check(bar, offset, 4).map_err(|cause| PciError::write(bar, offset, cause))?;
        self.bus_write(bar, offset, 4, data);
        Ok(())
    }

    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
        check(bar, offset, 1).map_err(|cause| PciError::write(bar, offset, cause))?;
        self.bus_write(bar, offset, 1, data.into());
        Ok(())
    }

    fn has(&self, _: Bar) -> bool {
        true
    }

    fn now(&mut self) -> Duration {
        self.elapsed()
    }

    fn sleep(&mut self, time: Duration) {
        match self.time {
            Time::Simulated(_) | Time::Told { .. } => self.spend(time),
            Time::Host(_) => std::thread::sleep(time),
        }
        self.settle();
    }

    fn remark(&self) -> Option<String> {
        let misfit = self.misfit().map(|why| format!("a design that cannot run, {why}"));
        misfit.or_else(|| self.failure().map(|why| format!("the simulation behind the card failed: {why}")))
    }
}

fn check(bar: Bar, offset: u32, width: u32) -> Result<(), &'static str> {
    if !offset.is_multiple_of(width) {
        return Err("the offset is not aligned");
    }
    if offset > bar.size() - width {
        return Err("the offset is beyond the window");
    }
    Ok(())
}
