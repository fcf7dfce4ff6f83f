//! The page of the blocks: what each one's file says of itself, and what it takes of the device.

use std::fmt::Write;

/// Blocks in reading order, each with its own source.
macro_rules! sources {
    ($($name:ident)*) => {
        &[$((stringify!($name), include_str!(concat!("../blocks/", stringify!($name), ".rs")))),*]
    };
}

const SOURCES: &[(&str, &str)] = sources!(
    core local_bus decoder register_file commit snapshot snapshot_address timebase interrupt safety clock_monitor encoder stall imu_spi
    sequencer multiplier divider trigonometry pwm kicker radio serial_receiver crc serial_host
);

/// What yosys 0.23 makes of each block by itself, `synth_xilinx -family xcv -flatten -nowidelut`; a test of the
/// testbench compares. Blocks inside others are counted there, too.
const RESOURCES: &str = include_str!("resources.csv");

/// LUT, inverters, flip-flops and block memories of a block, where they are known by itself.
pub fn resources(block: &str) -> Option<[usize; 4]> {
    let row = RESOURCES.lines().map(|line| line.split(',')).find(|row| row.clone().next() == Some(block))?;
    let numbers: Vec<usize> = row.skip(1).filter_map(|number| number.parse().ok()).collect();
    numbers.try_into().ok()
}

/// The page as markdown.
pub fn markdown() -> String {
    let mut page = String::from(
        "# Blocks\n\nEvery block of the gateware: what it does, its drawing or truth table, its timing and the registers it \
         serves, as the head of its file in `hdl/src/blocks` has it. Resources by yosys 0.23 for the XC2S200 (4704 LUT, 4704 \
         flip-flops, 14 block memories), each block synthesised by itself and mapped for area; four axes have four encoders, \
         stall detectors and PWM generators.\n\n\
         | block | LUT | inverters | FF | block memories |\n|---|---|---|---|---|\n",
    );
    for (name, _) in SOURCES {
        if let Some([luts, inverters, flip_flops, memories]) = resources(name) {
            let _ = writeln!(page, "| [{name}](#{name}) | {luts} | {inverters} | {flip_flops} | {memories} |");
        }
    }
    for (name, source) in SOURCES {
        let _ = write!(page, "\n## {name}\n\n");
        for line in source.lines().map_while(|line| line.strip_prefix("//!")) {
            page.push_str(line.strip_prefix(' ').unwrap_or(line));
            page.push('\n');
        }
        if let Some([luts, inverters, flip_flops, memories]) = resources(name) {
            let memory = if memories == 0 { String::new() } else { format!(", {memories} block memories") };
            let _ = writeln!(page, "\nTakes {luts} LUT, {inverters} inverters, {flip_flops} flip-flops{memory}.");
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_a_section() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/blocks");
        let page = markdown();
        for entry in std::fs::read_dir(folder).unwrap() {
            let file = entry.unwrap().file_name().into_string().unwrap();
            let name = file.strip_suffix(".rs").unwrap();
            let said = page.contains(&format!("\n## {name}\n"));
            assert!(said || name == "mod", "no section of {name}");
        }
        assert!(SOURCES.iter().all(|(_, source)| source.starts_with("//! ")));
        assert_eq!(resources("crc"), None, "counted where it stands");
        assert!(page.contains("stop_filter") || page.contains("emergency"), "the text of a file");
    }
}
