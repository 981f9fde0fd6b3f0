"""The mouse in the view: a click drops bodies where there is room, a drag takes hold of a body and pulls it softly.

While a client has the tool for joints, that gets the clicks instead. An invisible plane catches both; it lies exactly
at z = 0, so that what it reports are world coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser

from sandbox.commands import Grab, MoveHand, Release
from sandbox.frame import Frame
from web.hit import body_at, in_body, in_world
from web.overlays.overlay import add_lines, lines
from web.page import Page
from web.panels.desk import Desk
from web.panels.joints import JointsPanel
from web.panels.spawn import SpawnPanel
from web.parts import square_corners
from web.stage import Layer
from web.theme import HAND

PICK_PLANE = "/pick"
PLANE_SIZE = 1e5  # m, half of it

Point = tuple[float, float]


@dataclass
class Hand:
    """What one client holds: the body, the point of it in the body's own frame, and where the hand is now."""

    serial: int
    local: np.ndarray
    target: Point


class Pointer:
    """Turns what the mouse does into commands. The hand of a client is its id, so each pulls its own body."""

    def __init__(self, desk: Desk, page: Page, spawn: SpawnPanel, joints: JointsPanel) -> None:
        self._desk = desk
        self._page = page
        self._spawn = spawn
        self._joints = joints
        self._hands: dict[int, Hand | None] = {}
        self._pulls = add_lines(page.server.scene, "/hands", HAND, thickness=2.5)
        plane = _add_pick_plane(page.server.scene)
        plane.on_click(self._on_click)
        plane.on_drag("left")(self._on_drag)
        page.server.on_client_disconnect(self._on_disconnect)

    async def _on_click(self, event: viser.SceneNodePointerEvent[viser.MeshHandle]) -> None:
        if event.ray_origin is None or event.ray_direction is None or event.ray_direction[2] == 0.0:
            return
        reach = -event.ray_origin[2] / event.ray_direction[2]
        x, y = self._to_world(
            event.ray_origin[0] + reach * event.ray_direction[0], event.ray_origin[1] + reach * event.ray_direction[1]
        )
        if self._joints.clicked(event.client_id, x, y):
            return
        frame = self._page.publisher.frame
        if frame is not None and body_at(frame, x, y) is None:
            self._desk.submit(lambda: self._spawn.command(x, y))

    async def _on_drag(self, event: viser.SceneNodeDragEvent[viser.MeshHandle]) -> None:
        hand, target = event.client_id, self._to_world(*event.end_position[:2])
        if event.phase == "start":
            start = self._to_world(*event.start_position[:2])
            self._hands[hand] = self._taken(*start)
            self._desk.submit(lambda: Grab(hand, *start))
            self._desk.submit(lambda: MoveHand(hand, *target))
        elif hand in self._hands and event.phase == "update":
            self._desk.submit(lambda: MoveHand(hand, *target))
        elif event.phase == "end":
            self._release(hand)
        held = self._hands.get(hand)
        if held is not None:
            held.target = target

    async def _on_disconnect(self, client: viser.ClientHandle) -> None:
        self._release(client.client_id)

    def _release(self, hand: int) -> None:
        if hand in self._hands:
            del self._hands[hand]
            self._desk.submit(lambda: Release(hand))

    def _taken(self, x: float, y: float) -> Hand | None:
        frame = self._page.publisher.frame
        index = None if frame is None else body_at(frame, x, y)
        if frame is None or index is None:
            return None
        return Hand(int(frame.serials[index]), in_body(frame, index, x, y), (x, y))

    def _to_world(self, x: float, y: float) -> Point:
        origin = self._page.stage.origin
        return float(x) + origin[0], float(y) + origin[1]

    def update(self, frame: Frame) -> None:
        """Draw what the hands pull at."""
        held = [hand for hand in list(self._hands.values()) if hand is not None]
        starts, ends = [], []
        for hand in held:
            index = int(np.searchsorted(frame.serials, hand.serial))
            if index < len(frame.serials) and frame.serials[index] == hand.serial:
                starts.append(in_world(frame, index, hand.local))
                ends.append(hand.target)
        origin, shape = self._page.stage.origin, (len(starts), 2)
        z = self._page.stage.z(Layer.HAND)
        self._pulls.points = lines(np.reshape(starts, shape) - origin, np.reshape(ends, shape) - origin, z)


def _add_pick_plane(scene: viser.SceneApi) -> viser.MeshHandle:
    corners, faces = square_corners()
    return scene.add_mesh_simple(
        PICK_PLANE, corners * PLANE_SIZE, faces, opacity=0.0, side="double", cast_shadow=False, receive_shadow=False
    )
