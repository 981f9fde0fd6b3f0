"""soft_step: how far its contacts give way, how overlap goes, what it looks ahead for, and which contacts it keeps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from engine import Body, Box, Capsule, Circle, Polygon, Shape, World
from engine.softness import softness, stiffness
from tests.engine.worlds import DT, POINTS, PRECISIONS, busy, floor, gathering, regular, run

G = 10.0

# --- contacts are springs ---------------------------------------------------------------------------------------------


def omega(**settings: Any) -> float:
    """Angular frequency of a contact of two bodies that move [1/s]: an eighth of the substep rate, if it follows."""
    hertz = settings.get("substeps", 4) / DT / 8
    if settings.get("stiffness") == "fixed":
        hertz = min(hertz, settings.get("contact_hertz", 30.0))
    return 2 * math.pi * hertz


def stiffness_of_two_points(inverse_masses: float, inverse_inertias: float, half: float) -> float:
    """Of a face on a face: two points `half` from the middle, each a spring of its effective mass, over omega^2."""
    return 2 / (inverse_masses + inverse_inertias * half * half)


@pytest.mark.parametrize(
    "settings",
    [{}, {"substeps": 2}, {"substeps": 9}, {"stiffness": "fixed", "contact_hertz": 12.0},
     {"stiffness": "fixed", "contact_hertz": 90.0, "substeps": 8}],
)  # fmt: skip
def test_bodies_sink_as_far_as_the_springs_give_way(settings: dict[str, Any]) -> None:
    # on the ground contacts have twice the frequency; between two boxes both turn and both move
    masses = [4.0, 1.0, 2.5]
    world = World(precision="double", sleeping=False, **settings)
    floor(world)
    boxes = [world.create_body(Box(1, 1), position=(0, 0.5 + k), mass=mass) for k, mass in enumerate(masses)]
    run(world, 400)
    expected, below = 0.0, None
    for k, mass in enumerate(masses):
        inertia = mass / 6
        if below is None:
            k_contact = stiffness_of_two_points(1 / mass, 1 / inertia, 0.5) * 4
        else:
            k_contact = stiffness_of_two_points(1 / mass + 1 / below, 1 / inertia + 6 / below, 0.5)
        expected += sum(masses[k:]) * G / (k_contact * omega(**settings) ** 2)
        below = mass
        assert 0.5 + k - boxes[k].position.y == pytest.approx(expected, rel=0.01)
    assert np.abs(world.velocities).max() < 1e-6


def test_substeps_make_it_stiffer_and_fixed_stiffness_does_not() -> None:
    sunk: dict[str, list[float]] = {"follows": [], "fixed": []}
    for kind, found in sunk.items():
        for substeps in (4, 8, 16):
            world = World(precision="double", substeps=substeps, stiffness=kind)
            floor(world)
            ball = world.create_body(Circle(0.5), position=(0, 0.5))
            run(world, 300)
            found.append(0.5 - ball.position.y)
    assert sunk["follows"][0] / sunk["follows"][1] == pytest.approx(4, rel=0.01)
    assert sunk["follows"][1] / sunk["follows"][2] == pytest.approx(4, rel=0.01)
    assert sunk["fixed"] == pytest.approx([sunk["follows"][0]] * 3, rel=0.01)
    assert sunk["fixed"][0] == pytest.approx(G / (4 * omega() ** 2), rel=0.01)  # a circle: m w^2, and twice the w


def test_softness_is_an_implicit_step_of_a_damped_spring() -> None:
    # one mass on one soft constraint: solving (P = -m (mass_scale (v + bias_rate x)) - impulse_scale P0) equals
    # v1 = (v0 - h w^2 x) / (1 + 2 h zeta w + h^2 w^2)
    for hertz, ratio, h in ((30.0, 10.0, DT / 4), (60.0, 2.0, DT / 4), (5.0, 0.0, 0.1), (240.0, 0.7, 0.001)):
        soft = softness(hertz, ratio, h)
        w = 2 * math.pi * hertz
        x, v, m = 0.3, -2.0, 1.7
        after = v + -m * soft.mass_scale * (v + soft.bias_rate * x) / m
        assert after == pytest.approx((v - h * w * w * x) / (1 + 2 * h * ratio * w + h * h * w * w), rel=1e-12)
        assert soft.mass_scale + soft.impulse_scale == pytest.approx(1.0, rel=1e-15)
    assert softness(0.0, 1.0, 0.01) == (0.0, 1.0, 0.0), "rigid"


def test_stiffness_says_what_holds() -> None:
    follows = stiffness(World(substeps=8).settings, DT)
    assert (follows.contact_hertz, follows.joint_hertz) == (pytest.approx(60), pytest.approx(120))
    fixed = stiffness(World(substeps=8, stiffness="fixed", contact_hertz=1000, joint_hertz=7).settings, DT)
    assert (fixed.contact_hertz, fixed.joint_hertz) == (pytest.approx(60), 7), "never more than it can hold"
    off = stiffness(World(position_correction=False).settings, DT)
    assert off.contact == off.static == off.joint == (0.0, 1.0, 0.0)


# --- overlap ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("substeps", [1, 2, 4, 16, 50])
@pytest.mark.parametrize("limit", [0.5, 3.0])
def test_overlap_is_pushed_apart_gently(substeps: int, limit: float) -> None:
    # never faster than the push-out speed, as fast at any number of substeps, and nothing is left of the push
    world = World(precision="double", gravity=(0, 0), substeps=substeps, push_out_speed=limit, sleeping=False)
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.1))
    overlaps = [0.4]
    for _ in range(120):
        world.step(DT)
        overlaps.append(0.5 - ball.position.y)
        assert abs(ball.velocity.y) < 1e-12
    speeds = -np.diff(overlaps) / DT
    assert speeds.max() <= limit * (1 + 1e-9)
    assert speeds.min() >= 0
    assert overlaps[-1] < (1e-4 if limit == 3.0 else 2e-3)
    if limit == 3.0:
        # overlap falls off at bias_rate w / (2 zeta), about 9 a second twice over on the ground
        rate = math.log(overlaps[20] / overlaps[30]) / (10 * DT)
        assert 14 < rate < 20


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_heap_made_of_overlap_comes_apart_without_an_explosion(precision: str) -> None:
    world = World(precision=precision)
    floor(world)
    for k in range(12):
        world.create_body(Box(1, 1), position=(0.3 * (k % 3), 0.5 + 0.5 * (k // 3)), angle=0.05 * k)
    fastest = 0.0
    for _ in range(240):
        world.step(DT)
        fastest = max(fastest, float(np.abs(world.velocities).max()))
    assert fastest < 9.0  # a box is pushed by up to three others at once, each at the push-out speed of 3 m/s
    assert world.diagnostics().max_penetration < 0.01


def test_without_position_correction_overlap_stays() -> None:
    world = World(gravity=(0, 0), precision="double", position_correction=False)
    floor(world)
    world.create_body(Circle(0.5), position=(0, 0.2))
    world.create_body(Circle(0.5), position=(5, 0.2), velocity=(0, -3))
    run(world, 30)
    assert world.positions[1:, 1].tolist() == [0.2, 0.2]


# --- looking ahead ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", [Circle(0.5), Box(1, 1), Capsule(0.4, 0.5), Polygon(regular(4, math.sqrt(0.5)))])
def test_a_body_about_to_land_lands_on_the_surface(shape: Shape) -> None:
    # within the speculative distance it gets just the impulse that lets it meet; without, it goes in first
    deepest = {}
    for distance in (0.02, 0.0):
        world = World(precision="double", gravity=(0, 0), speculative_distance=distance)
        floor(world)
        turn = math.pi / 4 if isinstance(shape, Polygon) else 0.0
        body = world.create_body(shape, position=(0, 0.51), angle=turn, velocity=(0, -2))
        world.step(DT)
        deepest[distance] = 0.5 - body.position.y
        if distance:  # of two points the one that is solved first takes a little too much
            assert body.velocity.y == pytest.approx(0.0, abs=1e-9 if isinstance(shape, Circle) else 0.1)
    assert deepest[0.02] == pytest.approx(0.0, abs=1e-9 if isinstance(shape, Circle) else 1e-3)
    assert deepest[0.0] == pytest.approx(2 * DT - 0.01, rel=1e-9)


def test_a_body_that_passes_by_is_not_held_up() -> None:
    world = World(precision="double", gravity=(0, 0))
    floor(world)
    body = world.create_body(Circle(0.5), position=(0, 0.505), velocity=(3, 0.1))
    run(world, 60)
    assert tuple(body.velocity) == (3.0, 0.1)
    assert tuple(body.position) == pytest.approx((3.0, 0.605), rel=1e-12)


# --- impulses ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("precision", PRECISIONS)
def test_impulses_push_and_friction_stays_in_its_cone(precision: str) -> None:
    world = gathering(precision)
    for _ in range(100):
        world.step(DT)
        for arbiter in world.arbiters:
            for contact in arbiter.contacts:
                assert contact.normal_impulse >= 0.0
                # friction of a substep is bounded by the load of its own, and the sums by the sum
                most = arbiter.friction * contact.normal_impulse * (1 + 1e-5) + 1e-9
                assert abs(contact.tangent_impulse) <= most


def test_impulses_told_are_those_of_all_substeps() -> None:
    for substeps in (1, 4, 7):
        world = World(precision="double", substeps=substeps)
        floor(world)
        ball = world.create_body(Circle(0.5), position=(0, 0.5), velocity=(0, -3), mass=2)
        world.step(DT)
        (contact,) = world.arbiters[0].contacts
        assert contact.normal_impulse == pytest.approx(2 * (3 + G * DT) + 2 * ball.velocity.y, rel=1e-12)


def test_an_inelastic_hit_leaves_the_mean_speed() -> None:
    world = World(gravity=(0, 0), precision="double")
    left = world.create_body(Circle(0.5), position=(-0.5, 0), mass=3, velocity=(3, 0))
    right = world.create_body(Circle(0.5), position=(0.5, 0), mass=3, velocity=(-1, 0))
    world.step(DT)
    assert (left.velocity.x, right.velocity.x) == pytest.approx((1.0, 1.0), abs=1e-9)
    assert world.arbiters[0].contacts[0].normal_impulse == pytest.approx(6.0, rel=1e-9)


def test_warm_starting_begins_with_the_impulses_of_the_step_before() -> None:
    settled = World(precision="double")
    floor(settled)
    for k in range(5):
        settled.create_body(Box(1, 1), position=(0, 0.5 + k))
    run(settled, 300)
    left_over = {}
    for warm in (True, False):
        world = World(precision="double")
        world.restore(settled.snapshot())
        world.warm_starting = warm
        world.step(DT)
        left_over[warm] = np.abs(world.velocities).max()
    assert left_over[True] < 1e-6
    assert left_over[False] > 0.01


def test_a_heavy_load_is_held_better_by_more_substeps() -> None:
    sunk = []
    for substeps in (4, 8, 16):
        world = World(precision="double", substeps=substeps)
        floor(world)
        world.create_body(Box(1, 1), position=(0, 0.5))
        top = world.create_body(Box(1, 1), position=(0, 1.5), mass=200)
        run(world, 60)
        sunk.append(1.5 - top.position.y)
    assert sunk[1] < 0.5 * sunk[0]
    assert sunk[2] < 0.5 * sunk[1]


# --- contacts that are kept -------------------------------------------------------------------------------------------


def colliders_run(world: World) -> int:
    """How many colliders the next step calls."""
    state, calls = world._state, []
    real = state.meetings
    state.meetings = [_counted(meeting, calls) for meeting in real]
    world.step(DT)
    state.meetings = real
    return len(calls)


def _counted(meeting: Any, calls: list) -> Any:
    collide, *rest = meeting
    return (lambda *arguments: (calls.append(1), collide(*arguments)), *rest)


def test_what_rests_is_not_looked_at_again() -> None:
    world = World()
    floor(world)
    for k in range(3):
        world.create_body(Box(1, 1), position=(0, 0.5 + k))
    world.create_body(Circle(0.5), position=(3, 0.5))
    run(world, 60)
    assert colliders_run(world) == 0
    features = world.contact_records()["feature"].tolist()
    world.recycling = False
    world.step(DT)
    assert colliders_run(world) == 2
    assert world.contact_records()["feature"].tolist() == features
    world.recycling = True
    run(world, 2)
    assert colliders_run(world) == 0
    world.bodies[1].velocity = (3, 0)
    run(world, 2)
    assert colliders_run(world) > 0, "what moves is"


@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_a_ball_rolls_without_bobbing(radius: float) -> None:
    # a point on its outline that is kept turns away from the floor, and the ball would follow it down
    world = World(precision="double")
    floor(world, friction=1.0)
    ball = world.create_body(
        Circle(radius), position=(-10, radius), velocity=(3, 0), angular_velocity=-3 / radius, friction=1
    )
    heights = []
    for _ in range(240):
        world.step(DT)
        heights.append(ball.position.y - radius)
    assert -0.002 < min(heights) <= max(heights) < 0
    assert max(heights) - min(heights[30:]) < 2e-4
    assert ball.velocity.x == pytest.approx(3.0, rel=2e-3)


@pytest.mark.parametrize("shape", [Box(1, 1), Polygon(POINTS), Polygon(regular(6), 0.1), Capsule(0.6, 0.2)])
@pytest.mark.parametrize("angle", [0.05, 0.1])
def test_the_other_end_is_seen_when_it_comes_down(shape: Shape, angle: float) -> None:
    # it lands on one corner, and the other corner meets the floor later: a kept contact must not hide it
    world = World(precision="double")
    floor(world, friction=1.0)
    body = world.create_body(shape, position=(0, 0.7), angle=angle, friction=1.0)
    deepest = 0.0
    for step in range(300):
        world.step(DT)
        if step > 25:
            deepest = max(deepest, -lowest_point(body))
    assert deepest < 4e-3


def lowest_point(body: Body) -> float:
    """Height of the lowest point of its outline [m]."""
    shape = body.shape
    if isinstance(shape, Box):
        points, radius = [(x * shape.width / 2, y * shape.height / 2) for x in (-1, 1) for y in (-1, 1)], 0.0
    elif isinstance(shape, Capsule):
        points, radius = [(-shape.length / 2, 0.0), (shape.length / 2, 0.0)], shape.radius
    else:
        assert isinstance(shape, Polygon)
        points, radius = list(shape.points), shape.radius
    c, s = math.cos(body.angle), math.sin(body.angle)
    return body.position.y + min(s * x + c * y for x, y in points) - radius


def test_a_shape_that_moves_the_centre_does_not_move_the_contacts() -> None:
    # anchors of kept contacts are reckoned from the centre of mass: a small shift must not lift or drop the body
    for mass in (0.05, 0.2, 2.0):
        world = World(precision="double")
        floor(world)
        box = world.create_body(Box(1, 1), position=(0, 0.5))
        run(world, 60)
        before = box.position.y
        handle = box.add_shape(Circle(0.1), offset=(0, 0.35), mass=mass)
        for _ in range(5):
            world.step(DT)
            assert world.contact_records()["separation"] == pytest.approx([before - 0.5] * 2, abs=2e-4)
            assert box.position.y == pytest.approx(before, abs=2e-4)
        run(world, 60)
        handle.destroy()
        for _ in range(5):
            world.step(DT)
            assert box.position.y == pytest.approx(before, abs=4e-4)


def test_a_body_that_was_moved_by_hand_is_looked_at_again() -> None:
    world = World(precision="double")
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 0.5))
    run(world, 60)
    box.angle = math.pi / 2 + 0.001
    box.position = (0.0, 0.51)
    world.step(DT)
    assert box.angle == pytest.approx(math.pi / 2, abs=2e-3)
    box.position = (0.0, 0.3)
    world.step(DT)
    assert world.contact_records()["separation"].min() < -0.19


def test_contacts_are_told_where_the_bodies_are_now() -> None:
    # a kept contact moves along with its bodies
    world = World(precision="double", gravity=(0, 0))
    plate = world.create_body(Box(4, 1), position=(0, 0), kind="kinematic", velocity=(1, 0))
    world.create_body(Box(1, 1), position=(0, 0.999), velocity=(1, 0))
    run(world, 1)
    start = world.contact_records()["x"].copy()
    run(world, 30)
    assert world.contact_records()["x"] - start == pytest.approx([30 * DT] * 2, abs=2e-3)
    assert plate.position.x == pytest.approx(31 * DT)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_both_precisions_agree_for_a_while(precision: str) -> None:
    single, double = run(busy("single"), 30), run(busy("double"), 30)
    assert 0 < np.abs(single.positions - double.positions).max() < 5e-5
