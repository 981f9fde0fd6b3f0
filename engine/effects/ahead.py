"""Where bodies are when a force that depends on places is looked up.

Such a force is looked up once and held for the whole step. A solver of n substeps makes of it

    v1 = v0 + dt a,   x1 = x0 + dt v0 + (1/2) (1 + 1/n) dt^2 a

With a = a(x0) that is symplectic Euler for n = 1 alone; for more, things that orbit or bob gain energy by themselves:
the energy of an oscillator grows by the factor 1 + (1 - 1/n) (w dt)^2 / 2 in every step. With

    a = a(x0 + (1/2) (1 - 1/n) dt v0)

it is a drift, a kick and a drift. Each keeps areas in phase space, so nothing is gained, whatever n; and the more
substeps, the closer it is to the leapfrog method, of second order. (E. Hairer, C. Lubich, G. Wanner, "Geometric
Numerical Integration", on splitting methods.)
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel
from engine.vec2 import Vec2


@kernel
def time_ahead(step):
    """How far ahead of the step's beginning [s]."""
    return 0.5 * (1.0 - 1.0 / np.float64(step.parts)) * np.float64(step.dt)


@kernel
def center_ahead(body, motion, time):
    """The centre of mass a little later [m]."""
    return Vec2(body.center_x + time * np.float64(motion.vx), body.center_y + time * np.float64(motion.vy))


@kernel
def turn_ahead(motion, time):
    """The rotation until then: by 2 atan(w t / 2), which is a rotation whatever the angle."""
    half = 0.5 * time * np.float64(motion.w)
    square = half * half
    scale = 1.0 / (1.0 + square)
    return Vec2((1.0 - square) * scale, 2.0 * half * scale)
