"""Commands that concern the session, not the world: they are not recorded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from engine import validate
from sandbox.scenes import find_scene

SPEEDS = (0.1, 4.0)  # simulated seconds per second


@dataclass(frozen=True)
class Pause:
    """Stands still."""

    name: ClassVar[str] = "pause"


@dataclass(frozen=True)
class Play:
    """Goes on."""

    name: ClassVar[str] = "play"


@dataclass(frozen=True)
class StepOnce:
    """One step, then stands still."""

    name: ClassVar[str] = "step_once"


@dataclass(frozen=True)
class SetSpeed:
    """Simulated seconds per second."""

    speed: float
    name: ClassVar[str] = "set_speed"

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", validate.between("speed", self.speed, *SPEEDS))


@dataclass(frozen=True)
class Reset:
    """The scene begins again, with the settings as they are."""

    name: ClassVar[str] = "reset"


@dataclass(frozen=True)
class LoadScene:
    """Another scene begins. UnknownScene if there is none of that name."""

    scene: str
    name: ClassVar[str] = "load_scene"

    def __post_init__(self) -> None:
        object.__setattr__(self, "scene", find_scene(self.scene).name)


@dataclass(frozen=True)
class StartRecording:
    """Records from the next step on."""

    name: ClassVar[str] = "start_recording"


@dataclass(frozen=True)
class StopRecording:
    """Finishes the recording."""

    name: ClassVar[str] = "stop_recording"
