//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.

/// Number of features.
pub const COUNT: usize = 23;

/// Odds of a candidate whose weights are all zero, logarithm.
pub(super) const OFFSET: f32 = -0.523;

/// Values of a feature at which its weight is given.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const KNOTS: [[f32; 9]; COUNT] = [
    [0.048, 0.106, 0.171, 0.187, 0.256, 0.350, 0.473, 0.519, 0.688], // redness inside
    [-55.059, -8.522, 5.467, 8.151, 14.435, 22.492, 31.431, 41.094, 52.302], // hue, degrees from red to yellow
    [0.021, 0.113, 0.154, 0.242, 0.352, 0.385, 0.479, 0.686, 0.885], // redness inside less outside
    [0.000, 0.594, 0.656, 0.812, 0.969, 1.000, 1.025, 1.050, 1.075], // outline: share of rays that agree
    [0.010, 0.024, 0.043, 0.055, 0.067, 0.091, 0.096, 0.121, 0.200], // outline: roughness, radii
    [0.600, 0.655, 0.851, 0.948, 0.989, 0.999, 1.009, 1.019, 1.029], // share of the inside that is red
    [0.000, 0.025, 0.050, 0.075, 0.100, 0.125, 0.250, 0.275, 1.000], // share of the surroundings that is red
    [0.000, 0.025, 0.050, 0.143, 0.500, 0.857, 0.882, 1.000, 1.025], // share of carpet below
    [0.000, 0.025, 0.062, 0.375, 0.553, 0.667, 0.875, 1.000, 1.025], // share of carpet around
    [-0.986, -0.754, -0.552, -0.281, -0.035, 0.012, 0.194, 0.515, 0.879], // width over height, logarithm
    [-0.416, -0.354, -0.021, 0.063, 0.215, 0.423, 0.500, 0.523, 0.546], // bottom below the field's boundary, heights of the picture
    [0.568, 0.798, 1.108, 1.181, 1.787, 2.380, 2.598, 3.024, 3.459], // size, logarithm of pixels
    [-0.152, 0.001, 0.011, 0.062, 0.101, 0.139, 0.158, 0.185, 0.261], // upper less lower brightness
    [0.044, 0.090, 0.126, 0.156, 0.172, 0.189, 0.245, 0.332, 0.618], // unevenness of colour inside
    [0.000, 0.012, 0.025, 0.037, 0.095, 0.185, 0.221, 0.458, 0.499], // redness of the reddest candidate less its own
    [0.594, 0.656, 0.781, 1.000, 1.010, 1.020, 1.030, 1.041, 1.051], // share of the outline in the picture
    [-2.093, -0.302, -0.154, -0.090, 0.051, 0.167, 0.303, 0.407, 0.474], // brightness over the carpet's, logarithm
    [0.311, 0.356, 0.508, 0.723, 0.861, 0.971, 1.340, 1.820, 2.093], // red over green against the carpet, logarithm
    [-0.988, -0.689, -0.306, -0.253, -0.100, 0.086, 0.333, 0.415, 0.686], // green over blue against the carpet, logarithm
    [0.031, 0.051, 0.071, 0.092, 0.135, 0.210, 0.230, 0.380, 0.839], // brightness outside against inside, unevenness
    [0.000, 1.000, 2.000, 3.000, 4.000, 5.000, 6.000, 7.000, 8.000], // corners
    [0.000, 1.000, 2.000, 3.000, 4.000, 5.000, 6.000, 7.000, 8.000], // rough px
    [0.000, 1.000, 2.000, 3.000, 4.000, 5.000, 6.000, 7.000, 8.000], // ratio
];

/// Logarithm of odds at each knot.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const WEIGHTS: [[f32; 9]; COUNT] = [
    [-0.892, -0.466, -0.095, 0.047, 0.041, 0.090, 0.069, -0.100, -0.353], // redness inside
    [-1.892, -1.090, -0.236, 0.443, 0.877, 1.024, 0.690, -0.013, -0.848], // hue, degrees from red to yellow
    [-1.644, -1.285, -0.770, -0.153, 0.327, 0.699, 1.106, 1.504, 1.823], // redness inside less outside
    [-1.228, -0.778, -0.357, -0.091, -0.033, 0.010, 0.010, 0.010, 0.010], // outline: share of rays that agree
    [1.315, 1.015, 0.620, 0.156, -0.335, -0.660, -0.660, -0.660, -0.660], // outline: roughness, radii
    [-0.756, -0.442, -0.184, -0.074, -0.074, -0.047, -0.031, -0.014, 0.002], // share of the inside that is red
    [0.652, 0.558, 0.525, 0.417, 0.239, -0.056, -0.474, -0.935, -1.359], // share of the surroundings that is red
    [-1.035, -0.907, -0.851, -0.851, -0.851, -0.851, -0.851, -0.851, -0.774], // share of carpet below
    [-2.017, -1.531, -1.092, -0.609, -0.156, 0.107, 0.107, 0.107, 0.107], // share of carpet around
    [-1.401, -0.691, -0.034, 0.447, 0.675, 0.640, 0.269, -0.484, -1.430], // width over height, logarithm
    [-0.571, -0.500, -0.367, -0.168, -0.095, -0.076, -0.011, 0.036, 0.075], // bottom below the field's boundary, heights of the picture
    [-1.119, -0.606, -0.291, -0.179, -0.067, 0.141, 0.294, 0.297, 0.144], // size, logarithm of pixels
    [-2.692, -2.021, -1.019, 0.442, 1.506, 1.965, 2.034, 1.850, 1.660], // upper less lower brightness
    [-0.643, -0.462, -0.284, -0.070, 0.058, 0.099, 0.054, -0.189, -0.467], // unevenness of colour inside
    [0.427, 0.374, 0.360, 0.301, 0.065, -0.264, -0.600, -0.903, -1.111], // redness of the reddest candidate less its own
    [-0.397, -0.206, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001], // share of the outline in the picture
    [-1.621, -1.039, -0.424, 0.095, 0.397, 0.549, 0.526, 0.444, 0.347], // brightness over the carpet's, logarithm
    [-0.499, -0.176, 0.067, 0.067, -0.052, -0.211, -0.350, -0.457, -0.495], // red over green against the carpet, logarithm
    [-1.271, -0.857, -0.398, 0.021, 0.234, 0.325, 0.187, 0.051, -0.004], // green over blue against the carpet, logarithm
    [0.672, 0.696, 0.687, 0.525, 0.271, -0.127, -0.638, -1.207, -1.821], // brightness outside against inside, unevenness
    [0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000], // corners
    [0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000], // rough px
    [0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000, 0.000], // ratio
];
