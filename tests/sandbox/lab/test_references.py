"""Every closed form against something that does not know it: quadrature, small steps, or the recurrence itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sandbox.lab import references as ref

G = 10.0


def euler(position: float, speed: float, acceleration: float, h: float, steps: int) -> tuple[float, float]:
    """Symplectic Euler, as the engine does it."""
    for _ in range(steps):
        speed += acceleration * h
        position += speed * h
    return position, speed


@pytest.mark.parametrize("h", [0.1, 1 / 60, 1 / 1920])
def test_flight_lags_by_what_is_said(h: float) -> None:
    steps = round(2.0 / h)
    found, _ = euler(3.0, 12.0, -G, h, steps)
    exact = ref.flight(3.0, 12.0, G, steps * h)
    assert exact - found == pytest.approx(ref.flight_lag(G, h, steps * h), rel=1e-9)


def test_flight_ends_where_energy_says() -> None:
    top = 12.0**2 / (2 * G)
    assert ref.flight(0.0, 12.0, G, 12.0 / G) == pytest.approx(top)


@pytest.mark.parametrize(("restitution", "bounces"), [(1.0, 3), (0.8, 1), (0.5, 2), (0.0, 1)])
def test_apex_is_reached_with_the_speed_that_comes_back(restitution: float, bounces: int) -> None:
    speed = math.sqrt(2 * G * 5.0) * restitution**bounces
    assert ref.apex(5.0, restitution, bounces) == pytest.approx(speed**2 / (2 * G))


@pytest.mark.parametrize("friction", [0.1, 0.5, 1.0])
def test_sliding_stops_after_its_energy_is_used_up(friction: float) -> None:
    assert friction * G * ref.stopping_distance(7.0, friction, G) == pytest.approx(0.5 * 7.0**2)


def test_stopping_lags_by_what_is_said() -> None:
    h, friction, speed = 1 / 60, 0.5, 10.0
    steps = round(speed / (friction * G * h))  # then it stands
    found, left = euler(0.0, speed, -friction * G, h, steps)
    assert left == pytest.approx(0.0, abs=1e-9)
    assert ref.stopping_distance(speed, friction, G) - found == pytest.approx(ref.stopping_lag(speed, h), rel=1e-9)


@pytest.mark.parametrize("angle", [0.1, 0.3, 0.6])
def test_friction_is_read_off_the_slide(angle: float) -> None:
    friction = 0.5 * math.tan(angle)
    distance = 0.5 * ref.slope_acceleration(angle, friction, G) * 3.0**2
    assert ref.friction_seen(angle, distance, G, 3.0) == pytest.approx(friction)


def test_what_sticks_does_not_accelerate() -> None:
    assert ref.slope_acceleration(0.2, math.tan(0.2) + 1e-9, G) == 0.0
    assert ref.slope_acceleration(0.2, 0.0, G) == pytest.approx(G * math.sin(0.2))


def test_rolling_ends_where_the_resistance_has_taken_all_energy() -> None:
    mass, radius, speed, resistance = 2.0, 0.5, 3.0, 0.01
    energy = 0.5 * mass * speed**2 + 0.5 * (0.5 * mass * radius**2) * (speed / radius) ** 2
    turns = ref.rolling_distance(speed, resistance, radius, G) / radius
    assert resistance * mass * G * turns == pytest.approx(energy)


@pytest.mark.parametrize(("a", "b"), [(1.0, 0.5), (1.0, 1.0), (3.0, 1e-6), (1.0, math.sqrt(0.5))])
def test_arithmetic_geometric_mean_is_gauss_integral(a: float, b: float) -> None:
    # 1 / AGM(a, b) = 2/pi times the integral of 1 / sqrt(a^2 cos^2 + b^2 sin^2) over a quarter turn
    mean = ref.arithmetic_geometric_mean(a, b)
    n = 200_000 if b < 0.01 else 2000  # the midpoint rule is exact to rounding for a periodic integrand, if fine enough
    angles = (np.arange(n) + 0.5) * 0.5 * math.pi / n
    substituted = np.mean(1.0 / np.sqrt((a * np.cos(angles)) ** 2 + (b * np.sin(angles)) ** 2))
    if b >= 0.01:
        assert mean == pytest.approx(1.0 / substituted, rel=1e-12)
    assert min(a, b) <= mean <= 0.5 * (a + b)


@pytest.mark.parametrize("amplitude", [0.01, 0.5, 0.5 * math.pi, 2.0, 3.0])
def test_pendulum_period_is_the_integral_over_the_swing(amplitude: float) -> None:
    # T = 4 sqrt(I / 2 m g d) times the integral of 1 / sqrt(cos x - cos A) up to A, with sin(x/2) = sin(A/2) sin u
    inertia, mass, distance = 5.0, 1.3, 1.7
    n = 4000
    u = (np.arange(n) + 0.5) * 0.5 * math.pi / n
    k = math.sin(0.5 * amplitude)
    integral = np.sum(1.0 / np.sqrt(1.0 - (k * np.sin(u)) ** 2)) * 0.5 * math.pi / n
    expected = 4.0 * math.sqrt(inertia / (mass * G * distance)) * integral
    found = ref.pendulum_period(inertia, mass, distance, G, amplitude)
    assert found == pytest.approx(expected, rel=1e-10)


def test_small_swings_are_harmonic() -> None:
    assert ref.pendulum_period(4.0, 1.0, 2.0, G, 1e-4) == pytest.approx(2 * math.pi * math.sqrt(0.2), rel=1e-8)


def orbit(radius: float, h: float, pull: float = 60.0, seconds: float = 6.0) -> float:
    """How far symplectic Euler leaves the circle [m]."""
    x, v = np.array([radius, 0.0]), np.array([0.0, ref.orbit_speed(pull, radius)])
    worst = 0.0
    for _ in range(round(seconds / h)):
        v = v - pull * x / np.hypot(*x) ** 3 * h
        x = x + v * h
        worst = max(worst, abs(np.hypot(*x) - radius))
    return worst


@pytest.mark.parametrize("radius", [3.0, 5.0])
def test_orbits_wobble_by_what_is_said(radius: float) -> None:
    h = 1 / 960
    assert orbit(radius, h) == pytest.approx(ref.orbit_wobble(60.0, radius, h), rel=0.02)


def test_damping_is_what_small_steps_come_to() -> None:
    speed = 6.0
    for _ in range(100_000):
        speed -= 0.7 * speed * 2e-5
    assert ref.damped(6.0, 0.7, 2.0) == pytest.approx(speed, rel=1e-4)


def test_at_terminal_speed_drag_carries_the_weight() -> None:
    speed = ref.terminal_speed(1.5, G, 0.4)
    assert 0.4 * speed**2 == pytest.approx(1.5 * G)


def test_wind_takes_along_as_small_steps_come_to() -> None:
    speed, h = 0.0, 1e-5
    for _ in range(300_000):
        speed += 0.2 * (6.0 - speed) ** 2 / 1.5 * h
    assert ref.blown_speed(6.0, 0.2, 1.5, 3.0) == pytest.approx(speed, rel=1e-4)


def test_loads_are_the_weight_above() -> None:
    assert ref.loads([4.0, 1.0, 2.5], G) == [75.0, 35.0, 25.0]


@pytest.mark.parametrize("count", [1, 2, 5, 9])
def test_each_floating_magnet_is_in_balance(count: int) -> None:
    heights = np.append(0.0, ref.levitation(count, 7.0))
    assert (np.diff(heights) > 0).all()
    for k in range(1, count + 1):
        apart = heights[k] - np.delete(heights, k)
        assert np.sum(7.0 * np.sign(apart) / apart**2) == pytest.approx(1.0, rel=1e-9)


def test_one_magnet_floats_where_the_push_is_its_weight() -> None:
    assert ref.levitation(1, 9.0)[0] == pytest.approx(3.0)


def bridge_energy_gradient(q: np.ndarray, planks: int, length: float, mass: float, k: float, span: float) -> np.ndarray:
    """Of springs and weights, by x, y and angle of each plank."""
    gradient = np.zeros_like(q)
    left_end, right_end = np.array([0.0, 0.0]), np.array([span, 0.0])
    for joint in range(planks + 1):
        before, after = left_end, right_end
        arms = []
        if joint > 0:
            x, y, a = q[joint - 1]
            arm = 0.5 * length * np.array([math.cos(a), math.sin(a)])
            before = np.array([x, y]) + arm
            arms.append((joint - 1, arm, -1.0))
        if joint < planks:
            x, y, a = q[joint]
            arm = -0.5 * length * np.array([math.cos(a), math.sin(a)])
            after = np.array([x, y]) + arm
            arms.append((joint, arm, 1.0))
        pull = k * (after - before)
        for plank, arm, sign in arms:
            gradient[plank] += sign * np.array([*pull, arm[0] * pull[1] - arm[1] * pull[0]])
    gradient[:, 1] += mass * G
    return gradient


def test_bridge_hangs_where_its_energy_is_least() -> None:
    planks, length, mass, k = 5, 1.25, 50.0, 4e4
    span = planks * length
    q = np.zeros((planks, 3))
    q[:, 0] = (np.arange(planks) + 0.5) * length
    q[:, 1] = -0.6 * np.sin(np.pi * q[:, 0] / span)  # not straight, where it could not tell up from down

    def gradient(values: np.ndarray) -> np.ndarray:
        return bridge_energy_gradient(values.reshape(-1, 3), planks, length, mass, k, span).ravel()

    for _ in range(100):  # Newton's method in small steps, with differences for derivatives
        steps = 1e-6 * np.eye(q.size)
        slopes = np.array([gradient(q.ravel() + step) - gradient(q.ravel() - step) for step in steps]) / 2e-6
        change = np.linalg.solve(slopes.T, gradient(q))
        q = q - min(1.0, 0.05 / np.abs(change).max()) * change.reshape(-1, 3)
    assert np.abs(gradient(q)).max() < 1e-6
    assert q[planks // 2, 1] < 0.0
    assert ref.hanging_bridge(planks, length, mass, k, span, G) == pytest.approx(-q[planks // 2, 1], rel=1e-5)


@pytest.mark.parametrize(("hertz", "boxes"), [(30.0, 14.07), (60.0, 22.3), (120.0, 35.5), (240.0, 56.3)])
def test_buckling_height_is_greenhills(hertz: float, boxes: float) -> None:
    assert ref.buckling_height(hertz) == pytest.approx(boxes, abs=0.06)
