//! Signed permutations of wheels.

use runs::geometry::Geometry;

/// Share of a wheel's part in the motion by which two of them are no mirror images: drawings are rounded.
const SAME: f64 = 0.01;

/// Wheel and sign that every row of a log may truly be of: all orders with all signs (8 for two wheels, 48 for three, 384
/// for four), the given one first; for more wheels than four only single reversals and swaps.
pub fn orders(wheels: usize) -> Vec<Vec<(usize, f64)>> {
    let plain: Vec<(usize, f64)> = (0..wheels).map(|w| (w, 1.0)).collect();
    if wheels > 4 {
        let reversed = (0..wheels).map(|w| {
            let mut order = plain.clone();
            order[w].1 = -1.0;
            order
        });
        let swapped = (0..wheels).flat_map(|a| (a + 1..wheels).map(move |b| (a, b))).map(|(a, b)| {
            let mut order = plain.clone();
            order.swap(a, b);
            order
        });
        return std::iter::once(plain.clone()).chain(reversed).chain(swapped).collect();
    }
    let mut permutations: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..wheels {
        let longer = |p: Vec<usize>| {
            (0..wheels).filter(|w| !p.contains(w)).map(|w| [p.clone(), vec![w]].concat()).collect::<Vec<_>>()
        };
        permutations = permutations.into_iter().flat_map(longer).collect();
    }
    let signed = |p: &Vec<usize>| {
        let p = p.clone();
        (0..1_usize << wheels).map(move |signs| {
            p.iter().enumerate().map(|(i, w)| (*w, if signs >> i & 1 == 1 { -1.0 } else { 1.0 })).collect()
        })
    };
    permutations.iter().flat_map(signed).collect()
}

/// Wheels that an order moves or reverses, from 0.
pub(super) fn moved(order: &[(usize, f64)]) -> Vec<usize> {
    (0..order.len()).filter(|i| order[*i] != (*i, 1.0)).collect()
}

/// Whether every wheel turns the other way and none is another.
pub(super) fn all_reversed(order: &[(usize, f64)]) -> bool {
    order.iter().enumerate().all(|(i, (wheel, sign))| *wheel == i && *sign < 0.0)
}

/// In words, such as "enc_2 and enc_3 are swapped, enc_1 is reversed".
pub(super) fn words(order: &[(usize, f64)]) -> String {
    let mut parts = Vec::new();
    for (i, (wheel, sign)) in order.iter().enumerate() {
        if *wheel > i && order[*wheel].0 == i {
            parts.push(format!("enc_{} and enc_{} are swapped", i + 1, wheel + 1));
        } else if *wheel != i && order[*wheel].0 != i {
            parts.push(format!("enc_{} counts for wheel {}", i + 1, wheel + 1));
        }
        if *sign < 0.0 {
            parts.push(format!("enc_{} is reversed", i + 1));
        }
    }
    parts.join(", ")
}

/// Whether an order makes of what the counts say its mirror image, along the robot or across: poses that are mirrored look the same.
pub(super) fn mirrors(geometry: &Geometry, order: &[(usize, f64)]) -> bool {
    let wheels = order.len();
    let alone = |wheel: usize, turned: f64| {
        let mut turns = vec![0.0; wheels];
        turns[wheel] = turned;
        let twist = geometry.twist(&turns);
        [twist.vx, twist.vy, twist.omega]
    };
    let largest = (0..wheels).flat_map(|i| alone(i, 1.0)).fold(0.0, |most: f64, x| most.max(x.abs()));
    let by = |mirror: [f64; 3]| {
        order.iter().enumerate().all(|(i, (wheel, sign))| {
            let [image, ordered] = [alone(i, 1.0), alone(*wheel, *sign)];
            (0..3).all(|k| (mirror[k] * image[k] - ordered[k]).abs() < SAME * largest)
        })
    };
    by([-1.0, 1.0, -1.0]) || by([1.0, -1.0, -1.0])
}
