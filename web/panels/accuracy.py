"""What accuracy costs: the laboratory's work-precision diagram, measured while one waits."""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np
import viser

from sandbox.frame import Frame
from sandbox.lab.accuracy import measure, runs_of
from sandbox.lab.accuracy_picture import as_image
from sandbox.lab.experiments import EXPERIMENTS
from web.panels.desk import Desk, small_text

INTRODUCTION = "An exact answer is known for each; how far off are we, and how long does it take?"


class AccuracyPanel:
    """An experiment to choose, a button, and the diagram that comes of it."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._busy = threading.Lock()
        self._picture: np.ndarray | None = None
        with desk.gui.add_folder("Accuracy", expand_by_default=False) as self._folder:
            self._text = desk.gui.add_html(small_text(INTRODUCTION))
            self._scene = desk.gui.add_dropdown("experiment", tuple(EXPERIMENTS), hint="what is to be measured")
            self._button = desk.gui.add_button(
                "Measure its error and cost",
                icon=viser.Icon.CHART_LINE,
                hint="with both solvers over their settings; the scene may slow down meanwhile",
            )
            self._button.on_click(self._on_measure)
            self._larger = desk.gui.add_button("Show it larger", icon=viser.Icon.ARROWS_MAXIMIZE, visible=False)
            self._larger.on_click(self._on_larger)
        self._image: viser.GuiImageHandle | None = None

    def update(self, frame: Frame) -> None:
        """It has nothing to do with the scene."""

    def _on_measure(self, _: object) -> None:
        """On a thread of viser's pool; a second press meanwhile does nothing."""
        if not self._busy.acquire(blocking=False):
            return
        self._button.disabled = True
        try:
            self._show(diagram(self._scene.value, self._progress))
        except Exception as error:  # noqa: BLE001 - whatever it is, the page goes on and says so
            self._desk.page.report("accuracy could not be measured: %s", error)
            self._desk.page.notify("Not measured", str(error))
        finally:
            self._text.content = small_text(INTRODUCTION)
            self._button.disabled = False
            self._busy.release()

    def _progress(self, done: int, total: int) -> None:
        self._text.content = small_text(f"run {done} of {total} ...")

    def _show(self, picture: np.ndarray) -> None:
        self._picture = picture
        if self._image is None:
            with self._folder:
                self._image = self._desk.gui.add_image(picture)
        else:
            self._image.image = picture
        self._larger.visible = True

    def _on_larger(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client is None or self._picture is None:
            return
        with event.client.gui.add_modal("What accuracy costs"):
            event.client.gui.add_image(self._picture)


def diagram(scene: str, progress: Callable[[int, int], None]) -> np.ndarray:
    """(H, W, 3) uint8: the work-precision diagram of one experiment, measured now."""
    experiment = EXPERIMENTS[scene]
    total, done = runs_of([experiment], repeats=1), 0

    def tell() -> None:
        nonlocal done
        done += 1
        progress(done, total)

    return as_image(measure([experiment], repeats=1, progress=tell))
