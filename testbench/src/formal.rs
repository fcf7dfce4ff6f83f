//! Formal proofs on emitted Verilog: for every input and every state, not for the ones that were tried.
//!
//! ```text
//! module of generated/ + checker (testbench/proofs/*.v) ──► yosys: flatten, SAT ──► proven, or a counterexample
//!        └─ the same with one line broken (a mutant) ─────────────────────────────► must be refuted
//! ```
//!
//! A checker is Verilog that is put into the module's own scope, so it reads ports and flip-flops by
//! name. Method: temporal induction (yosys `sat -tempinduct`): the assertions hold in the first `k`
//! clocks from power-up, and whatever state they held in for `k` clocks, they hold in the next. A
//! mutant is refuted from power-up, not only in the step. Parts that a claim does not depend on are
//! cut out: their outputs may then do anything.

mod proofs;

pub use proofs::PROOFS;

use simulator::cosim::{CosimError, folder};
use std::path::Path;
use std::time::{Duration, Instant};

/// A claim about one module of the emitted Verilog.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// Short name, also that of the checker's file.
    pub name: &'static str,
    /// In words, for the table.
    pub claim: &'static str,
    /// Module it is claimed of.
    pub module: &'static str,
    /// Assertions, assumptions and what they need, in the scope of the module.
    pub checker: &'static str,
    /// Further modules inside it, each with a checker of its own.
    pub inside: &'static [(&'static str, &'static str)],
    /// Most clocks of an induction.
    pub depth: u32,
    /// Modules that are left out, their outputs free.
    pub cut: &'static [&'static str],
    /// Instances in the module that are left out, their outputs free.
    pub free: &'static [&'static str],
    /// Constants made small, in module and checker, so that a mutant shows within few clocks; the
    /// claim must hold there too.
    pub shrink: &'static [(&'static str, &'static str)],
    /// Ways to break the module.
    pub mutants: &'static [Mutant],
}

/// One line of a module broken on purpose.
#[derive(Clone, Copy, Debug)]
pub struct Mutant {
    /// What is wrong then.
    pub what: &'static str,
    /// Text that stands in the module exactly once.
    pub from: &'static str,
    /// What stands there instead.
    pub to: &'static str,
}

/// What a proof took.
#[derive(Clone, Debug)]
pub struct Proven {
    /// Clocks of the induction.
    pub depth: u32,
    /// Number of assertions that were proven.
    pub assertions: usize,
    /// Time for the proof.
    pub time: Duration,
    /// From the first mutant to the last answer.
    pub mutants_time: Duration,
}

/// A proof that is none.
#[derive(Debug, thiserror::Error)]
pub enum FormalError {
    /// Yosys is missing, or failed in another way than by an answer.
    #[error(transparent)]
    Tool(#[from] CosimError),
    /// The module is not in the text.
    #[error("{proof}: there is no module `{module}` in the Verilog; was it renamed?")]
    NoModule {
        /// As in the table of claims.
        proof: &'static str,
        /// Module it was claimed of.
        module: &'static str,
    },
    /// An edit that does not find its place.
    #[error("{proof}: `{text}` stands {count} times in `{module}`, not once; adapt the mutant or the shrinking")]
    NoPlace {
        /// As in the table of claims.
        proof: &'static str,
        /// Module it was claimed of.
        module: &'static str,
        /// What was to be replaced in the Verilog.
        text: &'static str,
        /// How often it stands there.
        count: usize,
    },
    /// The claim does not follow.
    #[error("{proof}{variant}: not proven within {depth} clocks: {answer}\n{log}")]
    NotProven {
        /// As in the table of claims.
        proof: &'static str,
        /// Which variant of the module.
        variant: &'static str,
        /// Clocks that were tried.
        depth: u32,
        /// A counterexample from power-up, or only an induction that does not close.
        answer: &'static str,
        /// The end of what yosys printed.
        log: String,
    },
    /// A broken module that the checker takes for a good one.
    #[error("{proof}: the mutant \"{mutant}\" was not refuted within {depth} clocks: the claim is too weak\n{log}")]
    Survived {
        /// As in the table of claims.
        proof: &'static str,
        /// What was replaced in the Verilog.
        mutant: &'static str,
        /// Clocks that were tried.
        depth: u32,
        /// The end of what yosys printed.
        log: String,
    },
}

/// What yosys answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    Proven,
    Refuted,
    Open,
}

/// Clocks in which a mutant has to show.
const MUTANT_DEPTH: u32 = 90;

impl Proof {
    /// Proves the claim on a Verilog text and refutes every mutant.
    ///
    /// # Errors
    /// [`FormalError`]: the claim is not proven, a mutant survives or does not apply, yosys is missing.
    pub fn run(&self, verilog: &str) -> Result<Proven, FormalError> {
        let folder = folder::fresh(&folder::root(), &format!("formal-{}", self.name))?;
        let begin = Instant::now();
        let (answer, log) = self.ask(verilog, &[], false, &folder)?;
        let time = begin.elapsed();
        self.must_hold("", answer, &log)?;
        let begin = Instant::now();
        if !self.shrink.is_empty() {
            let (answer, log) = self.ask(verilog, &[], true, &folder)?;
            self.must_hold(", made small", answer, &log)?;
        }
        for mutant in self.mutants {
            let (answer, log) = self.ask(verilog, &[*mutant], true, &folder)?;
            if answer != Answer::Refuted {
                let (proof, mutant) = (self.name, mutant.what);
                return Err(FormalError::Survived { proof, mutant, depth: MUTANT_DEPTH, log: tail(&log) });
            }
        }
        let _ = std::fs::remove_dir_all(&folder);
        let depth = log.matches("[induction step").count() as u32;
        let checkers = self.inside.iter().map(|(_, checker)| *checker).chain([self.checker]);
        let asserts = checkers.map(|checker| checker.matches("assert (").count()).sum();
        Ok(Proven { depth, assertions: asserts, time, mutants_time: begin.elapsed() })
    }

    fn must_hold(&self, variant: &'static str, answer: Answer, log: &str) -> Result<(), FormalError> {
        let answer = match answer {
            Answer::Proven => return Ok(()),
            Answer::Refuted => "it fails from power-up",
            Answer::Open => "the induction does not close",
        };
        Err(FormalError::NotProven { proof: self.name, variant, depth: self.depth, answer, log: tail(log) })
    }

    /// Where a module's text is, without its end.
    fn place(&self, verilog: &str, module: &'static str) -> Result<std::ops::Range<usize>, FormalError> {
        let missing = || FormalError::NoModule { proof: self.name, module };
        let begin = verilog.find(&format!("module {module} (")).ok_or_else(missing)?;
        let end = begin + verilog[begin..].find("endmodule").ok_or_else(missing)?;
        Ok(begin..end)
    }

    /// Replaces a text that must stand there exactly once.
    fn edit(&self, text: &mut String, from: &'static str, to: &str) -> Result<(), FormalError> {
        let count = text.matches(from).count();
        if count != 1 {
            return Err(FormalError::NoPlace { proof: self.name, module: self.module, text: from, count });
        }
        *text = text.replace(from, to);
        Ok(())
    }

    /// The Verilog with the checkers inside.
    fn bound(&self, verilog: &str, mutants: &[Mutant], small: bool) -> Result<String, FormalError> {
        let mut text = verilog.to_owned();
        let all = self.inside.iter().copied().chain([(self.module, self.checker)]);
        let mut checkers: Vec<_> = all.map(|(module, checker)| (module, checker.to_owned())).collect();
        let place = self.place(&text, self.module)?;
        let mut body = text[place.clone()].to_owned();
        if small {
            for (from, to) in self.shrink {
                let checker = checkers.iter_mut().map(|(_, text)| text).find(|text| text.contains(from));
                self.edit(checker.unwrap_or(&mut body), from, to)?;
            }
        }
        for mutant in mutants {
            self.edit(&mut body, mutant.from, mutant.to)?;
        }
        text.replace_range(place, &body);
        for (module, checker) in checkers {
            let end = self.place(&text, module)?.end;
            text.insert_str(end, &checker);
        }
        Ok(text)
    }

    fn ask(
        &self,
        verilog: &str,
        mutants: &[Mutant],
        small: bool,
        folder: &Path,
    ) -> Result<(Answer, String), FormalError> {
        folder::write(&folder.join("bound.v"), &self.bound(verilog, mutants, small)?)?;
        let module = self.module;
        let cut: String = self.cut.iter().map(|cut| format!("blackbox {cut}; ")).collect();
        let free: String = self.free.iter().map(|free| format!("delete {module}/c:{free}; ")).collect();
        let (mode, depth) = if mutants.is_empty() { ("", self.depth) } else { ("-baseonly", MUTANT_DEPTH) };
        let ignore = if self.cut.is_empty() { "" } else { "-ignore_unknown_cells" };
        let script = format!(
            "read_verilog -formal bound.v; {cut}hierarchy -check -top {module}; {free}proc; flatten; memory; opt -fast; \
             sat -tempinduct{mode} -prove-asserts -set-assumes -maxsteps {depth} -show-public {ignore}"
        );
        let output = folder::call("yosys", &["-p", &script], folder)?;
        let log = folder::both(&output);
        let answer = if log.contains("model found for base case: FAIL!") {
            Answer::Refuted
        } else if log.contains("Induction step proven: SUCCESS!") && mutants.is_empty() {
            Answer::Proven
        } else if output.status.success() && log.contains("Reached maximum number of time steps") {
            Answer::Open
        } else {
            let (tool, what) = ("yosys".into(), format!("the proof \"{}\"", self.name));
            return Err(CosimError::Tool { tool, what, folder: folder.into(), output: tail(&log) }.into());
        };
        Ok((answer, log))
    }
}

/// The last clocks of a counterexample, or the end of an error.
fn tail(log: &str) -> String {
    let lines: Vec<&str> = log.lines().collect();
    lines[lines.len().saturating_sub(160)..].join("\n")
}
