"""How long steps take, and how two engines that took turns compare."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Times:
    """Times of some steps, one after the other: (n,) float64 [ms]."""

    cpu: np.ndarray  # of the process that made them: what another process on the core does is not in it
    wall: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence[Times]) -> Times:
        """Several blocks as one."""
        return cls(np.concatenate([part.cpu for part in parts]), np.concatenate([part.wall for part in parts]))


@dataclass(frozen=True)
class Ratio:
    """Our time over theirs: the median over blocks of steps, and its quartiles."""

    median: float
    low: float
    high: float

    @classmethod
    def between(cls, ours: Sequence[Times], theirs: Sequence[Times]) -> Ratio:
        """Compares block with block: both made the same steps of the same scene, one right after the other."""
        ratios = [our.cpu.sum() / their.cpu.sum() for our, their in zip(ours, theirs, strict=True)]
        low, median, high = np.percentile(ratios, (25, 50, 75))
        return cls(float(median), float(low), float(high))


def time_steps(step: Callable[[], object], count: int, after: Callable[[], object] | None = None) -> Times:
    """Times `count` calls of `step`, each by itself; `after` is called after each and not timed."""
    cpu, wall = np.empty(count), np.empty(count)
    for i in range(count):
        wall_before = time.perf_counter()
        cpu_before = time.process_time()
        step()
        cpu[i] = time.process_time() - cpu_before
        wall[i] = time.perf_counter() - wall_before
        if after is not None:
            after()
    return Times(1e3 * cpu, 1e3 * wall)
