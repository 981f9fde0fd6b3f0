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


def orbit(radius: float, h: float, dt: float, pull: float = 60.0, seconds: float = 10.0) -> float:
    """How far an orbit leaves the circle, its pull looked up (dt - h) / 2 ahead and held for dt [m]."""
    x, v = np.array([radius, 0.0]), np.array([0.0, ref.orbit_speed(pull, radius)])
    worst = 0.0
    for _ in range(round(seconds / dt)):
        x = x + v * 0.5 * (dt - h)
        v = v - pull * x / np.hypot(*x) ** 3 * dt
        x = x + v * 0.5 * (dt + h)
        worst = max(worst, abs(np.hypot(*x) - radius))
    return worst


@pytest.mark.parametrize("parts", [1, 4, 64])
@pytest.mark.parametrize("radius", [3.0, 5.0])
def test_orbits_wobble_by_what_is_said(radius: float, parts: int) -> None:
    dt = 1 / 120
    assert orbit(radius, dt / parts, dt) == pytest.approx(ref.orbit_wobble(60.0, radius, dt / parts, dt), rel=2e-3)
    assert ref.orbit_wobble(60.0, radius, dt) == ref.orbit_wobble(60.0, radius, dt, dt)


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


# --- slopes, wedges, discs --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [0.2, 0.6, 1.2])
def test_block_and_wedge_move_as_newton_says(angle: float) -> None:
    wedge, block = 2.0, 0.7
    away, along = ref.wedge_accelerations(wedge, block, angle, G)
    sideways, down = along * math.cos(angle) - away, along * math.sin(angle)
    normal = block * (G - down) / math.cos(angle)  # from the block's vertical motion
    assert block * sideways == pytest.approx(normal * math.sin(angle))
    assert wedge * away == pytest.approx(normal * math.sin(angle))


def test_a_wedge_that_is_far_heavier_stands() -> None:
    away, along = ref.wedge_accelerations(1e9, 1.0, 0.5, G)
    assert away == pytest.approx(0.0, abs=1e-6)
    assert along == pytest.approx(G * math.sin(0.5))


def test_rolling_and_slipping_meet_where_friction_is_just_enough() -> None:
    friction, radius = 0.2, 0.5
    angle = math.atan(3.0 * friction)
    rolls = ref.rolling_acceleration(angle, G)
    assert rolls == pytest.approx(ref.slope_acceleration(angle, friction, G))
    assert rolls / radius == pytest.approx(ref.slip_spin(angle, friction, radius, G))


def test_a_skidding_disc_keeps_its_angular_momentum_about_the_floor() -> None:
    time, speed = ref.skid(6.0, 0.25, G)
    radius, mass = 0.5, 2.0
    inertia = 0.5 * mass * radius**2
    assert mass * speed * radius + inertia * speed / radius == pytest.approx(mass * 6.0 * radius)
    assert 6.0 - 0.25 * G * time == pytest.approx(speed)


# --- springs, damping -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("h", [1 / 60, 1 / 960])
def test_soft_springs_swing_as_their_two_passes_make_them(h: float) -> None:
    omega, x, v, found = 2.0 * math.pi, 0.5, 0.0, []
    softer = 1.0 / (1.0 + (omega * h) ** 2)
    for _ in range(round(2.0 / h)):
        x += h * softer * (v - h * omega**2 * x)  # v' = v - h w^2 (x + h v')
        v = softer * (v - h * omega**2 * x)  # v1 = v - h w^2 (x1 + h v1)
        found.append(x)
    t = h * np.arange(1, len(found) + 1)
    assert ref.soft_oscillation(0.5, omega, h, t) == pytest.approx(np.array(found), abs=1e-10)
    # as long a period as the zeros of the curve have, which is damped but else a cosine
    signs = np.flatnonzero(np.diff(np.sign(found)))
    assert len(signs) == 4
    excess = ref.soft_period_excess(omega, h)
    assert (t[signs[2]] - t[signs[0]]) == pytest.approx(1.0 + excess, abs=1.5 * h)
    assert excess == pytest.approx(11.0 / 24.0 * (omega * h) ** 2, rel=0.01)


@pytest.mark.parametrize("h", [1 / 60, 1 / 960])
def test_implicit_springs_swing_as_implicit_euler_has_it(h: float) -> None:
    omega, x, v, found = 2.0 * math.pi, 0.5, 0.0, []
    for _ in range(round(2.0 / h)):
        v = (v - h * omega**2 * x) / (1.0 + (omega * h) ** 2)
        x += h * v
        found.append(x)
    t = h * np.arange(1, len(found) + 1)
    assert ref.implicit_oscillation(0.5, omega, h, t) == pytest.approx(np.array(found), abs=1e-10)
    assert ref.implicit_period_excess(omega, h) == pytest.approx((omega * h) ** 2 / 3.0, rel=0.01)


@pytest.mark.parametrize("amplitude", [0.3, 2.0])
def test_energy_of_a_swing_wobbles_by_what_is_said(amplitude: float) -> None:
    inertia, mass, distance, h = 5.0, 1.3, 1.7, 1e-4
    pull = mass * G * distance
    x, v, worst = amplitude, 0.0, 0.0
    for _ in range(30_000):
        v -= h * pull * math.sin(x) / inertia
        x += h * v
        worst = max(worst, abs(0.5 * inertia * v * v - pull * (math.cos(x) - math.cos(amplitude))))
    found = ref.swing_wobble(inertia, mass, distance, G, amplitude, h)
    assert worst / (pull * (1.0 - math.cos(amplitude))) == pytest.approx(found, rel=1e-3)


def test_damping_lags_by_what_is_said() -> None:
    h, speed = 1 / 60, 6.0
    for _ in range(120):
        speed /= 1.0 + 0.7 * h
    assert speed - ref.damped(6.0, 0.7, 2.0) == pytest.approx(ref.damping_excess(6.0, 0.7, h, 2.0), rel=1e-9)


# --- impacts ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_collisions_keep_momentum_and_lose_the_energy_that_they_must(restitution: float) -> None:
    after = ref.collision(1.0, 3.0, 4.0, -1.0, restitution)
    assert 1.0 * after[0] + 3.0 * after[1] == pytest.approx(1.0)
    assert after[1] - after[0] == pytest.approx(5.0 * restitution)
    lost = 0.5 * (4.0**2 + 3.0) - 0.5 * (after[0] ** 2 + 3.0 * after[1] ** 2)
    assert lost == pytest.approx(0.5 * 0.75 * (1.0 - restitution**2) * 5.0**2)


def test_a_push_past_the_centre_meets_less_mass() -> None:
    through = ref.off_centre_impulse(1.0, 2.0, 1.5, 0.0, 5.0, 0.5)
    assert through == pytest.approx(1.5 * 5.0 / 1.5)
    push = ref.off_centre_impulse(1.0, 2.0, 1.5, 0.8, 5.0, 0.5)
    point = push / 2.0 + 0.8 * (0.8 * push / 1.5)  # of the rod, where it was hit
    assert point - (5.0 - push) == pytest.approx(0.5 * 5.0)


# --- what hangs -------------------------------------------------------------------------------------------------------


def test_hanging_links_are_in_balance_one_by_one() -> None:
    joints, pulls = ref.hanging_links(7, 1.2, 2.0, 6.0, G)
    assert joints[0] == pytest.approx([0.0, 0.0])
    assert joints[-1] == pytest.approx([6.0, 0.0], abs=1e-9)
    assert np.hypot(*np.diff(joints, axis=0).T) == pytest.approx(np.full(7, 1.2))
    for k in range(7):
        before, after = -pulls[k], pulls[k + 1]
        assert before + after + [0.0, -2.0 * G] == pytest.approx([0.0, 0.0], abs=1e-9)
        half = 0.5 * (joints[k + 1] - joints[k])
        turning = half[0] * (after[1] - before[1]) - half[1] * (after[0] - before[0])
        assert turning == pytest.approx(0.0, abs=1e-9)


def test_hanging_links_are_a_bridge_whose_joints_do_not_give_way() -> None:
    joints, _ = ref.hanging_links(7, 1.2, 2.0, 6.0, G)
    middle = 0.5 * (joints[3, 1] + joints[4, 1])
    assert ref.hanging_bridge(7, 1.2, 2.0, 1e12, 6.0, G) == pytest.approx(-middle, rel=1e-9)


@pytest.mark.parametrize("span", [0.0, 8.4, -1.0])
def test_links_that_cannot_span_it_are_refused(span: float) -> None:
    with pytest.raises(ValueError, match=r"span = .*: must be above 0 and below the chain's length, 8.4"):
        ref.hanging_links(7, 1.2, 2.0, span, G)


def test_loads_of_what_hangs_and_of_what_sticks_out() -> None:
    assert ref.hanging_loads([1.0, 2.0, 4.0], G) == pytest.approx([70.0, 60.0, 40.0])
    # of three pieces of 2 m and 10 N: 10 (1 + 3 + 5), 10 (1 + 3), 10
    assert ref.cantilever_moments(3, 2.0, 1.0, G) == pytest.approx([90.0, 40.0, 10.0])


def test_atwood_pulls_both_with_the_same_rope() -> None:
    acceleration, tension = ref.atwood(3.0, 2.0, G)
    assert 3.0 * G - tension == pytest.approx(3.0 * acceleration)
    assert tension - 2.0 * G == pytest.approx(2.0 * acceleration)
