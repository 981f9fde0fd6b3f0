"""Joints solved at once: what stretches by decimetres holds within millimetres; the blocks against a dense matrix;
which islands are solved so, and which are left.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Box, Circle, World
from engine.solvers.soft_step.direct.chains import find_chains
from engine.solvers.soft_step.direct.plan import least_degree
from engine.solvers.soft_step.direct.work import GIVE
from tests.engine.joints.making import GRAVITY, all_joints, world_of_joints
from tests.engine.worlds import DT, run
from tests.naive import joints as naive


def chain(ratio: float = 1000.0, links: int = 20, **settings) -> World:
    """Hanging links with a ball of so many times their mass at the end."""
    world = World(**settings)
    last = world.create_body(kind="static")
    for k in range(links):
        link = world.create_body(Box(0.25, 1.0), position=(0, -k - 0.5), density=20.0)
        world.create_joint_revolute(last, link, anchor=(0, -k), collide_connected=False)
        last = link
    ball = world.create_body(Circle(2.0), position=(0, -links - 2), mass=ratio * last.mass)
    world.create_joint_revolute(last, ball, anchor=(0, -links), collide_connected=False)
    return world


def bridge(planks: int = 160, **settings) -> World:
    """Planks between two ends."""
    world = World(**settings)
    ground = last = world.create_body(kind="static")
    for k in range(planks):
        plank = world.create_body(Box(1, 0.25), position=(k + 0.5, 0), density=20.0)
        world.create_joint_revolute(last, plank, anchor=(k, 0), collide_connected=False)
        last = plank
    world.create_joint_revolute(last, ground, anchor=(planks, 0), collide_connected=False)
    return world


def ball_and_chain(links: int = 20, **settings) -> World:
    """A heavy ball on a chain, let go with the chain level."""
    world = World(**settings)
    last = world.create_body(kind="static")
    for k in range(links):
        link = world.create_body(Box(1.0, 0.25), position=(k + 0.5, 0), density=20.0)
        world.create_joint_revolute(last, link, anchor=(k, 0), collide_connected=False)
        last = link
    ball = world.create_body(Circle(4.0), position=(links + 4, 0), density=20.0)
    world.create_joint_revolute(last, ball, anchor=(links, 0), collide_connected=False)
    return world


def stretch(world: World) -> float:
    """The most that two anchors of a joint are apart [m]."""
    records = world.joint_records()
    return float(np.hypot(records["x2"] - records["x1"], records["y2"] - records["y1"]).max())


def worst(world: World, steps: int, since: int = 0, every: int = 4) -> float:
    """The most over all steps from `since` on, of which every fourth is looked at."""
    found = 0.0
    world.run(since, DT)
    for _ in range((steps - since) // every):
        world.run(every, DT)
        found = max(found, stretch(world))
    return found


def test_a_chain_with_a_thousand_times_a_links_mass_at_its_end(capsys: pytest.CaptureFixture) -> None:
    iterated, found = worst(chain(joint_solving="iterated"), 300), worst(chain(), 600)
    with capsys.disabled():
        print(f"\n20 links with 1000 times a link's mass: {1e3 * found:.3f} mm ({1e3 * iterated:.0f} mm iterated)")
    assert found < 1e-3
    assert iterated > 0.1, "it is called for"


def test_a_bridge_of_160(capsys: pytest.CaptureFixture) -> None:
    found = worst(bridge(), 600, since=480, every=1)
    with capsys.disabled():
        print(f"\nbridge of 160 planks: {1e3 * found:.3f} mm in the last two of ten seconds")
    assert found < 2e-3


def test_ball_and_chain(capsys: pytest.CaptureFixture) -> None:
    found = worst(ball_and_chain(), 600, every=2)
    with capsys.disabled():
        print(f"\nball and chain: {1e3 * found:.3f} mm at its peak")
    assert found < 5e-3


def random_joints(seed: int, loops: int = 0, bodies: int = 9, precision: str = "double") -> World:
    """A tree of bodies in any poses, joined by any rigid kind, and some joints more that close loops."""
    rng = np.random.default_rng(seed)
    world = World(precision=precision, joint_solving="direct", gravity=(0, -GRAVITY))
    all_joints(world)
    made = [world.create_body(kind="static" if rng.random() < 0.5 else "dynamic", shape=Box(0.3, 0.2))]
    ends = [(int(rng.integers(k)), k) for k in range(1, bodies)]
    for _ in range(bodies - 1):
        made.append(
            world.create_body(
                Box(*rng.uniform(0.2, 1.0, 2)), position=tuple(rng.uniform(-3, 3, 2)), angle=rng.uniform(-3, 3),
                mass=10 ** rng.uniform(-2, 2), fixed_rotation=bool(rng.random() < 0.1),
            )
        )  # fmt: skip
    ends += [tuple(sorted(rng.choice(bodies, 2, replace=False).tolist())) for _ in range(loops)]
    for one, other in ends:
        a, b = made[one], made[other]
        if rng.random() < 0.5:
            a, b = b, a
        point, axis = tuple(rng.uniform(-3, 3, 2)), tuple(rng.uniform(-1, 1, 2))
        kind = rng.choice(["revolute", "weld", "prismatic", "wheel", "distance"])
        if kind == "distance":
            world.create_joint_distance(a, b, anchor1=point, anchor2=axis, collide_connected=False)
        else:
            more = {"axis": axis} if kind in ("prismatic", "wheel") else {}
            if kind == "wheel":
                more["hertz"] = None
            getattr(world, f"create_joint_{kind}")(a, b, anchor=point, collide_connected=False, **more)
    return world


@pytest.mark.parametrize("loops", [0, 1, 3])
@settings(max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_blocks_solve_what_the_dense_matrix_solves(loops: int, seed: int) -> None:
    world = random_joints(seed, loops)
    world._state.steps["dt"] = DT
    chains = find_chains(world._state, world.settings, world._state.joints.order)
    if chains is None:
        assert world._state.joints.count < 2
        return
    naive.prepare(world, chains)
    wanted = np.random.default_rng(seed).normal(size=chains.wanted.shape)
    matrix = naive.dense_matrix(chains, GIVE)
    found = naive.solve_in_blocks(chains, wanted, GIVE)
    assert np.abs(matrix @ found.ravel() - wanted.ravel()).max() < 1e-9 * np.linalg.cond(matrix) ** 0.5 + 1e-9
    exact = np.linalg.solve(matrix, wanted.ravel())
    assert found.ravel() == pytest.approx(exact, rel=1e-6, abs=1e-7 * np.abs(exact).max())


@settings(max_examples=12)
@given(seed=st.integers(0, 10**6))
def test_jacobians_are_how_errors_change(seed: int) -> None:
    world = random_joints(seed)
    world._state.steps["dt"] = DT
    chains = find_chains(world._state, world.settings, world._state.joints.order)
    assert chains is not None
    expected = naive.jacobian_by_differences(world, chains)
    rows_of = {int(row): k for k, row in enumerate(world._state.bodies.order)}
    found = np.zeros_like(expected)
    for k, row in enumerate(chains.rows):
        one, two = rows_of[int(row["body1"])], rows_of[int(row["body2"])]
        for i in range(3):
            x, y, arm1, arm2 = chains.jacobians[k, i]
            found[3 * k + i, :, one] -= x, y, arm1
            found[3 * k + i, :, two] += x, y, arm2
    assert np.abs(found - expected).max() < 1e-6


def edges(neighbours: dict[int, set[int]]) -> int:
    return sum(map(len, neighbours.values())) // 2


@given(parents=st.lists(st.integers(0, 10**6), min_size=1, max_size=40))
def test_in_the_order_of_least_degree_trees_fill_in_little(parents: list[int]) -> None:
    # joint k joins body k + 1 to an earlier one; joints at one body are coupled to each other
    at_body: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        for body in (joint + 1, parent % (joint + 1)):
            at_body.setdefault(body, []).append(joint)
    neighbours: dict[int, set[int]] = {joint: set() for joint in range(len(parents))}
    for members in at_body.values():
        for member in members:
            neighbours[member] |= set(members) - {member}
    order = least_degree(neighbours, 10**9)
    assert order is not None
    assert sorted(order.order) == sorted(neighbours)
    assert edges(neighbours) <= order.blocks <= 1.5 * edges(neighbours)
    assert least_degree(neighbours, order.blocks) == order
    if order.blocks:
        assert least_degree(neighbours, order.blocks - 1) is None


@pytest.mark.parametrize("joints", [2, 3, 10, 100])
def test_a_chain_has_a_block_less_than_joints_and_a_ring_few_more(joints: int) -> None:
    line = {k: {n for n in (k - 1, k + 1) if 0 <= n < joints} for k in range(joints)}
    assert least_degree(line, joints).blocks == joints - 1
    ring = {k: {(k - 1) % joints, (k + 1) % joints} - {k} for k in range(joints)}
    assert least_degree(ring, 3 * joints).blocks == edges(ring) + max(joints - 3, 0)


def ring_of_welds(count: int, world: World) -> list:
    angles = 2 * np.pi * np.arange(count) / count
    bodies = [
        world.create_body(Box(0.5, 0.2), position=(np.cos(t), np.sin(t)), angle=t + np.pi / 2, mass=1) for t in angles
    ]
    for k, (a, b) in enumerate(zip(bodies, [*bodies[1:], bodies[0]], strict=True)):
        t = angles[k] + np.pi / count
        world.create_joint_weld(a, b, anchor=(np.cos(t), np.sin(t)), collide_connected=False)
    return bodies


@pytest.mark.parametrize("precision", ["single", "double"])
def test_a_closed_ring_of_welds_is_finite_and_keeps_its_shape(precision: str) -> None:
    # twelve welds hold 36 numbers of bodies that have 33 to be held: what is held twice must not be divided by nothing
    world = world_of_joints(precision=precision, gravity=(0, 0), joint_solving="direct")
    bodies = ring_of_welds(12, world)
    bodies[0].velocity, bodies[5].angular_velocity = (3.0, 0.0), 4.0
    before = world.diagnostics()
    run(world, 120)
    assert world._state.chains is not None
    assert np.isfinite(world.positions).all()
    assert stretch(world) < 1e-3
    after = world.diagnostics()
    rounding = 1e-3 if precision == "single" else 1e-9
    assert tuple(after.momentum) == pytest.approx(tuple(before.momentum), rel=rounding, abs=rounding)
    assert after.angular_momentum == pytest.approx(before.angular_momentum, rel=max(rounding, 1e-5))
    assert np.ptp(world.angular_velocities) < 1e-2, "all turn as one"
    assert after.kinetic_energy <= before.kinetic_energy * (1 + 1e-9)


def solved_at_once(world: World) -> int:
    """How many joints the world solves at once."""
    world.step(DT)
    return 0 if world._state.chains is None else len(world._state.chains.plan.order)


@pytest.mark.parametrize(("solving", "expected"), [("auto", 21), ("direct", 21), ("iterated", 0)])
def test_a_heavy_chain_is_solved_at_once_unless_it_is_said_otherwise(solving: str, expected: int) -> None:
    assert solved_at_once(all_joints(chain(joint_solving=solving, precision="double"))) == expected


@pytest.mark.parametrize(("solving", "expected"), [("auto", 0), ("direct", 4), ("iterated", 0)])
def test_a_short_light_chain_is_solved_at_once_only_if_asked_for(solving: str, expected: int) -> None:
    assert solved_at_once(all_joints(chain(1.0, 3, joint_solving=solving, precision="double"))) == expected


def test_solving_is_set_at_any_time() -> None:
    world = all_joints(chain(precision="double"))
    for solving, expected in (("iterated", 0), ("auto", 21), ("iterated", 0), ("direct", 21)):
        world.set(joint_solving=solving)
        assert solved_at_once(world) == expected


@pytest.mark.parametrize("solving", ["auto", "direct"])
def test_bodies_without_a_shape_make_no_chain(solving: str) -> None:
    """They have no mass, and so nothing moves them."""
    world = World(joint_solving=solving)
    bodies = [world.create_body(position=(k, 0)) for k in range(3)]
    for a, b in ((0, 1), (0, 1), (1, 2)):
        world.create_joint_revolute(bodies[a], bodies[b], anchor=(a + 0.5, 0))
    assert solved_at_once(world) == 0


def test_nets_are_left_to_iterating() -> None:
    world = world_of_joints(joint_solving="direct")
    net = [[world.create_body(Box(0.5, 0.5), position=(x, -y)) for x in range(9)] for y in range(9)]
    for y in range(9):
        for x in range(9):
            if x:
                world.create_joint_revolute(net[y][x - 1], net[y][x], anchor=(x - 0.5, -y))
            if y:
                world.create_joint_revolute(net[y - 1][x], net[y][x], anchor=(x, -y + 0.5))
    assert solved_at_once(world) == 0
    assert np.isfinite(world.positions).all()


@pytest.mark.parametrize(
    ("more", "expected"),
    [({"softness": 0.1}, 0), ({"bias_factor": 0.3}, 0), ({}, 3), ({"motor_speed": 1.0, "max_motor_torque": 1.0}, 3)],
)
def test_what_is_soft_by_itself_is_not_among_them(more: dict, expected: int) -> None:
    world = world_of_joints(joint_solving="direct")
    bodies = [world.create_body(Box(0.5, 0.2), position=(k, 0)) for k in range(4)]
    for k, (a, b) in enumerate(pairwise(bodies)):
        world.create_joint_revolute(a, b, anchor=(k + 0.5, 0), **more)
    assert solved_at_once(world) == expected


def ragdoll(world: World, heavy: float = 1.0) -> list:
    """A trunk, a head, and four limbs of two parts each: a tree that hangs on nothing."""
    trunk = world.create_body(Box(0.5, 1.0), position=(0, 5), mass=8)
    parts = [trunk]
    for x, y, first in ((0, 5.7, 0.4), (-0.6, 5.3, 0.5), (0.6, 5.3, 0.5), (-0.2, 4.2, 0.5), (0.2, 4.2, 0.5)):
        part = world.create_body(Box(0.2, first), position=(x, y), mass=2)
        world.create_joint_revolute(trunk, part, anchor=(x * 0.7, y - 0.2), lower=-0.8, upper=0.8)
        parts.append(part)
        if y < 5.5:
            lower = world.create_body(Box(0.15, 0.5), position=(x, y - 0.5), mass=1.5 * (heavy if x > 0.5 else 1.0))
            world.create_joint_revolute(part, lower, anchor=(x, y - 0.25), lower=-0.5, upper=1.2)
            parts.append(lower)
    return parts


def test_a_tree_that_falls_freely_is_iterated_unless_one_end_is_heavy() -> None:
    world = world_of_joints()
    ragdoll(world)
    assert solved_at_once(world) == 0
    world = world_of_joints()
    ragdoll(world, heavy=2000.0)
    assert solved_at_once(world) == 9


@pytest.mark.parametrize("solving", ["direct", "iterated"])
def test_a_tree_that_falls_freely_holds_together(solving: str) -> None:
    world = world_of_joints(gravity=(0, -GRAVITY), joint_solving=solving)
    parts = ragdoll(world)
    parts[0].angular_velocity = 5.0
    mass, before = sum(part.mass for part in parts), world.diagnostics()
    far = 0.0
    for _ in range(60):
        world.step(DT)
        far = max(far, stretch(world))
    after = world.diagnostics()
    assert far < (2e-3 if solving == "direct" else 1e-2)
    assert after.momentum.y - before.momentum.y == pytest.approx(-mass * GRAVITY * 60 * DT, rel=1e-9)
    assert after.momentum.x == pytest.approx(before.momentum.x, abs=1e-9)


def test_every_joint_of_a_hanging_chain_tells_the_weight_below() -> None:
    world = all_joints(chain(1000.0, 20, precision="double", sleeping=False))
    run(world, 1200)
    masses = [body.mass for body in world.bodies[1:]]
    for k, joint in enumerate(world.joints):
        assert joint.force.y == pytest.approx(GRAVITY * sum(masses[k:]), rel=1e-6)


def test_a_snapshot_of_a_chain_continues_with_the_same_bits() -> None:
    world = all_joints(ball_and_chain(precision="double"))
    run(world, 30)
    other = all_joints(World(precision="double"))
    other.restore(world.snapshot())
    for _ in range(10):
        world.step(DT)
        other.step(DT)
        assert world.state_hash() == other.state_hash()
    ran = all_joints(World(precision="double"))
    ran.restore(world.snapshot())
    ran.run(20, DT)
    run(world, 20)
    assert ran.state_hash() == world.state_hash()


def test_two_threads_solve_many_chains_with_the_same_bits() -> None:
    worlds = []
    for threads in (1, 2):
        world = world_of_joints(threads=threads)
        for k in range(40):
            last = world.create_body(kind="static", position=(3.0 * k, 0))
            for n in range(8):
                mass = 500.0 if n == 7 else 1.0
                link = world.create_body(Box(0.8, 0.2), position=(3.0 * k + 0.1 * n, -n - 0.5), mass=mass)
                world.create_joint_revolute(last, link, anchor=(3.0 * k + 0.1 * n, -n), collide_connected=False)
                last = link
        run(world, 10)
        assert world._state.chains is not None
        assert world._state.chains.count == 40
        worlds.append(world)
    assert worlds[0].state_hash() == worlds[1].state_hash()
