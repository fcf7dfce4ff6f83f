//! Other people's reader understands our MCAP: the Python library of the format's makers, with its protobuf
//! decoder, which knows our messages from the file alone.

use runs::output::Existing;
use runs::robot::Robot;
use runs::{Layout, Run};
use std::path::Path;
use std::process::Command;

const SCRIPT: &str = r#"
import math
import sys
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from google.protobuf.descriptor_pb2 import FileDescriptorSet
units = {}
ticks, poses, drawn, counts, duty, topics = 0, 0, 0, 0, 0.0, set()
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
        elif channel.topic == "/racbot/camera":
            poses += 1
            x, y, theta = decoded.cam_x, decoded.cam_y, decoded.cam_theta
        else:
            # What 3D views draw: the same place, and x forward.
            drawn += 1
            if schema.name == "foxglove.PoseInFrame":
                assert decoded.frame_id == "field"
                place, turn = decoded.pose.position, decoded.pose.orientation
            else:
                assert (decoded.parent_frame_id, decoded.child_frame_id) == ("field", "robot")
                place, turn = decoded.translation, decoded.rotation
            assert decoded.timestamp.ToNanoseconds() == message.log_time
            assert abs(place.x - x) + abs(place.y - y) < 1e-12
            off = 2 * math.atan2(turn.z, turn.w) - theta - math.pi / 2
            assert abs(math.remainder(off, 2 * math.pi)) < 1e-9
    assert drawn == 2 * poses
    assert reader.get_summary().statistics.message_count == ticks + 3 * poses
    robot, = reader.iter_attachments()
    assert robot.name == "robot.toml" and b"wheel_radius_m" in robot.data
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
    let layout = Layout {
        command: true,
        references: 3,
        counts: 3,
        duties: 3,
        supply: run.supply_v.is_some(),
        camera: true,
        ..Layout::default()
    };
    let mut stream = runs::create(&path, layout, 0, Existing::Refuse).unwrap();
    stream.attach("robot.toml", &Robot::racbot().to_toml()).unwrap();
    run.stream_to(&mut *stream).unwrap();
    assert_eq!(Run::read(&path).unwrap().len(), run.len());
    let output = python(&["-c", SCRIPT, path.to_str().unwrap()]).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let duty = (run.duty[0].iter().sum::<f64>() * 1e6).round() / 1e6;
    let expected = format!(
        "{} {} {} {duty} foxglove.FrameTransform foxglove.PoseInFrame racbot.Camera racbot.Tick",
        run.len(),
        run.camera.len(),
        run.counts[2].iter().sum::<i64>()
    );
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected);
}
