"""Compares a recording with the same simulation computed again, bit for bit."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from engine.events import DTYPES
from recordings.protocols import StateLike
from recordings.recording import Recording
from recordings.schema import CONTACTS, JOINTS

_MISSING = "nothing"


@dataclass(frozen=True)
class Difference:
    """The first place where the computed states leave the recorded ones."""

    step: int
    body: int | None  # serial; of a contact, joint or event its first body; None if the whole step differs
    field: str
    recorded: object
    computed: object

    def __str__(self) -> str:
        where = f"step {self.step}" if self.body is None else f"step {self.step}, body {self.body}"
        return f"{where}: {self.field} was {_shown(self.recorded)} when recorded, {_shown(self.computed)} when computed"


def compare(recording: Recording, states: Iterable[StateLike]) -> Difference | None:
    """The first difference, or None if every recorded step came again with the same bits.

    `states` yields the computed steps in order, with or without the start. Equal NaNs are equal, 0.0 and -0.0 are not.
    """
    expected = iter(map(int, recording.steps))
    for state in states:
        if state.step != recording.start_step:
            step = next(expected, None)
            if step is None:
                return None
            if state.step != step:
                return Difference(step, None, "step", step, state.step)
        elif not recording.holds(state.step):
            continue
        difference = compare_states(recording.state(state.step), state)
        if difference is not None:
            return difference
    step = next(expected, None)
    return None if step is None else Difference(step, None, "step", step, _MISSING)


def compare_states(recorded: StateLike, computed: StateLike) -> Difference | None:
    """The first difference between two states of one step."""
    step = recorded.step
    serials = recorded.serials
    if len(serials) != len(computed.serials):
        return Difference(step, None, "body count", len(serials), len(computed.serials))
    columns = [
        ("serial", serials, computed.serials),
        ("kind", recorded.body_kinds, computed.body_kinds),
        ("x", recorded.positions[:, 0], computed.positions[:, 0]),
        ("y", recorded.positions[:, 1], computed.positions[:, 1]),
        ("angle", recorded.angles, computed.angles),
        ("velocity x", recorded.velocities[:, 0], computed.velocities[:, 0]),
        ("velocity y", recorded.velocities[:, 1], computed.velocities[:, 1]),
        ("angular velocity", recorded.angular_velocities, computed.angular_velocities),
        ("asleep", recorded.asleep, computed.asleep),
    ]
    return (
        _first_difference(step, serials, columns)
        or _compare_pieces(recorded, computed)
        or _compare_records(step, "contact", recorded.contacts, computed.contacts, CONTACTS.dtype)
        or _compare_records(step, "joint", recorded.joints, computed.joints, JOINTS.dtype)
        or _compare_events(recorded, computed)
    )


def _compare_events(recorded: StateLike, computed: StateLike) -> Difference | None:
    """What happened in the step; of older recordings, and where the world was not asked, nothing on either side."""
    for kind, dtype in DTYPES.items():
        noun = f"{kind.replace('_', ' ')} event"
        found = _compare_records(
            recorded.step, noun, getattr(recorded.events, kind), getattr(computed.events, kind), dtype
        )
        if found is not None:
            return found
    return None


def _compare_pieces(recorded: StateLike, computed: StateLike) -> Difference | None:
    """What the bodies look like. A difference is that of the piece's body."""
    for noun, was, became in (
        ("piece", recorded.shape_serials, computed.shape_serials),
        ("corner", recorded.corners, computed.corners),
    ):
        if len(was) != len(became):
            return Difference(recorded.step, None, f"{noun} count", len(was), len(became))
    columns = [
        ("piece serial", recorded.shape_serials, computed.shape_serials),
        ("piece owner", recorded.owners, computed.owners),
        ("piece kind", recorded.shape_kinds, computed.shape_kinds),
        ("piece corner count", recorded.corner_counts, computed.corner_counts),
    ]
    for name, fields in (("sizes", ("size 1", "size 2")), ("places", ("place x", "place y", "place angle"))):
        was, became = getattr(recorded, name), getattr(computed, name)
        columns += [(f"piece {field}", was[:, k], became[:, k]) for k, field in enumerate(fields)]
    owners = recorded.serials[recorded.owners]
    found = _first_difference(recorded.step, owners, columns)
    if found is not None:
        return found
    corners = [(f"corner {axis}", recorded.corners[:, k], computed.corners[:, k]) for k, axis in enumerate("xy")]
    return _first_difference(recorded.step, np.repeat(owners, recorded.corner_counts), corners)


def _compare_records(
    step: int, noun: str, recorded: np.ndarray, computed: np.ndarray, dtype: np.dtype
) -> Difference | None:
    if len(recorded) != len(computed):
        return Difference(step, None, f"{noun} count", len(recorded), len(computed))
    columns = [(f"{noun} {name}", recorded[name], computed[name]) for name in dtype.names or ()]
    whose = "body1" if "body1" in (dtype.names or ()) else "body"
    return _first_difference(step, recorded[whose], columns)


def _first_difference(
    step: int, serials: np.ndarray, columns: list[tuple[str, np.ndarray, np.ndarray]]
) -> Difference | None:
    """Of the first body that differs the first field."""
    found: tuple[int, str, object, object] | None = None
    for field, recorded, computed in columns:
        unequal = np.flatnonzero(_bits(recorded) != _bits(computed.astype(recorded.dtype, copy=False)))
        if len(unequal) and (found is None or unequal[0] < found[0]):
            row = int(unequal[0])
            found = row, field, recorded[row].item(), computed[row].item()
    if found is None:
        return None
    row, field, was, became = found
    return Difference(step, int(serials[row]), field, was, became)


def _bits(values: np.ndarray) -> np.ndarray:
    """The values as whole numbers of the same bits."""
    return np.ascontiguousarray(values).view(f"i{values.dtype.itemsize}")


def _shown(value: object) -> str:
    """Floats so that one last bit shows."""
    return f"{value!r} ({value.hex()})" if isinstance(value, float) else str(value)
