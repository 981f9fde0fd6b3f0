"""Finding out what happened: what a step changed, and what its stages note on the way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.constants import PARTING_DISTANCE
from engine.events import DTYPES, HIT_EVENT, MOVED_EVENT, NOTHING, TOUCH_EVENT, Events, joined, kept
from engine.jit import kernel
from engine.tables import empty
from engine.touching import BEFORE, PAIR, follow_touches

if TYPE_CHECKING:
    from engine.state import State


@kernel
def remember(order, bodies, motions, before):
    """Writes where the bodies are and how they move into rows BEFORE, those of their tables."""
    for rank in range(len(order)):
        body, motion, was = bodies[order[rank]], motions[order[rank]], before[order[rank]]
        was.x, was.y, was.angle = body.x, body.y, body.angle
        was.center_x, was.center_y = body.center_x, body.center_y
        was.vx, was.vy, was.w = motion.vx, motion.vy, motion.w


@kernel
def find_moved(order, bodies, before, number, moved):
    """Writes a MOVED_EVENT for each body that is not where it was; returns how many."""
    total = 0
    for rank in range(len(order)):
        body, was = bodies[order[rank]], before[order[rank]]
        if body.x != was.x or body.y != was.y or body.angle != was.angle:
            event = moved[total]
            event.step = number
            event.body = body.serial
            event.x, event.y, event.angle = body.x, body.y, body.angle
            total += 1
    return total


class Happened:
    """The events of a world: those of the last step, or of the steps of the last World.run."""

    def __init__(self) -> None:
        self.on = False  # whether anything calls for them
        self.touching: np.ndarray | None = None  # (T,) PAIR, ascending; None: the contacts of the last step say it
        self._told: list[Events] = []  # step by step
        self._noted: dict[str, list[tuple]] = {}  # what is to be told with the next step
        self._rooms: dict[str, np.ndarray] = {}  # tables to write into
        self._spare = "touching"  # which of them `touching` does not stand in

    def switch(self, on: bool) -> None:
        """Content or settings changed; what is not called for is forgotten."""
        self.on = on
        if not on:
            self.load({})

    def save(self) -> dict[str, np.ndarray]:
        """For a snapshot: who touches, where that is known."""
        return {} if self.touching is None else {"touching": np.array(self.touching, PAIR)}

    def load(self, saved: Mapping[str, np.ndarray]) -> None:
        """Takes back what `save` gave, and tells only what happens from now on."""
        self.touching = None
        if "touching" in saved:
            self.touching = empty(len(saved["touching"]), PAIR)
            self.touching[:] = saved["touching"]
        self._told = []
        self._noted = {}

    def clear(self) -> None:
        """Before a step, or before many in a row."""
        self._told = []

    def events(self) -> Events:
        """Since `clear`."""
        return joined(self._told)

    # --- who has something to tell calls one of these, in a step or before it; the next step that ends tells it ------

    def note_fell_asleep(self, serials: Any) -> None:
        """Bodies of these serials, in the order of creation."""
        self._note("fell_asleep", [(int(serial),) for serial in serials])

    def note_woke(self, serials: Any) -> None:
        """Bodies of these serials, in the order of creation."""
        self._note("woke", [(int(serial),) for serial in serials])

    def note_broken(self, joint: int, body1: int, body2: int, force: float, torque: float) -> None:
        """A joint, by its serial and those of its bodies; what broke it [N], [N m]. In the order of creation."""
        self._note("broken", [(int(joint), int(body1), int(body2), float(force), float(torque))])

    def _note(self, kind: str, rows: list[tuple]) -> None:
        if self.on:
            self._noted.setdefault(kind, []).extend(rows)

    # --- around a step ----------------------------------------------------------------------------------------------

    def before_step(self, state: State) -> None:
        """Remembers what the step is going to change."""
        bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
        before = state.scratch.get("before")
        if before is None or len(before) != len(bodies):
            before = state.scratch["before"] = empty(len(bodies), BEFORE)
        remember(state.bodies.order, bodies, motions, before)
        if self.touching is None:
            self.touching = self._follow_touches(state, empty(0, PAIR), np.inf)[0]

    def after_step(self, state: State, hit_speed: float) -> None:
        """Finds what the step, number state.step_count, changed."""
        number, order, bodies = state.step_count, state.bodies.order, state.bodies.tables["bodies"]
        assert self.touching is not None
        self.touching, begin, end, hit = self._follow_touches(state, self.touching, hit_speed)
        moved = self._room("moved", len(order), MOVED_EVENT)
        moved = moved[: find_moved(order, bodies, state.scratch["before"], number, moved)]
        noted = {
            kind: np.array([(number, *row) for row in sorted(rows)], DTYPES[kind]) for kind, rows in self._noted.items()
        }
        self._noted = {}
        found = {"begin": begin, "end": end, "hit": hit, "moved": moved, **noted}
        copies = {kind: kept(np.array(rows, DTYPES[kind])) for kind, rows in found.items() if len(rows)}
        self._told.append(NOTHING._replace(**copies))

    def _follow_touches(self, state: State, old: np.ndarray, hit_speed: float) -> tuple[np.ndarray, ...]:
        """Who touches after the step, and what began, ended and hit; `old`: who touched before it."""
        table, bodies = state.arbiters, state.bodies.tables["bodies"]
        now, self._spare = self._spare, "touching" if self._spare == "touched" else "touched"
        rooms = (
            self._room(now, table.count, PAIR), self._room("begin", table.count, TOUCH_EVENT),
            self._room("end", len(old), TOUCH_EVENT), self._room("hit", table.count, HIT_EVENT),
        )  # fmt: skip
        totals = np.zeros(4, np.int64)
        follow_touches(
            table.rows, table.contacts, table.count, bodies, state.scratch["before"], old, state.step_count, hit_speed,
            PARTING_DISTANCE, *rooms, totals,
        )  # fmt: skip
        touching, begin, end, hit = (room[:total] for room, total in zip(rooms, totals, strict=True))
        return touching, begin, end, hit

    def _room(self, name: str, count: int, dtype: np.dtype) -> np.ndarray:
        """A table to write into, with room for so many; nothing in it lasts."""
        found = self._rooms.get(name)
        if found is None or len(found) < count:
            found = self._rooms[name] = empty(max(16, count + count // 2), dtype)
        return found
