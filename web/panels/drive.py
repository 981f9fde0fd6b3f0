"""Driving: sliders, buttons and keys for the motors that a scene hands over. Without any there is no such folder."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from functools import partial
from typing import Any

from sandbox.commands import DriveMotor
from sandbox.frame import Frame
from sandbox.scenes import SCENES
from sandbox.scenes.registry import Drive
from web.panels.desk import Desk, Event, Follower

MOMENT = 0.15  # s after which a drive that does not stay is let go


class DrivePanel:
    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._scene = ""
        self._follower = Follower()
        self._handles: list[Any] = []  # of the scene's own controls and keys
        self._folder = desk.gui.add_folder("Drive", visible=False)
        self._show(desk.session.frame.scene)

    def update(self, frame: Frame) -> None:
        if frame.scene != self._scene:
            self._show(frame.scene)
        elif frame.drives:  # none in a frame that no simulation made
            self._follower.update(frame)

    def _show(self, name: str) -> None:
        """The controls of this scene instead of those of the one before."""
        self._scene = name
        for handle in self._handles:
            handle.remove()
        self._handles.clear()
        self._follower = Follower()
        drives = SCENES[name].drives if name in SCENES else ()
        self._folder.visible = bool(drives)
        with self._folder:
            for place, drive in enumerate(drives):
                self._add(place, drive)

    def _add(self, place: int, drive: Drive) -> None:
        gui = self._desk.gui
        if drive.released is None:
            slider = gui.add_slider(drive.name, -1.0, 1.0, 0.05, 0.0)
            self._handles.append(slider)
            self._follower.add(slider, lambda frame: frame.drives[place])

            @slider.on_update
            async def moved(event: Event) -> None:
                if event.client is not None:
                    self._set(drive, slider.value)

        keys = ", ".join(f"{key.removeprefix('arrow')} ({label})" for label, key in drive.keys.items())
        buttons = gui.add_button_group("", tuple(drive.buttons), hint=f"keys: {keys}" if keys else None)
        self._handles.append(buttons)
        press = {label: self._presser(drive, value) for label, value in drive.buttons.items()}

        @buttons.on_click
        async def pressed(event: Event) -> None:
            if event.client is not None and event.target.value in press:
                await press[event.target.value]()

        for label, key in drive.keys.items():
            self._add_key(f"{drive.name}: {label}", key, press[label])

    def _add_key(self, label: str, key: Any, press: Callable[[], Coroutine[Any, Any, None]]) -> None:
        command = self._desk.gui.add_command(label, hotkey=key)
        self._handles.append(command)

        @command.on_trigger
        async def triggered(_: object) -> None:
            await press()

    def _presser(self, drive: Drive, value: float) -> Callable[[], Coroutine[Any, Any, None]]:
        async def press() -> None:
            self._set(drive, value)
            if drive.released is not None:
                await asyncio.sleep(MOMENT)
                self._set(drive, drive.released)

        return press

    def _set(self, drive: Drive, value: float) -> None:
        for joint in drive.joints:
            self._desk.submit(partial(DriveMotor, joint, drive.gain * value))
