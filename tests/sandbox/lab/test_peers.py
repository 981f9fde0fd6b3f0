"""Each peer's copy of a world has its bodies where ours are, and moves as it does; what it cannot have it names."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest

from engine import Box, Capsule, Chain, Circle, Polygon, Segment, World
from sandbox.lab.peers import CannotMirror, Pyb2d3, Pymunk, pyb2d3_peer, pymunk_peer
from sandbox.lab.peers.protocol import UNASKED
from sandbox.scenes import SCENES, find_scene

DT = 1 / 60
PEERS = {"pyb2d3": Pyb2d3, "pymunk": Pymunk}
KNOWN = {"pyb2d3": pyb2d3_peer.KNOWN, "pymunk": pymunk_peer.KNOWN}
LACKS = {
    "pyb2d3": {"Drag", "Wind", "Buoyancy", "Magnets", "Point Gravity"},
    "pymunk": {
        *("Drag", "Wind", "Buoyancy", "Magnets", "Point Gravity", "Linear Damping", "Angular Damping"),
        *("Gravity Scale", "Rolling Resistance", "Conveyor"),
    },
}
NEAR = {"pyb2d3": 2e-3, "pymunk": 0.06}  # pymunk moves bodies before it changes their velocities: half a step behind


@pytest.fixture(params=PEERS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def mirrored(name: str, world: World, **options: Any) -> Any:
    return PEERS[name](**options).mirror(world, DT)


def after(name: str, world: World, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the last body is after that many steps: ours, and its copy."""
    copy = mirrored(name, world)
    copy.step(steps)
    for _ in range(steps):
        world.step(DT)
    return world.positions[-1].copy(), copy.positions()[-1]


@pytest.mark.parametrize("scene", SCENES)
def test_every_scene_is_copied_or_names_what_is_lacking(name: str, scene: str) -> None:
    world = SCENES[scene].make()
    known = KNOWN[name] | UNASKED
    lacking = [effect.name for effect in world.effects if effect.called_for and effect.name not in known]
    try:
        copy = mirrored(name, world)
    except CannotMirror as error:
        assert str(error).startswith(f"it has no {lacking[0]}: ")
    else:
        assert not lacking
        np.testing.assert_allclose(copy.positions(), world.positions, rtol=1e-6, atol=1e-6)
        copy.close()


def test_effects_that_are_lacking_are_few(name: str) -> None:
    refused = set()
    for scene in SCENES:
        if scene.startswith("Effects/"):
            try:
                mirrored(name, SCENES[scene].make())
            except CannotMirror:
                refused.add(scene.removeprefix("Effects/"))
    assert refused == LACKS[name]


def test_bodies_are_told_in_our_order_where_others_are_gone(name: str) -> None:
    world = World()
    bodies = [world.create_body(Box(1, 1), position=(3 * i, i)) for i in range(4)]
    bodies[1].destroy()
    world.create_body(Circle(0.5), position=(-7, 2))
    world.create_joint_revolute(bodies[2], bodies[3], anchor=(7.5, 2.5))
    copy = mirrored(name, world)
    np.testing.assert_allclose(copy.positions(), world.positions)
    copy.step(10)
    assert math.dist(copy.positions()[1], (6, 2)) > 0.01


def test_an_empty_world_is_copied(name: str) -> None:
    copy = mirrored(name, World())
    copy.step(1)
    assert copy.positions().shape == (0, 2)


def test_a_settled_world_goes_on_from_where_it_is(name: str) -> None:
    world = find_scene("Stacking/Arch").make()
    for _ in range(60):
        world.step(DT)
    copy = mirrored(name, world)
    before = copy.positions()
    copy.step(60)
    np.testing.assert_allclose(before, world.positions, atol=1e-5)
    np.testing.assert_allclose(copy.positions(), world.positions, atol=0.05)


def test_free_fall(name: str) -> None:
    world = World(gravity=(1.0, -5.0))
    world.create_body(Box(1, 1), velocity=(2, 3), angular_velocity=1.0)
    ours, theirs = after(name, world, 60)
    assert theirs == pytest.approx(ours, abs=NEAR[name])


def test_a_thrown_compound_turns_about_its_centre(name: str) -> None:
    world = World()
    body = world.create_body(Box(2, 0.4), angle=0.3, velocity=(3, 8), angular_velocity=4.0)
    body.add_shape(Circle(0.5), offset=(1.2, 0.3), density=3.0)
    ours, theirs = after(name, world, 45)
    assert theirs == pytest.approx(ours, abs=2 * NEAR[name])


def test_a_kinematic_body_moves_as_it_will(name: str) -> None:
    world = World()
    world.create_body(Box(1, 1), kind="kinematic", velocity=(2, -1), angular_velocity=0.5)
    ours, theirs = after(name, world, 60)
    assert theirs == pytest.approx(ours, abs=1e-3)
    assert theirs == pytest.approx((2.0, -1.0), abs=1e-3)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_a_ball_bounces_as_high(name: str, restitution: float) -> None:
    world = World()
    world.create_body(Box(20, 2), position=(0, -1), kind="static")
    world.create_body(Circle(0.5), position=(0, 5.5), restitution=restitution)
    falls = math.sqrt(2 * 5 / 10)
    steps = round((falls + restitution * falls) / DT)  # to the highest point after the first bounce
    ours, theirs = after(name, world, steps)
    assert theirs[1] == pytest.approx(0.5 + 5 * restitution**2, abs=0.15)
    assert theirs[1] == pytest.approx(ours[1], abs=0.15)


def test_box2d_bounces_what_meets_as_slowly_as_ours_does() -> None:
    world = World(restitution_threshold=0.1)
    world.create_body(Box(20, 2), position=(0, -1), kind="static")
    world.create_body(Circle(0.5), position=(0, 0.52), velocity=(0, -0.5), restitution=1.0)
    ours, theirs = after("pyb2d3", world, 6)
    assert ours[1] > 0.505
    assert theirs == pytest.approx(ours, abs=1e-3)


def test_a_box_slides_as_far(name: str) -> None:
    world = World()
    world.create_body(Box(100, 2), position=(0, -1), kind="static", friction=0.9)
    world.create_body(Box(2, 0.5), position=(0, 0.25), velocity=(6, 0), friction=0.1)
    ours, theirs = after(name, world, 150)
    assert theirs[0] == pytest.approx(6**2 / (2 * math.sqrt(0.9 * 0.1) * 10), rel=0.03)
    assert theirs == pytest.approx(ours, abs=0.1)


def test_a_pendulum_swings_as_ours(name: str) -> None:
    world = World()
    pivot = world.create_body(Box(1, 1), position=(0, 5), kind="static")
    bob = world.create_body(Circle(0.3), position=(4, 5))
    world.create_joint_revolute(pivot, bob, anchor=(0, 5))
    ours, theirs = after(name, world, 90)
    assert math.dist(theirs, (0, 5)) == pytest.approx(4.0, abs=0.02)
    assert theirs == pytest.approx(ours, abs=2 * NEAR[name])


def turned(name: str, torque: float) -> tuple[Any, World]:
    """A wheel of 1 kg m^2 on a motor that wants 3 rad/s, after a second: the copy and ours."""
    world = World(gravity=(0, 0))
    stand = world.create_body(Box(1, 1), kind="static")
    wheel = world.create_body(Circle(1.0), mass=2.0)
    world.create_joint_revolute(
        stand, wheel, anchor=(0, 0), collide_connected=False, motor_speed=3.0, max_motor_torque=torque
    )
    assert wheel.inertia == pytest.approx(1.0)
    copy = mirrored(name, world)
    copy.step(60)
    for _ in range(60):
        world.step(DT)
    return copy.bodies[-1].angular_velocity, world


def test_a_motor_turns_its_wheel(name: str) -> None:
    theirs, world = turned(name, 100.0)
    assert theirs == pytest.approx(3.0, rel=0.01)
    assert theirs == pytest.approx(world.angular_velocities[-1], rel=0.01)


def test_a_motor_has_the_torque_of_ours(name: str) -> None:
    theirs, world = turned(name, 0.5)
    assert theirs == pytest.approx(0.5, rel=0.02)
    assert theirs == pytest.approx(world.angular_velocities[-1], rel=0.02)


@pytest.mark.parametrize(
    ("shape", "rests"),
    [
        (Box(1, 1), 0.5),
        (Circle(0.4), 0.4),
        (Capsule(1.0, 0.3), 0.3),
        (Polygon(((-0.5, -0.2), (0.5, -0.2), (0.3, 0.4), (-0.3, 0.4))), 0.2),
        (Polygon(((-0.5, -0.2), (0.5, -0.2), (0.3, 0.4), (-0.3, 0.4)), radius=0.1), 0.3),
    ],
)
@pytest.mark.parametrize(
    "floor",
    [Box(20, 2), Segment((-10, 1), (10, 1)), Chain(((-10, 1), (0, 1), (3, 1), (10, 1)))],
    ids=["box", "segment", "chain"],
)
def test_shapes_rest_at_their_height(name: str, shape: Any, rests: float, floor: Any) -> None:
    world = World()
    world.create_body(floor, position=(0, -1), kind="static", friction=0.8)
    world.create_body(shape, position=(0.3, 0.05 + rests), friction=0.8)
    assert after(name, world, 90)[1] == pytest.approx((0.3, rests), abs=0.02)


def test_shapes_stand_where_ours_do_on_their_body(name: str) -> None:
    world = World(gravity=(0, 0))
    world.create_body(Box(1, 1), kind="static", position=(5, 0))
    arm = world.create_body(Box(1, 1), angle=math.pi / 2, fixed_rotation=True, velocity=(4, 0))
    arm.add_shape(Box(2.0, 0.2), offset=(0.0, -1.5), angle=math.pi / 2)  # to the right, as the body stands
    ours, theirs = after(name, world, 90)
    assert ours == pytest.approx((2.0, 0.0), abs=0.02)  # its end, 2.5 m ahead, meets the box's side at 4.5 m
    assert theirs == pytest.approx(ours, abs=0.02)


def test_fixed_rotation_stays_fixed(name: str) -> None:
    world = World()
    world.create_body(Box(1, 1), kind="static", position=(0.4, -1))
    world.create_body(Box(1, 1), fixed_rotation=True)
    copy = mirrored(name, world)
    copy.step(60)
    assert copy.bodies[-1].angle == pytest.approx(0.0, abs=1e-6)
    assert copy.positions()[-1] == pytest.approx((0, 0), abs=0.02)


@pytest.mark.parametrize(
    ("floor", "ball", "falls"),
    [
        ({}, {}, False),
        ({"category": 2}, {"mask": 1}, True),
        ({"category": 2}, {"mask": 2}, False),
        ({"category": 2}, {"mask": 2**63 - 3}, True),
        ({"category": 4}, {"mask": 2**63 - 3}, False),
        ({"group": -3}, {"group": -3}, True),
        ({"group": -3}, {"group": -4}, False),
    ],
)
def test_filters(name: str, floor: dict, ball: dict, *, falls: bool) -> None:
    world = World()
    world.create_body(Box(9, 1), kind="static", **floor)
    world.create_body(Circle(0.5), position=(0, 1.1), **ball)
    theirs = after(name, world, 60)[1]
    assert (theirs[1] < 0.0) == falls


def test_mass_inertia_and_centre_are_ours(name: str) -> None:
    world = World()
    world.create_body(Capsule(1.0, 0.3), mass=7.0).add_shape(Box(1, 2), density=0.01, offset=(1.5, 0.5))
    world.create_body(Polygon(((0, 0), (2, 0), (0, 1)), radius=0.2), density=3.0)
    copy = mirrored(name, world)
    for ours, theirs in zip(world.bodies, copy.bodies, strict=True):
        inertia = theirs.moment if name == "pymunk" else theirs.rotational_inertia()
        center = theirs.center_of_gravity if name == "pymunk" else theirs.local_center_of_mass()
        assert (theirs.mass, inertia) == (pytest.approx(ours.mass), pytest.approx(ours.inertia))
        assert tuple(ours.center) == pytest.approx((center[0], center[1]), abs=1e-6)


def test_twenty_thousand_bodies_take_seconds(name: str) -> None:
    world = World()
    places = np.stack(np.divmod(np.arange(20_000), 200), axis=1) * 1.5
    world.create_bodies(Box(1, 1), positions=places.astype(float))
    began = time.process_time()
    copy = mirrored(name, world)
    assert time.process_time() - began < 10.0  # a tenth of what one look at all shapes a body would take
    assert len(copy.positions()) == 20_000


def test_switches_that_it_has_not_are_named(name: str) -> None:
    for switch in ("accumulate_impulses", "warm_starting"):
        world = World(solver="sequential_impulses", **{switch: False})
        with pytest.raises(CannotMirror, match=f"^{switch} cannot be switched off in it$"):
            mirrored(name, world)


@pytest.mark.parametrize("rule", ["mean", "least"])
def test_rules_of_mixing_that_do_not_fit_are_named(name: str, rule: str) -> None:
    world = World(friction_mixing=rule)
    for k, friction in enumerate((0.1, 0.5, 0.9)):
        world.create_body(Box(1, 1), position=(2 * k, 0), friction=friction)
    with pytest.raises(CannotMirror, match=rf"friction.*{rule}"):
        mirrored(name, world)


def test_what_is_not_known_is_named(name: str) -> None:
    world = World()
    world.create_body(Box(1, 1), drag=0.5)
    with pytest.raises(CannotMirror, match=r"^it has no drag: 1 of 1 bodies has drag$"):
        mirrored(name, world)


def test_pymunk_names_what_it_cannot_have() -> None:
    cases = {
        "it has no group whose members always meet, as body 0 has": {"group": 4},
        "it has 32 categories, body 0 is of a higher one": {"category": 2**40},
    }
    for reason, properties in cases.items():
        world = World()
        world.create_body(Circle(1.0), **properties)
        with pytest.raises(CannotMirror, match=f"^{reason}$"):
            mirrored("pymunk", world)
    world = World()
    world.create_body(Segment((-5, 0), (5, 0)), kind="static")
    world.create_body(Circle(0.5), position=(0, 3)).add_shape(Segment((-2, 0), (2, 0)))
    with pytest.raises(CannotMirror, match=r"^segments of different bodies collide there, and body 1 moves one$"):
        mirrored("pymunk", world)


def test_pyb2d3_names_a_polygon_that_it_would_not_take() -> None:
    world = World()
    world.create_body(Polygon(((0, 0), (1, 0), (0, 0.01))))
    with pytest.raises(CannotMirror, match=r"^it takes no polygon as thin, .* as that of body 0$"):
        mirrored("pyb2d3", world)


def test_pyb2d3_takes_boxes_however_thin() -> None:
    world = World()
    world.create_body(Box(9, 1), kind="static", position=(0, -0.5))
    world.create_body(Box(1, 0.01), position=(0, 0.1))
    assert after("pyb2d3", world, 60)[1][1] == pytest.approx(0.005, abs=0.005)


@pytest.mark.parametrize("closed", [False, True])
def test_chains_in_box2d_are_solid_from_the_same_side(closed: bool) -> None:
    points = ((-6, 0), (6, 0), (6, 9), (-6, 9)) if closed else ((-6, 0), (0, 0), (6, 0))
    world = World(gravity=(0, 0))
    world.create_body(Chain(points, closed), kind="static")
    world.create_body(Circle(0.3), position=(0.2, -2), velocity=(0, 4))
    world.create_body(Circle(0.3), position=(-2, 4), velocity=(0, -4))
    copy = mirrored("pyb2d3", world)
    copy.step(75)
    for _ in range(75):
        world.step(DT)
    through, held = copy.positions()[1:]
    assert through == pytest.approx((0.2, 3.0), abs=0.01)
    assert held[1] == pytest.approx(0.3, abs=0.02)
    np.testing.assert_allclose(copy.positions(), world.positions, atol=0.02)


def test_a_closed_chain_of_three_points_is_whole_in_box2d() -> None:
    world = World(gravity=(0, 0))
    world.create_body(Chain(((-6, 0), (6, 0), (0, 9)), closed=True), kind="static")
    for angle in np.radians((30, 150, 270)):
        world.create_body(
            Circle(0.3), position=(0, 3), velocity=(5 * math.cos(angle), 5 * math.sin(angle)), category=2, mask=1
        )
    copy = mirrored("pyb2d3", world)
    copy.step(120)
    assert np.all(np.hypot(*(copy.positions()[1:] - (0, 3)).T) < 3.5)


def test_box2d_has_our_stiffness_substeps_and_no_sleep() -> None:
    world = World(substeps=8)
    world.create_body(Box(1, 1))
    copy = mirrored("pyb2d3", world)
    assert copy.substeps == 8
    assert not copy.world.sleeping_enabled
    assert not copy.world.continuous_enabled
    assert mirrored("pyb2d3", World(solver="sequential_impulses")).substeps == 4


def sag(**settings: Any) -> tuple[float, float]:
    """How far a tower has sunk after 5 s: ours, and in Box2D [m]."""
    world = World(**settings)
    world.create_body(Box(20, 1), kind="static", position=(0, -0.5))
    for k in range(6):
        world.create_body(Box(1, 1), position=(0, 0.5 + k))
    ours, theirs = after("pyb2d3", world, 300)
    return 5.5 - ours[1], 5.5 - theirs[1]


def test_contacts_in_box2d_are_as_stiff_as_ours() -> None:
    """A stiffness that were not told would leave the sag at 8 substeps where it is at 4: four times too much."""
    soft, stiff = sag(substeps=4), sag(substeps=8)
    assert soft[0] > 3 * stiff[0]
    assert soft[1] > 2 * stiff[1]


@pytest.mark.parametrize(
    "effect",
    ["Restitution", "Rolling Resistance", "Conveyor", "Linear Damping", "Angular Damping", "Gravity Scale", "Filters"],
)
def test_effects_in_box2d_are_ours(effect: str) -> None:
    world = find_scene(f"Effects/{effect}").make()
    copy = mirrored("pyb2d3", world)
    copy.step(60)
    for _ in range(60):
        world.step(DT)
    np.testing.assert_allclose(copy.positions(), world.positions, atol=2e-3)
    np.testing.assert_allclose(copy.batch.get_angular_velocities(), world.angular_velocities, atol=0.01)


def test_threads_do_not_change_what_box2d_does() -> None:
    world = find_scene("The Talk/Pyramid").make()
    one, two = mirrored("pyb2d3", world), mirrored("pyb2d3", world, threads=2)
    for copy in (one, two):
        copy.step(40)
    np.testing.assert_array_equal(one.positions(), two.positions())


def test_pymunk_steps_with_threads() -> None:
    copy = mirrored("pymunk", find_scene("The Talk/Pyramid").make(), threads=2)
    assert copy.space.threads == 2
    copy.step(3)


def test_worlds_of_box2d_are_given_back() -> None:
    """It holds 128 at most in a process."""
    world = World()
    world.create_body(Box(1, 1))
    for _ in range(300):
        copy = mirrored("pyb2d3", world)
        copy.close()
        copy.close()
