//! How the weight is shared between the wheels while the robot accelerates.

/// Normal loads of wheels whose forces lie in a plane: `N = c0 + c1·x + c2·y`, the only solution for three wheels and the
/// one of equally soft suspensions for more.
#[derive(Clone, Debug)]
pub(crate) struct LoadShare {
    /// For every wheel: load per weight, per moment about y, per moment about x.
    rows: Vec<[f64; 3]>,
    weight: f64,
    height: f64,
}

impl LoadShare {
    /// Wheels at `places` (m, from the centre of mass), weight in N, height of the centre of mass in m.
    pub(crate) fn new(places: &[[f64; 2]], weight: f64, height: f64) -> Self {
        let mut moments = [[0.0; 3]; 3];
        for &[x, y] in places {
            let basis = [1.0, x, y];
            for (row, a) in moments.iter_mut().zip(basis) {
                for (cell, b) in row.iter_mut().zip(basis) {
                    *cell += a * b;
                }
            }
        }
        let inverse = invert(moments);
        let rows = places
            .iter()
            .map(|&[x, y]| {
                let mut row = [0.0; 3];
                for (k, cell) in row.iter_mut().enumerate() {
                    *cell = inverse[0][k] + x * inverse[1][k] + y * inverse[2][k];
                }
                row
            })
            .collect();
        Self { rows, weight, height }
    }

    /// Load of wheel `i`, N, while the ground pushes the robot with `[fx, fy]` (body frame, N); never negative.
    pub(crate) fn of(&self, i: usize, [fx, fy]: [f64; 2]) -> f64 {
        let [w, mx, my] = self.rows[i];
        (w * self.weight - self.height * (mx * fx + my * fy)).max(0.0)
    }
}

/// Inverse of a symmetric 3×3 matrix; wheels on one line give a ridge instead of a division by zero.
fn invert(mut m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    for (i, row) in m.iter_mut().enumerate() {
        row[i] += 1e-12;
    }
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    let mut out = [[0.0; 3]; 3];
    for (r, row) in out.iter_mut().enumerate() {
        for (c, cell) in row.iter_mut().enumerate() {
            *cell = cofactor(c, r) / determinant;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_carry_the_weight_and_balance_the_moments() {
        let places = [[0.0, 0.09], [-0.07, -0.05], [0.08, -0.04], [0.01, 0.02]];
        for count in [3, 4] {
            let share = LoadShare::new(&places[..count], 20.0, 0.04);
            let push = [3.0, -2.0];
            let loads: Vec<f64> = (0..count).map(|i| share.of(i, push)).collect();
            let moment = |axis: usize| loads.iter().zip(&places).map(|(n, p)| n * p[axis]).sum::<f64>();
            assert!((loads.iter().sum::<f64>() - 20.0).abs() < 1e-6);
            assert!((moment(0) + 0.04 * push[0]).abs() < 1e-6 && (moment(1) + 0.04 * push[1]).abs() < 1e-6);
        }
    }
}
