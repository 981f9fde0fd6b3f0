"""Springs of joints against the oscillator: step by step, period and decay, how they converge, how low they hang."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Circle
from tests.engine.joints.making import GRAVITY, SPRUNG, one_freedom, world_of_joints
from tests.engine.worlds import DT, run

every_spring = pytest.mark.parametrize("name", SPRUNG)


def substeps_of(x: float, v: float, pull: float, omega: float, damping: float, h: float, count: int):
    """The spring's equation as soft_step takes it, from x [m] and v [m/s] under a pull [m/s^2]: after each substep.

    In the biased pass v comes from an implicit Euler step of x'' = pull - w^2 x - 2 z w x', with which x moves; when
    the push is taken back a spring, being a force, is an implicit step from where the body has come to.
    """
    drag = 1 + 2 * damping * h * omega + (h * omega) ** 2
    for _ in range(count):
        free = v + h * pull
        x += h * (free - h * omega * omega * x) / drag
        v = (free - h * omega * omega * x) / drag
        yield x, v


@every_spring
@pytest.mark.parametrize("damping", [0.0, 0.4, 1.5])
def test_each_substep_is_an_implicit_step_of_the_oscillator(name: str, damping: float) -> None:
    hertz, start, speed, load = 1.7, 0.2, -0.5, 6.0
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=hertz, damping_ratio=damping)
    sprung.move(start, speed)
    expected = substeps_of(start, speed, load / sprung.inertia, 2 * math.pi * hertz, damping, DT / 4, 4 * 60)
    for step, (x, _) in enumerate(expected, 1):
        if step % 4 == 0:
            sprung.pull(load)
            sprung.world.step(DT)
            assert sprung.value() == pytest.approx(x, abs=1e-11)


@every_spring
def test_period_and_decay_without_a_damper(name: str) -> None:
    # the two steps above as a matrix have the eigenvalues a e^(+-i theta): a = 1/(1 + (h w)^2), cos theta = (1 + a)/2
    hertz, start = 0.8, 0.3
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=hertz, damping_ratio=0.0)
    sprung.move(start, 0.0)
    h = DT / 4
    part = 1 / (1 + (2 * math.pi * hertz * h) ** 2)
    period = 2 * math.pi * h / math.acos((1 + part) / 2)
    assert period == pytest.approx(1 / hertz, rel=1e-3), "not far from the spring's own"
    values = []
    for _ in range(round(4.2 / hertz / DT)):
        sprung.world.step(DT)
        values.append(sprung.value())
    crossings = [
        (k + values[k] / (values[k] - values[k + 1]) + 1) * DT
        for k in range(len(values) - 1)
        if values[k] * values[k + 1] < 0
    ]
    assert np.diff(crossings).mean() == pytest.approx(period / 2, rel=2e-4)
    peaks = [max(values[k : k + round(1 / hertz / DT)]) for k in (0, round(3 / hertz / DT) - 5)]
    assert peaks[1] / start == pytest.approx(part ** (3 * period / h), rel=2e-3)


@every_spring
def test_it_converges_to_the_oscillator_in_the_first_order(name: str) -> None:
    hertz, damping, start = 1.5, 0.3, 0.25
    omega = 2 * math.pi * hertz
    swinging, decay = omega * math.sqrt(1 - damping**2), damping * omega
    errors = []
    for substeps in (4, 16, 64):
        sprung = one_freedom(
            name, world_of_joints(gravity=(0, 0), substeps=substeps), hertz=hertz, damping_ratio=damping
        )
        sprung.move(start, 0.0)
        worst = 0.0
        for step in range(1, 46):
            sprung.world.step(DT)
            t = step * DT
            exact = start * math.exp(-decay * t) * (math.cos(swinging * t) + decay / swinging * math.sin(swinging * t))
            worst = max(worst, abs(sprung.value() - exact))
        errors.append(worst)
    assert errors[0] < 0.1 * start
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4, rel=0.1)


@every_spring
def test_under_a_load_it_rests_where_stiffness_says_and_tells_the_load(name: str) -> None:
    hertz, load = 2.0, 9.0
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=hertz, damping_ratio=1.0)
    for _ in range(240):
        sprung.pull(load)
        sprung.world.step(DT)
    stiffness = sprung.inertia * (2 * math.pi * hertz) ** 2  # k = m w^2
    assert sprung.value() == pytest.approx(load / stiffness, rel=1e-8)
    assert sprung.told() == pytest.approx(-load, rel=1e-8)


@pytest.mark.parametrize("name", ["revolute", "prismatic", "wheel"])
def test_it_rests_at_its_target(name: str) -> None:
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=3.0, target=0.35)
    run(sprung.world, 180)
    assert sprung.value() == pytest.approx(0.35, abs=1e-8)
    sprung.joint.target = -0.2
    run(sprung.world, 180)
    assert sprung.value() == pytest.approx(-0.2, abs=1e-8)


def test_a_distance_spring_rests_at_its_length() -> None:
    sprung = one_freedom("distance", world_of_joints(gravity=(0, 0)), hertz=3.0, length=2.3)
    run(sprung.world, 180)
    assert sprung.joint.current_length == pytest.approx(2.3, abs=1e-8)
    sprung.joint.length = 1.5
    run(sprung.world, 180)
    assert sprung.joint.current_length == pytest.approx(1.5, abs=1e-8)


@every_spring
def test_frequency_and_damping_are_set_at_any_time(name: str) -> None:
    # the same bits as of a joint that was made with them
    part = f"{name.split()[1]}_" if " " in name else ""
    late = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=9.0, damping_ratio=0.1)
    early = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=2.0, damping_ratio=0.6)
    setattr(late.joint, f"{part}hertz", 2.0)
    setattr(late.joint, f"{part}damping_ratio", 0.6)
    for sprung in (late, early):
        sprung.move(0.2, 0.1)
        run(sprung.world, 20)
    assert late.world.state_hash() == early.world.state_hash()
    assert getattr(late.joint, f"{part}hertz") == pytest.approx(2.0)
    assert getattr(late.joint, f"{part}damping_ratio") == pytest.approx(0.6)


@pytest.mark.parametrize("name", ["revolute", "prismatic", "wheel"])
def test_without_a_spring_it_is_free_and_with_one_again_it_is_sprung(name: str) -> None:
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=2.0)
    sprung.joint.hertz = None
    assert sprung.joint.hertz is None
    sprung.move(0.1, 0.5)
    run(sprung.world, 30)
    assert sprung.value() == pytest.approx(0.1 + 0.5 * 30 * DT, rel=1e-9)
    assert sprung.told() == pytest.approx(0.0, abs=1e-9)
    sprung.joint.hertz = 2.0
    run(sprung.world, 240)
    assert sprung.value() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("name", ["distance", "weld linear", "weld angular", "motor linear", "motor angular", "mouse"])
def test_without_a_frequency_it_is_as_stiff_as_joints_are(name: str) -> None:
    sprung = one_freedom(name, world_of_joints(gravity=(0, 0)), hertz=2.0)
    part = f"{name.split()[1]}_" if " " in name else ""
    setattr(sprung.joint, f"{part}hertz", None)
    load = 9.0
    for _ in range(120):
        sprung.pull(load)
        sprung.world.step(DT)
    omega = 2 * math.pi * 4 / DT / 4
    assert sprung.value() == pytest.approx(load / sprung.inertia / omega**2, rel=1e-6)
    assert sprung.told() == pytest.approx(-load, rel=1e-8)


@pytest.mark.parametrize("damping", [0.0, 0.7])
def test_between_two_free_bodies_it_swings_about_their_centre(damping: float) -> None:
    # x = x2 - x1 obeys the same equation, whatever the masses: the frequency is that of the two
    world = world_of_joints(gravity=(0, -GRAVITY))
    a = world.create_body(Circle(0.1), position=(0, 0), mass=1.5)
    b = world.create_body(Circle(0.1), position=(2, 0), mass=4.0)
    world.create_joint_distance(
        a, b, anchor1=(0, 0), anchor2=(2, 0), hertz=1.3, damping_ratio=damping, collide_connected=False
    )
    b.velocity = (1.2, 0.0)
    x = 0.0
    expected = substeps_of(0.0, 1.2, 0.0, 2 * math.pi * 1.3, damping, DT / 4, 4 * 60)
    for step, (x, _) in enumerate(expected, 1):
        if step % 4 == 0:
            world.step(DT)
            assert b.position.x - a.position.x - 2 == pytest.approx(x, abs=1e-10)
    assert 1.5 * a.velocity.x + 4.0 * b.velocity.x == pytest.approx(4.0 * 1.2, rel=1e-13)
