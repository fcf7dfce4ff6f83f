//! The table itself.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "constants that fit their field"
)]

use super::fields::{BLOCK_FIELDS, BLOCKS_VALUE, FAULT_FIELDS, INTERRUPT_FIELDS, STATUS_FIELDS, bit, bits};
use super::{Access, Field, Group, Kind, Register, Target, VERSION, Value};
use crate::AXES;
use crate::control::{CONFIGURATION_WORDS, SET_POINT_WORDS};
use crate::format::Format;
use crate::imu_spi::SNAPSHOT_IMU_WORDS;
use crate::safety::{ARM_FIRST, ARM_SECOND};
use crate::word::WORD_BITS;

/// First word of every identification: "RAC4".
pub const COOKIE_VALUE: u32 = u32::from_be_bytes(*b"RAC4");
/// Nominal frequency of the 4I65's local bus clock in hertz.
pub const NOMINAL_CLOCK_HZ: u32 = 33_333_333;
/// The card that the design was made for.
pub const BOARD_4I65: Target = Target {
    word: u32::from_be_bytes(*b"4I65"),
    clock_hz: NOMINAL_CLOCK_HZ,
    text: "Mesa 4I65 (XC2S200), clocked by its PCI bridge",
};
/// The same core on an open board.
pub const BOARD_HX8K: Target = Target {
    word: u32::from_be_bytes(*b"HX8K"),
    clock_hz: 33_000_000,
    text: "Lattice iCE40-HX8K breakout board, clocked by its PLL",
};
/// Every board that a top module is written for.
pub const BOARDS: [Target; 2] = [BOARD_4I65, BOARD_HX8K];
/// Shortest control period in clocks; a shorter one in [`TICK_PERIOD`] acts as this.
pub const MIN_TICK_PERIOD: u32 = 1_000;
/// Reset value of [`TICK_PERIOD`]: 1 kHz at the nominal clock.
pub const DEFAULT_TICK_PERIOD: u32 = 33_333;
/// Reset value of [`WATCHDOG_TIMEOUT`]: 50 ms at the nominal clock.
pub const DEFAULT_WATCHDOG_TIMEOUT: u32 = 1_666_667;
/// Reset value of [`SET_POINT_TIMEOUT`]: 30 ms at the nominal clock and period.
pub const DEFAULT_SET_POINT_TIMEOUT: u32 = 30;
/// Reset value of [`STALL_WINDOW`]: 0.2 s at the nominal clock and period.
pub const DEFAULT_STALL_WINDOW: u32 = 200;
/// Word of [`KICKER_FIRE`] that fires: "KICK". Any other value does nothing.
pub const KICKER_FIRE_WORD: u32 = u32::from_be_bytes(*b"KICK");
/// Words of a snapshot, the two sequence numbers included.
pub const SNAPSHOT_WORDS: usize = 24;
/// Words of a snapshot with those of the inertial sensor, which stand after the second sequence number.
pub const SNAPSHOT_WORDS_WITH_IMU: usize = SNAPSHOT_WORDS + SNAPSHOT_IMU_WORDS;

const fn register(
    name: &'static str,
    offset: u16,
    access: Access,
    kind: Kind,
    reset: u32,
    text: &'static str,
) -> Register {
    Register { name, offset, words: 1, access, kind, reset, live: 0, values: &[], groups: &[], zero: "", text }
}

const fn array(
    name: &'static str,
    offset: u16,
    words: usize,
    access: Access,
    kind: Kind,
    text: &'static str,
) -> Register {
    Register { words: words as u16, ..register(name, offset, access, kind, 0, text) }
}

const fn value(name: &'static str, word: u32, text: &'static str) -> Value {
    Value { name, word, text }
}

/// One word per axis of an array.
const fn per_axis(name: &'static str, group: usize, format: Format, unit: &'static str, text: &'static str) -> Group {
    Group { name, first: group * AXES, words: AXES, format, unit, text }
}

const WORD: Kind = Kind::Fixed(Format::new("word", WORD_BITS, 0));
const SPEED: Kind = Kind::Fixed(Format::SPEED);
const DUTY: Kind = Kind::Fixed(Format::DUTY);

/// Identifies the design.
pub const COOKIE: Register =
    register("cookie", 0x000, Access::ReadOnly, Kind::Text, COOKIE_VALUE, "\"RAC4\": this is the design");
/// Major and minor number of this map, 16 bits each.
pub const MAP_VERSION: Register = register(
    "map_version",
    0x004,
    Access::ReadOnly,
    Kind::Unsigned(32),
    VERSION,
    "version of this map, major in bits 31:16",
);
/// Board name.
pub const BOARD: Register = register(
    "board",
    0x008,
    Access::ReadOnly,
    Kind::Text,
    BOARD_4I65.word,
    "board whose pins the bitstream drives; a 5I20 has the same FPGA as a 4I65 on other pins",
)
.values(&[value("4I65", BOARD_4I65.word, BOARD_4I65.text), value("HX8K", BOARD_HX8K.word, BOARD_HX8K.text)]);
/// Nominal clock.
pub const CLOCK_HZ: Register = register(
    "clock_hz",
    0x00C,
    Access::ReadOnly,
    Kind::Unsigned(32),
    NOMINAL_CLOCK_HZ,
    "nominal clock of that board in Hz, 33000000 on the HX8K; the real one is measured with `time`",
);
/// CRC-32 of the Verilog that the bitstream was made from.
pub const CONTENT_HASH: Register = register(
    "content_hash",
    0x010,
    Access::ReadOnly,
    Kind::Unsigned(32),
    0,
    "hash of the emitted Verilog with this constant zeroed; the reset value is the one in `rac4i65.v`",
);
/// How many axes were built in.
pub const AXIS_COUNT: Register =
    register("axis_count", 0x014, Access::ReadOnly, Kind::Unsigned(8), AXES as u32, "axes of the core");
/// Free-running time.
pub const TIME: Register =
    register("time", 0x018, Access::ReadOnly, Kind::Unsigned(32), 0, "clocks since configuration, wrapping")
        .starts(0, u32::MAX);

/// Block list.
pub const BLOCKS: Register = register(
    "blocks",
    0x01C,
    Access::ReadOnly,
    Kind::Fields(&BLOCK_FIELDS),
    BLOCKS_VALUE,
    "block list: what the design holds, and how many of each",
);

/// Control period.
pub const TICK_PERIOD: Register = register(
    "tick_period",
    0x020,
    Access::LockedWhileArmed,
    Kind::Unsigned(24),
    DEFAULT_TICK_PERIOD,
    "control period in clocks, at least 1000",
)
.zero("acts as 1000, like everything below");
/// Modes of all axes; each bit has a name of its own.
pub const MODE: Register = register(
    "mode",
    0x024,
    Access::LockedWhileArmed,
    Kind::Fields(&[MODE_COUNT_AND_TIME, MODE_TWIST, MODE_ODOMETRY, MODE_UP_DOWN]),
    0,
    "speed measurement, kind of set points, odometry, kind of PWM",
);
/// Speed by count and time.
pub const MODE_COUNT_AND_TIME: Field =
    bit("count-and-time", 0, "1: speed by count and time (M/T); 0: count difference per tick");
/// Set points are a body velocity.
pub const MODE_TWIST: Field =
    bit("twist", 1, "1: set points are a body velocity, inverse kinematics in gateware; 0: wheel speeds");
/// Set: the card keeps a pose from the counts.
pub const MODE_ODOMETRY: Field =
    bit("odometry", 2, "1: a pose is kept from the encoders at every tick; 0: bypassed, the pose is zero");
/// Kind of PWM.
pub const MODE_UP_DOWN: Field =
    bit("up-down", 3, "1: PWM pin pulses forward, DIR pin backward, never both; 0: magnitude on PWM, sign on DIR");
/// Clocks for which a line must differ before it counts.
pub const ENCODER_FILTER: Register = register(
    "encoder_filter",
    0x028,
    Access::LockedWhileArmed,
    Kind::Unsigned(4),
    3,
    "an encoder line must be stable for so many clocks and one more",
)
.zero("a line counts from the first clock on");
/// Clocks of a PWM period, 13 bits; 0 switches the outputs off.
pub const PWM_PERIOD: Register =
    register("pwm_period", 0x02C, Access::LockedWhileArmed, Kind::Unsigned(13), 0, "PWM period in clocks")
        .zero("off: no pulse whatever the duty");
/// Clocks for which PWM stays low around a change of direction.
pub const PWM_BLANKING: Register = register(
    "pwm_blanking",
    0x030,
    Access::LockedWhileArmed,
    Kind::Unsigned(10),
    33,
    "clocks with PWM low before and after a change of DIR",
)
.zero("no blanking");
/// Clocks without a commit after which the card disarms.
pub const WATCHDOG_TIMEOUT: Register = register(
    "watchdog_timeout",
    0x034,
    Access::LockedWhileArmed,
    Kind::Unsigned(24),
    DEFAULT_WATCHDOG_TIMEOUT,
    "clocks without a valid set-point commit until the outputs go off",
)
.zero("always bitten: the card cannot be armed");
/// Takes the two words that arm, in order; any other disarms.
pub const ARM: Register = register("arm", 0x038, Access::WriteOnly, Kind::Text, 0, ARMING).values(&[
    value("first", ARM_FIRST, "\"ARM1\": disarms and begins the sequence"),
    value("second", ARM_SECOND, "\"ARM2\": arms, as the next write to this register after the first word"),
]);
/// The rule of arming in one sentence.
pub const ARMING: &str = "the first word and then, as the next write to this register, the second arm the card, if \
     from the one to the other no cause of watchdog, emergency-stop, encoder, external or stall stands; bits \
     of `faults` whose cause is gone do not matter, nor do commit and arm-refused; any other word disarms at once";
/// Sticky causes of disarming, a bit each, cleared by ones.
pub const FAULTS: Register = register(
    "faults",
    0x03C,
    Access::WriteOneToClear,
    Kind::Fields(&FAULT_FIELDS),
    0,
    "sticky faults; a fault whose cause stands comes back at once: encoder until `encoder_error` is cleared, stall \
     until `stall` is, watchdog until a commit of set points; after configuration those that power-up is",
)
.starts(0x13, 0);
/// Of the sticky faults those that came first since the last clear.
pub const FIRST_FAULT: Register = register(
    "first_fault",
    0x040,
    Access::ReadOnly,
    Kind::Fields(&FAULT_FIELDS),
    0,
    "the fault that came first of those not cleared since; two bits where two came in one clock",
)
.starts(0x03, 0);
/// Live: armed, set points in force, pins, commits pending.
pub const STATUS: Register =
    register("status", 0x044, Access::ReadOnly, Kind::Fields(&STATUS_FIELDS), 0, "live state").starts(0x0C, 0x0C);
/// Takes the checksum of the staged set points; they act at the next tick.
pub const COMMIT_SET_POINTS: Register = register(
    "commit_set_points",
    0x048,
    Access::WriteOnly,
    Kind::Unsigned(32),
    0,
    "checksum over the staged set points; a right one restarts the watchdog's time",
);
/// Takes the checksum of the staged configuration; it acts at the next tick.
pub const COMMIT_CONFIGURATION: Register = register(
    "commit_configuration",
    0x04C,
    Access::WriteOnly,
    Kind::Unsigned(32),
    0,
    "checksum over the staged configuration",
);
/// Commit counters.
pub const COMMITS: Register = register(
    "commits",
    0x050,
    Access::ReadOnly,
    Kind::Fields(&[COMMITS_ACCEPTED, COMMITS_REJECTED]),
    0,
    "commits since configuration, wrapping",
);
/// Commits with the right checksum, 16 bits, wrapping.
pub const COMMITS_ACCEPTED: Field = bits("accepted", 0, 16, "commits with the right checksum and number of words");
/// Commits with a wrong checksum, 16 bits, wrapping.
pub const COMMITS_REJECTED: Field = bits("rejected", 16, 16, "commits that changed nothing");
/// Axes that saw an impossible transition, a sticky bit each.
pub const ENCODER_ERROR: Register = register(
    "encoder_error",
    0x054,
    Access::WriteOneToClear,
    Kind::Unsigned(AXES as u32),
    0,
    "per axis: both lines changed at once",
);
/// Levels of A, B and index of every axis, filtered.
pub const ENCODER_LINES: Register = register(
    "encoder_lines",
    0x058,
    Access::ReadOnly,
    Kind::Unsigned(3 * AXES as u32),
    0,
    "filtered lines, A of axis i in bit 2i, B in bit 2i + 1, index in bit 8 + i",
)
.starts(0xFFF, 0xFFF);
/// Which encoder errors disarm.
pub const ENCODER_FAULT_MASK: Register = register(
    "encoder_fault_mask",
    0x05C,
    Access::LockedWhileArmed,
    Kind::Unsigned(AXES as u32),
    0xF,
    "axes whose encoder error disarms",
);

/// Charging, firing at the ball, holding the charge.
pub const KICKER_CONTROL: Register = register(
    "kicker_control",
    0x060,
    Access::ReadWrite,
    Kind::Fields(&[KICKER_CHARGE, KICKER_ARM_ON_BALL, KICKER_HOLD, KICKER_BY_TIME]),
    0,
    "charging, discharging and automatic trigger",
);
/// Charge request.
pub const KICKER_CHARGE: Field = bit("charge", 0, "charge the capacitor, until the time-out");
/// Trigger on the ball sensor.
pub const KICKER_ARM_ON_BALL: Field = bit(
    "arm-on-ball",
    1,
    "fire once when the ball sensor sees the ball; it must rise while armed: set before, or after its shot, it must be \
     cleared and set again; `kicker_status` shows whether it will fire",
);
/// Keep the charge while disarmed.
pub const KICKER_HOLD: Field =
    bit("hold", 2, "keep the charge while disarmed; an emergency stop or a dead clock discharges all the same");
/// Charge without the input for a full capacitor.
pub const KICKER_BY_TIME: Field =
    bit("by-time", 3, "1: charge until the time-out whatever `kicker_full` says; 0: stop charging while it is high");
/// Fires when its one word is written.
pub const KICKER_FIRE: Register =
    register("kicker_fire", 0x064, Access::WriteOnly, Kind::Text, 0, "fires, when armed and not locked out")
        .values(&[value("fire", KICKER_FIRE_WORD, "\"KICK\": fires; any other word does nothing")]);
/// Length of the trigger pulse, µs, 14 bits.
pub const KICKER_PULSE: Register = register(
    "kicker_pulse",
    0x068,
    Access::ReadWrite,
    Kind::Unsigned(14),
    0,
    "trigger pulse in microseconds; longer than 10000 acts as 10000",
)
.zero("never fires");
/// Kicker lock-out.
pub const KICKER_LOCKOUT: Register = register(
    "kicker_lockout",
    0x06C,
    Access::LockedWhileArmed,
    Kind::Unsigned(20),
    0,
    "microseconds after a pulse in which none can follow; less than 100000 acts as 100000",
)
.zero("100 ms, the minimum");
/// Charge time-out.
pub const KICKER_CHARGE_TIMEOUT: Register = register(
    "kicker_charge_timeout",
    0x070,
    Access::LockedWhileArmed,
    Kind::Unsigned(24),
    0,
    "microseconds of charging, together, after which it stops until the capacitor is full, a pulse, or the card is \
     disarmed: a request that is taken back and made again gains no time",
)
.zero("never charges");
/// State of the kicker, and what was dropped or timed out.
pub const KICKER_STATUS: Register = register(
    "kicker_status",
    0x074,
    Access::ReadOnly,
    Kind::Fields(&[KICKER_STATE, KICKER_ON_BALL, KICKER_READY, KICKER_TIMED_OUT, KICKER_DROPPED, KICKER_FULL]),
    0,
    "state of the kicker; a write of anything but 0 to `faults` clears charge-timed-out and fire-dropped",
)
.starts(0x80, 0x80);
/// Kicker state machine.
pub const KICKER_STATE: Field = bits(
    "state",
    0,
    3,
    "0 off (disarmed), 1 ready, 2 pending (charging is off, its gap runs), 3 pulse, 4 commutation, 5 lock-out",
);
/// The ball trigger has a shot.
pub const KICKER_ON_BALL: Field =
    bit("on-ball", 3, "the next ball fires: arm-on-ball rose while armed and has its shot");
/// Set: a request to fire would be taken.
pub const KICKER_READY: Field = bit("ready", 4, "a fire request would be taken");
/// Charging stopped by its time-out.
pub const KICKER_TIMED_OUT: Field =
    bit("charge-timed-out", 5, "charging used up its time-out; stays while that stops the charger");
/// A fire request was dropped.
pub const KICKER_DROPPED: Field = bit("fire-dropped", 6, "a fire request came while disarmed or locked out");
/// The capacitor is full.
pub const KICKER_FULL: Field = bit("full", 7, "the filtered input for a full capacitor; high or open = full");
/// What the time base counts as a microsecond, 25 to 34.
pub const CLOCKS_PER_MICROSECOND: Register = register(
    "clocks_per_us",
    0x078,
    Access::LockedWhileArmed,
    Kind::Unsigned(6),
    33,
    "clocks in what the kicker takes for a microsecond; below 25 acts as 25, above 34 as 34",
);
/// Eight LEDs of the card, a bit each.
pub const LEDS: Register = register("leds", 0x07C, Access::ReadWrite, Kind::Unsigned(8), 0, "the eight LEDs, 1 = on");

/// Time-out of set points.
pub const SET_POINT_TIMEOUT: Register = register(
    "set_point_timeout",
    0x080,
    Access::LockedWhileArmed,
    Kind::Unsigned(16),
    DEFAULT_SET_POINT_TIMEOUT,
    "control ticks after which a set point is zero until the next commit; the watchdog disarms later",
)
.zero("no set point ever counts: the wheels are held at zero speed");
/// Control ticks in which a driven wheel must move.
pub const STALL_WINDOW: Register = register(
    "stall_window",
    0x084,
    Access::LockedWhileArmed,
    Kind::Unsigned(16),
    DEFAULT_STALL_WINDOW,
    "control ticks in which a driven wheel must move 4 counts net",
)
.zero("acts as 1: every tick is a window");
/// Drive from which on a wheel must move.
pub const STALL_COMPARE: Register = register(
    "stall_compare",
    0x088,
    Access::LockedWhileArmed,
    Kind::Unsigned(13),
    0,
    "PWM clocks above which a wheel counts as driven; 8191 switches the stall detection off",
)
.zero("any pulse at all counts as driven");
/// Stalled axes.
pub const STALL: Register = register(
    "stall",
    0x08C,
    Access::WriteOneToClear,
    Kind::Unsigned(AXES as u32),
    0,
    "per axis: driven through a whole window without net counts; a broken wire, or a blocked wheel",
);
/// Index capture.
pub const INDEX_ARM: Register = register(
    "index_arm",
    0x090,
    Access::WriteOnly,
    Kind::Fields(&[INDEX_ARM_LATCH, INDEX_ARM_CLEAR]),
    0,
    "axes whose next index is captured, and how; all others are left alone",
);
/// Axes to capture at the next index.
pub const INDEX_ARM_LATCH: Field =
    bits("latch", 0, AXES as u32, "per axis: latch the position at the next rising index");
/// Axes to zero at the next index.
pub const INDEX_ARM_CLEAR: Field =
    bits("clear", 4, AXES as u32, "per axis with its latch bit: counts begin at zero there");
/// State of the index capture.
pub const INDEX_STATUS: Register = register(
    "index_status",
    0x094,
    Access::ReadOnly,
    Kind::Fields(&[INDEX_WAITING, INDEX_SEEN]),
    0,
    "state of the index capture",
);
/// Axes that wait for an index.
pub const INDEX_WAITING: Field = bits("waiting", 0, AXES as u32, "per axis: armed, no index yet");
/// Axes that saw one.
pub const INDEX_SEEN: Field =
    bits("seen", 4, AXES as u32, "per axis: captured; `index_position` is there after the next control tick");
/// Causes that may pull the interrupt line.
pub const INTERRUPT_ENABLE: Register = register(
    "interrupt_enable",
    0x098,
    Access::ReadWrite,
    Kind::Fields(&INTERRUPT_FIELDS),
    0,
    "causes that pull INT# low; none after configuration",
);
/// Interrupt causes.
pub const INTERRUPT_STATUS: Register = register(
    "interrupt_status",
    0x09C,
    Access::WriteOneToClear,
    Kind::Fields(&INTERRUPT_FIELDS),
    0,
    "causes since they were cleared, enabled or not; INT# is low while an enabled one is set",
)
.starts(0, 1);

/// Radio link.
pub const RADIO: Register = register(
    "radio",
    0x0A0,
    Access::LockedWhileArmed,
    Kind::Fields(&[RADIO_SELECT, RADIO_ACCEPTED, RADIO_DROPPED]),
    0,
    "who commands, and counters of the link, which cannot be written and wrap",
)
.starts(0, 0x00FF_FF01);
/// The radio commands.
pub const RADIO_SELECT: Field = bit(
    "select",
    0,
    "1: commands come in the radio's frames, and a host's writes reach only `arm` and this register; 0: from the host; \
     after configuration 1 where the strap `host_select` is low",
);
/// Frames taken.
pub const RADIO_ACCEPTED: Field = bits("accepted", 8, 8, "frames that were whole and new, whoever commands");
/// Frames dropped.
pub const RADIO_DROPPED: Field = bits(
    "dropped",
    16,
    8,
    "frames with a wrong CRC, length or version, cut short, run over, or repeated; not those for other robots",
);

/// Reading of the inertial sensor.
pub const IMU_CONTROL: Register = register(
    "imu_control",
    0x0A4,
    Access::LockedWhileArmed,
    Kind::Fields(&[IMU_ENABLE, IMU_MODE_3, IMU_HALF, IMU_FIRST]),
    0,
    "how the inertial sensor is read; the count of bytes is 14, most significant bit first, and what they mean is the \
     driver's table of sensors",
);
/// Read at every tick.
pub const IMU_ENABLE: Field = bit(
    "enable",
    0,
    "1: read 14 bytes from register `first` on at every control tick; 0: the line is quiet but for `imu_access`",
);
/// SPI mode.
pub const IMU_MODE_3: Field = bit("mode-3", 1, "SPI mode, 1: mode 3, the clock rests high; 0: mode 0, it rests low");
/// Half a period of the line's clock.
pub const IMU_HALF: Field = bits(
    "half",
    2,
    2,
    "half a period of the line's clock in clocks, less one: 0 to 3 are 16.7, 8.3, 5.6, 4.2 MHz at the nominal clock",
);
/// First register of a burst.
pub const IMU_FIRST: Field = bits("first", 4, 7, "first register of the 14 bytes; the read flag is put before it");
/// One access to a register of the sensor.
pub const IMU_ACCESS: Register = register(
    "imu_access",
    0x0A8,
    Access::WriteOnly,
    Kind::Fields(&[IMU_DATA, IMU_REGISTER, IMU_READ]),
    0,
    "16 bits to the inertial sensor, highest first, at most 136 clocks; nothing is sent while `imu_control` enables \
     reading or an access is on its way",
);
/// Data of an access.
pub const IMU_DATA: Field = bits("data", 0, 8, "byte for the register; any value for a read");
/// Register of an access.
pub const IMU_REGISTER: Field = bits("register", 8, 7, "register of the sensor");
/// Direction of an access.
pub const IMU_READ: Field = bit("read", 15, "1: read; 0: write");
/// State of the line to the sensor.
pub const IMU_STATUS: Register = register(
    "imu_status",
    0x0AC,
    Access::ReadOnly,
    Kind::Fields(&[IMU_VALUE, IMU_BUSY]),
    0,
    "answer to the last access; ff where no sensor answers, since the line is pulled up",
)
.starts(0, 0x1FF);
/// Byte that the sensor sent.
pub const IMU_VALUE: Field = bits("value", 0, 8, "the last 8 bits from the sensor, whole when `busy` is 0");
/// The line is busy.
pub const IMU_BUSY: Field = bit("busy", 8, "an access or a burst is on its way");

/// Staged configuration.
pub const CONFIGURATION: Register = array(
    "configuration",
    0x400,
    CONFIGURATION_WORDS,
    Access::Staged,
    WORD,
    "staged configuration bank: thirteen groups of one word per axis",
)
.groups(&CONFIGURATION_GROUPS);
/// Configuration in force.
pub const ACTIVE_CONFIGURATION: Register =
    array("active_configuration", 0x500, CONFIGURATION_WORDS, Access::ReadOnly, WORD, "configuration in force")
        .groups(&CONFIGURATION_GROUPS);
/// The words of a configuration bank; the twin is [`crate::control::Configuration::to_words`].
pub const CONFIGURATION_GROUPS: [Group; 13] = [
    per_axis("inverse_x", 0, Format::COEFFICIENT, "speed LSB per LSB of velocity x", INVERSE),
    per_axis("inverse_y", 1, Format::COEFFICIENT, "speed LSB per LSB of velocity y", INVERSE),
    per_axis("inverse_omega", 2, Format::COEFFICIENT, "speed LSB per LSB of rotation", INVERSE),
    per_axis("direct_x", 3, Format::DISPLACEMENT, "2 LSB of pose x per count", DIRECT),
    per_axis("direct_y", 4, Format::DISPLACEMENT, "2 LSB of pose y per count", DIRECT),
    per_axis("direct_heading", 5, Format::DISPLACEMENT, "2^-32 turn per count, of half the turn", DIRECT),
    per_axis("kp", 6, Format::PROPORTIONAL, "duty LSB per speed LSB", "proportional gain of the speed loop"),
    per_axis("ki", 7, Format::INTEGRAL, "duty LSB per speed LSB and tick", "integral gain times the control period"),
    per_axis("lower", 8, Format::DUTY, "1 = full drive", "smallest duty, at least -1"),
    per_axis("upper", 9, Format::DUTY, "1 = full drive", "largest duty, at most 1"),
    per_axis("kff", 10, Format::FEED_FORWARD, "duty LSB per speed LSB", "feed-forward of the speed set point"),
    per_axis(
        "fall",
        11,
        Format::SPEED,
        "counts per clock and tick",
        "largest step down of the set point, negative or 0",
    ),
    per_axis(
        "rise",
        12,
        Format::SPEED,
        "counts per clock and tick",
        "largest step up of the set point; both 0 hold it",
    ),
];
const INVERSE: &str = "inverse kinematics: set point of the axis = sum over x, y, rotation";
const DIRECT: &str = "odometry: displacement of the body in its own frame, sum over the axes";
/// Staged set points.
pub const SET_POINTS: Register = array(
    "set_points",
    0x600,
    SET_POINT_WORDS,
    Access::Staged,
    WORD,
    "staged set points: as `mode` says a wheel speed per axis in counts per clock, LSB 2^-32, or body velocity x, y, \
     rotation in units of the inverse matrix, and a spare",
);
/// Set points in force.
pub const ACTIVE_SET_POINTS: Register =
    array("active_set_points", 0x640, SET_POINT_WORDS, Access::ReadOnly, WORD, "set points in force");
/// Counts at the last captured index of every axis.
pub const INDEX_POSITION: Register = array(
    "index_position",
    0x770,
    AXES,
    Access::ReadOnly,
    Kind::Unsigned(32),
    "counts at the last captured index, in the frame before it was cleared, two's complement",
);
/// State of the integral parts, one an axis.
pub const INTEGRALS: Register =
    array("integrals", 0x790, AXES, Access::ReadOnly, DUTY, "integrators of the speed loops; not part of a snapshot");
/// Snapshot: sequence number.
pub const SNAPSHOT_SEQUENCE: Register = array(
    "snapshot_sequence",
    0x800,
    1,
    Access::ReadOnly,
    Kind::Unsigned(32),
    "number of the control tick that finished last, at most a period and 1000 clocks old; reading it latches the \
     snapshot, so that all its words are of this tick until the last one is read",
)
.starts(0, u32::MAX);
/// [`STATUS`] as it was at the tick.
pub const SNAPSHOT_STATUS: Register = array(
    "snapshot_status",
    0x804,
    1,
    Access::ReadOnly,
    Kind::Fields(&STATUS_FIELDS),
    "`status` at the tick, without what is pending",
)
.starts(0, 0x0C);
/// Clocks since configuration at the tick, low 24 bits.
pub const SNAPSHOT_TIME: Register =
    array("snapshot_time", 0x808, 1, Access::ReadOnly, Kind::Unsigned(24), "low 24 bits of `time` at the tick")
        .starts(0, 0xFF_FFFF);
/// [`FAULTS`] as it was at the tick.
pub const SNAPSHOT_FAULTS: Register =
    array("snapshot_faults", 0x80C, 1, Access::ReadOnly, Kind::Fields(&FAULT_FIELDS), "`faults` at the tick")
        .starts(0, 0x7F);
/// Position of every axis at the tick, counts, 32 bits, wrapping.
pub const SNAPSHOT_COUNT: Register = array(
    "snapshot_count",
    0x810,
    AXES,
    Access::ReadOnly,
    Kind::Unsigned(32),
    "encoder counts, wrapping two's complement",
);
/// Measured speed of each axis at the tick.
pub const SNAPSHOT_SPEED: Register =
    array("snapshot_speed", 0x820, AXES, Access::ReadOnly, SPEED, "measured speed in counts per clock");
/// Speed set point of each axis in force at the tick.
pub const SNAPSHOT_REFERENCE: Register =
    array("snapshot_reference", 0x830, AXES, Access::ReadOnly, SPEED, "speed set point in force in counts per clock");
/// Duty of each axis, as computed at the tick.
pub const SNAPSHOT_DUTY: Register = array("snapshot_duty", 0x840, AXES, Access::ReadOnly, DUTY, "duty, 1 = full drive");
/// x, y and heading by odometry at the tick.
pub const SNAPSHOT_POSE: Register = array(
    "snapshot_pose",
    0x850,
    3,
    Access::ReadOnly,
    Kind::Unsigned(32),
    "pose x, y in the driver's unit, heading in 2^-32 turn; two's complement, wrapping",
);
/// Snapshot: sequence number again.
pub const SNAPSHOT_SEQUENCE_END: Register = array(
    "snapshot_sequence_end",
    0x85C,
    1,
    Access::ReadOnly,
    Kind::Unsigned(32),
    "equals `snapshot_sequence` in a coherent snapshot; reading it releases the latch",
)
.starts(0, u32::MAX);
/// Snapshot: inertial sensor.
pub const SNAPSHOT_IMU: Register = array(
    "snapshot_imu",
    0x860,
    SNAPSHOT_IMU_WORDS,
    Access::ReadOnly,
    Kind::Unsigned(16),
    "reading of the inertial sensor that began with the tick, to be read before `snapshot_sequence_end`: first the clocks \
     from the last rise of the data-ready line to the tick, 65535 where none came within 65534 or reading is off, when \
     the other words mean nothing; then seven words of two bytes, the first byte in bits 15:8",
)
.starts(0, 0xFFFF);

/// All registers, by offset.
pub const REGISTERS: &[&Register] = &[
    &COOKIE,
    &MAP_VERSION,
    &BOARD,
    &CLOCK_HZ,
    &CONTENT_HASH,
    &AXIS_COUNT,
    &TIME,
    &BLOCKS,
    &TICK_PERIOD,
    &MODE,
    &ENCODER_FILTER,
    &PWM_PERIOD,
    &PWM_BLANKING,
    &WATCHDOG_TIMEOUT,
    &ARM,
    &FAULTS,
    &FIRST_FAULT,
    &STATUS,
    &COMMIT_SET_POINTS,
    &COMMIT_CONFIGURATION,
    &COMMITS,
    &ENCODER_ERROR,
    &ENCODER_LINES,
    &ENCODER_FAULT_MASK,
    &KICKER_CONTROL,
    &KICKER_FIRE,
    &KICKER_PULSE,
    &KICKER_LOCKOUT,
    &KICKER_CHARGE_TIMEOUT,
    &KICKER_STATUS,
    &CLOCKS_PER_MICROSECOND,
    &LEDS,
    &SET_POINT_TIMEOUT,
    &STALL_WINDOW,
    &STALL_COMPARE,
    &STALL,
    &INDEX_ARM,
    &INDEX_STATUS,
    &INTERRUPT_ENABLE,
    &INTERRUPT_STATUS,
    &RADIO,
    &IMU_CONTROL,
    &IMU_ACCESS,
    &IMU_STATUS,
    &CONFIGURATION,
    &ACTIVE_CONFIGURATION,
    &SET_POINTS,
    &ACTIVE_SET_POINTS,
    &INDEX_POSITION,
    &INTEGRALS,
    &SNAPSHOT_SEQUENCE,
    &SNAPSHOT_STATUS,
    &SNAPSHOT_TIME,
    &SNAPSHOT_FAULTS,
    &SNAPSHOT_COUNT,
    &SNAPSHOT_SPEED,
    &SNAPSHOT_REFERENCE,
    &SNAPSHOT_DUTY,
    &SNAPSHOT_POSE,
    &SNAPSHOT_SEQUENCE_END,
    &SNAPSHOT_IMU,
];
