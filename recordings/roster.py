"""Which bodies and shapes there are: noticed when it changes, so that shapes are written once and not every step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from recordings.shot import Shot


class Run(NamedTuple):
    """Shots in a row that have the same bodies."""

    first: int  # index of its first shot in the block
    shots: list[Shot]
    changed: bool  # whether these are other bodies than before the run


_CONTENT = (
    "serials", "body_kinds", "shape_serials", "owners", "shape_kinds", "sizes", "places", "corner_counts", "corners",
)  # fmt: skip


def same_bodies(a: Shot, b: Shot) -> bool:
    """Whether both shots have the same bodies with the same shapes, in the same order."""
    return all(_same(getattr(a, name), getattr(b, name)) for name in _CONTENT)


def runs(previous: Shot | None, shots: list[Shot]) -> Iterator[Run]:
    """Cuts a block where bodies or shapes come or go. `previous` is the last shot before the block."""
    first = 0
    changed = previous is None or not same_bodies(previous, shots[0])
    for index in range(1, len(shots)):
        if not same_bodies(shots[index - 1], shots[index]):
            yield Run(first, shots[first:index], changed)
            first, changed = index, True
    yield Run(first, shots[first:], changed)


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return a is b or (a.shape == b.shape and a.tobytes() == b.tobytes())
