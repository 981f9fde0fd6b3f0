"""The revolute joint in soft_step: its two anchors stay together as if by a stiff, damped spring.

With C the way from anchor to anchor, one pass gives the impulse -K^-1 (mass_scale (dC/dt + bias_rate C))
- impulse_scale P, K being the 2x2 matrix that turns an impulse into a change of dC/dt; see softness.py.

A joint with a softness of its own is that spring: softness 1/(dt (d + dt k)) and bias factor dt k/(d + dt k) give the
stiffness k [N/m] and the damper d [N s/m], which then act in every substep: (K + 1/(h (d + h k))) P = -dC/dt -
k/(d + h k) C - P_before/(h (d + h k)). A rigid one with a bias factor of its own loses that part of C a step.
"""

from __future__ import annotations

from engine.constants import JOINT_BIAS_FACTOR
from engine.jit import kernel
from engine.lanes import const, over
from engine.origin import center_of, origin_of
from engine.vec2 import Vec2, cross, rotate, spin


@kernel
def prepare(joints, order, bodies, motions, step):
    """Turns the anchors as the step begins, and takes the softness of each joint."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        body1 = bodies[joint.body1]
        body2 = bodies[joint.body2]
        motion1 = motions[joint.body1]
        motion2 = motions[joint.body2]
        lane = motion1.vx
        arm1 = Vec2(const(joint.anchor1_x - body1.local_x, lane), const(joint.anchor1_y - body1.local_y, lane))
        arm2 = Vec2(const(joint.anchor2_x - body2.local_x, lane), const(joint.anchor2_y - body2.local_y, lane))
        r1 = rotate(Vec2(motion1.cosine, motion1.sine), arm1)
        r2 = rotate(Vec2(motion2.cosine, motion2.sine), arm2)
        origin = origin_of(body1, lane)
        apart = center_of(body2, origin, lane) - center_of(body1, origin, lane)
        joint.r1_x, joint.r1_y = r1.x, r1.y
        joint.r2_x, joint.r2_y = r2.x, r2.y
        joint.apart_x, joint.apart_y = apart.x, apart.y
        joint.given_x = const(0.0, lane)
        joint.given_y = const(0.0, lane)
        joint.impulse_x *= step.carried
        joint.impulse_y *= step.carried
        soften(joint, step)


@kernel
def soften(joint, step):
    """Writes bias rate, mass scale, impulse scale and what is added to K of one joint."""
    zero = const(0.0, step.h)
    one = const(1.0, step.h)
    joint.give = zero
    if joint.softness > zero:
        whole = one / (joint.softness * step.dt)  # d + dt k
        k = const(0.0, step.h)
        if step.position_correction != 0:
            factor = joint.bias_factor
            if factor < zero:
                factor = const(JOINT_BIAS_FACTOR, step.h)
            k = factor * whole * step.inverse_dt
        d = whole - k * step.dt
        joint.give = one / (step.h * (d + step.h * k))
        joint.bias_rate = k / (d + step.h * k)
        joint.mass_scale = one
        joint.impulse_scale = zero
    elif joint.bias_factor >= zero:
        joint.bias_rate = zero
        if step.position_correction != 0:
            joint.bias_rate = joint.bias_factor * step.inverse_dt
        joint.mass_scale = one
        joint.impulse_scale = zero
    else:
        joint.bias_rate = step.joint_bias_rate
        joint.mass_scale = step.joint_mass_scale
        joint.impulse_scale = step.joint_impulse_scale


@kernel
def push(mover, motion, r, impulse):
    """Gives a body an impulse at r from its centre."""
    mover.vx += motion.inverse_mass * impulse.x
    mover.vy += motion.inverse_mass * impulse.y
    mover.w += motion.inverse_inertia * cross(r, impulse)


@kernel
def warm_start(joints, order, motions, movers):
    """Gives the bodies the impulses of the substep before."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        mover1 = movers[joint.body1]
        mover2 = movers[joint.body2]
        impulse = Vec2(joint.impulse_x, joint.impulse_y)
        r1 = rotate(Vec2(mover1.cosine, mover1.sine), Vec2(joint.r1_x, joint.r1_y))
        r2 = rotate(Vec2(mover2.cosine, mover2.sine), Vec2(joint.r2_x, joint.r2_y))
        push(mover1, motions[joint.body1], r1, -impulse)
        push(mover2, motions[joint.body2], r2, impulse)


@kernel
def solve_one(joint, motion1, motion2, mover1, mover2, bias_rate, mass_scale, impulse_scale):
    """Removes the relative velocity of the two anchors, and part of what is between them."""
    r1 = rotate(Vec2(mover1.cosine, mover1.sine), Vec2(joint.r1_x, joint.r1_y))
    r2 = rotate(Vec2(mover2.cosine, mover2.sine), Vec2(joint.r2_x, joint.r2_y))
    way = Vec2(mover2.dx - mover1.dx, mover2.dy - mover1.dy)
    apart = (way + Vec2(joint.apart_x, joint.apart_y)) + (r2 - r1)
    dv = (Vec2(mover2.vx, mover2.vy) + spin(mover2.w, r2)) - (Vec2(mover1.vx, mover1.vy) + spin(mover1.w, r1))
    i1 = motion1.inverse_inertia
    i2 = motion2.inverse_inertia
    free = motion1.inverse_mass + motion2.inverse_mass + joint.give
    k_xx = free + i1 * r1.y * r1.y + i2 * r2.y * r2.y
    k_xy = -(i1 * r1.x * r1.y) - i2 * r2.x * r2.y
    k_yy = free + i1 * r1.x * r1.x + i2 * r2.x * r2.x
    inverse = over(mass_scale, k_xx * k_yy - k_xy * k_xy)
    before = Vec2(joint.impulse_x, joint.impulse_y)
    wanted = -(dv + apart * bias_rate) - before * joint.give
    impulse = Vec2(
        inverse * (k_yy * wanted.x - k_xy * wanted.y) - impulse_scale * before.x,
        inverse * (k_xx * wanted.y - k_xy * wanted.x) - impulse_scale * before.y,
    )
    joint.impulse_x += impulse.x
    joint.impulse_y += impulse.y
    push(mover1, motion1, r1, -impulse)
    push(mover2, motion2, r2, impulse)


@kernel
def solve_biased(joints, order, motions, movers, step):
    """One pass over the joints, with bias."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        a, b = joint.body1, joint.body2
        solve_one(
            joint, motions[a], motions[b], movers[a], movers[b],
            joint.bias_rate, joint.mass_scale, joint.impulse_scale,
        )  # fmt: skip


@kernel
def relax(joints, order, motions, movers, step):
    """One pass without bias; a spring keeps its own, it is a force and no error."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        a, b = joint.body1, joint.body2
        zero = const(0.0, step.h)
        rate = zero
        if joint.softness > zero:
            rate = joint.bias_rate
        solve_one(joint, motions[a], motions[b], movers[a], movers[b], rate, const(1.0, step.h), zero)


@kernel
def forget(joints, order):
    """Without warm starting each substep begins with nothing."""
    for rank in range(len(order)):
        joints[order[rank]].impulse_x = 0
        joints[order[rank]].impulse_y = 0


@kernel
def add_given(joints, order):
    """Sums up what a substep gave."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        joint.given_x += joint.impulse_x
        joint.given_y += joint.impulse_y


@kernel
def store_impulses(joints, order, step):
    """Keeps the impulses, as for a whole step."""
    for rank in range(len(order)):
        joints[order[rank]].impulse_x *= step.parts
        joints[order[rank]].impulse_y *= step.parts
