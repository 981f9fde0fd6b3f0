"""Hostile values at every entrance, in random order: refused with a ValueError and nothing changed, or borne.

And what is poisoned behind the engine's back is named by the step that meets it; the last good state comes back.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from engine import StepError, World
from tests.engine import hostile
from tests.engine.worlds import busy, fingerprint, gathering, run

CALLS = 40  # of an example


@settings(
    max_examples=40,
    phases=[Phase.explicit, Phase.generate],  # a failing draw of forty calls takes minutes to be made smaller
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(st.data())
def test_a_world_is_not_broken_from_outside(data: st.DataObject) -> None:
    place = hostile.Place(data.draw)
    for _ in range(CALLS):
        call = data.draw(st.sampled_from(hostile.CALLS))
        before, digest = fingerprint(place.world), place.world.state_hash()
        try:
            call(place)
        except ValueError as refusal:
            assert str(refusal)
            assert len(str(refusal)) < 1000
            assert fingerprint(place.world) == before, f"{call.__name__}: a refusal changed the world: {refusal}"
            assert place.world.state_hash() == digest
        except StepError as loss:  # finite values may be so large that what comes of them is not
            assert "body" in str(loss)
            return
        assert_finite(place.world)


def assert_finite(world: World) -> None:
    """Nothing in it is NaN or infinite that must not be."""
    for values in (world.positions, world.angles, world.velocities, world.angular_velocities):
        assert np.isfinite(values).all()


POISON = {"positions": ("bodies", "center_x"), "angle": ("bodies", "angle"), "speed": ("motions", "vy"),
          "spin": ("motions", "w")}  # fmt: skip


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize("what", POISON)
@pytest.mark.parametrize("make", [busy, gathering])
def test_a_poisoned_body_is_named_and_the_last_good_state_comes_back(make, what: str, value: float) -> None:
    world = run(make("single"), 20)
    good, digest = world.snapshot(), world.state_hash()
    after = run(world, 5).state_hash()
    world.restore(good)
    table, field = POISON[what]
    victim = next(body for body in world.bodies if body.kind == "dynamic")  # of all that it infects, the first
    world._state.bodies.tables[table][field][victim._row] = value
    with pytest.raises(StepError, match=rf"stage '.+': body {victim.serial} is no longer finite"):
        run(world, 5)
    world.restore(good)
    assert world.state_hash() == digest
    assert run(world, 5).state_hash() == after
