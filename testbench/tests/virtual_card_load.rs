//! Loading over the virtual card: what goes well, what goes wrong, and what is said then.

use driver::bitstream::{BYTES, Bitstream, Fault, Order};
use driver::load::{LoadError, Loaded, Options, inspect, load};
use driver::pci::Bar;
use driver::{Board, PciCard, PciError, RegisterWindow, Scale, Settings};
use fixed_kin::registers::{BOARD, CONTENT_HASH};
use hdl::design::COMMITTED_BITSTREAM;
use runs::frames::Twist;
use runs::robot::Robot;
use simulator::circuit::committed;
use simulator::fpga::FpgaError;
use simulator::virtual_card::{BitTrueLive, Eeprom, Faults, Live, Machine, VirtualCard};
use std::time::Duration;
use testbench::blinker::silent;

fn card() -> VirtualCard {
    VirtualCard::new(&Robot::racbot()).unwrap()
}

fn bitstream() -> Bitstream {
    committed()
}

/// The committed file without its header.
fn stream() -> &'static [u8] {
    &COMMITTED_BITSTREAM[COMMITTED_BITSTREAM.len() - BYTES..]
}

fn try_load(card: &mut VirtualCard) -> Result<Loaded, LoadError> {
    load(card, &bitstream(), &Options::default(), |_| {})
}

/// Fails, leaves every output off, and says this.
#[track_caller]
fn refused(faults: Faults, says: &[&str]) -> LoadError {
    let mut card = card();
    card.faults = faults;
    let error = try_load(&mut card).unwrap_err();
    assert!(!card.configured(), "the FPGA runs after: {error}");
    for part in says {
        assert!(error.to_string().contains(part), "no {part:?} in {error}");
    }
    // Once the fault is gone the card loads again.
    card.faults = Faults::default();
    try_load(&mut card).unwrap();
    error
}

#[test]
fn a_good_card_loads_and_a_right_design_is_kept() {
    let mut card = card();
    let loaded = try_load(&mut card).unwrap();
    assert!(!loaded.kept && loaded.tries == 1 && loaded.ready_enabled == 0);
    assert_eq!(loaded.identity.content_hash, hdl::design::content_hash());
    assert!((loaded.clock_hz / 33_333_333.0 - 1.0).abs() < 1e-4, "{}", loaded.clock_hz);
    // One 8-bit store a byte, and nothing between them: the time is that of the stores.
    // The last dummy bytes already reach the design, which takes a bus cycle each.
    let stores = 166_980 * Duration::from_nanos(300);
    assert!(loaded.transfer >= stores && loaded.transfer < stores + Duration::from_micros(10));
    let accesses = card.accesses();
    assert!(try_load(&mut card).unwrap().kept);
    assert!(card.accesses() - accesses < 100);
    let again = load(&mut card, &bitstream(), &Options { force: true, ..Options::default() }, |_| {}).unwrap();
    assert!(!again.kept);
}

#[test]
fn the_robot_behind_a_loaded_card_drives_and_the_watchdog_stops_it() {
    let mut card = card();
    let clock_hz = try_load(&mut card).unwrap().clock_hz;
    let scale = Scale::new(&Robot::racbot(), clock_hz).unwrap();
    let mut board = Board::new(RegisterWindow::new(card));
    board.configure(&scale, &Settings::default()).unwrap();
    board.bus.card.sleep(Duration::from_millis(2));
    board.arm().unwrap();
    for _ in 0..400 {
        board.set_twist(&scale, Twist { vx: 0.0, vy: 0.5, omega: 0.0 }).unwrap();
        board.bus.card.sleep(Duration::from_millis(1));
        assert!(board.snapshot().unwrap().status.armed);
    }
    let twist = board.bus.card.machine().plant().twist();
    assert!((twist.vy - 0.5).abs() < 0.05 && twist.vx.abs() < 0.02, "{twist:?}");
    board.bus.card.sleep(Duration::from_millis(49));
    assert!(board.status().unwrap().armed);
    board.bus.card.sleep(Duration::from_millis(3));
    assert!(!board.status().unwrap().armed, "the watchdog sleeps");
    // Shorted motors brake with a time constant of 3.5 s.
    board.bus.card.sleep(Duration::from_secs(20));
    assert!(board.bus.card.machine().plant().twist().vy.abs() < 0.02);
    assert!(board.set_twist(&scale, Twist { vx: 0.0, vy: 0.5, omega: 0.0 }).is_ok());
    board.bus.card.sleep(Duration::from_millis(20));
    assert!(!board.status().unwrap().armed, "a set point alone must not arm");
    // A reload in motion: the wheels' positions are nobody's error.
    let mut card = board.bus.into_card();
    let force = Options { force: true, ..Options::default() };
    load(&mut card, &bitstream(), &force, |_| {}).unwrap();
    card.sleep(Duration::from_millis(20));
    assert_eq!(card.failure(), None);
}

#[test]
fn another_clock_is_measured() {
    for clock_hz in [25.0e6, 33.0e6, 2.0e6] {
        let mut card = card().with_clock(clock_hz);
        let measured = try_load(&mut card).unwrap().clock_hz;
        assert!((measured / clock_hz - 1.0).abs() < 1e-4, "{measured} for {clock_hz}");
    }
}

#[test]
fn ready_is_switched_on_where_the_eeprom_leaves_it_off() {
    let mut card = card().with_eeprom(Eeprom { ready_enabled: false });
    assert_eq!(inspect(&mut card).unwrap().ready_enabled, [false; 4]);
    assert_eq!(try_load(&mut card).unwrap().ready_enabled, 4);
}

#[test]
fn a_foreign_design_is_called_what_it_is() {
    let file = silent("blinker.ncd");
    let foreign = Bitstream::parse(&file).unwrap();
    let mut card = card();
    let error = load(&mut card, &foreign, &Options::default(), |_| {}).unwrap_err();
    let message = error.to_string();
    assert!(matches!(error.cause(), LoadError::Foreign { .. }) && !message.contains("gone"), "{message}");
    for part in ["blinker.ncd", "another design", "tries: 1", "outputs off"] {
        assert!(message.contains(part), "no {part:?} in {message}");
    }
    assert!(!card.configured());
    // One that was there before is called so as well.
    let mut card = card_with(&file);
    let state = inspect(&mut card).unwrap();
    assert!(state.done && state.identity.is_none());
    assert!(state.other.unwrap().contains("another design"));
    // A card that is gone still is.
    card.faults = Faults { absent: true, ..Faults::default() };
    assert!(inspect(&mut card).unwrap_err().to_string().contains("does not answer"));
    card.faults = Faults::default();
    try_load(&mut card).unwrap();
}

#[test]
fn a_design_that_makes_no_circuit_is_said_to_be_so() {
    let broken = || card().with_fabric(Box::new(|_| Err(FpgaError::NoCircuit("two drivers at X3Y4".into()))));
    let message = try_load(&mut broken()).unwrap_err().to_string();
    assert!(message.contains("cannot run") && message.contains("two drivers at X3Y4"), "{message}");
    let mut card = configured_by_others(broken(), COMMITTED_BITSTREAM);
    let other = inspect(&mut card).unwrap().other.unwrap();
    assert!(other.contains("two drivers at X3Y4"), "{other}");
}

/// A card that somebody else has configured.
fn card_with(file: &[u8]) -> VirtualCard {
    configured_by_others(card(), file)
}

fn configured_by_others(mut card: VirtualCard, file: &[u8]) -> VirtualCard {
    use driver::plx9030::{Bridge, PROGRAM, WRITE};
    Bridge::new(&mut card).set_lines(WRITE, PROGRAM).unwrap();
    card.sleep(Duration::from_micros(10));
    Bridge::new(&mut card).set_lines(PROGRAM, 0).unwrap();
    card.sleep(Duration::from_millis(1));
    Bridge::new(&mut card).set_lines(0, WRITE).unwrap();
    for &byte in Bitstream::parse(file).unwrap().lanes() {
        card.write8(Bar::Memory32, 0, byte).unwrap();
    }
    Bridge::new(&mut card).set_lines(WRITE, 0).unwrap();
    card
}

#[test]
fn prom_order_loads_as_well() {
    let prom = Bitstream::parse(committed().lanes()).unwrap();
    assert_eq!((prom.order, &prom.header), (Order::Prom, &None));
    assert_eq!(prom.lanes(), bitstream().lanes());
    let raw = Bitstream::parse(stream()).unwrap();
    assert_eq!((raw.order, raw.lanes()), (Order::Bit, prom.lanes()));
    load(&mut card(), &prom, &Options::default(), |_| {}).unwrap();
}

#[test]
fn faults_of_the_card_are_named_and_end_safe() {
    let quiet = Faults::default();
    refused(Faults { init_low: true, ..quiet }, &["INIT stayed low for 20 ms", "tries: 3", "outputs off"]);
    refused(Faults { done_low: true, ..quiet }, &["DONE stayed low", "tries: 3"]);
    refused(Faults { done_high: true, ..quiet }, &["did not clear: DONE stays high"]);
    refused(Faults { write_high: true, ..quiet }, &["DONE stayed low", "no complete bitstream"]);
    refused(Faults { clock_still: true, ..quiet }, &["clock stands still"]);
    let lost = Faults { lost_byte: Some(100_000), hurt_loads: u32::MAX, ..quiet };
    refused(lost, &["tries: 3"]);
    let flipped = Faults { flipped_byte: Some((166_000, 0x10)), hurt_loads: u32::MAX, ..quiet };
    assert!(matches!(refused(flipped, &["CRC error"]).cause(), LoadError::Crc));
    let doubled = Faults { doubled_byte: Some(5), hurt_loads: u32::MAX, ..quiet };
    refused(doubled, &["tries: 3"]);
}

#[test]
fn a_passing_fault_costs_a_try_and_no_more() {
    let mut card = card();
    card.faults = Faults { flipped_byte: Some((90_000, 1)), hurt_loads: 2, ..Faults::default() };
    assert_eq!(try_load(&mut card).unwrap().tries, 3);
}

#[test]
fn an_absent_card_is_said_to_be_absent() {
    let mut card = card();
    card.faults.absent = true;
    let error = try_load(&mut card).unwrap_err();
    assert!(matches!(error, LoadError::Absent { .. }), "{error}");
    for after in [2, 7, 10, 80_000, 166_999, 167_030] {
        let mut card = self::card();
        card.faults.absent_after = Some(after);
        let message = try_load(&mut card).unwrap_err().to_string();
        assert!(message.contains("all ones"), "{after}: {message}");
        assert!(message.contains("cut the motors' power") || after < 10, "{after}: {message}");
    }
}

/// Our design but for one register, which says something else.
struct Answers(BitTrueLive, (u16, u32));

impl Live for Answers {
    fn run_to(&mut self, clock: u64, clock_hz: f64, machine: &mut Machine) -> Result<(), FpgaError> {
        self.0.run_to(clock, clock_hz, machine)
    }
    fn read(&mut self, offset: u16) -> Result<u32, FpgaError> {
        let (register, word) = self.1;
        if offset == register { Ok(word) } else { self.0.read(offset) }
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        self.0.write(offset, data)
    }
    fn kicks(&self) -> u32 {
        self.0.kicks()
    }
}

fn card_that_answers(register: (u16, u32)) -> VirtualCard {
    card().with_fabric(Box::new(move |_| Ok(Box::new(Answers(BitTrueLive::new(), register)))))
}

#[test]
fn another_design_or_board_is_refused_after_loading() {
    let other = (CONTENT_HASH.offset, 0xDEAD_BEEF);
    let five_i20 = (BOARD.offset, u32::from_be_bytes(*b"5I20"));
    for (register, says) in [(other, "answers with hash deadbeef"), (five_i20, "pins of another board")] {
        let mut card = card_that_answers(register);
        let error = try_load(&mut card).unwrap_err();
        assert!(error.to_string().contains(says), "{error}");
        assert!(!card.configured());
    }
    let any = Options { content_hash: None, ..Options::default() };
    let loaded = load(&mut card_that_answers(other), &bitstream(), &any, |_| {}).unwrap();
    assert_eq!(loaded.identity.content_hash, 0xDEAD_BEEF);
}

/// A host without memory windows.
struct PortsOnly(VirtualCard);

impl PciCard for PortsOnly {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        assert!(self.has(bar));
        self.0.read32(bar, offset)
    }
    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        assert!(self.has(bar));
        self.0.write32(bar, offset, data)
    }
    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
        assert!(self.has(bar));
        self.0.write8(bar, offset, data)
    }
    fn has(&self, bar: Bar) -> bool {
        !bar.is_memory()
    }
    fn now(&mut self) -> Duration {
        self.0.now()
    }
    fn sleep(&mut self, time: Duration) {
        self.0.sleep(time);
    }
}

#[test]
fn ports_are_enough_to_load_and_verify() {
    let mut card = PortsOnly(card());
    load(&mut card, &bitstream(), &Options::default(), |_| {}).unwrap();
    assert!(inspect(&mut card).unwrap().identity.is_some());
}

fn fault(file: &[u8]) -> Fault {
    Bitstream::parse(file).unwrap_err()
}

#[test]
fn damaged_files_are_refused_with_place_and_cause() {
    let bit = COMMITTED_BITSTREAM.to_vec();
    let start = bit.len() - 166_980;
    let with = |at: usize, bytes: &[u8]| {
        let mut file = bit.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let says = |file: &[u8], part: &str| {
        let message = fault(file).to_string();
        assert!(message.contains(part), "no {part:?} in {message}");
    };
    says(&[], "is empty");
    says(&bit[..40], "cut short");
    says(&bit[..bit.len() - 1], "goes on beyond the end");
    says(&[&bit[..], &[0, 1]].concat(), "2 bytes follow the bitstream");
    says(&with(3, &[0]), "preamble) is damaged");
    says(&with(5, &[0]), "preamble) is damaged");
    says(&with(13, b"z"), "field 'z'");
    says(&with(14, &[0, 0]), "does not end with a zero byte");
    let part = bit.windows(10).position(|w| w == b"2s200pq208").unwrap();
    says(&with(part, b"2s100pq208"), "the file is for 2s100pq208, the card has 2s200pq208");
    says(&with(part, &[7]), "no printable text");
    says(&with(start + 4, &[0; 4]), "no sync word");
    says(&with(start + 23, &[16]), "frame length register is set to 16");
    let crc = fault(&with(start + 90_000, &[bit[start + 90_000] ^ 1]));
    // The CRC word after the three big sections of frames.
    let word = start + 4 * (41_745 - 4 - 2 - 2 - 2 - 19 - 2 - 1);
    assert!(matches!(crc, Fault::Crc { offset, .. } if offset == word), "{crc} {word:#x}");
    says(b"Xilinx ASCII Bitstream\n", "rawbits");
    says(b":100000", "Intel hexadecimal");
    says(&[0x1F, 0x8B, 8], "compressed");
    says(&vec![0; 166_980], "no sync word");
    says(&stream()[..100_000], "100000 bytes");
}
