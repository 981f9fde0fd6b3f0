"""What avbd works on within one step: made afresh each time, so no part of a snapshot.

In float64, whatever the precision: a body's 3x3 system holds its mass beside penalties of many times that.
"""

from __future__ import annotations

import numpy as np

REAL = np.float64

BODY = np.dtype(
    [
        ("x", REAL),  # way of the centre of mass since the step began [m]
        ("y", REAL),
        ("turn", REAL),  # angle since then [rad]
        ("target_x", REAL),  # the same where nothing were to hold the body, dt v + dt^2 f / m [m]
        ("target_y", REAL),
        ("target_turn", REAL),
        ("mass", REAL),  # [kg]; 0 where nothing moves it
        ("inertia", REAL),  # [kg m^2]; 0 where nothing turns it
        ("first", np.int64),  # its rows: where they begin in the list of all bodies' rows, and how many there are
        ("count", np.int64),
    ]
)

ROW = np.dtype(
    [
        ("body1", np.int64),  # rows of the bodies
        ("body2", np.int64),
        ("source", np.int64),  # index of the arbiter, or of the joint's row
        ("point", np.int64),  # of the arbiter's contacts; -1: a joint's row
        ("normal", np.int64),  # of friction: the row whose multiplier bounds it; -1 for others
        ("nx", REAL),  # Jacobian: dC/dt = n . (v2 - v1) + arm2 w2 - arm1 w1
        ("ny", REAL),
        ("arm1", REAL),
        ("arm2", REAL),
        ("lever1", REAL),  # how far from the centres it acts, where its direction turns with the bodies; else 0 [m]
        ("lever2", REAL),
        ("start", REAL),  # C as the step began [m]
        ("error", REAL),  # C now, less what is left of it for later steps [m]
        ("left", REAL),  # that part [m]
        ("mass", REAL),  # effective mass, as the step began [kg]
        ("penalty", REAL),  # k dt^2 [kg]
        ("most_penalty", REAL),  # of a spring, its stiffness; infinite for what is rigid
        ("damper", REAL),  # of a spring, d dt [kg]
        ("multiplier", REAL),  # lambda dt^2 [kg m]
        ("least", REAL),  # bounds of it
        ("most", REAL),
        ("friction", REAL),
    ]
)
"""A scalar constraint. Forces are told as pushes, times dt^2: then neither dt nor masses need appear in the penalty."""
