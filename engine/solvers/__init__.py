"""Solvers: one file a method, one line here.

A solver is `solve(bodies, motions, arbiters, contacts, count, joints, joint_order, steps)`: it changes the
velocities in `motions` so that the constraints hold, and keeps the impulses that it needed for it. `joints` is None
where a world has none, `steps` is one row of step_dtype.
"""

from __future__ import annotations

from engine.solvers import sequential_impulses

SOLVERS = {"sequential_impulses": sequential_impulses.solve}
