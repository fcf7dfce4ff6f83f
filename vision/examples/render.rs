//! Renders pictures into a folder, with labels beside them as `labelled` reads them:
//!
//! ```sh
//! cargo run --release -p vision --example render -- FIRST LAST FOLDER
//! ```
//!
//! Pictures of the seeds from FIRST to before LAST. A ball of which little is seen is of class 1: neither to be found nor a
//! mistake.

use rayon::prelude::*;
use std::fmt::Write as _;
use std::path::Path;
use vision::render::sample;

/// Side of the pictures, pixels.
const SIDE: usize = 224;
/// Less of a ball than this is no ball and no mistake either.
const VISIBLE: f64 = 0.4;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [first, last, folder] = &arguments[..] else { panic!("give FIRST LAST FOLDER") };
    let number = |text: &str| text.parse::<u64>().expect("FIRST and LAST are whole numbers");
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder).expect("the folder can be made");
    (number(first)..number(last)).into_par_iter().for_each(|seed| {
        let rendered = sample(seed, SIDE, SIDE).rendered;
        let mut labels = String::new();
        for label in &rendered.balls {
            let [x, y, width, height] =
                [label.region.x, label.region.y, label.region.width, label.region.height].map(|c| c / SIDE as f64);
            let class = u8::from(label.visible < VISIBLE);
            writeln!(labels, "{class} {x:.5} {y:.5} {width:.5} {height:.5}").expect("memory takes a line");
        }
        std::fs::write(folder.join(format!("{seed:06}.txt")), labels).expect("the folder can be written to");
        let file = std::fs::File::create(folder.join(format!("{seed:06}.png"))).expect("the folder can be written to");
        let mut encoder = png::Encoder::new(file, SIDE as u32, SIDE as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a picture has a header");
        writer.write_image_data(rendered.picture.pixels().as_flattened()).expect("the folder can be written to");
    });
}
