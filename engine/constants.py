"""Every tuning number: what it is, its unit, its usual value, and what breaks when it is wrong."""

from __future__ import annotations

import numpy as np


def float32_value(value: float) -> float:
    """The double that a float32 literal of C stands for: Box2D Lite's numbers are such."""
    return float(np.float32(value))


# --- overlap removal (sequential_impulses) -------------------------------------------------------------------------

BIAS_FACTOR = float32_value(0.2)
"""Part of the overlap beyond the slop that one step pushes out, usual 0.1 to 0.3. Higher: boxes jump apart; lower:
stacks sink. Box2D Lite's float32 value, in either precision: a decimal 0.2 misses its trajectories by 1e-5 m."""

SLOP = float32_value(0.01)
"""Overlap that is left alone [m], usual 0.005 to 0.01 for bodies of about 1 m. Zero: contacts come and go with every
step, their impulses are lost, and piles never rest. Larger: bodies visibly sink into each other."""

JOINT_BIAS_FACTOR = float32_value(0.2)
"""Part of a joint's separation that one step removes, usual 0.1 to 0.3. Higher: the joint rings."""

# --- narrow phase -------------------------------------------------------------------------------------------------

FACE_RELATIVE_TOLERANCE = float32_value(0.95)
FACE_ABSOLUTE_TOLERANCE = float32_value(0.01)
"""An axis replaces the one chosen before it only if its separation beats 0.95 of the other's by 0.01 of the face's
half width. Without: two equally good faces alternate from step to step and their impulses are lost."""

COINCIDENT = 1e-15
"""Centres of circles closer than this are one point [m]: the normal is straight up. Zero: in single precision the
square of a distance below 1e-19 m loses its digits, and the normal its unit length."""

# --- broad phase --------------------------------------------------------------------------------------------------

BOUNDS_MARGIN = 1e-3
BOUNDS_MARGIN_RELATIVE = 2.0**-22
"""Bounding boxes are float32 and grown by this [m] plus this part of their coordinates and of their size, so that
rounding never parts a pair that touches, at any distance from the origin. Too small: contacts of bodies that just touch
are missed."""

# --- defaults of what a user may set ------------------------------------------------------------------------------

DENSITY = 1.0
"""Default density [kg/m^2]."""

FRICTION = 0.2
"""Default friction coefficient of a body: the talk's."""

ITERATIONS = 10
"""Default passes over all constraints in a step, usual 4 to 50: what accuracy costs in time."""

MAX_ITERATIONS = 10_000
"""Most passes that may be asked for: a step that lasts minutes is a typing error."""
