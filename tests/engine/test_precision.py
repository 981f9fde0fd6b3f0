"""Single precision against double: how far apart they may be, and for how long.

Rounding differs by 1e-7 of a metre or so in each step. Resting scenes forget it; a scene in which a contact comes a
step earlier or later, or which falls over, does not, so only its beginning can be compared.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.engine.trajectories import NAMES, build, load, row
from tests.engine.worlds import DT, busy, run

BEGINNING = 30  # steps
QUIET = ("demo1_single_box", "demo4_randomized_stacking", "demo5_pyramid", "demo7_suspension_bridge")


@pytest.mark.parametrize("name", NAMES)
def test_single_begins_as_double(name: str) -> None:
    reference = load(name)
    world = build(reference.start, "single")
    for step in range(1, BEGINNING + 1):
        world.step(reference.start["dt"])
        assert np.abs(row(world) - reference.trajectory[step])[:, :3].max() < 2e-6  # m and rad


@pytest.mark.parametrize("name", QUIET)
def test_single_rests_where_double_does(name: str) -> None:
    reference = load(name)
    world = run(build(reference.start, "single"), len(reference.trajectory) - 1, reference.start["dt"])
    assert np.abs(row(world) - reference.trajectory[-1])[:, :3].max() < 2e-5


def test_single_and_double_are_not_the_same() -> None:
    # or the comparison above compares nothing
    single, double = run(busy("single"), 30), run(busy("double"), 30)
    error = np.abs(single.positions - double.positions).max()
    assert 0 < error < 5e-5


def test_the_solvers_numbers_are_of_the_precision() -> None:
    for precision, real in (("single", np.float32), ("double", np.float64)):
        state = run(busy(precision), 1)._state
        assert state.bodies.tables["motions"].dtype["vx"] == real
        assert state.arbiters.contacts.dtype["normal_impulse"] == real
        assert state.joints.tables["joints"].dtype["mass_xx"] == real
        assert state.steps.dtype["dt"] == real
        assert state.bodies.tables["bodies"].dtype["x"] == np.float64


def test_positions_are_doubles_in_single_precision() -> None:
    world = busy("single", gravity=(0, 0), sleeping=False)
    body = world.bodies[1]
    body.position, body.velocity = (1e6, 0.0), (0.001, 0)
    body.angular_velocity = 0.0
    run(world, 60)
    assert body.position.x - 1e6 == pytest.approx(0.001 * 60 * DT, rel=1e-5)  # a float32 there counts in 6 cm
