"""What effects cost in time: steps from the same moment of a scene, with the code of one of them and without it.

Two copies of the scene take turns step by step, so that what slows the machine for a while slows both; and what is told
is the median of the differences. Nobody else's world is touched.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from engine import EFFECTS, SOLVERS, Snapshot, StepError, World
from engine.effects import Effect
from sandbox.simulation import TIME_STEP

SECONDS = 5.0  # that a measurement lasts; longer where a few rounds of large scenes take longer
FEWEST_ROUNDS = 3
WARM_UP = 2  # steps after a restored snapshot, until pairs are found and tables made
TIMED = 8  # steps after those
STRIDE = 15  # steps from one moment to the next
STEPS_TIMED = 100  # for the time of a step as it is


Code = tuple[frozenset[str], frozenset[str]]  # effects that are forced, effects that are suppressed
AS_IT_IS: Code = (frozenset(), frozenset())
Progress = Callable[[float], object]  # is told what part is done

# Effects whose code runs when somebody asks, not in a step: asked once a step.
ON_REQUEST: dict[str, Callable[[World], object]] = {
    "diagnostics": lambda world: world.diagnostics(),
    "explosions": lambda world: world.explode((0.0, 0.0), radius=0.0, impulse=0.0),
}


@dataclass(frozen=True)
class Ablation:
    """One effect, and the two ways to run a step that differ in its code alone."""

    name: str
    without: Code
    with_it: Code
    request: Callable[[World], object] | None = None

    @classmethod
    def of(cls, effect: Effect, called_for: bool) -> Ablation:
        """An effect in use is left out; another is forced, along with what it needs."""
        nothing: frozenset[str] = frozenset()
        request = ON_REQUEST.get(effect.name)
        if called_for:
            return cls(effect.name, (nothing, frozenset({effect.name})), (nothing, nothing), request)
        needed = frozenset({effect.needs}) if effect.needs else nothing
        return cls(effect.name, (needed, nothing), (needed | {effect.name}, nothing), request)


def everything_idle(world: World) -> Ablation:
    """All at once that the world does not call for."""
    idle = frozenset(one.name for one in ablations(world) if one.with_it != AS_IT_IS and one.request is None)
    return Ablation("everything idle", AS_IT_IS, (idle, frozenset()))


def ablations(world: World) -> list[Ablation]:
    """All effects that the world's solver knows."""
    lacking = SOLVERS[world.solver].lacks
    called_for = {status.name for status in world.effects if status.called_for}
    return [Ablation.of(effect, effect.name in called_for) for effect in EFFECTS if effect.name not in lacking]


@dataclass(frozen=True)
class Difference:
    """A median of differences, and how far it may be off by chance."""

    median: float  # [us]
    noise: float  # two standard errors of a median of so many [us]

    @classmethod
    def of(cls, values: np.ndarray) -> Difference:
        """From the spread of the values: 1.57 quartile ranges / sqrt(n) either way (R. McGill et al., "Variations of
        Box Plots", 1978).
        """
        low, median, high = np.percentile(values, (25, 50, 75))
        return cls(float(median), float(1.57 * (high - low) / np.sqrt(len(values))))

    @property
    def is_noise(self) -> bool:
        return abs(self.median) <= self.noise


def measure(
    source: World | Snapshot,
    *,
    dt: float = TIME_STEP,
    seconds: float = SECONDS,
    names: Collection[str] | None = None,
    progress: Progress | None = None,
) -> dict[str, float]:
    """What each effect costs [us a step]: what it adds to a step where the scene calls for it, and what it would add
    where it does not. From how the source is now; it is only read, so take a snapshot where another thread steps it.

    names: of effects, all if left out. Effects that the solver lacks are left out. Kernels release the interpreter, so
    on a thread of its own this hinders others little.
    """
    snapshot = source.snapshot() if isinstance(source, World) else source
    wanted = [one for one in ablations(copy_of(snapshot)) if names is None or one.name in names]
    found = compare_all(snapshot, wanted, dt=dt, seconds=seconds, progress=progress)
    return {name: difference.median for name, difference in found.items()}


def compare_all(
    snapshot: Snapshot,
    wanted: Sequence[Ablation],
    *,
    dt: float = TIME_STEP,
    seconds: float = SECONDS,
    progress: Progress | None = None,
) -> dict[str, Difference]:
    """What each of them costs [us a step]. One whose steps fail is left out."""
    pair = copy_of(snapshot), copy_of(snapshot)
    for one in wanted:  # compiled before anything is timed
        compare(pair, snapshot, one, dt)
    differences: dict[str, list[np.ndarray]] = {one.name: [] for one in wanted}
    started = time.perf_counter()
    done = 0.0
    rounds = 0
    while done < 1.0:
        for one in wanted:
            if (found := compare(pair, snapshot, one, dt)) is not None:
                differences[one.name].append(found)
        snapshot = later(pair[0], snapshot, dt)
        rounds += 1
        done = min((time.perf_counter() - started) / seconds, rounds / FEWEST_ROUNDS)
        if progress is not None:
            progress(min(done, 1.0))
    return {name: Difference.of(np.concatenate(found)) for name, found in differences.items() if found}


def compare(pair: tuple[World, World], snapshot: Snapshot, one: Ablation, dt: float) -> np.ndarray | None:
    """(TIMED,) what the effect adds to each step after a moment [us]; None if a step failed."""
    without, with_it = pair
    begin(without, snapshot, one.without)
    begin(with_it, snapshot, one.with_it)
    added = np.empty(TIMED)
    try:
        for _ in range(WARM_UP):
            without.step(dt)
            with_it.step(dt)
        for k in range(TIMED):
            if k % 2 == 0:
                less = timed_step(without, dt)
                more = timed_step(with_it, dt, one.request)
            else:
                more = timed_step(with_it, dt, one.request)
                less = timed_step(without, dt)
            added[k] = more - less
    except StepError:  # without its joints or its gravity a scene may come to anything
        return None
    return added


def timed_step(world: World, dt: float, request: Callable[[World], object] | None = None) -> float:
    """CPU time of a step and of what is asked for after it [us]."""
    before = time.thread_time_ns()
    world.step(dt)
    if request is not None:
        request(world)
    return 1e-3 * (time.thread_time_ns() - before)


def step_time(source: World | Snapshot, dt: float = TIME_STEP) -> float:
    """Median CPU time of a step as it is [us]. Only reads the source."""
    snapshot = source.snapshot() if isinstance(source, World) else source
    world = copy_of(snapshot)
    for _ in range(WARM_UP):
        world.step(dt)
    return float(np.median([timed_step(world, dt) for _ in range(STEPS_TIMED)]))


def copy_of(snapshot: Snapshot) -> World:
    """A world of its own."""
    world = World(precision=snapshot.settings.precision)
    world.restore(snapshot)
    return world


def begin(world: World, snapshot: Snapshot, code: Code) -> None:
    """Takes the world to a moment, with such code."""
    state = world._state
    state.load(snapshot.tables)
    state.forced, state.suppressed = code


def later(world: World, snapshot: Snapshot, dt: float) -> Snapshot:
    """The scene some steps on; from its beginning again if it cannot go on."""
    begin(world, snapshot, AS_IT_IS)
    try:
        for _ in range(STRIDE):
            world.step(dt)
    except StepError:
        return snapshot
    return world.snapshot()
