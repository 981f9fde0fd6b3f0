"""The same start and the same commands at the same steps give the same bits."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import SHAPE_KINDS, Box, Capsule, Chain, Circle, Polygon, Snapshot
from sandbox import commands as ask
from sandbox.simulation import Simulation
from tests.sandbox.watching import PRECISIONS, LivelyHands, bits, whole_frame


def lively_run(simulation: Simulation, visitors: LivelyHands, steps: int) -> list[str]:
    hashes = []
    for _ in range(steps):
        for command in visitors.commands(simulation.world.positions):
            simulation.apply(command)
        simulation.step()
        hashes.append(simulation.world.state_hash())
    return hashes


@settings(max_examples=8)
@given(seed=st.integers(0, 2**32), precision=st.sampled_from(PRECISIONS))
def test_same_commands_at_the_same_steps_give_the_same_bits(seed: int, precision: str) -> None:
    runs = [Simulation("The Talk/Circles", precision=precision) for _ in range(2)]
    hashes = [lively_run(simulation, LivelyHands(seed), 60) for simulation in runs]
    assert hashes[0] == hashes[1]
    assert bits(runs[0]) == bits(runs[1])
    assert whole_frame(runs[0].frame()) == whole_frame(runs[1].frame())


def test_a_command_a_step_later_gives_other_bits() -> None:
    hashes = []
    for at in (3, 4):
        simulation = Simulation("The Talk/Single Box")
        for step in range(10):
            if step == at:
                simulation.apply(ask.Set("gravity", (1.0, -9.0)))
            simulation.step()
        hashes.append(simulation.world.state_hash())
    assert hashes[0] != hashes[1]


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("elsewhere", [False, True])
def test_a_snapshot_in_mid_drag_goes_on_bit_for_bit(precision: str, elsewhere: bool) -> None:
    """With both hands full, the bomb thrown, and bodies destroyed before."""
    simulation = Simulation("The Talk/Pyramid", precision=precision)
    visitors = LivelyHands(5)
    lively_run(simulation, visitors, 40)
    for body in simulation.world.bodies[5:9]:
        body.destroy()
    simulation.apply(ask.Bomb(0.0, 15.0, 0.0, 0.0, -20.0, 1.0))
    for hand, body in ((1, simulation.world.bodies[20]), (2, simulation.world.bodies[30])):
        simulation.apply(ask.Grab(hand, *body.position))
        simulation.apply(ask.MoveHand(hand, 5.0, 9.0))
    simulation.step()
    assert len(simulation.hands) >= 2
    snapshot = simulation.world.snapshot().to_bytes()
    extras = json.loads(json.dumps(simulation.extras()))
    kept = bits(simulation)

    further = [ask.MoveHand(1, -5.0, 3.0), ask.Bomb(2.0, 15.0, 0.0, -3.0, -20.0, 1.0), ask.Release(2)]

    def go_on(simulation: Simulation) -> list[tuple]:
        frames = []
        for step in range(40):
            if step % 10 == 0 and step // 10 < len(further):
                simulation.apply(further[step // 10])
            simulation.step()
            frames.append(whole_frame(simulation.frame()))
        return frames

    expected = go_on(simulation)
    again = Simulation("The Talk/Single Box", precision=precision) if elsewhere else simulation
    again.restore(Snapshot.from_bytes(snapshot), extras)
    assert bits(again) == kept
    assert go_on(again) == expected


def test_restoring_forgets_hands_and_bomb_of_later() -> None:
    simulation = Simulation("The Talk/Single Box")
    snapshot, extras = simulation.world.snapshot(), simulation.extras()
    simulation.apply(ask.Bomb(-3.0, 15.0, 0.5, 4.0, -20.0, 3.0))
    simulation.apply(ask.Grab(1, 0.0, 4.0))
    content = simulation.content
    simulation.restore(snapshot, extras)
    assert (simulation.hands, simulation.bomb_serial, simulation.world.body_count) == ({}, -1, 2)
    assert simulation.content != content


def test_extras_are_a_copy() -> None:
    simulation = Simulation("The Talk/Single Box")
    simulation.apply(ask.Grab(1, 0.0, 4.0))
    extras = simulation.extras()
    before = json.dumps(extras)
    simulation.apply(ask.MoveHand(1, 9.0, 9.0))
    assert json.dumps(extras) == before


def test_hands_pull_in_the_order_of_their_numbers() -> None:
    """Not in that of taking hold: a restored simulation may have them in another."""
    states = []
    for order in ((1, 2), (2, 1)):
        simulation = Simulation("The Talk/Single Box")
        for hand in order:
            simulation.apply(ask.Grab(hand, -0.4 if hand == 1 else 0.3, 4.2))
            simulation.apply(ask.MoveHand(hand, 2.0 * hand, 7.0))
        for _ in range(5):
            simulation.step()
        states.append(simulation.world.state_hash())
    assert states[0] == states[1]


def test_frames_are_read_only_copies() -> None:
    simulation = Simulation("The Talk/Circles")
    for _ in range(60):
        simulation.step()
    frame = simulation.frame()
    arrays = {name: value for name, value in vars(frame).items() if isinstance(value, np.ndarray)}
    assert {"serials", "body_kinds", "positions", "angles", "velocities", "angular_velocities", "asleep",
            "shape_serials", "owners", "shape_kinds", "sizes", "places", "corner_counts", "corners", "bounds",
            "contacts", "joints",
            } == set(arrays)  # fmt: skip
    kept = {name: value.tobytes() for name, value in arrays.items()}
    for value in arrays.values():
        with pytest.raises(ValueError, match="read-only"):
            value[...] = 0
    simulation.step()
    assert {name: value.tobytes() for name, value in arrays.items()} == kept


def test_a_frame_tells_what_there_is() -> None:
    simulation = Simulation("The Talk/Teeter")
    for _ in range(200):
        simulation.step()
    frame, world = simulation.frame(({"command": "release", "hand": 1},)), simulation.world
    assert (frame.scene, frame.step, frame.dt) == ("The Talk/Teeter", 200, 1 / 60)
    assert frame.time == pytest.approx(200 / 60)
    assert frame.positions.tolist() == [list(body.position) for body in world.bodies]
    assert frame.angles.tolist() == [body.angle for body in world.bodies]
    assert frame.velocities.tolist() == [list(body.velocity) for body in world.bodies]
    assert frame.serials.tolist() == [0, 1, 2, 3, 4]
    assert frame.body_kinds.tolist() == [0, 1, 1, 1, 1]
    assert frame.sizes.tolist() == [[100, 20], [12, 0.25], [0.5, 0.5], [0.5, 0.5], [1, 1]]
    assert len(frame.joints) == 1
    assert len(frame.contacts) > 0
    assert set(frame.stage_ms) == set(world.stage_times)
    assert all(0.0 <= value < 1000.0 for value in frame.stage_ms.values())
    assert frame.commands == ({"command": "release", "hand": 1},)
    assert frame.settings == world.settings


def test_a_frame_has_the_pieces_of_every_shape_in_the_order_of_creation() -> None:
    """Bodies and shapes were destroyed before, so that rows and indices differ."""
    simulation = Simulation("The Talk/Single Box")
    world = simulation.world
    gone = world.create_body(Box(1, 1), position=(5, 5))
    body = world.create_body(Capsule(1.0, 0.25), position=(2.0, 3.0), angle=np.pi / 2)
    lost = body.add_shape(Box(9, 9))
    body.add_shape(Polygon([(0, 0), (1, 0), (0, 1)], radius=0.1), offset=(0.5, 0.0), angle=np.pi / 2)
    world.bodies[0].add_shape(Chain([(0, 0), (2, 0), (2, 2)]), offset=(0.0, 1.0))
    gone.destroy()
    lost.destroy()
    world.create_body(Circle(0.5), position=(7, 7))
    frame = simulation.frame()
    kinds = [SHAPE_KINDS[kind] for kind in frame.shape_kinds]
    assert kinds == ["box", "box", "capsule", "polygon", "chain", "chain", "circle"]
    assert frame.serials[frame.owners].tolist() == [0, 1, 3, 3, 0, 0, 4]
    assert frame.sizes.tolist() == [[100, 20], [1, 1], [1, 0.25], [0.1, 0], [2, 0], [2, 0], [0.5, 0]]
    assert frame.places[:, 2].tolist() == pytest.approx([0, 0, 0, np.pi / 2, 0, np.pi / 2, 0])
    assert frame.corner_counts.tolist() == [0, 0, 0, 3, 0, 0, 0]
    assert sorted(frame.corners.tolist()) == [[0, 0], [0, 1], [1, 0]]
    positions, angles = frame.shape_poses()
    assert positions[[3, 5, 6]].tolist() == [pytest.approx(place) for place in ([2.0, 3.5], [2.0, -8.0], [7.0, 7.0])]
    assert angles[3] == pytest.approx(np.pi)
    simulation.step()
    later = simulation.frame()
    assert later.corners is frame.corners, "made once for all frames that have them"
    low, high = later.bounds[:, :2], later.bounds[:, 2:]
    assert np.all((low <= later.shape_poses()[0]) & (later.shape_poses()[0] <= high))
    assert {effect.name: effect.called_for for effect in later.effects}["restitution"] is False


def test_a_frame_notices_what_came_and_went_without_a_command() -> None:
    """A corner's place in the engine's table is used again, so the order of the corners is not that of the table."""
    simulation = Simulation("The Talk/Single Box")
    world = simulation.world
    square = world.create_body(Polygon([(0, 0), (1, 0), (1, 1), (0, 1)]), position=(3, 5))
    world.create_body(Polygon([(0, 0), (2, 0), (0, 2)]), position=(6, 5))
    assert simulation.frame().corner_counts.tolist() == [0, 0, 4, 3]
    square.destroy()
    assert simulation.frame().corner_counts.tolist() == [0, 0, 3]
    world.create_body(Polygon([(0, 0), (1, 0), (2, 1), (1, 2), (0, 1)]), position=(9, 5))
    frame = simulation.frame()
    assert frame.corner_counts.tolist() == [0, 0, 3, 5]
    assert frame.corners[:3].max() == 2.0
    assert sorted(frame.corners[3:].tolist()) == [[0, 0], [0, 1], [1, 0], [1, 2], [2, 1]]
    shape = world.bodies[1].add_shape(Circle(0.5), offset=(1.0, 0.0))
    assert simulation.frame().owners.tolist() == [0, 1, 2, 3, 1]
    shape.destroy()
    assert simulation.frame().owners.tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    "extras",
    [
        {"bomb": float("inf"), "hands": {}},
        {"bomb": -1, "hands": {"0": {"serial": 1, "anchor_x": float("nan"), "anchor_y": 0.0, "x": 0.0, "y": 0.0}}},
        {"bomb": -1, "hands": {"0": {"serial": 1, "anchor_x": 0.0, "anchor_y": "up", "x": 0.0, "y": 0.0}}},
    ],
)
def test_impossible_extras_are_refused_and_change_nothing(extras: dict) -> None:
    simulation = Simulation("Teeter")
    simulation.step()
    before, snapshot = simulation.world.state_hash(), Simulation("Teeter").world.snapshot()
    with pytest.raises(ValueError, match=r"bomb|anchor"):
        simulation.restore(snapshot, extras)
    assert simulation.world.state_hash() == before


def test_a_hand_on_a_static_body_lets_go() -> None:
    simulation = Simulation("Teeter")
    hand = {"serial": 0, "anchor_x": 0.0, "anchor_y": 0.0, "x": 0.0, "y": 0.0}
    simulation.restore(simulation.world.snapshot(), {"bomb": -1, "hands": {"0": hand}})
    simulation.step()
    assert simulation.hands == {}
