"""Settings: there and back, as JSON and as properties of a world."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError, fields
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Settings, World

CHANGES: dict[str, Any] = {
    "gravity": (1.5, -3.0),
    "solver": "sequential_impulses",
    "iterations": 17,
    "broad_phase": "all_pairs",
    "accumulate_impulses": False,
    "warm_starting": False,
    "position_correction": False,
}


@given(
    gravity=st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
    iterations=st.integers(1, 10_000),
    precision=st.sampled_from(["single", "double"]),
    switches=st.tuples(st.booleans(), st.booleans(), st.booleans()),
)
def test_there_and_back_through_json(gravity, iterations, precision, switches) -> None:
    settings = Settings(gravity, "sequential_impulses", iterations, precision, "all_pairs", *switches)
    assert Settings.from_dict(json.loads(json.dumps(settings.to_dict()))) == settings


def test_unknown_name_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^setting = 'color': must be one of 'gravity'"):
        Settings.from_dict({"color": 1})


def test_immutable_and_normalised() -> None:
    settings = Settings(gravity=[0, -3])  # type: ignore[arg-type]
    assert settings.gravity == (0.0, -3.0)
    assert type(settings.gravity) is tuple
    with pytest.raises(FrozenInstanceError):
        settings.iterations = 3  # type: ignore[misc]


def test_every_setting_is_a_property_of_the_world() -> None:
    assert {*CHANGES, "precision"} == {field.name for field in fields(Settings)}
    world = World(precision="double")
    for name, value in CHANGES.items():
        assert getattr(world, name) == getattr(Settings(), name)
        setattr(world, name, value)
        assert getattr(world, name) == getattr(world.settings, name) == value
    other = World(precision="double")
    other.set(**CHANGES)
    assert other.settings == world.settings
    assert other.settings == World(precision="double", **CHANGES).settings
    with pytest.raises(ValueError, match="precision = 'single'"):
        world.precision = "single"
    world.precision = "double"


def test_switches_reach_the_step() -> None:
    # each of them changes what a busy world does
    from tests.engine.worlds import busy, run

    hashes = {run(busy("double"), 40).state_hash()}
    for name, value in CHANGES.items():
        if name not in ("solver", "broad_phase"):
            hashes.add(run(busy("double", **{name: value}), 40).state_hash())
    assert len(hashes) == len(CHANGES) - 2 + 1
