"""The settings of a world as its properties: each can be read and, but for the precision, changed at any time."""

from __future__ import annotations

from typing import Any, Generic, TypeVar, overload

from engine import validate
from engine.settings import Settings

T = TypeVar("T")


class Setting(Generic[T]):
    """One setting of the world as its attribute; settings.py says what it means."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, world: None, owner: type) -> Setting[T]: ...
    @overload
    def __get__(self, world: Configured, owner: type) -> T: ...
    def __get__(self, world: Configured | None, owner: type) -> Any:
        return self if world is None else getattr(world._settings, self.name)

    def __set__(self, world: Configured, value: Any) -> None:
        world.set(**{self.name: value})


class Configured:
    """What has `_settings`. A refused change leaves all as it was."""

    _settings: Settings

    gravity = Setting[tuple[float, float]]()
    solver = Setting[str]()
    substeps = Setting[int]()
    iterations = Setting[int]()
    precision = Setting[str]()
    broad_phase = Setting[str]()
    stiffness = Setting[str]()
    contact_hertz = Setting[float]()
    contact_damping_ratio = Setting[float]()
    push_out_speed = Setting[float]()
    joint_hertz = Setting[float]()
    joint_damping_ratio = Setting[float]()
    joint_solving = Setting[str]()
    restitution_threshold = Setting[float]()
    speculative_distance = Setting[float]()
    recycling = Setting[bool]()
    recycling_distance = Setting[float]()
    continuous = Setting[bool]()
    maximum_speed = Setting[float]()
    sleeping = Setting[bool]()
    sleep_speed = Setting[float]()
    sleep_time = Setting[float]()
    friction_mixing = Setting[str]()
    restitution_mixing = Setting[str]()
    wind = Setting[tuple[float, float]]()
    accumulate_impulses = Setting[bool]()
    warm_starting = Setting[bool]()
    position_correction = Setting[bool]()
    tell_events = Setting[bool]()
    hit_speed = Setting[float]()

    @property
    def settings(self) -> Settings:
        """All of them, immutable."""
        return self._settings

    def set(self, **changes: Any) -> None:
        """Changes settings by name, all or none: world.set(iterations=20, warm_starting=False).

        Another solver brings its own number of substeps and iterations, unless they are given too.
        """
        settings = self._settings.changed(changes)
        if settings.precision != self.precision:
            raise validate.refuse("precision", settings.precision, "left as the world was made")
        self._accept(settings)
        self._settings = settings

    def _accept(self, settings: Settings) -> None:
        """ValueError if the world as it is cannot have these settings."""
