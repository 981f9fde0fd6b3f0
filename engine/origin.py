"""Where the geometry of a pair is reckoned from.

In single precision from the centre of its first body, so that a float32 holds small differences and a scene far from
the origin behaves as one at it. In double precision from the world's own origin, as Box2D Lite does: rounding like its
own, not only as small, is what keeps ten seconds of dominos within 1e-9 m of it (2e-8 m otherwise).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.core import types
from numba.extending import overload

from engine.jit import kernel
from engine.lanes import const
from engine.simd import Lanes
from engine.vec2 import Vec2


def origin_of(body: Any, lane: Any) -> Vec2:
    """The point from which positions around `body` are reckoned, for a solver of that lane [m]."""
    return Vec2(body.center_x, body.center_y) if lane.dtype == np.float32 else Vec2(0.0, 0.0)


@overload(origin_of)
def _origin_of(body, lane):
    if lane == types.float32 or lane == Lanes(types.float32):
        return lambda body, lane: Vec2(body.center_x, body.center_y)
    return lambda body, lane: Vec2(0.0, 0.0)


@kernel
def center_of(body, origin, lane):
    """The centre of mass of a body as seen from the origin, in the lane's width [m]."""
    return Vec2(const(body.center_x - origin.x, lane), const(body.center_y - origin.y, lane))
