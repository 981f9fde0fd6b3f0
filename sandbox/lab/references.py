"""Closed forms: what an exact simulation would give, and what symplectic Euler gives instead.

The engine moves bodies by symplectic Euler: v += a h, then x += v h. Its error in simple motions is known too, so that
a measured error is told apart from a mistake. h is the time of one integration: dt / substeps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

# --- flight -----------------------------------------------------------------------------------------------------------


def flight(y: float, speed: float, gravity: float, time: float) -> float:
    """Height of a body thrown upwards, y + v t - g t^2 / 2 [m]."""
    return y + speed * time - 0.5 * gravity * time * time


def flight_lag(gravity: float, h: float, time: float) -> float:
    """How far symplectic Euler is below the parabola, exactly g h t / 2 [m]: a sum instead of an integral."""
    return 0.5 * gravity * h * time


def apex(height: float, restitution: float, bounces: int = 1) -> float:
    """Height that a ball dropped from `height` reaches after some bounces, e^(2n) h [m]."""
    return restitution ** (2 * bounces) * height


# --- friction ---------------------------------------------------------------------------------------------------------


def stopping_distance(speed: float, friction: float, gravity: float) -> float:
    """How far a body slides, v^2 / (2 mu g) [m]."""
    return speed * speed / (2.0 * friction * gravity)


def stopping_lag(speed: float, h: float) -> float:
    """How much earlier symplectic Euler stops, v h / 2 [m]: each h is travelled with the speed of its end."""
    return 0.5 * speed * h


def wedge_accelerations(wedge: float, block: float, angle: float, gravity: float) -> tuple[float, float]:
    """Of a smooth wedge on a smooth floor, and of the block along it, as the wedge sees it [m/s^2].

    Horizontally nothing acts: M A = N sin a, and across the slope m A sin a = m g cos a - N, so that
    A = m g sin a cos a / (M + m sin^2 a); along it the block feels g sin a + A cos a.
    """
    sine, cosine = math.sin(angle), math.cos(angle)
    away = block * gravity * sine * cosine / (wedge + block * sine * sine)
    return away, gravity * sine + away * cosine


def slope_acceleration(angle: float, friction: float, gravity: float) -> float:
    """Of a body on a slope, g (sin a - mu cos a), 0 if it sticks [m/s^2]."""
    return max(gravity * (math.sin(angle) - friction * math.cos(angle)), 0.0)


def friction_seen(angle: float, distance: float, gravity: float, time: float) -> float:
    """The friction coefficient of a body that slid so far down a slope from rest: tan a - 2 s / (g t^2 cos a)."""
    return math.tan(angle) - 2.0 * distance / (gravity * time * time * math.cos(angle))


def rolling_acceleration(angle: float, gravity: float) -> float:
    """Of a disc that rolls down a slope, g sin a / (1 + I / m r^2) = 2/3 g sin a, as long as tan a < 3 mu [m/s^2]."""
    return 2.0 / 3.0 * gravity * math.sin(angle)


def slip_spin(angle: float, friction: float, radius: float, gravity: float) -> float:
    """Angular acceleration of a disc that slips down a slope, mu m g cos a r / I = 2 mu g cos a / r [rad/s^2]."""
    return 2.0 * friction * gravity * math.cos(angle) / radius


def skid(speed: float, friction: float, gravity: float) -> tuple[float, float]:
    """When a disc that is thrown without spin begins to roll [s], and how fast it is then [m/s].

    It loses mu g, its rim gains 2 mu g: both are alike at 2/3 of its speed, after v / (3 mu g).
    """
    return speed / (3.0 * friction * gravity), 2.0 / 3.0 * speed


def rolling_distance(speed: float, resistance: float, radius: float, gravity: float) -> float:
    """How far a rolling disc gets [m]. A torque of c m g against it, c the rolling resistance [m], slows it by
    a = c m g r / (I + m r^2) = 2 c g / (3 r), so v^2 / (2 a) = 3 r v^2 / (4 c g).
    """
    return 0.75 * radius * speed * speed / (resistance * gravity)


# --- swinging and circling --------------------------------------------------------------------------------------------


def arithmetic_geometric_mean(a: float, b: float) -> float:
    """The common limit of a, b = (a + b) / 2, sqrt(a b), for positive numbers."""
    for _ in range(60):  # the number of correct digits doubles with each; the bound is for a and b apart by rounding
        if abs(a - b) <= 1e-15 * a:
            break
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return a


def pendulum_period(inertia: float, mass: float, distance: float, gravity: float, amplitude: float) -> float:
    """Of a rigid pendulum at any amplitude below pi, 2 pi sqrt(I / (m g d)) / AGM(1, cos(amplitude / 2)) [s].

    inertia: about the pivot [kg m^2]; distance: from there to the centre of mass [m].
    """
    small = 2.0 * math.pi * math.sqrt(inertia / (mass * gravity * distance))
    return small / arithmetic_geometric_mean(1.0, math.cos(0.5 * amplitude))


def swing_wobble(inertia: float, mass: float, distance: float, gravity: float, amplitude: float, h: float) -> float:
    """How far symplectic Euler's energy of a pendulum leaves what it was let go with, in parts of m g d (1 - cos A).

    To first order it keeps H - (h / 2) V'(x) v instead of the energy H (E. Hairer, C. Lubich, G. Wanner, "Geometric
    Numerical Integration", chapter IX), and begins with v = 0: so H is off by (h / 2) m g d sin(x) w at most, w being
    the angular velocity there.
    """
    angles = np.linspace(0.0, amplitude, 2001)
    pull, fallen = mass * gravity * distance, np.cos(angles) - math.cos(amplitude)
    powers = pull * np.sin(angles) * np.sqrt(2.0 * pull * np.maximum(fallen, 0.0) / inertia)
    return 0.5 * h * float(powers.max()) / (pull * (1.0 - math.cos(amplitude)))


def implicit_oscillation(amplitude: float, omega: float, h: float, t: np.ndarray) -> np.ndarray:
    """An undamped spring let go at rest, as the implicit Euler method has it, at times t that h divides.

    v1 = v0 - h w^2 x1, x1 = x0 + h v1: z = x - i v / w is multiplied by 1 / (1 - i w h) in each h, so that it loses the
    part w^2 h / 2 of its amplitude in a second. XPBD's compliant constraints are such springs.
    """
    steps = np.round(np.asarray(t) / h)
    return np.real(amplitude * (1.0 - 1j * omega * h) ** -steps)


def implicit_period_excess(omega: float, h: float) -> float:
    """How much longer its period is, w h / atan(w h) - 1, about (w h)^2 / 3 [relative]."""
    return omega * h / math.atan(omega * h) - 1.0


def soft_oscillation(amplitude: float, omega: float, h: float, t: np.ndarray) -> np.ndarray:
    """An undamped spring let go at rest, as soft_step has it, at times t that h divides.

    Both passes of a substep solve it implicitly: v' = v - h w^2 (x + h v'), x1 = x + h v', v1 = v - h w^2 (x1 + h v1).
    With s = 1 / (1 + w^2 h^2) that is (x1, v1) = s (x + h v, -s h w^2 x + s v), whose eigenvalues are s e^(+-i a),
    cos a = (1 + s) / 2: it loses the part w^2 h of its amplitude in a second, twice what implicit Euler would.
    """
    s, angle = soft_turn(omega, h)
    steps = np.round(np.asarray(t) / h)
    return amplitude * s**steps * (np.cos(steps * angle) + math.tan(0.5 * angle) * np.sin(steps * angle))


def soft_turn(omega: float, h: float) -> tuple[float, float]:
    """What a substep does to the amplitude, and the angle by which the oscillation goes on [rad]."""
    square = (omega * h) ** 2
    s = 1.0 / (1.0 + square)
    return s, 2.0 * math.asin(0.5 * math.sqrt(square * s))  # acos((1 + s) / 2), which would lose its digits


def soft_period_excess(omega: float, h: float) -> float:
    """How much longer its period is, w h / a - 1, about 11 (w h)^2 / 24 [relative]."""
    return omega * h / soft_turn(omega, h)[1] - 1.0


def orbit_speed(attraction: float, radius: float) -> float:
    """Of a circular orbit about a point that pulls with attraction / r^2, sqrt(attraction / r) [m/s]."""
    return math.sqrt(attraction / radius)


def orbit_wobble(attraction: float, radius: float, h: float, dt: float | None = None) -> float:
    """How far a circular orbit leaves the circle in steps of dt [s], each of substeps of h [s], to second order [m].

    The pull is looked up once a step, ahead (engine/effects/ahead.py): a drift of (dt - h) / 2, a kick of dt, a drift
    of (dt + h) / 2. Such kicks can go round in a regular polygon of corners at R, with u^2 = mu / R; it is seen h / 2
    past the middles of its sides, at r with r^2 = R^2 - u^2 (dt^2 - h^2) / 4, where u goes outwards by the angle
    w h / 2. One let go at r without that is too slow outwards by w^2 r h / 2: an ellipse of eccentricity e = w h / 2,
    whose farthest point is r e (1 + e) away. And it is too fast sideways by the part w^2 (dt^2 + h^2) / 16, which takes
    it (1 - cos) r w^2 (dt^2 + h^2) / 8 farther out. Without dt it is symplectic Euler, dt = h.
    """
    turn = orbit_speed(attraction, radius) / radius  # w [rad/s]
    eccentric, fast = 0.5 * turn * h, 0.125 * turn**2 * ((dt or h) ** 2 + h * h)
    return radius * (math.hypot(eccentric, fast) + fast + eccentric**2)


def levitation(count: int, strength: float) -> np.ndarray:
    """(count,) heights at which magnets float above one another, on one that is fixed at 0 [m].

    All are alike and push each other by strength / d^2 in units of their weight, every pair of them. Newton's method on
    sum_j s / (y_i - y_j)^2 (+ of those below, - of those above) = 1.
    """
    heights = math.sqrt(strength * count) * np.arange(1.0, count + 1.0)
    for _ in range(100):
        all_heights = np.append(0.0, heights)
        apart = heights[:, None] - all_heights[None, :]
        apart[np.arange(count), np.arange(1, count + 1)] = np.inf
        balance = np.sum(np.sign(apart) * strength / apart**2, axis=1) - 1.0
        slopes = -2.0 * strength / np.abs(apart) ** 3  # of each push with the own height; with the other's the opposite
        jacobian = np.diag(slopes.sum(axis=1)) - slopes[:, 1:]
        change = np.linalg.solve(jacobian, balance)
        # not past a neighbour: at most half of the least gap
        step = min(1.0, 0.5 * float(np.diff(all_heights).min()) / float(np.abs(change).max() + 1e-300))
        heights = heights - step * change
    return heights


# --- impacts ----------------------------------------------------------------------------------------------------------


def collision(
    mass1: float, mass2: float, speed1: float, speed2: float, restitution: float
) -> tuple[float, float]:  # fmt: skip
    """Speeds after two bodies met head on: momentum is kept, and they part with e times their speed of approach."""
    together = (mass1 * speed1 + mass2 * speed2) / (mass1 + mass2)
    approach = restitution * (speed1 - speed2)
    return together - approach * mass2 / (mass1 + mass2), together + approach * mass1 / (mass1 + mass2)


def off_centre_impulse(
    mass1: float, mass2: float, inertia2: float, arm: float, speed: float, restitution: float
) -> float:
    """The impulse by which a body hits one at rest, past whose centre its push goes by `arm` [N s].

    P = (1 + e) v / (1/m1 + 1/m2 + r^2 / I2): (1 + e) v times the effective mass.
    """
    return (1.0 + restitution) * speed / (1.0 / mass1 + 1.0 / mass2 + arm * arm / inertia2)


# --- media ------------------------------------------------------------------------------------------------------------


def damped(value: float, rate: float, time: float) -> float:
    """What is left of a speed under linear or angular damping, v e^(-c t)."""
    return value * math.exp(-rate * time)


def damping_excess(value: float, rate: float, h: float, time: float) -> float:
    """How much more is left with v /= 1 + c h in each h, about v e^(-c t) c^2 h t / 2: the implicit Euler method."""
    return value * (1.0 + rate * h) ** -(time / h) - damped(value, rate, time)


def terminal_speed(mass: float, gravity: float, drag: float) -> float:
    """Where drag k v^2 carries the weight, sqrt(m g / k) [m/s]."""
    return math.sqrt(mass * gravity / drag)


def blown_speed(wind: float, drag: float, mass: float, time: float) -> float:
    """Of a free body that starts at rest in wind, W - W / (1 + k W t / m), from du/dt = -k u^2 / m, u = W - v [m/s]."""
    return wind - wind / (1.0 + drag * wind * time / mass)


# --- rest -------------------------------------------------------------------------------------------------------------


def loads(masses: Sequence[float], gravity: float) -> list[float]:
    """The force on each of a stack's contacts from below upwards: the weight above it [N]."""
    return [gravity * sum(masses[k:]) for k in range(len(masses))]


def hanging_bridge(planks: int, length: float, mass: float, stiffness: float, span: float, gravity: float) -> float:
    """How far the middle of a chain of rigid planks on springs hangs below its ends [m].

    length: of a plank, from joint to joint [m]; stiffness: of each of the planks + 1 joints [N/m]; span: between the
    ends [m]. Joint j pulls with (H, V_j), V_j being half the weight less that of j planks; a plank hangs along the mean
    of the pulls at its ends, and a joint gives way by its pull / stiffness. What is left is to find the H that spans
    the span.
    """
    pulls = [0.5 * planks * mass * gravity - j * mass * gravity for j in range(planks + 1)]
    slopes = [0.5 * (left + right) for left, right in pairwise(pulls)]

    def reach(horizontal: float) -> float:
        along = sum(length * horizontal / math.hypot(horizontal, slope) for slope in slopes)
        return along + (planks + 1) * horizontal / stiffness

    low, high = 0.0, stiffness * span
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reach(middle) < span else (low, middle)
    half = (planks - 1) // 2
    drop = sum(pull / stiffness for pull in pulls[: half + 1])
    return drop + sum(length * slope / math.hypot(low, slope) for slope in slopes[:half])


def hanging_links(links: int, length: float, mass: float, span: float, gravity: float) -> tuple[np.ndarray, np.ndarray]:
    """A chain of rigid links between two points at one height, the discrete catenary.

    Returns (links + 1, 2) the joints [m], the first at the origin, and (links + 1, 2) the pull of what comes after on
    what comes before each of them [N]. By the moments about its middle a link points along the mean of the pulls at its
    two ends; (H, V) differ by its weight in V. What is left is to find the H that spans the span.
    """
    if not 0.0 < span < links * length:
        raise ValueError(f"span = {span!r}: must be above 0 and below the chain's length, {links * length:g}")
    vertical = mass * gravity * (np.arange(links + 1) - 0.5 * links)
    slopes = 0.5 * (vertical[:-1] + vertical[1:])
    low, high = 0.0, 1.0
    while np.sum(length * high / np.hypot(high, slopes)) < span:
        high *= 2.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        short = np.sum(length * middle / np.hypot(middle, slopes)) < span
        low, high = (middle, high) if short else (low, middle)
    way = length * np.column_stack([np.full(links, low), slopes]) / np.hypot(low, slopes)[:, None]
    joints = np.vstack([np.zeros(2), np.cumsum(way, axis=0)])
    return joints, np.column_stack([np.full(links + 1, low), vertical])


def hanging_loads(masses: Sequence[float], gravity: float) -> np.ndarray:
    """(n,) the pull on each joint of what hangs in a row, from above: the weight of all below it [N]."""
    return gravity * np.cumsum(np.asarray(masses)[::-1])[::-1]


def cantilever_moments(pieces: int, length: float, mass: float, gravity: float) -> np.ndarray:
    """(pieces,) the moment at each weld of a level beam, from the wall: that of the weights beyond it [N m]."""
    beyond = pieces - np.arange(pieces)
    return 0.5 * mass * gravity * length * beyond**2


def atwood(mass1: float, mass2: float, gravity: float) -> tuple[float, float]:
    """Acceleration g (m1 - m2) / (m1 + m2) [m/s^2], and the pull in the rope, 2 m1 m2 g / (m1 + m2) [N]."""
    total = mass1 + mass2
    return gravity * (mass1 - mass2) / total, 2.0 * mass1 * mass2 * gravity / total


def buckling_height(hertz: float, gravity: float = 10.0, width: float = 1.0, height: float = 1.0) -> float:
    """Number of boxes at which a column on soft contacts buckles under its own weight, if nothing freezes its contacts.

    Greenhill's self-buckling, n^3 L^3 q = 7.837 E I, with a pair's tilt stiffness k (w / 2)^2 for E I / L, the weight
    m g / L for q, and the contact stiffness k = 0.4 m w0^2 of square boxes (sandbox/lab/sag.py).
    """
    w0 = 2.0 * math.pi * hertz
    return (0.7837 * w0 * w0 * width * width / (gravity * height)) ** (1.0 / 3.0)
