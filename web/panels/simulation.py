"""Which scene, and how its time passes."""

from __future__ import annotations

import random

import viser

from sandbox.commands import Bomb, LoadScene, Pause, Play, Reset, SetSpeed, StepOnce
from sandbox.frame import Frame
from sandbox.scenes import SCENES
from web.panels.desk import Desk, Event, Follower


class SimulationPanel:
    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._paused = False
        self._random = random.Random()
        self._follower = Follower()
        with desk.gui.add_folder("Simulation"):
            self._add_controls(desk)
        self._add_keys(desk)

    def _add_controls(self, desk: Desk) -> None:
        gui = desk.gui
        scene = gui.add_dropdown("scene", tuple(SCENES), initial_value=desk.session.frame.scene)
        desk.on_change(scene, lambda: LoadScene(scene.value))
        self._follower.add(scene, lambda frame: frame.scene)
        self._play = gui.add_button("Pause", icon=viser.Icon.PLAYER_PAUSE, hint="space")
        desk.on_press(self._play, self._toggle)
        actions = gui.add_button_group("", ("Step", "Reset", "Bomb"), hint="keys: S or . (step), R (reset), B (bomb)")

        @actions.on_click
        async def acted(event: Event) -> None:
            make = {"Step": StepOnce, "Reset": Reset, "Bomb": self._bomb}.get(event.target.value)
            if event.client is not None and make is not None:
                desk.submit(make)

        speed = gui.add_slider("speed", 0.1, 4.0, 0.1, 1.0, hint="simulated seconds per second")
        desk.on_change(speed, lambda: SetSpeed(speed.value))
        self._follower.add(speed, lambda frame: frame.status.speed)

    def _add_keys(self, desk: Desk) -> None:
        desk.on_key("Pause or play", "space", self._toggle)
        desk.on_key("Single step", "S", StepOnce)
        desk.on_key("Single step (.)", ".", StepOnce)
        desk.on_key("Reset the scene", "R", Reset)
        desk.on_key("Launch a bomb", "B", self._bomb)

    def _toggle(self) -> Pause | Play:
        return Play() if self._paused else Pause()

    def _bomb(self) -> Bomb:
        return Bomb.random(self._random)

    def update(self, frame: Frame) -> None:
        self._follower.update(frame)
        if frame.status.paused != self._paused:
            self._paused = frame.status.paused
            self._play.label = "Play" if self._paused else "Pause"
            self._play.icon = viser.Icon.PLAYER_PLAY if self._paused else viser.Icon.PLAYER_PAUSE
