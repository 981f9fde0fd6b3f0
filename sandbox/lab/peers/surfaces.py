"""Coefficients of friction or restitution for an engine whose shapes mix theirs by another rule than ours."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from engine import mixing
from sandbox.lab.peers.description import BodyDescription

Coefficient = Callable[[float, bool], float]
"""What the other engine's shape is given, for ours and whether its body is moved by impulses."""


class Values(NamedTuple):
    """Which coefficients there are among shapes that impulses move, and among the others, which never meet."""

    moving: frozenset[float]
    fixed: frozenset[float]

    @classmethod
    def of(cls, name: str, bodies: Iterable[BodyDescription]) -> Values:
        """name: "friction" or "restitution"."""
        found: tuple[set[float], set[float]] = (set(), set())
        for body in bodies:
            found[body.kind != "dynamic"].update(getattr(outline, name) for outline in body.outlines)
        return cls(frozenset(found[0]), frozenset(found[1]))

    def pairs(self, rule: str) -> set[float]:
        """What pairs that may meet have."""
        return {mix(rule, a, b) for a in self.moving for b in self.moving | self.fixed}


def mix(rule: str, a: float, b: float) -> float:
    """As the engine does it."""
    function: Any = getattr(mixing.mix, "py_func", mixing.mix)
    return float(function(mixing.RULES.index(rule), a, b))


def for_product(rule: str, values: Values) -> Coefficient | None:
    """For an engine that takes the product of the two; None if no choice comes near.

    Exact for the rules "geometric" and "product", and where all pairs have one value. Otherwise what cannot move is
    given 1, so that everything is exact against it, but two moving shapes get the product of their own.
    """
    if rule == "geometric":
        return lambda value, _: math.sqrt(value)
    if rule == "product":
        return lambda value, _: value
    pairs = values.pairs(rule)
    if len(pairs) <= 1:
        root = math.sqrt(max(pairs, default=0.0))
        return lambda _, __: root
    against = {a: {mix(rule, a, b) for b in values.fixed} for a in values.moving}
    if any(len(mixed) != 1 for mixed in against.values()):
        return None
    own = {value: mixed.pop() for value, mixed in against.items()}
    return lambda value, moving: own[value] if moving else 1.0


def for_rule(theirs: str, rule: str, values: Values) -> Coefficient | None:
    """For an engine that mixes by the rule `theirs`, "geometric" or "greatest"; None if no choice is exact."""
    if rule == theirs:
        return lambda value, _: value
    if (theirs, rule) == ("geometric", "product"):
        return lambda value, _: value * value
    pairs = values.pairs(rule)
    if len(pairs) > 1:
        return None
    only = max(pairs, default=0.0)
    return lambda _, __: only
