"""What a hard case is: a scene, what must hold of it, and what is done to it while it runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from engine import Shape, World
from sandbox.scenes import Scene, find_scene
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import Build
from sandbox.simulation import TIME_STEP


class Stage(Protocol):
    """A world of ours or another engine's, as a case sees it."""

    world: World  # as it stands now: to be read. Of another engine, a copy of ours that is put where its bodies are.

    def set_gravity(self, gravity: tuple[float, float]) -> None:
        """[m/s^2], from the next step on."""

    def destroy(self, index: int) -> None:
        """Takes a body away, by its place among the living."""

    def create(self, shape: Shape, position: tuple[float, float], **body: Any) -> None:
        """A body more. NotApplicable where that cannot be told."""


class NotApplicable(Exception):
    """This solver or engine cannot have this case; the message says why."""


Program = Callable[[Stage, int, float], float]
"""Called before every time step with the stage, the number of the step from 0, and the time step [s]: it may act on
the stage, and gives the time step to be taken. It remembers nothing: what it does follows from the number."""


@dataclass(frozen=True)
class Case:
    """A scene that is hard to simulate, and the criteria that tell whether it held."""

    scene: Scene
    shows: tuple[Criterion, ...] = ()  # the scene's own, if none are given
    program: Program | None = None
    dt: float = TIME_STEP  # [s]
    sleeping: bool = False  # whether bodies may fall asleep: what falls slowly would be held
    ours_alone: str = ""  # why no other engine can have it, "" if it can
    quick: bool = False  # runs in a fraction of a second
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        return self.shows or self.scene.shows


def case(name: str, **about: Any) -> Case:
    """Of a scene that is listed. shows: one criterion or several."""
    return _case(find_scene(name), **about)


def variant(name: str, build: Build, summary: str, **about: Any) -> Case:
    """Of a scene like the one of that name, with something of another size: it is not listed."""
    return _case(replace(find_scene(name), name=f"{name}, varied", build=build, summary=summary), **about)


def _case(scene: Scene, shows: Criterion | tuple[Criterion, ...] = (), **about: Any) -> Case:
    return Case(scene, (shows,) if isinstance(shows, Criterion) else tuple(shows), **about)


def is_finite(world: World) -> bool:
    """Whether every body is somewhere, and moves somehow."""
    return bool(np.isfinite(world.positions).all() and np.isfinite(world.velocities).all())
