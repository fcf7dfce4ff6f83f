//! Analyses a data set: `analyse FOLDER [OUT]`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let folder = args.next().ok_or("usage: analyse FOLDER [OUT]")?;
    let set = runs::DataSet::open(folder)?;
    let analysis = gap::analyse(&set, &gap::Options::default())?;
    print!("{}", analysis.terminal_summary());
    if let Some(out) = args.next() {
        analysis.write(out)?;
    }
    Ok(())
}
