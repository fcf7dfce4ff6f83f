//! ROS 2 bags in MCAP files. Series are named by topic and field: `/odom.x`, `.y`, `.theta` (heading of the forward axis),
//! `.vx`, `.vy`, `.w`; `/cmd_vel.vx`; `/joint_states.position.NAME`, `.velocity.NAME`, `.effort.NAME`; `/tf.PARENT.CHILD.x`;
//! `/imu.gyro_x`, `.acc_x`. Times are the headers' stamps, or where there are none those of the recording.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

use super::Table;
use super::cdr::Cdr;
use crate::columns::Column;
use crate::error::InputError;
use crate::mcap::{Topic, messages};

pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Table, InputError> {
    let broken = |what: String| InputError::new(path, what, "copy the file again, or recover it with `mcap recover`");
    if !bytes.starts_with(mcap::MAGIC) {
        let hint = "give the *.mcap of a bag (`ros2 bag convert` makes one of a *.db3)";
        return Err(InputError::new(path, "does not start as an MCAP file does", hint));
    }
    let mut table = Table::default();
    let mut others: HashSet<String> = HashSet::new();
    let mut topics: HashMap<u16, Option<Topic>> = HashMap::new();
    let (mut values, mut is_run) = (Vec::new(), false);
    let mut clocks: BTreeMap<String, Stamps> = BTreeMap::new();
    messages(bytes, broken, |message| {
        let kind = message.schema.map_or("", |s| s.name.as_str());
        let t = message.log_time as f64 * 1e-9;
        if message.channel.message_encoding != "cdr" || !is_known(kind) {
            let channel = message.channel;
            // Fields that are called as columns are, in protobuf or JSON: racbot's own recordings.
            let topic = topics.entry(channel.id).or_insert_with(|| Topic::of(channel, message.schema).ok());
            let known = topic.as_ref().is_some_and(|topic| topic.decode(message.data, &mut values).is_ok());
            let known = known && values.iter().any(|(column, _)| *column != Column::Time);
            if !known {
                others.insert(format!("{} ({kind})", channel.topic));
                return Ok(());
            }
            let columns: Vec<Column> = values.iter().map(|(column, _)| *column).collect();
            is_run |= Topic::has_tick(&columns);
            let stated = values.iter().find(|(column, _)| *column == Column::Time).map(|(_, value)| value.real());
            for (column, value) in values.iter().filter(|(column, _)| *column != Column::Time) {
                table.push(&column.name(), stated.unwrap_or(t), value.real());
            }
            return Ok(());
        }
        let topic = &message.channel.topic;
        let short = || broken(format!("topic {topic}: a message is shorter than a {kind}"));
        let stamp = decode(kind, topic, t, message.data, &mut table).ok_or_else(short)?;
        clocks.entry(topic.clone()).or_default().add(t, stamp);
        Ok(())
    })?;
    foreign(&mut table, &clocks);
    if table.series.is_empty() {
        let mut others: Vec<String> = others.into_iter().collect();
        others.sort();
        if others.is_empty() {
            return Err(broken("holds no whole message".to_owned()));
        }
        let what = format!("holds none of the messages that are read; it has {}", others.join(", "));
        let hint = "record Twist, TwistStamped, JointState, Odometry, PoseStamped, PoseWithCovarianceStamped, Pose2D, TF or Imu";
        return Err(InputError::new(path, what, hint));
    }
    if is_run {
        table
            .remarks
            .push("its fields are called as columns are: it is a run as it stands, and needs no map".to_owned());
    }
    Ok(table)
}

/// No message is under way for longer, s.
const UNDER_WAY_S: f64 = 60.0;

/// Times of a topic's messages.
struct Stamps {
    /// First and last by the recording, and by the messages.
    recorded: [f64; 2],
    stamped: [f64; 2],
    /// By how much the recording was later at least.
    later: f64,
}

impl Default for Stamps {
    fn default() -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self { recorded: none, stamped: none, later: f64::INFINITY }
    }
}

impl Stamps {
    fn add(&mut self, recorded: f64, stamp: f64) {
        for (ends, t) in [(&mut self.recorded, recorded), (&mut self.stamped, stamp)] {
            *ends = [ends[0].min(t), ends[1].max(t)];
        }
        self.later = self.later.min(recorded - stamp);
    }
}

/// Stamps that are of another time than all of the recording are of a computer whose clock is wrong: what came soonest was
/// recorded when it was stamped.
fn foreign(table: &mut Table, clocks: &BTreeMap<String, Stamps>) {
    let [first, last] = clocks.values().fold([f64::INFINITY, f64::NEG_INFINITY], |[first, last], stamps| {
        [first.min(stamps.recorded[0]), last.max(stamps.recorded[1])]
    });
    let length = (last - first).max(UNDER_WAY_S);
    for (topic, stamps) in clocks {
        if stamps.stamped[1] >= first - length && stamps.stamped[0] <= last + length {
            continue;
        }
        let own = |name: &str| name.strip_prefix(topic.as_str()).is_some_and(|rest| rest.starts_with('.'));
        for series in table.series.iter_mut().filter(|s| own(&s.name)) {
            series.t.iter_mut().for_each(|t| *t += stamps.later);
        }
        let off =
            format!("{topic}: its stamps are {:.0} s off the recording, by a clock that is wrong", stamps.later.abs());
        table.remarks.push(format!("{off}: they are moved to it"));
    }
}

const KNOWN: [&str; 11] = [
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/TwistStamped",
    "sensor_msgs/msg/JointState",
    "nav_msgs/msg/Odometry",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/Pose2D",
    "tf2_msgs/msg/TFMessage",
    "sensor_msgs/msg/Imu",
    "std_msgs/msg/Float64",
    "std_msgs/msg/Float32",
];

fn is_known(kind: &str) -> bool {
    KNOWN.contains(&kind)
}

/// Takes over a message; its stamp, or when it was recorded.
fn decode(kind: &str, topic: &str, recorded: f64, data: &[u8], table: &mut Table) -> Option<f64> {
    let mut cdr = Cdr::new(data)?;
    let mut put = |name: &str, field: &str, t: f64, value: f64| table.push(&format!("{name}.{field}"), t, value);
    // A stamp of zero was never set.
    let time = |stamp: f64| if stamp > 0.0 { stamp } else { recorded };
    let mut stamped = recorded;
    match kind {
        "geometry_msgs/msg/Twist" => {
            let twist = cdr.doubles::<6>()?;
            twist_of(twist, |field, value| put(topic, field, recorded, value));
        }
        "geometry_msgs/msg/TwistStamped" => {
            let t = time(cdr.header()?.0);
            stamped = t;
            let twist = cdr.doubles::<6>()?;
            twist_of(twist, |field, value| put(topic, field, t, value));
        }
        "nav_msgs/msg/Odometry" => {
            let t = time(cdr.header()?.0);
            stamped = t;
            cdr.text()?;
            let pose = cdr.doubles::<7>()?;
            cdr.skip_doubles(36)?;
            let twist = cdr.doubles::<6>()?;
            pose_of(pose, |field, value| put(topic, field, t, value));
            twist_of(twist, |field, value| put(topic, field, t, value));
        }
        "geometry_msgs/msg/PoseStamped" | "geometry_msgs/msg/PoseWithCovarianceStamped" => {
            let t = time(cdr.header()?.0);
            stamped = t;
            pose_of(cdr.doubles::<7>()?, |field, value| put(topic, field, t, value));
        }
        "geometry_msgs/msg/Pose2D" => {
            for (field, value) in ["x", "y", "theta"].into_iter().zip(cdr.doubles::<3>()?) {
                put(topic, field, recorded, value);
            }
        }
        "sensor_msgs/msg/JointState" => {
            let t = time(cdr.header()?.0);
            stamped = t;
            let names: Vec<String> = (0..cdr.length()?).map(|_| cdr.text()).collect::<Option<_>>()?;
            for quantity in ["position", "velocity", "effort"] {
                let number = cdr.length()? as usize;
                for i in 0..number {
                    let value = cdr.double()?;
                    if let Some(name) = names.get(i) {
                        put(topic, &format!("{quantity}.{name}"), t, value);
                    }
                }
            }
        }
        "tf2_msgs/msg/TFMessage" => {
            for _ in 0..cdr.length()? {
                let (stamp, parent) = cdr.header()?;
                let child = cdr.text()?;
                let pose = cdr.doubles::<7>()?;
                pose_of(pose, |field, value| put(topic, &format!("{parent}.{child}.{field}"), time(stamp), value));
            }
        }
        "sensor_msgs/msg/Imu" => {
            let t = time(cdr.header()?.0);
            stamped = t;
            cdr.skip_doubles(4 + 9)?;
            let gyro = cdr.doubles::<3>()?;
            cdr.skip_doubles(9)?;
            let acceleration = cdr.doubles::<3>()?;
            for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                put(topic, &format!("gyro_{axis}"), t, gyro[i]);
                put(topic, &format!("acc_{axis}"), t, acceleration[i]);
            }
        }
        "std_msgs/msg/Float64" => put(topic, "data", recorded, cdr.double()?),
        "std_msgs/msg/Float32" => put(topic, "data", recorded, cdr.float()?),
        _ => {}
    }
    Some(stamped)
}

/// Linear x, y, z, angular x, y, z.
fn twist_of(twist: [f64; 6], mut put: impl FnMut(&str, f64)) {
    put("vx", twist[0]);
    put("vy", twist[1]);
    put("w", twist[5]);
}

/// Position x, y, z, quaternion x, y, z, w.
fn pose_of([x, y, _, qx, qy, qz, qw]: [f64; 7], mut put: impl FnMut(&str, f64)) {
    put("x", x);
    put("y", y);
    put("theta", super::heading([qx, qy, qz, qw]));
}
