//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.

/// Number of features.
pub const COUNT: usize = 23;

/// Odds of a candidate whose weights are all zero, logarithm.
pub(super) const OFFSET: f32 = -0.498;

/// Values of a feature at which its weight is given.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const KNOTS: [[f32; 9]; COUNT] = [
    [0.047, 0.123, 0.166, 0.188, 0.269, 0.394, 0.522, 0.537, 0.663], // redness inside
    [-52.372, -13.298, 4.277, 13.420, 16.087, 21.537, 30.535, 43.024, 54.301], // hue, degrees from red to yellow
    [0.021, 0.112, 0.166, 0.242, 0.357, 0.392, 0.499, 0.723, 0.984], // redness inside less outside
    [0.000, 0.476, 0.656, 0.781, 0.969, 1.000, 1.025, 1.050, 1.075], // outline: share of rays that agree
    [0.010, 0.025, 0.046, 0.056, 0.067, 0.091, 0.096, 0.128, 0.200], // outline: roughness, radii
    [0.615, 0.648, 0.840, 0.946, 0.983, 0.997, 1.006, 1.016, 1.025], // share of the inside that is red
    [0.000, 0.025, 0.050, 0.075, 0.100, 0.125, 0.229, 0.254, 1.000], // share of the surroundings that is red
    [0.000, 0.025, 0.050, 0.075, 0.429, 0.786, 0.818, 1.000, 1.025], // share of carpet below
    [0.000, 0.025, 0.050, 0.125, 0.500, 0.525, 0.778, 0.972, 1.000], // share of carpet around
    [-0.981, -0.813, -0.525, -0.218, -0.023, 0.025, 0.236, 0.901, 0.949], // width over height, logarithm
    [-0.434, -0.349, -0.055, 0.015, 0.140, 0.374, 0.500, 0.523, 0.547], // bottom below the field's boundary, heights of the picture
    [0.554, 0.627, 1.052, 1.132, 1.685, 2.343, 2.661, 3.013, 3.495], // size, logarithm of pixels
    [-0.188, -0.103, -0.000, 0.059, 0.103, 0.142, 0.167, 0.201, 0.323], // upper less lower brightness
    [0.050, 0.063, 0.100, 0.147, 0.174, 0.187, 0.241, 0.459, 0.574], // unevenness of colour inside
    [0.000, 0.013, 0.026, 0.038, 0.090, 0.215, 0.234, 0.433, 0.512], // redness of the reddest candidate less its own
    [0.594, 0.656, 0.781, 1.000, 1.010, 1.020, 1.030, 1.041, 1.051], // share of the outline in the picture
    [-1.196, -0.450, -0.189, -0.103, 0.045, 0.164, 0.327, 0.395, 0.629], // brightness over the carpet's, logarithm
    [0.360, 0.409, 0.530, 0.750, 0.861, 1.103, 1.587, 1.797, 2.323], // red over green against the carpet, logarithm
    [-0.920, -0.693, -0.306, -0.233, -0.086, 0.093, 0.368, 0.466, 0.797], // green over blue against the carpet, logarithm
    [0.033, 0.058, 0.082, 0.109, 0.182, 0.238, 0.420, 0.882, 1.018], // brightness outside against inside, unevenness
    [-0.053, -0.047, -0.020, -0.001, 0.016, 0.025, 0.048, 0.086, 0.108], // outline: bulge towards the box's corners, radii
    [0.069, 0.126, 0.180, 0.292, 0.346, 0.512, 1.070, 1.409, 2.218], // outline: roughness, pixels
    [-3.000, -2.846, -2.056, -1.354, -0.781, 0.906, 1.507, 3.101, 3.255], // height over bottom below the field's boundary, logarithm
];

/// Logarithm of odds at each knot.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const WEIGHTS: [[f32; 9]; COUNT] = [
    [-1.045, -0.479, -0.027, 0.199, 0.198, 0.093, 0.045, -0.127, -0.398], // redness inside
    [-1.851, -0.947, -0.047, 0.579, 0.788, 0.691, 0.307, -0.215, -0.669], // hue, degrees from red to yellow
    [-1.593, -1.198, -0.693, -0.144, 0.337, 0.661, 1.032, 1.427, 1.722], // redness inside less outside
    [-0.929, -0.821, -0.656, -0.381, -0.124, 0.020, 0.020, 0.020, 0.020], // outline: share of rays that agree
    [0.998, 0.759, 0.463, 0.123, -0.211, -0.375, -0.375, -0.375, -0.375], // outline: roughness, radii
    [-0.871, -0.509, -0.206, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001], // share of the inside that is red
    [0.958, 0.816, 0.779, 0.667, 0.436, 0.044, -0.540, -1.199, -1.801], // share of the surroundings that is red
    [-0.753, -0.520, -0.354, -0.270, -0.270, -0.270, -0.270, -0.214, -0.143], // share of carpet below
    [-1.109, -0.785, -0.489, -0.136, 0.280, 0.560, 0.707, 0.733, 0.733], // share of carpet around
    [-1.580, -0.910, -0.249, 0.302, 0.551, 0.474, 0.128, -0.334, -0.597], // width over height, logarithm
    [-1.324, -0.866, -0.427, -0.139, -0.139, 0.014, 0.364, 0.533, 0.638], // bottom below the field's boundary, heights of the picture
    [-1.681, -0.982, -0.464, -0.157, 0.124, 0.444, 0.674, 0.567, 0.162], // size, logarithm of pixels
    [-1.611, -1.730, -1.451, -0.167, 0.959, 1.448, 1.553, 1.473, 1.314], // upper less lower brightness
    [0.266, 0.064, -0.169, -0.311, -0.347, -0.335, -0.330, -0.286, -0.180], // unevenness of colour inside
    [0.645, 0.557, 0.451, 0.287, 0.058, -0.279, -0.642, -0.960, -1.177], // redness of the reddest candidate less its own
    [-0.621, -0.300, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001], // share of the outline in the picture
    [-1.928, -1.240, -0.571, 0.004, 0.465, 0.677, 0.698, 0.724, 0.806], // brightness over the carpet's, logarithm
    [-0.524, -0.234, -0.049, -0.066, -0.186, -0.134, -0.157, -0.268, -0.403], // red over green against the carpet, logarithm
    [-1.146, -0.678, -0.220, 0.169, 0.370, 0.302, 0.061, -0.305, -0.742], // green over blue against the carpet, logarithm
    [0.068, 0.099, 0.048, -0.146, -0.464, -0.647, -0.488, -0.087, 0.354], // brightness outside against inside, unevenness
    [-0.128, -0.128, -0.128, -0.128, -0.150, -0.321, -0.769, -1.384, -2.034], // outline: bulge towards the box's corners, radii
    [-0.233, -0.233, -0.233, -0.233, -0.233, -0.233, -0.233, -0.233, -0.275], // outline: roughness, pixels
    [-0.961, -0.463, -0.064, 0.138, 0.123, -0.076, -0.204, -0.238, -0.263], // height over bottom below the field's boundary, logarithm
];
