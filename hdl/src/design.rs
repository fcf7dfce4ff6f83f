//! The design as a whole: every file in `generated/`, made afresh, and the committed Verilog.

use crate::blocks::core::Core;
use crate::blocks::serial_host::SerialHost;
use crate::board::{Board, BoardError};
use crate::emit::{blocks, hash, ise, open_board, registers, top, ucf, verilog, wavejson};
use fixed_kin::registers::BOARD_4I65;
use rust_hdl::prelude::{Block, ToBits};
use std::sync::OnceLock;

/// Name of the top module and of the files.
pub const NAME: &str = "rac4i65";

/// The committed `generated/rac4i65.v`; a test proves that it is current.
pub const COMMITTED_VERILOG: &str = include_str!("../../generated/rac4i65.v");

/// The committed `generated/rac4i65.bit`, made of that Verilog; a test builds it again.
pub const COMMITTED_BITSTREAM: &[u8] = include_bytes!("../../generated/rac4i65.bit");

/// The committed `generated/rac_hx8k.v`: top and serial host for the open board.
pub const COMMITTED_OPEN_BOARD: &str = include_str!("../../generated/rac_hx8k.v");

/// A file of `generated/`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Name in the folder.
    pub name: String,
    /// What is written to it, whole.
    pub text: String,
}

/// A design that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// Core and board do not fit.
    #[error(transparent)]
    Top(#[from] top::TopError),
    /// The board table contradicts itself.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The core does not fit the open board.
    #[error(transparent)]
    OpenBoard(#[from] open_board::OpenBoardError),
}

/// The hash that a card with the committed design answers with.
#[must_use]
pub fn content_hash() -> u32 {
    static HASH: OnceLock<u32> = OnceLock::new();
    *HASH.get_or_init(|| hash::embedded(COMMITTED_VERILOG).unwrap_or_else(|| hash::content_hash(COMMITTED_VERILOG)))
}

/// The core, connected, ready to simulate.
#[must_use]
pub fn core() -> Core {
    let mut core = Core::new(content_hash());
    core.board.next = u64::from(BOARD_4I65.word).to_bits();
    core.clock_hz.next = u64::from(BOARD_4I65.clock_hz).to_bits();
    core.connect_all();
    core
}

/// The chip's Verilog with its own hash inside.
///
/// # Errors
/// [`DesignError`] where core and board do not fit: a mistake in one of them.
pub fn verilog(board: &Board) -> Result<String, DesignError> {
    let mut core = Core::new(0);
    core.connect_all();
    let text = top::chip(&core, board, NAME)?;
    Ok(hash::embed(&text).unwrap_or(text))
}

/// The open board's top and serial host; the core is in the chip's own file, `chip`.
///
/// # Errors
/// [`DesignError::OpenBoard`] where the core does not fit the board.
pub fn open_board(chip: &str) -> Result<String, DesignError> {
    let mut host = SerialHost::default();
    host.connect_all();
    let host_name = format!("{}_host", open_board::NAME);
    let top = open_board::top(chip, &format!("{NAME}_core"), &host_name)?;
    Ok(verilog::file(open_board::NAME, &[&top, &verilog::modules(&host, &host_name)]))
}

/// Every file of `generated/`.
///
/// # Errors
/// As [`verilog()`].
pub fn files() -> Result<Vec<File>, DesignError> {
    let board = Board::mesa_4i65_7i30();
    let verilog = verilog(&board)?;
    let hash = hash::content_hash(&verilog);
    let open_board = open_board(&verilog)?;
    let open_pins = open_board::constraints(&verilog, &format!("{NAME}_core"))?;
    let file = |name: &str, text: String| File { name: name.to_owned(), text };
    Ok(vec![
        file("rac4i65.v", verilog),
        file("rac4i65.ucf", ucf::ucf(&board, NAME)?),
        file("rac4i65.prj", ise::project(NAME)),
        file("rac4i65.xst", ise::synthesis(NAME)),
        file("rac4i65.ut", ise::bitstream(hash)),
        file("Makefile", ise::makefile(NAME)),
        file("rac_hx8k.v", open_board),
        file("rac_hx8k.pcf", open_pins),
        file("blocks.md", blocks::markdown()),
        file("registers.md", registers::markdown() + &wavejson::section()),
        file("registers.h", registers::c_header()),
        file("registers.json", registers::json(hash)),
    ])
}
