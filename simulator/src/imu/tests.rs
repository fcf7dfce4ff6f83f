use super::*;
use fixed_kin::imu_spi::{Inputs, Outputs};
use hdl::stimulus::imu_spi::hardware;

fn started() -> VirtualImu {
    let mut sensor = VirtualImu::new(1_000.0, 5);
    for (register, value) in [(INT_SOURCE0, 0x08), (GYRO_CONFIG0, 0x03), (ACCEL_CONFIG0, 0x03), (PWR_MGMT0, 0x0F)] {
        sensor.access(u16::from(register) << 8 | u16::from(value as u8));
    }
    sensor
}

#[test]
fn it_says_who_it_is_and_has_no_data_before_it_is_switched_on() {
    let mut sensor = VirtualImu::new(1_000.0, 1);
    assert_eq!(sensor.access(0xF500), 0x47);
    sensor.feel(&Motion::default(), 33_333_333.0);
    assert_eq!(sensor.sample(TEMP_DATA1), Sample { age: NO_AGE, words: [INVALID; WORDS] });
    sensor.access(u16::from(PWR_MGMT0) << 8 | 0x0F);
    sensor.feel(&Motion::default(), 33_333_333.0);
    let up = sensor.sample(TEMP_DATA1).words[3] as i16;
    assert!((i32::from(up) - 2_048).abs() < 200, "{up}");
    sensor.access(u16::from(DEVICE_CONFIG) << 8 | 1);
    assert_eq!(sensor.access(0xCE00), 0, "reset switches it off");
}

#[test]
fn range_and_self_test_are_in_its_words() {
    let mut sensor = started();
    let mean = |sensor: &mut VirtualImu, word: usize| {
        let all = (0..400).map(|_| {
            sensor.feel(&Motion::default(), 33_333_333.0);
            f64::from(sensor.sample(TEMP_DATA1).words[word] as i16)
        });
        all.sum::<f64>() / 400.0
    };
    let (coarse, still) = (mean(&mut sensor, 3), mean(&mut sensor, 6));
    sensor.access(u16::from(ACCEL_CONFIG0) << 8 | 0x63);
    assert!((mean(&mut sensor, 3) / coarse - 8.0).abs() < 0.05, "±2 g");
    sensor.access(u16::from(SELF_TEST_CONFIG) << 8 | 0x04);
    // 100 °/s of 2000 °/s in 32768 units.
    assert!((mean(&mut sensor, 6) - still - 1_638.4).abs() < 3.0);
}

/// The block of the gateware, the lines, the sensor: every byte that the sensor means is what the snapshot holds.
#[test]
fn the_gateware_reads_over_the_lines_what_the_sensor_means() {
    let mut block = hardware();
    let mut pins = SpiPins::new(started());
    let mut outputs =
        Outputs { cs_n: true, sclk: true, mosi: false, busy: false, reading: false, value: 0, read_data: 0 };
    let mut miso = true;
    let mut run = |inputs: Inputs, pins: &mut SpiPins, clocks: u32| {
        for clock in 0..clocks {
            let first = clock == 0;
            outputs = block(&Inputs { tick: inputs.tick && first, access: inputs.access && first, miso, ..inputs });
            miso = pins.see(outputs.cs_n, outputs.sclk, outputs.mosi);
        }
        outputs
    };
    for (half, idle_high) in (0..4).flat_map(|half| [(half, false), (half, true)]) {
        let off = Inputs { half, idle_high, first: TEMP_DATA1, bank: 1, ..Inputs::default() };
        run(off, &mut pins, 4);
        let who = run(Inputs { access: true, command: 0xF500, ..off }, &mut pins, 150);
        assert_eq!(who.value, 0x47, "half {half}, mode 3 {idle_high}");
        run(Inputs { access: true, command: 0x5063, ..off }, &mut pins, 150);
        assert_eq!(run(Inputs { access: true, command: 0xD000, ..off }, &mut pins, 150).value, 0x63);
        run(Inputs { access: true, command: 0x5003, ..off }, &mut pins, 150);
        for turn in [0.3, -7.0, 40.0] {
            let on = Inputs { enable: true, ..off };
            run(on, &mut pins, 4);
            pins.sensor.feel(&Motion { omega: [0.0, 0.0, turn], ..Motion::default() }, 33_333_333.0);
            run(Inputs { tick: true, ..on }, &mut pins, 1_000);
            for (word, expected) in pins.sensor.sample(TEMP_DATA1).words.into_iter().enumerate() {
                let read = run(Inputs { read_bank: 1, read_word: word as u8 + 1, bank: 2, ..on }, &mut pins, 1);
                assert_eq!(read.read_data, expected, "word {word}, half {half}, mode 3 {idle_high}");
            }
            run(off, &mut pins, 4);
        }
    }
}

#[test]
fn what_a_robots_file_hides_is_in_the_words() {
    use runs::robot::{Effect, EffectParameter, ImuMount, SensorName};

    let words = |scale: f64| {
        let parameters = vec![("scale".to_owned(), EffectParameter { value: scale, ..EffectParameter::default() })];
        let hidden = Effect { name: "gyro-scale".to_owned(), parameters, ..Effect::default() };
        let imu = SensorName::new("icm-42688-p").map(ImuMount::upright);
        let robot = Robot { effects: vec![hidden], imu, ..Robot::racbot() };
        let mut sensor = VirtualImu::of_robot(&robot, 5).unwrap();
        sensor.access(u16::from(PWR_MGMT0) << 8 | 0x0F);
        sensor.feel(&Motion { omega: [0.0, 0.0, 10.0], ..Motion::default() }, 33_333_333.0);
        f64::from(sensor.sample(TEMP_DATA1).words[6] as i16)
    };
    // 10 rad/s of 34.9 in 32768 units, and a twentieth more.
    let (plain, hidden) = (words(0.0), words(0.05));
    assert!((plain - 9_387.0).abs() < 300.0 && (hidden - plain - 0.05 * 9_387.0).abs() < 15.0, "{plain} {hidden}");
}
