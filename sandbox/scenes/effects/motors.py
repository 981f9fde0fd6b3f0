"""Motors of revolute joints: they spin up as their torque says, and keep the speed that they are asked for."""

from __future__ import annotations

from engine import Box, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import scene

SPEED = 6.0  # [rad/s]
TORQUES = (1.0, 2.0, 4.0, 8.0)  # [N m]
AFTER = 2.0  # when two of the wheels have their speed [s]


def off_its_speed(world: World) -> float:
    """The farthest that a wheel is from torque t / I, or from the speed asked for once that is less [rad/s]."""
    wheels = [joint.body2 for joint in world.joints]
    return max(
        abs(wheel.angular_velocity - min(SPEED, torque / wheel.inertia * world.time))
        for wheel, torque in zip(wheels, TORQUES, strict=True)
    )


@scene(
    "Effects/Motors",
    shows=Criterion(
        "a wheel's speed is off what its motor's torque makes it by",
        off_its_speed,
        unit="rad/s",
        after=AFTER,
        at_most=1e-3,  # rounding: 480 substeps in single precision
    ),
    view=(0.0, 0.0, 12.0),
)
def motors(world: World) -> None:
    """Four motors spin up wheels alike, each with twice the torque of the one before."""
    stand = world.create_body(kind="static")
    for k, torque in enumerate(TORQUES):
        place = (3.0 * (k - 1.5), 0.0)
        wheel = world.create_body(Box(2.4, 0.3), position=place)
        wheel.add_shape(Box(0.3, 2.4))
        world.create_joint_revolute(stand, wheel, anchor=place, motor_speed=SPEED, max_motor_torque=torque)
