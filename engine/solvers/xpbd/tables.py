"""What xpbd works on within one step: made afresh each time, so no part of a snapshot."""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.tables import REALS


@cache
def pair_dtype(precision: str) -> np.dtype:
    """Two bodies that touch, or are about to."""
    real = REALS[precision]
    return np.dtype(
        [
            ("index", np.int64),  # of its arbiter
            ("body1", np.int64),  # rows of the movers
            ("body2", np.int64),
            ("count", np.int64),  # points
            ("nx", real),  # unit normal, from body1 to body2
            ("ny", real),
            ("inverse_mass1", real),
            ("inverse_inertia1", real),
            ("inverse_mass2", real),
            ("inverse_inertia2", real),
            ("coupling", real),  # how a push at one point moves the other along the normal [1/kg]
            ("friction", real),
            ("belt", real),  # how fast the surfaces run past each other by themselves [m/s]
            ("restitution", real),
            ("reach", real),  # resisting moment / load [m]
            ("turn_mass", real),  # 1 / (1/I1 + 1/I2) [kg m^2]
            ("turn", real),  # impulse that resisted rolling in a substep [N m s]
        ]
    )


@cache
def point_dtype(precision: str) -> np.dtype:
    """One of the two points where they touch; (pairs, 2)."""
    real = REALS[precision]
    return np.dtype(
        [
            ("r1_x", real),  # from the centres of mass, as the step began [m]
            ("r1_y", real),
            ("r2_x", real),
            ("r2_y", real),
            ("separation", real),  # less (r2 - r1) . n, so that it adds to how far the bodies moved [m]
            ("normal_mass", real),  # effective mass along the normal, 1 / (w1 + w2) of the paper [kg]
            ("tangent_mass", real),  # and across it [kg]
            ("rest", real),  # separation that a substep leaves: 0, or overlap that is not to go faster [m]
            ("before", real),  # speed along the normal as the substep began; < 0: they approach [m/s]
            ("normal", real),  # multiplier of a substep, lambda_n of the paper [kg m]
            ("tangent", real),  # lambda_t [kg m]
            ("given_normal", real),  # in all substeps [N s]
            ("given_tangent", real),
        ]
    )
