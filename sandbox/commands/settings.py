"""The command that changes a setting of the world: any of them, but for the precision."""

from __future__ import annotations

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


def _checked(info: SettingInfo, value: Any) -> Any:
    if info.kind == "whole":
        return None if value is None else validate.whole(info.name, info.check(value), 1, int(LARGEST))
    checked = info.check(value)
    if info.kind == "vector" and max(map(abs, checked)) > LARGEST:
        raise validate.refuse(info.name, value, f"two numbers from {-LARGEST:g} to {LARGEST:g}")
    return validate.between(info.name, checked, 0.0, LARGEST) if info.kind == "number" else checked
