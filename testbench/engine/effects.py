"""What can be hidden: names and parameters as in gap.json, sizes from modest to clear, and how the plant changes."""

import math

import disturbances

TURN = 2.0 * math.pi


def between(rng, low, high):
    """Log-uniform."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def signed(rng, low, high):
    return rng.choice((-1.0, 1.0)) * between(rng, low, high)


def one(plant, value, wheel, rest=0.0):
    return [value if i == wheel else rest for i in range(plant.wheels)]


def wheel_skew(rng, plant):
    most = between(rng, math.radians(1.0), math.radians(5.0))
    skews = [rng.uniform(-most, most) for _ in range(plant.wheels)]
    skews[rng.randrange(plant.wheels)] = rng.choice((-1.0, 1.0)) * most
    plant.skew = skews
    return [i + 1 for i in range(plant.wheels)], {f"skew_{i + 1}_rad": s for i, s in enumerate(skews)}


def per_wheel(attribute, parameter, low, high, plus_one=False, both_signs=True, torque=False):
    """An effect on one drawn wheel; `torque`: sizes go with the robot's motors."""

    def act(rng, plant):
        wheel = rng.randrange(plant.wheels)
        size = signed(rng, low, high) if both_signs else between(rng, low, high)
        size *= plant.torque_unit if torque else 1.0
        setattr(plant, attribute, one(plant, size + plus_one, wheel, float(plus_one)))
        return [wheel + 1], {parameter.format(wheel + 1): size}

    return act


def common(attribute, parameter, low, high, plus_one=False, both_signs=True, wheels=False, torque=False):
    """An effect on the whole robot; `wheels`: the plant has one value a wheel; `torque`: as in `per_wheel`."""

    def act(rng, plant):
        size = signed(rng, low, high) if both_signs else between(rng, low, high)
        size *= plant.torque_unit if torque else 1.0
        value = size + plus_one
        setattr(plant, attribute, [value] * plant.wheels if wheels else value)
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
    wheel, loss = rng.randrange(plant.wheels), between(rng, 0.02, 0.1)
    plant.encoder_loss = one(plant, loss, wheel)
    plant.encoder_loss_above = rng.choice((0.0, rng.uniform(8.0, 20.0)))
    return [wheel + 1], {f"loss_{wheel + 1}": loss, "threshold_rad_s": plant.encoder_loss_above}


def stribeck(rng, plant):
    torque, plant.stribeck_speed = plant.torque_unit * between(rng, 0.008, 0.03), rng.uniform(1.0, 4.0)
    plant.stribeck = [torque] * plant.wheels
    return [], {"torque_nm": torque, "speed_rad_s": plant.stribeck_speed}


def asymmetric(rng, plant):
    wheel, torque = rng.randrange(plant.wheels), plant.torque_unit * between(rng, 0.008, 0.03)
    plant.asymmetric_sense = rng.choice((-1, 1))
    plant.asymmetric = one(plant, torque, wheel)
    return [wheel + 1], {f"torque_{wheel + 1}_nm": torque, "sense": plant.asymmetric_sense}


def heating(rng, plant):
    plant.heating_per_joule = between(rng, 0.006, 0.03) / plant.power_unit
    return [], {"rise_per_j": plant.heating_per_joule}


def hot_motor(rng, plant):
    """Windings that are hot from the start: copper has 0.39 % more resistance a kelvin, magnets lose 0.1 %."""
    warmer = rng.uniform(30.0, 80.0)
    plant.resistance_scale = 1.0 + 0.0039 * warmer
    plant.torque_constant_scale = 1.0 - 0.001 * warmer
    return [], {"start_k": warmer}


def battery_sag(rng, plant):
    plant.battery_resistance, plant.battery_drop = between(rng, 0.2, 0.7), rng.choice((0.0, rng.uniform(0.1, 0.5)))
    plant.supply_measured = False
    return [], {"resistance_ohm": plant.battery_resistance, "drop_v": plant.battery_drop}


def wheel_slip(rng, plant):
    plant.friction = between(rng, 0.12, 0.28) * min(max(plant.thrust_unit, 0.7), 1.6)
    return [], {"friction_coefficient": plant.friction}


def less_efficient(rng, plant):
    plant.gear_efficiency_more = -between(rng, 0.1, 0.25)
    return [], {"scale": plant.gear_efficiency_more}


def carpet_grain(rng, plant):
    force, azimuth = plant.force_unit * between(rng, 0.4, 1.5), rng.uniform(0.0, math.pi)
    plant.disturbance = disturbances.grain(force, azimuth)
    return [], {"force_n": force, "azimuth_rad": azimuth}


def roller_friction(rng, plant):
    force = plant.force_unit * between(rng, 0.3, 1.0)
    plant.roller_drag = [force] * plant.wheels
    return [], {"force_n": force}


def wheel_order(rng, plant):
    order = list(range(1, plant.wheels + 1))
    if rng.random() < 0.6:
        while order == sorted(order):
            rng.shuffle(order)
    else:
        order[rng.randrange(plant.wheels)] *= -1
    if rng.random() < 0.5:
        plant.command_row, stem = order, "axis"
    else:
        plant.axis_wheel, stem = order, "cable"
    wrong = [i + 1 for i in range(plant.wheels) if order[i] != i + 1]
    return wrong, {f"{stem}_{i + 1}": a for i, a in enumerate(order)}


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


def wheel_creep(rng, plant):
    """The engine's friction is stiff in proportion to `grip`; the size is measured while the set is made."""
    plant.grip = between(rng, 0.02, 0.25)
    return [], {"creep_s_per_kg": None}


def roller_ripple(rng, plant):
    """An axle out of its wheel's centre: once a turn."""
    wheel, share = rng.randrange(plant.wheels), between(rng, 0.04, 0.12)
    plant.eccentricity, plant.same_start = one(plant, share, wheel), rng.random() < 0.5
    return [wheel + 1], {"amplitude": share}


def windup(rng, plant):
    plant.windup_limit = rng.choice((1.0, rng.uniform(0.4, 3.0)))
    return [], {"limit_duty": plant.windup_limit}


def quantisation(rng, plant):
    plant.duty_quantum = rng.choice((0.005, 0.008, 0.01, 0.02, 0.05))
    return [], {"duty_quantum": plant.duty_quantum}


def heading_drag(rng, plant):
    """Dry friction of all wheels that goes with the heading, as a trailing cable makes it."""
    torque = plant.torque_unit * between(rng, 0.02, 0.05)
    harmonic, phase = rng.choice((1, 2, 3)), rng.uniform(0.0, TURN)
    plant.disturbance = disturbances.heading_rub(range(plant.wheels), torque, harmonic, phase)
    return [], {"cos_nm": 0.5 * torque * math.cos(phase), "sin_nm": 0.5 * torque * math.sin(phase)}


def periodic(rng, plant):
    wheel, torque = rng.randrange(plant.wheels), plant.torque_unit * between(rng, 0.008, 0.025)
    frequency = rng.uniform(1.0, 6.0)
    plant.disturbance = disturbances.periodic_torque(wheel, torque, frequency)
    return [wheel + 1], {"torque_nm": torque, "frequency_hz": frequency}


def shaking(rng, plant):
    force, frequency = plant.force_unit * between(rng, 0.8, 2.5), rng.uniform(0.7, 5.0)
    plant.disturbance = disturbances.periodic_push(force, rng.uniform(0.0, math.pi), frequency)
    return [], {"force_n": force, "frequency_hz": frequency}


def cable(rng, plant):
    anchor, slack = (rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6)), rng.uniform(0.1, 0.3)
    stiffness = plant.force_unit * between(rng, 4.0, 15.0)
    plant.disturbance = disturbances.cable(anchor, slack, stiffness, 0.5)
    return [], {"stiffness_n_m": stiffness}


def rough_patch(rng, plant):
    force, centre = plant.force_unit * between(rng, 1.0, 3.0), (rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3))
    plant.disturbance = disturbances.rough_patch(centre, rng.uniform(0.12, 0.3), force)
    return [], {"force_n": force}


def camera_drift(rng, plant):
    speed, azimuth = between(rng, 0.008, 0.03), rng.uniform(0.0, TURN)
    plant.camera_drift = (speed * math.cos(azimuth), speed * math.sin(azimuth))
    return [], {"speed_m_s": speed}


def rub(rng, plant):
    wheel, torque = rng.randrange(plant.wheels), plant.torque_unit * between(rng, 0.015, 0.04)
    harmonic = rng.choice((1, 2, 3))
    plant.disturbance = disturbances.heading_rub([wheel], torque, harmonic, rng.uniform(0.0, TURN))
    return [wheel + 1], {"torque_nm": torque, "harmonic": harmonic}


def sticking(rng, plant):
    wheel, torque = rng.randrange(plant.wheels), plant.torque_unit * between(rng, 0.012, 0.035)
    onset = rng.uniform(2.5, 4.5)
    plant.disturbance = disturbances.late_sticking(wheel, torque, onset)
    return [wheel + 1], {"torque_nm": torque, "onset_s": onset}


def collisions(rng, plant):
    count, force = rng.choice((2, 3, 4)), plant.force_unit * between(rng, 6.0, 20.0)
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
    "encoder-lag": common("encoder_lag", "latency_s", 0.008, 0.05, both_signs=False),
    "wheel-creep": wheel_creep,
    "wheel-slip": wheel_slip,
    "roller-ripple": roller_ripple,
    "camera-latency": common("camera_latency", "latency_s", 0.008, 0.09, both_signs=False),
    "camera-scale": common("camera_scale", "scale", 0.008, 0.04, plus_one=True),
    "marker-heading": common("marker_heading", "angle_rad", 0.015, 0.1),
    "marker-offset": vector("marker_offset", ("x_m", "y_m"), 0.003, 0.02),
    "lens-distortion": common("lens_k1", "k1_per_m2", 0.015, 0.08),
    "coulomb-friction": common("coulomb", "torque_nm", 0.007, 0.025, both_signs=False, wheels=True, torque=True),
    "coulomb-friction/wheel": per_wheel("coulomb", "torque_{}_nm", 0.008, 0.03, both_signs=False, torque=True),
    "viscous-friction": common("viscous", "coefficient_nms", 3e-4, 1.2e-3, both_signs=False, wheels=True, torque=True),
    "stribeck-friction": stribeck,
    "asymmetric-friction": asymmetric,
    "gear-efficiency": less_efficient,
    "drive-curve": common("drive_curve", "curvature", 0.2, 0.6),
    "dead-band": common("dead_band", "duty", 0.03, 0.12, both_signs=False),
    "torque-constant": common("torque_constant_scale", "scale", 0.07, 0.25, plus_one=True),
    "motor-heating": heating,
    "motor-heating/hot": hot_motor,
    "battery-sag": battery_sag,
    "robot-mass": common("mass_scale", "scale", 0.08, 0.3, plus_one=True),
    "yaw-inertia": common("yaw_inertia_scale", "scale", 0.2, 0.6, plus_one=True, both_signs=False),
    "rotor-inertia": common("rotor_inertia_scale", "scale", 8.0, 50.0, plus_one=True, both_signs=False),
    "centre-of-mass": vector("centre_of_mass", ("x_m", "y_m"), 0.005, 0.02),
    "floor-tilt": vector("tilt", ("x_rad", "y_rad"), 0.008, 0.04),
    "carpet-grain": carpet_grain,
    "roller-friction": roller_friction,
    "actuation-latency": common("actuation_latency", "latency_s", 0.003, 0.012, both_signs=False),
    "command-latency": common("command_latency", "latency_s", 0.01, 0.08, both_signs=False),
    "wheel-order": wheel_order,
    "pi-gain": pi_gain,
    "integrator-windup": windup,
    "quantisation": quantisation,
    "heading-drag": heading_drag,
    "gear-backlash": common("play", "play_rad", 0.04, 0.25, both_signs=False, wheels=True),
    "gear-backlash/stiff": common("play", "play_rad", 0.04, 0.25, both_signs=False, wheels=True),
    "sample-order": sample_order,
    "camera-timing": camera_timing,
}

OUTSIDE = {
    "collisions": collisions,
    "wall": wall,
    "periodic-torque": periodic,
    "heading-rub": rub,
    "late-sticking": sticking,
    "shaking": shaking,
    "cable": cable,
    "rough-patch": rough_patch,
    "camera-drift": camera_drift,
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
    ("wheel-creep", "camera-latency"),
    ("quantisation", "viscous-friction"),
]


def hide(name, rng, plant):
    """Changes the plant; the entry of the truth file."""
    table = OUTSIDE if name in OUTSIDE else CATALOGUE
    wheels, parameters = table[name](rng, plant)
    return {"name": name.split("/")[0], "wheels": wheels, "parameters": parameters, "outside": name in OUTSIDE}
