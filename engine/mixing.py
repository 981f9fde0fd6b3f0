"""How two shapes that touch agree on one friction or restitution."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import maximum, minimum, sqrt

RULES = ("geometric", "mean", "least", "greatest", "product")
GEOMETRIC, MEAN, LEAST, GREATEST, PRODUCT = range(5)


@kernel
def mix(rule, a, b):
    """geometric: sqrt(a b), the talk's for friction; or the mean, the lesser, the greater, the product of the two."""
    if rule == MEAN:
        return 0.5 * (a + b)
    if rule == LEAST:
        return minimum(a, b)
    if rule == GREATEST:
        return maximum(a, b)
    if rule == PRODUCT:
        return a * b
    return sqrt(a * b)
