//! A start pose on the command line.

use runs::frames::Pose;

/// Coordinates that a place may have at most, m: what is beyond no robot reaches in an hour, and no table shows.
const FARTHEST_M: f64 = 10_000.0;

/// `X,Y,DEG`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start(pub(crate) Pose);

impl std::str::FromStr for Start {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text.split(',').filter_map(|field| field.trim().parse().ok()).collect();
        match numbers[..] {
            [x, y, degrees] if degrees.is_finite() && text.split(',').count() == 3 => {
                if ![x, y].iter().all(|n| n.abs() <= FARTHEST_M) {
                    return Err(format!("'{text}' is no place within {FARTHEST_M} m"));
                }
                Ok(Self(Pose::new(x, y, degrees.to_radians())))
            }
            _ => Err(format!("'{text}' is no pose; give x, y in metres and the heading in degrees, such as 1,0.5,90")),
        }
    }
}
