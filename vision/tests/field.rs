//! Fields from game logs.

use prost::Message;
use runs::vision::{FieldSize, GeometryData, WrapperPacket};
use vision::field::Field;

/// Head of a game log, then records of vision (type 4).
fn log(packets: &[WrapperPacket]) -> Vec<u8> {
    let mut bytes = b"SSL_LOG_FILE\0\0\0\x01".to_vec();
    for packet in packets {
        let message = packet.encode_to_vec();
        bytes.extend(1_000_u64.to_be_bytes());
        bytes.extend(4_u32.to_be_bytes());
        bytes.extend((message.len() as u32).to_be_bytes());
        bytes.extend(message);
    }
    bytes
}

fn packet(length: i32) -> WrapperPacket {
    let field = FieldSize {
        field_length: length,
        field_width: 9_000,
        goal_width: 1_800,
        goal_depth: 180,
        boundary_width: 300,
        penalty_area_depth: Some(1_800),
        penalty_area_width: Some(3_600),
        ..FieldSize::default()
    };
    WrapperPacket { geometry: Some(GeometryData { field, ..GeometryData::default() }), ..WrapperPacket::default() }
}

#[test]
fn the_first_geometry_of_a_log_counts_and_a_log_without_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let field = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        Field::of(&file).map_err(|error| error.to_string())
    };
    let empty = WrapperPacket::default();
    assert_eq!(field("a.log", &log(&[empty.clone(), packet(12_000), packet(9_000)])), Ok(Field::DIVISION_A));
    assert!(field("b.log", &log(&[empty])).unwrap_err().contains("no geometry message"));
    assert!(field("c.log", &log(&[packet(12)])).unwrap_err().contains("length: 0.012 m is not between 1 and 100 m"));
    assert!(field("d.log", &[0xff, 0xfe, 0, 1]).unwrap_err().contains("neither text nor a game log"));
}
