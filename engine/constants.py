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

# --- soft_step ------------------------------------------------------------------------------------------------------
# Usual values: those of Box2D v3 (github.com/erincatto/box2d, include/box2d/constants.h and types.h).

CONTACT_HERTZ = 30.0
"""Natural frequency of a contact with stiffness "fixed" [1/s]. Beyond an eighth of the substep rate it would ring and
is cut off there; lower: stacks sink and buckle (a tower stands up to 14 boxes at 30 Hz without recycling)."""

CONTACT_DAMPING_RATIO = 10.0
"""Far beyond critical, so that overlap creeps out instead of springing back. Near 1: boxes bounce on their overlap."""

PUSH_OUT_SPEED = 3.0
"""Fastest that overlap is pushed apart [m/s]. Higher: overlapping bodies fly off; lower: they stay overlapped long."""

JOINT_HERTZ = 60.0
JOINT_DAMPING_RATIO = 2.0
"""The same for joints with stiffness "fixed"; at most a quarter of the substep rate."""

CONTACT_SUBSTEPS_A_CYCLE = 8.0
JOINT_SUBSTEPS_A_CYCLE = 4.0
"""Substeps in one period of the stiffest contact and joint, and of the fastest spring of a joint: fewer ring. With
stiffness "follows" all contacts and joints are that stiff, so that the error falls fourfold with every doubling of the
substeps."""

STATIC_STIFFENING = 2.0
"""How much higher the frequency is of a contact with a body that no impulse moves: heaps sink less into the ground."""

SPECULATIVE_DISTANCE = 0.02
"""Contacts are made this far ahead [m], so that they act before shapes overlap. Zero: contacts flicker. Larger: bodies
may stop at a corner they would have passed."""

RECYCLING_DISTANCE = 0.05
RECYCLING_ANGLE = 0.05
"""A contact is kept, not found anew, while its bodies moved by less than this [m], and turned by less [rad], since it
was found. Zero: towers of more than 14 boxes buckle at 4 substeps. Larger: contacts lag behind sliding corners."""

RECYCLING_ROLL = 5e-4
"""Nor is it kept when a round shape has turned so far that the point that touched is this much off the outline [m]: a
tenth of a usual overlap. Larger: balls that roll bob up and down, by 4 cm at a radius of 2 m without this limit."""

MAXIMUM_SPEED = 4000.0
"""Fastest that anything makes a body [m/s]: ten times the speed of sound. Lower: a bullet stops short of its speed;
without: what blows up is a number that is not finite a step later."""

MAX_SUBSTEPS = 1000
"""Most substeps that may be asked for."""

# --- narrow phase -------------------------------------------------------------------------------------------------

FACE_RELATIVE_TOLERANCE = float32_value(0.95)
FACE_ABSOLUTE_TOLERANCE = float32_value(0.01)
"""An axis replaces the one chosen before it only if its separation beats 0.95 of the other's by 0.01 of the face's
half width. Without: two equally good faces alternate from step to step and their impulses are lost."""

COINCIDENT = 1e-15
"""Centres of circles closer than this are one point [m]: the normal is straight up. Zero: in single precision the
square of a distance below 1e-19 m loses its digits, and the normal its unit length."""

# --- events ---------------------------------------------------------------------------------------------------------

PARTING_DISTANCE = 0.005
"""Shapes that touched do so until they are this far apart [m], or until nothing presses if that is later: a contact
that was seen ahead may. Zero: pairs in a heap begin and end all the time. Larger: more low bounces are told as one
touch; here those below sqrt(2 g 0.005 m), 0.3 m/s, are."""

# --- continuous collision -------------------------------------------------------------------------------------------

CONTINUOUS_WAY = 0.5
"""Part of the half width of its thinnest shape that a body may go in a step before it counts as fast. Near 1: what ends
in the middle of a wall comes out on either side; 0: all bodies that move are looked at."""

CONTINUOUS_DEPTH = 0.005
CONTINUOUS_SHARE = 0.25
"""What is fast stops where it would overlap by more than this [m], or by more than this part of the thinner half width.
Smaller: bodies that slide stop at the seams of a floor, into which they sink a little; larger: corners go through what
is thin."""

CONTINUOUS_FAR = 10.0
CONTINUOUS_AHEAD = 1e-3
"""What goes further in a step than so many speculative distances keeps no contact that is further ahead than this [m].
Far larger: bullets are turned away by corners that they miss; 0: what slides fast loses the floor now and then."""

CONTINUOUS_NEAR = 0.02
"""Part of that depth by which an impact may be found too early. Zero: what turns takes many advances."""

# --- broad phase --------------------------------------------------------------------------------------------------

BOUNDS_MARGIN = 1e-3
BOUNDS_MARGIN_RELATIVE = 2.0**-22
"""Bounding boxes are float32 and grown by this [m] plus this part of their coordinates and of their size, so that
rounding never parts a pair that touches, at any distance from the origin. Too small: contacts of bodies that just touch
are missed."""

# --- effects --------------------------------------------------------------------------------------------------------

MAGNET_CONSTANT = 1.0
"""K in the force K p1 p2 / d^2 between two magnets: two of strength 1 at 1 m push each other with 1 N [N m^2]."""

CORE_RADIUS = 0.1
"""Nearer than this, magnets and attraction fall off to nothing, as inside a ball [m]. Zero: two bodies that meet are
flung out of the world by one step. Larger: bodies that touch feel too little."""

# --- defaults of what a user may set ------------------------------------------------------------------------------

DENSITY = 1.0
"""Default density [kg/m^2]."""

FRICTION = 0.2
"""Default friction coefficient of a body: the talk's."""

RESTITUTION_THRESHOLD = 1.0
"""Shapes that meet slower than this do not bounce [m/s]. Zero: resting bodies tremble for ever; larger: a ball stops
while one still sees it move."""

HIT_SPEED = 1.0
"""Shapes that begin to touch faster than this hit each other [m/s]. Box2D v3's value: below it nobody hears them."""

SLEEP_SPEED = 0.05
"""Slower than this, as the root mean square of all its mass, a body is still [m/s]: Box2D's figure. Larger: what creeps
or tips slowly is stopped; smaller: heaps that tremble never sleep."""

SLEEP_TIME = 0.5
"""So long must all of an island be still before it falls asleep [s]: Box2D's figure. Smaller: what turns back, such as
a ball at its highest, is stopped."""

MAX_ITERATIONS = 10_000
"""Most passes that may be asked for: a step that lasts minutes is a typing error."""

# --- avbd -------------------------------------------------------------------------------------------------------------
# Usual values of the first two: C. Giles et al., "Augmented Vertex Block Descent" (2025). The others are told in
# effective masses, so that they mean the same for bodies of any mass and steps of any length.

AVBD_ALPHA = 0.95
"""Part of an error that is there already which a step leaves, usual 0.95 to 0.99. Lower: what overlaps is thrown apart,
and stacks shake; higher: they sink before their contacts have taken up the weight."""

AVBD_GAMMA = 0.99
"""Part of the multipliers, with alpha, from which a step starts, usual 0.99. With all of them (alpha gamma = 1) the
errors of one body feed those of the next: a tower of 10 boxes takes off."""

AVBD_PENALTY = 30.0
"""Penalty of a row as a step begins, in effective masses over dt^2, usual 10 to 100. Lower: bodies sink; higher: one
body after the other moves so little that in 10 iterations a heap does not come to rest."""

AVBD_FRICTION_PENALTY = 1.0
"""The same of friction, usual 0.3 to 2. Higher: what slides is held back though it is beyond the cone; at 30 it slides
with a third of its acceleration. Lower: what should stick creeps."""

AVBD_GROWTH = 100.0
"""Growth of a penalty in each iteration, in effective masses over dt^2 for each metre of error, usual 0 to 1000.
Higher: what falls fast onto a heap is thrown back."""
