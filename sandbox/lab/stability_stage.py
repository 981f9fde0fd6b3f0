"""Where a case is run: a world of ours, or another engine, seen through a world of ours that is put where it is."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from engine import Shape, World
from engine.diagnostics import Diagnostics
from engine.integrate import place_rows
from engine.stages import STAGES, prepare_step
from sandbox.lab.hard_cases import Case, NotApplicable
from sandbox.lab.peers import CannotMirror, Peer, Pyb2d3, Pymunk
from sandbox.lab.peers.pyb2d3_peer import Pyb2d3World
from sandbox.lab.peers.pymunk_peer import PymunkWorld
from sandbox.lab.stability_ladder import MIRRORED, Variant

PEERS: dict[str, Callable[[int], Peer]] = {"pymunk": Pymunk, "pyb2d3": Pyb2d3}
LOOKING = 3  # stages until contacts are known


class OurStage:
    """A world of ours."""

    def __init__(self, world: World) -> None:
        self.world: World = world
        self.seconds = 0.0  # CPU time of the steps but the first, which loads compiled code
        self.timed = 0.0  # what they simulated [s]

    def step(self, dt: float) -> None:
        first = self.world.step_count == 0
        before = time.process_time()
        self.world.step(dt)
        if not first:
            self.seconds += time.process_time() - before
            self.timed += dt

    def set_gravity(self, gravity: tuple[float, float]) -> None:
        self.world.gravity = gravity

    def destroy(self, index: int) -> None:
        self.world.bodies[index].destroy()

    def create(self, shape: Shape, position: tuple[float, float], **body: Any) -> None:
        self.world.create_body(shape, position=position, **body)

    def close(self) -> None:
        pass


class Shadow(World):
    """A world that is never stepped, but put where another engine's bodies are."""

    def put(self, places: np.ndarray, angles: np.ndarray, velocities: np.ndarray, spins: np.ndarray) -> None:
        """(N, 2) origins [m], (N,) angles [rad], (N, 2) velocities of the centres [m/s], (N,) spins [rad/s]."""
        storage = self._state.bodies
        rows = np.asarray(storage.order)
        bodies, motions = storage.tables["bodies"], storage.tables["motions"]
        bodies["x"][rows], bodies["y"][rows] = places.T
        turned = angles - bodies["angle"][rows]  # another engine's may begin anew at half a turn
        bodies["angle"][rows] += turned - 2.0 * math.pi * np.round(turned / (2.0 * math.pi))
        motions["vx"][rows], motions["vy"][rows] = velocities.T
        motions["w"][rows] = spins
        place_rows(bodies, motions, rows)

    def pass_time(self, dt: float) -> None:
        self._state.time += dt
        self._state.step_count += dt > 0.0

    def diagnostics(self) -> Diagnostics:
        """With contacts as they are where the bodies are now."""
        prepare_step(self._state, self._settings, 1.0 / 60.0)
        for _, stage in STAGES[:LOOKING]:
            stage(self._state, self._settings)
        return super().diagnostics()


class PeerStage:
    """Another engine. Its continuous collision is on, as it is if nobody says otherwise."""

    def __init__(self, peer: Peer, world: Shadow, dt: float) -> None:
        self.world: World = world
        self._shadow = world
        self.seconds = self.timed = 0.0
        try:
            self._copy: Any = peer.mirror(world, dt)
        except CannotMirror as reason:
            raise NotApplicable(str(reason)) from None
        self._space: Any = getattr(self._copy, "space", None)
        if isinstance(self._copy, Pyb2d3World):
            self._copy.world.continuous_enabled = True
            for body, own in zip(self._copy.bodies, world.bodies, strict=True):
                body.bullet = getattr(own, "bullet", False)

    def step(self, dt: float) -> None:
        self._copy.dt = dt
        self.seconds += 1e-3 * float(self._copy.step(1).cpu.sum())
        self.timed += dt
        self._shadow.pass_time(dt)
        self._shadow.put(*self._motion())

    def set_gravity(self, gravity: tuple[float, float]) -> None:
        (self._space or self._copy.world).gravity = gravity

    def destroy(self, index: int) -> None:
        self.world.bodies[index].destroy()
        body = self._copy.bodies.pop(index)
        if isinstance(self._copy, PymunkWorld):
            self._space.remove(body, *body.shapes)
        else:
            body.destroy()
            self._copy.batch = type(self._copy.batch)()
            for left in self._copy.bodies:
                self._copy.batch.append(left)

    def create(self, shape: Shape, position: tuple[float, float], **body: Any) -> None:
        raise NotApplicable("bodies are not added to a copy")

    def close(self) -> None:
        self._copy.close()

    def _motion(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        copy = self._copy
        if isinstance(copy, PymunkWorld):
            bodies = copy.bodies
            velocities = [body.velocity_at_world_point(body.local_to_world(body.center_of_gravity)) for body in bodies]
            spins, angles = [body.angular_velocity for body in bodies], [body.angle for body in bodies]
            return copy.positions(), np.array(angles), np.array(velocities).reshape(-1, 2), np.array(spins)
        turns = np.asarray(copy.batch.get_rotations(), np.float64).reshape(-1, 2)
        return (
            copy.positions(),
            np.arctan2(turns[:, 1], turns[:, 0]),
            np.asarray(copy.batch.get_linear_velocities(), np.float64).reshape(-1, 2),
            np.asarray(copy.batch.get_angular_velocities(), np.float64).ravel(),
        )


def open_stage(case: Case, variant: Variant) -> OurStage | PeerStage:
    """The case at its beginning. NotApplicable where a solver or an engine cannot have it."""
    settings = {"solver": variant.ours, "sleeping": case.sleeping, **case.settings, **dict(variant.settings)}
    if variant.solver not in PEERS:
        try:
            world = case.scene.make(**settings)
        except ValueError as reason:
            raise NotApplicable(str(reason)) from None
        if case.sleeping and not world.may_sleep:
            raise NotApplicable("nothing falls asleep in it")
        return OurStage(world)
    if case.ours_alone:
        raise NotApplicable(case.ours_alone)
    return PeerStage(PEERS[variant.solver](1), shadow_of(case, variant, settings), case.dt / variant.parts)


def shadow_of(case: Case, variant: Variant, settings: dict[str, Any]) -> Shadow:
    """The case's world; of the settings that another engine is given those that the effects of the case allow."""
    shadow = Shadow(**case.scene.defaults().changed({"precision": "double", **settings}).to_dict())
    try:
        case.scene.build(shadow)
    except ValueError:
        if variant.settings or MIRRORED[variant.solver] == "soft_step":
            raise NotApplicable("its settings do not suit this scene") from None
        shadow = Shadow(**case.scene.defaults().changed({"precision": "double", "sleeping": False}).to_dict())
        case.scene.build(shadow)
    return shadow
