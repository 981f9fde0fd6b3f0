"""Forces between centres of mass that fall off as 1 / d^2."""

from __future__ import annotations

import numpy as np

from engine.constants import CORE_RADIUS
from engine.effects.ahead import center_ahead
from engine.jit import kernel


@kernel
def centers_ahead(rows, bodies, motions, time):
    """(N, 2) places of these bodies' centres of mass a little later [m]: see ahead.py."""
    places = np.empty((len(rows), 2))
    for k in range(len(rows)):
        center = center_ahead(bodies[rows[k]], motions[rows[k]], time)
        places[k, 0] = center.x
        places[k, 1] = center.y
    return places


@kernel
def over_cube(x, y):
    """1 / d^3 for a way (x, y) of length d, but of CORE_RADIUS where it is shorter [1/m^3].

    Times the way, that is 1 / d^2 outside and falls off evenly to nothing inside, as in a uniform ball.
    """
    square = x * x + y * y
    if square < CORE_RADIUS * CORE_RADIUS:
        return 1.0 / (CORE_RADIUS * CORE_RADIUS * CORE_RADIUS)
    return 1.0 / (square * np.sqrt(square))
