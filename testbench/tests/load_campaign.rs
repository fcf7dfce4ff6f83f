//! Fault campaign on loading, in process and seeded. Whatever is hurt, and wherever loading is killed:
//! no output is on afterwards, what is accepted is right, what is refused has a cause with a name, and the
//! next load on a mended card succeeds at once. `RACBOT_CAMPAIGN=10` runs ten times the cases.

use driver::bitstream::Bitstream;
use driver::load::{Loaded, Options, load};
use driver::pci::{Bar, PciCard, PciError};
use fixed_kin::registers::STATUS;
use hdl::design::{COMMITTED_BITSTREAM, content_hash};
use measured::Table;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use simulator::virtual_card::{Faults, VirtualCard};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

const SEED: u64 = 0x4_165;

/// A host that dies, or whose bus hurts a word, at some access.
struct Hurt {
    card: VirtualCard,
    access: u64,
    /// From this access on nothing is done any more.
    dies_at: u64,
    /// This access has these bits flipped, if it is a word.
    flips: (u64, u32),
}

impl Hurt {
    fn new(card: VirtualCard) -> Self {
        Self { card, access: 0, dies_at: u64::MAX, flips: (0, 0) }
    }

    fn next(&mut self) -> Option<u32> {
        self.access += 1;
        let flips = if self.access == self.flips.0 { self.flips.1 } else { 0 };
        (self.access < self.dies_at).then_some(flips)
    }
}

impl PciCard for Hurt {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        let Some(flips) = self.next() else { return Err(PciError::read(bar, offset, "killed")) };
        Ok(self.card.read32(bar, offset)? ^ flips)
    }
    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        let Some(flips) = self.next() else { return Err(PciError::write(bar, offset, "killed")) };
        self.card.write32(bar, offset, data ^ flips)
    }
    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
        let Some(_) = self.next() else { return Err(PciError::write(bar, offset, "killed")) };
        self.card.write8(bar, offset, data)
    }
    fn has(&self, bar: Bar) -> bool {
        self.card.has(bar)
    }
    fn now(&mut self) -> Duration {
        self.card.now()
    }
    fn sleep(&mut self, time: Duration) {
        self.card.sleep(time);
    }
}

#[derive(Clone, Copy, Debug)]
enum Case {
    /// The process is killed before this access.
    Killed(u64),
    /// This access has this bit flipped.
    Word(u64, u32),
    /// The card is gone from this access on.
    Gone(u64),
    /// A byte of the stream is lost, doubled or changed on the bus.
    Byte(u64, u8),
    /// A bit of the file is flipped.
    File(usize, u8),
    /// The file ends early.
    Short(usize),
}

impl Case {
    fn kind(self) -> &'static str {
        match self {
            Self::Killed(_) => "process killed at an access",
            Self::Word(..) => "bit of a register access flipped",
            Self::Gone(_) => "card gone from an access on",
            Self::Byte(_, 0) => "byte lost on the bus",
            Self::Byte(_, 1) => "byte doubled on the bus",
            Self::Byte(..) => "bits of a byte flipped on the bus",
            Self::File(..) => "bit of the file flipped",
            Self::Short(_) => "file cut short",
        }
    }
}

fn options() -> Options {
    Options { tries: 1, clock_time: Duration::from_millis(3), ..Options::default() }
}

/// Accesses of a load that goes well, bytes included.
fn accesses(good: &Bitstream) -> u64 {
    let mut card = VirtualCard::new(&Robot::racbot()).unwrap();
    load(&mut card, good, &options(), |_| {}).unwrap();
    card.accesses()
}

/// Every class of position: all accesses before and after the bytes, and many between.
fn cases(accesses: u64) -> Vec<Case> {
    let more: u64 = std::env::var("RACBOT_CAMPAIGN").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let mut cases = Vec::new();
    let ends = || (1..60).chain(accesses - 100..accesses);
    cases.extend(ends().map(Case::Killed));
    cases.extend(ends().map(Case::Gone));
    for access in ends() {
        cases.extend((0..2 * more).map(|_| Case::Word(access, random.random_range(0..32))));
    }
    let bit = COMMITTED_BITSTREAM.len();
    // Packets stand at the beginning, before the last 40 words, and after the first two sections.
    let packets: Vec<u64> = (0..100).step_by(3).chain((157_440..157_480).step_by(3)).chain(166_800..166_980).collect();
    for &byte in &packets {
        cases.extend([0, 1, random.random_range(2..=255)].map(|how| Case::Byte(byte, how)));
    }
    for _ in 0..300 * more {
        cases.push(Case::Killed(random.random_range(20..accesses)));
        cases.push(Case::Byte(random.random_range(0..166_980), random.random_range(0..=255)));
        cases.push(Case::File(random.random_range(0..bit), random.random_range(0..8)));
        cases.push(Case::Short(random.random_range(0..bit)));
    }
    for _ in 0..100 * more {
        cases.push(Case::Gone(random.random_range(20..accesses)));
    }
    cases.extend((0..200).map(|byte| Case::File(byte, random.random_range(0..8))));
    cases.extend((bit - 120..bit).map(|byte| Case::File(byte, random.random_range(0..8))));
    cases
}

fn right(loaded: &Loaded) -> bool {
    let clock = loaded.clock_hz / f64::from(fixed_kin::registers::NOMINAL_CLOCK_HZ);
    loaded.identity.content_hash == content_hash() && (clock - 1.0).abs() < 0.01
}

/// Runs a case; says whether it loaded, or what it broke.
fn run(case: Case, good: &Bitstream, file: &[u8]) -> Result<bool, String> {
    let mut card = Hurt::new(VirtualCard::new(&Robot::racbot()).map_err(|error| error.to_string())?);
    let mut parsed = None;
    let mut bytes = file.to_vec();
    match case {
        Case::Killed(at) => card.dies_at = at,
        Case::Word(at, bit) => card.flips = (at, 1 << bit),
        Case::Gone(at) => card.card.faults.absent_after = Some(at),
        Case::Byte(at, how) => {
            let faults = Faults { hurt_loads: u32::MAX, ..Faults::default() };
            card.card.faults = match how {
                0 => Faults { lost_byte: Some(at), ..faults },
                1 => Faults { doubled_byte: Some(at), ..faults },
                bits => Faults { flipped_byte: Some((at, bits)), ..faults },
            };
        }
        Case::File(at, bit) => bytes[at] ^= 1 << bit,
        Case::Short(length) => bytes.truncate(length),
    }
    if matches!(case, Case::File(..) | Case::Short(_)) {
        match Bitstream::parse(&bytes) {
            Ok(bitstream) => parsed = Some(bitstream),
            Err(fault) if fault.to_string().len() > 15 => return Ok(false),
            Err(fault) => return Err(format!("a fault without words: {fault:?}")),
        }
    }
    let options = options();
    let result = load(&mut card, parsed.as_ref().unwrap_or(good), &options, |_| {});
    let armed = card.card.peek(STATUS.offset).is_some_and(|status| status & 1 == 1);
    if armed {
        return Err("armed after loading".to_owned());
    }
    let gone = matches!(case, Case::Gone(_) | Case::Killed(_));
    match &result {
        Ok(loaded) if !right(loaded) => return Err(format!("accepted, and wrong: {loaded:?}")),
        Err(_) if card.card.configured() && !gone && !matches!(case, Case::Word(..)) => {
            return Err("refused, but the FPGA is not clear".to_owned());
        }
        Err(error) if error.to_string().len() < 20 => return Err(format!("no cause: {error}")),
        _ => {}
    }
    // Mended, the card loads at once.
    card.card.faults = Faults::default();
    let mut card = card.card;
    let again = load(&mut card, good, &options, |_| {}).map_err(|error| format!("does not load again: {error}"))?;
    if !right(&again) {
        return Err("the next load is wrong".to_owned());
    }
    Ok(result.is_ok())
}

const TABLE: Table<'_> = Table {
    name: "load-campaign",
    title: "Loading under faults, seeded: afterwards outputs are off or the accepted design is right",
    command: "cargo test --release -p testbench --test load_campaign",
    columns: &["fault while loading", "cases", "no harm done", "refused, outputs off"],
};

#[test]
fn whatever_is_hurt_ends_safe_and_named() {
    let file = COMMITTED_BITSTREAM;
    let good = Bitstream::parse(file).unwrap();
    let cases = cases(accesses(&good));
    let next = AtomicU32::new(0);
    let table: Mutex<BTreeMap<&str, [u32; 2]>> = Mutex::default();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some(&case) = cases.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    let loaded = run(case, &good, file).unwrap_or_else(|broken| panic!("{case:?}: {broken}"));
                    let mut table = table.lock().unwrap();
                    table.entry(case.kind()).or_default()[usize::from(!loaded)] += 1;
                }
            });
        }
    });
    let table = table.into_inner().unwrap();
    let row = |(kind, [fine, refused]): (&&str, &[u32; 2])| {
        assert!(*refused > 0, "{kind} never mattered");
        vec![(*kind).to_owned(), (fine + refused).to_string(), fine.to_string(), refused.to_string()]
    };
    TABLE.check(&table.iter().map(row).collect::<Vec<_>>());
    assert!(cases.len() > 2_000);
}
