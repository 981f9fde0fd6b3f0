"""How fast a scene steps, beside other engines that step a copy of it.

All engines start from the same state and take turns, a block of steps each, in one run: what slows the machine down for
a while slows all of them down, and a ratio compares the same steps of the same scene. Times are CPU times of whole
steps, seen from outside: ours include what Python does between two kernels.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from itertools import chain
from typing import Any, Protocol

import numpy as np

from engine import STAGES, World
from sandbox.lab.peers import CannotMirror, Peer, PeerError, PeerWorld
from sandbox.lab.timing import Ratio, Times, time_steps
from sandbox.scenes import Scene
from sandbox.simulation import TIME_STEP

BLOCK = 20  # steps a turn: enough that the first, on cold caches, weighs little
WARM_UP_STEPS = 20  # of a separate world: whatever compiles or is loaded once is then out of the way
SAME_PLACE = 1e-5  # relative; a copy may round positions to single precision

Say = Callable[[str], None]
Progress = Callable[[int], None]  # is told how many steps were made


@dataclass(frozen=True)
class PeerResult:
    """One other engine's time for the same steps [ms], and our time over its."""

    ms_median: float
    wall_ms_median: float
    ratio: Ratio

    def to_dict(self) -> dict[str, float]:
        """As JSON takes it."""
        return {
            "ms_median": self.ms_median,
            "wall_ms_median": self.wall_ms_median,
            "ratio": self.ratio.median,
            "ratio_low": self.ratio.low,
            "ratio_high": self.ratio.high,
        }


@dataclass(frozen=True)
class BenchResult:
    """One scene's times [ms]: CPU times of whole steps, wall times of their stages."""

    scene: str
    bodies: int
    contacts: int  # after the last step
    steps: int
    ms_median: float
    ms_min: float
    ms_p99: float
    wall_ms_median: float
    stages: dict[str, float]  # medians, in the order of the step
    peers: dict[str, PeerResult]

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        peers = {name: result.to_dict() for name, result in self.peers.items()}
        return {"scene": self.scene, "threads": 1, **vars(self), "stages": dict(self.stages), "peers": peers}


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
        return {name: float(ms) for (name, _), ms in zip(STAGES, medians, strict=True)}

    def _keep_stages(self) -> None:
        self._stage_rows.append(list(self.world.stage_times.values()))


def bench(scene: Scene, peers: Sequence[Peer], steps: int, progress: Progress, say: Say) -> BenchResult:
    """Steps the scene and its copies in the peers. A peer that cannot copy it is left out, and `say` hears why."""
    _warm_up(scene)
    ours = TimedWorld(scene.make(), TIME_STEP)
    with ExitStack() as stack:
        copies: dict[str, PeerWorld] = {}
        for peer in peers:
            try:
                copies[peer.name] = stack.enter_context(closing(peer.mirror(ours.world, TIME_STEP)))
            except CannotMirror as error:
                say(f"{scene.name}: left out {peer.name}: {error}")
            else:
                _check_copy(peer.name, copies[peer.name], ours.world)
        blocks, *peer_blocks = take_turns([ours, *copies.values()], steps, progress)
    times = Times.joined(blocks)
    return BenchResult(
        scene=scene.name,
        bodies=ours.world.body_count,
        contacts=ours.world.diagnostics().contact_count,
        steps=steps,
        ms_median=float(np.median(times.cpu)),
        ms_min=float(times.cpu.min()),
        ms_p99=float(np.percentile(times.cpu, 99)),
        wall_ms_median=float(np.median(times.wall)),
        stages=ours.stages(),
        peers={name: _compare(blocks, theirs) for name, theirs in zip(copies, peer_blocks, strict=True)},
    )


def take_turns(steppers: Sequence[Stepper], steps: int, progress: Progress) -> list[list[Times]]:
    """Each makes all the steps, a block at a time; the times of each one's blocks."""
    blocks: list[list[Times]] = [[] for _ in steppers]
    for turn, count in enumerate(_block_sizes(steps)):
        order = range(len(steppers))
        # Every other time the other way round: nobody always follows the same neighbour's caches.
        for i in order if turn % 2 == 0 else reversed(order):
            blocks[i].append(steppers[i].step(count))
        progress(count)
    return blocks


def _block_sizes(steps: int) -> Iterator[int]:
    """Full blocks and what is left."""
    whole, rest = divmod(steps, BLOCK)
    return chain([BLOCK] * whole, [rest] if rest else [])


def _compare(ours: Sequence[Times], theirs: Sequence[Times]) -> PeerResult:
    times = Times.joined(theirs)
    return PeerResult(float(np.median(times.cpu)), float(np.median(times.wall)), Ratio.between(ours, theirs))


def _warm_up(scene: Scene) -> None:
    world = scene.make()
    for _ in range(WARM_UP_STEPS):
        world.step(TIME_STEP)


def _check_copy(name: str, copy: PeerWorld, world: World) -> None:
    """A comparison with another scene would be worth nothing. PeerError if the copy's bodies stand elsewhere."""
    positions = copy.positions()
    if not np.allclose(positions, world.positions, rtol=SAME_PLACE, atol=SAME_PLACE):
        raise PeerError(f"{name}: its copy of the scene differs from ours")
