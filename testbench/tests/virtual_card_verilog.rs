//! The emitted Verilog behind the virtual card: from the driver's register writes to turning wheels, all through
//! pins.

use driver::load::{Options, load};
use driver::{Board, PciCard, RegisterWindow, Scale, Settings};
use runs::frames::Twist;
use runs::robot::Robot;
use simulator::circuit::committed;
use simulator::virtual_card::VirtualCard;
use std::time::Duration;

/// A slow bus clock: 5,000 clocks a control tick.
const CLOCK_HZ: f64 = 1e6;

#[test]
fn compiled_verilog_turns_the_wheels_and_its_watchdog_stops_them() {
    let robot = Robot { control_rate_hz: 200.0, ..Robot::racbot() };
    let mut card = VirtualCard::new(&robot).unwrap().with_clock(CLOCK_HZ).with_verilog().unwrap();
    let loaded = load(&mut card, &committed(), &Options::default(), |_| {}).unwrap();
    assert!((loaded.clock_hz / CLOCK_HZ - 1.0).abs() < 2e-3, "{}", loaded.clock_hz);

    let scale = Scale::new(&robot, loaded.clock_hz).unwrap();
    let mut board = Board::new(RegisterWindow::new(card));
    board.configure(&scale, &Settings::default()).unwrap();
    board.bus.card.sleep(Duration::from_millis(11));
    board.arm().unwrap();
    for _ in 0..160 {
        board.set_twist(&scale, Twist { vx: 0.2, vy: 0.4, omega: 0.0 }).unwrap();
        board.bus.card.sleep(Duration::from_millis(5));
    }
    let snapshot = board.snapshot().unwrap();
    assert!(snapshot.status.armed && snapshot.faults == 0, "{snapshot:?}");
    let twist = board.bus.card.machine().plant().twist();
    assert!((twist.vx - 0.2).abs() < 0.05 && (twist.vy - 0.4).abs() < 0.05 && twist.omega.abs() < 0.3, "{twist:?}");
    board.bus.card.sleep(Duration::from_millis(60));
    assert!(!board.status().unwrap().armed, "the watchdog sleeps");
    board.bus.card.sleep(Duration::from_secs(1));
    let slower = board.bus.card.machine().plant().twist();
    assert!(slower.vy < twist.vy, "{slower:?}");
    assert_eq!(board.bus.card.failure(), None);
}
