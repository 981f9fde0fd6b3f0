"""Computing a recorded run again: the same start, the same commands before the same steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from engine import Snapshot
from sandbox.commands import command_from_dict
from sandbox.frame import Frame
from sandbox.scenes import SCENES, Scene
from sandbox.simulation import Simulation


class Recorded(Protocol):
    """What is needed of a recording to compute it again."""

    @property
    def scene(self) -> str: ...
    @property
    def dt(self) -> float: ...
    @property
    def snapshot(self) -> bytes: ...
    @property
    def hands(self) -> dict[str, Any]: ...
    @property
    def steps(self) -> np.ndarray: ...
    @property
    def commands(self) -> Mapping[int, Sequence[Mapping[str, Any]]]: ...


def simulation_at_start(recorded: Recorded) -> Simulation:
    """The simulation as it was when the recording began. ValueError if its snapshot is not one of ours."""
    snapshot = Snapshot.from_bytes(recorded.snapshot)
    known = SCENES.get(recorded.scene)
    view = known.view if known else (0.0, 5.0, 20.0)
    empty = Scene(recorded.scene, lambda world: None, "", view)
    simulation = Simulation(empty, recorded.dt, **snapshot.settings.to_dict())
    simulation.restore(snapshot, recorded.hands)
    return simulation


def repeat(recorded: Recorded) -> Iterator[Frame]:
    """The frames of the run computed again: the start, then every recorded step."""
    simulation = simulation_at_start(recorded)
    yield simulation.frame()
    for step in recorded.steps:
        commands = tuple(dict(command) for command in recorded.commands.get(int(step), ()))
        for command in commands:
            simulation.apply(command_from_dict(command))
        simulation.step()
        yield simulation.frame(commands)
