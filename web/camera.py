"""The camera: straight down on the plane, near enough to parallel projection, and never tilted.

viser has no orthographic camera and no lock: a very narrow field of view from very far away does the one, and putting
a turned camera back does the other. Panning and zooming stay free.
"""

from __future__ import annotations

import math
import time

import numpy as np
import viser

from web.stage import Stage

FIELD_OF_VIEW = 0.1  # rad, vertical
LEAST_ASPECT = 1.5  # a scene's view is as wide as this times its height; narrower windows look from further away
HUD_SHARE = 0.22  # of the picture's height, at the top: the window there lies over sky, and the scene's view below it
TILT = 1e-3  # as a share of the distance: less is rounding
SETTLE_TIME = 1.5  # s in which a client's camera may still report where it was before it was told where to be
NEAREST, FURTHEST = 0.03, 12.0  # how far one may zoom, relative to the scene's own distance


class Camera:
    """Points the camera of every client; each client may then look elsewhere on its own."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._stage = Stage(0.0, 0.0, 20.0)
        self._aimed: dict[int, tuple[float, float, float]] = {}  # client -> where we put its camera
        self._told: dict[int, float] = {}  # client -> when
        server.initial_camera.fov = FIELD_OF_VIEW
        server.initial_camera.up = (0.0, 1.0, 0.0)
        server.on_client_connect(self._on_connect)
        server.on_client_disconnect(self._on_disconnect)

    def show(self, stage: Stage) -> None:
        """Make every client see this stage, also those who come later."""
        self._stage = stage
        x, y, distance = _place(stage, LEAST_ASPECT)
        initial = self._server.initial_camera
        initial.near, initial.far = distance * NEAREST / 2, distance * FURTHEST * 2
        initial.position, initial.look_at = (x, y, distance), (x, y, 0.0)
        for client in self._server.get_clients().values():
            self.aim(client)

    def aim(self, client: viser.ClientHandle) -> None:
        """Back to the scene's own view, for one client."""
        stage, camera = self._stage, client.camera
        if camera.image_height == 0:
            return
        x, y, distance = _place(stage, camera.aspect)
        self._aimed[client.client_id] = (x, y, distance)
        self._told[client.client_id] = time.monotonic()
        with client.atomic():
            camera.near, camera.far = distance * NEAREST / 2, distance * FURTHEST * 2
            camera.min_orbit_distance, camera.max_orbit_distance = distance * NEAREST, distance * FURTHEST
            _look_down(camera, x, y, distance)
        client.flush()

    async def _on_connect(self, client: viser.ClientHandle) -> None:
        self.aim(client)
        client.camera.on_update(self._on_move)

    async def _on_disconnect(self, client: viser.ClientHandle) -> None:
        self._aimed.pop(client.client_id, None)
        self._told.pop(client.client_id, None)

    async def _on_move(self, camera: viser.CameraHandle) -> None:
        number = camera.client.client_id
        aimed = self._aimed.get(number)
        if not _is_upright(camera):
            if time.monotonic() - self._told.get(number, 0.0) < SETTLE_TIME:
                self.aim(camera.client)  # it reports from before it was told: where it was must not count
            else:
                _put_upright(camera)
        elif aimed is not None and np.allclose(camera.position, aimed, rtol=1e-4):
            # Nobody moved it: then it was the window that changed its shape, or the panel that took a part of it.
            if not math.isclose(aimed[2], _place(self._stage, camera.aspect)[2], rel_tol=1e-4):
                self.aim(camera.client)


def _is_upright(camera: viser.CameraHandle) -> bool:
    away = np.abs(camera.position - camera.look_at)[:2].max() + abs(camera.look_at[2])
    return bool(away < TILT * abs(camera.position[2]) and camera.up_direction[1] > 1.0 - TILT)


def _put_upright(camera: viser.CameraHandle) -> None:
    """Where it looked stays in the middle, as far away as it was; to fly down is to zoom in."""
    x, y, z = (float(value) for value in camera.look_at)
    distance = max(math.dist(camera.position, camera.look_at) + z, 1e-3)
    with camera.client.atomic():
        _look_down(camera, x, y, distance)
    camera.client.flush()


def _look_down(camera: viser.CameraHandle, x: float, y: float, distance: float) -> None:
    camera.up_direction = (0.0, 1.0, 0.0)
    camera.position = (x, y, distance)
    camera.look_at = (x, y, 0.0)


def shown_height(height: float, aspect: float) -> float:
    """How many metres the whole picture is high, so that a view of `height` fits under the window."""
    return max(height / (1.0 - HUD_SHARE), height * LEAST_ASPECT / max(aspect, 0.1))


def _place(stage: Stage, aspect: float) -> tuple[float, float, float]:
    """Where the camera goes: the scene's view is in the middle of what the window leaves free."""
    shown = shown_height(stage.height, aspect)
    x, y = stage.center_x - stage.origin[0], stage.center_y - stage.origin[1]
    return x, y + HUD_SHARE / 2.0 * shown, shown / 2.0 / math.tan(FIELD_OF_VIEW / 2.0)
