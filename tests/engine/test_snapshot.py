"""Snapshots take a world back bit for bit; the hash sees what physics means and nothing else."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import BROAD_PHASES, SOLVERS, Box, Capsule, Circle, Polygon, Settings, Snapshot, World
from engine.snapshot import MAGIC
from tests.engine.worlds import DT, POINTS, PRECISIONS, busy, floor, gathering, run, tables_of

either = pytest.mark.parametrize("solver", SOLVERS)

# --- there and back ---------------------------------------------------------------------------------------------------


def eventful(precision: str, solver: str = "soft_step", **settings: Any) -> World:
    """A busy world whose rows are not in the order of creation, and which carries impulses."""
    world = run(busy(precision, solver=solver, **settings), 40)
    world.bodies[2].destroy()
    world.create_body(Box(0.5, 0.5), position=(0.3, 2.5), linear_damping=0.1, category=2)
    world.create_body(Polygon(POINTS), position=(2.5, 1))
    world.bodies[-1].add_shape(Capsule(0.5, 0.1), offset=(0.3, 0), rolling_resistance=0.1 * (solver == "soft_step"))
    run(world, 40)
    world.bodies[1].apply_force((3, 1), (0.2, 0.7))
    return world


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_restoring_goes_back_bit_for_bit(precision: str, solver: str) -> None:
    world = eventful(precision, solver)
    snapshot, before = world.snapshot(), tables_of(world)
    run(world, 50)
    after, later = world.state_hash(), tables_of(world)
    world.gravity = (5, 5)
    world.bodies[0].destroy()
    world.create_body(Circle(1))
    world.restore(snapshot)
    assert world.gravity == (0.0, -10.0)
    assert {k: v for k, v in tables_of(world).items() if "serial" not in k} == {
        k: v for k, v in before.items() if "serial" not in k
    }
    run(world, 50)
    assert world.state_hash() == after
    assert all(later[name] == bits for name, bits in tables_of(world).items() if "serial" not in name)
    assert (world.step_count, world.time) == (130, pytest.approx(130 * DT))


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_another_world_takes_it_over(precision: str, solver: str) -> None:
    world = eventful(precision, solver)
    other = run(busy(precision, gravity=(1, 1), iterations=3), 7)
    other.restore(world.snapshot())
    assert other.settings == world.settings
    assert other.state_hash() == world.state_hash()
    run(world, 50)
    run(other, 50)
    assert other.state_hash() == world.state_hash()
    assert np.array_equal(other.contact_records(), world.contact_records())
    assert [tuple(body.position) for body in other.bodies] == [tuple(body.position) for body in world.bodies]


def lively(world: World, step: int) -> None:
    """Things come and go, and settings change, between steps."""
    if step == 20:
        world.create_body(Circle(0.2), position=(0.4, 2.5), gravity_scale=0.5, drag=0.2)
    elif step == 35:
        world.bodies[3].destroy()
    elif step == 45:
        world.bodies[2].add_shape(Box(0.2, 0.2), offset=(0.2, 0.1), friction=0.9)
        world.wind = (3, 0)
    elif step == 60:
        world.bodies[4].shapes[0].destroy()
    elif step == 70:
        world.joints[0].destroy()
        world.iterations = 3
    world.bodies[-1].apply_force((0.5, 1), world.bodies[-1].position)


@either
@pytest.mark.parametrize("make", [busy, gathering])
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("broad_phase", BROAD_PHASES)
def test_two_hundred_steps_with_a_restore_halfway(make: Any, precision: str, solver: str, broad_phase: str) -> None:
    world = run(make(precision, solver=solver, broad_phase=broad_phase), 100)
    snapshot = world.snapshot()
    straight = []
    for step in range(100):
        lively(world, step)
        world.step(DT)
        straight.append(world.state_hash())
    world.restore(snapshot)
    other = World(precision=precision, gravity=(9, 9), solver=solver)
    other.create_body(Box(1, 1), restitution=0.3 * (solver == "soft_step"), mask=5)
    run(other, 3)
    other.restore(Snapshot.from_bytes(snapshot.to_bytes()))
    for taken in (world, other):
        for step in range(100):
            lively(taken, step)
            taken.step(DT)
            assert taken.state_hash() == straight[step], f"step {step}"


@pytest.mark.parametrize("change", [{"substeps": 7}, {"recycling": False}, {"warm_starting": False}, {"solver": "x"}])
def test_a_restore_right_after_a_change_of_settings(change: dict) -> None:
    if "solver" in change:
        change = {"solver": "sequential_impulses"}
    world = run(gathering("single"), 60)
    world.set(**change)
    other = World()
    other.restore(world.snapshot())
    assert run(other, 60).state_hash() == run(world, 60).state_hash()


def test_what_was_found_before_the_first_step_is_not_needed() -> None:
    # a world that was never stepped, one stepped by nothing, and one stepped and restored: all begin alike
    hashes = set()
    for prepare in (lambda world: None, lambda world: world.step(0.0), lambda world: world.restore(world.snapshot())):
        world = gathering()
        prepare(world)
        hashes.add(run(world, 20).state_hash())
    assert len(hashes) == 1


def test_handles_follow_a_snapshot_from_another_world() -> None:
    # the same serials stand in other rows there: no handle may point into the wrong one
    source = World()
    for k in range(5):
        source.create_body(Circle(0.1), position=(k, 0))
    target = World()
    held = [target.create_body(Circle(0.1), position=(0, k)) for k in range(4)]
    held[0].destroy()
    held.append(target.create_body(Circle(0.1), position=(0, 9)))
    assert held[4]._row == 0
    target.restore(source.snapshot())
    assert [tuple(body.position) for body in target.bodies] == [(k, 0.0) for k in range(5)]
    assert not held[4].alive


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_bytes_there_and_back(precision: str, solver: str) -> None:
    world = eventful(precision, solver)
    data = world.snapshot().to_bytes()
    assert data == world.snapshot().to_bytes(), "equal states give equal bytes"
    read = Snapshot.from_bytes(data)
    assert read.to_bytes() == data
    other = World(precision=precision)
    other.restore(read)
    run(world, 50)
    run(other, 50)
    assert other.state_hash() == world.state_hash()


def test_a_snapshot_is_a_copy() -> None:
    world = eventful("double")
    snapshot = world.snapshot()
    data = snapshot.to_bytes()
    run(world, 5)
    assert snapshot.to_bytes() == data
    world.restore(snapshot)
    run(world, 5)
    assert snapshot.to_bytes() == data


def test_handles_across_a_restore() -> None:
    world = run(busy(), 10)
    body, joint = world.bodies[4], world.joints[0]
    snapshot = world.snapshot()
    body.destroy()
    assert not body.alive
    assert not joint.alive
    late = world.create_body(Box(1, 1), position=(7, 7))
    late_joint = world.create_joint_revolute(late, world.bodies[0], anchor=(7, 8))
    world.restore(snapshot)
    assert body.alive
    assert joint.alive
    assert body in world.bodies
    assert joint.body2 == body
    assert not late.alive
    assert not late_joint.alive
    again = world.create_body(Box(1, 1), position=(8, 8))
    assert again != late
    assert not late.alive, "a serial is never given twice"
    assert again.serial > late.serial
    world.restore(snapshot)
    world.restore(snapshot)
    assert world.bodies[4] == body


def test_serials_made_since_do_not_change_the_hash() -> None:
    world = run(busy(), 10)
    snapshot, before = world.snapshot(), world.state_hash()
    for _ in range(3):
        world.create_body(Box(1, 1))
    world.restore(snapshot)
    assert world.state_hash() == before


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_damaged_bytes_are_refused(data: st.DataObject) -> None:
    whole = bytearray(run(busy(), 3).snapshot().to_bytes())
    kind = data.draw(st.sampled_from(["flip", "cut", "extend"]))
    place = data.draw(st.integers(0, len(whole) - 1))
    if kind == "flip":
        whole[place] ^= 1 << data.draw(st.integers(0, 7))
    elif kind == "cut":
        del whole[place:]
    else:
        whole += b"\0"
    with pytest.raises(ValueError, match=r"^snapshot: must be "):
        Snapshot.from_bytes(bytes(whole))


@pytest.mark.parametrize("data", [b"", b"tumble", MAGIC, pickle.dumps(1), None, "text", 5])
def test_what_is_no_snapshot_is_refused(data: Any) -> None:
    with pytest.raises(ValueError, match=r"^snapshot: must be (one that tumble wrote|whole)"):
        Snapshot.from_bytes(data)


def test_whole_bytes_of_another_meaning_are_refused() -> None:
    good = run(busy(), 3).snapshot()
    bad_settings = Snapshot(Settings(), {})
    object.__setattr__(bad_settings.settings, "iterations", -5)
    with pytest.raises(ValueError, match=r"this version of tumble \(iterations = -5"):
        Snapshot.from_bytes(bad_settings.to_bytes())
    object.__setattr__(bad_settings, "tables", {"settings2": good.tables["bodies.bodies"]})
    with pytest.raises(ValueError, match="this version of tumble"):
        Snapshot.from_bytes(bad_settings.to_bytes())


# --- the hash ---------------------------------------------------------------------------------------------------------


def hashed(**changes: Any) -> str:
    """The hash of a small world at rest, with something changed."""
    world = World(precision="double")
    floor(world)
    body = world.create_body(Box(1, 1), position=(0.3, 0.49), angle=0.01, velocity=(1, 2), angular_velocity=3)
    for name, value in changes.items():
        setattr(body, name, value)
    return world.state_hash()


def up(value: float) -> float:
    return float(np.nextafter(value, np.inf))


def test_hash_sees_one_ulp_of_the_motion() -> None:
    variants = [
        {},
        {"position": (up(0.3), 0.49)},
        {"position": (0.3, up(0.49))},
        {"angle": up(0.01)},
        {"velocity": (up(1.0), 2)},
        {"velocity": (1, up(2.0))},
        {"angular_velocity": up(3.0)},
    ]
    assert len({hashed(**changes) for changes in variants}) == len(variants)


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_hash_sees_one_ulp_of_every_impulse(precision: str, solver: str) -> None:
    world = run(busy(precision, solver=solver), 40)
    seen = {world.state_hash()}
    (touching, *_) = np.flatnonzero(world._state.arbiters.rows["count"][: world._state.arbiters.count])
    tables = [(world._state.arbiters.contacts[touching : touching + 1], ("normal_impulse", "tangent_impulse")),
              (world._state.joints.tables["joints"][:1], ("impulse_x", "impulse_y"))]  # fmt: skip
    for table, names in tables:
        for name in names:
            place = (0,) * table.ndim
            before = table[name][place]
            table[name][place] = np.nextafter(before, np.inf, dtype=before.dtype)
            seen.add(world.state_hash())
            table[name][place] = before
    assert len(seen) == 5


def test_hash_sees_keys_and_counts() -> None:
    world = run(busy("double"), 40)
    seen = {world.state_hash()}
    (touching, *_) = np.flatnonzero(world._state.arbiters.rows["count"][: world._state.arbiters.count])
    world._state.arbiters.contacts["feature"][touching, 0] += 1
    seen.add(world.state_hash())
    world.create_body(Circle(1))
    seen.add(world.state_hash())
    world.create_joint_revolute(world.bodies[1], world.bodies[2], anchor=(0, 0))
    seen.add(world.state_hash())
    assert len(seen) == 4


def test_zeros_of_either_sign_are_equal() -> None:
    assert hashed(position=(0.0, 0.0), angle=0.0, velocity=(0.0, 0), angular_velocity=0.0) == hashed(
        position=(-0.0, -0.0), angle=-0.0, velocity=(-0.0, -0.0), angular_velocity=-0.0
    )


@pytest.mark.parametrize("precision", PRECISIONS)
def test_capacity_and_serials_do_not_matter(precision: str) -> None:
    grown = World(precision=precision)
    for _ in range(300):
        grown.create_body(Box(1, 1))
    for body in grown.bodies:
        body.destroy()
    fresh = World(precision=precision)
    for world in (grown, fresh):
        floor(world)
        for k in range(20):
            world.create_body(Circle(0.4), position=(0.1 * k, 0.4 + 0.7 * k))
        world.create_joint_revolute(world.bodies[2], world.bodies[5], anchor=(0, 0))
        run(world, 60)
    assert grown.state_hash() == fresh.state_hash()
    assert len(grown._state.bodies.tables["bodies"]) > len(fresh._state.bodies.tables["bodies"])


def test_settings_and_forces_are_not_physics_yet() -> None:
    assert hashed() == hashed(force=(1, 1)) == hashed(friction=0.9)


def test_hash_is_64_hex_digits() -> None:
    assert len(bytes.fromhex(hashed())) == 32
