"""pymunk: the Chipmunk engine, in C, behind a Python module."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from engine import Body, Box, Circle, RevoluteJoint, World
from engine.constants import BIAS_FACTOR, SLOP
from sandbox.lab.peers.protocol import CannotMirror, PeerError, bias_factor, passes
from sandbox.lab.timing import Times, time_steps


class Pymunk:
    """The engine; imported here and not before."""

    name = "pymunk"

    def __init__(self) -> None:
        try:
            import pymunk
        except ImportError:
            raise PeerError("pymunk is not installed: pip install 'tumble[peers]'") from None
        self._pymunk = pymunk

    def mirror(self, world: World, dt: float) -> PymunkWorld:
        return PymunkWorld(self._pymunk, world, dt)

    def close(self) -> None:
        pass


class PymunkWorld:
    """A copy of our world as a pymunk space, as many iterations, nothing falling asleep.

    pymunk has rigid pivots only: a soft joint becomes one that closes as fast.
    """

    def __init__(self, pymunk: Any, world: World, dt: float) -> None:
        self.dt = dt
        self.space = pymunk.Space()
        self.space.gravity = tuple(world.gravity)
        self.space.iterations = passes(world)
        self.space.sleep_time_threshold = math.inf
        self.space.collision_slop = SLOP
        self.space.collision_bias = _left_after_a_second(BIAS_FACTOR if world.position_correction else 0.0, dt)
        self.bodies: list[Any] = [self._add_body(pymunk, body) for body in world.bodies]
        by_serial = {body.serial: copy for body, copy in zip(world.bodies, self.bodies, strict=True)}
        for joint in world.joints:
            self._add_joint(pymunk, joint, by_serial)

    def step(self, count: int) -> Times:
        return time_steps(lambda: self.space.step(self.dt), count)

    def positions(self) -> np.ndarray:
        return np.array([tuple(body.position) for body in self.bodies]).reshape(-1, 2)

    def close(self) -> None:
        pass

    def _add_body(self, pymunk: Any, body: Body) -> Any:
        static = body.kind == "static"
        copy = pymunk.Body(body_type=pymunk.Body.STATIC) if static else pymunk.Body(body.mass, body.inertia)
        copy.position = tuple(body.position)
        copy.angle = body.angle
        if not static:
            copy.velocity = tuple(body.velocity)
            copy.angular_velocity = body.angular_velocity
        ours = body.shape if len(body.shapes) == 1 and body.center == body.position else None
        shape: Any
        if isinstance(ours, Box):
            shape = pymunk.Poly.create_box(copy, (ours.width, ours.height))
        elif isinstance(ours, Circle):
            shape = pymunk.Circle(copy, ours.radius)
        else:
            raise CannotMirror(f"only bodies of one box or one circle are copied, body {body.serial} is none")
        shape.friction = math.sqrt(body.friction)  # a pair rubs with the product there, with its square root here
        self.space.add(copy, shape)
        return copy

    def _add_joint(self, pymunk: Any, joint: RevoluteJoint, by_serial: dict[int, Any]) -> None:
        body1, body2 = by_serial[joint.body1.serial], by_serial[joint.body2.serial]
        anchor1, anchor2 = joint.anchors
        copy = pymunk.PivotJoint(
            body1, body2, body1.world_to_local(tuple(anchor1)), body2.world_to_local(tuple(anchor2))
        )
        copy.error_bias = _left_after_a_second(bias_factor(joint), dt=self.dt)
        copy.collide_bodies = joint.collide_connected
        self.space.add(copy)


def _left_after_a_second(bias_factor: float, dt: float) -> float:
    """Our part of an error removed in each step of dt [s], as pymunk has it: the part that is left after 1 s."""
    return (1.0 - bias_factor) ** (1.0 / dt)
