//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.

use super::features::COUNT;

/// Odds of a candidate whose weights are all zero, logarithm.
pub(super) const OFFSET: f32 = -0.597;

/// Values of a feature at which its weight is given.
#[rustfmt::skip]
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
pub(super) const WEIGHTS: [[f32; 9]; COUNT] = [
    [-1.158, -0.677, -0.211, 0.117, 0.264, 0.223, 0.059, -0.154, -0.405], // redness inside
    [-2.121, -1.203, -0.327, 0.344, 0.762, 0.969, 0.849, 0.293, -0.482], // hue, degrees from red to yellow
    [-1.477, -1.172, -0.801, -0.333, 0.159, 0.605, 0.953, 1.220, 1.461], // redness inside less outside
    [-1.282, -0.818, -0.345, 0.075, 0.265, 0.320, 0.278, 0.195, 0.102], // outline: share of rays that agree
    [1.212, 0.935, 0.580, 0.109, -0.458, -0.880, -0.932, -0.717, -0.492], // outline: roughness, radii
    [-1.045, -0.633, -0.304, -0.126, -0.116, -0.111, -0.084, -0.050, -0.013], // share of the inside that is red
    [0.819, 0.786, 0.764, 0.625, 0.337, -0.089, -0.627, -1.193, -1.674], // share of the surroundings that is red
    [-0.080, 0.019, 0.067, 0.014, -0.201, -0.512, -0.749, -0.912, -0.977], // share of carpet below
    [-1.175, -1.117, -0.887, -0.342, 0.334, 0.786, 1.037, 1.042, 0.959], // share of carpet around
    [-1.285, -0.605, 0.022, 0.461, 0.650, 0.614, 0.263, -0.621, -1.802], // width over height, logarithm
    [-0.336, -0.372, -0.392, -0.412, -0.396, -0.258, -0.056, 0.092, 0.219], // bottom below the field's boundary, heights of the picture
    [-1.500, -0.742, -0.135, 0.100, 0.110, 0.128, 0.135, 0.050, -0.132], // size, logarithm of pixels
    [-2.951, -2.231, -1.146, 0.407, 1.551, 2.066, 2.263, 2.221, 2.045], // upper less lower brightness
    [-0.573, -0.451, -0.346, -0.226, -0.118, -0.020, -0.090, -0.160, -0.245], // unevenness of colour inside
    [0.438, 0.405, 0.329, 0.160, -0.087, -0.364, -0.619, -0.927, -1.217], // redness of the reddest candidate less its own
    [-0.998, -0.599, -0.244, -0.221, -0.165, -0.104, -0.050, -0.003, 0.040], // share of the outline in the picture
    [-1.710, -1.013, -0.394, 0.065, 0.272, 0.378, 0.350, 0.286, 0.201], // brightness over the carpet's, logarithm
    [-0.989, -0.639, -0.298, -0.010, 0.059, -0.076, -0.160, -0.150, -0.155], // red over green against the carpet, logarithm
    [-1.216, -0.974, -0.562, -0.047, 0.290, 0.430, 0.282, 0.036, -0.233], // green over blue against the carpet, logarithm
    [0.080, 0.225, 0.307, 0.277, 0.090, -0.235, -0.632, -1.008, -1.320], // brightness outside against inside, unevenness
];
