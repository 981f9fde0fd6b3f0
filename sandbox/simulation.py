"""A world with a scene in it, the hands that pull at its bodies, and the commands applied: all that must repeat.

Headless and without a clock: the same start and the same commands at the same steps give the same bits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from engine import Body, Box, Snapshot, validate
from engine.constants import float32_value
from sandbox.commands import PhysicsCommand
from sandbox.content import ContentKeeper
from sandbox.frame import Frame, Status
from sandbox.gathering import Gathering
from sandbox.hands import Hand, pull
from sandbox.scenes import Scene, find_scene

TIME_STEP = 1.0 / 60.0  # [s]
MOST_BODIES = 25_000  # that commands may fill a world with
MOST_JOINTS = 25_000


class Simulation:
    """One scene's run. `world` may be read; change it through commands, or the run cannot be repeated."""

    def __init__(self, scene: str | Scene, dt: float = TIME_STEP, *, threads: int = 1, **settings: Any) -> None:
        self.scene = find_scene(scene) if isinstance(scene, str) else scene
        self.world = self.scene.make(threads=threads, **settings)
        self.dt = dt
        self.hands: dict[int, Hand] = {}
        self.bomb_serial = -1
        self.content = 0  # changes whenever bodies came or went
        self._keeper = ContentKeeper()
        self._events = Gathering()  # since the last frame

    def apply(self, command: PhysicsCommand) -> None:
        """Applies a command before the next step. ValueError if it cannot be done now; then nothing changes."""
        bodies = self.world.body_count
        command.apply(self)
        self.content += bodies != self.world.body_count

    def step(self) -> None:
        """One time step. StepError if the state stops being finite."""
        for hand_id in sorted(self.hands):
            body = self.body_of(self.hands[hand_id])
            if body is None:
                del self.hands[hand_id]
            else:
                pull(self.hands[hand_id], body, self.dt)
        self.world.step(self.dt)
        if self.world.tell_events:
            self._events.add(self.world.events)

    # --- what commands ask for ----------------------------------------------------------------------------------

    def make_room(self, count: int) -> None:
        """Refuses more bodies than the sandbox is made for."""
        room = MOST_BODIES - self.world.body_count
        if count > room:
            raise ValueError(f"count = {count}: must be at most {max(room, 0)}, a scene holds {MOST_BODIES} bodies")

    def bomb(self) -> Body:
        """The bomb, made on its first throw."""
        bomb = self.world.find_body(self.bomb_serial)
        if bomb is None:
            self.make_room(1)
            bomb = self.world.create_body(Box(1, 1), mass=50.0, friction=float32_value(0.2))
            self.bomb_serial = bomb.serial
        return bomb

    def grab(self, hand_id: int, point: tuple[float, float]) -> None:
        """A hand takes hold of the dynamic body under the point; of nothing if there is none."""
        self.hands.pop(hand_id, None)
        body = self.world.body_at(point)
        if body is not None:
            self.hands[hand_id] = Hand.on(body, point)

    def move_hand(self, hand_id: int, point: tuple[float, float]) -> None:
        if hand_id in self.hands:
            self.hands[hand_id].x, self.hands[hand_id].y = point

    def release(self, hand_id: int) -> None:
        self.hands.pop(hand_id, None)

    def drive(self, serial: int, speed: float) -> None:
        """Asks the motor of a joint for a speed; nothing if there is none."""
        joint = self._motor(serial)
        if joint is not None:
            joint.motor_speed = speed

    def _motor(self, serial: int) -> Any:
        """The joint of that number, None unless it has a motor."""
        joint = next((joint for joint in self.world.joints if joint.serial == serial), None)
        return joint if getattr(joint, "motor_speed", None) is not None else None

    def _driven(self) -> tuple[float, ...]:
        """How far each of the scene's drives is on, by its first motor."""
        motors = ((drive.gain, self._motor(drive.joints[0])) for drive in self.scene.drives)
        return tuple(motor.motor_speed / gain if motor is not None else 0.0 for gain, motor in motors)

    def room_for_joint(self) -> None:
        """Refuses more joints than the sandbox is made for."""
        if self.world.joint_count >= MOST_JOINTS:
            raise ValueError(f"joints = {self.world.joint_count + 1}: must be at most {MOST_JOINTS} in a scene")

    def anchor_body(self) -> Body:
        """What holds the points to which bodies are joined: the first static body, one without a shape if none."""
        anchor = next((body for body in self.world.bodies if body.kind == "static"), None)
        if anchor is None:
            self.make_room(1)
            anchor = self.world.create_body(kind="static")
        return anchor

    def body_of(self, hand: Hand) -> Body | None:
        """What a hand holds, None if that was destroyed or cannot be moved."""
        body = self.world.find_body(hand.serial)
        return body if body is not None and body.kind == "dynamic" else None

    # --- to keep and take back ----------------------------------------------------------------------------------

    def extras(self) -> dict[str, Any]:
        """What a repeat needs beyond the world's snapshot, as JSON takes it."""
        return {"bomb": self.bomb_serial, "hands": {str(key): hand.to_dict() for key, hand in self.hands.items()}}

    def restore(self, snapshot: Snapshot, extras: Mapping[str, Any]) -> None:
        """Goes back to a snapshot and the extras of the same moment. ValueError if a hand's numbers are not finite."""
        bomb_serial = validate.whole("bomb", extras["bomb"], -1, 2**62)
        hands = {int(key): Hand.from_dict(hand) for key, hand in extras["hands"].items()}
        self.world.restore(snapshot)
        self.bomb_serial, self.hands = bomb_serial, hands
        self._events.clear()
        self.content += 1

    def frame(self, commands: tuple[dict, ...] = (), status: Status | None = None) -> Frame:
        """What there is to see now, and what happened since the last call."""
        world = self.world
        events, events_lost = self._events.take()
        frame = Frame(
            scene=self.scene.name,
            step=world.step_count,
            time=world.time,
            dt=self.dt,
            positions=np.array(world.positions),
            angles=np.array(world.angles),
            velocities=np.array(world.velocities),
            angular_velocities=np.array(world.angular_velocities),
            asleep=world.asleep,
            **self._keeper.content(world, self.content)._asdict(),
            bounds=np.array(world.bounds),
            contacts=world.contact_records(),
            joints=world.joint_records(),
            diagnostics=world.diagnostics(),
            settings=world.settings,
            events=events,
            events_lost=events_lost,
            effects=world.effects,
            stage_ms={name: 1e3 * seconds for name, seconds in world.stage_times.items()},
            commands=commands,
            drives=self._driven(),
            content=self.content,
            status=status or Status(),
        )
        for value in vars(frame).values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        return frame
