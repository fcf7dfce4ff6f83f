"""What the team software commands: body velocities (x right, y forward, counter-clockwise) at 100 Hz."""

import math

PERIOD_S = 0.01
REST_S = 0.25
TURN = 2.0 * math.pi


def trapezoid(part, ramp):
    """Unit height over unit time, rising and falling during `ramp` each."""
    return min(max(min(part, 1.0 - part) / ramp, 0.0), 1.0)


def sign(rng):
    return rng.choice((-1.0, 1.0))


def polar(speed, direction, spin=0.0):
    return (speed * math.cos(direction), speed * math.sin(direction), spin)


def legs(count, span, there_and_back):
    """Straight legs, evenly spread over `span`, each with its own speed."""

    def make(active, rng):
        first, turn = rng.uniform(0.0, TURN), sign(rng)
        plan = [
            (first + turn * span * i / count + rng.uniform(-0.15, 0.15), rng.uniform(0.35, 0.75)) for i in range(count)
        ]
        spin = sign(rng) * rng.uniform(0.3, 0.8) if rng.random() < 0.4 else 0.0
        ramp = rng.uniform(0.3, 0.48)

        def at(t):
            place = t / active * count
            direction, peak = plan[min(int(place), count - 1)]
            part = place % 1.0
            if there_and_back:
                way = 1.0 if part < 0.5 else -1.0
                return polar(way * peak * trapezoid(2.0 * part % 1.0, ramp), direction)
            return polar(peak * trapezoid(part, ramp), direction, spin * trapezoid(part, 0.2))

        return at

    return make


def circle(active, rng):
    """Half of the time a circle at fixed heading, half of it with the heading turning."""
    speeds = [rng.uniform(0.4, 0.85) for _ in range(2)]
    first = [rng.uniform(0.0, TURN) for _ in range(2)]
    turn, spin = sign(rng) * rng.uniform(1.5, 2.6), sign(rng) * rng.uniform(1.2, 2.4)

    def at(t):
        half = 0 if t < active / 2 else 1
        envelope = trapezoid((2.0 * t / active) % 1.0, 0.28)
        direction = first[half] + (turn * t if half == 0 else 0.0)
        return polar(speeds[half] * envelope, direction, spin * envelope if half else 0.0)

    return at


def eight(active, rng):
    """A figure of eight, the heading swinging."""
    size, rounds = rng.uniform(0.4, 0.7), rng.choice((1.0, 1.5, 2.0))
    tilt, swing, phase = rng.uniform(0.0, TURN), rng.uniform(0.5, 2.0), rng.uniform(0.0, TURN)

    def at(t):
        angle = TURN * rounds * t / active
        fade = trapezoid(t / active, 0.08)
        vx, vy = size * math.cos(angle), size * math.cos(2.0 * angle)
        c, s = math.cos(tilt), math.sin(tilt)
        return (fade * (c * vx - s * vy), fade * (s * vx + c * vy), fade * swing * math.sin(1.3 * angle + phase))

    return at


def sweep(active, rng):
    """Chirps in all three freedoms at once, fading as they get faster."""
    axes = [
        (
            rng.uniform(0.35, 0.5) if k < 2 else rng.uniform(1.8, 2.9),
            rng.uniform(0.2, 0.5),
            rng.uniform(1.3, 2.2),
            rng.uniform(0.0, TURN),
        )
        for k in range(3)
    ]

    def at(t):
        part = t / active
        fade = (1.0 - 0.65 * part) * min(t / 0.3, 1.0) * min((active - t) / 0.2, 1.0)
        return tuple(
            size * fade * math.sin(phase + TURN * t * (slow + 0.5 * (fast - slow) * part))
            for size, slow, fast, phase in axes
        )

    return at


def chirp(active, rng):
    """One freedom after the other."""
    order = rng.sample(range(3), 3)
    direction = rng.uniform(0.0, TURN)
    fast = rng.uniform(1.8, 3.0)

    def at(t):
        third = min(int(3.0 * t / active), 2)
        part = 3.0 * t / active - third
        wave = trapezoid(part, 0.1) * math.sin(TURN * active / 3.0 * part * (0.5 + 0.5 * (fast - 0.5) * part))
        axis = order[third]
        if axis == 2:
            return (0.0, 0.0, 3.0 * (1.0 - 0.5 * part) * wave)
        return polar(0.6 * (1.0 - 0.5 * part) * wave, direction + axis * math.pi / 2)

    return at


def spin(active, rng):
    """Turns on the spot to both sides."""
    side = sign(rng)
    peaks = [side * (-1.0) ** i * rng.uniform(3.5, 6.6) for i in range(4)]
    ramp = rng.uniform(0.25, 0.4)

    def at(t):
        place = 4.0 * t / active
        return (0.0, 0.0, peaks[min(int(place), 3)] * trapezoid(place % 1.0, ramp))

    return at


def steps(slow, fast):
    """Steps of velocity with rests between."""

    def make(active, rng):
        plan, start = [], 0.0
        while start < active - 0.5:
            go, rest = rng.uniform(0.4, 0.75), rng.uniform(0.2, 0.45)
            turn = sign(rng) * rng.uniform(0.3, 2.1) if rng.random() < 0.35 else 0.0
            plan.append(
                (start, min(start + go, active - 0.1), polar(rng.uniform(slow, fast), rng.uniform(0.0, TURN), turn))
            )
            start += go + rest
        return lambda t: next((v for a, b, v in plan if a <= t < b), (0.0, 0.0, 0.0))

    return make


def walk(active, rng):
    """A random walk of the body velocity, pulled back to rest."""
    limits, pull = (0.55, 0.55, 2.5), 0.02
    rows, v, drift = [], [0.0] * 3, [0.0] * 3
    for _ in range(int(active / PERIOD_S) + 2):
        for k in range(3):
            drift[k] = 0.97 * drift[k] + 0.25 * 0.02 * limits[k] * rng.gauss(0.0, 1.0)
            v[k] = min(max(v[k] * (1.0 - pull) + 3.0 * drift[k], -limits[k]), limits[k])
        rows.append(tuple(v))

    def at(t):
        fade = trapezoid(t / active, 0.06)
        return tuple(fade * x for x in rows[int(t / PERIOD_S)])

    return at


PATTERNS = {
    "lines": legs(4, math.pi, True),
    "square": legs(4, TURN, False),
    "star": legs(6, TURN * 4.0 / 6.0, True),
    "circle": circle,
    "eight": eight,
    "sweep": sweep,
    "chirp": chirp,
    "walk": walk,
    "spin": spin,
    "stop-and-go": steps(0.4, 1.0),
    "go-hard": steps(0.8, 1.6),
}

# One of each row makes a set, as people record them: straight, curved, broad, hard.
FAMILIES = [
    ["lines", "square", "star"],
    ["circle", "eight", "spin"],
    ["sweep", "chirp", "walk"],
    ["stop-and-go", "go-hard"],
]


def commands(pattern, seconds, rng):
    """Rows (vx, vy, w) every 10 ms, rounded as they are logged."""
    active = seconds - 2.0 * REST_S
    at = PATTERNS[pattern](active, rng)
    rows = []
    for k in range(round(seconds / PERIOD_S)):
        t = k * PERIOD_S - REST_S
        rows.append(tuple(round(x, 3) + 0.0 for x in at(t)) if 0.0 < t < active else (0.0, 0.0, 0.0))
    return rows
