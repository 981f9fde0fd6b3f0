"""The talk's solver: visit the constraints one after another, give each the impulse that satisfies it, and repeat.

Three ideas make it work, each with a switch: impulses are accumulated and the sum is clamped, so that a later pass may
take back what an earlier one gave too much; a step starts from the impulses of the step before (warm starting); and
overlap is pushed out by a bias velocity (position correction). Source: E. Catto, "How Do Physics Engines Work?" and
"Fast and Simple Physics using Sequential Impulses" (GDC 2006).
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from engine import integrate
from engine.impulses import pull, push
from engine.jit import kernel
from engine.lanes import clamp, const, maximum, minimum, over
from engine.solvers import talk_joints
from engine.solvers.solver import Solver
from engine.tables import JOINT_KINDS, REALS, empty
from engine.vec2 import Vec2, cross, dot, right_of

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@cache
def point_dtype(precision: str) -> np.dtype:
    """What a pass needs of a contact beside its impulses; made afresh each step."""
    real = REALS[precision]
    return np.dtype(
        [
            ("normal_mass", real),  # effective mass along the normal [kg]
            ("tangent_mass", real),  # and along the tangent [kg]
            ("normal_arm1", real),  # r1 x n: how an impulse along the normal turns body1 [m]
            ("normal_arm2", real),
            ("tangent_arm1", real),  # r1 x t [m]
            ("tangent_arm2", real),
            ("bias", real),  # velocity that removes overlap [m/s]
        ]
    )


@kernel
def effective_mass(motion1, motion2, r1, r2, direction):
    """Mass that an impulse along a unit direction feels at a contact [kg].

    1/m_n = 1/m1 + 1/m2 + [(r1 x n) x r1 / I1 + (r2 x n) x r2 / I2] . n   (talk, "Solution")
    """
    along1 = dot(r1, direction)
    along2 = dot(r2, direction)
    turning1 = motion1.inverse_inertia * (dot(r1, r1) - along1 * along1)
    turning2 = motion2.inverse_inertia * (dot(r2, r2) - along2 * along2)
    inverse = motion1.inverse_mass + motion2.inverse_mass + (turning1 + turning2)
    return over(const(1.0, inverse), inverse)


@kernel
def prepare_contacts(arbiters, contacts, count, motions, points, step):
    """Effective masses and biases of all contacts; and the impulses to start from."""
    for index in range(count):
        arbiter = arbiters[index]
        motion1 = motions[arbiter.body1]
        motion2 = motions[arbiter.body2]
        normal = Vec2(arbiter.nx, arbiter.ny)
        tangent = right_of(normal)
        for i in range(arbiter.count):
            contact = contacts[index, i]
            point = points[index, i]
            r1 = Vec2(contact.r1_x, contact.r1_y)
            r2 = Vec2(contact.r2_x, contact.r2_y)
            point.normal_mass = effective_mass(motion1, motion2, r1, r2, normal)
            point.tangent_mass = effective_mass(motion1, motion2, r1, r2, tangent)
            overlap = minimum(const(0.0, step.slop), contact.separation + step.slop)
            point.bias = -step.bias_factor * step.inverse_dt * overlap
            point.normal_arm1 = cross(r1, normal)
            point.normal_arm2 = cross(r2, normal)
            point.tangent_arm1 = cross(r1, tangent)
            point.tangent_arm2 = cross(r2, tangent)
            if step.accumulate_impulses != 0:
                impulse = normal * contact.normal_impulse + tangent * contact.tangent_impulse
                pull(motion1, r1, impulse)
                push(motion2, r2, impulse)


@kernel
def solve_contacts(arbiters, contacts, points, count, motions, accumulate):
    """One pass over all contacts: first the normal impulse, then friction bounded by it.

    Each contact waits for the one before it, so what counts is the longest chain of dependent operations. The talk's
    dv . n = (v2 + w2 x r2 - v1 - w1 x r1) . n is therefore computed as (v2 - v1) . n + w2 (r2 x n) - w1 (r1 x n), with
    the cross products, called arms, prepared: a quarter less time, equal but for rounding.
    """
    for index in range(count):
        arbiter = arbiters[index]
        motion1 = motions[arbiter.body1]
        motion2 = motions[arbiter.body2]
        v1, w1 = Vec2(motion1.vx, motion1.vy), motion1.w
        v2, w2 = Vec2(motion2.vx, motion2.vy), motion2.w
        i1, i2 = motion1.inverse_inertia, motion2.inverse_inertia
        friction = arbiter.friction
        normal = Vec2(arbiter.nx, arbiter.ny)
        tangent = right_of(normal)
        normal1, normal2 = normal * motion1.inverse_mass, normal * motion2.inverse_mass
        tangent1, tangent2 = tangent * motion1.inverse_mass, tangent * motion2.inverse_mass
        for i in range(arbiter.count):
            contact = contacts[index, i]
            point = points[index, i]
            arm1, arm2 = point.normal_arm1, point.normal_arm2

            # normal impulse, P_n = max(-m_n v_n, 0), on the sum of all passes
            speed = dot(v2 - v1, normal) + (w2 * arm2 - w1 * arm1)
            change = point.normal_mass * (point.bias - speed)
            zero = const(0.0, change)
            if accumulate:
                before = contact.normal_impulse
                total = maximum(before + change, zero)
                contact.normal_impulse = total
                change = total - before
            else:
                change = total = maximum(change, zero)
            v1 = v1 - normal1 * change
            w1 = w1 - (i1 * arm1) * change
            v2 = v2 + normal2 * change
            w2 = w2 + (i2 * arm2) * change

            # friction, |P_t| <= mu P_n
            limit = friction * total
            arm1, arm2 = point.tangent_arm1, point.tangent_arm2
            speed = dot(v2 - v1, tangent) + (w2 * arm2 - w1 * arm1)
            change = point.tangent_mass * -speed
            if accumulate:
                before = contact.tangent_impulse
                total = clamp(before + change, -limit, limit)
                contact.tangent_impulse = total
                change = total - before
            else:
                change = clamp(change, -limit, limit)
            v1 = v1 - tangent1 * change
            w1 = w1 - (i1 * arm1) * change
            v2 = v2 + tangent2 * change
            w2 = w2 + (i2 * arm2) * change
        motion1.vx, motion1.vy, motion1.w = v1.x, v1.y, w1
        motion2.vx, motion2.vy, motion2.w = v2.x, v2.y, w2


@kernel
def solve_all(bodies, motions, arbiters, contacts, count, joints, turns, joint_order, points, steps):
    """Prepares all constraints, then passes over contacts and joints `iterations` times."""
    step = steps[0]
    prepare_contacts(arbiters, contacts, count, motions, points, step)
    if joints is not None:
        talk_joints.prepare(joints, turns, joint_order, bodies, motions, step)
    for _ in range(step.iterations):
        solve_contacts(arbiters, contacts, points, count, motions, step.accumulate_impulses != 0)
        if joints is not None:
            talk_joints.solve(joints, turns, joint_order, motions, step.dt)
    for index in range(count):
        for i in range(arbiters[index].count):
            contacts[index, i].given_normal = contacts[index, i].normal_impulse
            contacts[index, i].given_tangent = contacts[index, i].tangent_impulse
    if joints is not None:
        talk_joints.store(joints, turns, joint_order)


def apply_forces(state: State, settings: Settings) -> int:
    """Stage 2 of the talk."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    gravity = state.steps if "gravity" in state.effects else None
    return int(
        integrate.apply_forces(
            state.dynamic, bodies, motions, gravity, state.gravity_scales, state.linear_damping,
            state.angular_damping, state.steps,
        )
    )  # fmt: skip


def solve(state: State, settings: Settings) -> None:
    """Stage 3 of the talk."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    table = state.arbiters
    turns = (
        state.joints.tables["turns"] if state.active_joints is not None and "joint motors" in state.effects else None
    )
    points = state.scratch.get("points")
    if points is None or len(points) < table.count:
        points = state.scratch["points"] = empty((2 * table.count, 2), point_dtype(state.precision))
    solve_all(
        bodies, motions, table.rows, table.contacts, table.count, state.active_joints, turns, state.joints.order,
        points, state.steps,
    )  # fmt: skip


def update_positions(state: State, settings: Settings) -> int:
    """Stage 4 of the talk."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    return int(integrate.update_positions(state.bodies.order, bodies, motions, state.steps))


SEQUENTIAL_IMPULSES = Solver(
    "sequential_impulses",
    apply_forces,
    solve,
    update_positions,
    iterations=10,
    talk_clipping=True,
    lacks=(
        "restitution",
        "rolling resistance",
        "conveyor",
        "bullets",
        "joint springs",
        "joint limits",
        *(f"{kind} joints" for kind in JOINT_KINDS if kind not in ("revolute", "filter")),
    ),
)
