"""At double precision the engine is Box2D Lite: every reference trajectory, step by step.

Positions and angles within 1e-8 over all steps; the same contacts, in the same order, at every step; impulses within
1e-7 of the step's largest. tests/data/box2d_lite/README.md says why these are the bars.
"""

from __future__ import annotations

import numpy as np
import pytest

from engine import BROAD_PHASES
from tests.engine.trajectories import NAMES, build, load, row

LENGTH = 1e-8  # m and rad
SPEED = 1e-6  # m/s and rad/s: LENGTH over a time step
IMPULSE = 1e-7  # of the step's largest
NEGLIGIBLE = 1e-9  # N s: where even the largest joint impulse is less, it is rounding


@pytest.mark.parametrize("broad_phase", BROAD_PHASES)
@pytest.mark.parametrize("name", NAMES)
def test_trajectory_is_box2d_lites(name: str, broad_phase: str) -> None:
    reference = load(name)
    world = build(reference.start, broad_phase=broad_phase)
    steps = len(reference.trajectory) - 1
    contacts = [reference.contacts[reference.contacts[:, 0] == step] for step in range(steps + 1)]
    assert np.abs(row(world) - reference.trajectory[0]).max() == 0.0
    for step in range(1, steps + 1):
        world.step(reference.start["dt"])
        error = np.abs(row(world) - reference.trajectory[step])
        assert error[:, :3].max() < LENGTH, f"step {step}: off by {error[:, :3].max():.2g}"
        assert error[:, 3:].max() < SPEED, f"step {step}: off by {error[:, 3:].max():.2g}"
        compare_contacts(world.contact_records(), contacts[step], step)
        compare_joints(world.joint_records(), reference.joints[step - 1], step)


def compare_contacts(found: np.ndarray, expected: np.ndarray, step: int) -> None:
    assert len(found) == len(expected), f"step {step}: {len(found)} contacts, not {len(expected)}"
    if len(found) == 0:
        return
    edges = expected[:, 3:7].astype(np.int64)
    features = edges[:, 0] | edges[:, 1] << 4 | edges[:, 2] << 8 | edges[:, 3] << 12
    for field, column in (("body1", expected[:, 1]), ("body2", expected[:, 2]), ("feature", features)):
        assert np.array_equal(found[field], column), f"step {step}: {field} {found[field]}, not {column}"
    for field, column in zip(("x", "y", "nx", "ny", "separation"), expected[:, 7:12].T, strict=True):
        assert np.abs(found[field] - column).max() < 10 * LENGTH, f"step {step}: {field}"
    largest = np.abs(expected[:, 12:]).max()
    for field, column in zip(("normal_impulse", "tangent_impulse"), expected[:, 12:].T, strict=True):
        error = np.abs(found[field] - column).max()
        assert error <= IMPULSE * largest, f"step {step}: {field} off by {error:.2g} of {largest:.2g}"


def compare_joints(found: np.ndarray, expected: np.ndarray, step: int) -> None:
    assert len(found) == len(expected)
    if len(found) == 0:
        return
    error = np.abs(np.column_stack([found["impulse_x"], found["impulse_y"]]) - expected).max()
    largest = np.abs(expected).max()
    bar = NEGLIGIBLE if largest < NEGLIGIBLE else IMPULSE * largest
    assert error <= bar, f"step {step}: joint impulse off by {error:.2g} of {largest:.2g}"


def test_there_are_trajectories() -> None:
    assert len(NAMES) >= 18
    assert {"no_accumulate", "no_warm_start", "no_position_correction"} <= {name.partition("_")[2] for name in NAMES}
