"""pyb2d3: Box2D 3.1, in C, behind a Python module."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from engine import Settings, World
from engine.constants import CONTACT_HERTZ
from engine.softness import stiffness
from sandbox.lab.peers.description import BodyDescription, JointDescription, describe_bodies, describe_joints
from sandbox.lab.peers.protocol import PeerError, refuse_effects, refuse_switches
from sandbox.lab.peers.pyb2d3_shapes import ShapeMaker, rotation
from sandbox.lab.timing import Times, time_steps

KNOWN = frozenset(
    {
        "gravity",
        "gravity scale",
        "linear damping",
        "angular damping",
        "friction",
        "restitution",
        "rolling resistance",
        "conveyor",
        "filters",
        "continuous collision",  # goes without
        "revolute joints",
        "joint motors",
        "joined without colliding",
    }
)


class Pyb2d3:
    """The engine; imported here and not before. threads: how many work on one world."""

    name = "pyb2d3"

    def __init__(self, threads: int = 1) -> None:
        try:
            import pyb2d3
        except ImportError:
            raise PeerError("pyb2d3 is not installed: pip install 'tumble[peers]'") from None
        self._pyb2d3 = pyb2d3
        self._threads = threads

    def mirror(self, world: World, dt: float) -> Pyb2d3World:
        return Pyb2d3World(self._pyb2d3, world, dt, self._threads)

    def close(self) -> None:
        pass


class Pyb2d3World:
    """A copy of our world in Box2D, as many substeps, nothing falling asleep, no continuous collision.

    Contacts have the frequency and damping that ours have in steps of dt; joints always twice the frequency, with a
    damping ratio of 2. Its revolute joints are rigid: a soft one of ours becomes one of those.
    """

    def __init__(self, module: Any, world: World, dt: float, threads: int) -> None:
        self.dt = dt
        refuse_effects(world, KNOWN)
        refuse_switches(world)
        settings = world.settings
        if settings.solver != "soft_step":
            settings = settings.changed({"solver": "soft_step"})
        self.substeps = settings.substeps
        self._module = module
        bodies = describe_bodies(world)
        joints = describe_joints(world, bodies)
        self._shapes = ShapeMaker(module, settings, bodies)
        pool = module.ThreadPool(threads) if threads > 1 else None
        self.world = module.World(thread_pool=pool, gravity=tuple(settings.gravity))
        try:
            self._tune(settings, dt)
            self.batch = module.Bodies()
            self.bodies = [self._add_body(body) for body in bodies]
            self._set_velocities(bodies)
            for joint in joints:
                self._add_joint(joint)
        except BaseException:
            self.close()
            raise

    def step(self, count: int) -> Times:
        return time_steps(lambda: self.world.step(self.dt, self.substeps), count)

    def positions(self) -> np.ndarray:
        return self.batch.get_positions().astype(np.float64).reshape(-1, 2)

    def motions(self) -> np.ndarray:
        batch = self.batch  # its get_transforms writes beyond the array that it makes
        turns = batch.get_rotations().astype(np.float64).reshape(-1, 2)  # cosine, sine
        velocities = batch.get_linear_velocities().reshape(-1, 2), batch.get_angular_velocities().reshape(-1)
        return np.column_stack([self.positions(), np.arctan2(turns[:, 1], turns[:, 0]), *velocities])

    def close(self) -> None:
        if self.world.is_valid():
            self.world.destroy()

    def _tune(self, settings: Settings, dt: float) -> None:
        world = self.world
        world.sleeping_enabled = False
        world.continuous_enabled = False
        world.restitution_threshold = settings.restitution_threshold
        hertz = stiffness(settings, dt).contact_hertz if settings.position_correction else 0.0
        damping = settings.contact_damping_ratio
        if settings.stiffness == "follows":  # then ours follows too
            damping *= hertz / CONTACT_HERTZ
        world.set_contact_tuning(hertz, damping, settings.push_out_speed)

    def _add_body(self, body: BodyDescription) -> Any:
        module = self._module
        definition = module.BodyDef()
        definition.type = getattr(module.BodyType, body.kind.upper())
        definition.position = body.position
        definition.rotation = rotation(module, body.angle)
        definition.enable_sleep = False
        definition.linear_damping = body.linear_damping
        definition.angular_damping = body.angular_damping
        definition.gravity_scale = body.gravity_scale
        copy = self.world.create_body_from_def(definition)
        for outline in body.outlines:
            self._shapes.add(copy, outline, body)
        if body.kind == "dynamic":
            data = module.MassData()
            data.mass = _finite(body.mass)
            data.rotational_inertia = _finite(body.inertia)
            data.center = body.center
            copy.mass_data = data  # after the shapes, which bring a mass of their own
        self.batch.append(copy)
        return copy

    def _set_velocities(self, bodies: Sequence[BodyDescription]) -> None:
        """Of the centres of mass: after these are known."""
        if bodies:
            self.batch.set_linear_velocities(np.array([body.velocity for body in bodies], np.float32))
            self.batch.set_angular_velocities(np.array([body.angular_velocity for body in bodies], np.float32))

    def _add_joint(self, joint: JointDescription) -> None:
        definition = self._module.RevoluteJointDef()
        definition.body_a, definition.body_b = self.bodies[joint.body1], self.bodies[joint.body2]
        definition.local_anchor_a, definition.local_anchor_b = joint.anchor1, joint.anchor2
        definition.collide_connected = joint.collide_connected
        if joint.motor_speed is not None:
            definition.enable_motor = True
            definition.motor_speed = joint.motor_speed
            definition.max_motor_torque = joint.max_motor_torque
        self.world.create_revolute_joint(definition)


def _finite(value: float) -> float:
    """Mass or inertia that no impulse overcomes is 0 there: so it is of a body that nothing turns."""
    return value if math.isfinite(value) else 0.0
