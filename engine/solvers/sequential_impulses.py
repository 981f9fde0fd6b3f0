"""The talk's solver: visit the constraints one after another, give each the impulse that satisfies it, and repeat.

Three ideas make it work, each with a switch: impulses are accumulated and the sum is clamped, so that a later pass may
take back what an earlier one gave too much; a step starts from the impulses of the step before (warm starting); and
overlap is pushed out by a bias velocity (position correction). Source: E. Catto, "How Do Physics Engines Work?" and
"Fast and Simple Physics using Sequential Impulses" (GDC 2006).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import integrate
from engine.impulses import pull, push
from engine.jit import kernel
from engine.joints import revolute
from engine.lanes import clamp, const, maximum, minimum, over
from engine.solvers.solver import Solver
from engine.vec2 import Vec2, cross, dot, right_of

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


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
def prepare_contacts(arbiters, contacts, count, motions, step):
    """Effective masses and biases of all contacts; and the impulses to start from."""
    for index in range(count):
        arbiter = arbiters[index]
        motion1 = motions[arbiter.body1]
        motion2 = motions[arbiter.body2]
        normal = Vec2(arbiter.nx, arbiter.ny)
        tangent = right_of(normal)
        for i in range(arbiter.count):
            contact = contacts[index, i]
            r1 = Vec2(contact.r1_x, contact.r1_y)
            r2 = Vec2(contact.r2_x, contact.r2_y)
            contact.normal_mass = effective_mass(motion1, motion2, r1, r2, normal)
            contact.tangent_mass = effective_mass(motion1, motion2, r1, r2, tangent)
            overlap = minimum(const(0.0, step.slop), contact.separation + step.slop)
            contact.bias = -step.bias_factor * step.inverse_dt * overlap
            contact.normal_arm1 = cross(r1, normal)
            contact.normal_arm2 = cross(r2, normal)
            contact.tangent_arm1 = cross(r1, tangent)
            contact.tangent_arm2 = cross(r2, tangent)
            if step.accumulate_impulses != 0:
                impulse = normal * contact.normal_impulse + tangent * contact.tangent_impulse
                pull(motion1, r1, impulse)
                push(motion2, r2, impulse)


@kernel
def solve_contacts(arbiters, contacts, count, motions, accumulate):
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
            arm1, arm2 = contact.normal_arm1, contact.normal_arm2

            # normal impulse, P_n = max(-m_n v_n, 0), on the sum of all passes
            speed = dot(v2 - v1, normal) + (w2 * arm2 - w1 * arm1)
            change = contact.normal_mass * (contact.bias - speed)
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
            arm1, arm2 = contact.tangent_arm1, contact.tangent_arm2
            speed = dot(v2 - v1, tangent) + (w2 * arm2 - w1 * arm1)
            change = contact.tangent_mass * -speed
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
def solve_all(bodies, motions, arbiters, contacts, count, joints, joint_order, steps):
    """Prepares all constraints, then passes over contacts and joints `iterations` times."""
    step = steps[0]
    prepare_contacts(arbiters, contacts, count, motions, step)
    if joints is not None:
        revolute.prepare(joints, joint_order, bodies, motions, step)
    for _ in range(step.iterations):
        solve_contacts(arbiters, contacts, count, motions, step.accumulate_impulses != 0)
        if joints is not None:
            revolute.solve(joints, joint_order, motions)
    for index in range(count):
        for i in range(arbiters[index].count):
            contacts[index, i].given_normal = contacts[index, i].normal_impulse
            contacts[index, i].given_tangent = contacts[index, i].tangent_impulse
    if joints is not None:
        for rank in range(len(joint_order)):
            joint = joints[joint_order[rank]]
            joint.given_x = joint.impulse_x
            joint.given_y = joint.impulse_y


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
    solve_all(
        bodies, motions, table.rows, table.contacts, table.count, state.active_joints, state.joints.order, state.steps
    )


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
    lacks=("restitution", "rolling resistance", "conveyor"),
)
