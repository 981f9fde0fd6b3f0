"""How long steps take, and how two engines that took turns compare."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Times:
    """Times of some steps, one after the other: (n,) float64 [ms]."""

    cpu: np.ndarray  # of all threads of the process that made them: what another process on the core does is not in it
    wall: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence[Times]) -> Times:
        """Several blocks as one."""
        return cls(np.concatenate([part.cpu for part in parts]), np.concatenate([part.wall for part in parts]))


@dataclass(frozen=True)
class Figures:
    """What there is to say of the times of many steps [ms]."""

    median: float
    least: float
    p99: float  # 99 % of the steps took no longer

    @classmethod
    def of(cls, times: np.ndarray) -> Figures:
        """times (n,) [ms]."""
        return cls(float(np.median(times)), float(times.min()), float(np.percentile(times, 99)))

    def to_dict(self, prefix: str) -> dict[str, float]:
        """As JSON takes it, under names that begin with the prefix."""
        return {f"{prefix}_median": self.median, f"{prefix}_min": self.least, f"{prefix}_p99": self.p99}


@dataclass(frozen=True)
class Ratio:
    """Our time over theirs: the median over blocks of steps, and its quartiles."""

    median: float
    low: float
    high: float

    @classmethod
    def between(cls, ours: Sequence[Times], theirs: Sequence[Times], clock: str = "cpu") -> Ratio:
        """Compares block with block: both made the same steps of the same scene, one right after the other.

        clock: "cpu" or "wall".
        """
        ratios = [
            getattr(our, clock).sum() / getattr(their, clock).sum() for our, their in zip(ours, theirs, strict=True)
        ]
        low, median, high = np.percentile(ratios, (25, 50, 75))
        return cls(float(median), float(low), float(high))

    def to_dict(self, prefix: str) -> dict[str, float]:
        """As JSON takes it, under names that begin with the prefix."""
        return {prefix: self.median, f"{prefix}_low": self.low, f"{prefix}_high": self.high}


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


@contextmanager
def no_collection() -> Iterator[None]:
    """Puts off Python's collecting of garbage: it would look at one engine's thousands of handles in another's time."""
    was_on = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
