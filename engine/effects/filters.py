"""Which shapes ignore each other: categories, masks and groups."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.effects.effect import Effect, Property, number_of_shapes
from engine.jit import kernel

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

ALL = 2**63 - 1  # every category


def bits(name: str, value: Any) -> int:
    return validate.whole(name, value, 0, ALL)


def group(name: str, value: Any) -> int:
    return validate.whole(name, value, -(2**31), 2**31)


def filtering(state: State, settings: Settings) -> str:
    """Any shape whose category, mask or group is not everybody's."""
    shapes = state.shapes
    departs = np.zeros(shapes.count, bool)
    for name in ("category", "mask", "group"):
        if name in shapes.columns:
            departs |= shapes.columns[name][shapes.order] != shapes.possible[name].default
    return number_of_shapes(state, departs, "a category, mask or group")


FILTERS = Effect(
    "filters",
    "some shapes pass through each other",
    filtering,
    shape=(
        Property("category", 1, bits, "bits: what it is", np.int64),
        Property("mask", ALL, bits, "bits: the categories it meets", np.int64),
        Property("group", 0, group, "two of one group meet always (> 0) or never (< 0)", np.int64),
    ),
)


@kernel
def may_meet(category1, mask1, group1, category2, mask2, group2):
    """Whether two shapes do not pass through each other.

    Of one group: never if it is negative, always if positive. Otherwise each one's mask must hold the other's category.
    """
    if group1 != 0 and group1 == group2:
        return group1 > 0
    return (mask1 & category2) != 0 and (mask2 & category1) != 0


@kernel
def drop_filtered(pairs, count, category, mask, group):
    """Takes pairs of shapes that pass through each other out of the first `count`, keeping the order."""
    kept = 0
    for index in range(count):
        row1 = pairs[index, 0]
        row2 = pairs[index, 1]
        if may_meet(category[row1], mask[row1], group[row1], category[row2], mask[row2], group[row2]):
            pairs[kept, 0] = row1
            pairs[kept, 1] = row2
            kept += 1
    return kept
