use super::*;
use fixed_kin::card::Card;
use runs::robot::{Axis, ImuMount, SensorName};

fn imu(axes: [Axis; 3]) -> Imu {
    let mount = ImuMount { axes, ..ImuMount::upright(SensorName::new("icm-42688-p").unwrap()) };
    Imu { kind: &ICM_42688_P, mount, clock_hz: 33_333_333.0, bias: [0.0; 3] }
}

const WORDS: Words = [333, 1_325, 2_048, 0, 0, 16_384, 0, 0xC000];

#[test]
fn words_become_si_in_the_bodys_axes() {
    let reading = imu(Axis::XYZ).reading(&WORDS).unwrap();
    assert!((reading.temperature_c - 35.0).abs() < 0.01);
    assert!((reading.acceleration[0] - 9.806_65).abs() < 1e-9);
    assert!((reading.gyro[0] - 1000.0_f64.to_radians()).abs() < 1e-9);
    assert!((reading.gyro[2] + 1000.0_f64.to_radians()).abs() < 1e-9);
    assert!(!reading.saturated);
    let [x, y, z] = Axis::XYZ;
    let turned = imu([y, x.opposite(), z]).reading(&WORDS).unwrap();
    assert!((turned.acceleration[1] + 9.806_65).abs() < 1e-9);
    assert!((imu(Axis::XYZ).age_s(&WORDS).unwrap() - 10e-6).abs() < 1e-7);
}

#[test]
fn silence_and_limits_are_told() {
    assert_eq!(imu(Axis::XYZ).reading(&[NO_AGE; 8]), None);
    let mut words = WORDS;
    words[7] = 0x8000;
    assert!(imu(Axis::XYZ).reading(&words).unwrap().saturated);
}

#[test]
fn every_type_is_found_by_its_name_and_by_its_answer() {
    for (index, one) in KINDS.iter().enumerate() {
        assert_eq!(kind(one.name), Some(*one));
        assert!(KINDS[..index].iter().all(|other| other.who_am_i != one.who_am_i));
    }
    assert_eq!(kind("mpu-6050"), None);
}

/// Time that passes only while somebody waits.
struct Waits(Duration);

impl Clock for Waits {
    fn now(&mut self) -> Duration {
        self.0
    }

    fn sleep_until(&mut self, at: Duration) {
        self.0 = self.0.max(at);
    }
}

/// The line's clock is the fastest of up to 9 MHz, and rests high, before anything is asked of the sensor.
#[test]
fn the_line_is_set_up_for_the_sensor() {
    let mount = imu(Axis::XYZ).mount;
    for (clock_hz, half) in [(16e6, 0), (33_333_333.0, 1), (100e6, 3)] {
        let mut board = Board::new(Card::new(0));
        let absent = board.start_imu(&mount, clock_hz, &mut Waits(Duration::ZERO));
        assert!(matches!(absent, Err(ImuError::Absent { .. })), "{absent:?}");
        let control = board.bus.read(map::IMU_CONTROL.offset);
        let fields = [map::IMU_MODE_3, map::IMU_HALF, map::IMU_FIRST].map(|field| field.of(control));
        assert_eq!(fields, [1, half, 0x1D], "{clock_hz} Hz");
    }
}
