"""Attributes of joints: numbers in a joint's tables, read, checked and written."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from engine import validate
from engine.tables import ALONG_NOTHING, NEVER, NO_SPRING, SPRING, STIFF

if TYPE_CHECKING:
    from engine.joints.joint import Joint

FAR = 1e9
"""A limit that is not there [m] or [rad]: as far as no joint ever goes."""

Check = Callable[[str, Any], float]


MOST_DAMPING = 1e6


def place(name: str, value: Any) -> float:
    """Where something along a joint is [m] or [rad]."""
    return validate.between(name, value, -FAR, FAR)


def damping(name: str, value: Any) -> float:
    """A damping ratio."""
    return validate.between(name, value, 0.0, MOST_DAMPING)


def checked(precision: str, name: str, value: Any, check: Check) -> float:
    """A number that is right, and that the solver's precision can hold."""
    number = check(name, value)
    validate.in_range(precision, **{name: (number,)})
    return number


class Number:
    """A number of a joint's tables."""

    def __init__(self, table: str, field: str, check: Check, doc: str) -> None:
        self.table, self.field, self.check = table, field, check
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, joint: Joint | None, owner: type) -> Any:
        return self if joint is None else self.read(joint)

    def read(self, joint: Joint) -> Any:
        return float(joint._part(self.table)[self.field])

    def __set__(self, joint: Joint, value: Any) -> None:
        joint._check()
        joint._write(self.table, self.written(joint.world.precision, value))

    def written(self, precision: str, value: Any) -> dict[str, Any]:
        """What to write for a value; ValueError if it is none that may be."""
        return {self.field: checked(precision, self.name, value, self.check)}


class Most(Number):
    """The largest force or torque of something; None: any."""

    def __init__(self, table: str, field: str, doc: str) -> None:
        super().__init__(table, field, validate.non_negative, doc)

    def read(self, joint: Joint) -> float | None:
        most = super().read(joint)
        return None if most < 0.0 else most

    def written(self, precision: str, value: Any) -> dict[str, Any]:
        return {self.field: NEVER} if value is None else super().written(precision, value)


class Hertz(Number):
    """The frequency of a spring; None: there is no spring, or, of what must be held, it is as stiff as joints are."""

    def __init__(self, table: str, without: int, doc: str) -> None:
        super().__init__(table, "hertz", validate.positive, doc)
        self.without = without

    def read(self, joint: Joint) -> float | None:
        return super().read(joint) if joint._part(self.table)["spring"] == SPRING else None

    def written(self, precision: str, value: Any) -> dict[str, Any]:
        return spring_of(precision, self.name, value, self.without)


class MotorSpeed(Number):
    """The speed of a motor; None: there is no motor."""

    def __init__(self, table: str, doc: str) -> None:
        super().__init__(table, "motor_speed", validate.number, doc)

    def read(self, joint: Joint) -> float | None:
        return super().read(joint) if joint._part(self.table)["motored"] else None

    def written(self, precision: str, value: Any) -> dict[str, Any]:
        return motor_of(precision, value)


class Limit(Number):
    """One of two limits; None: there is none on that side. least: that it may be."""

    def __init__(self, table: str, field: str, doc: str, least: float = -FAR) -> None:
        super().__init__(table, field, validate.number, doc)
        self.least = least

    def read(self, joint: Joint) -> float | None:
        value = super().read(joint)
        return value if joint._part(self.table)["limited"] and abs(value) < FAR else None

    def __set__(self, joint: Joint, value: Any) -> None:
        joint._check()
        both = {name: Limit.read(getattr(type(joint), name), joint) for name in ("lower", "upper")}
        joint._write(self.table, limits_of(**{**both, self.name: value}, least=self.least, set_now=self.name))


def spring_of(precision: str, name: str, hertz: float | None, without: int = NO_SPRING) -> dict[str, Any]:
    """A spring's columns but for its damping and target."""
    if hertz is None:
        return {"spring": without, "hertz": 0.0}
    return {"spring": SPRING, "hertz": checked(precision, name, hertz, validate.positive)}


def motor_of(precision: str, speed: float | None) -> dict[str, Any]:
    """A motor's columns but for its strength."""
    if speed is None:
        return {"motored": 0, "motor_speed": 0.0}
    allowed = "a finite number, or None"
    speed = checked(precision, "motor_speed", speed, lambda name, value: validate.number(name, value, allowed))
    return {"motored": 1, "motor_speed": speed}


def limits_of(lower: float | None, upper: float | None, least: float = -FAR, set_now: str = "lower") -> dict[str, Any]:
    """The columns of both limits, from `least` to FAR. ValueError, of the one set now, unless lower <= upper."""
    if lower is None and upper is None:
        return {"limited": 0, "lower": 0.0, "upper": 0.0}
    allowed = f"a number from {least:g} to {FAR:g}, or None"

    def side(name: str, value: float | None, none: float) -> float:
        return none if value is None else validate.between(name, validate.number(name, value, allowed), least, FAR)

    low, high = side("lower", lower, -FAR), side("upper", upper, FAR)
    if low > high and set_now == "upper":
        raise validate.refuse("upper", upper, f"at least lower, which is {lower!r}")
    if low > high:
        raise validate.refuse("lower", lower, f"at most upper, which is {upper!r}")
    return {"limited": 1, "lower": low, "upper": high}


def acts(part: Any) -> bool:
    """Whether anything acts in this turn or slide."""
    return part["spring"] != NO_SPRING or bool(part["motored"]) or bool(part["limited"])


def clear_idle(part: Any) -> None:
    """What is not there has given nothing."""
    idle = (
        ("spring", part["spring"] == NO_SPRING), ("motor", not part["motored"]), ("lower", not part["limited"]),
        ("upper", not part["limited"]),
    )  # fmt: skip
    for name, is_idle in idle:
        if is_idle:
            part[f"{name}_impulse"] = part[f"{name}_given"] = 0.0


__all__ = [
    "ALONG_NOTHING", "FAR", "STIFF", "Hertz", "Limit", "Most", "MotorSpeed", "Number", "acts", "checked", "clear_idle",
    "damping", "limits_of", "motor_of", "place", "spring_of",
]  # fmt: skip
