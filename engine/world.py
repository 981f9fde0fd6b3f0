"""The world: bodies, joints and arbiters, and a step in the talk's four stages. The page to read first."""

from __future__ import annotations

import time
import weakref
from dataclasses import replace
from typing import Any

import numpy as np

from engine import validate
from engine.bodies import Body, Pair
from engine.constants import FRICTION
from engine.creation import add_bodies, add_shape, checked_positions, finite_rows
from engine.effects.explosion import explode
from engine.effects.fluid import Fluid, add_fluid
from engine.joints import Joining
from engine.lacking import refuse_lacking
from engine.removal import destroy_body, destroy_shape
from engine.run import NOWHERE, rest_through, run_quietly
from engine.settings import Settings
from engine.shape_handle import ShapeHandle
from engine.shapes import Shape
from engine.sleeping import touch_weights, wake_all
from engine.snapshot import Snapshot, state_hash
from engine.snapshot_check import check_tables
from engine.stages import STAGES, prepare_step
from engine.state import State
from engine.threads import MOST as MOST_THREADS
from engine.watched import Watched

MOST_STEPS = 10**12  # at once


class World(Watched, Joining):
    """Bodies, joints and arbiters in a plane, y up, in SI units.

    Settings by name, such as World(gravity=(0, -10), solver="soft_step", substeps=4, iterations=1,
    precision="single"): engine/settings.py lists all with their defaults. Each is an attribute, too, and all but the
    precision can be changed at any time. Positions are doubles in either precision.

    threads: how many a step may use; it changes how long steps take, and no bit of what they give.
    """

    def __init__(self, *, threads: int = 1, **settings: Any) -> None:
        self._settings = Settings.from_dict(settings)
        self._state = State(self._settings)
        self.threads = threads
        self._handles: weakref.WeakValueDictionary[int, Body] = weakref.WeakValueDictionary()
        self.stage_times = {name: 0.0 for name, _ in STAGES}  # of the last step [s]

    # --- the step -----------------------------------------------------------------------------------------------

    def step(self, dt: float) -> None:
        """Moves the world on by dt [s]: find contacts, apply forces, solve constraints, update positions.

        dt = 0 changes nothing. ValueError if dt is negative or not finite; StepError, naming body and stage, if the
        state stops being finite: the world is then not usable, restore a snapshot. TooLarge, which is a StepError too,
        if the solver cannot take so much: no body has moved.
        """
        dt = self._checked(dt)
        if dt > 0.0:
            self._state.happened.clear()
            prepare_step(self._state, self._settings, dt)
            if self._state.acting is not None and self._state.dormant:
                rest_through(self._state, 1, dt)
            else:
                self._finish_step(dt)

    def run(self, steps: int, dt: float) -> None:
        """As many calls of step(dt), bit for bit, but without a look at Python where nothing calls for it.

        That makes small worlds several times as fast. ValueError and StepError as in `step`, which is told in
        stage_times only if Python took it. Worlds that several threads step, and those with forces of effects, are
        stepped one by one.
        """
        left = validate.whole("steps", steps, 0, MOST_STEPS)
        dt = self._checked(dt)
        if left > 0 and dt > 0.0:
            self._state.happened.clear()
        while left > 0 and dt > 0.0:
            prepare_step(self._state, self._settings, dt)
            done, stage = run_quietly(self._state, self._settings, left, dt)
            left -= done
            if stage != NOWHERE:
                self._finish_step(dt, stage)
                left -= 1

    def _checked(self, dt: float) -> float:
        """dt [s], or ValueError; what the last step had need not be looked at again."""
        state = self._state
        if type(dt) is float and dt == state.prepared_dt and state.prepared_for is self._settings:
            return dt
        return validate.time_step("dt", dt, self.precision, self.substeps)

    def _finish_step(self, dt: float, first: int = 0) -> None:
        """Takes a step that is prepared, from one of its stages on."""
        state, settings = self._state, self._settings
        happened = state.happened
        if happened.on:
            happened.before_step(state)
        before = time.perf_counter()
        for name, stage in STAGES[first:]:
            stage(state, settings)
            now = time.perf_counter()
            self.stage_times[name] = now - before
            before = now
        state.step_count += 1
        state.time += dt
        state.last_dt = dt
        if happened.on:
            happened.after_step(state, settings.hit_speed)

    @property
    def threads(self) -> int:
        """How many threads a step may use, 1 to 64; a world of fewer than 256 bodies is stepped by one."""
        return self._state.threads

    @threads.setter
    def threads(self, value: int) -> None:
        self._state.threads = validate.whole("threads", value, 1, MOST_THREADS)

    # --- create and destroy -------------------------------------------------------------------------------------

    def create_body(
        self,
        shape: Shape | None = None,
        *,
        position: Pair = (0.0, 0.0),
        angle: float = 0.0,
        kind: str = "dynamic",
        mass: float | None = None,
        density: float | None = None,
        friction: float = FRICTION,
        velocity: Pair = (0.0, 0.0),
        angular_velocity: float = 0.0,
        fixed_rotation: bool = False,
        offset: Pair = (0.0, 0.0),
        shape_angle: float = 0.0,
        **properties: Any,
    ) -> Body:
        """A new body, with a first shape unless that is left out: Body.add_shape gives it more.

        position: of its origin [m]; angle [rad]; kind: "dynamic", "kinematic" (moves as it will) or "static"; velocity
        [m/s] of its centre of mass; angular_velocity [rad/s]. Of the shape: mass [kg], or density [kg/m^2], 1 if
        neither is given; friction: coefficient >= 0; offset [m] and shape_angle [rad]: its place in the body's frame.
        properties: what effects bring, of the body (linear_damping, gravity_scale, ...) or of its shape (restitution,
        rolling_resistance, ...): engine/effects lists them.
        """
        x, y = validate.vector("position", position)
        angle = validate.number("angle", angle)
        vx, vy = validate.vector("velocity", velocity)
        w = validate.number("angular_velocity", angular_velocity)
        (body,) = add_bodies(
            self, shape, np.array([(x, y)]), np.array([angle]), kind, mass, density, friction, np.array([(vx, vy)]),
            np.array([w]), fixed_rotation, offset, shape_angle, properties,
        )  # fmt: skip
        self._handles[body.serial] = body
        self._content_changed()
        return body

    def create_bodies(
        self,
        shape: Shape,
        *,
        positions: np.ndarray,
        angles: np.ndarray | float = 0.0,
        kind: str = "dynamic",
        mass: float | None = None,
        density: float | None = None,
        friction: float = FRICTION,
        velocities: np.ndarray | Pair = (0.0, 0.0),
        angular_velocities: np.ndarray | float = 0.0,
        fixed_rotation: bool = False,
        offset: Pair = (0.0, 0.0),
        shape_angle: float = 0.0,
        **properties: Any,
    ) -> list[Body]:
        """Many bodies of one shape at once: positions (N, 2) [m]; angles [rad], velocities [m/s] and angular_velocities
        [rad/s] one for each or one for all. The rest as in create_body.
        """
        places = checked_positions(positions)
        count = len(places)
        if shape is None:
            raise validate.refuse("shape", shape, "a shape")
        bodies = add_bodies(
            self, shape, places, finite_rows("angles", angles, count, 0), kind, mass, density, friction,
            finite_rows("velocities", velocities, count, 2),
            finite_rows("angular_velocities", angular_velocities, count, 0), fixed_rotation, offset, shape_angle,
            properties,
        )  # fmt: skip
        self._handles.update({body.serial: body for body in bodies})
        self._content_changed()
        return bodies

    def create_fluid(
        self, lower: Pair, upper: Pair, *, density: float, linear_drag: float = 0.0, angular_drag: float = 0.0
    ) -> Fluid:
        """A fluid in the rectangle from lower to upper [m], which carries what is in it and holds it back.

        density [kg/m^2], as of shapes; linear_drag, angular_drag: rates at which a body as dense as the fluid, all
        under, loses speed and spin [1/s].
        """
        fluid = add_fluid(self, lower, upper, density, linear_drag, angular_drag)
        self._content_changed()
        return fluid

    def explode(self, position: Pair, *, radius: float, falloff: float = 0.0, impulse: float) -> None:
        """Pushes everything within `radius` [m] away from a point at once, with `impulse` per metre of what faces it
        [N s/m]; beyond, less and less until nothing is left `falloff` [m] further out. Negative: towards the point.
        """
        explode(self, position, radius, falloff, impulse)

    def _add_shape(self, body: Body, *arguments: Any) -> ShapeHandle:
        handle = add_shape(self, body, *arguments)
        self._content_changed()
        return handle

    def _destroy_shape(self, handle: ShapeHandle) -> None:
        destroy_shape(self._state, handle)
        self._content_changed()

    def _destroy_body(self, body: Body) -> None:
        destroy_body(self._state, body)
        self._content_changed()

    def _destroy_joint(self, row: int) -> None:
        self._joined(row)
        self._state.joints.remove(row)

    def _joined(self, row: int) -> None:
        """A joint has come, or goes: its bodies wake."""
        self._joint_changed(row, structure=True)

    def _joint_changed(self, row: int, structure: bool) -> None:
        """A joint's numbers changed, and its bodies wake; structure: so that other rows or tables are called for."""
        joint = self._state.joints.tables["joints"][row]
        touch_weights(self._state, np.array([joint["body1"], joint["body2"]]))
        if structure:
            self._content_changed()

    def _content_changed(self) -> None:
        self._state.stale = True
        self._state.islands.forget(len(self._state.bodies.tables["bodies"]))

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

    def _accept(self, settings: Settings) -> None:
        refuse_lacking(self._state, settings)
        if settings != replace(self._settings, broad_phase=settings.broad_phase):
            wake_all(self._state)
