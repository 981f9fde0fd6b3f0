"""Which settings of a solver are tried, from the cheapest to the dearest, and in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from engine import SOLVERS, World

PEERS = ("pymunk", "pyb2d3")  # appear as solvers
MIRRORED = {"pymunk": "sequential_impulses", "pyb2d3": "soft_step"}  # whose settings they take
SHOWN = ("substeps", "iterations")


@dataclass(frozen=True)
class Variant:
    """Settings of a solver to try; none: its defaults."""

    solver: str
    settings: tuple[tuple[str, Any], ...] = ()
    parts: int = 1  # of each time step

    @property
    def default(self) -> bool:
        return not self.settings and self.parts == 1

    @property
    def ours(self) -> str:
        """The solver of ours that it is, or whose settings another engine is given."""
        return MIRRORED.get(self.solver, self.solver)

    @property
    def label(self) -> str:
        """Such as "substeps 8" or "iterations 40, dt / 4"."""
        parts = [f"{name} {value}" for name, value in self.settings]
        parts += [f"dt / {self.parts}"] * (self.parts != 1)
        return ", ".join(parts) or "default"

    def shown(self, world: World, dt: float) -> dict[str, Any]:
        """What it comes to in a world, as JSON takes it."""
        names = [name for name in SHOWN if name == "iterations" or SOLVERS[self.ours].has_substeps]
        return {"dt": dt / self.parts, **{name: getattr(world.settings, name) for name in names}}


def ladder(solver: str) -> list[Variant]:
    """From the cheapest to the dearest; the default is one of them."""
    about = SOLVERS[MIRRORED.get(solver, solver)]
    if about.has_substeps:
        counts = sorted(
            {max(1, about.substeps // 4), max(1, about.substeps // 2), 2 * about.substeps, 4 * about.substeps}
        )
        others = [Variant(solver, (("substeps", count),)) for count in counts if count != about.substeps]
        cheaper = [variant for variant in others if variant.settings[0][1] < about.substeps]
        return [*cheaper, Variant(solver), *others[len(cheaper) :]]
    few = max(1, about.iterations * 2 // 5)
    cheaper = [Variant(solver, (("iterations", few),))] if few < about.iterations else []
    many = (("iterations", 4 * about.iterations),)
    return [*cheaper, Variant(solver), Variant(solver, many), Variant(solver, (), 4)]


def climb(solver: str, passes: Callable[[Variant], bool | None], defaults_only: bool = False) -> Iterator[Variant]:
    """Tries the default; if it passes, cheaper ones until one fails; else dearer ones until one passes.

    passes: tries one; None: it cannot be had, and so nor can others.
    """
    rungs = ladder(solver)
    start = next(k for k, variant in enumerate(rungs) if variant.default)
    passed = passes(rungs[start])
    yield rungs[start]
    if passed is None or defaults_only:
        return
    for variant in rungs[start + 1 :] if not passed else rungs[start - 1 :: -1] if start else []:
        now = passes(variant)
        yield variant
        if now is None or now is not passed:
            return
