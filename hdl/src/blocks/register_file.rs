//! The plain registers, byte offsets 000–0FF of the map, and the strobes of those that act.
//!
//! | access | rule |
//! |---|---|
//! | locked while armed | a write while `armed` is ignored |
//! | write only | a strobe in the clock after the write, with `written` |
//! | read | `read_data` and `kept_data` two clocks after `address`; the word is both, ored |
//!
//! Wide registers that only keep what was written are read from a copy in block memory, which is written with
//! any register and shows only the bits that a copied one has. It is read a clock late, at the address that a write
//! would have then; nobody may want what it gives after a clock that writes.
//!
//! The case labels are word addresses of `fixed_kin::registers`; a test walks all of them.

use crate::primitives::{Literal, Memory, Preset, Setting};
use fixed_kin::AXES;
use fixed_kin::registers::{
    BLOCKS_VALUE, COOKIE_VALUE, DEFAULT_SET_POINT_TIMEOUT, DEFAULT_STALL_WINDOW, DEFAULT_TICK_PERIOD,
    DEFAULT_WATCHDOG_TIMEOUT, IMU_CONTROL, KICKER_CHARGE_TIMEOUT, KICKER_FIRE_WORD, KICKER_LOCKOUT, KICKER_PULSE,
    PWM_BLANKING, PWM_PERIOD, Register, SET_POINT_TIMEOUT, STALL_COMPARE, STALL_WINDOW, TICK_PERIOD, VERSION,
    WATCHDOG_TIMEOUT,
};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// Registers that are read from the copy in block memory.
const COPIED: [&Register; 11] = [
    &TICK_PERIOD,
    &PWM_PERIOD,
    &PWM_BLANKING,
    &WATCHDOG_TIMEOUT,
    &KICKER_PULSE,
    &KICKER_LOCKOUT,
    &KICKER_CHARGE_TIMEOUT,
    &SET_POINT_TIMEOUT,
    &STALL_WINDOW,
    &STALL_COMPARE,
    &IMU_CONTROL,
];

/// See the module.
#[derive(LogicBlock, Default)]
pub struct RegisterFile {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Word address inside the page.
    pub address: Signal<In, Bits<6>>,
    /// The page is written in this clock.
    pub write: Signal<In, Bit>,
    /// What is written.
    pub data: Signal<In, Bits<32>>,
    /// What was written in the last clock.
    pub written: Signal<Out, Bits<32>>,
    /// The word at `address` of the clock before the last, 0 for a copied register or where there is none.
    pub read_data: Signal<Out, Bits<32>>,
    /// `address` of the last clock was in this page.
    pub was_in_page: Signal<In, Bit>,
    /// The copied register there, likewise.
    pub kept_data: Signal<Out, Bits<24>>,
    /// Outputs may be on.
    pub armed: Signal<In, Bit>,

    /// `board`, a constant of the top module.
    pub board: Signal<In, Bits<32>>,
    /// `clock_hz`, likewise.
    pub clock_hz: Signal<In, Bits<32>>,
    /// Live `time`.
    pub clock_count: Signal<In, Bits<32>>,
    /// Live `faults`.
    pub faults: Signal<In, Bits<8>>,
    /// Live `first_fault`.
    pub first_fault: Signal<In, Bits<8>>,
    /// Live `status`.
    pub status: Signal<In, Bits<8>>,
    /// Live `commits`.
    pub commits: Signal<In, Bits<32>>,
    /// Live `encoder_error`.
    pub encoder_error: Signal<In, Bits<4>>,
    /// Live `encoder_lines`.
    pub encoder_lines: Signal<In, Bits<12>>,
    /// Live `kicker_status`.
    pub kicker_status: Signal<In, Bits<8>>,
    /// Live `stall`.
    pub stall: Signal<In, Bits<4>>,
    /// Live `index_status`.
    pub index_status: Signal<In, Bits<8>>,
    /// Live `interrupt_status`.
    pub interrupt_status: Signal<In, Bits<2>>,
    /// Live `radio`.
    pub radio: Signal<In, Bits<24>>,
    /// Live `imu_status`.
    pub imu_status: Signal<In, Bits<9>>,

    /// The register `tick_period` as last written.
    pub tick_period: Signal<Out, Bits<24>>,
    /// High for the clock in which `tick_period` is written.
    pub tick_period_written: Signal<Out, Bit>,
    /// The register `mode` as last written.
    pub mode: Signal<Out, Bits<4>>,
    /// The register `encoder_filter` as last written.
    pub encoder_filter: Signal<Out, Bits<4>>,
    /// The register `encoder_fault_mask` as last written.
    pub encoder_fault_mask: Signal<Out, Bits<4>>,
    /// The register `pwm_period` as last written.
    pub pwm_period: Signal<Out, Bits<13>>,
    /// The register `pwm_blanking` as last written.
    pub pwm_blanking: Signal<Out, Bits<10>>,
    /// The register `watchdog_timeout` as last written.
    pub watchdog_timeout: Signal<Out, Bits<24>>,
    /// The register `kicker_control` as last written.
    pub kicker_control: Signal<Out, Bits<4>>,
    /// The register `kicker_pulse` as last written.
    pub kicker_pulse: Signal<Out, Bits<14>>,
    /// The register `kicker_lockout` as last written.
    pub kicker_lockout: Signal<Out, Bits<20>>,
    /// The register `kicker_charge_timeout` as last written.
    pub kicker_charge_timeout: Signal<Out, Bits<24>>,
    /// `clocks_per_us`.
    pub clocks_per_microsecond: Signal<Out, Bits<6>>,
    /// The register `leds` as last written.
    pub leds: Signal<Out, Bits<8>>,
    /// The register `set_point_timeout` as last written.
    pub set_point_timeout: Signal<Out, Bits<16>>,
    /// The register `stall_window` as last written.
    pub stall_window: Signal<Out, Bits<16>>,
    /// The register `stall_compare` as last written.
    pub stall_compare: Signal<Out, Bits<13>>,
    /// The register `interrupt_enable` as last written.
    pub interrupt_enable: Signal<Out, Bits<2>>,
    /// `stall` is written: the bits to clear.
    pub clear_stall: Signal<Out, Bits<4>>,
    /// `index_arm` is written: axes to capture.
    pub index_arm: Signal<Out, Bits<4>>,
    /// Of those captured, axes whose counts begin at zero at the index; lasts.
    pub index_clear: Signal<Out, Bits<4>>,
    /// `interrupt_status` is written: the bits to clear.
    pub clear_interrupt: Signal<Out, Bits<2>>,
    /// `radio` is written.
    pub select_radio: Signal<Out, Bit>,
    /// The register `imu_control` as last written.
    pub imu_control: Signal<Out, Bits<11>>,
    /// `imu_access` is written.
    pub imu_access: Signal<Out, Bit>,
    /// `arm` is written.
    pub arm_write: Signal<Out, Bit>,
    /// `faults` is written: the bits to clear.
    pub clear_faults: Signal<Out, Bits<8>>,
    /// `faults` is written with anything but 0.
    pub clear_kicker: Signal<Out, Bit>,
    /// `encoder_error` is written: the bits to clear.
    pub clear_encoder_error: Signal<Out, Bits<4>>,
    /// `commit_set_points` is written.
    pub commit_set_points: Signal<Out, Bit>,
    /// `commit_configuration` is written.
    pub commit_configuration: Signal<Out, Bit>,
    /// `kicker_fire` is written with the right word.
    pub fire: Signal<Out, Bit>,

    tick_period_q: Preset<24, { DEFAULT_TICK_PERIOD as u64 }>,
    mode_q: DFF<Bits<4>>,
    encoder_filter_q: Preset<4, 3>,
    encoder_fault_mask_q: Preset<4, 0xF>,
    pwm_period_q: DFF<Bits<13>>,
    pwm_blanking_q: Preset<10, 33>,
    watchdog_timeout_q: Preset<24, { DEFAULT_WATCHDOG_TIMEOUT as u64 }>,
    kicker_control_q: DFF<Bits<4>>,
    kicker_pulse_q: DFF<Bits<14>>,
    kicker_lockout_q: DFF<Bits<20>>,
    kicker_charge_timeout_q: DFF<Bits<24>>,
    clocks_per_microsecond_q: Preset<6, 33>,
    leds_q: DFF<Bits<8>>,
    set_point_timeout_q: Preset<16, { DEFAULT_SET_POINT_TIMEOUT as u64 }>,
    stall_window_q: Preset<16, { DEFAULT_STALL_WINDOW as u64 }>,
    stall_compare_q: DFF<Bits<13>>,
    interrupt_enable_q: DFF<Bits<2>>,
    index_clear_q: DFF<Bits<4>>,
    imu_control_q: DFF<Bits<11>>,
    read_q: DFF<Bits<32>>,
    writing: DFF<Bit>,
    place: DFF<Bits<6>>,
    word: DFF<Bits<32>>,
    kept: Memory<24, 6>,
    mask: DFF<Bits<24>>,

    unlocked: Signal<Local, Bit>,
    no_bits: Literal<24, 0>,
    bits_10: Literal<24, 0x3FF>,
    bits_11: Literal<24, 0x7FF>,
    bits_13: Literal<24, 0x1FFF>,
    bits_14: Literal<24, 0x3FFF>,
    bits_16: Literal<24, 0xFFFF>,
    bits_20: Literal<24, 0xF_FFFF>,
    bits_24: Literal<24, 0xFF_FFFF>,

    kicker_pulse_place: Literal<6, { KICKER_PULSE.word_address() as u64 }>,

    cookie: Literal<32, { COOKIE_VALUE as u64 }>,
    version: Literal<32, { VERSION as u64 }>,
    blocks: Literal<32, { BLOCKS_VALUE as u64 }>,
    axes: Literal<32, { AXES as u64 }>,
    fire_word: Literal<32, { KICKER_FIRE_WORD as u64 }>,
    zero: Literal<32, 0>,
    no_axes: Literal<4, 0>,
    no_faults: Literal<8, 0>,
    no_causes: Literal<2, 0>,
    /// Set by the emitter; the hash is taken with this constant zero.
    content_hash: Setting<32>,
}

impl RegisterFile {
    /// Registers at their reset values, with the hash of the emitted Verilog.
    #[must_use]
    pub fn new(content_hash: u32) -> Self {
        let mut initial = [0; 64];
        for register in COPIED {
            initial[usize::from(register.word_address())] = register.reset;
        }
        Self { content_hash: Setting::new(content_hash.into()), kept: Memory::new(&initial), ..Self::default() }
    }
}

impl Logic for RegisterFile {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            tick_period_q,
            mode_q,
            encoder_filter_q,
            pwm_period_q,
            pwm_blanking_q,
            watchdog_timeout_q,
            encoder_fault_mask_q,
            kicker_control_q,
            kicker_pulse_q,
            kicker_lockout_q,
            kicker_charge_timeout_q,
            clocks_per_microsecond_q,
            leds_q,
            set_point_timeout_q,
            stall_window_q,
            stall_compare_q,
            interrupt_enable_q,
            index_clear_q,
            imu_control_q,
            read_q,
            mask,
            writing,
            place,
            word
        );

        self.unlocked.next = !self.armed.val();
        self.tick_period_written.next = false;
        self.arm_write.next = false;
        self.select_radio.next = false;
        self.imu_access.next = false;
        self.clear_faults.next = self.no_faults.val();
        self.clear_kicker.next = false;
        self.commit_set_points.next = false;
        self.commit_configuration.next = false;
        self.fire.next = false;
        self.clear_encoder_error.next = self.no_axes.val();
        self.clear_stall.next = self.no_axes.val();
        self.index_arm.next = self.no_axes.val();
        self.clear_interrupt.next = self.no_causes.val();
        // A write acts in the clock after, which keeps the decoding of address and strobe out of its paths.
        self.writing.d.next = self.write.val();
        self.place.d.next = self.address.val();
        self.word.d.next = self.data.val();
        self.written.next = self.word.q.val();
        self.kept.clock.next = self.clock.val();
        self.kept.read_address.next = self.place.q.val();
        self.kept.write_address.next = self.place.q.val();
        self.kept.write_data.next = self.word.q.val().get_bits::<24>(0);
        self.kept.write_enable.next =
            self.writing.q.val() & (self.unlocked.val() | (self.place.q.val() == self.kicker_pulse_place.val()));
        self.mask.d.next = self.no_bits.val();
        if self.was_in_page.val() {
            match self.place.q.val().index() {
                8 => {
                    self.mask.d.next = self.bits_24.val();
                } // TICK_PERIOD
                11 => {
                    self.mask.d.next = self.bits_13.val();
                } // PWM_PERIOD
                12 => {
                    self.mask.d.next = self.bits_10.val();
                } // PWM_BLANKING
                13 => {
                    self.mask.d.next = self.bits_24.val();
                } // WATCHDOG_TIMEOUT
                26 => {
                    self.mask.d.next = self.bits_14.val();
                } // KICKER_PULSE
                27 => {
                    self.mask.d.next = self.bits_20.val();
                } // KICKER_LOCKOUT
                28 => {
                    self.mask.d.next = self.bits_24.val();
                } // KICKER_CHARGE_TIMEOUT
                32 => {
                    self.mask.d.next = self.bits_16.val();
                } // SET_POINT_TIMEOUT
                33 => {
                    self.mask.d.next = self.bits_16.val();
                } // STALL_WINDOW
                34 => {
                    self.mask.d.next = self.bits_13.val();
                } // STALL_COMPARE
                41 => {
                    self.mask.d.next = self.bits_11.val();
                } // IMU_CONTROL
                _ => {
                    self.mask.d.next = self.no_bits.val();
                }
            }
        }
        self.kept_data.next = self.kept.read_data.val() & self.mask.q.val();
        if self.writing.q.val() {
            match self.place.q.val().index() {
                8 => {
                    if self.unlocked.val() {
                        self.tick_period_q.d.next = self.word.q.val().get_bits::<24>(0);
                        self.tick_period_written.next = true;
                    }
                } // TICK_PERIOD
                9 => {
                    if self.unlocked.val() {
                        self.mode_q.d.next = self.word.q.val().get_bits::<4>(0);
                    }
                } // MODE
                10 => {
                    if self.unlocked.val() {
                        self.encoder_filter_q.d.next = self.word.q.val().get_bits::<4>(0);
                    }
                } // ENCODER_FILTER
                11 => {
                    if self.unlocked.val() {
                        self.pwm_period_q.d.next = self.word.q.val().get_bits::<13>(0);
                    }
                } // PWM_PERIOD
                12 => {
                    if self.unlocked.val() {
                        self.pwm_blanking_q.d.next = self.word.q.val().get_bits::<10>(0);
                    }
                } // PWM_BLANKING
                13 => {
                    if self.unlocked.val() {
                        self.watchdog_timeout_q.d.next = self.word.q.val().get_bits::<24>(0);
                    }
                } // WATCHDOG_TIMEOUT
                14 => {
                    self.arm_write.next = true;
                } // ARM
                15 => {
                    self.clear_faults.next = self.word.q.val().get_bits::<8>(0);
                    self.clear_kicker.next = self.word.q.val() != self.zero.val();
                } // FAULTS
                18 => {
                    self.commit_set_points.next = true;
                } // COMMIT_SET_POINTS
                19 => {
                    self.commit_configuration.next = true;
                } // COMMIT_CONFIGURATION
                21 => {
                    self.clear_encoder_error.next = self.word.q.val().get_bits::<4>(0);
                } // ENCODER_ERROR
                23 => {
                    if self.unlocked.val() {
                        self.encoder_fault_mask_q.d.next = self.word.q.val().get_bits::<4>(0);
                    }
                } // ENCODER_FAULT_MASK
                24 => {
                    self.kicker_control_q.d.next = self.word.q.val().get_bits::<4>(0);
                } // KICKER_CONTROL
                25 => {
                    self.fire.next = self.word.q.val() == self.fire_word.val();
                } // KICKER_FIRE
                26 => {
                    self.kicker_pulse_q.d.next = self.word.q.val().get_bits::<14>(0);
                } // KICKER_PULSE
                27 => {
                    if self.unlocked.val() {
                        self.kicker_lockout_q.d.next = self.word.q.val().get_bits::<20>(0);
                    }
                } // KICKER_LOCKOUT
                28 => {
                    if self.unlocked.val() {
                        self.kicker_charge_timeout_q.d.next = self.word.q.val().get_bits::<24>(0);
                    }
                } // KICKER_CHARGE_TIMEOUT
                30 => {
                    if self.unlocked.val() {
                        self.clocks_per_microsecond_q.d.next = self.word.q.val().get_bits::<6>(0);
                    }
                } // CLOCKS_PER_MICROSECOND
                31 => {
                    self.leds_q.d.next = self.word.q.val().get_bits::<8>(0);
                } // LEDS
                32 => {
                    if self.unlocked.val() {
                        self.set_point_timeout_q.d.next = self.word.q.val().get_bits::<16>(0);
                    }
                } // SET_POINT_TIMEOUT
                33 => {
                    if self.unlocked.val() {
                        self.stall_window_q.d.next = self.word.q.val().get_bits::<16>(0);
                    }
                } // STALL_WINDOW
                34 => {
                    if self.unlocked.val() {
                        self.stall_compare_q.d.next = self.word.q.val().get_bits::<13>(0);
                    }
                } // STALL_COMPARE
                35 => {
                    self.clear_stall.next = self.word.q.val().get_bits::<4>(0);
                } // STALL
                36 => {
                    self.index_arm.next = self.word.q.val().get_bits::<4>(0);
                    self.index_clear_q.d.next = (self.index_clear_q.q.val() & !self.word.q.val().get_bits::<4>(0))
                        | (self.word.q.val().get_bits::<4>(4) & self.word.q.val().get_bits::<4>(0));
                } // INDEX_ARM
                38 => {
                    self.interrupt_enable_q.d.next = self.word.q.val().get_bits::<2>(0);
                } // INTERRUPT_ENABLE
                39 => {
                    self.clear_interrupt.next = self.word.q.val().get_bits::<2>(0);
                } // INTERRUPT_STATUS
                40 => {
                    self.select_radio.next = true;
                } // RADIO
                41 => {
                    if self.unlocked.val() {
                        self.imu_control_q.d.next = self.word.q.val().get_bits::<11>(0);
                    }
                } // IMU_CONTROL
                42 => {
                    self.imu_access.next = true;
                } // IMU_ACCESS
                _ => {
                    self.fire.next = false;
                }
            }
        }

        self.read_q.d.next = self.zero.val();
        if self.was_in_page.val() {
            match self.place.q.val().index() {
                0 => {
                    self.read_q.d.next = self.cookie.val();
                }
                1 => {
                    self.read_q.d.next = self.version.val();
                }
                2 => {
                    self.read_q.d.next = self.board.val();
                }
                3 => {
                    self.read_q.d.next = self.clock_hz.val();
                }
                4 => {
                    self.read_q.d.next = self.content_hash.val();
                }
                5 => {
                    self.read_q.d.next = self.axes.val();
                }
                6 => {
                    self.read_q.d.next = self.clock_count.val();
                }
                7 => {
                    self.read_q.d.next = self.blocks.val();
                }
                9 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.mode_q.q.val());
                }
                10 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.encoder_filter_q.q.val());
                }
                15 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.faults.val());
                }
                16 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.first_fault.val());
                }
                17 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.status.val());
                }
                20 => {
                    self.read_q.d.next = self.commits.val();
                }
                21 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.encoder_error.val());
                }
                22 => {
                    self.read_q.d.next = bit_cast::<32, 12>(self.encoder_lines.val());
                }
                23 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.encoder_fault_mask_q.q.val());
                }
                24 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.kicker_control_q.q.val());
                }
                29 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.kicker_status.val());
                }
                30 => {
                    self.read_q.d.next = bit_cast::<32, 6>(self.clocks_per_microsecond_q.q.val());
                }
                31 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.leds_q.q.val());
                }
                35 => {
                    self.read_q.d.next = bit_cast::<32, 4>(self.stall.val());
                }
                37 => {
                    self.read_q.d.next = bit_cast::<32, 8>(self.index_status.val());
                }
                38 => {
                    self.read_q.d.next = bit_cast::<32, 2>(self.interrupt_enable_q.q.val());
                }
                39 => {
                    self.read_q.d.next = bit_cast::<32, 2>(self.interrupt_status.val());
                }
                40 => {
                    self.read_q.d.next = bit_cast::<32, 24>(self.radio.val());
                }
                43 => {
                    self.read_q.d.next = bit_cast::<32, 9>(self.imu_status.val());
                }
                _ => {
                    self.read_q.d.next = self.zero.val();
                }
            }
        }
        self.read_data.next = self.read_q.q.val();

        self.tick_period.next = self.tick_period_q.q.val();
        self.mode.next = self.mode_q.q.val();
        self.encoder_filter.next = self.encoder_filter_q.q.val();
        self.pwm_period.next = self.pwm_period_q.q.val();
        self.pwm_blanking.next = self.pwm_blanking_q.q.val();
        self.watchdog_timeout.next = self.watchdog_timeout_q.q.val();
        self.encoder_fault_mask.next = self.encoder_fault_mask_q.q.val();
        self.kicker_control.next = self.kicker_control_q.q.val();
        self.kicker_pulse.next = self.kicker_pulse_q.q.val();
        self.kicker_lockout.next = self.kicker_lockout_q.q.val();
        self.kicker_charge_timeout.next = self.kicker_charge_timeout_q.q.val();
        self.clocks_per_microsecond.next = self.clocks_per_microsecond_q.q.val();
        self.leds.next = self.leds_q.q.val();
        self.set_point_timeout.next = self.set_point_timeout_q.q.val();
        self.stall_window.next = self.stall_window_q.q.val();
        self.stall_compare.next = self.stall_compare_q.q.val();
        self.interrupt_enable.next = self.interrupt_enable_q.q.val();
        self.index_clear.next = self.index_clear_q.q.val();
        self.imu_control.next = self.imu_control_q.q.val();
    }
}
