"""A scene's effects as rows: for a terminal, as JSON, and as a page of the documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.table import Table

from engine import EFFECTS, JOINT_KINDS, EffectStatus
from engine.effects import Effect
from sandbox.lab.ablation import Difference
from sandbox.lab.tables import rendered

SUMMARIES = {effect.name: effect.summary for effect in EFFECTS}
LACKING = "not with this solver"


@dataclass(frozen=True)
class Row:
    """One effect in a scene. None: the scene's solver lacks it."""

    effect: str
    called_for: bool
    because: str  # what calls for it, "" if nothing does
    cost: Difference | None  # what its code adds to a step, or would add [us]
    compile_s: float | None  # what compiling it takes, or would take [s]

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {
            "effect": self.effect,
            "called_for": self.called_for,
            "because": self.because,
            "cost_us": None if self.cost is None else self.cost.median,
            "compile_s": self.compile_s,
        }


def make_rows(
    statuses: Sequence[EffectStatus], costs: Mapping[str, Difference], compile_s: Mapping[str, float]
) -> list[Row]:
    """One for every effect the engine has, in its order."""
    return [Row(name, on, because, costs.get(name), compile_s.get(name)) for name, on, because in statuses]


@dataclass(frozen=True)
class Report:
    """A scene's rows, and what they were measured on."""

    scene: str
    bodies: int
    step_us: float  # median of a step as it is [us]
    idle: Difference  # what the code of all that is off would add to a step, together [us]
    rows: list[Row]

    @property
    def on(self) -> list[Row]:
        return [row for row in self.rows if row.called_for]

    @property
    def off(self) -> list[Row]:
        return [row for row in self.rows if not row.called_for]

    def summary(self) -> str:
        """What the effects cost, and what leaving the others out saves."""
        compiled = sum(row.compile_s or 0.0 for row in self.off)
        return (
            f"{self.scene}, {self.bodies} bodies, {self.step_us:.0f} us a step. It calls for {len(self.on)} of "
            f"{len(self.rows)} effects; without the others it saves {shown(self.idle)} us a step and {compiled:.1f} s "
            "of compiling."
        )


def as_text(report: Report) -> str:
    """A short table of what is on, a long one of what is off."""
    on = table("on", ("effect", "because", "us a step", "s to compile"))
    for row in report.on:
        on.add_row(row.effect, row.because, cost(row), seconds(row))
    off = table("off", ("effect", "what it does", "us a step saved", "s saved"))
    for row in report.off:
        off.add_row(row.effect, SUMMARIES[row.effect], cost(row), seconds(row))
    return "\n\n".join((rendered(on), rendered(off), report.summary()))


def table(title: str, columns: tuple[str, str, str, str]) -> Table:
    found = Table(box=None, pad_edge=False, title=title, title_justify="left")
    for name, right in zip(columns, (False, False, True, True), strict=True):
        found.add_column(name, justify="right" if right else "left", no_wrap=right)
    return found


def cost(row: Row) -> str:
    return LACKING if row.cost is None else shown(row.cost)


def shown(difference: Difference) -> str:
    """A figure, or within what nothing can be told from noise."""
    if difference.is_noise:
        return f"0 ± {digits(difference.noise)}"
    return digits(difference.median)


def digits(value: float) -> str:
    return f"{value:.2f}" if abs(value) < 1.0 else f"{value:.1f}" if abs(value) < 100.0 else f"{value:.0f}"


def seconds(row: Row) -> str:
    return "" if row.compile_s is None else f"{row.compile_s:.2f}"


def as_markdown(reports: Sequence[Report]) -> str:
    """The page docs/effects.md."""
    scenes = " ".join(f'"{report.scene}"' for report in reports)
    lines = [
        *PAGE_TOP.format(command=f"tumble effects {scenes} --markdown docs/effects.md").splitlines(),
        "| effect | what it does | called for by |",
        "|---|---|---|",
        *(f"| {effect.name} | {cell(effect.summary)} | {source(effect)} |" for effect in EFFECTS),
        *PAGE_COSTS.splitlines(),
    ]
    for report in reports:
        lines += ["", f"### {report.scene}", "", report.summary(), ""]
        lines += ["| on | because | us a step | s to compile |", "|---|---|---:|---:|"]
        lines += [f"| {row.effect} | {cell(row.because)} | {cost(row)} | {seconds(row)} |" for row in report.on]
        lines += ["", "| off | us a step saved | s saved |", "|---|---:|---:|"]
        lines += [f"| {row.effect} | {cost(row)} | {seconds(row)} |" for row in report.off]
    return "\n".join(lines) + "\n"


PAGE_TOP = """\
# Effects: what a scene does not call for, it does not pay for

Made by `{command}`; not edited by hand.

An effect is anything that a scene may do without. What a scene calls for is read from its content and settings
whenever those change, never in a step. The table of an effect that is not called for is not there, its kernel is
neither compiled nor run, and no inner loop asks about it. Tests hold that:

- forcing all idle code on leaves the state hash of every scene after 300 steps as it was, the benchmark's left out
  (`tests/sandbox/lab/test_effects_scenes.py`);
- after a run, the kernels of idle effects have no compiled signature; and more effects in the engine change no kernel
  that a plain pyramid runs, no type that one is compiled for, and not one instruction of its step
  (`tests/engine/effects/test_on_demand.py`; the processor's own, which `tests/engine/effects/instructions.py` counts
  with valgrind, agree within 0.3 %).

`engine/effects/__init__.py::EFFECTS` lists them all; [adding_an_effect.md](adding_an_effect.md) says how to add one.

"""

PAGE_COSTS = """
## What they cost

"us a step" is the median difference, in CPU time, between steps from the same moment with the effect's code and without
it, the two taking turns; 0 ± x where that is less than chance may make it. Of an effect that is off: what its code
would add if it ran and found nothing to do. It may be less than nothing: what passes through each other need not be
kept apart. "s to compile", from an empty cache, is for the effect's own kernels and for what it adds to those that it
changes.
Explosions and diagnostics run on request, not in a step: of them it is what one request takes.
"""


def cell(text: str) -> str:
    """In a table of Markdown a bar would end the cell."""
    return text.replace("|", "\\|")


def source(effect: Effect) -> str:
    """Which properties bring it, or what else does."""
    body = [f"`{item.name}` of a body" for item in effect.body]
    shape = [f"`{item.name}` of a shape" for item in effect.shape]
    return ", ".join(body + shape) or CALLED_FOR_BY[effect.name]


CALLED_FOR_BY = {
    "gravity": "`gravity` of the world, unless it is zero",
    "wind": "`wind` of the world, where a body has drag",
    "buoyancy": "`World.create_fluid`",
    "explosions": "`World.explode`",
    "friction": "`friction` of a shape",
    "continuous collision": "`continuous` of the world, where dynamic bodies and shapes that nothing moves are",
    "revolute joints": "`World.create_joint_revolute`",
    **{f"{kind} joints": f"`World.create_joint_{kind}`" for kind in JOINT_KINDS[1:]},
    "joint springs": "`hertz` of a joint; welds and rods have stiff ones",
    "joint motors": "`motor_speed` of a joint",
    "joint limits": "`lower` and `upper` of a joint",
    "chains": "chains, bridges and the like, by what they are made of; or `World.joint_solving`",
    "breaking joints": "`break_force`, `break_torque` of a joint",
    "joined without colliding": "a joint with `collide_connected=False`",
    "events": "`tell_events` of the world",
    "diagnostics": "`World.diagnostics`",
}
