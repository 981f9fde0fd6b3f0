"""After the substeps: speeds are held to the largest one, and bodies that went far are found; see engine/continuous."""

from __future__ import annotations

import numpy as np

from engine.continuous.fast import NO_LIMIT
from engine.jit import kernel
from engine.lanes import absolute, const, eight_of, holds_somewhere
from engine.simd import WIDTH
from engine.solvers.soft_step.movers import hold_speed, load, store
from engine.vec2 import dot


@kernel
def is_fast(mover, slowest):
    """Whether a body goes further than `slowest.way`; spin counts with its reach."""
    way = abs(np.float64(mover.dx)) + abs(np.float64(mover.dy)) + abs(np.float64(mover.turned)) * slowest.reach
    return slowest.way < NO_LIMIT and way > slowest.way  # nobody, who fills up lanes, has no limit, and may go anywhere


@kernel
def find_fast(dynamic, movers, slowest, fast, steps):
    """Holds velocities to the largest speed, writes the rows of fast bodies into `fast`, and returns how many.

    dynamic: rows, filled up to a multiple of eight with nobody's. slowest (engine/continuous/fast.py), fast: None where
    continuous collision is not called for.
    """
    step = steps[0]
    found = 0 * len(dynamic)
    for k in range(len(dynamic) // WIDTH):
        rows = eight_of(dynamic, WIDTH * k)
        mover = load(movers, rows)
        squared = dot(mover.v, mover.v)
        if holds_somewhere(squared > step.maximum_speed * step.maximum_speed):
            store(movers, rows, hold_speed(mover.v, step.maximum_speed), mover.w, mover.turned)
        if slowest is not None:
            of_all = slowest[len(slowest) - 1]
            turned = absolute(mover.turned) * const(of_all.reach, squared)
            way = absolute(mover.d.x) + absolute(mover.d.y) + turned
            if holds_somewhere(way > const(of_all.way, squared)):
                for place in range(WIDTH * k, WIDTH * k + WIDTH):
                    row = dynamic[place]
                    if is_fast(movers[row], slowest[row]):
                        fast[found] = row
                        found += 1
    return found
