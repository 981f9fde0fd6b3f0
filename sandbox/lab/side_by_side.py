"""One scene stepped by several solvers at once: the live one, and beside it a simulation of its own for each other.

They begin with the scene, and are given the same commands before the same steps, but for those that choose a solver.
Stepping happens on a thread; who draws asks for the latest outlines.
"""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Callable, Mapping
from typing import Any

from engine import StepError
from sandbox.commands import command_from_dict
from sandbox.frame import Frame
from sandbox.simulation import Simulation

OWN = frozenset({"solver", "substeps", "iterations"})  # settings that each solver keeps for itself
MOST_WAITING = 600  # steps that it may lag behind
REHEARSED = 2  # steps that compile what a solver calls

Say = Callable[[str], None]


class SideBySide:
    """A viewer of a session, which follows its steps with other solvers.

    say: is told what goes wrong, and when nothing does: "".
    """

    def __init__(self, say: Say) -> None:
        self._say = say
        self._queue: queue.Queue[Frame | None] = queue.Queue(MOST_WAITING)
        self._solvers: tuple[str, ...] = ()
        self._simulations: dict[str, Simulation] = {}
        self._lost: dict[str, str] = {}
        self._step = -1
        self._scene = ""
        self._latest: Mapping[str, Frame] = {}
        self._lock = threading.Lock()  # held by who changes the simulations
        self._thread: threading.Thread | None = None

    # --- from any thread ----------------------------------------------------------------------------------------

    @property
    def frames(self) -> Mapping[str, Frame]:
        """The latest frame of each solver that is compared."""
        return self._latest

    def choose(self, solvers: tuple[str, ...], like: Frame) -> None:
        """Compares with these from the scene's next beginning. Compiles what they call for, which may take a while."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="tumble-compare", daemon=True)
            self._thread.start()
        with self._lock:
            self._solvers, self._simulations, self._latest = solvers, {}, {}
            self._step = -1
            self._lost = {}
            for solver in solvers:
                self._rehearse(solver, like)
        self._tell()

    def show(self, frame: Frame) -> None:
        """A frame of the session, on the session's thread."""
        if self._solvers:
            try:
                self._queue.put_nowait(frame)
            except queue.Full:
                self._solvers = ()
                self._say("the comparison could not keep up, and ended")

    def close(self) -> None:
        self._solvers = ()
        with contextlib.suppress(queue.Full):  # then its thread, which keeps nothing alive, waits no more either
            self._queue.put_nowait(None)

    # --- the thread ---------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while (frame := self._queue.get()) is not None:
            with self._lock:
                if not self._solvers:
                    self._latest = {}
                else:
                    self._take(frame)

    def _take(self, frame: Frame) -> None:
        if frame.step == 0 or (frame.step == 1 and self._step != 0):  # a session in a hurry does not show its start
            self._begin(frame)
        if frame.step and self._simulations and frame.scene == self._scene:
            self._follow(frame)

    def _begin(self, frame: Frame) -> None:
        """The scene is at its start, or one step from it."""
        self._simulations = {}
        for solver in self._solvers:
            if solver not in self._lost and (made := self._made(solver, frame)) is not None:
                self._simulations[solver] = made
        self._step, self._scene = 0, frame.scene
        self._publish()

    def _follow(self, frame: Frame) -> None:
        if frame.step == self._step:  # it stands still
            return
        if frame.step != self._step + 1:  # gone back, after a step that failed
            self._simulations, self._latest = {}, {}
            self._say("the scene did not go on step by step: reset it to compare again")
            return
        self._step = frame.step
        for solver, simulation in list(self._simulations.items()):
            try:
                apply_all(simulation, frame.commands)
                simulation.step()
            except StepError as error:
                del self._simulations[solver]
                self._lost[solver] = str(error)
                self._tell()
        if self._queue.empty():
            self._publish()

    def _publish(self) -> None:
        self._latest = {solver: simulation.frame() for solver, simulation in self._simulations.items()}

    def _made(self, solver: str, like: Frame) -> Simulation | None:
        """The scene with another solver, with its own numbers; None if it cannot have it."""
        settings = like.settings.to_dict()
        for name in OWN:
            del settings[name]
        try:
            return Simulation(like.scene, like.dt, solver=solver, **settings)
        except ValueError as error:
            self._lost[solver] = str(error)
            self._tell()
            return None

    def _rehearse(self, solver: str, like: Frame) -> None:
        try:
            simulation = self._made(solver, like)
            for _ in range(REHEARSED if simulation is not None else 0):
                simulation.step()  # type: ignore[union-attr]
        except StepError as error:
            self._lost[solver] = str(error)

    def _tell(self) -> None:
        self._say("; ".join(f"{solver}: {why}" for solver, why in self._lost.items()))


def apply_all(simulation: Simulation, commands: tuple[dict[str, Any], ...]) -> None:
    """What the live scene was told; what this one cannot do it goes without."""
    for values in commands:
        if values.get("command") == "set" and values.get("setting") in OWN:
            continue
        try:
            simulation.apply(command_from_dict(values))
        except ValueError:
            continue
