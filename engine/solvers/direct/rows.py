"""The rows of `direct`: joints as joint_rows has them, then for each contact its normal and what holds it sideways."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.jit import kernel
from engine.lanes import over
from engine.solvers.joint_rows.rows import measure
from engine.solvers.joint_rows.tables import HOLDS, LOWER, SPRINGS, UPPER
from engine.solvers.soft_step.contacts import Arms, separation_now
from engine.solvers.soft_step.movers import load
from engine.vec2 import Vec2, cross, dot, right_of, rotate

TOUCHING = 1e-9
"""What is not farther apart than this [m] touches. Zero: rounding errors of places decide who bears a load, where
several may."""


class System(NamedTuple):
    """n rows: w = J M^-1 J^T P + J v + bias, and the bounds of P; see pivoting.py."""

    body: np.ndarray  # (n, 2) int64, rows of the bodies
    jacobian: np.ndarray  # (n, 4): direction, arms [m]
    bias: np.ndarray  # (n,) [m/s]
    give: np.ndarray  # (n,) softness, which adds to the diagonal [1/kg]
    low: np.ndarray  # (n,) [N s]
    high: np.ndarray
    ratio: np.ndarray  # (n,) friction coefficient, of friction rows
    normal: np.ndarray  # (n,) int64, of friction rows: the row of its normal; -1


@kernel
def write(system, k, body1, body2, n, arm1, arm2, bias):
    """One row, with neither bounds nor friction."""
    system.body[k, 0], system.body[k, 1] = body1, body2
    system.jacobian[k, 0], system.jacobian[k, 1] = n.x, n.y
    system.jacobian[k, 2], system.jacobian[k, 3] = arm1, arm2
    system.bias[k] = bias
    system.give[k], system.ratio[k] = 0.0, 0.0
    system.low[k], system.high[k] = -np.inf, np.inf
    system.normal[k] = -1


@kernel
def write_joints(system, rows, frames, step):
    """All joint rows as they were prepared. A spring acts as its implicit step does (joint_rows/__init__.py)."""
    dt = np.float64(step.dt)
    for k in range(len(rows)):
        row = rows[k]
        frame = frames[row.frame]
        error, bias = np.float64(row.error), -np.float64(row.speed)
        if (row.use == LOWER and error > 0.0) or (row.use == UPPER and error < 0.0):
            bias = error / dt
        soft = 0.0
        if row.use == SPRINGS:
            give = np.float64(row.damping) + dt * np.float64(row.stiffness)
            bias = over(np.float64(row.stiffness), give) * error
            soft = over(1.0, dt * give)
        write(system, k, frame.body1, frame.body2, Vec2(row.nx, row.ny), row.arm1, row.arm2, bias)
        system.give[k] = soft
        system.low[k], system.high[k] = row.least, row.most


@kernel
def write_contacts(system, first, arbiters, contacts, count, belts, step):
    """Two rows a contact, from row `first` on: what is apart may approach so fast that it just meets.

    belts: how fast surfaces run, None where none does. Returns the number of rows.
    """
    k = first
    for index in range(count):
        arbiter = arbiters[index]
        normal = Vec2(np.float64(arbiter.nx), np.float64(arbiter.ny))
        tangent = right_of(normal)
        running = 0.0
        if belts is not None:
            running = -(belts[arbiter.shape1] + belts[arbiter.shape2])  # clockwise round their shapes
        for i in range(arbiter.count):
            contact = contacts[index, i]
            r1 = Vec2(np.float64(contact.r1_x), np.float64(contact.r1_y))
            r2 = Vec2(np.float64(contact.r2_x), np.float64(contact.r2_y))
            gap = np.float64(contact.separation)
            bias = gap / np.float64(step.dt) if gap > TOUCHING else 0.0
            write(system, k, arbiter.body1, arbiter.body2, normal, cross(r1, normal), cross(r2, normal), bias)
            system.low[k] = 0.0
            write(system, k + 1, arbiter.body1, arbiter.body2, tangent, cross(r1, tangent), cross(r2, tangent), running)
            system.ratio[k + 1] = arbiter.friction
            system.normal[k + 1] = k
            k += 2
    return k


@kernel
def write_places(system, rows, frames, arbiters, contacts, count, movers, most, errors):
    """Rows of what is wrong with positions, where the movers are: errors of joints, overlap. At most `most` [m] each.

    Writes how far each is off into `errors`. Returns how many there are.
    """
    zero = np.float64(0.0)
    k = 0
    if rows is not None:
        for i in range(len(rows)):
            row = rows[i]
            if row.use not in (HOLDS, LOWER, UPPER):
                continue
            frame = frames[row.frame]
            found = measure(row, frame, load(movers, frame.body1), load(movers, frame.body2))
            error = np.float64(found.value) - np.float64(row.zero)
            write(system, k, frame.body1, frame.body2, found.n, found.arm1, found.arm2, max(-most, min(error, most)))
            wrong = abs(error)
            if row.use == LOWER:
                system.low[k], wrong = 0.0, max(-error, zero)
            elif row.use == UPPER:
                system.high[k], wrong = 0.0, max(error, zero)
            errors[k] = wrong
            k += 1
    for index in range(count):
        arbiter = arbiters[index]
        normal = Vec2(arbiter.nx, arbiter.ny)
        for i in range(arbiter.count):
            contact = contacts[index, i]
            a, b = load(movers, arbiter.body1), load(movers, arbiter.body2)
            r1, r2 = Vec2(contact.r1_x, contact.r1_y), Vec2(contact.r2_x, contact.r2_y)
            gap = np.float64(separation_now(a, b, Arms(r1, r2), normal, contact.separation - dot(r2 - r1, normal)))
            arm1, arm2 = cross(rotate(a.q, r1), normal), cross(rotate(b.q, r2), normal)
            write(system, k, arbiter.body1, arbiter.body2, normal, arm1, arm2, max(gap, -most))
            system.low[k] = 0.0
            errors[k] = -gap
            k += 1
    return k


@kernel
def assemble(system, count, motions):
    """J M^-1 J^T of the first `count` rows [1/kg], softened."""
    matrix = np.zeros((count, count))
    for i in range(count):
        for j in range(i + 1):
            value = 0.0
            for side in range(2):
                motion = motions[system.body[i, side]]
                for other in range(2):
                    if system.body[j, other] != system.body[i, side]:
                        continue
                    along = (
                        system.jacobian[i, 0] * system.jacobian[j, 0] + system.jacobian[i, 1] * system.jacobian[j, 1]
                    )
                    turning = system.jacobian[i, 2 + side] * system.jacobian[j, 2 + other]
                    both = np.float64(motion.inverse_mass) * along + np.float64(motion.inverse_inertia) * turning
                    value += both if side == other else -both
            matrix[i, j] = value
            matrix[j, i] = value
        matrix[i, i] += system.give[i]
    return matrix


@kernel
def add_rates(system, count, motions, b):
    """Adds J v."""
    for k in range(count):
        motion1, motion2 = motions[system.body[k, 0]], motions[system.body[k, 1]]
        n = Vec2(system.jacobian[k, 0], system.jacobian[k, 1])
        v1 = Vec2(np.float64(motion1.vx), np.float64(motion1.vy))
        v2 = Vec2(np.float64(motion2.vx), np.float64(motion2.vy))
        turning = system.jacobian[k, 3] * np.float64(motion2.w) - system.jacobian[k, 2] * np.float64(motion1.w)
        b[k] += dot(v2 - v1, n) + turning
