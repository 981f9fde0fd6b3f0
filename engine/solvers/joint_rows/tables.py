"""What is kept of joints and of their scalar rows within a step: made afresh each time, so no part of a snapshot."""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.solvers.soft_step.joints.frames import BODY_FIELDS, FRAME_FIELDS
from engine.tables import REALS

X, Y, ACROSS_AXIS, TURN, ALONG_THE_AXIS, ALONG_THE_WAY = range(6)
"""What a row measures: the way from anchor to anchor along x, along y, across the axis; the angle of body2 over body1;
the way along the axis; its length."""

HOLDS, SPRINGS, DRIVES, LOWER, UPPER = range(5)
"""What a row is for: to hold a value; to draw it to a target as a damped spring; to drive its rate; to keep it above a
limit, or below one."""


@cache
def frame_dtype(precision: str) -> np.dtype:
    """One joint: whom it joins, what they weigh, and where its anchors were as the step began."""
    real = REALS[precision]
    names = (*BODY_FIELDS, *FRAME_FIELDS, "axis_x", "axis_y", "angle_before")
    whole = ("joint", "body1", "body2")  # rows of their tables
    return np.dtype([*((name, np.int32) for name in whole), *((name, real) for name in names)])


@cache
def row_dtype(precision: str) -> np.dtype:
    """One scalar row. Units of a way; those of a turn are rad for m, N m for N."""
    real = REALS[precision]
    whole = ("frame", "measures", "use")  # row of its joint's frame; X to ALONG_THE_WAY; HOLDS to UPPER
    names = (
        "nx", "ny",  # Jacobian, now: direction, nothing for a turn;
        "arm1", "arm2",  # and how an impulse along it turns body1 and body2 [m]
        "error", "zero",  # value less `zero`, now [m]; the value where it is 0 [m]
        "speed",  # wanted rate of the value [m/s]: 0 but for DRIVES
        "least", "most",  # bounds of the impulse of a substep [N s]
        "stiffness", "damping",  # of SPRINGS [N/m], [N s/m]; 0 for others, which are rigid
        "mass",  # 1 / (J M^-1 J^T), now; 0 where an impulse changes nothing [kg]
        "impulse",  # accumulated in a substep, on body2 along the direction [N s]
        "given",  # in all substeps [N s]
    )  # fmt: skip
    return np.dtype([*((name, np.int32) for name in whole), *((name, real) for name in names)])
