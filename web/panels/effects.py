"""Every effect that the engine has: which ones this scene calls for, why, and what each costs."""

from __future__ import annotations

import html
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

import viser

from engine.effects import EffectStatus
from sandbox.frame import Frame
from web.panels.desk import Desk
from web.theme import PLOT_LINES


class Cost(NamedTuple):
    """What an effect costs, or would cost where it is not called for; None: not measured."""

    step_us: float | None = None  # a step with its code, less one without it [us]
    compile_s: float | None = None  # to compile that code [s]


Costs = Mapping[str, Cost]  # by the effects' names
Measure = Callable[[], Iterable[Costs]]  # of the running scene, more of it each time; on a thread of its own

UNMEASURED: Costs = {}
ON = PLOT_LINES[2]
_ROW = (
    '<div style="display:grid;grid-template-columns:9px 1fr auto;gap:2px 7px;align-items:baseline;padding:2px 0;'
    'opacity:{opacity}"><i style="width:7px;height:7px;border-radius:50%;background:{dot}"></i>'
    '<span>{name}</span><span style="white-space:nowrap">{cost}</span>'
    '<span style="grid-column:2/4;opacity:.65;font-size:.9em;line-height:1.25">{because}</span></div>'
)
_TITLE = '<div style="opacity:.65;padding:0 0 3px">{} of {} called for by this scene</div>'
_LEGEND = '<div style="opacity:.65;padding:6px 0 0">µs: a step with it, less one without; s: to compile it</div>'
IDLE, BUSY = "Measure their costs", "Measuring ..."
_PAGE = '<div style="padding:2px 14px 8px;font-size:.85em;line-height:1.4;font-variant-numeric:tabular-nums">{}</div>'


class EffectsPanel:
    """A live table, and a button for the costs where there is something that measures them."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._measure = desk.measure_effects
        self._costs: Costs = UNMEASURED
        self._shown: tuple[tuple[EffectStatus, ...], Costs] = ((), UNMEASURED)
        self._scene = ""
        self._busy = threading.Lock()
        with desk.gui.add_folder("Effects", expand_by_default=False):
            self._table = desk.gui.add_html(effects_html(()))
            if self._measure is not None:
                self._button = desk.gui.add_button(
                    IDLE,
                    icon=viser.Icon.CLOCK_PLAY,
                    hint="steps a copy of the scene with and without each; compiling them as well takes minutes",
                )
                self._button.on_click(self._on_measure)

    def update(self, frame: Frame) -> None:
        if frame.scene != self._scene:
            self._scene, self._costs = frame.scene, UNMEASURED
        if (frame.effects, self._costs) != self._shown:
            self._shown = (frame.effects, self._costs)
            self._table.content = effects_html(frame.effects, self._costs)

    async def _on_measure(self, _: object) -> None:
        """On a thread that does not keep the program alive; a second press meanwhile does nothing."""
        if self._busy.acquire(blocking=False):
            threading.Thread(target=self._run, name="tumble-measure", daemon=True).start()

    def _run(self) -> None:
        scene = self._scene
        self._button.disabled, self._button.label = True, BUSY
        try:
            for costs in self._measure() if self._measure is not None else ():
                if scene != self._scene:
                    break
                self._costs = costs
                self._desk.page.publisher.again()
        except Exception as error:  # noqa: BLE001 - whatever it is, the page goes on and says so
            self._desk.page.report("the effects could not be measured: %s", error)
            self._desk.page.notify("Not measured", str(error))
        finally:
            self._button.disabled, self._button.label = False, IDLE
            self._busy.release()


def effects_html(effects: tuple[EffectStatus, ...], costs: Costs = UNMEASURED) -> str:
    """Those that are called for first, otherwise in the engine's order."""
    if not effects:
        return _PAGE.format("waiting for the first frame")
    called = [effect for effect in effects if effect.called_for]
    others = [effect for effect in effects if not effect.called_for]
    rows = "".join(_row(effect, costs.get(effect.name, Cost())) for effect in (*called, *others))
    return _PAGE.format(_TITLE.format(len(called), len(effects)) + rows + (_LEGEND if costs else ""))


def _row(effect: EffectStatus, cost: Cost) -> str:
    return _ROW.format(
        opacity=1.0 if effect.called_for else 0.55,
        dot=ON if effect.called_for else "#808080",
        name=html.escape(effect.name),
        because=html.escape(effect.because),
        cost=_cost(effect.called_for, cost),
    )


def _cost(called_for: bool, cost: Cost) -> str:
    """Of an effect in use its share of a step, of another what leaving it out saves."""
    parts = []
    if cost.step_us is not None:
        parts.append(f"{max(cost.step_us, 0.0):.1f} µs")  # below zero is noise
    if cost.compile_s is not None:
        parts.append(f"{cost.compile_s:.1f} s")
    return f"{'' if called_for else 'saves '}{' · '.join(parts)}" if parts else ""
