"""What a user may set: immutable, checked when made. A new setting is one line here, one in configured.py.

Each says how it is checked and what it means, and that is where the page and the command line read it, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, NamedTuple

from engine import constants, mixing, validate
from engine.broad_phase import BROAD_PHASES
from engine.solvers import SOLVERS
from engine.tables import REALS

STIFFNESSES = ("follows", "fixed")
TALK = ("sequential_impulses",)
SOFT = ("soft_step",)
AHEAD = ("soft_step", "ngs", "xpbd", "avbd", "direct")
"""Solvers that see contacts ahead."""
BOUNCING = ("soft_step", "ngs", "xpbd", "direct")
"""Solvers that let things bounce."""
SUBSTEPPING = ("soft_step", "xpbd")
ITERATING = ("soft_step", "sequential_impulses", "ngs", "xpbd", "avbd")
MOVING = ("soft_step", "xpbd", "avbd")
"""Solvers that let things sleep, and stop what is fast."""
STARTING = ("soft_step", "sequential_impulses", "ngs", "avbd")
"""Solvers that start from the impulses of the step before."""


class SettingInfo(NamedTuple):
    """What there is to say of a setting."""

    name: str
    kind: str  # "number" | "whole" | "choice" | "switch" | "vector"
    low: float = 0.0  # of numbers: what makes sense on a slider; more may be allowed
    high: float = 0.0
    step: float = 0.0
    choices: tuple[str, ...] = ()
    unit: str = ""
    hint: str = ""
    solvers: tuple[str, ...] = ()  # to which it matters; empty: to all

    def check(self, value: Any) -> Any:
        """The value, or ValueError naming the setting."""
        if self.kind == "vector":
            return validate.vector(self.name, value)
        if self.kind == "choice":
            return validate.choice(self.name, value, self.choices)
        if self.kind == "switch":
            return validate.switch(self.name, value)
        if self.kind == "whole":
            return validate.whole(self.name, value, 1, MOST[self.name])
        return validate.positive(self.name, value) if self.low > 0.0 else validate.non_negative(self.name, value)


MOST = {"iterations": constants.MAX_ITERATIONS, "substeps": constants.MAX_SUBSTEPS}


def number(default: float, low: float, high: float, step: float, unit: str, hint: str, solvers: Any = ()) -> Any:
    about = {"low": low, "high": high, "step": step, "unit": unit, "hint": hint, "solvers": solvers}
    return field(default=default, metadata={"kind": "number", **about})


def choice(default: str, choices: Any, hint: str, solvers: Any = ()) -> Any:
    about = {"choices": tuple(choices), "hint": hint, "solvers": solvers}
    return field(default=default, metadata={"kind": "choice", **about})


def switch(hint: str, solvers: Any = (), default: bool = True) -> Any:
    return field(default=default, metadata={"kind": "switch", "hint": hint, "solvers": solvers})


def whole(most: int, hint: str, solvers: Any = ()) -> Any:
    about = {"low": 1, "high": most, "step": 1, "hint": hint, "solvers": solvers}
    return field(default=None, metadata={"kind": "whole", **about})


def vector(default: tuple[float, float], largest: float, unit: str, hint: str) -> Any:
    about = {"low": -largest, "high": largest, "step": 0.1, "unit": unit, "hint": hint}
    return field(default=default, metadata={"kind": "vector", **about})


@dataclass(frozen=True)
class Settings:
    """All settings of a world. ValueError names the one that is wrong."""

    gravity: tuple[float, float] = vector((0.0, -10.0), 30.0, "m/s²", "how all bodies fall")
    solver: str = choice("soft_step", SOLVERS, "how contacts and joints are kept")
    substeps: int = whole(32, "parts of a time step: more make everything stiffer and more exact", SUBSTEPPING)
    iterations: int = whole(50, "passes over all constraints, in a step or in each substep", ITERATING)
    precision: str = choice("single", REALS, "of the solver's own numbers; stays as the world was made")
    broad_phase: str = choice("dynamic_tree", BROAD_PHASES, "how pairs that may touch are found")
    stiffness: str = choice(
        "follows", STIFFNESSES, "whether contacts and joints get stiffer with more substeps, or stay as set below", SOFT
    )
    contact_hertz: float = number(
        constants.CONTACT_HERTZ, 5.0, 240.0, 1.0, "Hz", "of contacts, where the stiffness is fixed", SOFT
    )
    contact_damping_ratio: float = number(
        constants.CONTACT_DAMPING_RATIO, 0.0, 20.0, 0.1, "", "of contacts: 1 is critical", SOFT
    )
    push_out_speed: float = number(
        constants.PUSH_OUT_SPEED, 0.0, 10.0, 0.1, "m/s", "at most, of bodies that overlap", MOVING
    )
    joint_hertz: float = number(
        constants.JOINT_HERTZ, 5.0, 240.0, 1.0, "Hz", "of joints, where the stiffness is fixed", SOFT
    )
    joint_damping_ratio: float = number(constants.JOINT_DAMPING_RATIO, 0.0, 20.0, 0.1, "", "of joints", SOFT)
    joint_solving: str = choice(
        "auto", ("auto", "iterated", "direct"), "chains that would stretch are solved at once; or none, or all", SOFT
    )
    restitution_threshold: float = number(
        constants.RESTITUTION_THRESHOLD, 0.0, 10.0, 0.1, "m/s", "below it nothing bounces", BOUNCING
    )
    speculative_distance: float = number(
        constants.SPECULATIVE_DISTANCE, 0.0, 0.2, 0.005, "m", "contacts are made this far ahead", AHEAD
    )
    recycling: bool = switch("keep contacts whose bodies hardly moved: what keeps tall stacks standing", AHEAD)
    recycling_distance: float = number(
        constants.RECYCLING_DISTANCE, 0.0, 0.2, 0.005, "m", "how far bodies move before contacts are found anew", AHEAD
    )
    continuous: bool = switch("what is fast stops where it would go through something", MOVING)
    maximum_speed: float = number(
        constants.MAXIMUM_SPEED, 100.0, 10000.0, 100.0, "m/s", "of a body: what would be faster is held to it", MOVING
    )
    sleeping: bool = switch("what lies still falls asleep and costs nothing until something wakes it", MOVING)
    sleep_speed: float = number(constants.SLEEP_SPEED, 0.0, 1.0, 0.01, "m/s", "below it a body is still", MOVING)
    sleep_time: float = number(
        constants.SLEEP_TIME, 0.1, 10.0, 0.1, "s", "so long must a body be still to sleep", MOVING
    )
    friction_mixing: str = choice("geometric", mixing.RULES, "the friction of two shapes that touch")
    restitution_mixing: str = choice("greatest", mixing.RULES, "the restitution of two shapes that touch", BOUNCING)
    wind: tuple[float, float] = vector((0.0, 0.0), 30.0, "m/s", "of the air; moves bodies that have drag")
    accumulate_impulses: bool = switch("clamp the sum of a contact's impulses, not each alone", TALK)
    warm_starting: bool = switch("start from the impulses of the step before", STARTING)
    position_correction: bool = switch("push bodies apart that have sunk into each other")
    tell_events: bool = switch("tell what begins, ends, hits and moves in each step", default=False)
    hit_speed: float = number(
        constants.HIT_SPEED, 0.0, 20.0, 0.1, "m/s", "shapes that begin to touch faster hit each other"
    )

    def __post_init__(self) -> None:
        solver = SOLVERS[validate.choice("solver", self.solver, SOLVERS)]
        checked: dict[str, Any] = {}
        for info in describe():
            value = getattr(self, info.name)
            if info.kind == "whole" and value is None:
                value = getattr(solver, info.name)  # the solver's own
            checked[info.name] = info.check(value)
        if checked["substeps"] != 1 and not solver.has_substeps:
            raise validate.refuse("substeps", self.substeps, f"1 where the solver is {self.solver!r}")
        for name, value in checked.items():
            object.__setattr__(self, name, value)
            if not isinstance(value, (str, bool)):
                validate.in_range(self.precision, **{name: numbers_of(value)})

    def changed(self, changes: Mapping[str, Any]) -> Settings:
        """With these changes. Another solver brings its own substeps and iterations, unless they are given."""
        for name in changes:
            validate.choice("setting", name, self.to_dict())
        if changes.get("solver", self.solver) != self.solver:
            changes = {"substeps": None, "iterations": None, **changes}
        return replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Settings:
        """What `to_dict` gave; an unknown name is refused."""
        for name in values:
            validate.choice("setting", name, [info.name for info in describe()])
        return cls(**values)


def numbers_of(value: Any) -> tuple[float, ...]:
    return value if isinstance(value, tuple) else (value,)


def describe() -> tuple[SettingInfo, ...]:
    """Every setting, in the order in which they stand above."""
    return tuple(SettingInfo(item.name, **item.metadata) for item in fields(Settings))
