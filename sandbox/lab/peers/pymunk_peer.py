"""pymunk: the Chipmunk engine, in C, behind a Python module."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from engine import World
from engine.constants import BIAS_FACTOR, JOINT_BIAS_FACTOR, SLOP
from sandbox.lab.peers.description import (
    LINES,
    BodyDescription,
    JointDescription,
    Outline,
    describe_bodies,
    describe_joints,
)
from sandbox.lab.peers.protocol import CannotMirror, PeerError, passes, refuse_effects, refuse_switches
from sandbox.lab.peers.surfaces import Coefficient, Values, for_product
from sandbox.lab.timing import Times, time_steps

KNOWN = frozenset(
    {
        "gravity",
        "friction",
        "restitution",
        "filters",
        "continuous collision",  # goes without
        "revolute joints",
        "joint motors",
        "joined without colliding",
    }
)
CATEGORIES = 2**32  # as many bits


class Pymunk:
    """The engine; imported here and not before. threads: how many work on one world."""

    name = "pymunk"

    def __init__(self, threads: int = 1) -> None:
        try:
            import pymunk
        except ImportError:
            raise PeerError("pymunk is not installed: pip install 'tumble[peers]'") from None
        self._pymunk = pymunk
        self._threads = threads

    def mirror(self, world: World, dt: float) -> PymunkWorld:
        return PymunkWorld(self._pymunk, world, dt, self._threads)

    def close(self) -> None:
        pass


class PymunkWorld:
    """A copy of our world as a pymunk space, as many iterations, nothing falling asleep.

    Three things differ. It has rigid pivots only: a soft joint becomes one that closes as fast. A chain becomes
    segments, which are solid from both sides. Things bounce however slowly they meet.
    """

    def __init__(self, pymunk: Any, world: World, dt: float, threads: int = 1) -> None:
        refuse_effects(world, KNOWN)
        refuse_switches(world)
        self.dt = dt
        self._pymunk = pymunk
        settings = world.settings
        bodies = describe_bodies(world)
        _refuse_moving_lines(bodies)
        self._friction = _rule("friction", settings.friction_mixing, bodies)
        self._restitution = _rule("restitution", settings.restitution_mixing, bodies)
        self.space = pymunk.Space(threaded=threads > 1)
        self.space.threads = threads
        self.space.gravity = tuple(settings.gravity)
        self.space.iterations = passes(world)
        self.space.sleep_time_threshold = math.inf
        self.space.collision_slop = SLOP
        self.space.collision_bias = _left_after_a_second(BIAS_FACTOR if settings.position_correction else 0.0, dt)
        self._filters: dict[tuple[int, int, int], Any] = {}
        self.bodies: list[Any] = [self._add_body(body) for body in bodies]
        for joint in describe_joints(world, bodies):
            self._add_joint(joint)

    def step(self, count: int) -> Times:
        return time_steps(lambda: self.space.step(self.dt), count)

    def positions(self) -> np.ndarray:
        return np.array([tuple(body.position) for body in self.bodies]).reshape(-1, 2)

    def motions(self) -> np.ndarray:
        rows = [(*b.position, b.angle, *b.velocity, b.angular_velocity) for b in self.bodies]
        return np.array(rows, np.float64).reshape(-1, 6)

    def close(self) -> None:
        pass

    def _add_body(self, body: BodyDescription) -> Any:
        pymunk = self._pymunk
        dynamic = body.kind == "dynamic" and math.isfinite(body.mass)
        if dynamic:
            copy = pymunk.Body(body.mass, body.inertia)
            copy.center_of_gravity = body.center
        else:  # gravity would pull what has infinite mass; nothing does here
            kind = pymunk.Body.STATIC if body.kind == "static" else pymunk.Body.KINEMATIC
            copy = pymunk.Body(body_type=kind)
        copy.angle = body.angle
        copy.position = body.position  # after the angle, which turns about the centre
        if body.kind != "static":
            copy.velocity = body.velocity
            copy.angular_velocity = body.angular_velocity
        shapes = [shape for outline in body.outlines for shape in self._shapes(copy, outline, body)]
        self.space.add(copy, *shapes)
        return copy

    def _shapes(self, copy: Any, outline: Outline, body: BodyDescription) -> list[Any]:
        """What an outline is made of there: one shape, but for a chain."""
        shapes = self._forms(copy, outline)
        moving = body.kind == "dynamic"
        for shape in shapes:
            shape.friction = self._friction(outline.friction, moving)
            shape.elasticity = self._restitution(outline.restitution, moving)
            shape.filter = self._filter(outline, body)
        return shapes

    def _forms(self, copy: Any, outline: Outline) -> list[Any]:
        pymunk = self._pymunk
        points = outline.points
        if outline.kind == "circle":
            return [pymunk.Circle(copy, outline.radius, points[0])]
        if outline.kind in ("box", "polygon"):
            return [pymunk.Poly(copy, points, radius=outline.radius)]
        if outline.kind != "chain":
            return [pymunk.Segment(copy, *points, outline.radius)]
        ends = (points[-1], points[:2]) if outline.closed else (points[0], points[-1:])
        around = [ends[0], *points, *ends[1]]
        pieces = []
        for before, start, end, after in zip(around, around[1:], around[2:], around[3:], strict=False):
            pieces.append(pymunk.Segment(copy, start, end, outline.radius))
            pieces[-1].set_neighbors(before, after)  # what touches at a joint is pushed as by one line
        return pieces

    def _filter(self, outline: Outline, body: BodyDescription) -> Any:
        key = (outline.category, outline.mask, outline.group)
        if key not in self._filters:
            category, mask, group = key
            if group > 0:
                raise CannotMirror(f"it has no group whose members always meet, as body {body.serial} has")
            if category >= CATEGORIES:
                raise CannotMirror(f"it has 32 categories, body {body.serial} is of a higher one")
            mask &= CATEGORIES - 1  # nobody is of the others
            self._filters[key] = self._pymunk.ShapeFilter(group=-group, categories=category, mask=mask)
        return self._filters[key]

    def _add_joint(self, joint: JointDescription) -> None:
        body1, body2 = self.bodies[joint.body1], self.bodies[joint.body2]
        pivot = self._pymunk.PivotJoint(body1, body2, joint.anchor1, joint.anchor2)
        factor = JOINT_BIAS_FACTOR if joint.bias_factor is None else joint.bias_factor
        pivot.error_bias = _left_after_a_second(factor, dt=self.dt)
        pivot.collide_bodies = joint.collide_connected
        self.space.add(pivot)
        if joint.motor_speed is not None:
            motor = self._pymunk.SimpleMotor(body1, body2, -joint.motor_speed)  # its rate is of body1 against body2
            motor.max_force = joint.max_motor_torque
            self.space.add(motor)


def _rule(name: str, rule: str, bodies: Sequence[BodyDescription]) -> Coefficient:
    found = for_product(rule, Values.of(name, bodies))
    if found is None:
        raise CannotMirror(f"a pair has the product of its {name}s there, which fits the rule {rule!r} in no way here")
    return found


def _refuse_moving_lines(bodies: Sequence[BodyDescription]) -> None:
    """Segments of two bodies collide there, ours never: that matters only if one of the bodies is moved."""
    bearers = [body for body in bodies if any(outline.kind in LINES for outline in body.outlines)]
    moved = [body for body in bearers if body.kind == "dynamic"]
    if moved and len(bearers) > 1:
        raise CannotMirror(f"segments of different bodies collide there, and body {moved[0].serial} moves one")


def _left_after_a_second(bias_factor: float, dt: float) -> float:
    """Our part of an error removed in each step of dt [s], as pymunk has it: the part that is left after 1 s."""
    return (1.0 - bias_factor) ** (1.0 / dt)
