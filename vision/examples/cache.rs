//! Temporary.
use std::io::Write;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (first, last): (u64, u64) = (a[2].parse().unwrap(), a[3].parse().unwrap());
    let mut f = std::io::BufWriter::new(std::fs::File::create(&a[1]).unwrap());
    for seed in first..last {
        let s = vision::render::sample(seed, 224, 224);
        f.write_all(&(s.rendered.balls.len() as u32).to_le_bytes()).unwrap();
        for b in &s.rendered.balls {
            for v in [b.region.x, b.region.y, b.region.width, b.region.height, b.visible] {
                f.write_all(&v.to_le_bytes()).unwrap();
            }
        }
        f.write_all(s.rendered.picture.pixels().as_flattened()).unwrap();
    }
}
