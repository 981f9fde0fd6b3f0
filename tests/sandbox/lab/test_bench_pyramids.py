"""The pyramids that the bench measures are the talk's."""

from __future__ import annotations

import numpy as np
import pytest

from sandbox.lab.pyramids import BASES, pyramid
from sandbox.scenes import find_scene


def test_base_twelve_is_the_scene_of_the_talk() -> None:
    assert pyramid(12).make().state_hash() == find_scene("The Talk/Pyramid").make().state_hash()


@pytest.mark.parametrize("base", BASES)
def test_every_box_stands_above_the_ground(base: int) -> None:
    world = pyramid(base).make()
    ground, *boxes = world.bodies
    assert len(boxes) == base * (base + 1) // 2
    assert np.abs(world.positions[1:, 0]).max() + 0.5 < 0.5 * ground.shape.extent[0]


@pytest.mark.parametrize("base", [base for base in BASES if base > 12])
def test_larger_pyramids_are_centred(base: int) -> None:
    assert pyramid(base).make().positions[1:, 0].mean() == pytest.approx(0.0, abs=1e-9)


def test_settings_do_not_follow_the_defaults() -> None:
    settings = pyramid(12).defaults()
    assert (settings.solver, settings.iterations, settings.precision) == ("sequential_impulses", 10, "single")
