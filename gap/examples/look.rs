//! Prints the summary of data sets: `look FOLDER...`; with `-r` runs again on what it wrote.
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let again = std::env::args().any(|a| a == "-r");
    for path in std::env::args().skip(1).filter(|a| a != "-r") {
        let set = runs::DataSet::open(&path)?;
        let start = std::time::Instant::now();
        let a = gap::analyse(&set, &gap::Options::default())?;
        println!("=== {path}  {} {:.1}s\n{}", a.verdict.name(), start.elapsed().as_secs_f64(), a.terminal_summary());
        println!("{}", serde_json::to_string(&a.to_json()["gap"])?);
        println!("alternatives {:?} tried limits {}", a.alternatives, a.limits.len());
        if again {
            let robot = runs::robot::Robot::parse(&a.robot_text, "robot.toml".as_ref())?;
            let b = gap::analyse(&runs::DataSet { robot, ..set }, &gap::Options::default())?;
            println!("--- again {}\n{}", b.verdict.name(), b.terminal_summary());
            println!("AGAIN {path} first after {} second before {}", a.to_json()["gap"]["after"], b.to_json()["gap"]["before"]);
        }
    }
    Ok(())
}
