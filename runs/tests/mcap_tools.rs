//! Other people's reader understands our MCAP: the Python library of the format's makers, with its protobuf
//! decoder, which knows our messages from the file alone.

use runs::Run;
use std::path::Path;
use std::process::Command;

const SCRIPT: &str = r#"
import sys
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from google.protobuf.descriptor_pb2 import FileDescriptorSet
units = {}
ticks, poses, counts, duty, topics = 0, 0, 0, 0.0, set()
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
    for schema in reader.get_summary().schemas.values():
        for file in FileDescriptorSet.FromString(schema.data).file:
            for place in file.source_code_info.location:
                field = file.message_type[place.path[1]].field[place.path[3]]
                units[field.name] = place.leading_comments.strip()
    assert [units[name] for name in ("t", "cmd_vx", "ref_1", "enc_3", "cam_theta")] == ["s", "m/s", "rad/s", "counts", "rad"]
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        topics.add(schema.name)
        if channel.topic == "/racbot/tick":
            assert abs(message.log_time * 1e-9 - decoded.t) < 1e-8
            ticks, counts, duty = ticks + 1, counts + decoded.enc_3, duty + decoded.duty_1
            assert not decoded.HasField("supply_v") or decoded.supply_v > 0
        else:
            poses += 1
    assert reader.get_summary().statistics.message_count == ticks + poses
print(ticks, poses, counts, round(duty, 6), *sorted(topics))
"#;

#[test]
fn the_python_library_reads_every_tick_and_pose() {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).output();
    if !python(&["-c", "import mcap_protobuf"]).is_ok_and(|output| output.status.success()) {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "pip install mcap-protobuf-support");
        eprintln!("NOT RUN: pip install mcap-protobuf-support");
        return;
    }
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew/run_01.csv");
    let run = Run::read(data).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    run.write(&path).unwrap();
    let output = python(&["-c", SCRIPT, path.to_str().unwrap()]).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let duty = (run.duty[0].iter().sum::<f64>() * 1e6).round() / 1e6;
    let expected = format!(
        "{} {} {} {duty} racbot.Camera racbot.Tick",
        run.len(),
        run.camera.len(),
        run.counts[2].iter().sum::<i64>()
    );
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected);
}
