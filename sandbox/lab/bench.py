"""How fast a scene steps, beside other engines that step a copy of it.

Our world settles alone, where the scene has something that falls first. The peers are copied from there, so all start
from the same state; after a few steps that are not timed they take turns, a block of steps each, in one run: what slows
the machine down for a while slows all of them down, and a ratio compares the same steps of the same scene. Times are
CPU times of whole steps, and wall times, seen from outside: ours include what Python does between two kernels.
"""

from __future__ import annotations

import resource
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from itertools import chain
from typing import Protocol

import numpy as np

from engine import World
from sandbox.lab.bench_result import BenchResult, PeerResult
from sandbox.lab.bench_scenes import default_steps
from sandbox.lab.peers import CannotMirror, Peer, PeerError, PeerWorld
from sandbox.lab.timing import Figures, Ratio, Times, no_collection, time_steps
from sandbox.scenes import Scene
from sandbox.simulation import TIME_STEP

BLOCK = 20  # steps a turn: enough that the first, on cold caches, weighs little
RUN_IN = 20  # steps that all make before the first that is timed: impulses, caches and compiled code are then there
FAR = 10.0  # so far from all others a body may be, where these are close together [m]
SAME_PLACE = 1e-5  # relative; a copy may round positions to single precision

Say = Callable[[str], None]
Progress = Callable[[int, int], None]  # is told how many steps are made, and of how many


@dataclass(frozen=True)
class Plan:
    """What to measure."""

    scene: Scene
    after: float = 0.0  # simulated time before anything is timed [s]
    steps: int | None = None  # None: fewer, the more there is
    threads: int = 1


class Stepper(Protocol):
    """Our world or a copy of it: makes steps and times each."""

    def step(self, count: int) -> Times: ...


class TimedWorld:
    """Our world, stepped and timed; keeps the times of the stages too."""

    def __init__(self, world: World, dt: float) -> None:
        self.world = world
        self.dt = dt
        self._stage_rows: list[list[float]] = []

    def step(self, count: int) -> Times:
        return time_steps(lambda: self.world.step(self.dt), count, self._keep_stages)

    def stages(self) -> dict[str, float]:
        """Median wall time of each stage [ms]."""
        medians = 1e3 * np.median(self._stage_rows, axis=0)
        return {name: float(ms) for name, ms in zip(self.world.stage_times, medians, strict=True)}

    def forget(self) -> None:
        """Lets go of the stages' times so far."""
        self._stage_rows.clear()

    def _keep_stages(self) -> None:
        self._stage_rows.append(list(self.world.stage_times.values()))


class WatchedCopy:
    """A copy of our world that is stepped as long as it holds together: what flies apart is another scene."""

    def __init__(self, copy: PeerWorld, world: World) -> None:
        self._copy = copy
        self._world = world
        self._steps = 0
        self.apart = ""  # how it came apart

    def step(self, count: int) -> Times:
        """Steps that are not made any more take no time."""
        if self.apart:
            return Times(np.zeros(count), np.zeros(count))
        times = self._copy.step(count)
        self._steps += count
        if flown_apart(self._copy.positions(), self._world.positions):
            self.apart = f"its bodies have flown apart within {self._steps} steps"
        return times


def flown_apart(theirs: np.ndarray, ours: np.ndarray) -> bool:
    """Whether a body of theirs is further from all of ours than these are from each other; positions (N, 2) [m]."""
    if len(ours) == 0:
        return False
    low, high = ours.min(axis=0), ours.max(axis=0)
    reach = FAR + float((high - low).max())
    return not bool(np.all((theirs > low - reach) & (theirs < high + reach)))


def bench(world: World, plan: Plan, peers: Sequence[Peer], progress: Progress, say: Say) -> BenchResult:
    """Steps the scene's world and its copies in the peers.

    A peer that cannot copy it, or whose copy comes apart, is left out, and `say` hears why. Nothing sleeps, for what
    sleeps costs nothing.
    world: as the scene begins, with the plan's threads. PeerError, StepError if something breaks on the way.
    """
    steps = default_steps(world.body_count + world.joint_count) if plan.steps is None else plan.steps
    settling = round(plan.after / TIME_STEP)
    world.sleeping = False
    report = _Counter(progress, settling + RUN_IN + steps)
    for _ in range(settling):
        world.step(TIME_STEP)
        report(1)
    ours = TimedWorld(world, TIME_STEP)
    left_out: dict[str, str] = {}
    with ExitStack() as stack:
        copies: dict[str, WatchedCopy] = {}
        for peer in peers:
            try:
                copy = stack.enter_context(closing(peer.mirror(world, TIME_STEP)))
            except CannotMirror as error:
                left_out[peer.name] = str(error)
            else:
                _check_copy(peer.name, copy, world)
                copies[peer.name] = WatchedCopy(copy, world)
        steppers: list[Stepper] = [ours, *copies.values()]
        take_turns(steppers, RUN_IN, report)
        ours.forget()
        with no_collection():
            blocks, *peer_blocks = take_turns(steppers, steps, report)
    left_out |= {name: copy.apart for name, copy in copies.items() if copy.apart}
    for name, why in left_out.items():
        say(f"{plan.scene.name}: left out {name}: {why}")
    measured = [(name, times) for name, times in zip(copies, peer_blocks, strict=True) if name not in left_out]
    times = Times.joined(blocks)
    return BenchResult(
        scene=plan.scene.name,
        threads=plan.threads,
        bodies=world.body_count,
        contacts=world.diagnostics().contact_count,
        joints=world.joint_count,
        colours=tuple(int(count) for count in getattr(world, "colours", ())),
        overflow=int(getattr(world, "overflow", 0)),
        after=settling * TIME_STEP,
        steps=steps,
        peak_memory=peak_memory(),
        cpu=Figures.of(times.cpu),
        wall=Figures.of(times.wall),
        stages=ours.stages(),
        peers={name: _compare(blocks, theirs) for name, theirs in measured},
        left_out=left_out,
    )


class _Counter:
    """Adds up the steps that were made."""

    def __init__(self, progress: Progress, total: int) -> None:
        self._progress, self._total, self._done = progress, total, 0

    def __call__(self, count: int) -> None:
        self._done += count
        self._progress(self._done, self._total)


def take_turns(steppers: Sequence[Stepper], steps: int, made: Callable[[int], None]) -> list[list[Times]]:
    """Each makes all the steps, a block at a time; the times of each one's blocks."""
    blocks: list[list[Times]] = [[] for _ in steppers]
    for turn, count in enumerate(_block_sizes(steps)):
        order = range(len(steppers))
        # Every other time the other way round: nobody always follows the same neighbour's caches.
        for i in order if turn % 2 == 0 else reversed(order):
            blocks[i].append(steppers[i].step(count))
        made(count)
    return blocks


def _block_sizes(steps: int) -> Iterator[int]:
    """Full blocks and what is left."""
    whole, rest = divmod(steps, BLOCK)
    return chain([BLOCK] * whole, [rest] if rest else [])


def _compare(ours: Sequence[Times], theirs: Sequence[Times]) -> PeerResult:
    times = Times.joined(theirs)
    ratios = (Ratio.between(ours, theirs, clock) for clock in ("cpu", "wall"))
    return PeerResult(float(np.median(times.cpu)), float(np.median(times.wall)), *ratios)


def peak_memory() -> float:
    """The most that this process has held so far [MB]."""
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most / 2**20 if sys.platform == "darwin" else most / 2**10  # bytes there, kilobytes elsewhere


def _check_copy(name: str, copy: PeerWorld, world: World) -> None:
    """A comparison with another scene would be worth nothing. PeerError if the copy's bodies stand elsewhere."""
    positions = copy.positions()
    if not np.allclose(positions, world.positions, rtol=SAME_PLACE, atol=SAME_PLACE):
        raise PeerError(f"{name}: its copy of the scene differs from ours")
