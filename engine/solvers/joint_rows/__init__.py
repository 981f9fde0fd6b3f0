"""Joints of all kinds as scalar rows, for solvers that take constraints one by one.

A row has a value v(positions), an error C = v - zero, and a Jacobian: its rate is
dC/dt = n . (v2 - v1) + arm2 w2 - arm1 w1, and an impulse P along it gives body2 P n / m2 and P arm2 / I2, and body1
the same the other way. Every kind of row is held by bounds alone:

    HOLDS    C = 0                      P in (-inf, inf)
    SPRINGS  P / h = -k C - d dC/dt     P in (-inf, inf), or as strong as the spring may be
    DRIVES   dC/dt = speed              P in [-h most, h most]; C is how far it went in this step
    LOWER    C >= 0                     P in [0, inf)
    UPPER    C <= 0                     P in (-inf, 0]

so `clamp(total, row.least, row.most)` is the only thing that a pass does to a row's total impulse. A limit that still
has room (LOWER with C > 0, UPPER with C < 0) may be used up within the substep: dC/dt + C/h = 0 is what to ask of it.

How to consume them:

    table = rows_of(state)                       once a step; None where no joint does anything
    movers as of soft_step/movers.py, begun      their d, q and turned say where bodies are within the step
    prepare(...)                                 frames and rows as the step begins, with the impulses to start from
    refresh(rows, frames, movers)                brings all errors and Jacobians to where the movers are, or
    measure(row, frame, a, b)                    those of one row, for movers a and b: for position solving
    pushed(...)                                  velocities after an impulse along a row
    store(rows, frames, joints, turns, slides, parts)
                                                 keeps `impulse`, times `parts` substeps, for the next step, and `given`
                                                 for whoever asks: a solver writes both

A pass takes frame = frames[row.frame], body1 = frame.body1, and so on: what bodies weigh stands in the frame.
Implicit Euler of a spring (E. Catto, "Soft Constraints", GDC 2011): with gamma = 1 / (h (d + h k)) and bias rate
k / (d + h k), P = -(mass^-1 + gamma)^-1 (dC/dt + bias rate C + gamma P_before); for XPBD the compliance is 1 / k.

What rows do not know: a largest force that holds a point, which bounds two rows together (motor and mouse joints), and
a revolute joint's bias factor where it is rigid: errors go away as the solver has it. Joints are sequential in the
order of creation: springs, motors and limits first, then what is rigid, as a later row has the last word in a pass.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.solvers.joint_rows.impulses import Speeds, pushed, rate, store
from engine.solvers.joint_rows.rows import measure, prepare, refresh
from engine.solvers.joint_rows.tables import (
    ACROSS_AXIS,
    ALONG_THE_AXIS,
    ALONG_THE_WAY,
    DRIVES,
    HOLDS,
    LOWER,
    SPRINGS,
    TURN,
    UPPER,
    X,
    Y,
    frame_dtype,
    row_dtype,
)  # fmt: skip
from engine.tables import ALONG_NOTHING, ALONG_WAY, JOINT_KINDS, LINE, NO_SPRING, NOTHING, POINT, SPRING, STIFF, empty

if TYPE_CHECKING:
    from engine.state import State

LACKING = ("motor joints", "mouse joints")
"""What a solver that consumes rows lacks: see above."""


class Rows(NamedTuple):
    """The rows of a world's joints, as its content has them."""

    rows: np.ndarray  # row_dtype: frame, measures and use are written; `prepare` writes the rest
    frames: np.ndarray  # frame_dtype: joint is written


def rows_of(state: State) -> Rows | None:
    """The rows, made anew after content changed; None where no joint does anything."""
    if "joint rows" not in state.gathered:
        state.gathered["joint rows"] = arrange(state)
    found: Rows | None = state.gathered["joint rows"]
    return found


def awake_rows(state: State) -> Rows | None:
    """Those of the joints whose bodies are awake: of no use any more once something falls asleep or wakes."""
    found = rows_of(state)
    asleep = state.bodies.columns.get("asleep")
    if found is None or asleep is None:
        return found
    joints = state.joints.tables["joints"][found.frames["joint"]]
    awake = (asleep[joints["body1"]] == 0) & (asleep[joints["body2"]] == 0)
    if awake.all():
        return found
    if not awake.any():
        return None
    rows = found.rows[awake[found.rows["frame"]]]
    rows["frame"] = (np.cumsum(awake) - 1)[rows["frame"]]
    return Rows(rows, found.frames[awake])


def arrange(state: State) -> Rows | None:
    """Which rows there are."""
    if state.active_joints is None:
        return None
    joints, turns, slides = (state.joints.tables[name] for name in ("joints", "turns", "slides"))
    order = [row for row in state.joints.order if f"{JOINT_KINDS[joints['kind'][row]]} joints" in state.effects]
    found: list[tuple[int, int, int]] = []
    for k, row in enumerate(order):
        free, rigid = parts_of(turns[row], slides[row])
        held = int(joints["held"][row])
        if held == POINT:
            rigid += [(X, HOLDS), (Y, HOLDS)]
        elif held != NOTHING:
            rigid += [(ACROSS_AXIS, HOLDS)] + [(TURN, HOLDS)] * (held == LINE)
        found += [(k, measures, use) for measures, use in free + rigid]
    frames = empty(len(order), frame_dtype(state.precision))
    frames["joint"] = order
    rows = empty(len(found), row_dtype(state.precision))
    for name, column in zip(("frame", "measures", "use"), np.array(found, np.int32).reshape(-1, 3).T, strict=True):
        rows[name] = column
    return Rows(rows, frames)


def parts_of(turn: np.void, slide: np.void) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """What acts in the directions that a joint leaves free, and what is rigid there."""
    free, rigid = [], []
    for part, measures in (
        (turn, TURN),
        (slide, ALONG_THE_WAY if slide["along"] == ALONG_WAY else ALONG_THE_AXIS),
    ):
        if part["along"] == ALONG_NOTHING:
            continue
        if part["spring"] == SPRING:
            free.append((measures, SPRINGS))
        if part["motored"]:
            free.append((measures, DRIVES))
        if part["limited"]:
            free += [(measures, LOWER), (measures, UPPER)]
        if part["spring"] == STIFF:
            rigid.append((measures, HOLDS))
    return free, rigid


assert NO_SPRING not in (SPRING, STIFF)

__all__ = [
    "ACROSS_AXIS", "ALONG_THE_AXIS", "ALONG_THE_WAY", "DRIVES", "HOLDS", "LACKING", "LOWER", "SPRINGS", "TURN",
    "UPPER", "Rows", "Speeds", "X", "Y", "awake_rows", "frame_dtype", "measure", "prepare", "pushed", "rate",
    "refresh", "row_dtype", "rows_of", "store",
]  # fmt: skip
