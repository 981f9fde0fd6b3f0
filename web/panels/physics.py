"""The settings of the world, made from what the engine says of each: its range, and to which solvers it matters."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import viser

from engine.settings import SettingInfo, Settings
from sandbox.commands import Set
from sandbox.commands.settings import CHANGEABLE
from sandbox.frame import Frame
from web.panels.desk import Desk, Follower

MAIN = (
    "gravity", "solver", "substeps", "iterations", "accumulate_impulses", "warm_starting", "position_correction",
)  # fmt: skip
SURROUNDINGS = ("wind", "friction_mixing", "restitution_mixing")
TELLING = ("tell_events", "hit_speed")
NEEDS = {  # settings that another one switches off
    "contact_hertz": ("stiffness", "fixed"),
    "joint_hertz": ("stiffness", "fixed"),
    "recycling_distance": ("recycling", True),
    "hit_speed": ("tell_events", True),
}


class PhysicsPanel:
    """The main ones open; whatever else the engine has, in folders below them."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._settings: Settings = desk.session.frame.settings
        self._follower = Follower()
        self._controls: list[tuple[SettingInfo, Any]] = []
        with desk.gui.add_folder("Physics"):
            self._add_all(MAIN)
            with desk.gui.add_folder("Solver details", expand_by_default=False):
                self._add_all(name for name in CHANGEABLE if name not in (*MAIN, *SURROUNDINGS, *TELLING))
            with desk.gui.add_folder("Wind and materials", expand_by_default=False):
                self._add_all(SURROUNDINGS)
            with desk.gui.add_folder("What is told", expand_by_default=False):
                self._add_all(TELLING)
        self._show_what_matters()

    def update(self, frame: Frame) -> None:
        self._follower.update(frame)
        if frame.settings != self._settings:
            self._settings = frame.settings
            self._show_what_matters()

    def _show_what_matters(self) -> None:
        for info, control in self._controls:
            matters = matters_now(info, self._settings)
            if control.visible != matters:
                control.visible = matters

    def _add_all(self, names: Iterable[str]) -> None:
        for name in names:
            info = CHANGEABLE[name]
            if info.kind == "vector":
                self._add_vector(info)
            else:
                control = _add_control(self._desk.gui, info, getattr(self._settings, name))
                self._keep(info, control, _setter(name, control), _getter(name))

    def _add_vector(self, info: SettingInfo) -> None:
        x, y = getattr(self._settings, info.name)
        sliders = [
            _add_slider(self._desk.gui, info, f"{info.name} {axis}", value) for axis, value in (("x", x), ("y", y))
        ]
        for axis, slider in enumerate(sliders):
            self._keep(info, slider, lambda: Set(info.name, [one.value for one in sliders]), _getter(info.name, axis))

    def _keep(self, info: SettingInfo, control: Any, make: Callable[[], Set], read: Callable[[Frame], Any]) -> None:
        self._controls.append((info, control))
        self._desk.on_change(control, make)
        self._follower.add(control, read)


def matters_now(info: SettingInfo, settings: Settings) -> bool:
    """Whether changing this setting would change anything, as the others are."""
    name, needed = NEEDS.get(info.name, ("solver", settings.solver))
    return (not info.solvers or settings.solver in info.solvers) and getattr(settings, name) == needed


def _add_control(gui: viser.GuiApi, info: SettingInfo, value: Any) -> Any:
    label = info.name.replace("_", " ")
    if info.kind == "switch":
        return gui.add_checkbox(label, value, hint=info.hint)
    if info.kind == "choice":
        return gui.add_dropdown(label, info.choices, initial_value=value, hint=info.hint)
    return _add_slider(gui, info, label, value)


def _add_slider(gui: viser.GuiApi, info: SettingInfo, label: str, value: float) -> Any:
    hint = f"{info.hint} [{info.unit}]" if info.unit else info.hint
    return gui.add_slider(label, info.low, info.high, info.step, min(max(value, info.low), info.high), hint=hint)


def _setter(name: str, control: Any) -> Callable[[], Set]:
    return lambda: Set(name, control.value)


def _getter(name: str, axis: int | None = None) -> Callable[[Frame], Any]:
    def read(frame: Frame) -> Any:
        value = getattr(frame.settings, name)
        return value if axis is None else value[axis]

    return read
