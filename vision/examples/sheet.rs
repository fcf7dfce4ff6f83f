//! Contact sheet of rendered pictures: `cargo run --release -p vision --example sheet -- OUT.png FIRST_SEED`.
use std::io::BufWriter;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let first: u64 = args[2].parse().expect("a seed");
    let (n, s) = (6, 224);
    let mut out = vec![0_u8; n * s * n * s * 3];
    for k in 0..n * n {
        let sample = vision::render::sample(first + k as u64, s, s);
        for (i, p) in sample.rendered.picture.pixels().iter().enumerate() {
            let (x, y) = ((k % n) * s + i % s, (k / n) * s + i / s);
            out[(y * n * s + x) * 3..][..3].copy_from_slice(p);
        }
    }
    let mut e = png::Encoder::new(
        BufWriter::new(std::fs::File::create(&args[1]).expect("file")),
        (n * s) as u32,
        (n * s) as u32,
    );
    e.set_color(png::ColorType::Rgb);
    e.write_header().expect("header").write_image_data(&out).expect("data");
}
