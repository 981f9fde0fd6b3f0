"""Solvers: one file or folder a method, one line here; solver.py says what a solver is."""

from __future__ import annotations

from engine.solvers import avbd, direct, ngs, sequential_impulses, soft_step, xpbd
from engine.solvers.solver import Solver

SOLVERS: dict[str, Solver] = {
    solver.name: solver
    for solver in (
        soft_step.SOFT_STEP,
        sequential_impulses.SEQUENTIAL_IMPULSES,
        ngs.NGS,
        xpbd.XPBD,
        avbd.AVBD,
        direct.DIRECT,
    )
}
