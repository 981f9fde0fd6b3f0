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
from sandbox.commands import Set, SetAll, command_from_dict
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
        self._lost: dict[str, str] = {}  # why a solver is not there, a sentence each
        self._ended = ""  # why it follows no more
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

    @property
    def ended(self) -> bool:
        """Whether it could not keep up, and follows nothing until it is asked again."""
        return bool(self._ended)

    def choose(self, solvers: tuple[str, ...], like: Frame) -> None:
        """Compares with these from the scene's next beginning. Compiles what they call for, which may take a while."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="tumble-compare", daemon=True)
            self._thread.start()
        self._ended = ""
        self._solvers = ()  # what is shown while this compiles is not kept: the scene begins again afterwards
        with self._lock:
            self._simulations, self._latest = {}, {}
            self._step = -1
            self._lost = {}
            for solver in solvers:
                self._rehearse(solver, like)
            self._forget_waiting()
            self._solvers = solvers
        self._tell()

    def show(self, frame: Frame) -> None:
        """A frame of the session, on the session's thread."""
        if self._solvers:
            try:
                self._queue.put_nowait(frame)
            except queue.Full:
                self._solvers = ()
                self._ended = "the comparison could not keep up, and ended"
                self._tell()

    def close(self) -> None:
        self._solvers = ()
        with contextlib.suppress(queue.Full):  # then its thread, which keeps nothing alive, waits no more either
            self._queue.put_nowait(None)

    # --- the thread ---------------------------------------------------------------------------------------------

    def _forget_waiting(self) -> None:
        """Frames from before."""
        with contextlib.suppress(queue.Empty):
            while self._queue.get_nowait() is not None:
                pass
            self._queue.put_nowait(None)  # that it closes is no frame

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
        """The scene is at its start, or one step from it: all that can have it begin, whatever happened before."""
        self._simulations, self._lost = {}, {}
        for solver in self._solvers:
            if (made := self._made(solver, frame)) is not None:
                self._simulations[solver] = made
        self._step, self._scene = 0, frame.scene
        self._tell()
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
            except (
                StepError,
                ValueError,
            ) as error:  # a step that failed, or a command refused
                del self._simulations[solver]
                self._lost[solver] = f"{solver} stopped following: {error}"
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
            self._lost[solver] = f"{solver}: {error}"
            return None

    def _rehearse(self, solver: str, like: Frame) -> None:
        try:
            simulation = self._made(solver, like)
            for _ in range(REHEARSED if simulation is not None else 0):
                simulation.step()  # type: ignore[union-attr]
        except StepError as error:
            self._lost[solver] = f"{solver}: {error}"

    def _tell(self) -> None:
        self._say(self._ended or "; ".join(self._lost.values()))


def apply_all(simulation: Simulation, commands: tuple[dict[str, Any], ...]) -> None:
    """What the live scene was told, but for what each solver keeps for itself. ValueError if this one cannot do it."""
    for values in commands:
        command = command_from_dict(values)
        left = without_own(command) if isinstance(command, Set | SetAll) else command
        if left is not None:
            simulation.apply(left)


def without_own(command: Set | SetAll) -> SetAll | None:
    """What is left of it without the settings that each solver keeps for itself; None if nothing is."""
    pairs = command.settings if isinstance(command, SetAll) else ((command.setting, command.value),)
    left = {name: value for name, value in pairs if name not in OWN}
    return SetAll(left) if left else None
