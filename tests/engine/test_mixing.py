"""How two shapes agree on one friction or restitution."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import SOLVERS, Box, World
from engine.mixing import RULES, mix
from tests.engine.worlds import DT, floor

pytestmark = pytest.mark.kernel

EXPECTED = {
    "geometric": lambda a, b: math.sqrt(a * b),
    "mean": lambda a, b: (a + b) / 2,
    "least": min,
    "greatest": max,
    "product": lambda a, b: a * b,
}
coefficient = st.floats(0, 10)


@given(a=coefficient, b=coefficient)
def test_every_rule(a: float, b: float) -> None:
    for number, rule in enumerate(RULES):
        assert mix(number, a, b) == pytest.approx(EXPECTED[rule](a, b), rel=1e-15, abs=1e-300)
        assert mix(number, a, b) == mix(number, b, a), "whoever comes first"


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("rule", RULES)
def test_friction_of_a_pair_follows_the_setting(rule: str, solver: str) -> None:
    world = World(precision="double", solver=solver)
    floor(world, friction=0.9)
    world.create_body(Box(1, 1), position=(0, 0.499), friction=0.4)
    world.step(DT)
    assert world.arbiters[0].friction == math.sqrt(0.9 * 0.4), "the talk's"
    world.friction_mixing = rule
    world.step(DT)
    assert world.arbiters[0].friction == EXPECTED[rule](0.9, 0.4)
