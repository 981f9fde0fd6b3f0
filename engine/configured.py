"""The settings of a world as its properties: each can be read and, but for the precision, changed at any time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from engine import validate
from engine.settings import Settings


class Configured:
    """What has `_settings`. A refused change leaves all as it was."""

    _settings: Settings

    @property
    def settings(self) -> Settings:
        """All of them, immutable."""
        return self._settings

    def set(self, **changes: Any) -> None:
        """Changes settings by name, all or none: world.set(iterations=20, warm_starting=False)."""
        for name in changes:
            validate.choice("setting", name, self._settings.to_dict())
        settings = replace(self._settings, **changes)
        if settings.precision != self.precision:
            raise validate.refuse("precision", settings.precision, "left as the world was made")
        self._settings = settings

    @property
    def precision(self) -> str:
        """Of the solver's own numbers: "single" or "double". The one setting that stays as the world was made."""
        return self._settings.precision

    @precision.setter
    def precision(self, value: str) -> None:
        self.set(precision=value)

    @property
    def gravity(self) -> tuple[float, float]:
        """[m/s^2]"""
        return self._settings.gravity

    @gravity.setter
    def gravity(self, value: Sequence[float]) -> None:
        self.set(gravity=value)

    @property
    def solver(self) -> str:
        """A name from engine.SOLVERS."""
        return self._settings.solver

    @solver.setter
    def solver(self, value: str) -> None:
        self.set(solver=value)

    @property
    def broad_phase(self) -> str:
        """A name from engine.BROAD_PHASES."""
        return self._settings.broad_phase

    @broad_phase.setter
    def broad_phase(self, value: str) -> None:
        self.set(broad_phase=value)

    @property
    def iterations(self) -> int:
        """Passes over all constraints in a step."""
        return self._settings.iterations

    @iterations.setter
    def iterations(self, value: int) -> None:
        self.set(iterations=value)

    @property
    def accumulate_impulses(self) -> bool:
        """Whether the sum of a contact's impulses is clamped, not each of them."""
        return self._settings.accumulate_impulses

    @accumulate_impulses.setter
    def accumulate_impulses(self, value: bool) -> None:
        self.set(accumulate_impulses=value)

    @property
    def warm_starting(self) -> bool:
        """Whether a step begins with the impulses of the step before."""
        return self._settings.warm_starting

    @warm_starting.setter
    def warm_starting(self, value: bool) -> None:
        self.set(warm_starting=value)

    @property
    def position_correction(self) -> bool:
        """Whether overlapping bodies are pushed apart."""
        return self._settings.position_correction

    @position_correction.setter
    def position_correction(self, value: bool) -> None:
        self.set(position_correction=value)
