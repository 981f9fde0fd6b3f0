"""What the bench finds out about a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sandbox.lab.timing import Figures, Ratio


@dataclass(frozen=True)
class PeerResult:
    """One other engine's time for the same steps [ms], and our time over its."""

    ms_median: float
    wall_ms_median: float
    ratio: Ratio  # of CPU times
    wall_ratio: Ratio

    def to_dict(self) -> dict[str, float]:
        """As JSON takes it."""
        return {
            "ms_median": self.ms_median,
            "wall_ms_median": self.wall_ms_median,
            **self.ratio.to_dict("ratio"),
            **self.wall_ratio.to_dict("wall_ratio"),
        }


@dataclass(frozen=True)
class BenchResult:
    """One scene's times, and how large it is after the last step."""

    scene: str
    threads: int
    bodies: int
    contacts: int
    joints: int
    colours: tuple[int, ...]  # contact constraints in each
    overflow: int  # and in none
    after: float  # simulated time before the first step that was timed [s]
    steps: int
    peak_memory: float  # of the process so far, peers and all [MB]
    cpu: Figures
    wall: Figures
    stages: dict[str, float]  # medians of wall time [ms], in the order of the step
    peers: dict[str, PeerResult]
    left_out: dict[str, str]  # peers that cannot copy the scene, and why

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {
            "scene": self.scene,
            "threads": self.threads,
            "bodies": self.bodies,
            "contacts": self.contacts,
            "joints": self.joints,
            "colours": list(self.colours),
            "overflow": self.overflow,
            "after_s": self.after,
            "steps": self.steps,
            "peak_memory_mb": self.peak_memory,
            **self.cpu.to_dict("ms"),
            **self.wall.to_dict("wall_ms"),
            "stages": dict(self.stages),
            "peers": {name: result.to_dict() for name, result in self.peers.items()},
            "left_out": dict(self.left_out),
        }
