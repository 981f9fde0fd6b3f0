"""What several tests of the sandbox share: sessions that end with the test, and viewers that can be waited for."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from engine import SHAPE_KINDS, SOLVERS
from sandbox import commands as ask
from sandbox.frame import Frame
from sandbox.session import Session
from sandbox.simulation import Simulation

PRECISIONS = ("single", "double")
SWITCHES = ("accumulate_impulses", "warm_starting", "position_correction", "recycling")
LARGEST = float(np.finfo(np.float32).max)  # no force may be added to such a velocity in single precision
PATIENCE = 60.0  # for what must come, on however busy a machine [s]


class Watcher:
    """Keeps every frame it is shown."""

    def __init__(self) -> None:
        self.frames: list[Frame] = []
        self.closed = False
        self._changed = threading.Condition()

    def show(self, frame: Frame) -> None:
        with self._changed:
            self.frames.append(frame)
            self._changed.notify_all()

    def close(self) -> None:
        self.closed = True

    def wait(self, wanted: Callable[[Frame], Any], seconds: float = PATIENCE) -> Frame:
        """The latest frame, once it is as wanted."""
        with self._changed:
            came = self._changed.wait_for(lambda: self.frames and wanted(self.frames[-1]), seconds)
            assert came, f"waited for another frame than {self.frames[-1] if self.frames else 'none'}"
            return self.frames[-1]

    def wait_for_step(self, step: int) -> Frame:
        return self.wait(lambda frame: frame.step >= step)


@contextmanager
def running(scene: str = "The Talk/Single Box", *, paused: bool = False, **options: Any) -> Iterator[tuple[Any, Any]]:
    """A session that runs, and its watcher."""
    session, watcher = Session(scene, **options), Watcher()
    session.add_viewer(watcher)
    if paused:
        session.submit(ask.Pause())
    session.start()
    try:
        yield session, watcher
    finally:
        session.close()


def step_by_step(session: Session, watcher: Watcher, steps: int) -> Frame:
    """Takes so many single steps and waits for the last."""
    target = watcher.wait(lambda frame: frame.status.paused).step + steps
    for _ in range(steps):
        session.submit(ask.StepOnce())
    return watcher.wait(lambda frame: frame.step == target)


def until(condition: Callable[[], Any], seconds: float = PATIENCE) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.002)


def bits(simulation: Simulation) -> tuple[bytes, str]:
    """All that a later step depends on."""
    return simulation.world.snapshot().to_bytes(), repr(simulation.extras())


def whole_frame(frame: Frame) -> tuple[Any, ...]:
    """All of a frame that must repeat, as bytes. A restored broad phase has other margins, and finds the same."""
    arrays = {name: value for name, value in vars(frame).items() if isinstance(value, np.ndarray) and name != "bounds"}
    return frame.step, frame.time, {name: value.tobytes() for name, value in arrays.items()}


class LivelyHands:
    """What busy visitors do: a few commands a step, those of one seed always the same."""

    def __init__(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self._dice = random.Random(seed)
        self._kinds = (
            self._spawn, self._spawn, self._bomb, self._gravity, self._switch, self._iterations, self._solver,
            self._grab, self._grab, self._grab, self._move, self._move, self._move, self._move, self._release,
        )  # fmt: skip
        self._hands = [0, 3, 17]

    def commands(self, simulation_positions: np.ndarray) -> list[ask.PhysicsCommand]:
        """What they do before the next step, knowing where bodies are."""
        self._positions = simulation_positions
        return [self._pick(self._kinds)() for _ in range(self._rng.integers(0, 4))]

    def _pick(self, options: Any) -> Any:
        return options[int(self._rng.integers(len(options)))]

    def _place(self) -> tuple[float, float]:
        return float(self._rng.uniform(-8.0, 8.0)), float(self._rng.uniform(1.0, 12.0))

    def _spawn(self) -> ask.Spawn:
        x, y = self._place()
        width, height = (float(size) for size in self._rng.uniform(0.2, 1.2, 2))
        mass = float(10.0 ** self._rng.uniform(-1.0, 3.0))
        shape = self._pick(SHAPE_KINDS)
        kind = "static" if shape in ask.LINES else "dynamic"
        count, corners = int(self._rng.integers(1, 4)), int(self._rng.integers(3, 9))
        angle = float(self._rng.uniform(-3.0, 3.0))
        return ask.Spawn(shape, x, y, width, height, mass, 0.5, count, kind, angle, corners=corners, rounding=0.05)

    def _bomb(self) -> ask.Bomb:
        return ask.Bomb.random(self._dice)

    def _gravity(self) -> ask.Set:
        return ask.Set("gravity", (float(self._rng.uniform(-3.0, 3.0)), float(self._rng.uniform(-20.0, 2.0))))

    def _switch(self) -> ask.Set:
        return ask.Set(self._pick(SWITCHES), bool(self._rng.integers(2)))

    def _iterations(self) -> ask.Set:
        return ask.Set("iterations", int(self._rng.integers(1, 15)))

    def _solver(self) -> ask.Set:
        return ask.Set("solver", self._pick(tuple(name for name in SOLVERS if name != "direct")))

    def _grab(self) -> ask.Grab:
        x, y = self._pick(self._positions)
        return ask.Grab(self._pick(self._hands), float(x), float(y))

    def _move(self) -> ask.MoveHand:
        return ask.MoveHand(self._pick(self._hands), *self._place())

    def _release(self) -> ask.Release:
        return ask.Release(self._pick(self._hands))


def make_unwritable(folder: Path) -> Path:
    """A place below `folder` where nobody, not even root, can make a folder."""
    blocker = folder / "blocker"
    blocker.write_text("a file, not a folder")
    return blocker / "runs"


class PushTooHard(ask.PhysicsCommand):
    """A command that no page can send: the next step fails."""

    name = "push_too_hard"

    def to_dict(self) -> dict[str, Any]:
        return {"command": self.name}

    def apply(self, simulation: Simulation) -> None:
        body = simulation.world.bodies[-1]
        body.velocity = (LARGEST, 0.0)
        body.force = (LARGEST, 0.0)
