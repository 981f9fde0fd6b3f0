"""The world: bodies, joints and arbiters, and a step in the talk's four stages. The page to read first."""

from __future__ import annotations

import time
import weakref

import numpy as np

from engine import validate
from engine.bodies import Body, Pair
from engine.configured import Configured
from engine.constants import FRICTION, ITERATIONS
from engine.creation import add_body, add_revolute
from engine.diagnostics import Diagnostics, diagnose
from engine.joints.handle import RevoluteJoint
from engine.queries import rows_at
from engine.records import Arbiter, arbiter_list, contact_records, joint_records
from engine.settings import Settings
from engine.shapes import Shape
from engine.snapshot import Snapshot, state_hash
from engine.snapshot_check import check_tables
from engine.stages import STAGES, prepare_step
from engine.state import State
from engine.tables import BODY_KINDS


class World(Configured):
    """Bodies, joints and arbiters in a plane, y up, in SI units.

    gravity: [m/s^2]. solver: a name from engine.SOLVERS. iterations: passes over all constraints in a step.
    precision: "single" or "double", of the solver's own numbers; positions are doubles in either. broad_phase: a name
    from engine.BROAD_PHASES. The three switches are the talk's. All but the precision can be changed at any time.
    """

    def __init__(
        self,
        gravity: Pair = (0.0, -10.0),
        solver: str = "sequential_impulses",
        iterations: int = ITERATIONS,
        precision: str = "single",
        broad_phase: str = "all_pairs",
        accumulate_impulses: bool = True,
        warm_starting: bool = True,
        position_correction: bool = True,
    ) -> None:
        self._settings = Settings(
            gravity=validate.vector("gravity", gravity),
            solver=solver,
            iterations=iterations,
            precision=precision,
            broad_phase=broad_phase,
            accumulate_impulses=accumulate_impulses,
            warm_starting=warm_starting,
            position_correction=position_correction,
        )
        self._state = State(self._settings)
        self._handles: weakref.WeakValueDictionary[int, Body] = weakref.WeakValueDictionary()
        self.stage_times = {name: 0.0 for name, _ in STAGES}  # of the last step [s]

    # --- the step -----------------------------------------------------------------------------------------------

    def step(self, dt: float) -> None:
        """Moves the world on by dt [s]: find contacts, apply forces, solve constraints, update positions.

        dt = 0 changes nothing. ValueError if dt is negative or not finite; StepError, naming body and stage, if the
        state stops being finite: the world is then not usable, restore a snapshot.
        """
        dt = validate.time_step("dt", dt, self.precision)
        if dt == 0.0:
            return
        state, settings = self._state, self._settings
        if state.stale:
            state.refresh()
        prepare_step(state, settings, dt)
        before = time.perf_counter()
        for name, stage in STAGES:
            stage(state, settings)
            now = time.perf_counter()
            self.stage_times[name] = now - before
            before = now
        state.step_count += 1
        state.time += dt

    @property
    def step_count(self) -> int:
        """Steps since the world was made."""
        return self._state.step_count

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._state.time

    # --- create and destroy -------------------------------------------------------------------------------------

    def create_body(
        self,
        shape: Shape,
        *,
        position: Pair = (0.0, 0.0),
        angle: float = 0.0,
        kind: str = "dynamic",
        mass: float | None = None,
        density: float | None = None,
        friction: float = FRICTION,
        velocity: Pair = (0.0, 0.0),
        angular_velocity: float = 0.0,
    ) -> Body:
        """A new body of a Box or a Circle.

        position: of its centre [m]; angle [rad]; kind: "dynamic" or "static"; mass [kg], or density [kg/m^2], 1 if
        neither is given; friction: coefficient >= 0; velocity [m/s]; angular_velocity [rad/s].
        """
        body = add_body(
            self, shape, position, angle, kind, mass, density, friction, velocity, angular_velocity
        )  # fmt: skip
        self._handles[body.serial] = body
        self._state.stale = True
        return body

    def create_joint_revolute(
        self,
        body1: Body,
        body2: Body,
        *,
        anchor: Pair,
        softness: float = 0.0,
        bias_factor: float | None = None,
        collide_connected: bool = True,
    ) -> RevoluteJoint:
        """Pins two bodies together at a point of the world.

        anchor [m]; softness [1/kg]: 0 is rigid, 1/(dt (d + dt k)) a spring k [N/m] with damper d [N s/m]; bias_factor:
        part of the separation that a step removes, Box2D Lite's 0.2 if left out, dt k/(d + dt k) for that spring.
        collide_connected: whether the two collide with each other.
        """
        joint = add_revolute(self, body1, body2, anchor, softness, bias_factor, collide_connected)
        self._state.stale = True
        return joint

    def _destroy_body(self, body: Body) -> None:
        state = self._state
        joints = state.joints.tables["joints"]
        for row in state.joints.order:
            if body._row in (joints["body1"][row], joints["body2"][row]):
                state.joints.remove(int(row))
        state.drop_arbiters_of(body.serial)
        state.bodies.remove(body._row)
        state.stale = True

    def _destroy_joint(self, row: int) -> None:
        self._state.joints.remove(row)
        self._state.stale = True

    # --- what is there ------------------------------------------------------------------------------------------

    @property
    def bodies(self) -> list[Body]:
        """Living bodies in the order of creation."""
        return [self._body_in_row(int(row)) for row in self._state.bodies.order]

    @property
    def joints(self) -> list[RevoluteJoint]:
        """Living joints in the order of creation."""
        storage = self._state.joints
        serials = storage.tables["joints"]["serial"]
        return [RevoluteJoint(self, int(row), int(serials[row])) for row in storage.order]

    @property
    def body_count(self) -> int:
        return self._state.bodies.count

    @property
    def joint_count(self) -> int:
        return self._state.joints.count

    @property
    def arbiters(self) -> list[Arbiter]:
        """Who touches whom, as the last step found it; the impulses are those it ended with."""
        return arbiter_list(self)

    def contact_records(self) -> np.ndarray:
        """(C,) CONTACT_RECORD: all contacts of the last step as one table, in the solver's order."""
        return contact_records(self._state)

    def joint_records(self) -> np.ndarray:
        """(J,) JOINT_RECORD: all joints as one table, in the order of creation."""
        return joint_records(self._state)

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

    # --- snapshots ----------------------------------------------------------------------------------------------

    def snapshot(self) -> Snapshot:
        """A copy of everything that a later step depends on, settings included."""
        return Snapshot(self._settings, self._state.save())

    def restore(self, snapshot: Snapshot) -> None:
        """Goes back to a snapshot, bit for bit; handles of bodies that lived then are valid again.

        It may come from another world or process, but its precision must be this world's. ValueError, and nothing
        changed, if it is not what a world can be.
        """
        if not isinstance(snapshot, Snapshot):
            raise validate.refuse("snapshot", snapshot, "what World.snapshot() gave")
        if snapshot.settings.precision != self.precision:
            raise validate.refuse("snapshot.precision", snapshot.settings.precision, f"this world's {self.precision!r}")
        check_tables(snapshot.settings, snapshot.tables)
        self._settings = snapshot.settings
        self._state.load(snapshot.tables)

    def state_hash(self) -> str:
        """64 hex digits over positions, velocities and impulses: equal for equal states, see engine/snapshot.py."""
        return state_hash(self._state)

    # --- inside -------------------------------------------------------------------------------------------------

    def _body_in_row(self, row: int) -> Body:
        serial = int(self._state.bodies.tables["bodies"]["serial"][row])
        body = self._handles.get(serial)
        if body is None or body._row != row:  # a restored snapshot of another world may have it in another row
            body = Body(self, row, serial)
            self._handles[serial] = body
        return body

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
