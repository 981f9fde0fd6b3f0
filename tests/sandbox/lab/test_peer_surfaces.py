"""Coefficients for engines that mix by other rules: a pair there has what it has here, wherever that can be."""

from __future__ import annotations

import itertools
import math

import pytest

from engine import mixing
from sandbox.lab.peers.surfaces import Values, for_product, for_rule, mix

RULES = mixing.RULES
EXACT = [
    ("geometric", (0.2, 0.9), (0.0, 0.5)),
    ("product", (0.2, 0.9), (0.0, 0.5)),
    *((rule, (0.4,), (0.4,)) for rule in RULES),
    ("greatest", (0.3,), (0.0, 0.1)),  # balls all alike on ground that is less springy
    ("least", (0.3,), (0.5, 1.0)),
]


def values(moving: tuple[float, ...], fixed: tuple[float, ...]) -> Values:
    return Values(frozenset(moving), frozenset(fixed))


def pairs(known: Values) -> list[tuple[float, float, bool]]:
    """Coefficients of two shapes that may meet, and whether the second moves."""
    return [
        *((a, b, True) for a, b in itertools.product(known.moving, repeat=2)),
        *((a, b, False) for a in known.moving for b in known.fixed),
    ]


@pytest.mark.parametrize(("rule", "moving", "fixed"), EXACT)
def test_products_are_what_the_rule_gives(rule: str, moving: tuple[float, ...], fixed: tuple[float, ...]) -> None:
    known = values(moving, fixed)
    found = for_product(rule, known)
    assert found is not None
    for a, b, moves in pairs(known):
        assert found(a, True) * found(b, moves) == pytest.approx(mix(rule, a, b))


def test_balls_of_different_bounce_are_exact_against_the_ground() -> None:
    found = for_product("greatest", values((0.0, 0.5, 0.9), (0.0,)))
    assert found is not None
    assert [found(a, True) * found(0.0, False) for a in (0.0, 0.5, 0.9)] == [0.0, 0.5, 0.9]


def test_no_product_fits_a_trampoline_beside_dull_ground() -> None:
    assert for_product("greatest", values((0.0, 0.3), (0.0, 0.9))) is None


def test_a_rule_of_its_own_takes_coefficients_as_they_are() -> None:
    for rule in ("geometric", "greatest"):
        found = for_rule(rule, rule, values((0.1, 0.7), (0.3,)))
        assert found is not None
        assert found(0.7, True) == 0.7


def test_the_geometric_mean_of_squares_is_the_product() -> None:
    found = for_rule("geometric", "product", values((0.1, 0.7), (0.3,)))
    assert found is not None
    assert math.sqrt(found(0.7, True) * found(0.3, False)) == pytest.approx(0.7 * 0.3)


def test_one_value_for_all_pairs_fits_any_rule() -> None:
    found = for_rule("greatest", "mean", values((0.4,), (0.4,)))
    assert found is not None
    assert found(0.4, True) == pytest.approx(0.4)
    assert for_rule("greatest", "mean", values((0.4,), (0.2,))) is None


def test_shapes_that_cannot_meet_do_not_matter() -> None:
    assert for_rule("greatest", "mean", values((), (0.2, 0.7))) is not None
