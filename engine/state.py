"""All that a world is: its tables, and what was read off them when their content last changed."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.arbiters import ArbiterTable, follow_pairs, mix_friction
from engine.awake import list_all, list_arbiters, plan_bounds
from engine.broad_phase import BROAD_PHASES
from engine.colouring import Layout, any_change, any_change_among, give_colours
from engine.effects import BODY_PROPERTIES, EFFECTS, SHAPE_PROPERTIES
from engine.effects.filters import drop_filtered
from engine.effects.sleeping import restless_rows
from engine.happened import Happened
from engine.islands import COARSE, DRIVEN, Islands
from engine.joints.layout import JointLayout, joins
from engine.mixing import RULES
from engine.narrow_phase import COLLIDER_OF, COLLIDERS, TALK_COLLIDERS
from engine.narrow_phase.recycling import BOX
from engine.pairs import drop_joined
from engine.settings import Settings
from engine.simd import WIDTH
from engine.sleeping import fall_asleep, sleeping_rows, wake, wake_touched
from engine.solvers import SOLVERS
from engine.storage import Column, Storage
from engine.tables import (
    BODY,
    DYNAMIC,
    FLUID,
    HULL,
    KINEMATIC,
    SHAPE,
    STATIC,
    empty,
    free_dtype,
    joint_dtype,
    motion_dtype,
    placement_dtype,
    step_dtype,
)


class State:
    """The tables of one world. A step refreshes what is `stale` before it looks at it."""

    # What is awake, made by awake.py: rows of bodies, in the order of creation, and filled up to a multiple of eight;
    awake_order: np.ndarray
    moving: np.ndarray
    dynamic: np.ndarray
    body_lanes: np.ndarray
    moving_lanes: np.ndarray
    dynamic_lanes: np.ndarray
    joined_pairs: np.ndarray  # (J, 2) rows of bodies that are joined;
    indices: list[tuple[np.ndarray, int]]  # of arbiters, by collider,
    meetings: list[tuple[Any, np.ndarray, int]]  # with that collider, where there are any;
    chosen: np.ndarray
    awake_plan: list[tuple[Any, np.ndarray]]  # groups of shapes, with what finds their boxes

    def __init__(self, settings: Settings) -> None:
        precision = settings.precision
        self.precision = precision
        body_columns = {name: p.column() for name, p in BODY_PROPERTIES.items()} | SLEEP_COLUMNS
        shape_columns = {name: p.column() for name, p in SHAPE_PROPERTIES.items()}
        self.bodies = Storage({"bodies": BODY, "motions": motion_dtype(precision)}, body_columns)
        self.shapes = Storage({"shapes": SHAPE}, shape_columns)
        self.hulls = Storage({"hulls": HULL})
        free = free_dtype(precision)
        self.joints = Storage({"joints": joint_dtype(precision), "turns": free, "slides": free})
        self.fluids = Storage({"fluids": FLUID})
        self.arbiters = ArbiterTable(precision, 0)
        self.spare_arbiters = ArbiterTable(precision, 0)  # where the next change of pairs is written
        self.steps = empty(1, step_dtype(precision))
        self.step_count = 0
        self.time = 0.0  # [s]
        self.last_dt = 0.0  # of the last step [s]
        self.explosions = 0  # so far
        self.scratch: dict[str, Any] = {}  # tables that a solver makes for itself; nothing in them lasts
        self.happened = Happened()  # events, where something calls for them
        self.forced: frozenset[str] = frozenset()  # effects whose code runs though nothing calls for them
        self.suppressed: frozenset[str] = frozenset()  # effects whose code does not run though something does
        self.gathered: dict[str, Any] = {}  # what effects read off the content, until it changes
        self.diagnosed_at: int | None = None  # step count when somebody asked for diagnostics
        self.layout = Layout()  # touching arbiters by colour
        self.joint_layout = JointLayout()
        self.chains: Any = None  # joints that are solved at once
        self.colours_are_stale = True  # something began or ceased to touch, or arbiters are others
        self.solve_plan: Any = None  # what the solver reads off content and colours, until either changes
        self.addresses: dict[Any, int] = {}  # of compiled kernels, see run.py; until content changes
        self.repetition: Any = None  # what steps in a row read off all that, see run.py
        self.pause = self.pause_left = 0  # steps for which Python does not try that again
        self.threads = 1  # that a step may use
        self.lanes = WIDTH  # contacts and joints that are solved at once: 8, or 1 to compare
        self.islands = Islands()
        self.counting = NOTHING  # 0, 1, 2, ...
        self.ready = np.ones(1, np.int64)  # bodies that have been still long enough to sleep, at most
        self.lists_are_stale = False  # of what is awake, see awake.py
        self.boxes_are_stale = False  # all bounding boxes are to be found, not only those of what is awake
        self.acting: np.ndarray | None = None  # bodies that can change what they touch; None: nobody sleeps
        self.watched: np.ndarray | None = None  # arbiters to look at; None: all
        self.watched_ranks: np.ndarray | None = None  # shapes whose boxes may change; None: all
        self.forget_broad_phase()
        self.stale = True  # content or settings changed since the last refresh
        self.prepared_for: Settings | None = None
        self.prepared_dt = self.prepared_carried = 0.0
        self.bounds_margin = 0.0  # by which bounding boxes are larger [m]

    def forget_broad_phase(self) -> None:
        """The next step finds all pairs anew. Which arbiters have contacts does not depend on it."""
        self.broad_name = ""
        self.pairs = np.empty((0, 2), np.int64)  # of rows of shapes that may touch

    # --- what the content calls for -----------------------------------------------------------------------------

    def active(self, settings: Settings) -> frozenset[str]:
        """Names of the effects whose code runs."""
        wanted = {effect.name for effect in EFFECTS if effect.because(self, settings)}
        return frozenset((wanted | self.forced) - self.suppressed)

    def refresh(self, settings: Settings) -> None:
        """Reads off the content what the stages need: which effects, which shapes, who moves, who ignores whom."""
        for storage in (self.bodies, self.shapes):
            storage.drop_idle_columns()
        self.effects = self.active(settings)
        self.happened.switch("events" in self.effects)
        self.gathered = {}
        self.solve_plan = None
        self.addresses = {}
        for effect in EFFECTS:
            if effect.name in self.forced:
                for properties, storage in ((effect.body, self.bodies), (effect.shape, self.shapes)):
                    for item in properties:
                        storage.ensure(item.name)
        self._refresh_bodies(settings)
        self._refresh_shapes(settings)
        self._refresh_pairs(settings)
        self.active_joints = self.joints.tables["joints"] if joins(self.effects) else None
        list_all(self)
        self.forces = [e.apply for e in EFFECTS if e.apply is not None and e.name in self.effects]
        self.stale = False

    def column(self, effect: str, storage: Storage, name: str) -> np.ndarray | None:
        """A column, where its effect is active."""
        return storage.columns.get(name) if effect in self.effects else None

    def _refresh_bodies(self, settings: Settings) -> None:
        self.gravity_scales = self.column("gravity scale", self.bodies, "gravity_scale")
        self.linear_damping = self.column("linear damping", self.bodies, "linear_damping")
        self.angular_damping = self.column("angular damping", self.bodies, "angular_damping")
        self.timed = self.steps if settings.sleeping and "sleeping" in self.effects else None
        self.restless = restless_rows(self, settings)
        self.belts = self.column("conveyor", self.shapes, "tangent_speed")
        motions, order = self.bodies.tables["motions"], self.bodies.order
        unheld = (motions["inverse_mass"][order] == 0) & (self.bodies.tables["bodies"]["kind"][order] != STATIC)
        self.islands.flags[DRIVEN] = self.belts is not None or bool(unheld.any())
        if self.belts is None:
            self.belts = np.zeros(len(self.shapes.tables["shapes"]))
        self.wake_restless()
        self.islands.forget(len(motions))
        self.ready[0] = self.timed is not None

    def wake_restless(self) -> None:
        """What sleeps and no longer may, wakes."""
        sleepers = sleeping_rows(self)
        wake(self, sleepers[self.restless[sleepers] != 0])

    def _refresh_shapes(self, settings: Settings) -> None:
        order = self.shapes.order
        shapes = self.shapes.tables["shapes"]
        self.placements = _sized(self.__dict__.get("placements"), len(shapes), placement_dtype(self.precision))
        self.ranks = np.zeros(len(shapes), np.int64)
        self.ranks[order] = np.arange(len(order))
        self.bounds = np.zeros((4, len(order)), np.float32)
        self.boxes = empty(len(shapes), BOX)
        self.full_plan = plan_bounds(self, np.arange(len(order)))
        self.boxes_are_stale = True
        body_kinds = self.bodies.tables["bodies"]["kind"][shapes["body"][order]]
        self.groups = np.where(body_kinds == DYNAMIC, 1, np.where(body_kinds == KINEMATIC, 2, 0)).astype(np.uint8)

    def _refresh_pairs(self, settings: Settings) -> None:
        shapes = self.shapes.tables["shapes"]
        order = self.shapes.order
        if self.broad_name != settings.broad_phase:
            self.broad_name = settings.broad_phase
            self.broad_phase = BROAD_PHASES[settings.broad_phase]()
        self.broad_phase.sync(order, shapes["serial"][order], self.groups)
        talk = SOLVERS[settings.solver].talk_clipping
        self.colliders = TALK_COLLIDERS if talk else COLLIDERS
        self.joined = self._joined_pairs() if "joined without colliding" in self.effects else None
        self.pairs_are_stale = self.friction_is_stale = True

    def arrange_joints(self, order: np.ndarray) -> None:
        """Which of the joints in these rows are solved at once, and which of the others side by side."""
        settings = self.prepared_for
        solves = self.active_joints is not None and settings is not None
        self.chains = SOLVERS[settings.solver].find_chains(self, settings, order) if solves and settings else None
        self.joint_layout.arrange(self, order)

    def _joined_pairs(self) -> np.ndarray:
        """(P, 2) int64 serials of bodies joined without colliding, ascending."""
        joints, order = self.joints.tables["joints"], self.joints.order
        order = order[joints["collide_connected"][order] == 0]
        serials = self.bodies.tables["bodies"]["serial"]
        one, other = serials[joints["body1"][order]], serials[joints["body2"][order]]
        low, high = np.minimum(one, other), np.maximum(one, other)
        pairs = np.stack([low, high], axis=1)[np.lexsort((high, low))]
        return pairs[np.append(True, (np.diff(pairs, axis=0) != 0).any(axis=1))] if len(pairs) else pairs

    # --- pairs and arbiters -------------------------------------------------------------------------------------

    def follow(self, settings: Settings) -> None:
        """Makes the arbiters those of the pairs that the broad phase holds."""
        self.pairs_are_stale = False
        shapes = self.shapes.tables["shapes"]
        pairs, count = self.broad_phase.pairs, self.broad_phase.pair_count
        if self.joined is not None or "filters" in self.effects:
            pairs = np.array(pairs[:count])  # the broad phase keeps those that are dropped here
        if self.joined is not None:
            count = drop_joined(pairs, count, shapes, self.bodies.tables["bodies"], self.joined)
        if "filters" in self.effects:
            columns = (self.shapes.ensure(name) for name in ("category", "mask", "group"))
            count = drop_filtered(pairs, count, *columns)
        if count == 0 and self.arbiters.count == 0 and self.solve_plan is not None and not self.colours_are_stale:
            return  # no pair may touch, as before: what was listed and planned holds
        old, new = self.arbiters, self.spare_arbiters
        if new.capacity < count:
            new = ArbiterTable(self.precision, max(16, count + count // 2))
        rule = RULES.index(settings.friction_mixing)
        new.count = count = follow_pairs(
            pairs, count, np.ascontiguousarray(shapes["serial"]), shapes, COLLIDER_OF, rule, old.rows, old.contacts,
            old.count, new.rows, new.contacts, new.kinds, self.bodies.tables["motions"],
        )  # fmt: skip
        if self.friction_is_stale:
            mix_friction(new.rows, count, shapes, rule)
            self.friction_is_stale = False
        new.point_at_nobody(len(self.bodies.tables["bodies"]), len(shapes))
        self.arbiters, self.spare_arbiters = new, old
        self.colours_are_stale = True
        self.islands.flags[COARSE] = 1  # what has gone may have touched
        list_arbiters(self)

    def watched_arbiters(self) -> np.ndarray:
        """Indices of the arbiters to look at, ascending."""
        if self.watched is not None:
            return self.watched
        if len(self.counting) < self.arbiters.count:
            self.counting = np.arange(2 * self.arbiters.count)
        return self.counting[: self.arbiters.count]

    def follow_contacts(self) -> None:
        """Takes up what has begun to touch and what has parted: it wakes what sleeps, joins islands, gets a colour."""
        table = self.arbiters
        changed = self.colours_are_stale
        if not changed:
            differ, watched = (any_change, NOTHING) if self.watched is None else (any_change_among, self.watched)
            changed = differ(table.rows, table.count, watched)
        if changed:
            if wake_touched(self):
                list_all(self)
            self.islands.follow(self.watched_arbiters(), table.rows, self.bodies.tables["motions"])
        if self.timed is not None and self.ready[0] > 0 and fall_asleep(self):
            list_all(self)
            changed = True
        if changed:
            self.follow_colours()

    def follow_colours(self) -> None:
        """Gives what touches a colour, and takes that of what has parted. What sleeps keeps its own, and no place."""
        table, motions = self.arbiters, self.bodies.tables["motions"]
        watched = self.watched_arbiters()
        give_colours(table.rows, watched, motions, np.empty(len(motions), np.int64))
        if self.watched is None:
            self.layout.arrange(table.rows["colour"][: table.count], self.lanes, table.nothing)
        else:
            self.layout.arrange(table.rows["colour"][watched], self.lanes, -1)
            self.layout.slots = np.append(watched, table.nothing)[self.layout.slots].astype(np.int32)
        self.colours_are_stale = False
        self.solve_plan = None

    def drop_arbiters(self, serials: Any) -> None:
        """Forgets the contacts of shapes that are going."""
        table = self.arbiters
        rows = table.rows[: table.count]
        going = np.isin(rows["serial1"], serials) | np.isin(rows["serial2"], serials)
        kept = np.flatnonzero(~going)
        table.rows[: len(kept)] = rows[kept]
        table.contacts[: len(kept)] = table.contacts[kept]
        table.count = len(kept)

    def find_contacts_anew(self, body: int) -> None:
        """Lets the next step recycle no contact of the body in that row."""
        rows = self.arbiters.rows[: self.arbiters.count]
        rows["recyclable"][(rows["body1"] == body) | (rows["body2"] == body)] = 0

    # --- snapshots ----------------------------------------------------------------------------------------------

    def save(self) -> dict[str, np.ndarray]:
        """Copies of every table that a later step depends on."""
        table = self.arbiters
        touching = np.flatnonzero(table.rows["count"][: table.count])
        saved = {
            f"{name}.{key}": rows for name, storage in self.storages().items() for key, rows in storage.save().items()
        }
        return {
            **saved,
            **self.happened.save(),
            "arbiters": np.array(table.rows[touching]),
            "contacts": np.array(table.contacts[touching]),
            "step_count": np.array(self.step_count, np.int64),
            "time": np.array(self.time),
            "last_dt": np.array(self.last_dt),
            "explosions": np.array(self.explosions, np.int64),
        }

    def load(self, saved: dict[str, Any]) -> None:
        """Takes back what `save` gave."""
        for name, storage in self.storages().items():
            prefix = name + "."
            storage.load({key.removeprefix(prefix): rows for key, rows in saved.items() if key.startswith(prefix)})
        count = len(saved["arbiters"])
        self.arbiters = ArbiterTable(self.precision, count)
        self.arbiters.rows[:count] = saved["arbiters"]
        self.arbiters.contacts[:count] = saved["contacts"]
        self.arbiters.count = count
        self.step_count = int(saved["step_count"])
        self.time = float(saved["time"])
        self.last_dt = float(saved["last_dt"])
        self.explosions = int(saved["explosions"])
        self.happened.load(saved)
        self.forget_broad_phase()
        self.prepared_for = None
        self.stale = True

    @property
    def dormant(self) -> bool:
        """Whether nothing can happen: all that has weight sleeps, and nothing else goes its way."""
        return (
            self.acting is not None
            and not (self.stale or self.lists_are_stale or self.boxes_are_stale or self.pairs_are_stale)
            and not (self.colours_are_stale or self.acting.any())
        )

    def storages(self) -> dict[str, Storage]:
        """What comes and goes in this world, by name."""
        return {
            "bodies": self.bodies, "shapes": self.shapes, "hulls": self.hulls, "joints": self.joints,
            "fluids": self.fluids,
        }  # fmt: skip


SLEEP_COLUMNS = {
    "asleep": Column(np.dtype(np.uint8), 0),  # 1: the body sleeps
    "disturbed": Column(np.dtype(np.uint8), 0),  # 1: a body without weight was moved or changed since the last step
}
NOTHING = np.empty(0, np.int64)


def _sized(table: np.ndarray | None, count: int, dtype: np.dtype) -> np.ndarray:
    """The table, or a new one where it is too short."""
    return empty(count, dtype) if table is None or len(table) < count else table
