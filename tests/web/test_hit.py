"""Which body is under a point: every shape that has an area, wherever its piece lies in its body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.scenes import SCENES
from sandbox.simulation import Simulation
from tests.web.fake_session import BODY, PENTAGON, make_frame
from web.hit import body_at, in_body, in_world, pieces_at

BOX: BODY = ("dynamic", "box", 4.0, 1.0, 2.0, 3.0, np.pi / 2)
DISC: BODY = ("dynamic", "circle", 0.5, 0.0, -3.0, 0.5, 0.0)
WALL: BODY = ("static", "box", 1.0, 1.0, 6.0, 6.0, 0.0)
CAPSULE: BODY = ("dynamic", "capsule", 2.0, 0.5, 0.0, -5.0, np.pi / 2)
SHARP: BODY = ("dynamic", "polygon", 0.0, 0.0, 10.0, 0.0, 0.0)
ROUND: BODY = ("dynamic", "polygon", 0.3, 0.0, 20.0, 0.0, 0.0)
LINE: BODY = ("dynamic", "segment", 4.0, 0.0, 30.0, 0.0, 0.0)
CHAIN: BODY = ("dynamic", "chain", 4.0, 0.0, 40.0, 0.0, 0.0)
TRIANGLE = np.array([(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)])


@pytest.mark.parametrize(
    ("x", "y", "found"),
    [
        (2.4, 4.9, 0),  # the box stands on its end
        (3.5, 3.0, None),
        (-3.3, 0.8, 1),
        (-3.4, 0.9, None),  # in the square around the disc, but not in the disc
        (6.0, 6.0, None),  # static bodies cannot be taken hold of
        (0.0, -3.6, 3),  # in the capsule's upper cap
        (0.45, -4.2, 3),
        (0.45, -3.6, None),  # beside the cap
        (10.0 + np.cos(0.2 * np.pi) - 0.01, 0.0, 4),
        (11.01, 0.0, None),  # before the corner
        (10.15, -0.93, None),  # in the rectangle around the polygon
        (21.29, 0.0, 5),  # rounded off
        (20.0 + 1.1 * np.cos(0.2 * np.pi), 1.1 * np.sin(0.2 * np.pi), 5),  # 0.291 from the edge's middle
        (20.0 + 1.12 * np.cos(0.2 * np.pi), 1.12 * np.sin(0.2 * np.pi), None),
        (30.0, 0.0, None),  # a line covers nothing
        (40.0, 0.0, None),
    ],
)
def test_the_body_under_a_point(x: float, y: float, found: int | None) -> None:
    assert body_at(make_frame([BOX, DISC, WALL, CAPSULE, SHARP, ROUND, LINE, CHAIN]), x, y) == found


def test_nothing_is_under_a_point_of_an_empty_frame() -> None:
    assert body_at(make_frame([]), 0.0, 0.0) is None
    assert body_at(make_frame([LINE]), 30.0, 0.0) is None


def test_pieces_lie_anywhere_in_their_body_and_the_body_created_last_wins() -> None:
    frame = make_frame([("dynamic", "box", 1.0, 1.0, 5.0, 5.0, np.pi / 2), SHARP, SHARP, DISC], [TRIANGLE, PENTAGON])
    frame = replace(
        frame,
        owners=np.array([0, 1, 0, 1]),  # the second polygon and the disc came later, to the first two bodies
        serials=frame.serials[:2],
        body_kinds=frame.body_kinds[:2],
        positions=frame.positions[:2],
        angles=frame.angles[:2],
        places=np.array([(0.0, 0.0, 0.0), (0.0, 0.0, np.pi / 2), (4.0, 0.0, 0.5), (-5.0, 7.0, 0.0)]),
    )
    assert body_at(frame, 5.0, 9.0) == 0  # where its second piece is: 4 m along its own x, which points up
    assert body_at(frame, 9.0, 5.0) is None
    assert body_at(frame, 9.1, 1.9) is None
    assert body_at(frame, 9.1, 0.1) == 1  # the triangle's long side stands up: left of it there is nothing
    assert body_at(frame, 9.99, 1.9) == 1
    assert body_at(frame, 5.0, 7.0) == 1
    assert pieces_at(frame, 5.0, 7.0).tolist() == [False, False, False, True]
    both = replace(frame, places=np.zeros((4, 3)), positions=np.zeros((2, 2)))
    assert pieces_at(both, 0.1, 0.1).sum() >= 3
    assert body_at(both, 0.1, 0.1) == 1


@given(st.floats(-50, 50), st.floats(-50, 50))
def test_there_and_back_again(x: float, y: float) -> None:
    frame = make_frame([BOX, CAPSULE])
    assert in_world(frame, 1, in_body(frame, 1, x, y)) == pytest.approx((x, y), abs=1e-9)


@pytest.mark.parametrize("name", ["All Shapes", "Compounds", "Chain", "Capsules"])
def test_the_engine_finds_the_same(name: str) -> None:
    """Grab asks the engine; whether a click spawns, the page decides."""
    scene = next(scene for scene in SCENES.values() if scene.name.endswith("/" + name))
    simulation = Simulation(scene)
    for _ in range(40):
        simulation.step()
    frame = simulation.frame()
    rng = np.random.default_rng(3)
    around = frame.positions[rng.integers(0, len(frame.positions), 300)] + rng.normal(0.0, 0.5, (300, 2))
    hits = 0
    for x, y in around.tolist():
        body, index = simulation.world.body_at((x, y)), body_at(frame, x, y)
        assert (None if index is None else frame.serials[index]) == (None if body is None else body.serial)
        hits += index is not None
    assert 10 < hits < 290
