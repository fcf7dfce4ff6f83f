//! The core: every block on one clock behind the local bus.
//!
//! ```text
//!  radio ─┐
//!  local bus ─┬─ register file ── safety, kicker, timebase
//!             ├─ commit ───────── banks of set points and configuration
//!             └─ memory of the sequencer ── snapshot ── inertial sensor
//!  encoders ─┬► sequencer (speed, kinematics, PI, pose) ──► PWM
//!            └► stall detectors ──► safety
//! ```
//!
//! Ports carry the names and levels of the pins, but for `lad`, which the emitted top file joins
//! from `lad_in`, `lad_out` and `lad_drive`, and for `board` and `clock_hz`, two constants by which each
//! board's top says whose pins are driven. Whatever can move a motor or fire the kicker is off at the pins in
//! the clock in which `armed` is low (the pulses fall with it in their own flip-flops, all else passes a gate),
//! and at once without a live clock, seen by the monitor on the crystal. The kicker's
//! capacitor is discharged, active high as an unconfigured pin is, whenever that gate is shut, unless
//! the host asked to hold the charge and neither the emergency stop nor a dead clock overrules it.
//!
//! A snapshot is done when the program has ended and the inertial sensor, where it is read, has sent its bytes.
//!
//! Radio and host share one write path. The radio's words go through in clocks that the bus does not claim;
//! while the radio commands, the host's writes reach only `arm` and `radio`. Reads are always the host's.

use crate::blocks::clock_monitor::ClockMonitor;
use crate::blocks::commit::Commit;
use crate::blocks::decoder::Decoder;
use crate::blocks::encoder::Encoder;
use crate::blocks::imu_spi::ImuSpi;
use crate::blocks::interrupt::Interrupt;
use crate::blocks::kicker::Kicker;
use crate::blocks::local_bus::LocalBus;
use crate::blocks::pwm::Pwm;
use crate::blocks::radio::Radio;
use crate::blocks::register_file::RegisterFile;
use crate::blocks::safety::Safety;
use crate::blocks::sequencer::Sequencer;
use crate::blocks::snapshot::Snapshot;
use crate::blocks::stall::Stall;
use crate::blocks::timebase::Timebase;
use crate::blocks::trigonometry::Trigonometry;
use crate::primitives::Literal;
use crate::program::{OutputPort, control_tick};
use fixed_kin::registers::{ARM, RADIO};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct Core {
    /// Local bus clock.
    pub lclk: Signal<In, Clock>,
    /// 50 MHz crystal.
    pub synclk: Signal<In, Clock>,
    /// What `board` reads, a constant of the top module.
    pub board: Signal<In, Bits<32>>,
    /// What `clock_hz` reads, likewise.
    pub clock_hz: Signal<In, Bits<32>>,
    /// Address strobe.
    pub ads_n: Signal<In, Bit>,
    /// Burst last.
    pub blast_n: Signal<In, Bit>,
    /// High for a write.
    pub lw_r: Signal<In, Bit>,
    /// Address and data bus, as seen.
    pub lad_in: Signal<In, Bits<32>>,
    /// Address and data bus, as driven.
    pub lad_out: Signal<Out, Bits<32>>,
    /// High while the card, not the bridge, drives LAD.
    pub lad_drive: Signal<Out, Bit>,
    /// Low: the word on LAD is taken or valid at this edge.
    pub ready_n: Signal<Out, Bit>,
    /// Interrupt, low = a cause that the host enabled.
    pub int_n: Signal<Out, Bit>,
    /// LEDs, low = on.
    pub led_n: Signal<Out, Bits<8>>,
    /// Encoder lines A, a bit per axis.
    pub encoder_a: Signal<In, Bits<4>>,
    /// Encoder lines B.
    pub encoder_b: Signal<In, Bits<4>>,
    /// Encoder index lines.
    pub encoder_index: Signal<In, Bits<4>>,
    /// PWM pins.
    pub pwm: Signal<Out, Bits<4>>,
    /// Direction pins.
    pub dir: Signal<Out, Bits<4>>,
    /// Bridge enables, low = on.
    pub enable_n: Signal<Out, Bits<4>>,
    /// Charger of the kicker, low = charge.
    pub kicker_charge_n: Signal<Out, Bit>,
    /// Trigger of the kicker, low = fire.
    pub kicker_trigger_n: Signal<Out, Bit>,
    /// Discharge of the kicker, high = discharge.
    pub kicker_discharge: Signal<Out, Bit>,
    /// The kicker's capacitor is full, high or open = full.
    pub kicker_full: Signal<In, Bit>,
    /// Emergency stop, high or open = stop.
    pub emergency_stop: Signal<In, Bit>,
    /// Ball sensor, high = ball.
    pub ball_sensor: Signal<In, Bit>,
    /// Serial line of the radio, idle high.
    pub radio_rx: Signal<In, Bit>,
    /// Strap: high or open = the host commands, low = the radio.
    pub host_select: Signal<In, Bit>,
    /// Straps: number of the robot, open = 15.
    pub robot_number: Signal<In, Bits<4>>,
    /// Chip select of the inertial sensor.
    pub imu_cs_n: Signal<Out, Bit>,
    /// Clock of its line.
    pub imu_sclk: Signal<Out, Bit>,
    /// Line to the sensor.
    pub imu_mosi: Signal<Out, Bit>,
    /// Line from the sensor, open = high.
    pub imu_miso: Signal<In, Bit>,
    /// Data-ready line of the sensor, active high.
    pub imu_ready: Signal<In, Bit>,

    bus: LocalBus,
    registers: RegisterFile,
    timebase: Timebase,
    decoder: Decoder,
    commit: Commit,
    snapshot: Snapshot,
    safety: Safety,
    kicker: Kicker,
    monitor: ClockMonitor,
    sequencer: Sequencer,
    trigonometry: Trigonometry,
    interrupt: Interrupt,
    radio: Radio,
    imu: ImuSpi,
    encoders: [Encoder; 4],
    stalls: [Stall; 4],
    drives: [Pwm; 4],

    clear_at_tick: DFF<Bits<4>>,
    status_at_tick: DFF<Bits<8>>,
    faults_at_tick: DFF<Bits<8>>,
    now: DFF<Bits<24>>,
    reverse: DFF<Bit>,
    stages: DFF<Bit>,
    encoder_fault: DFF<Bit>,
    stall_fault: DFF<Bit>,
    read_memory: DFF<Bit>,
    read_imu: DFF<Bit>,
    finished: DFF<Bit>,
    stop_sync: DFF<Bit>,
    stop_live: DFF<Bit>,
    ball_sync: DFF<Bit>,
    ball_live: DFF<Bit>,
    dead_sync: DFF<Bit>,
    dead_live: DFF<Bit>,

    tick: Signal<Local, Bit>,
    snapshot_done: Signal<Local, Bit>,
    alive: Signal<Local, Bit>,
    radio_turn: Signal<Local, Bit>,
    address: Signal<Local, Bits<14>>,
    index: Signal<Local, Bits<6>>,
    write_data: Signal<Local, Bits<32>>,
    host_writes: Signal<Local, Bit>,
    blocked: Signal<Local, Bit>,
    radio_writes: Signal<Local, Bit>,
    staged: Signal<Local, Bits<32>>,
    memory_word: Signal<Local, Bits<32>>,
    imu_word: Signal<Local, Bits<32>>,
    status: Signal<Local, Bits<8>>,
    kicker_status: Signal<Local, Bits<8>>,
    errors: Signal<Local, Bits<4>>,
    lines: Signal<Local, Bits<12>>,
    masked_errors: Signal<Local, Bits<4>>,
    count: Signal<Local, Bits<16>>,
    edge_time: Signal<Local, Bits<24>>,
    direction: Signal<Local, Bit>,
    index_count: Signal<Local, Bits<16>>,
    index_event: Signal<Local, Bits<1>>,
    index_clear: Signal<Local, Bits<1>>,
    indices: Signal<Local, Bits<4>>,
    index_status: Signal<Local, Bits<8>>,
    stalled: Signal<Local, Bits<4>>,
    masked_stalls: Signal<Local, Bits<4>>,
    second_starts: DFF<Bit>,
    third_starts: DFF<Bit>,
    fourth_starts: DFF<Bit>,
    quarter: Signal<Local, Bits<13>>,
    half: Signal<Local, Bits<13>>,
    three_quarters: DFF<Bits<13>>,
    shut: Signal<Local, Bit>,
    holds: Signal<Local, Bit>,
    line: DFF<Bits<16>>,
    compare: Signal<Local, Bits<13>>,
    pwm_pins: Signal<Local, Bits<4>>,
    dir_pins: Signal<Local, Bits<4>>,

    zero: Literal<32, 0>,
    /// The bits of the status that a snapshot shows; what is pending is over at the tick.
    live_status: Literal<8, 0x0F>,
    sign_30: Literal<32, 0xC000_0000>,
    mask_30: Literal<32, 0x3FFF_FFFF>,
    at_arm: Literal<6, { ARM.word_address() as u64 }>,
    at_radio: Literal<6, { RADIO.word_address() as u64 }>,
    none: Literal<4, 0>,
    all: Literal<4, 0xF>,
    port_direction: Literal<2, { OutputPort::Direction as u64 }>,
    port_compare: Literal<2, { OutputPort::Compare as u64 }>,
    port_angle: Literal<2, { OutputPort::Angle as u64 }>,
}

impl Core {
    /// The core with the hash of its own Verilog; 0 while that is being made.
    #[must_use]
    pub fn new(content_hash: u32) -> Self {
        Self {
            registers: RegisterFile::new(content_hash),
            sequencer: Sequencer::new(&control_tick()),
            ..Self::default()
        }
    }
}

impl Logic for Core {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            lclk,
            clear_at_tick,
            status_at_tick,
            faults_at_tick,
            now,
            line,
            reverse,
            stages,
            encoder_fault,
            stall_fault,
            read_memory,
            read_imu,
            finished,
            stop_sync,
            stop_live,
            ball_sync,
            ball_live,
            dead_sync,
            second_starts,
            third_starts,
            fourth_starts,
            three_quarters,
            dead_live
        );
        clock!(
            self,
            lclk,
            bus,
            registers,
            timebase,
            decoder,
            commit,
            snapshot,
            safety,
            kicker,
            sequencer,
            trigonometry,
            interrupt,
            radio,
            imu
        );
        for i in 0..4 {
            self.encoders[i].clock.next = self.lclk.val();
            self.stalls[i].clock.next = self.lclk.val();
            self.drives[i].clock.next = self.lclk.val();
        }
        self.monitor.lclk.next = self.lclk.val();
        self.monitor.synclk.next = self.synclk.val();

        // Pins.
        self.bus.ads_n.next = self.ads_n.val();
        self.bus.blast_n.next = self.blast_n.val();
        self.bus.lw_r.next = self.lw_r.val();
        self.bus.lad_in.next = self.lad_in.val();
        self.lad_out.next = self.bus.lad_out.val();
        self.lad_drive.next = self.bus.lad_drive.val();
        self.ready_n.next = self.bus.ready_n.val();
        self.snapshot_done.next = (self.sequencer.done.val() | self.finished.q.val()) & !self.imu.reading.val();
        self.interrupt.done.next = self.snapshot_done.val();
        self.interrupt.armed.next = self.safety.armed.val();
        self.interrupt.enable.next = self.registers.interrupt_enable.val();
        self.interrupt.clear.next = self.registers.clear_interrupt.val();
        self.int_n.next = self.interrupt.int_n.val();
        self.led_n.next = !self.registers.leds.val();
        self.stop_sync.d.next = self.emergency_stop.val();
        self.stop_live.d.next = self.stop_sync.q.val();
        self.ball_sync.d.next = self.ball_sensor.val();
        self.ball_live.d.next = self.ball_sync.q.val();
        self.dead_sync.d.next = self.monitor.lclk_dead.val();
        self.dead_live.d.next = self.dead_sync.q.val();

        self.status.next = bit_cast::<8, 1>(self.safety.armed.val().into())
            | (bit_cast::<8, 1>(self.safety.setpoints_valid.val().into()) << 1)
            | (bit_cast::<8, 1>(self.stop_live.q.val().into()) << 2)
            | (bit_cast::<8, 1>(self.ball_live.q.val().into()) << 3)
            | (bit_cast::<8, 1>(self.commit.set_points_pending.val().into()) << 4)
            | (bit_cast::<8, 1>(self.commit.configuration_pending.val().into()) << 5);

        // Time and the control tick.
        self.timebase.tick_period.next = self.registers.tick_period.val();
        self.timebase.restart.next = self.registers.tick_period_written.val();
        self.timebase.clocks_per_microsecond.next = self.registers.clocks_per_microsecond.val();
        self.timebase.stall_window.next = self.registers.stall_window.val();
        self.tick.next = self.timebase.tick.val() & !self.sequencer.running.val();
        self.sequencer.tick.next = self.tick.val();
        self.sequencer.configuration_bank.next = self.commit.configuration_bank.val();
        self.sequencer.set_point_bank.next = self.commit.set_point_bank.val();
        self.sequencer.snapshot_bank.next = self.snapshot.write_bank.val();
        self.snapshot.tick.next = self.tick.val();
        self.snapshot.done.next = self.snapshot_done.val();
        self.finished.d.next = (self.sequencer.done.val() | self.finished.q.val()) & self.imu.reading.val();
        if self.tick.val() {
            self.status_at_tick.d.next = self.status.val() & self.live_status.val();
            self.clear_at_tick.d.next = self.registers.index_clear.val();
            self.faults_at_tick.d.next = self.safety.faults.val();
            self.now.d.next = self.timebase.clock_count.val().get_bits::<24>(0);
        }

        // Whose turn it is, and where the access goes.
        self.radio.rx.next = self.radio_rx.val();
        self.radio.host_select.next = self.host_select.val();
        self.radio.robot.next = self.robot_number.val();
        self.radio.armed.next = self.safety.armed.val();
        self.radio_turn.next = self.radio.offer.val() & !self.bus.claims.val();
        self.address.next = self.bus.address.val();
        self.write_data.next = self.bus.write_data.val();
        if !self.bus.claims.val() {
            self.address.next = self.radio.address.val();
            self.write_data.next = self.radio.data.val();
        }
        self.index.next = self.address.val().get_bits::<6>(0);
        self.host_writes.next = self.bus.write.val()
            & (!self.radio.selected.val()
                | (self.index.val() == self.at_arm.val())
                | (self.index.val() == self.at_radio.val()));
        self.decoder.address.next = self.address.val();
        self.decoder.read.next = self.bus.read.val();
        self.decoder.configuration_bank.next = self.commit.configuration_bank.val();
        self.decoder.set_point_bank.next = self.commit.set_point_bank.val();
        self.decoder.snapshot_bank.next = self.snapshot.read_bank.val();
        self.snapshot.read_first.next = self.decoder.snapshot_first.val();
        self.snapshot.read_last.next = self.decoder.snapshot_last.val();

        // Writes act in the clock after, when it is known what they mean; they wait where the memory will be busy then.
        self.blocked.next = self.sequencer.bus_blocked.val();
        self.radio_writes.next = self.radio_turn.val() & !self.blocked.val();
        self.registers.address.next = self.index.val();
        self.registers.data.next = self.write_data.val();
        self.registers.write.next =
            self.decoder.at_registers.val() & (self.host_writes.val() | self.radio_writes.val());
        self.stages.d.next = self.radio_writes.val() | (self.bus.write.val() & !self.radio.selected.val());
        self.staged.next = self.registers.written.val() & self.mask_30.val();
        if self.registers.written.val().get_bit(29) {
            self.staged.next = self.registers.written.val() | self.sign_30.val();
        }
        self.radio.taken.next = self.radio_writes.val();
        self.radio.select_write.next = self.registers.select_radio.val();
        self.radio.select.next = self.registers.written.val().get_bit(0);
        self.sequencer.bus_address.next = self.decoder.memory_address.val();
        self.sequencer.bus_write_address.next = self.decoder.staging_address.val();
        self.sequencer.bus_write_data.next = self.staged.val();
        self.sequencer.bus_write.next =
            self.stages.q.val() & (self.decoder.stages_set_point.val() | self.decoder.stages_configuration.val());
        self.bus.write_busy.next = self.blocked.val();
        self.commit.stage_set_point.next = self.stages.q.val() & self.decoder.stages_set_point.val();
        self.commit.stage_configuration.next = self.stages.q.val() & self.decoder.stages_configuration.val();
        self.commit.address.next = self.decoder.staging_word.val();
        self.commit.data.next = self.registers.written.val();
        self.commit.checksum.next = self.registers.written.val();
        self.commit.commit_set_points.next = self.registers.commit_set_points.val();
        self.commit.commit_configuration.next = self.registers.commit_configuration.val();
        self.commit.tick.next = self.tick.val();

        // Reads: a memory is asked one clock after the strobe and answers in the next.
        self.read_memory.d.next = self.decoder.in_memory.val();
        self.read_imu.d.next = self.decoder.in_imu.val();
        self.memory_word.next = self.zero.val();
        if self.read_memory.q.val() {
            self.memory_word.next = self.sequencer.bus_read_data.val();
        }
        self.imu_word.next = self.zero.val();
        if self.read_imu.q.val() {
            self.imu_word.next = bit_cast::<32, 16>(self.imu.read_data.val());
        }
        self.registers.was_in_page.next = self.decoder.in_registers.val();
        self.bus.read_data.next = self.registers.read_data.val()
            | bit_cast::<32, 24>(self.registers.kept_data.val())
            | self.memory_word.val()
            | self.imu_word.val();

        // Inertial sensor.
        self.imu.tick.next = self.tick.val();
        self.imu.bank.next = self.snapshot.write_bank.val();
        self.imu.enable.next = self.registers.imu_control.val().get_bit(0);
        self.imu.idle_high.next = self.registers.imu_control.val().get_bit(1);
        self.imu.half.next = self.registers.imu_control.val().get_bits::<2>(2);
        self.imu.first.next = self.registers.imu_control.val().get_bits::<7>(4);
        self.imu.access.next = self.registers.imu_access.val();
        self.imu.command.next = self.registers.written.val().get_bits::<16>(0);
        self.imu.miso.next = self.imu_miso.val();
        self.imu.ready.next = self.imu_ready.val();
        self.imu.read_bank.next = self.snapshot.read_bank.val();
        self.imu.read_word.next = self.decoder.word.val().get_bits::<3>(0);
        self.imu_cs_n.next = self.imu.cs_n.val();
        self.imu_sclk.next = self.imu.sclk.val();
        self.imu_mosi.next = self.imu.mosi.val();

        // Encoders.
        for i in 0..4 {
            self.encoders[i].a.next = self.encoder_a.val().get_bit(i);
            self.encoders[i].b.next = self.encoder_b.val().get_bit(i);
            self.encoders[i].filter.next = self.registers.encoder_filter.val();
            self.encoders[i].sample.next = self.tick.val();
            self.encoders[i].now.next = self.timebase.clock_count.val().get_bits::<24>(0);
            self.encoders[i].clear_error.next = self.registers.clear_encoder_error.val().get_bit(i);
            self.encoders[i].index.next = self.encoder_index.val().get_bit(i);
            self.encoders[i].arm_index.next = self.registers.index_arm.val().get_bit(i);
            self.stalls[i].enable.next = self.safety.armed.val();
            self.stalls[i].step.next = self.encoders[i].step.val();
            self.stalls[i].up.next = self.encoders[i].up.val();
            self.stalls[i].threshold.next = self.registers.stall_compare.val();
            self.stalls[i].window.next = self.timebase.window.val();
            self.stalls[i].clear.next = self.registers.clear_stall.val().get_bit(i);
        }
        self.indices.next = bit_cast::<4, 1>(self.encoders[0].live_index.val().into())
            | (bit_cast::<4, 1>(self.encoders[1].live_index.val().into()) << 1)
            | (bit_cast::<4, 1>(self.encoders[2].live_index.val().into()) << 2)
            | (bit_cast::<4, 1>(self.encoders[3].live_index.val().into()) << 3);
        self.index_status.next = bit_cast::<8, 1>(self.encoders[0].index_waiting.val().into())
            | (bit_cast::<8, 1>(self.encoders[1].index_waiting.val().into()) << 1)
            | (bit_cast::<8, 1>(self.encoders[2].index_waiting.val().into()) << 2)
            | (bit_cast::<8, 1>(self.encoders[3].index_waiting.val().into()) << 3)
            | (bit_cast::<8, 1>(self.encoders[0].index_seen.val().into()) << 4)
            | (bit_cast::<8, 1>(self.encoders[1].index_seen.val().into()) << 5)
            | (bit_cast::<8, 1>(self.encoders[2].index_seen.val().into()) << 6)
            | (bit_cast::<8, 1>(self.encoders[3].index_seen.val().into()) << 7);
        self.stalled.next = bit_cast::<4, 1>(self.stalls[0].stalled.val().into())
            | (bit_cast::<4, 1>(self.stalls[1].stalled.val().into()) << 1)
            | (bit_cast::<4, 1>(self.stalls[2].stalled.val().into()) << 2)
            | (bit_cast::<4, 1>(self.stalls[3].stalled.val().into()) << 3);
        self.masked_stalls.next = self.stalled.val() & self.registers.encoder_fault_mask.val();
        self.errors.next = bit_cast::<4, 1>(self.encoders[0].error.val().into())
            | (bit_cast::<4, 1>(self.encoders[1].error.val().into()) << 1)
            | (bit_cast::<4, 1>(self.encoders[2].error.val().into()) << 2)
            | (bit_cast::<4, 1>(self.encoders[3].error.val().into()) << 3);
        self.lines.next = bit_cast::<12, 1>(self.encoders[0].live_a.val().into())
            | (bit_cast::<12, 1>(self.encoders[0].live_b.val().into()) << 1)
            | (bit_cast::<12, 1>(self.encoders[1].live_a.val().into()) << 2)
            | (bit_cast::<12, 1>(self.encoders[1].live_b.val().into()) << 3)
            | (bit_cast::<12, 1>(self.encoders[2].live_a.val().into()) << 4)
            | (bit_cast::<12, 1>(self.encoders[2].live_b.val().into()) << 5)
            | (bit_cast::<12, 1>(self.encoders[3].live_a.val().into()) << 6)
            | (bit_cast::<12, 1>(self.encoders[3].live_b.val().into()) << 7)
            | (bit_cast::<12, 4>(self.indices.val()) << 8);
        self.masked_errors.next = self.errors.val() & self.registers.encoder_fault_mask.val();

        // Input ports of the sequencer.
        match self.sequencer.axis.val().index() {
            0 => {
                self.count.next = self.encoders[0].count.val();
                self.edge_time.next = self.encoders[0].edge_time.val();
                self.direction.next = self.encoders[0].direction.val();
                self.index_count.next = self.encoders[0].index_count.val();
                self.index_event.next = self.encoders[0].index_event.val().into();
                self.index_clear.next = self.clear_at_tick.q.val().get_bits::<1>(0);
            }
            1 => {
                self.count.next = self.encoders[1].count.val();
                self.edge_time.next = self.encoders[1].edge_time.val();
                self.direction.next = self.encoders[1].direction.val();
                self.index_count.next = self.encoders[1].index_count.val();
                self.index_event.next = self.encoders[1].index_event.val().into();
                self.index_clear.next = self.clear_at_tick.q.val().get_bits::<1>(1);
            }
            2 => {
                self.count.next = self.encoders[2].count.val();
                self.edge_time.next = self.encoders[2].edge_time.val();
                self.direction.next = self.encoders[2].direction.val();
                self.index_count.next = self.encoders[2].index_count.val();
                self.index_event.next = self.encoders[2].index_event.val().into();
                self.index_clear.next = self.clear_at_tick.q.val().get_bits::<1>(2);
            }
            _ => {
                self.count.next = self.encoders[3].count.val();
                self.edge_time.next = self.encoders[3].edge_time.val();
                self.direction.next = self.encoders[3].direction.val();
                self.index_count.next = self.encoders[3].index_count.val();
                self.index_event.next = self.encoders[3].index_event.val().into();
                self.index_clear.next = self.clear_at_tick.q.val().get_bits::<1>(3);
            }
        }
        self.line.d.next = self.count.val() - bit_cast::<16, 1>(self.direction.val().into());
        match self.sequencer.input_port.val().index() {
            0 => {
                self.sequencer.input_data.next = bit_cast::<32, 16>(self.count.val());
            } // Count
            1 => {
                self.sequencer.input_data.next = bit_cast::<32, 24>(self.edge_time.val());
            } // EdgeTime
            2 => {
                self.sequencer.input_data.next = bit_cast::<32, 16>(self.line.q.val());
            } // Line
            3 => {
                self.sequencer.input_data.next = bit_cast::<32, 24>(self.now.q.val());
            } // Now
            4 => {
                self.sequencer.input_data.next = bit_cast::<32, 24>(self.timebase.period.val());
            } // TickPeriod
            5 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.registers.mode.val().get_bits::<1>(0));
            } // CountAndTime
            6 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.registers.mode.val().get_bits::<1>(1));
            } // Twist
            7 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.status_at_tick.q.val().get_bits::<1>(0));
            } // Armed
            8 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.status_at_tick.q.val().get_bits::<1>(1));
            } // SetPointsValid
            9 => {
                self.sequencer.input_data.next = bit_cast::<32, 13>(self.registers.pwm_period.val());
            } // PwmPeriod
            10 => {
                self.sequencer.input_data.next = bit_cast::<32, 8>(self.status_at_tick.q.val());
            } // Status
            11 => {
                self.sequencer.input_data.next = bit_cast::<32, 8>(self.faults_at_tick.q.val());
            } // Faults
            12 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.index_event.val());
            } // IndexEvent
            13 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.index_clear.val());
            } // IndexClear
            14 => {
                self.sequencer.input_data.next = bit_cast::<32, 16>(self.index_count.val());
            } // IndexCount
            15 => {
                self.sequencer.input_data.next = bit_cast::<32, 1>(self.registers.mode.val().get_bits::<1>(2));
            } // Odometry
            16 => {
                self.sequencer.input_data.next = bit_cast::<32, 18>(self.trigonometry.fraction.val());
            } // Fraction
            17 => {
                self.sequencer.input_data.next = bit_cast::<32, 18>(self.trigonometry.sine.val());
            } // Sine
            _ => {
                self.sequencer.input_data.next = bit_cast::<32, 18>(self.trigonometry.cosine.val());
            } // Cosine
        }

        // PWM.
        self.trigonometry.angle.next = self.sequencer.output_data.val();
        self.trigonometry.load.next =
            self.sequencer.output_strobe.val() & (self.sequencer.output_port.val() == self.port_angle.val());
        if self.sequencer.output_strobe.val() & (self.sequencer.output_port.val() == self.port_direction.val()) {
            self.reverse.d.next = self.sequencer.output_data.val().get_bit(31);
        }
        self.compare.next = self.sequencer.output_data.val().get_bits::<13>(12);
        self.alive.next = !self.monitor.lclk_dead.val();
        for i in 0..4 {
            self.drives[i].enable.next = self.safety.armed.val();
            self.drives[i].stops.next = self.safety.stops.val();
            self.drives[i].period.next = self.registers.pwm_period.val();
            self.drives[i].blanking.next = self.registers.pwm_blanking.val();
            self.drives[i].compare.next = self.compare.val();
            self.drives[i].direction.next = self.reverse.q.val();
            self.drives[i].load.next = false;
            self.drives[i].sync.next = false;
            self.drives[i].up_down.next = self.registers.mode.val().get_bit(3);
            self.stalls[i].compare.next = self.compare.val();
            self.stalls[i].load.next = false;
        }
        // Axes 1, 2, 3 start their periods a quarter, a half and three quarters after axis 0.
        self.quarter.next = self.registers.pwm_period.val() >> 2;
        self.half.next = self.registers.pwm_period.val() >> 1;
        self.three_quarters.d.next = self.half.val() + self.quarter.val();
        self.second_starts.d.next = self.drives[0].position.val() == self.quarter.val();
        self.third_starts.d.next = self.drives[0].position.val() == self.half.val();
        self.fourth_starts.d.next = self.drives[0].position.val() == self.three_quarters.q.val();
        self.drives[1].sync.next = self.second_starts.q.val();
        self.drives[2].sync.next = self.third_starts.q.val();
        self.drives[3].sync.next = self.fourth_starts.q.val();
        if self.sequencer.output_strobe.val() & (self.sequencer.output_port.val() == self.port_compare.val()) {
            match self.sequencer.axis.val().index() {
                0 => {
                    self.drives[0].load.next = true;
                    self.stalls[0].load.next = true;
                }
                1 => {
                    self.drives[1].load.next = true;
                    self.stalls[1].load.next = true;
                }
                2 => {
                    self.drives[2].load.next = true;
                    self.stalls[2].load.next = true;
                }
                _ => {
                    self.drives[3].load.next = true;
                    self.stalls[3].load.next = true;
                }
            }
        }
        self.pwm_pins.next = bit_cast::<4, 1>(self.drives[0].pwm.val().into())
            | (bit_cast::<4, 1>(self.drives[1].pwm.val().into()) << 1)
            | (bit_cast::<4, 1>(self.drives[2].pwm.val().into()) << 2)
            | (bit_cast::<4, 1>(self.drives[3].pwm.val().into()) << 3);
        self.dir_pins.next = bit_cast::<4, 1>(self.drives[0].dir.val().into())
            | (bit_cast::<4, 1>(self.drives[1].dir.val().into()) << 1)
            | (bit_cast::<4, 1>(self.drives[2].dir.val().into()) << 2)
            | (bit_cast::<4, 1>(self.drives[3].dir.val().into()) << 3);
        self.pwm.next = self.pwm_pins.val();
        self.dir.next = self.dir_pins.val();
        self.shut.next = self.safety.off.val() | !self.alive.val();
        if !self.alive.val() {
            self.pwm.next = self.none.val();
        }
        if self.registers.mode.val().get_bit(3) & !self.alive.val() {
            self.dir.next = self.none.val();
        }
        self.enable_n.next = self.none.val();
        if self.shut.val() {
            self.enable_n.next = self.all.val();
        }

        // Safety and kicker.
        self.safety.emergency_stop.next = self.emergency_stop.val();
        self.safety.arm_write.next = self.registers.arm_write.val();
        self.safety.arm_data.next = self.registers.written.val();
        self.safety.pet.next = self.commit.pet.val();
        self.safety.watchdog_timeout.next = self.registers.watchdog_timeout.val();
        self.encoder_fault.d.next = self.masked_errors.val() != self.none.val();
        self.stall_fault.d.next = self.masked_stalls.val() != self.none.val();
        self.safety.encoder_fault.next = self.encoder_fault.q.val();
        self.safety.stall_fault.next = self.stall_fault.q.val();
        self.safety.tick.next = self.tick.val();
        self.safety.set_point_timeout.next = self.registers.set_point_timeout.val();
        self.safety.commit_fault.next = self.commit.fault.val();
        self.safety.external_fault.next = self.dead_live.q.val();
        self.safety.clear_faults.next = self.registers.clear_faults.val();
        self.kicker.enable.next = self.safety.armed.val();
        self.kicker.microsecond.next = self.timebase.microsecond.val();
        self.kicker.charge_request.next = self.registers.kicker_control.val().get_bit(0);
        self.kicker.arm_on_ball.next = self.registers.kicker_control.val().get_bit(1);
        self.kicker.charge_timeout.next = self.registers.kicker_charge_timeout.val();
        self.kicker.fire.next = self.registers.fire.val();
        self.kicker.pulse.next = self.registers.kicker_pulse.val();
        self.kicker.lockout.next = self.registers.kicker_lockout.val();
        self.kicker.ball.next = self.ball_sensor.val();
        self.kicker.full.next = self.kicker_full.val();
        self.kicker.by_time.next = self.registers.kicker_control.val().get_bit(3);
        self.kicker.clear.next = self.registers.clear_kicker.val();
        self.kicker_charge_n.next = !(self.kicker.charge.val() & !self.shut.val());
        self.kicker_trigger_n.next = !(self.kicker.trigger.val() & !self.shut.val());

        self.holds.next =
            self.registers.kicker_control.val().get_bit(2) & !self.safety.stopped.val() & self.alive.val();
        self.kicker_discharge.next = self.shut.val() & !self.holds.val();

        // What the register file shows.
        self.registers.stall.next = self.stalled.val();
        self.registers.index_status.next = self.index_status.val();
        self.registers.interrupt_status.next = self.interrupt.status.val();
        self.registers.board.next = self.board.val();
        self.registers.clock_hz.next = self.clock_hz.val();
        self.registers.radio.next = bit_cast::<24, 1>(self.radio.selected.val().into())
            | (bit_cast::<24, 8>(self.radio.accepted.val()) << 8)
            | (bit_cast::<24, 8>(self.radio.dropped.val()) << 16);
        self.registers.imu_status.next =
            bit_cast::<9, 8>(self.imu.value.val()) | (bit_cast::<9, 1>(self.imu.busy.val().into()) << 8);
        self.registers.armed.next = self.safety.armed.val();
        self.registers.clock_count.next = self.timebase.clock_count.val();
        self.registers.faults.next = self.safety.faults.val();
        self.registers.first_fault.next = self.safety.first_fault.val();
        self.registers.encoder_error.next = self.errors.val();
        self.registers.encoder_lines.next = self.lines.val();
        self.registers.commits.next =
            bit_cast::<32, 16>(self.commit.accepted.val()) | (bit_cast::<32, 16>(self.commit.rejected.val()) << 16);
        self.registers.status.next = self.status.val();
        self.kicker_status.next = bit_cast::<8, 3>(self.kicker.state.val())
            | (bit_cast::<8, 1>(self.kicker.on_ball.val().into()) << 3)
            | (bit_cast::<8, 1>(self.kicker.ready.val().into()) << 4)
            | (bit_cast::<8, 1>(self.kicker.timed_out.val().into()) << 5)
            | (bit_cast::<8, 1>(self.kicker.dropped.val().into()) << 6)
            | (bit_cast::<8, 1>(self.kicker.is_full.val().into()) << 7);
        self.registers.kicker_status.next = self.kicker_status.val();
    }
}
