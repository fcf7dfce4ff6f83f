//! Primitives that rust-hdl lacks: sized literals, flip-flops with a start value, block memory.

use rust_hdl::prelude::*;

/// A sized constant: `V` in `N` bits, a `localparam` in Verilog.
///
/// rust-hdl emits a bare number as `32'h…`, which silently widens the expression around it; a sized
/// one means the same in simulation and in Verilog. A value that does not fit does not compile:
///
/// ```compile_fail
/// # use hdl::primitives::Literal;
/// let limit = Literal::<14, 20_000>::default();
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Literal<const N: usize, const V: u64>(Constant<Bits<N>>);

impl<const N: usize, const V: u64> Literal<N, V> {
    /// `V`, for logic that reads it.
    #[must_use]
    pub fn val(&self) -> Bits<N> {
        self.0.val()
    }
}

impl<const N: usize, const V: u64> Default for Literal<N, V> {
    fn default() -> Self {
        // Else it is a panic of whoever makes the block.
        const { assert!(N >= 64 || V >> N == 0, "the literal's value does not fit in its bits") };
        Self(Constant::new(V.to_bits()))
    }
}

impl<const N: usize, const V: u64> Logic for Literal<N, V> {
    fn update(&mut self) {}
}

impl<const N: usize, const V: u64> Block for Literal<N, V> {
    fn connect_all(&mut self) {}
    fn update_all(&mut self) {}
    fn has_changed(&self) -> bool {
        false
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        self.0.accept(name, probe);
    }
}

/// A constant that is chosen when the block is made; zero by default.
#[derive(Clone, Copy, Debug)]
pub struct Setting<const N: usize>(Constant<Bits<N>>);

impl<const N: usize> Setting<N> {
    /// A constant of this value.
    #[must_use]
    pub fn new(value: u64) -> Self {
        Self(Constant::new(value.to_bits()))
    }

    /// What it was made with, for logic that reads it.
    #[must_use]
    pub fn val(&self) -> Bits<N> {
        self.0.val()
    }
}

impl<const N: usize> Default for Setting<N> {
    fn default() -> Self {
        Self::new(0)
    }
}

impl<const N: usize> Logic for Setting<N> {
    fn update(&mut self) {}
}

impl<const N: usize> Block for Setting<N> {
    fn connect_all(&mut self) {}
    fn update_all(&mut self) {}
    fn has_changed(&self) -> bool {
        false
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        self.0.accept(name, probe);
    }
}

/// A register of `N` bits that starts at `V` when the FPGA is configured.
#[derive(LogicBlock)]
pub struct Preset<const N: usize, const V: u64> {
    /// Next value.
    pub d: Signal<In, Bits<N>>,
    /// What was stored at the last rising edge.
    pub q: Signal<Out, Bits<N>>,
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
}

impl<const N: usize, const V: u64> Default for Preset<N, V> {
    fn default() -> Self {
        Self { d: Signal::default(), q: Signal::new_with_default(V.to_bits()), clock: Signal::default() }
    }
}

impl<const N: usize, const V: u64> Logic for Preset<N, V> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            self.q.next = self.d.val();
        }
    }
    fn connect(&mut self) {
        self.q.connect();
    }
    fn hdl(&self) -> Verilog {
        Verilog::Custom(format!(
            "initial begin\n   q = {N}'h{V:x};\nend\n\nalways @(posedge clock) begin\n   q <= d;\nend"
        ))
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: "preset".into(),
            clock: "clock".into(),
            inputs: vec!["d".into()],
            outputs: vec!["q".into()],
        }]
    }
}

/// Memory of 2ᴺ words of `W` ≤ 32 bits: one write port, one registered read port, one clock.
///
/// A read of the word that is written in the same clock gives garbage: the device's block memories promise
/// nothing then. Its user must not make such a read, or not use what it gives; `no_rw_check` tells yosys,
/// which otherwise builds the missing promise from flip-flops without a start value. Where nothing is given
/// the memory starts at zero, so that no pattern is left to chance.
#[derive(LogicBlock)]
pub struct Memory<const W: usize, const N: usize> {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Address to read; data follow one clock later.
    pub read_address: Signal<In, Bits<N>>,
    /// What stood at `read_address` at the last clock.
    pub read_data: Signal<Out, Bits<W>>,
    /// Where `write_data` goes at the next edge if `write` is high.
    pub write_address: Signal<In, Bits<N>>,
    /// Word to write.
    pub write_data: Signal<In, Bits<W>>,
    /// Write at this clock.
    pub write_enable: Signal<In, Bit>,
    // rust-hdl takes fields with an underscore for no part of the circuit.
    _words: Vec<u32>,
}

impl<const W: usize, const N: usize> Memory<W, N> {
    /// A memory that starts with `initial`, then zeros.
    ///
    /// # Panics
    /// If there are more than 2ᴺ words.
    #[must_use]
    pub fn new(initial: &[u32]) -> Self {
        Self {
            clock: Signal::default(),
            read_address: Signal::default(),
            read_data: Signal::new_with_default(Bits::default()),
            write_address: Signal::default(),
            write_data: Signal::default(),
            write_enable: Signal::default(),
            _words: padded::<N>(initial),
        }
    }
}

impl<const W: usize, const N: usize> Default for Memory<W, N> {
    fn default() -> Self {
        Self::new(&[])
    }
}

impl<const W: usize, const N: usize> Logic for Memory<W, N> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            let word = u64::from(self._words[self.read_address.val().index()]).to_bits();
            let meets = self.write_enable.val() && self.write_address.val() == self.read_address.val();
            self.read_data.next = if meets { !word } else { word };
            if self.write_enable.val() {
                self._words[self.write_address.val().index()] = self.write_data.val().index() as u32;
            }
        }
    }
    fn connect(&mut self) {
        self.read_data.connect();
    }
    fn hdl(&self) -> Verilog {
        Verilog::Custom(format!(
            "{}\n\nalways @(posedge clock) begin\n   read_data <= mem[read_address];\n   \
             if (write_enable) mem[write_address] <= write_data;\nend",
            memory_of::<W, N>(&self._words)
        ))
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: "memory".into(),
            clock: "clock".into(),
            inputs: ["read_address", "write_address", "write_data", "write_enable"].map(String::from).to_vec(),
            outputs: vec!["read_data".into()],
        }]
    }
}

/// Read-only memory of 2ᴺ words of `W` ≤ 32 bits, with a registered read port.
#[derive(LogicBlock)]
pub struct Rom<const W: usize, const N: usize> {
    /// All state changes at its rising edge.
    pub clock: Signal<In, Clock>,
    /// Address to read; data follow one clock later.
    pub read_address: Signal<In, Bits<N>>,
    /// What stands at `read_address` of the last clock.
    pub read_data: Signal<Out, Bits<W>>,
    _words: Vec<u32>,
}

impl<const W: usize, const N: usize> Rom<W, N> {
    /// A memory that holds `words`, then zeros.
    ///
    /// # Panics
    /// If there are more than 2ᴺ words.
    #[must_use]
    pub fn new(words: &[u32]) -> Self {
        Self {
            clock: Signal::default(),
            read_address: Signal::default(),
            read_data: Signal::new_with_default(Bits::default()),
            _words: padded::<N>(words),
        }
    }
}

impl<const W: usize, const N: usize> Default for Rom<W, N> {
    fn default() -> Self {
        Self::new(&[])
    }
}

impl<const W: usize, const N: usize> Logic for Rom<W, N> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            self.read_data.next = u64::from(self._words[self.read_address.val().index()]).to_bits();
        }
    }
    fn connect(&mut self) {
        self.read_data.connect();
    }
    fn hdl(&self) -> Verilog {
        Verilog::Custom(format!(
            "{}\n\nalways @(posedge clock) begin\n   read_data <= mem[read_address];\nend",
            memory_of::<W, N>(&self._words)
        ))
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: "rom".into(),
            clock: "clock".into(),
            inputs: vec!["read_address".into()],
            outputs: vec!["read_data".into()],
        }]
    }
}

fn padded<const N: usize>(words: &[u32]) -> Vec<u32> {
    assert!(words.len() <= 1 << N, "{} words do not fit 2^{N}", words.len());
    let mut padded = vec![0; 1 << N];
    padded[..words.len()].copy_from_slice(words);
    padded
}

/// Declaration and start values of a memory.
fn memory_of<const W: usize, const N: usize>(words: &[u32]) -> String {
    let initial: Vec<String> =
        words.iter().enumerate().map(|(i, word)| format!("   mem[{i}] = {W}'h{word:x};")).collect();
    format!(
        "(* no_rw_check *)\nreg [{top}:0] mem [0:{last}];\n\ninitial begin\n   read_data = {W}'h0;\n{initial}\nend",
        top = W - 1,
        last = (1 << N) - 1,
        initial = initial.join("\n")
    )
}
