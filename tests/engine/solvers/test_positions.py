"""xpbd and avbd: exact answers, what stands, what it weighs, and how errors fall."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from engine import Box, Circle, World
from engine.constants import AVBD_ALPHA
from tests.engine.worlds import DT, PRECISIONS, floor, run

G = 10.0
BOTH = ["xpbd", "avbd"]
either = pytest.mark.parametrize("solver", BOTH)


def stack(boxes: int, **settings: object) -> World:
    world = World(sleeping=False, **settings)
    floor(world)
    for k in range(boxes):
        world.create_body(Box(1, 1), position=(0, 0.5 + k), friction=0.6)
    return world


def sunk(world: World) -> float:
    """How far the top of a stack is below where it would stand [m]."""
    return len(world.bodies) - 1.5 - world.bodies[-1].position.y


@pytest.mark.parametrize(("solver", "substeps"), [("xpbd", 1), ("xpbd", 7), ("avbd", 1)])
def test_what_nothing_holds_falls_as_symplectic_euler_says(solver: str, substeps: int) -> None:
    world = World(precision="double", solver=solver, substeps=substeps)
    ball = world.create_body(Circle(0.5), position=(0, 0), velocity=(3, 4), angular_velocity=2)
    floor(world)
    ball.position = (0, 50)
    run(world, 60)
    h, t = DT / substeps, 60 * DT
    assert tuple(ball.position) == pytest.approx((3 * t, 50 + 4 * t - G * t * (t + h) / 2), abs=1e-11)
    assert ball.velocity.y == pytest.approx(4 - G * t, abs=1e-11)
    assert ball.angle == pytest.approx(2 * t, abs=1e-12)


@pytest.mark.parametrize(("hertz", "ratio"), [(1.0, 0.0), (2.0, 0.3), (5.0, 1.0)])
@pytest.mark.parametrize(("solver", "substeps"), [("xpbd", 1), ("xpbd", 4), ("xpbd", 32), ("avbd", 1)])
def test_a_spring_is_an_implicit_step_of_its_equation(solver: str, substeps: int, hertz: float, ratio: float) -> None:
    # v1 = (v0 + h (g - w^2 x0)) / (1 + 2 h zeta w + h^2 w^2), x1 = x0 + h v1, x along gravity
    world = World(precision="double", solver=solver, substeps=substeps, sleeping=False)
    pin = world.create_body(kind="static", position=(0, 0))
    bob = world.create_body(Circle(0.2), position=(0, -2), velocity=(0, 1.0), mass=1.7)
    world.create_joint_distance(pin, bob, anchor1=(0, 0), anchor2=(0, -2), length=2, hertz=hertz, damping_ratio=ratio)
    x, v, h, w = 0.0, -1.0, DT / substeps, 2 * math.pi * hertz
    for _ in range(60):
        world.step(DT)
        for _ in range(substeps):
            v = (v + h * (G - w * w * x)) / (1 + 2 * h * ratio * w + h * h * w * w)
            x += h * v
        assert -2 - bob.position.y == pytest.approx(x, abs=1e-9)
        assert -bob.velocity.y == pytest.approx(v, abs=1e-8)


def period(length: float, amplitude: float, inertia: float) -> float:
    """Of a pendulum of mass 1, exactly: by the arithmetic-geometric mean [s]."""
    a, b = 1.0, math.cos(amplitude / 2)
    for _ in range(20):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi * math.sqrt((inertia + length * length) / (G * length)) / a


def measured_period(amplitude: float, **settings: object) -> tuple[float, float]:
    """Of the first swing, there and back: and the largest distance that its joint had come apart."""
    world = World(precision="double", sleeping=False, **settings)
    pin = world.create_body(kind="static")
    bob = world.create_body(Circle(0.1), position=(math.sin(amplitude), -math.cos(amplitude)), mass=1)
    joint = world.create_joint_revolute(pin, bob, anchor=(0, 0))
    crossings: list[float] = []
    apart = 0.0
    while len(crossings) < 3:
        before = bob.position.x
        world.step(DT)
        one, other = joint.anchors
        apart = max(apart, math.dist(one, other))
        if before * bob.position.x < 0:
            crossings.append(world.time - DT * abs(bob.position.x) / abs(bob.position.x - before))
    return crossings[2] - crossings[0], apart


def test_the_period_of_a_pendulum_comes_with_smaller_substeps() -> None:
    exact = period(1.0, 1.0, Circle(0.1).inertia(1))
    errors = []
    for substeps in (8, 16, 32, 64):
        found, apart = measured_period(1.0, solver="xpbd", substeps=substeps)
        errors.append(exact - found)
        assert apart < 1e-6
    assert errors[0] < 0.01 * exact
    for coarse, fine in pairwise(errors):
        assert 1.7 < coarse / fine < 2.3, "of first order: positions are taken along the chord"


def test_the_period_of_a_pendulum_with_avbd_comes_with_smaller_steps() -> None:
    found, apart = measured_period(1.0, solver="avbd")
    exact = period(1.0, 1.0, Circle(0.1).inertia(1))
    assert found == pytest.approx(exact, rel=0.05), "one implicit step of 1/60 s each: it loses energy"
    assert found < exact, "and swings less and less far"
    assert apart < 5e-3


# --- friction ---------------------------------------------------------------------------------------------------------

CREEP = {"xpbd": 1e-9, "avbd": 4e-4}  # [m/s]: avbd starts each step from 0.94 of its friction
SLIDES = {"xpbd": 1e-9, "avbd": 2e-2}


@pytest.mark.parametrize("angle", [0.3, math.atan(0.6) - 0.02, math.atan(0.6) + 0.02, 0.9])
@either
def test_a_box_on_a_slope_sticks_or_slides(solver: str, angle: float) -> None:
    world = World(
        gravity=(G * math.sin(angle), -G * math.cos(angle)), precision="double", solver=solver, sleeping=False
    )
    floor(world, friction=0.6)
    box = world.create_body(Box(2, 0.5), position=(0, 0.25), friction=0.6)
    run(world, 60)
    place, speed = box.position.x, box.velocity.x
    run(world, 60)
    if math.tan(angle) < 0.6:
        assert box.position.x - place == pytest.approx(0.0, abs=CREEP[solver])
    else:
        expected = G * (math.sin(angle) - 0.6 * math.cos(angle))
        assert box.velocity.x - speed == pytest.approx(expected, rel=SLIDES[solver])


# --- stacks -----------------------------------------------------------------------------------------------------------


WEIGHS = {"xpbd": 2e-3, "avbd": 3e-2}  # after 10 iterations one body does not know yet what the next one pushes with


@pytest.mark.parametrize("precision", PRECISIONS)
@either
def test_ten_boxes_stand_and_weigh_what_is_above(solver: str, precision: str) -> None:
    world = run(stack(10, solver=solver, precision=precision), 300)
    assert 0 <= sunk(world) < 2e-3
    assert abs(world.positions[1:, 0]).max() < 1e-3
    assert abs(world.velocities).max() < 1e-3
    weight = world.bodies[1].mass * G * DT
    for k in range(10):
        mine = sum(arbiter_impulse for arbiter_impulse in impulses(world, k, k + 1))
        assert mine == pytest.approx((10 - k) * weight, rel=WEIGHS[solver])


def impulses(world: World, one: int, other: int) -> list[float]:
    """Along the normal, of the contacts between two bodies, by serial [N s]."""
    records = world.contact_records()
    return list(records["normal_impulse"][(records["body1"] == one) & (records["body2"] == other)])


def test_overlap_falls_with_the_square_of_the_substep() -> None:
    found = [sunk(run(stack(6, solver="xpbd", precision="double", substeps=n), 120)) for n in (4, 8, 16)]
    assert found[0] / found[1] == pytest.approx(4, rel=0.05)
    assert found[1] / found[2] == pytest.approx(4, rel=0.05)


def test_overlap_falls_with_iterations() -> None:
    found = [sunk(run(stack(10, solver="avbd", precision="double", iterations=n), 300)) for n in (4, 10, 30)]
    assert found[0] > 2 * found[1] > 4 * found[2]


@either
def test_the_energy_of_a_stack_at_rest_does_not_grow(solver: str) -> None:
    world = stack(8, solver=solver, precision="double")
    start = world.diagnostics().energy
    for _ in range(200):
        world.step(DT)
        assert world.diagnostics().energy <= start + 1e-9 * start
        assert world.diagnostics().kinetic_energy < 1e-3 * start


@pytest.mark.parametrize(("solver", "ratio"), [("xpbd", 100), ("avbd", 400)])
def test_a_light_box_bears_a_heavy_one(solver: str, ratio: float) -> None:
    # xpbd carries nothing from substep to substep, and 16 of them do not bear 400
    world = World(solver=solver, sleeping=False)
    floor(world)
    world.create_body(Box(1, 1), position=(0, 0.5), friction=0.6)
    top = world.create_body(Box(1, 1), position=(0, 1.5), mass=ratio, friction=0.6)
    run(world, 300)
    assert top.position.y == pytest.approx(1.5, abs=0.02)
    assert abs(top.position.x) < 0.01


@pytest.mark.parametrize(("solver", "ratio", "most"), [("xpbd", 100, 3e-3), ("avbd", 100, 5e-3), ("avbd", 1000, 4e-2)])
def test_a_chain_holds_a_heavy_end(solver: str, ratio: float, most: float) -> None:
    world = World(solver=solver, sleeping=False)
    last = world.create_body(kind="static")
    for k in range(20):
        link = world.create_body(Box(0.2, 1.0), position=(0, -0.5 - k))
        world.create_joint_revolute(last, link, anchor=(0, -k))
        last = link
    end = world.create_body(Box(1, 1), position=(0, -20.5), mass=ratio * last.mass)
    joint = world.create_joint_revolute(last, end, anchor=(0, -20))
    run(world, 400)
    assert max(math.dist(*joint.anchors) for joint in world.joints) < most
    forces = []
    for _ in range(60):
        world.step(DT)
        forces.append(joint.force.y)
    assert np.mean(forces) == pytest.approx(end.mass * G, rel=0.01 if solver == "xpbd" else 0.06)


# --- overlap ----------------------------------------------------------------------------------------------------------


def test_with_xpbd_overlap_goes_and_leaves_no_speed() -> None:
    world = World(solver="xpbd", precision="double", sleeping=False, gravity=(0, 0))
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.3))
    fastest = 0.0
    for _ in range(200):
        before = ball.position.y
        world.step(DT)
        fastest = max(fastest, (ball.position.y - before) / DT)
    assert ball.position.y == pytest.approx(0.5, abs=1e-3)
    assert fastest <= world.push_out_speed * (1 + 1e-9)
    assert abs(ball.velocity.y) < 1e-3


@pytest.mark.parametrize("limit", [3.0, 0.1])
def test_with_avbd_overlap_goes_by_a_twentieth_a_step_and_leaves_its_speed(limit: float) -> None:
    world = World(solver="avbd", precision="double", sleeping=False, gravity=(0, 0), push_out_speed=limit)
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.3))
    world.step(DT)
    expected = min((1 - AVBD_ALPHA) * 0.2, limit * DT)
    assert ball.position.y - 0.3 == pytest.approx(expected, rel=1e-3)
    run(world, 200)
    assert ball.position.y > 0.499
    assert abs(ball.velocity.y) <= 1.05 * expected / DT  # and what 10 iterations leave


@either
def test_without_position_correction_overlap_stays(solver: str) -> None:
    world = World(solver=solver, precision="double", gravity=(0, 0), position_correction=False)
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.3))
    run(world, 30)
    assert ball.position.y == 0.3


# --- xpbd bounces, avbd does not --------------------------------------------------------------------------------------


@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("shape", [Circle(0.5), Box(1, 1)])
def test_it_rises_to_e_squared_of_the_height(shape: Box | Circle, e: float) -> None:
    world = World(precision="double", solver="xpbd")
    floor(world)
    body = world.create_body(shape, position=(0, 5.5), restitution=e)
    while body.velocity.y <= 0:
        world.step(DT)
    while body.velocity.y > 0:
        world.step(DT)
    assert body.position.y - 0.5 == pytest.approx(e * e * 5, rel=0.02)
    assert body.angle == pytest.approx(0.0, abs=1e-9)


def test_avbd_refuses_what_bounces() -> None:
    world = World(solver="avbd")
    with pytest.raises(ValueError, match=r"^restitution = 0.5: must be 0.0 with the solver 'avbd'$"):
        world.create_body(Circle(0.5), restitution=0.5)
    world = World()
    world.create_body(Circle(0.5), rolling_resistance=0.1)
    with pytest.raises(ValueError, match=r"^solver = 'avbd': must be one that knows rolling resistance"):
        world.solver = "avbd"


# --- state ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("precision", PRECISIONS)
@either
def test_a_restored_world_goes_on_to_the_bit(solver: str, precision: str) -> None:
    world = stack(3, solver=solver, precision=precision)
    one, other = world.bodies[2], world.create_body(Circle(0.4), position=(1.2, 0.6), velocity=(-3, 0))
    world.create_joint_revolute(one, other, anchor=(1, 1), lower=-0.5, upper=0.5)
    run(world, 17)
    copy = World(precision=precision)
    copy.restore(world.snapshot())
    for _ in range(30):
        world.step(DT)
        copy.step(DT)
        assert copy.state_hash() == world.state_hash()


def test_avbd_starts_from_the_impulses_of_the_step_before() -> None:
    settled = run(stack(5, solver="avbd", precision="double"), 100)
    cold = settled.snapshot()
    world = World(precision="double")
    world.restore(cold)
    world.warm_starting = False
    world.step(DT)
    settled.step(DT)
    assert abs(settled.velocities).max() < 1e-4 < 1e-3 < abs(world.velocities).max()
