"""What accuracy costs: an experiment measured with all solvers in the background, its diagram, and settings to choose.

It is measured in another process, so that the scene that runs does not stutter. Of the points those can be chosen that
a live scene can have: a session keeps its time step and its precision.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import viser

from engine import SOLVERS
from sandbox.commands import SetAll
from sandbox.frame import Frame
from sandbox.lab.accuracy import Outcome, Row, all_series, front, sweep
from sandbox.lab.accuracy.chart import as_svg
from sandbox.lab.accuracy.groups import number, solvers_of
from sandbox.lab.accuracy.report import left_out, not_applicable
from sandbox.lab.accuracy.style import dark_style
from sandbox.lab.accuracy.workers import Processes
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.simulation import TIME_STEP
from web.panels.desk import Desk, small_text

INTRODUCTION = "An answer is known for each scene here; how far off is each solver, and how long does it take?"
IDLE, BUSY = "Measure its error and cost", "Stop measuring"
SECONDS = 90.0  # that a measurement may last
SETTABLE = ("substeps", "iterations", "stiffness")
NOTHING = "nothing is measured yet"
_PICTURE = '<div style="padding:0 14px 4px;max-width:520px">{}</div>'

Tell = Callable[[int, int, str], None]


def measured(scene: str, stop: threading.Event, tell: Tell) -> Outcome:
    """An experiment with all solvers, in a process of its own."""
    return sweep(
        [EXPERIMENTS[scene]], all_series(SOLVERS), Processes(1), seconds=SECONDS, repeats=2, stop=stop, progress=tell
    )  # fmt: skip


class LaboratoryPanel:
    """A tab of the window over the view."""

    def __init__(self, desk: Desk) -> None:
        self._desk, self._gui = desk, desk.gui
        self._busy = threading.Lock()
        self._stop = threading.Event()
        self._outcome = Outcome()
        self._choices: dict[str, Row] = {}
        with desk.hud.add_tab("Laboratory", viser.Icon.FLASK):
            self._add_controls()
        self._scene.on_update(self._on_scene)
        self._measure.on_update(self._on_measure_chosen)
        self._button.on_click(self._on_button)
        self._apply.on_click(self._on_apply)

    def _add_controls(self) -> None:
        first = next(iter(EXPERIMENTS))
        self._text = self._gui.add_html(small_text(INTRODUCTION))
        self._scene = self._gui.add_dropdown("known scene", tuple(EXPERIMENTS), hint="what is to be measured")
        self._measure = self._gui.add_dropdown("measure", _measures(first), hint="which error the diagram shows")
        self._button = self._gui.add_button(
            IDLE, icon=viser.Icon.CHART_LINE, hint="with all solvers, in the background; the scene goes on"
        )
        self._bar: Any = self._gui.add_progress_bar(0.0, visible=False)
        self._picture = self._gui.add_html("")
        self._point = self._gui.add_dropdown(
            "setting", (NOTHING,), hint="points that nothing beats, the cheapest first, then all others", visible=False
        )  # fmt: skip
        self._apply = self._gui.add_button(
            "Give this setting to the scene", icon=viser.Icon.ARROW_RIGHT, visible=False,
            hint="its solver, substeps and iterations",
        )  # fmt: skip

    def update(self, frame: Frame) -> None:
        """It has nothing to do with the scene."""

    # --- what a visitor does ------------------------------------------------------------------------------------

    async def _on_scene(self, _: object) -> None:
        self._measure.options = _measures(self._scene.value)

    async def _on_measure_chosen(self, _: object) -> None:
        self._show()

    async def _on_button(self, _: object) -> None:
        """Starts on a thread that does not keep the program alive, or stops what was started."""
        if self._busy.acquire(blocking=False):
            self._stop.clear()
            threading.Thread(target=self._run, args=(self._scene.value,), name="tumble-accuracy", daemon=True).start()
        else:
            self._stop.set()

    async def _on_apply(self, event: viser.GuiEvent[Any]) -> None:
        row = self._choices.get(self._point.value)
        if event.client is not None and row is not None:
            self._desk.submit(partial(SetAll, settings_of(row)))

    # --- in the background --------------------------------------------------------------------------------------

    def _run(self, scene: str) -> None:
        self._button.label, self._bar.visible, self._bar.value = BUSY, True, 0.0
        try:
            self._outcome = measured(scene, self._stop, self._tell)
            if not self._stop.is_set():
                self._show()
        except Exception as error:  # noqa: BLE001 - whatever it is, the page goes on and says so
            self._desk.page.report("accuracy could not be measured: %s", error)
            self._desk.page.notify("Not measured", str(error))
        finally:
            self._text.content = small_text(INTRODUCTION)
            self._button.label, self._bar.visible = IDLE, False
            self._busy.release()

    def _tell(self, done: int, total: int, what: str) -> None:
        if self._desk.closing.is_set():
            self._stop.set()
        self._bar.value = 100.0 * done / max(total, 1)
        self._text.content = small_text(f"{what}: {done} of {total} settings")

    def _show(self) -> None:
        """The diagram and the settings of the measure that is chosen, if that was measured."""
        rows = [
            row
            for row in self._outcome.rows
            if (row.scene, row.measure) == (self._scene.value, self._measure.value)
        ]  # fmt: skip
        self._choices = choices_of(rows)
        notes = [*not_applicable(self._outcome), *left_out(self._outcome)] if rows else []
        picture = _PICTURE.format(as_svg(rows, dark_style(".chart"))) if rows else small_text(NOTHING)
        self._picture.content = picture + "".join(map(small_text, notes))
        self._point.options = tuple(self._choices) or (NOTHING,)
        self._point.visible = self._apply.visible = bool(self._choices)


def _measures(scene: str) -> tuple[str, ...]:
    return tuple(measure.name for measure in EXPERIMENTS[scene].measures)


def can_be_live(row: Row) -> bool:
    """Whether a session that runs can have the setting."""
    return row.solver in SOLVERS and row.precision == "single" and abs(row.settings["dt"] / TIME_STEP - 1.0) < 1e-9


def choices_of(rows: list[Row]) -> dict[str, Row]:
    """What can be chosen, under the words that say it: those that nothing beats first."""
    live = [row for row in rows if can_be_live(row)]
    best = front(live)
    ordered = [*best, *(row for solver in solvers_of(live) for row in live if row.solver == solver and row not in best)]
    return {f"{row.solver}, {row.setting}: {number(row.error)}, {row.cost_ms:.2g} ms": row for row in ordered}


def settings_of(row: Row) -> dict[str, Any]:
    """What a live scene is to be set to, all of it or, where the scene cannot have the solver, nothing."""
    return {"solver": row.solver, **{name: row.settings[name] for name in SETTABLE if name in row.settings}}
