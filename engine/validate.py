"""Bad input is refused where it enters: every message names the argument, its value and what is allowed."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from typing import Any

import numpy as np

from engine.tables import REALS


def refuse(name: str, value: Any, allowed: str) -> ValueError:
    """The error to raise for a bad argument."""
    try:
        shown = repr(value)
    except ValueError:  # Python writes out no integer of more than 4300 digits
        shown = f"an integer of {value.bit_length()} bits" if isinstance(value, int) else "a value that has no text"
    return ValueError(f"{name} = {shown[:80]}{'...' if len(shown) > 80 else ''}: must be {allowed}")


def number(name: str, value: Any, allowed: str = "a finite number") -> float:
    """A finite float; booleans, text and arrays are none."""
    is_number = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    try:
        result = float(value) if is_number else math.nan
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise refuse(name, value, allowed)
    return result


def positive(name: str, value: Any) -> float:
    """A finite float > 0."""
    result = number(name, value, "a finite number > 0")
    if result <= 0.0:
        raise refuse(name, value, "a finite number > 0")
    return result


def non_negative(name: str, value: Any) -> float:
    """A finite float >= 0."""
    result = number(name, value, "a finite number >= 0")
    if result < 0.0:
        raise refuse(name, value, "a finite number >= 0")
    return result


def between(name: str, value: Any, low: float, high: float) -> float:
    """A finite float in [low, high]."""
    result = number(name, value, f"a number from {low:g} to {high:g}")
    if not low <= result <= high:
        raise refuse(name, value, f"a number from {low:g} to {high:g}")
    return result


def whole(name: str, value: Any, low: int, high: int) -> int:
    """An integer in [low, high]."""
    allowed = f"a whole number from {low} to {high}"
    if isinstance(value, (bool, np.bool_)):
        raise refuse(name, value, allowed)
    try:
        result = operator.index(value)
    except TypeError:
        raise refuse(name, value, allowed) from None
    if not low <= result <= high:
        raise refuse(name, value, allowed)
    return result


def vector(name: str, value: Any) -> tuple[float, float]:
    """Two finite floats."""
    allowed = "two finite numbers (x, y)"
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise refuse(name, value, allowed)
    try:
        parts = list(value)
    except TypeError:  # a numpy array without dimensions
        raise refuse(name, value, allowed) from None
    if len(parts) != 2:
        raise refuse(name, value, allowed)
    try:
        return number(name, parts[0]), number(name, parts[1])
    except ValueError:
        raise refuse(name, value, allowed) from None


def points(name: str, value: Any, least: int, most: int) -> tuple[tuple[float, float], ...]:
    """From `least` to `most` points."""
    allowed = f"{least} to {most} points (x, y) of finite numbers"
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise refuse(name, value, allowed)
    try:
        parts = list(value)
        if not least <= len(parts) <= most:
            raise refuse(name, value, allowed)
        return tuple(vector(name, part) for part in parts)
    except (TypeError, ValueError):
        raise refuse(name, value, allowed) from None


def switch(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise refuse(name, value, "True or False")
    return bool(value)


def choice(name: str, value: Any, options: Iterable[str]) -> str:
    """One of the options."""
    options = tuple(options)
    if not isinstance(value, str) or value not in options:
        raise refuse(name, value, "one of " + ", ".join(repr(option) for option in options))
    return value


def in_range(precision: str, **values: Iterable[float]) -> None:
    """Refuses numbers, checked already, that the solver's precision cannot hold."""
    largest = float(np.finfo(REALS[precision]).max)
    for name, numbers in values.items():
        shown = tuple(float(value) for value in numbers)
        if not all(abs(value) <= largest for value in shown):
            raise refuse(name, shown, f"of parts of at most {largest:.3g} in {precision} precision")


def time_step(name: str, value: Any, precision: str, parts: int = 1) -> float:
    """A finite float >= 0 that is zero, or whose parts the precision can hold together with their inverse."""
    result = non_negative(name, value)
    info = np.finfo(REALS[precision])
    if result != 0.0 and not parts * float(info.tiny) <= result <= float(info.max) / 4.0:
        among = f", and so each of {parts} parts" if parts > 1 else ""
        raise refuse(name, value, f"0 or a normal {precision} precision number{among}")
    return result
