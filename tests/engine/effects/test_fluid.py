"""Fluids as things of a world: handles, snapshots, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from engine import Box, Fluid, Snapshot, World
from tests.engine.worlds import DT, fingerprint, run

pytestmark = pytest.mark.kernel


def pool(**settings: Any) -> tuple[World, Fluid]:
    """A box that bobs in a fluid."""
    world = World(**settings)
    fluid = world.create_fluid((-4, -4), (4, 0), density=2.0, linear_drag=0.5, angular_drag=0.25)
    world.create_body(Box(1, 0.6), position=(0, 0.3), angle=0.2)
    return world, fluid


def test_a_handle_says_what_it_was_made_with() -> None:
    world, fluid = pool()
    assert (tuple(fluid.lower), tuple(fluid.upper)) == ((-4.0, -4.0), (4.0, 0.0))
    assert (fluid.density, fluid.linear_drag, fluid.angular_drag) == (2.0, 0.5, 0.25)
    assert fluid.alive
    assert world.fluids == [fluid]
    assert len({fluid, *world.fluids}) == 1
    assert repr(fluid) == "<Fluid 0: (-4.0, -4.0) to (4.0, 0.0), density 2>"
    assert world.fluid_records()["upper_x"].tolist() == [4.0]
    assert {e.name: e.because for e in world.effects}["buoyancy"] == "1 fluid"


def test_it_can_be_changed_and_destroyed() -> None:
    world, fluid = pool()
    fluid.density, fluid.linear_drag, fluid.angular_drag = 5.0, 0.0, 1.0
    other = world.create_fluid((0, 0), (1, 1), density=1.0)
    assert {e.name: e.because for e in world.effects}["buoyancy"] == "2 fluids"
    fluid.destroy()
    assert not fluid.alive
    assert world.fluids == [other]
    assert repr(fluid) == "<Fluid 0, destroyed>"
    with pytest.raises(ValueError, match=r"^fluid = Fluid 0: must be a living fluid, this one was destroyed$"):
        fluid.destroy()
    with pytest.raises(ValueError, match="this one was destroyed"):
        fluid.density = 1.0
    again = world.create_fluid((0, 0), (1, 1), density=1.0)
    assert again._row == fluid._row
    assert again != fluid
    assert not fluid.alive


@pytest.mark.parametrize("precision", ["single", "double"])
def test_a_snapshot_has_it(precision: str) -> None:
    world, fluid = pool(precision=precision)
    run(world, 40)
    kept = Snapshot.from_bytes(world.snapshot().to_bytes())
    expected = run(world, 60).state_hash()
    fluid.destroy()
    run(world, 7)
    world.restore(kept)
    assert fluid.alive
    assert run(world, 60).state_hash() == expected
    elsewhere = World(precision=precision)
    elsewhere.restore(kept)
    assert run(elsewhere, 60).state_hash() == expected
    assert elsewhere.fluids[0].density == 2.0


def test_none_is_there_where_none_was_made() -> None:
    world = World()
    world.create_body(Box(1, 1))
    world.step(DT)
    assert world.fluids == []
    assert len(world.snapshot().tables["fluids.fluids"]) == 0
    assert world._state.forces == []
    assert world._state.gathered == {}


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"lower_x": 9.0}, "of rectangles, lower before upper"),
        ({"upper_y": -4.0}, "of rectangles, lower before upper"),
        ({"density": 0.0}, "of positive density and no negative drag"),
        ({"linear_drag": -1.0}, "of positive density and no negative drag"),
        ({"angular_drag": -1.0}, "of positive density and no negative drag"),
        ({"density": math.nan}, "finite, density is not"),
        ({"serial": 7}, "of serials given once, below next_serial"),
    ],
)
def test_a_snapshot_that_cannot_be_is_refused(change: dict[str, float], what: str) -> None:
    world, _ = pool()
    snapshot = world.snapshot()
    for name, value in change.items():
        snapshot.tables["fluids.fluids"][name] = value
    before = fingerprint(world)
    with pytest.raises(ValueError, match=f"^snapshot: its table fluids.fluids must be {what}$"):
        world.restore(snapshot)
    assert fingerprint(world) == before


GOOD: dict[str, Any] = {"lower": (0, 0), "upper": (1, 1), "density": 1.0}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"lower": (0, math.nan)}, r"lower = .*: must be two finite numbers \(x, y\)"),
        ({"lower": "here"}, r"lower = 'here': must be two finite numbers \(x, y\)"),
        ({"upper": (1, math.inf)}, r"upper = .*: must be two finite numbers \(x, y\)"),
        ({"upper": (0, 1)}, r"upper = \(0.0, 1.0\): must be above and to the right of lower = \(0.0, 0.0\)"),
        ({"upper": (1, -1)}, r"upper = .*: must be above and to the right of lower = .*"),
        ({"density": 0}, "density = 0: must be a finite number > 0"),
        ({"density": 1e300}, "density = .*: must be of parts of at most 3.4e.38 in single precision"),
        ({"linear_drag": -1}, "linear_drag = -1: must be a finite number >= 0"),
        ({"angular_drag": math.nan}, "angular_drag = nan: must be a finite number >= 0"),
        ({"angular_drag": True}, "angular_drag = True: must be a finite number >= 0"),
    ],
)
def test_refused(change: dict[str, Any], message: str) -> None:
    world, fluid = pool()
    before = fingerprint(world)
    with pytest.raises(ValueError, match=f"^{message}$"):
        world.create_fluid(**{**GOOD, **change})
    assert fingerprint(world) == before
    for name in change.keys() & {"density", "linear_drag", "angular_drag"}:
        with pytest.raises(ValueError, match=f"^{message}$"):
            setattr(fluid, name, change[name])
    assert fingerprint(world) == before


def test_without_jit_tables_are_read_the_same() -> None:
    world, _ = pool(precision="double")
    run(world, 5)
    assert np.isfinite(world.positions).all()
