//! Texture: numbers that look random but depend on the place alone.

/// A number from 0 to 1 for a cell of a grid.
pub(super) fn cell(x: i64, y: i64, seed: u32) -> f64 {
    // The finaliser of MurmurHash3 on a mix of the coordinates.
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
        ^ u64::from(seed).wrapping_mul(0x1656_67b1_9e37_79f9);
    h ^= h >> 33;
    h = h.wrapping_mul(0xff51_afd7_ed55_8ccd);
    h ^= h >> 33;
    h = h.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    h ^= h >> 33;
    (h >> 11) as f64 / (1_u64 << 53) as f64
}

/// Smooth noise from 0 to 1 whose cells have side 1 (value noise, bilinear with smooth steps).
pub(super) fn smooth(x: f64, y: f64, seed: u32) -> f64 {
    let (cx, cy) = (x.floor(), y.floor());
    let step = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (step(x - cx), step(y - cy));
    let at = |dx: i64, dy: i64| cell(cx as i64 + dx, cy as i64 + dy, seed);
    let upper = at(0, 0) * (1.0 - fx) + at(1, 0) * fx;
    let lower = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
    upper * (1.0 - fy) + lower * fy
}
