//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.

use super::features::COUNT;

/// Odds of a candidate whose weights are all zero, logarithm.
pub(super) const OFFSET: f32 = -0.595;

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
    [-0.067, 0.001, 0.010, 0.063, 0.091, 0.103, 0.139, 0.192, 0.279], // upper less lower brightness
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
    [-1.158, -0.675, -0.208, 0.119, 0.260, 0.220, 0.059, -0.149, -0.396], // redness inside
    [-2.115, -1.196, -0.321, 0.343, 0.755, 0.962, 0.844, 0.293, -0.476], // hue, degrees from red to yellow
    [-1.465, -1.167, -0.805, -0.345, 0.145, 0.596, 0.954, 1.229, 1.474], // redness inside less outside
    [-1.287, -0.822, -0.348, 0.075, 0.271, 0.329, 0.287, 0.202, 0.107], // outline: share of rays that agree
    [1.219, 0.937, 0.579, 0.110, -0.450, -0.872, -0.929, -0.722, -0.506], // outline: roughness, radii
    [-1.059, -0.639, -0.302, -0.120, -0.108, -0.107, -0.083, -0.050, -0.016], // share of the inside that is red
    [0.814, 0.784, 0.762, 0.619, 0.332, -0.089, -0.620, -1.185, -1.667], // share of the surroundings that is red
    [-0.080, 0.016, 0.062, 0.007, -0.205, -0.510, -0.741, -0.897, -0.958], // share of carpet below
    [-1.159, -1.107, -0.884, -0.345, 0.328, 0.775, 1.022, 1.026, 0.947], // share of carpet around
    [-1.298, -0.613, 0.017, 0.460, 0.650, 0.614, 0.265, -0.612, -1.780], // width over height, logarithm
    [-0.338, -0.374, -0.394, -0.414, -0.397, -0.255, -0.049, 0.102, 0.229], // bottom below the field's boundary, heights of the picture
    [-1.451, -0.723, -0.137, 0.092, 0.105, 0.121, 0.122, 0.028, -0.165], // size, logarithm of pixels
    [-2.933, -2.226, -1.159, 0.371, 1.517, 2.074, 2.283, 2.241, 2.059], // upper less lower brightness
    [-0.566, -0.446, -0.343, -0.227, -0.121, -0.024, -0.091, -0.160, -0.242], // unevenness of colour inside
    [0.442, 0.403, 0.325, 0.157, -0.088, -0.363, -0.617, -0.924, -1.213], // redness of the reddest candidate less its own
    [-0.886, -0.558, -0.245, -0.241, -0.189, -0.125, -0.064, -0.010, 0.040], // share of the outline in the picture
    [-1.702, -1.008, -0.394, 0.063, 0.268, 0.377, 0.349, 0.286, 0.202], // brightness over the carpet's, logarithm
    [-0.999, -0.644, -0.299, -0.006, 0.067, -0.067, -0.155, -0.151, -0.162], // red over green against the carpet, logarithm
    [-1.209, -0.974, -0.565, -0.050, 0.289, 0.430, 0.286, 0.043, -0.226], // green over blue against the carpet, logarithm
    [0.119, 0.246, 0.316, 0.279, 0.088, -0.243, -0.643, -1.020, -1.332], // brightness outside against inside, unevenness
];
