//! Temporary: train/eval on caches.
use vision::ball::*;
use vision::picture::Picture;
fn load(p: &str) -> Vec<(Picture, Vec<(Region, f64)>)> {
    let d = std::fs::read(p).unwrap();
    let mut i = 0;
    let mut v = vec![];
    let f = |i: &mut usize| {
        let x = f64::from_le_bytes(d[*i..*i + 8].try_into().unwrap());
        *i += 8;
        x
    };
    while i + 4 < d.len() {
        let n = u32::from_le_bytes(d[i..i + 4].try_into().unwrap());
        i += 4;
        let mut l = vec![];
        for _ in 0..n {
            let r = Region { x: f(&mut i), y: f(&mut i), width: f(&mut i), height: f(&mut i) };
            let vis = f(&mut i);
            l.push((r, vis));
        }
        let e = i + 224 * 224 * 3;
        if e > d.len() {
            break;
        }
        let px = d[i..e].as_chunks::<3>().0.to_vec();
        i = e;
        v.push((Picture::new(224, 224, px).unwrap(), l));
    }
    v
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let set = load(&a[1]);
    let least = 0.02;
    // best-overlap of any candidate
    let edges = [0.0, 5.0, 8.0, 12.0, 20.0, 40.0, 500.0];
    let mut n = [0; 6];
    let mut cand = [0; 6];
    let mut cand7 = [0; 6];
    let mut dets: Vec<(f64, bool, f64)> = vec![]; // score, tp, size (ignore removed)
    let mut big = 0;
    let mut bias = vec![vec![]; 6];
    let t = std::time::Instant::now();
    let mut dump: Vec<(f64, usize, Region, bool)> = vec![];
    for (k, (p, l)) in set.iter().enumerate() {
        let c = candidates(p);
        for (r, vis) in l {
            if *vis < 0.4 {
                continue;
            }
            let s = r.width.max(r.height);
            let b = edges.windows(2).position(|w| s >= w[0] && s < w[1]).unwrap();
            n[b] += 1;
            let o = c.iter().map(|c| c.region.overlap(r)).fold(0.0, f64::max);
            if let Some(c) = c
                .iter()
                .filter(|c| c.region.overlap(r) > 0.3)
                .max_by(|x, y| x.region.overlap(r).total_cmp(&y.region.overlap(r)))
            {
                if *vis > 0.9 {
                    bias[b].push([
                        c.region.width - r.width,
                        c.region.height - r.height,
                        c.region.x - r.x,
                        c.region.y - r.y,
                    ]);
                }
            }
            if o > 0.5 {
                cand[b] += 1
            } else if s > 8.0 {
                dump.push((o, k, *r, true));
            }
            if o > 0.7 {
                cand7[b] += 1
            }
            if s > 8.0 {
                big += 1;
            }
        }
        let mut used = vec![false; l.len()];
        for d in find(p, least) {
            let m = (0..l.len())
                .filter(|&i| !used[i])
                .map(|i| (l[i].0.overlap(&d.region), i))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match m {
                Some((o, i)) if o > 0.5 => {
                    used[i] = true;
                    let s = l[i].0.width.max(l[i].0.height);
                    if s > 8.0 && l[i].1 >= 0.4 {
                        dets.push((d.score, true, s));
                    }
                }
                Some((o, i)) if o > 0.1 && (l[i].1 < 0.4 || l[i].0.width.max(l[i].0.height) <= 8.0) => {}
                _ => {
                    dets.push((d.score, false, d.region.width.max(d.region.height)));
                    dump.push((d.score, k, d.region, false));
                }
            }
        }
    }
    eprintln!("time per picture {:?}", t.elapsed() / set.len() as u32);
    for b in 0..6 {
        eprintln!(
            "{:5}..{:5}: {:4} balls, candidate IoU>.5 {:.3} >.7 {:.3}",
            edges[b],
            edges[b + 1],
            n[b],
            cand[b] as f64 / n[b] as f64,
            cand7[b] as f64 / n[b] as f64
        );
    }
    for b in 0..6 {
        let m: Vec<f64> = (0..4)
            .map(|i| {
                let mut v: Vec<f64> = bias[b].iter().map(|r: &[f64; 4]| r[i]).collect();
                v.sort_by(f64::total_cmp);
                *v.get(v.len() / 2).unwrap_or(&0.)
            })
            .collect();
        eprintln!("bias {} {:.2?}", edges[b], m);
    }
    for th in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9] {
        let tp = dets.iter().filter(|d| d.0 >= th && d.1).count();
        let fp = dets.iter().filter(|d| d.0 >= th && !d.1).count();
        let fpb = dets.iter().filter(|d| d.0 >= th && !d.1 && d.2 > 8.0).count();
        eprintln!(
            "score {th}: recall {:.3} precision {:.3} (>8 px only {:.3})",
            tp as f64 / big as f64,
            tp as f64 / (tp + fp) as f64,
            tp as f64 / (tp + fpb) as f64
        );
    }
    if a.len() > 2 {
        // sheet of failures: missed (candidate none) and strongest false ones
        dump.sort_by(|x, y| y.0.total_cmp(&x.0));
        let sel: Vec<_> = if a[2] == "fp" {
            dump.iter().filter(|d| !d.3).take(24).collect()
        } else {
            dump.iter().filter(|d| d.3).take(24).collect()
        };
        let (nx, ny, s) = (6, 4, 224);
        let mut out = vec![0_u8; nx * s * ny * s * 3];
        for (q, d) in sel.iter().enumerate() {
            eprintln!("{q}: pic {} score/iou {:.2} {:?}", d.1, d.0, d.2);
            let px = set[d.1].0.pixels();
            for (i, p) in px.iter().enumerate() {
                let (x, y) = ((q % nx) * s + i % s, (q / nx) * s + i / s);
                out[(y * nx * s + x) * 3..][..3].copy_from_slice(p);
            }
            let (x0, x1, y0, y1) = (
                d.2.x - d.2.width / 2. - 1.,
                d.2.x + d.2.width / 2. + 1.,
                d.2.y - d.2.height / 2. - 1.,
                d.2.y + d.2.height / 2. + 1.,
            );
            let mut put = |x: f64, y: f64| {
                if x >= 0. && y >= 0. && x < 224. && y < 224. {
                    let (x, y) = ((q % nx) * s + x as usize, (q / nx) * s + y as usize);
                    out[(y * nx * s + x) * 3..][..3].copy_from_slice(&[255, 0, 255]);
                }
            };
            let mut t = x0;
            while t <= x1 {
                put(t, y0);
                put(t, y1);
                t += 1.;
            }
            let mut t = y0;
            while t <= y1 {
                put(x0, t);
                put(x1, t);
                t += 1.;
            }
        }
        let mut e = png::Encoder::new(
            std::io::BufWriter::new(std::fs::File::create(&a[3]).unwrap()),
            (nx * s) as u32,
            (ny * s) as u32,
        );
        e.set_color(png::ColorType::Rgb);
        e.write_header().unwrap().write_image_data(&out).unwrap();
    }
}
