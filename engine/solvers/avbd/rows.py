"""The rows of a step: two for each contact point, along the normal and across it, and those of joints."""

from __future__ import annotations

import numpy as np

from engine.constants import AVBD_ALPHA, AVBD_FRICTION_PENALTY, AVBD_GAMMA, AVBD_PENALTY
from engine.jit import kernel
from engine.lanes import over
from engine.solvers.joint_rows.rows import place
from engine.solvers.joint_rows.tables import HOLDS, LOWER, SPRINGS, TURN, UPPER
from engine.vec2 import Vec2, cross, right_of

INFINITE = np.inf


@kernel
def effective_mass(row, bodies):
    """1 / (J M^-1 J^T) [kg]; 0 where nothing moves."""
    one, other = bodies[row.body1], bodies[row.body2]
    inverse = (row.nx * row.nx + row.ny * row.ny) * (over(1.0, one.mass) + over(1.0, other.mass))
    inverse += row.arm1 * row.arm1 * over(1.0, one.inertia) + row.arm2 * row.arm2 * over(1.0, other.inertia)
    return over(1.0, inverse)


@kernel
def write_direction(row, direction, r1, r2):
    """The Jacobian of a contact's row."""
    row.nx, row.ny = np.float64(direction.x), np.float64(direction.y)
    row.arm1, row.arm2 = np.float64(cross(r1, direction)), np.float64(cross(r2, direction))


@kernel
def begin_row(row, source, point, body1, body2):
    """A row that holds, so far."""
    row.source, row.point, row.normal = source, point, -1
    row.body1, row.body2 = body1, body2
    row.lever1 = row.lever2 = row.start = row.left = row.damper = row.friction = 0.0
    row.most_penalty = INFINITE
    row.least, row.most = -INFINITE, INFINITE


@kernel
def left_of(step):
    """Part of an error that is there as the step begins and is left for later steps (eq. 18)."""
    return AVBD_ALPHA if step.position_correction != 0 else 1.0


@kernel
def add_contacts(slots, arbiters, contacts, shapes, bodies, rows, frictional, tangent_speed, step):
    """Rows of the arbiters in `slots`. Returns how many there are.

    frictional, tangent_speed: None where the effect is not called for.
    """
    count = 0
    dt, alpha = np.float64(step.dt), left_of(step)
    carried = AVBD_ALPHA * AVBD_GAMMA * np.float64(step.carried) * dt if step.warm_starting != 0 else 0.0
    for k in range(len(slots)):
        index = slots[k]
        if index == len(arbiters) - 1:  # that of no arbiter
            continue
        arbiter = arbiters[index]
        for i in range(arbiter.count):
            contact = contacts[index, i]
            normal = Vec2(arbiter.nx, arbiter.ny)
            r1, r2 = Vec2(contact.r1_x, contact.r1_y), Vec2(contact.r2_x, contact.r2_y)
            row = rows[count]
            begin_row(row, index, i, arbiter.body1, arbiter.body2)
            write_direction(row, normal, r1, r2)
            row.start = np.float64(contact.separation)
            row.left = min(alpha * row.start, row.start + dt * np.float64(step.push_out_speed), 0.0)
            row.least = 0.0
            row.mass = effective_mass(row, bodies)
            row.multiplier = carried * max(np.float64(contact.normal_impulse), 0.0)
            row.penalty = AVBD_PENALTY * row.mass
            count += 1
            contact.tangent_impulse, kept = contact.tangent_impulse * 0, np.float64(contact.tangent_impulse)
            if frictional is not None and arbiter.friction > 0:
                row = rows[count]
                begin_row(row, index, i, arbiter.body1, arbiter.body2)
                write_direction(row, right_of(normal), r1, r2)
                row.normal = count - 1
                row.friction = np.float64(arbiter.friction)
                if tangent_speed is not None:
                    row.start = -dt * (tangent_speed[arbiter.shape1] + tangent_speed[arbiter.shape2])
                row.mass = effective_mass(row, bodies)
                row.multiplier = carried * kept
                row.penalty = AVBD_FRICTION_PENALTY * row.mass
                count += 1
    return count


@kernel
def add_joints(joint_rows, frames, bodies, rows, count, step):
    """Rows of joints, after those of contacts. Returns how many there are in all."""
    dt, alpha = np.float64(step.dt), left_of(step)
    for k in range(len(joint_rows)):
        found = joint_rows[k]
        frame = frames[found.frame]
        row = rows[count]
        begin_row(row, k, -1, frame.body1, frame.body2)
        take_jacobian(row, found)
        row.start = np.float64(found.error)
        row.mass = effective_mass(row, bodies)
        row.multiplier = AVBD_ALPHA * AVBD_GAMMA * np.float64(found.impulse) * dt
        row.penalty = AVBD_PENALTY * row.mass
        row.least, row.most = np.float64(found.least) * dt, np.float64(found.most) * dt
        if found.use == HOLDS:
            row.left = alpha * row.start
        elif found.use == LOWER:
            row.left = alpha * min(row.start, 0.0)
        elif found.use == UPPER:
            row.left = alpha * max(row.start, 0.0)
        elif found.use == SPRINGS:
            row.most_penalty = dt * dt * np.float64(found.stiffness)
            row.penalty = min(row.penalty, row.most_penalty)
            row.damper = dt * np.float64(found.damping)
            row.multiplier = 0.0
        if found.measures != TURN:
            row.lever1 = np.sqrt(np.float64(frame.arm1_x) ** 2 + np.float64(frame.arm1_y) ** 2)
            row.lever2 = np.sqrt(np.float64(frame.arm2_x) ** 2 + np.float64(frame.arm2_y) ** 2)
        count += 1
    return count


@kernel
def take_jacobian(row, found):
    """That of a joint's row, which turns with the bodies."""
    row.nx, row.ny = np.float64(found.nx), np.float64(found.ny)
    row.arm1, row.arm2 = np.float64(found.arm1), np.float64(found.arm2)


@kernel
def evaluate(row, bodies, joint_rows, frames, movers):
    """Brings a row to where the bodies are: contacts by their first derivative, joints as they are."""
    if joint_rows is not None:
        if row.point < 0:
            found = joint_rows[row.source]
            place(found, frames[found.frame], movers)
            take_jacobian(row, found)
            row.error = np.float64(found.error) - row.left
            return
    one, other = bodies[row.body1], bodies[row.body2]
    along = row.nx * (other.x - one.x) + row.ny * (other.y - one.y)
    row.error = row.start + along + (row.arm2 * other.turn - row.arm1 * one.turn) - row.left


@kernel
def list_rows(rows, count, bodies, order, incident):
    """Which rows each body in `order` has, in their order."""
    for k in range(len(bodies)):
        bodies[k].count = -1
    for k in range(len(order)):
        bodies[order[k]].count = 0
    for k in range(count):
        for side in range(2):
            body = bodies[rows[k].body2] if side == 1 else bodies[rows[k].body1]
            if body.count >= 0:
                body.count += 1
    total = 0
    for k in range(len(order)):
        body = bodies[order[k]]
        body.first = total
        total += body.count
        body.count = 0
    for k in range(count):
        for side in range(2):
            body = bodies[rows[k].body2] if side == 1 else bodies[rows[k].body1]
            if body.count >= 0:
                incident[body.first + body.count] = k
                body.count += 1
