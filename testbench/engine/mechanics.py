"""The robot as a rigid-body model in MuJoCo's XML: a chassis, its wheels, fifteen rollers each, a floor."""

import math

STEP_S = 0.0002
ROLLERS = 15
ROLLER_RADIUS_M = 0.004
ROLLER_MASS_KG = 0.0004
ROLLER_ARMATURE = 1e-8
HUB_MASS_KG = 0.030
HUB_INERTIA = 1.5e-6  # about its axle
CHASSIS_HEIGHT_M = 0.045  # of its centre of mass above the floor


def roller_half_length(wheel_radius):
    """Half length of the ellipsoid that is flush with the circle in its middle and where the next one takes over."""
    half_pitch = math.pi * wheel_radius / ROLLERS
    sagitta = wheel_radius * (1.0 - math.cos(math.pi / ROLLERS))
    return half_pitch / math.sqrt(1.0 - (1.0 - sagitta / ROLLER_RADIUS_M) ** 2)


def wheel_xml(i, azimuth, direction, body_radius, radius, eccentricity):
    """Wheel `i`: hinge along its axle, local x along the drive direction, rollers on a ring that may be off centre."""
    px, py = body_radius * math.cos(azimuth), body_radius * math.sin(azimuth)
    dx, dy = math.cos(direction), math.sin(direction)
    ring, half = radius - ROLLER_RADIUS_M, roller_half_length(radius)
    inertia = ROLLER_MASS_KG * ROLLER_RADIUS_M**2 * 0.4
    rollers = []
    for k in range(ROLLERS):
        a = 2.0 * math.pi * k / ROLLERS
        c, s = math.cos(a), math.sin(a)
        rollers.append(f"""
      <body pos="{ring * c + eccentricity * radius:.9g} {ring * s:.9g} 0" xyaxes="{-s:.9g} {c:.9g} 0 0 0 1">
        <inertial pos="0 0 0" mass="{ROLLER_MASS_KG}" diaginertia="{inertia:g} {inertia:g} {inertia:g}"/>
        <joint name="roller{i}_{k}" axis="1 0 0" class="roller"/>
        <geom type="ellipsoid" size="{half:.9g} {ROLLER_RADIUS_M} {ROLLER_RADIUS_M}" class="roller"/>
      </body>""")
    return f"""
    <body name="wheel{i}" pos="{px:.9g} {py:.9g} {radius:.9g}" xyaxes="{dx:.9g} {dy:.9g} 0 0 0 -1">
      <inertial pos="0 0 0" mass="{HUB_MASS_KG}" diaginertia="{HUB_INERTIA} {HUB_INERTIA} {HUB_INERTIA}"/>
      <joint name="wheel{i}" axis="0 0 1" class="wheel"/>{"".join(rollers)}
    </body>"""


def wall_xml(wall):
    """An upright plane `distance` m from the origin that faces back along `azimuth`, which only the chassis meets."""
    azimuth, distance = wall
    c, s = math.cos(azimuth), math.sin(azimuth)
    return f"""
    <geom name="wall" type="plane" size="20 20 1" contype="0" conaffinity="2"
      pos="{distance * c:.9g} {distance * s:.9g} 0" xyaxes="{s:.9g} {-c:.9g} 0 0 0 1"
      friction="0.2 0 0" solref="0.01 1"/>"""


def xml(nominal, plant, wall=None):
    """The whole model. Chassis mass and inertia make the totals those of the nominal robot times the plant's scales."""
    body_radius = nominal.body_radius * plant.body_radius_scale
    wheel_mass = HUB_MASS_KG + ROLLERS * ROLLER_MASS_KG
    mass = nominal.mass * plant.mass_scale - nominal.wheels * wheel_mass
    yaw = nominal.yaw_inertia * plant.yaw_inertia_scale - nominal.wheels * wheel_mass * body_radius**2
    # The offset is that of the whole robot, the wheels stay where they are.
    share = nominal.mass * plant.mass_scale / mass
    cx, cy = (share * c for c in plant.centre_of_mass)
    yaw = max(yaw - mass * (cx * cx + cy * cy), 0.2 * yaw)
    across = 0.62 * yaw
    wheels = "".join(
        wheel_xml(
            i + 1,
            nominal.mounts[i] + plant.wheel_angle[i],
            nominal.mounts[i] + plant.wheel_angle[i] - math.pi / 2 - plant.skew[i],
            body_radius,
            nominal.wheel_radius * plant.wheel_radius_scale[i],
            plant.eccentricity[i],
        )
        for i in range(nominal.wheels)
    )
    gravity = 9.81
    tx, ty = plant.tilt
    gx, gy = gravity * math.sin(tx), gravity * math.sin(ty)
    shell = f'<geom type="cylinder" size="{body_radius + 0.005:.9g} 0.06" pos="0 0 0.08" contype="2" conaffinity="0"/>'
    # A rotor behind play is a body of its own (drive.py); what stays keeps the engine's step stable.
    share_here = 0.2 if any(plant.play) else 1.0
    armature = share_here * nominal.rotor_inertia * plant.rotor_inertia_scale * nominal.gear_ratio**2
    contact = f'friction="{plant.friction} 0 0" solref="{plant.contact_time} 1" solimp="0.95 0.98 0.0005"'
    return f"""<mujoco model="RacBot">
  <compiler angle="radian" inertiafromgeom="false"/>
  <option timestep="{STEP_S}" gravity="{gx:.9g} {gy:.9g} {-math.sqrt(gravity**2 - gx * gx - gy * gy):.9g}"
    integrator="implicitfast" cone="elliptic" solver="Newton" iterations="12" tolerance="1e-9" impratio="{plant.grip}">
    <flag eulerdamp="disable"/>
  </option>
  <default>
    <default class="wheel">
      <joint type="hinge" armature="{armature}" solreffriction="0.001 1" solimpfriction="0.98 0.98 0.001"/>
    </default>
    <default class="roller">
      <joint type="hinge" armature="{ROLLER_ARMATURE}" solreffriction="0.001 1" solimpfriction="0.95 0.95 0.001"/>
      <geom contype="1" conaffinity="0" condim="3" {contact}/>
    </default>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="20 20 1" contype="0" conaffinity="1" condim="3" {contact}/>
    {wall_xml(wall) if wall else ""}
    <body name="chassis" pos="0 0 0">
      <freejoint name="chassis"/>
      {shell if wall else ""}
      <inertial pos="{cx:.9g} {cy:.9g} {CHASSIS_HEIGHT_M}" mass="{mass:.9g}"
        diaginertia="{across:.9g} {across:.9g} {yaw:.9g}"/>{wheels}
    </body>
  </worldbody>
</mujoco>
"""
