"""What happened in a step, as arrays: who began and ceased to touch, who hit whom, what moved, slept, woke or broke.

Two shapes begin to touch in the step in which a contact of theirs presses, or overlapped as the step found it; they
touch until a step in which none presses and all are further apart than constants.PARTING_DISTANCE. So contacts that are
only expected, up to the speculative distance ahead, are no touch, a pair at rest does not flicker, and of each pair
begin and end alternate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.touching import PAIR

TOUCH_EVENT = np.dtype([("step", np.int64), *((name, PAIR[name]) for name in PAIR.names or ())])
"""Two shapes begin or cease to touch: serials of the shapes, shape1 < shape2, and of their bodies. Of a chain, the
serial of the piece. `step`: the number of the step that it happened in, as World.step_count was after it; so in all."""

HIT_EVENT = np.dtype(
    [
        *((name, TOUCH_EVENT[name]) for name in TOUCH_EVENT.names or ()),
        ("x", np.float64),  # midway between the surfaces, as the step found them [m]
        ("y", np.float64),
        ("nx", np.float64),  # unit normal, from body1 to body2
        ("ny", np.float64),
        ("speed", np.float64),  # at which they came together along it as the step began, before it was solved [m/s]
    ]
)
"""Two shapes begin to touch faster than the setting hit_speed. Of two contacts the faster one, the first of equals."""

MOVED_EVENT = np.dtype(
    [
        ("step", np.int64),
        ("body", np.int64),  # serial
        ("x", np.float64),  # position after the step [m]
        ("y", np.float64),
        ("angle", np.float64),  # likewise, unwrapped [rad]
    ]
)
"""A body whose position or angle the step changed."""

BODY_EVENT = np.dtype([("step", np.int64), ("body", np.int64)])
"""A body, by its serial."""

BROKEN_EVENT = np.dtype(
    [
        ("step", np.int64),
        ("joint", np.int64),  # serial of the joint
        ("body1", np.int64),  # serials of its bodies
        ("body2", np.int64),
        ("force", np.float64),  # that broke it [N]
        ("torque", np.float64),  # [N m]
    ]
)
"""A joint that gave way."""


class Events(NamedTuple):
    """What happened in a step, or in many: read-only copies, step after step."""

    begin: np.ndarray  # (B,) TOUCH_EVENT, in a step in ascending order of the pair
    end: np.ndarray  # (E,) TOUCH_EVENT, likewise; also of what was destroyed, in the step after
    hit: np.ndarray  # (H,) HIT_EVENT, likewise
    moved: np.ndarray  # (M,) MOVED_EVENT, in the order of creation
    fell_asleep: np.ndarray  # (A,) BODY_EVENT, likewise
    woke: np.ndarray  # (W,) BODY_EVENT, likewise
    broken: np.ndarray  # (J,) BROKEN_EVENT, likewise


KINDS = Events._fields
DTYPES = dict(
    zip(KINDS, (TOUCH_EVENT, TOUCH_EVENT, HIT_EVENT, MOVED_EVENT, BODY_EVENT, BODY_EVENT, BROKEN_EVENT), strict=True)
)


def joined(parts: list[Events]) -> Events:
    """Several in a row as one; of none, one that is empty."""
    if len(parts) == 1:
        return parts[0]
    return Events(
        *(kept(np.concatenate([np.empty(0, dtype), *(getattr(part, kind) for part in parts)]))
        for kind, dtype in DTYPES.items())
    )  # fmt: skip


def kept(rows: np.ndarray) -> np.ndarray:
    """Read-only rows."""
    rows.flags.writeable = False
    return rows


NOTHING = joined([])
