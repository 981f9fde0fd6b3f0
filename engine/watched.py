"""What there is in a world, and how it moves: all that one may ask, none of which changes anything."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, cast

import numpy as np

from engine import validate
from engine.bodies import Body, Pair
from engine.configured import Configured
from engine.diagnostics import Diagnostics, diagnose
from engine.effects import EffectStatus
from engine.effects.fluid import Fluid
from engine.effects.sleeping import SOLVERS as SLEEPERS_SOLVERS
from engine.events import Events
from engine.joints import KINDS, Joint
from engine.lacking import effect_statuses
from engine.queries import rows_at
from engine.records import Arbiter, arbiter_list, contact_records, joint_records
from engine.shape_handle import ShapeHandle
from engine.sleeping import asleep_of, island_names
from engine.tables import BODY_KINDS, DYNAMIC

if TYPE_CHECKING:
    from engine.state import State
    from engine.world import World


class Watched(Configured):
    """What has `_state` and `_handles` beside its settings."""

    _state: State
    _handles: weakref.WeakValueDictionary[int, Body]

    @property
    def _world(self) -> World:
        """Itself: only worlds are watched."""
        return cast("World", self)

    @property
    def step_count(self) -> int:
        """Steps since the world was made."""
        return self._state.step_count

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._state.time

    @property
    def bodies(self) -> list[Body]:
        """Living bodies in the order of creation."""
        return [self._body_in_row(int(row)) for row in self._state.bodies.order]

    @property
    def joints(self) -> list[Joint]:
        """Living joints in the order of creation."""
        storage = self._state.joints
        serials, kinds = storage.tables["joints"]["serial"], storage.tables["joints"]["kind"]
        return [KINDS[kinds[row]](self, int(row), int(serials[row])) for row in storage.order]

    @property
    def fluids(self) -> list[Fluid]:
        """Living fluids in the order of creation."""
        storage = self._state.fluids
        return [Fluid(self._world, int(row), int(storage.tables["fluids"]["serial"][row])) for row in storage.order]

    def fluid_records(self) -> np.ndarray:
        """(F,) FLUID: all fluids as one table, in the order of creation: a copy."""
        return self._state.fluids.gather("fluids")

    @property
    def body_count(self) -> int:
        return self._state.bodies.count

    @property
    def joint_count(self) -> int:
        return self._state.joints.count

    @property
    def arbiters(self) -> list[Arbiter]:
        """Who touches whom, as the last step found it; the impulses are those it ended with."""
        return arbiter_list(self._world)

    def contact_records(self) -> np.ndarray:
        """(C,) CONTACT_RECORD: all contacts of the last step as one table, in the solver's order."""
        return contact_records(self._state)

    def joint_records(self) -> np.ndarray:
        """(J,) JOINT_RECORD: all joints as one table, in the order of creation."""
        return joint_records(self._state)

    @property
    def events(self) -> Events:
        """What happened in the last step, or in all steps of the last `run`: engine/events.py says what is told.

        Of what was destroyed, and of what woke or broke between two steps, the step after tells. ValueError unless the
        setting tell_events is on.
        """
        if not self.tell_events:
            raise validate.refuse("tell_events", False, "True before the step whose events are to be read")
        return self._state.happened.events()

    def shape_records(self) -> np.ndarray:
        """(S,) SHAPE: all pieces of all shapes as one table, in the order of creation: a copy."""
        return self._state.shapes.gather("shapes")

    def hull_records(self) -> np.ndarray:
        """(H,) HULL: corners of polygons by row, as `hull` of shape_records says: a copy."""
        return np.array(self._state.hulls.tables["hulls"])

    @property
    def bounds(self) -> np.ndarray:
        """(S, 4) float32 [m]: lower x and y, upper x and y of the pieces' boxes, as the last step's broad phase had.

        In the order of creation; empty before the first step and after content changed.
        """
        if self._state.stale or not self._state.broad_name or self._state.step_count == 0:
            return np.empty((0, 4), np.float32)
        return self._state.broad_phase.fat_bounds()

    @property
    def effects(self) -> tuple[EffectStatus, ...]:
        """Every effect that the engine has, and what in this world calls for it."""
        return effect_statuses(self._state, self._settings)

    def body_records(self) -> np.ndarray:
        """(N,) BODY: what describes the bodies as one table, in the order of creation: a copy."""
        return self._state.bodies.gather("bodies")

    @property
    def positions(self) -> np.ndarray:
        """(N, 2) float64 [m]; like the next three: living bodies in the order of creation, read-only.

        A view of the state while nothing was destroyed and no capacity grew, so copy it to keep it.
        """
        return self._columns("bodies", "x", 2)

    @property
    def angles(self) -> np.ndarray:
        """(N,) float64, unwrapped [rad]."""
        return self._columns("bodies", "angle", 1)[:, 0]

    @property
    def velocities(self) -> np.ndarray:
        """(N, 2) float64 [m/s]; in single precision a copy."""
        return self._columns("motions", "vx", 2)

    @property
    def angular_velocities(self) -> np.ndarray:
        """(N,) float64 [rad/s]; in single precision a copy."""
        return self._columns("motions", "w", 1)[:, 0]

    @property
    def asleep(self) -> np.ndarray:
        """(N,) bool: who sleeps; living bodies in the order of creation, a copy."""
        asleep, order = asleep_of(self._state), self._state.bodies.order
        return np.zeros(len(order), np.bool_) if asleep is None else asleep[order] != 0

    @property
    def awake_count(self) -> int:
        """How many dynamic bodies are awake."""
        kinds = self._state.bodies.tables["bodies"]["kind"][self._state.bodies.order]
        return int(np.count_nonzero((kinds == DYNAMIC) & ~self.asleep))

    @property
    def islands(self) -> np.ndarray:
        """(N,) int64: for each body, in the order of creation, the first body by number that hangs together with it by
        touch and joints; its own number, if none does.
        """
        return island_names(self._state)

    @property
    def may_sleep(self) -> bool:
        """Whether the settings let bodies fall asleep."""
        return self.sleeping and self.solver in SLEEPERS_SOLVERS

    def body_at(self, point: Pair, kind: str = "dynamic") -> Body | None:
        """The body of that kind under a point of the world [m]; of several, the one created last."""
        x, y = validate.vector("point", point)
        kind = validate.choice("kind", kind, BODY_KINDS)
        state = self._state
        rows = rows_at(state, x, y)
        rows = rows[state.bodies.tables["bodies"]["kind"][rows] == BODY_KINDS.index(kind)]
        return self._body_in_row(int(rows[-1])) if len(rows) else None

    def find_body(self, serial: int) -> Body | None:
        """The living body of that serial."""
        row = self._state.bodies.find(serial)
        return None if row < 0 else self._body_in_row(row)

    def diagnostics(self) -> Diagnostics:
        """Energy [J], momentum, deepest overlap [m] and number of contacts."""
        return diagnose(self._state, self._settings.gravity)

    @property
    def colours(self) -> tuple[int, ...]:
        """How many pairs in contact the last step solved side by side in each colour, see engine/colouring.py."""
        return tuple(int(size) for size in self._state.layout.sizes[:-1] if size)

    @property
    def overflow(self) -> int:
        """How many pairs in contact found no colour and were solved one by one."""
        return int(self._state.layout.sizes[-1])

    def _shapes_of(self, row: int) -> list[ShapeHandle]:
        storage = self._state.shapes
        shapes = storage.tables["shapes"]
        own = storage.order[shapes["body"][storage.order] == row]
        firsts = shapes["part_of"][own]
        return [ShapeHandle(self._world, own[firsts == serial], int(serial)) for serial in np.unique(firsts)]

    def _body_in_row(self, row: int) -> Body:
        serial = int(self._state.bodies.tables["bodies"]["serial"][row])
        body = self._handles.get(serial)
        if body is None or body._row != row:  # a restored snapshot of another world may have it in another row
            body = Body(self._world, row, serial)
            self._handles[serial] = body
        return body

    def _joint_record(self, row: int) -> np.void:
        return joint_records(self._state, np.array([row]))[0]

    def _columns(self, table: str, first: str, width: int) -> np.ndarray:
        """(N, width) float64 of neighbouring fields: a read-only view where the rows allow it, else a copy."""
        storage = self._state.bodies
        rows = storage.tables[table]
        fields = rows.dtype.fields
        assert fields is not None
        real, offset = fields[first][:2]
        shape = (len(rows), width)
        columns = np.ndarray(shape, real, rows, offset, (rows.itemsize, real.itemsize))
        columns = columns[: storage.count] if storage.dense else columns[storage.order]
        columns = columns.astype(np.float64, copy=False)
        columns.flags.writeable = False
        return columns
