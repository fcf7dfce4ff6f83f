"""What can be hidden: names and parameters as in gap.json, sizes from modest to clear, and how the plant changes."""

import math

import disturbances
from robot import WHEELS

TURN = 2.0 * math.pi


def between(rng, low, high):
    """Log-uniform."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def signed(rng, low, high):
    return rng.choice((-1.0, 1.0)) * between(rng, low, high)


def one(value, wheel, rest=0.0):
    return [value if i == wheel else rest for i in range(WHEELS)]


def wheel_skew(rng, plant):
    most = between(rng, math.radians(1.0), math.radians(5.0))
    skews = [rng.uniform(-most, most) for _ in range(WHEELS)]
    skews[rng.randrange(WHEELS)] = rng.choice((-1.0, 1.0)) * most
    plant.skew = skews
    return [1, 2, 3], {f"skew_{i + 1}_rad": s for i, s in enumerate(skews)}


def per_wheel(attribute, parameter, low, high, plus_one=False, both_signs=True):
    """An effect on one drawn wheel."""

    def act(rng, plant):
        wheel = rng.randrange(WHEELS)
        size = signed(rng, low, high) if both_signs else between(rng, low, high)
        setattr(plant, attribute, one(size + plus_one, wheel, float(plus_one)))
        return [wheel + 1], {parameter.format(wheel + 1): size}

    return act


def common(attribute, parameter, low, high, plus_one=False, both_signs=True, wheels=False):
    """An effect on the whole robot; `wheels`: the plant has one value a wheel."""

    def act(rng, plant):
        size = signed(rng, low, high) if both_signs else between(rng, low, high)
        value = size + plus_one
        setattr(plant, attribute, [value] * WHEELS if wheels else value)
        return [], {parameter: size}

    return act


def vector(attribute, names, low, high):
    """An effect with a length and a direction."""

    def act(rng, plant):
        size, azimuth = between(rng, low, high), rng.uniform(0.0, TURN)
        value = (size * math.cos(azimuth), size * math.sin(azimuth))
        setattr(plant, attribute, value)
        return [], dict(zip(names, value, strict=True))

    return act


def encoder_loss(rng, plant):
    wheel, loss = rng.randrange(WHEELS), between(rng, 0.02, 0.1)
    plant.encoder_loss = one(loss, wheel)
    plant.encoder_loss_above = rng.choice((0.0, rng.uniform(8.0, 20.0)))
    return [wheel + 1], {f"loss_{wheel + 1}": loss, "threshold_rad_s": plant.encoder_loss_above}


def stribeck(rng, plant):
    torque, plant.stribeck_speed = between(rng, 0.008, 0.03), rng.uniform(1.0, 4.0)
    plant.stribeck = [torque] * WHEELS
    return [], {"torque_nm": torque, "speed_rad_s": plant.stribeck_speed}


def asymmetric(rng, plant):
    wheel, torque = rng.randrange(WHEELS), between(rng, 0.008, 0.03)
    plant.asymmetric_sense = rng.choice((-1, 1))
    plant.asymmetric = one(torque, wheel)
    return [wheel + 1], {f"torque_{wheel + 1}_nm": torque, "sense": plant.asymmetric_sense}


def heating(rng, plant):
    plant.heating_per_joule = between(rng, 0.006, 0.03)
    return [], {"rise_per_j": plant.heating_per_joule}


def hot_motor(rng, plant):
    """Windings that are hot from the start: copper has 0.39 % more resistance a kelvin, magnets lose 0.1 %."""
    warmer = rng.uniform(30.0, 80.0)
    plant.resistance_scale = 1.0 + 0.0039 * warmer
    plant.torque_constant_scale = 1.0 - 0.001 * warmer
    return [], {"kelvin": warmer}


def battery_sag(rng, plant):
    plant.battery_resistance, plant.battery_drop = between(rng, 0.2, 0.7), rng.choice((0.0, rng.uniform(0.1, 0.5)))
    plant.supply_measured = False
    return [], {"resistance_ohm": plant.battery_resistance, "drop_v": plant.battery_drop}


def wheel_slip(rng, plant):
    plant.friction = between(rng, 0.12, 0.28)
    return [], {"friction_coefficient": plant.friction}


def carpet_grain(rng, plant):
    force, azimuth = between(rng, 0.4, 1.5), rng.uniform(-math.pi / 2, math.pi / 2)
    plant.disturbance = disturbances.grain(force, azimuth)
    return [], {"force_n": force, "azimuth_rad": azimuth}


def roller_friction(rng, plant):
    force = between(rng, 0.3, 1.0)
    plant.roller_drag = [force] * WHEELS
    return [], {"force_n": force}


def wheel_order(rng, plant):
    order = rng.choice(([2, 1, 3], [3, 2, 1], [1, 3, 2], [2, 3, 1], [3, 1, 2], [-1, 2, 3], [1, -2, 3], [1, 2, -3]))
    if rng.random() < 0.5:
        plant.command_row, stem = order, "axis"
    else:
        plant.axis_wheel, stem = order, "cable"
    return [i + 1 for i in range(WHEELS) if order[i] != i + 1], {f"{stem}_{i + 1}": a for i, a in enumerate(order)}


def pi_gain(rng, plant):
    kp, ki = signed(rng, 0.05, 0.3), rng.choice((0.0, signed(rng, 0.1, 0.5)))
    plant.kp_scale, plant.ki_scale = 1.0 + kp, 1.0 + ki
    return [], {"kp_scale": kp, "ki_scale": ki}


def sample_order(rng, plant):
    plant.count_age_ticks = rng.choice((1, 2))
    return [], {"shift_ticks": plant.count_age_ticks}


def camera_timing(rng, plant):
    if rng.random() < 0.5:
        plant.stamp_jitter = between(rng, 0.003, 0.008)
        return [], {"jitter_s": plant.stamp_jitter}
    plant.stamp_drift = signed(rng, 0.004, 0.015)
    return [], {"drift": plant.stamp_drift}


def periodic(rng, plant):
    wheel, torque, frequency = rng.randrange(WHEELS), between(rng, 0.008, 0.025), rng.uniform(1.0, 6.0)
    plant.disturbance = disturbances.periodic_torque(wheel, torque, frequency)
    return [wheel + 1], {"torque_nm": torque, "frequency_hz": frequency}


def rub(rng, plant):
    wheel, torque, harmonic = rng.randrange(WHEELS), between(rng, 0.015, 0.04), rng.choice((1, 2, 3))
    plant.disturbance = disturbances.heading_rub(wheel, torque, harmonic, rng.uniform(0.0, TURN))
    return [wheel + 1], {"torque_nm": torque, "harmonic": harmonic}


def sticking(rng, plant):
    wheel, torque, onset = rng.randrange(WHEELS), between(rng, 0.012, 0.035), rng.uniform(2.5, 4.5)
    plant.disturbance = disturbances.late_sticking(wheel, torque, onset)
    return [wheel + 1], {"torque_nm": torque, "onset_s": onset}


def collisions(rng, plant):
    count, force = rng.choice((2, 3, 4)), between(rng, 6.0, 20.0)
    times = sorted(rng.uniform(0.5, 5.5) for _ in range(count))
    sides = [rng.uniform(0.0, TURN) for _ in range(count)]
    plant.disturbance = disturbances.pushes(times, [(force * math.cos(a), force * math.sin(a)) for a in sides])
    return [], {"force_n": force, "count": count}


def wall(rng, plant):
    plant.wall = True
    return [], {}


CATALOGUE = {
    "wheel-skew": wheel_skew,
    "wheel-radius": per_wheel("wheel_radius_scale", "scale_{}", 0.008, 0.04, plus_one=True),
    "wheel-radius-common": common("wheel_radius_scale", "scale", 0.01, 0.05, plus_one=True, wheels=True),
    "body-radius": common("body_radius_scale", "scale", 0.012, 0.06, plus_one=True),
    "wheel-angle": per_wheel("wheel_angle", "angle_{}_rad", 0.015, 0.08),
    "encoder-scale": per_wheel("encoder_scale", "scale_{}", 0.01, 0.04, plus_one=True),
    "encoder-loss": encoder_loss,
    "wheel-slip": wheel_slip,
    "camera-latency": common("camera_latency", "latency_s", 0.008, 0.09, both_signs=False),
    "camera-scale": common("camera_scale", "scale", 0.008, 0.04, plus_one=True),
    "marker-heading": common("marker_heading", "angle_rad", 0.015, 0.1),
    "marker-offset": vector("marker_offset", ("x_m", "y_m"), 0.003, 0.02),
    "lens-distortion": common("lens_k1", "k1_per_m2", 0.015, 0.08),
    "coulomb-friction": common("coulomb", "torque_nm", 0.007, 0.025, both_signs=False, wheels=True),
    "coulomb-friction/wheel": per_wheel("coulomb", "torque_{}_nm", 0.008, 0.03, both_signs=False),
    "viscous-friction": common("viscous", "coefficient_nms", 3e-4, 1.2e-3, both_signs=False, wheels=True),
    "stribeck-friction": stribeck,
    "asymmetric-friction": asymmetric,
    "dead-band": common("dead_band", "duty", 0.03, 0.12, both_signs=False),
    "torque-constant": common("torque_constant_scale", "scale", 0.07, 0.25, plus_one=True),
    "motor-heating": heating,
    "motor-heating/hot": hot_motor,
    "battery-sag": battery_sag,
    "robot-mass": common("mass_scale", "scale", 0.08, 0.3, plus_one=True),
    "yaw-inertia": common("yaw_inertia_scale", "scale", 0.2, 0.6, plus_one=True, both_signs=False),
    "rotor-inertia": common("rotor_inertia_scale", "scale", 3.0, 12.0, plus_one=True, both_signs=False),
    "centre-of-mass": vector("centre_of_mass", ("x_m", "y_m"), 0.005, 0.02),
    "floor-tilt": vector("tilt", ("x_rad", "y_rad"), 0.008, 0.04),
    "carpet-grain": carpet_grain,
    "roller-friction": roller_friction,
    "actuation-latency": common("actuation_latency", "latency_s", 0.003, 0.012, both_signs=False),
    "command-latency": common("command_latency", "latency_s", 0.01, 0.08, both_signs=False),
    "wheel-order": wheel_order,
    "pi-gain": pi_gain,
    "gear-backlash": common("play", "play_rad", 0.04, 0.25, both_signs=False, wheels=True),
    "sample-order": sample_order,
    "camera-timing": camera_timing,
}

OUTSIDE = {
    "collisions": collisions,
    "wall": wall,
    "periodic-torque": periodic,
    "heading-rub": rub,
    "late-sticking": sticking,
}

PAIRS = [
    ("wheel-skew", "coulomb-friction"),
    ("wheel-skew", "coulomb-friction/wheel"),
    ("camera-latency", "robot-mass"),
    ("wheel-radius", "viscous-friction"),
    ("marker-offset", "floor-tilt"),
    ("body-radius", "torque-constant"),
    ("wheel-skew", "camera-latency"),
    ("battery-sag", "wheel-radius-common"),
    ("command-latency", "coulomb-friction/wheel"),
    ("camera-scale", "roller-friction"),
    ("actuation-latency", "marker-heading"),
    ("pi-gain", "wheel-skew"),
]


def hide(name, rng, plant):
    """Changes the plant; the entry of the truth file."""
    table = OUTSIDE if name in OUTSIDE else CATALOGUE
    wheels, parameters = table[name](rng, plant)
    return {"name": name.split("/")[0], "wheels": wheels, "parameters": parameters, "outside": name in OUTSIDE}
