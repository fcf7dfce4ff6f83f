//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.

/// How many features there are.
pub const COUNT: usize = 20;

/// Odds of a candidate whose weights are all zero, logarithm.
pub(super) const OFFSET: f32 = -0.591;

/// Values of a feature at which its weight is given.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const KNOTS: [[f32; 9]; COUNT] = [
    [0.047, 0.103, 0.175, 0.190, 0.254, 0.341, 0.472, 0.521, 0.626], // redness inside
    [-53.221, 0.209, 6.035, 8.706, 16.897, 24.909, 33.625, 43.826, 48.783], // hue, degrees from red to yellow
    [0.018, 0.108, 0.134, 0.238, 0.354, 0.383, 0.467, 0.645, 0.898], // redness inside less outside
    [0.000, 0.594, 0.656, 0.826, 0.969, 1.000, 1.025, 1.050, 1.075], // outline: share of rays that agree
    [0.011, 0.024, 0.045, 0.054, 0.067, 0.091, 0.096, 0.121, 0.200], // outline: roughness, radii
    [0.630, 0.697, 0.851, 0.944, 0.991, 1.000, 1.010, 1.019, 1.028], // share of the inside that is red
    [0.000, 0.025, 0.050, 0.075, 0.100, 0.125, 0.275, 0.300, 1.000], // share of the surroundings that is red
    [0.000, 0.025, 0.050, 0.075, 0.500, 0.857, 0.929, 1.000, 1.025], // share of carpet below
    [0.000, 0.025, 0.050, 0.312, 0.633, 0.658, 0.867, 0.979, 1.004], // share of carpet around
    [-1.031, -0.813, -0.553, -0.285, -0.095, -0.025, 0.167, 0.476, 0.847], // width over height, logarithm
    [-0.377, -0.345, -0.003, 0.042, 0.201, 0.427, 0.500, 0.522, 0.544], // bottom below the field's boundary, heights of the picture
    [0.569, 0.797, 1.124, 1.198, 1.778, 2.422, 2.622, 3.001, 3.519], // size, logarithm of pixels
    [-0.066, 0.001, 0.010, 0.063, 0.097, 0.105, 0.139, 0.192, 0.279], // upper less lower brightness
    [0.037, 0.084, 0.122, 0.155, 0.167, 0.187, 0.245, 0.428, 0.550], // unevenness of colour inside
    [0.000, 0.012, 0.023, 0.035, 0.103, 0.175, 0.224, 0.403, 0.469], // redness of the reddest candidate less its own
    [0.594, 0.656, 0.781, 1.000, 1.010, 1.020, 1.030, 1.041, 1.051], // share of the outline in the picture
    [-0.774, -0.312, -0.091, -0.056, 0.045, 0.163, 0.307, 0.434, 0.466], // brightness over the carpet's, logarithm
    [0.300, 0.339, 0.509, 0.724, 0.772, 0.980, 1.376, 1.714, 1.853], // red over green against the carpet, logarithm
    [-1.090, -0.775, -0.325, -0.280, -0.103, 0.075, 0.295, 0.340, 0.732], // green over blue against the carpet, logarithm
    [0.029, 0.039, 0.057, 0.094, 0.141, 0.156, 0.226, 0.347, 0.393], // brightness outside against inside, unevenness
];

/// Logarithm of odds at each knot.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]
pub(super) const WEIGHTS: [[f32; 9]; COUNT] = [
    [-1.155, -0.667, -0.198, 0.133, 0.280, 0.226, 0.049, -0.177, -0.443], // redness inside
    [-2.128, -1.204, -0.318, 0.358, 0.771, 0.975, 0.848, 0.285, -0.492], // hue, degrees from red to yellow
    [-1.514, -1.208, -0.833, -0.351, 0.162, 0.631, 1.000, 1.287, 1.553], // redness inside less outside
    [-1.320, -0.911, -0.487, -0.125, -0.005, 0.003, 0.003, 0.003, 0.003], // outline: share of rays that agree
    [1.202, 0.970, 0.658, 0.220, -0.327, -0.722, -0.775, -0.775, -0.775], // outline: roughness, radii
    [-1.040, -0.583, -0.218, -0.021, 0.004, 0.010, 0.011, 0.011, 0.011], // share of the inside that is red
    [0.810, 0.810, 0.810, 0.677, 0.383, -0.059, -0.626, -1.224, -1.734], // share of the surroundings that is red
    [-0.074, -0.071, -0.071, -0.071, -0.071, -0.071, -0.071, -0.071, -0.065], // share of carpet below
    [-1.240, -1.191, -1.009, -0.576, -0.037, 0.277, 0.397, 0.397, 0.397], // share of carpet around
    [-1.356, -0.660, -0.022, 0.433, 0.641, 0.629, 0.301, -0.560, -1.725], // width over height, logarithm
    [-0.366, -0.366, -0.366, -0.366, -0.337, -0.176, 0.047, 0.190, 0.303], // bottom below the field's boundary, heights of the picture
    [-1.492, -0.740, -0.132, 0.108, 0.121, 0.138, 0.136, 0.033, -0.187], // size, logarithm of pixels
    [-2.946, -2.234, -1.154, 0.407, 1.554, 2.067, 2.257, 2.216, 2.049], // upper less lower brightness
    [-0.553, -0.443, -0.347, -0.237, -0.137, -0.031, -0.089, -0.158, -0.242], // unevenness of colour inside
    [0.456, 0.425, 0.348, 0.176, -0.073, -0.352, -0.605, -0.910, -1.198], // redness of the reddest candidate less its own
    [-0.992, -0.585, -0.216, -0.210, -0.164, -0.108, -0.055, -0.008, 0.035], // share of the outline in the picture
    [-1.710, -1.019, -0.397, 0.058, 0.259, 0.376, 0.364, 0.306, 0.221], // brightness over the carpet's, logarithm
    [-1.074, -0.686, -0.313, 0.000, 0.082, -0.048, -0.131, -0.124, -0.135], // red over green against the carpet, logarithm
    [-1.196, -0.959, -0.552, -0.044, 0.288, 0.427, 0.273, 0.016, -0.266], // green over blue against the carpet, logarithm
    [0.099, 0.251, 0.337, 0.300, 0.093, -0.248, -0.653, -1.031, -1.337], // brightness outside against inside, unevenness
];
