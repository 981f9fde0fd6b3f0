"""Breaks soft_step in one way after another, and prints which of three hard cases see it.

A program of its own: uncompiled (NUMBA_DISABLE_JIT=1), where a function that is exchanged is the one that is called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from engine.solvers.soft_step import contacts, friction, passes
from sandbox.lab.hard_cases import CASES
from sandbox.lab.stability import check
from sandbox.lab.stability_ladder import Variant

SHORT = {"mass_ratio_10": 1.2, "friction_ramp": 0.8, "overlap_recovery": 1.0}  # uncompiled steps take long [s]


def half_the_mass(mass_along: Callable) -> Callable:
    return lambda *arguments: mass_along(*arguments) * 0.5


def no_relax(relax_normal: Callable) -> Callable:
    return lambda c, m1, m2, kept, step: contacts.Speeds(m1.v, m1.w, m2.v, m2.w)


def unclamped(change: Callable) -> Callable:
    return lambda speed, mass, impulse, limit: -mass * speed


BROKEN: dict[str, tuple[Any, str, Callable[[Callable], Callable]]] = {
    "wrong effective mass": (contacts, "mass_along", half_the_mass),
    "no relax pass": (passes, "relax_normal", no_relax),
    "friction unclamped": (friction, "change", unclamped),
}


@contextmanager
def broken(what: str) -> Iterator[None]:
    """For as long as this lasts."""
    module, name, worse = BROKEN[what]
    right = getattr(module, name)
    setattr(module, name, worse(right))
    yield
    setattr(module, name, right)


def fallen() -> list[str]:
    """Which of the cases do not hold."""
    return [name for name in SHORT if not check(name, Variant("soft_step")).passed]


def main() -> None:
    for name, after in SHORT.items():
        CASES[name] = replace(CASES[name], shows=tuple(replace(c, after=after) for c in CASES[name].criteria))
    print("nothing:", *fallen())
    for what in BROKEN:
        with broken(what):
            print(f"{what}:", *fallen())


if __name__ == "__main__":
    main()
