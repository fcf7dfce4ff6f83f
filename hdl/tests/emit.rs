//! Emission of a hierarchy with arrays: names, merging, order, determinism; and the top module and
//! constraints of a core of the real chip's shape.

use hdl::board::Board;
use hdl::emit::ports::Ports;
use hdl::emit::token::{Kind, tokens};
use hdl::emit::{hash, top, ucf, verilog};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;
use std::collections::BTreeSet;

#[derive(Clone, Copy, Debug, PartialEq, LogicState)]
enum Mode {
    Up,
    Down,
    Hold,
}

#[derive(LogicBlock, Default)]
struct Stage {
    clock: Signal<In, Clock>,
    amount: Signal<In, Bits<8>>,
    down: Signal<In, Bit>,
    value: Signal<Out, Bits<8>>,
    total: DFF<Bits<8>>,
    mode: DFF<Mode>,
}

impl Logic for Stage {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, total, mode);
        match self.mode.q.val() {
            Mode::Up => self.total.d.next = self.total.q.val() + self.amount.val(),
            Mode::Down => self.total.d.next = self.total.q.val() - self.amount.val(),
            Mode::Hold => {}
            _ => {}
        }
        self.mode.d.next = Mode::Up;
        if !self.amount.val().any() {
            self.mode.d.next = Mode::Hold;
        }
        if self.down.val() {
            self.mode.d.next = Mode::Down;
        }
        self.value.next = self.total.q.val();
    }
}

#[derive(LogicBlock, Default)]
struct Pair {
    clock: Signal<In, Clock>,
    amount: Signal<In, Bits<8>>,
    down: Signal<In, Bit>,
    value: Signal<Out, Bits<8>>,
    stage: [Stage; 2],
    stage_0: Stage,
}

impl Logic for Pair {
    #[hdl_gen]
    fn update(&mut self) {
        self.stage_0.clock.next = self.clock.val();
        self.stage_0.down.next = self.down.val();
        for i in 0..2 {
            self.stage[i].clock.next = self.clock.val();
            self.stage[i].down.next = self.down.val();
        }
        self.stage[0].amount.next = self.amount.val();
        self.stage[1].amount.next = self.stage[0].value.val();
        self.stage_0.amount.next = self.stage[1].value.val();
        self.value.next = self.stage_0.value.val();
    }
}

#[derive(LogicBlock)]
struct Tree {
    clock: Signal<In, Clock>,
    amount: [Signal<In, Bits<8>>; 3],
    down: Signal<In, Bit>,
    value: [Signal<Out, Bits<8>>; 3],
    hash: Signal<Out, Bits<32>>,
    pair: [Pair; 3],
    content_hash: Constant<Bits<32>>,
}

impl Default for Tree {
    fn default() -> Self {
        Self {
            clock: Signal::default(),
            amount: Default::default(),
            down: Signal::default(),
            value: Default::default(),
            hash: Signal::default(),
            pair: Default::default(),
            content_hash: Constant::new(0_u32.to_bits()),
        }
    }
}

impl Logic for Tree {
    #[hdl_gen]
    fn update(&mut self) {
        for i in 0..3 {
            self.pair[i].clock.next = self.clock.val();
            self.pair[i].amount.next = self.amount[i].val();
            self.pair[i].down.next = self.down.val();
            self.value[i].next = self.pair[i].value.val();
        }
        self.hash.next = self.content_hash.val();
    }
}

fn tree() -> Tree {
    let mut tree = Tree::default();
    tree.connect_all();
    tree
}

fn modules(text: &str) -> Vec<&str> {
    let solid: Vec<_> = tokens(text).into_iter().filter(|t| !t.is_blank()).collect();
    solid.windows(2).filter(|w| w[0].is("module")).map(|w| w[1].text).collect()
}

#[test]
fn equal_instances_become_one_module_with_a_name_that_says_what_they_share() {
    let text = verilog::emit(&tree(), "tree");
    assert_eq!(modules(&text), ["tree", "tree_pair", "tree_pair_stage", "tree_dff_2", "tree_dff_8"]);
    let dollars: Vec<_> = tokens(&text).into_iter().filter(|t| t.kind == Kind::Ident && t.text.contains('$')).collect();
    assert!(dollars.is_empty(), "{dollars:?}");
}

#[test]
fn names_that_would_fall_together_are_kept_apart() {
    // `stage$0$value` is a pin of the array, `stage_0$value` one of the stage beside it.
    let text = verilog::emit(&tree(), "tree");
    let declared: Vec<_> = text.lines().filter(|l| l.contains("wire [7:0] stage_0_value")).collect();
    assert_eq!(declared.len(), 2, "{declared:?}");
    assert_eq!(declared.iter().collect::<BTreeSet<_>>().len(), 2);
}

#[test]
fn emission_is_the_same_every_time() {
    assert_eq!(verilog::emit(&tree(), "tree"), verilog::emit(&tree(), "tree"));
}

#[test]
fn the_design_can_hold_the_fingerprint_of_its_text() {
    let text = verilog::emit(&tree(), "tree");
    let signed = hash::embed(&text).unwrap();
    assert_eq!(hash::embedded(&signed), Some(hash::content_hash(&text)));
    assert_eq!(hash::content_hash(&signed), hash::content_hash(&text));
    let mut rebuilt = Tree { content_hash: Constant::new(hash::content_hash(&text).to_bits()), ..Tree::default() };
    rebuilt.connect_all();
    assert_eq!(hash::content_hash(&verilog::emit(&rebuilt, "tree")), hash::content_hash(&text));
}

fn core() -> Ports {
    let text = "module rac4i65_core (input clock, input synclk, input ads_n, input blast_n, input lw_r,\n\
                input [31:0] lad_in, output [31:0] lad_out, output lad_drive, output ready_n, output int_n,\n\
                output [7:0] led_n, input [3:0] encoder_a, input [3:0] encoder_b, input [3:0] encoder_index,\n\
                output pwm_0, output pwm_1, output pwm_2, output pwm_3, output [3:0] dir, output [3:0] enable_n,\n\
                output kicker_charge_n, output kicker_trigger_n, output kicker_discharge, input kicker_full,\n\
                input emergency_stop, input ball_sensor,\n\
                input radio_rx, input host_select, input [3:0] robot_number,\n\
                output imu_cs_n, output imu_sclk, output imu_mosi, input imu_miso, input imu_ready); endmodule";
    Ports::parse(text, "rac4i65_core", &[]).unwrap()
}

#[test]
fn the_top_module_joins_every_pin() {
    let board = Board::mesa_4i65_7i30();
    let text = top::wrapper(&board, "rac4i65", "rac4i65_core", &core()).unwrap();
    for part in [
        "inout wire [31:0] lad",
        "output wire [3:0] pwm",
        "assign lad = lad_drive ? lad_out : 32'bz;",
        ".clock(lclk)",
        ".lad_in(lad)",
        ".lad_out(lad_out)",
        ".pwm_3(pwm[3])",
        ".dir(dir)",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}

#[test]
fn a_core_that_does_not_fit_the_board_is_named() {
    let board = Board::mesa_4i65_7i30();
    let wrong = |change: fn(&mut Ports)| {
        let mut ports = core();
        change(&mut ports);
        top::wrapper(&board, "rac4i65", "rac4i65_core", &ports).unwrap_err().to_string()
    };
    assert!(wrong(|p| p.list.retain(|p| p.name != "ball_sensor")).contains("`ball_sensor`"));
    assert!(wrong(|p| p.list.retain(|p| p.name != "pwm_2")).contains("`pwm_0` to `pwm_3`"));
    assert!(wrong(|p| p.list.iter_mut().filter(|p| p.name == "dir").for_each(|p| p.width = 3)).contains("`dir` of 4"));
    assert!(wrong(|p| p.list[0].name = "tick".into()).contains("`clock`"));
    let mut extra = core();
    extra.list.push(hdl::emit::ports::Port { name: "beeper".into(), ..extra.list[3].clone() });
    let message = top::wrapper(&board, "rac4i65", "rac4i65_core", &extra).unwrap_err().to_string();
    assert!(message.contains("`beeper`"), "{message}");
}

#[test]
fn the_constraints_place_every_pin_once_with_its_buffer() {
    let text = ucf::ucf(&Board::mesa_4i65_7i30(), "rac4i65").unwrap();
    let places: Vec<_> = text.lines().filter_map(|l| l.split("LOC = \"").nth(1)?.split('"').next()).collect();
    // 7 control and clock pins, 32 LAD, 8 LEDs, 24 on P1, 12 on P3, 5 on P4.
    assert_eq!(places.len(), 88);
    assert_eq!(places.iter().collect::<BTreeSet<_>>().len(), 88);
    for line in [
        "NET \"lad<0>\" LOC = \"P153\" | IOSTANDARD = LVTTL | DRIVE = 8 | SLEW = FAST;",
        "NET \"led_n<7>\" LOC = \"P95\" | IOSTANDARD = LVTTL | DRIVE = 24 | SLEW = SLOW;",
        "NET \"encoder_a<0>\" LOC = \"P75\" | IOSTANDARD = LVTTL | PULLUP;  # P1 pin 7",
        "NET \"int_n\" LOC = \"P112\" | IOSTANDARD = LVTTL | DRIVE = 8 | SLEW = SLOW;",
        "TIMESPEC \"TS_lclk\" = PERIOD \"lclk\" 30 ns HIGH 50%;",
        "TIMESPEC \"TS_synclk\" = PERIOD \"synclk\" 20 ns HIGH 50%;",
        "OFFSET = IN 19.5 ns BEFORE \"lclk\";",
        "OFFSET = OUT 24 ns AFTER \"lclk\";",
    ] {
        assert!(text.lines().any(|l| l == line), "{line} is missing in\n{text}");
    }
}
