"""Every state table: one structured dtype each, one row a body, arbiter, contact or joint.

Lengths in metres, time in seconds, mass in kilograms, angles in radians. `real` is the solver's own number: float32
("single") or float64 ("double"). Positions, angles and what describes a body are always float64. A snapshot is a copy
of these tables, so whatever a later step depends on must stand in one of them.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numba
import numpy as np

BODY_KINDS = ("static", "dynamic", "kinematic")
STATIC, DYNAMIC, KINEMATIC = range(3)

REALS: dict[str, np.dtype[np.floating]] = {"single": np.dtype(np.float32), "double": np.dtype(np.float64)}

BODY = np.dtype(
    [
        ("serial", np.int64),  # number of creation, from 0, never given twice; -1: no body in this row
        ("x", np.float64),  # position: of the body's origin [m]
        ("y", np.float64),
        ("angle", np.float64),  # unwrapped [rad]
        ("center_x", np.float64),  # centre of mass, in the world [m]
        ("center_y", np.float64),
        ("local_x", np.float64),  # centre of mass, in the body's frame [m]
        ("local_y", np.float64),
        ("force_x", np.float64),  # set by the user, used up by the next step [N]
        ("force_y", np.float64),
        ("torque", np.float64),  # [N m]
        ("mass", np.float64),  # [kg], infinite for a body that no force moves
        ("inertia", np.float64),  # about the centre of mass [kg m^2], infinite likewise
        ("kind", np.int64),  # index into BODY_KINDS
        ("fixed_rotation", np.int64),  # 1: nothing turns it
    ]
)

SHAPE = np.dtype(
    [
        ("serial", np.int64),  # number of creation, from 0, never given twice; -1: no shape in this row
        ("body", np.int64),  # row of its body
        ("kind", np.int64),  # index into SHAPE_KINDS
        ("part_of", np.int64),  # serial of the first of the pieces that came together: one but for a chain
        ("mass", np.float64),  # [kg]
        ("friction", np.float64),  # coefficient, >= 0
        ("half_x", np.float64),  # box: half its width; capsule, segment: half the way between its ends [m]
        ("half_y", np.float64),  # box: half its height [m]
        ("radius", np.float64),  # circle, capsule: radius; polygon: how far it is rounded [m]
        ("local_x", np.float64),  # place of the shape's own frame in the body's frame [m]
        ("local_y", np.float64),
        ("local_angle", np.float64),  # [rad]
        ("local_cosine", np.float64),  # of that angle
        ("local_sine", np.float64),
        ("hull", np.int64),  # polygon: row in the table of hulls; -1 otherwise
        ("ghost1_x", np.float64),  # chain piece: the points before and after it, in its own frame [m]
        ("ghost1_y", np.float64),
        ("ghost2_x", np.float64),
        ("ghost2_y", np.float64),
    ]
)
"""One piece of a body's outline: a whole shape, or one segment of a chain."""

HULL_POINTS = 8
HULL = np.dtype(
    [
        ("serial", np.int64),  # -1: no hull in this row
        ("count", np.int64),  # corners
        ("x", np.float64, (HULL_POINTS,)),  # corners, counter-clockwise, in the shape's own frame [m]
        ("y", np.float64, (HULL_POINTS,)),
        ("nx", np.float64, (HULL_POINTS,)),  # unit outward normal of the edge from each corner to the next
        ("ny", np.float64, (HULL_POINTS,)),
    ]
)

FLUID = np.dtype(
    [
        ("serial", np.int64),  # number of creation among the fluids; -1: no fluid in this row
        ("lower_x", np.float64),  # the rectangle that it fills [m]
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("density", np.float64),  # [kg/m^2]
        ("linear_drag", np.float64),  # of a body as dense, all under [1/s]
        ("angular_drag", np.float64),
    ]
)

CONTACT_RECORD = np.dtype(
    [
        ("body1", np.int64),  # serials of the two bodies, body1 the one created first
        ("body2", np.int64),
        ("feature", np.int32),  # which edges meet: what recognises the contact in the next step
        ("x", np.float64),  # position [m]
        ("y", np.float64),
        ("nx", np.float64),  # unit normal, from body1 to body2
        ("ny", np.float64),
        ("separation", np.float64),  # < 0: overlap [m]
        ("normal_impulse", np.float64),  # accumulated [N s]
        ("tangent_impulse", np.float64),  # accumulated, along (ny, -nx) [N s]
    ]
)
"""A contact as the outside sees it: a copy, one row a contact, in the solver's order."""

JOINT_KINDS = ("revolute", "distance", "prismatic", "weld", "wheel", "motor", "mouse", "filter")
REVOLUTE, DISTANCE, PRISMATIC, WELD, WHEEL, MOTOR, MOUSE, FILTER = range(8)

JOINT_RECORD = np.dtype(
    [
        ("joint", np.int64),  # serial of the joint
        ("body1", np.int64),  # serials of its bodies
        ("body2", np.int64),
        ("x1", np.float64),  # anchor on body1, in the world [m]
        ("y1", np.float64),
        ("x2", np.float64),  # anchor on body2, in the world [m]
        ("y2", np.float64),
        ("impulse_x", np.float64),  # what the last step gave body2 at its anchor [N s]
        ("impulse_y", np.float64),
        ("turn_impulse", np.float64),  # and to turn it [N m s]
        ("kind", np.int64),  # index into JOINT_KINDS
    ]
)
"""A joint as the outside sees it: a copy, one row a joint, in the order of creation."""


@cache
def motion_dtype(precision: str) -> np.dtype:
    """What the solver reads and writes of a body, and nothing else: one row of eight numbers, same row as in BODY."""
    real = REALS[precision]
    return np.dtype(
        [
            ("vx", real),  # velocity of the centre of mass [m/s]
            ("vy", real),
            ("w", real),  # angular velocity [rad/s]
            ("inverse_mass", real),  # [1/kg], 0 for a static body
            ("inverse_inertia", real),  # [1/(kg m^2)], 0 for a static body
            ("cosine", real),  # of the body's angle: made whenever the angle changes
            ("sine", real),
            ("still", real),  # how long it has been slow enough to sleep, see sleeping.py [s]
        ]
    )


@cache
def placement_dtype(precision: str) -> np.dtype:
    """Where a shape is in the world: made afresh each step, same row as in SHAPE."""
    real = REALS[precision]
    return np.dtype(
        [
            ("x", np.float64),  # of the shape's own frame [m]
            ("y", np.float64),
            ("cosine", real),  # of its angle
            ("sine", real),
        ]
    )


@cache
def arbiter_dtype(precision: str) -> np.dtype:
    """Two shapes that are near each other, and what their contacts share. It lives as long as they are near.

    What lanes read stands first, eight numbers and eight numbers: see engine/rows.py, load_row.
    """
    real = REALS[precision]
    return np.dtype(
        [
            ("nx", real),  # unit normal, from body1 to body2
            ("ny", real),
            ("friction", real),  # of the pair
            ("rolling_impulse", real),  # accumulated [N m s]
            ("found_nx", real),  # the normal when the contacts were found
            ("found_ny", real),
            ("apart_x", real),  # from the centre of body1 to that of body2, likewise [m]
            ("apart_y", real),
            ("cosine1", real),  # of the angles of body1 and body2, likewise
            ("sine1", real),
            ("cosine2", real),
            ("sine2", real),
            ("radius1", real),  # how far the outline of each shape is rounded [m]
            ("radius2", real),
            ("fewest", real),  # contacts that may be kept: 1 where a shape is a circle, else 2
            ("clearance", real),  # they are this far apart at least, where they do not touch; 0: not known [m]
            ("serial1", np.int64),  # serials of the shapes, serial1 < serial2: the arbiter's key and its order
            ("serial2", np.int64),
            ("shape1", np.int32),  # rows of the shapes
            ("shape2", np.int32),
            ("body1", np.int32),  # rows of their bodies
            ("body2", np.int32),
            ("collider", np.int32),  # which kind of pair: index into COLLIDERS
            ("count", np.int32),  # contacts, 0 to 2
            ("colour", np.int32),  # of its contacts, see colouring.py; -1: none, they do not touch
            ("recyclable", np.int32),  # 1: its contacts may be kept while its bodies hardly move
        ]
    )


@cache
def contact_dtype(precision: str) -> np.dtype:
    """One contact point; an arbiter's two stand in one row of a (arbiters, 2) table. Eight numbers first, as above."""
    real = REALS[precision]
    return np.dtype(
        [
            ("r1_x", real),  # position relative to the centres of body1 and body2, when it was found [m]
            ("r1_y", real),
            ("r2_x", real),
            ("r2_y", real),
            ("separation", real),  # < 0: overlap [m]
            ("found", real),  # separation when the contact was found, see recycling.py [m]
            ("normal_impulse", real),  # accumulated P_n: what the next step starts from, for a whole step [N s]
            ("tangent_impulse", real),  # accumulated P_t [N s]
            ("given_normal", real),  # what the last step gave in all [N s]
            ("given_tangent", real),
            ("feature", np.int32),  # which corners or edges meet, see narrow_phase/manifold_points.py
        ]
    )


NEVER = -1.0
"""A largest force or torque that is not there: any is taken."""

HELD = ("nothing", "point", "line", "across")
NOTHING, POINT, LINE, ACROSS = range(4)
"""What a joint takes away from how its bodies move: nothing; the way between two points; the way across an axis and
the turning; the way across an axis alone."""


@cache
def joint_dtype(precision: str) -> np.dtype:
    """A joint of any kind, and what it holds. What it leaves free has rows of their own, see `free_dtype`."""
    real = REALS[precision]
    return np.dtype(
        [
            ("body1", np.int64),  # rows of the bodies
            ("body2", np.int64),
            ("anchor1_x", np.float64),  # anchor in the frame of body1 [m]
            ("anchor1_y", np.float64),
            ("anchor2_x", np.float64),  # anchor in the frame of body2 [m]
            ("anchor2_y", np.float64),
            ("impulse_x", real),  # accumulated, on body2 [N s]; of a line: across it [N s]
            ("impulse_y", real),  # of a line: turning [N m s]
            ("given_x", real),  # what the last step gave body2, likewise
            ("given_y", real),
            ("serial", np.int64),  # number of creation among the joints; -1: no joint in this row
            ("kind", np.int64),  # index into JOINT_KINDS
            ("held", np.int64),  # index into HELD
            ("axis_x", np.float64),  # unit axis in the frame of body1, of those that slide
            ("axis_y", np.float64),
            ("reference_angle", np.float64),  # of body2 over body1, where the joint's own angle is 0 [rad]
            ("hertz", np.float64),  # of the spring that holds the point; 0: as stiff as joints are [1/s]
            ("damping_ratio", np.float64),
            ("max_force", np.float64),  # that holds the point [N]; NEVER
            ("break_force", np.float64),  # beyond which it breaks [N]; NEVER
            ("break_torque", np.float64),  # [N m]; NEVER
            ("softness", real),  # how far it gives way [1/kg]: 0 is rigid
            ("bias_factor", real),  # part of the separation that a step removes; < 0: the solver's own
            ("collide_connected", np.int64),  # 1: its bodies collide with each other
            ("r1_x", real),  # sequential_impulses: anchors relative to the centres, turned into the world [m]
            ("r1_y", real),
            ("r2_x", real),
            ("r2_y", real),
            ("mass_xx", real),  # and effective mass, a symmetric matrix [kg]
            ("mass_xy", real),
            ("mass_yy", real),
            ("bias_x", real),  # and velocity that removes the separation [m/s]
            ("bias_y", real),
        ]
    )


ALONG_NOTHING, ALONG_AXIS, ALONG_WAY = range(3)
"""What a joint's slide is along: there is none; its axis; the way from anchor to anchor."""

NO_SPRING, SPRING, STIFF = range(3)


def rounded_up(strength: Any) -> Any:
    """The next power of two above the strength of a motor: what depends on it holds until it has changed that much."""
    return np.ldexp(1.0, np.frexp(strength)[1])


@cache
def free_dtype(precision: str) -> np.dtype:
    """What acts in a direction that a joint leaves free: how its bodies turn, or slide, against each other.

    Units of a slide; those of a turn are rad for m, N m for N.
    """
    real = REALS[precision]
    return np.dtype(
        [
            ("along", np.int64),  # of slides: ALONG_..., of turns: 1 if anything acts
            ("spring", np.int64),  # NO_SPRING, SPRING or STIFF, which is as stiff as joints are
            ("hertz", np.float64),  # of the spring [1/s]
            ("damping_ratio", np.float64),
            ("target", np.float64),  # where the spring rests [m]
            ("max_spring", np.float64),  # most that the spring gives [N]; NEVER
            ("motored", np.int64),  # 1: there is a motor
            ("motor_speed", np.float64),  # of body2 over body1 [m/s]
            ("max_motor", np.float64),  # [N]
            ("limited", np.int64),  # 1: there are limits
            ("lower", np.float64),  # [m]
            ("upper", np.float64),
            *((f"{name}_{what}", real) for name in ("spring", "motor", "lower", "upper") for what in IMPULSES),
        ]
    )


IMPULSES = ("impulse", "given")
"""Accumulated: what the next step starts from, for a whole step [N s]; and what the last step gave body2 in all."""


@cache
def step_dtype(precision: str) -> np.dtype:
    """What holds for a whole step: one row, so that a kernel takes it as one argument."""
    real = REALS[precision]
    return np.dtype(
        [
            ("dt", real),  # time step [s]
            ("inverse_dt", real),  # [1/s]
            ("gravity_x", real),  # [m/s^2]
            ("gravity_y", real),
            ("bias_factor", real),  # of contacts; 0 while position correction is off
            ("slop", real),  # [m]
            ("iterations", np.int64),
            ("accumulate_impulses", np.int64),  # the talk's three switches, 0 or 1
            ("warm_starting", np.int64),
            ("position_correction", np.int64),
            ("margin", real),  # contacts are found where shapes are closer than this [m]
            ("recycling", real),  # contacts are kept while bodies moved less than this; 0: never [m]
            ("substeps", np.int64),
            ("h", real),  # time of a substep [s]
            ("inverse_h", real),  # [1/s]
            ("parts", real),  # substeps, as a number of the solver's
            ("carried", real),  # part of a stored impulse that a substep starts from
            ("push_out_speed", real),  # [m/s]
            ("sleep_speed", real),  # [m/s]
            ("sleep_time", real),  # [s]
            ("restitution_threshold", real),  # [m/s]
            ("maximum_speed", real),  # [m/s]
            *((name, real) for name in SOFTNESS_FIELDS),
        ]
    )


SOFTNESS_FIELDS = tuple(
    f"{kind}_{name}" for kind in ("contact", "static", "joint") for name in ("bias_rate", "mass_scale", "impulse_scale")
)
"""Softness of contacts, of contacts with what no impulse moves, and of joints: see softness.py."""


def empty(count: int | tuple[int, ...], dtype: np.dtype) -> np.ndarray:
    """A table of zeros. Without compilation a row must give its fields by attribute, which a recarray's does."""
    table = np.zeros(count, dtype)
    return table.view(np.recarray) if numba.config.DISABLE_JIT else table
