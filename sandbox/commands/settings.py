"""The commands that change settings of the world: any of them, but for the precision; one, or several at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from engine import validate
from engine.settings import SettingInfo, describe
from sandbox.commands.base import PhysicsCommand

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

LARGEST = 1000.0  # of any number, in its own unit: far beyond the sliders, and a step still ends, and ends finite
FIXED = "precision"  # stays as the world was made

CHANGEABLE: dict[str, SettingInfo] = {info.name: info for info in describe() if info.name != FIXED}


@dataclass(frozen=True)
class Set(PhysicsCommand):
    """One of the world's settings by name: Set("gravity", (0, -10)), Set("iterations", 20).

    Of substeps and iterations, None is the solver's own number.
    """

    setting: str
    value: Any
    name = "set"

    def __post_init__(self) -> None:
        setting = validate.choice("setting", self.setting, CHANGEABLE)
        self._keep(setting=setting, value=_checked(CHANGEABLE[setting], self.value))

    def to_dict(self) -> dict[str, Any]:
        value = list(self.value) if isinstance(self.value, tuple) else self.value
        return {"command": self.name, "setting": self.setting, "value": value}

    def apply(self, simulation: Simulation) -> None:
        simulation.world.set(**{self.setting: self.value})


@dataclass(frozen=True)
class SetAll(PhysicsCommand):
    """Several settings at once, all or none: SetAll({"solver": "avbd", "iterations": 20}).

    settings: a mapping of names to values; kept as pairs, in its order.
    """

    settings: Any
    name = "set_all"

    def __post_init__(self) -> None:
        if not isinstance(self.settings, Mapping) or not self.settings:
            raise validate.refuse("settings", self.settings, "a mapping of names of settings to values")
        ones = [Set(name, value) for name, value in self.settings.items()]
        self._keep(settings=tuple((one.setting, one.value) for one in ones))

    def to_dict(self) -> dict[str, Any]:
        ones = [Set(name, value).to_dict() for name, value in self.settings]
        return {"command": self.name, "settings": {one["setting"]: one["value"] for one in ones}}

    def apply(self, simulation: Simulation) -> None:
        simulation.world.set(**dict(self.settings))


def _checked(info: SettingInfo, value: Any) -> Any:
    if info.kind == "whole":
        return None if value is None else validate.whole(info.name, info.check(value), 1, int(LARGEST))
    checked = info.check(value)
    if info.kind == "vector" and max(map(abs, checked)) > LARGEST:
        raise validate.refuse(info.name, value, f"two numbers from {-LARGEST:g} to {LARGEST:g}")
    return validate.between(info.name, checked, 0.0, LARGEST) if info.kind == "number" else checked
