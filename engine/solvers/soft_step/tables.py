"""What soft_step works on within one step: made afresh each time, so no part of a snapshot.

A mover is a row of eight numbers, as wide as a vector of the machine. A constraint holds all that a pass needs of a
pair but for its two movers, so that a pass reads one row after another; a block is eight of them, field by field
(engine/rows.py, `wide`). What an effect adds stands in a table of its own with a row for each constraint: friction,
belts, rolling resistance, restitution.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.tables import REALS


@cache
def mover_dtype(precision: str) -> np.dtype:
    """How a body moves: same row as in BODY."""
    real = REALS[precision]
    return np.dtype(
        [
            ("vx", real),  # velocity of the centre of mass [m/s]
            ("vy", real),
            ("w", real),  # angular velocity [rad/s]
            ("turned", real),  # angle since the step began [rad]
            ("dx", real),  # way of the centre of mass since the step began [m]
            ("dy", real),
            ("cosine", real),  # of the rotation since the step began
            ("sine", real),
        ]
    )


@cache
def drive_dtype(precision: str) -> np.dtype:
    """What forces do to a body in a substep; one row a dynamic body."""
    real = REALS[precision]
    return np.dtype([("vx", real), ("vy", real), ("w", real), ("spare", real)])  # [m/s], [rad/s]


@cache
def constraint_dtype(precision: str) -> np.dtype:
    """The normal part of a pair's contacts; a second point that is not there has no mass, so it gives nothing."""
    real = REALS[precision]
    point = [
        ("r1_x", real),  # from the centres of mass, as the step began [m]
        ("r1_y", real),
        ("r2_x", real),
        ("r2_y", real),
        ("separation", real),  # less (r2 - r1) . n, so that it adds to how far the bodies moved [m]
        ("mass", real),  # effective mass along the normal [kg]
        ("impulse", real),  # accumulated in a substep [N s]
        ("given", real),  # in all substeps [N s]
    ]
    return np.dtype(
        [
            ("body1", np.int32),  # rows of the movers
            ("body2", np.int32),
            ("nx", real),  # unit normal, from body1 to body2
            ("ny", real),
            ("inverse_mass1", real),
            ("inverse_inertia1", real),
            ("inverse_mass2", real),
            ("inverse_inertia2", real),
            *((f"a_{name}", kind) for name, kind in point),
            *((f"b_{name}", kind) for name, kind in point),
        ]
    )


@cache
def friction_dtype(precision: str) -> np.dtype:
    """The sideways part."""
    real = REALS[precision]
    return np.dtype(
        [
            ("friction", real),
            *((f"{point}_{name}", real) for point in "ab" for name in ("mass", "impulse", "given")),
        ]
    )


@cache
def belt_dtype(precision: str) -> np.dtype:
    """How fast the surfaces run past each other by themselves [m/s]."""
    return np.dtype([("speed", REALS[precision])])


@cache
def rolling_dtype(precision: str) -> np.dtype:
    """The turning part."""
    real = REALS[precision]
    return np.dtype(
        [
            ("reach", real),  # resisting moment / load [m]
            ("mass", real),  # 1 / (1/I1 + 1/I2) [kg m^2]
            ("impulse", real),  # accumulated in a substep [N m s]
        ]
    )


@cache
def restitution_dtype(precision: str) -> np.dtype:
    """What bouncing needs to know of the time before the step."""
    real = REALS[precision]
    return np.dtype(
        [
            ("restitution", real),
            ("a_speed", real),  # along the normal before the step; < 0: they approach [m/s]
            ("b_speed", real),
        ]
    )
