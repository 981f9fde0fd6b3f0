"""The talk's joint, for sequential_impulses: a point of body1 and a point of body2 stay together, as if pinned.

It removes the relative velocity of its two anchors, softly if asked:
K P = bias - dv - softness P, K being the 2x2 matrix that turns an impulse into a change of dv (GDC 2006 slides,
"Joints" and "soft constraints" of Box2D Lite).

Its motor turns body2 over body1: w2 - w1 = motor speed, |P_m| <= max motor torque x dt, with the effective mass
1 / (1/I1 + 1/I2), the point where the joint holds taken for free. It comes before the joint's own constraint in every
pass, and both agree as the passes go on.
"""

from __future__ import annotations

from engine.constants import JOINT_BIAS_FACTOR
from engine.impulses import pull, push
from engine.jit import kernel
from engine.lanes import clamp, const, over
from engine.origin import center_of, origin_of
from engine.vec2 import Vec2, rotate, spin


@kernel
def write_effective_mass(joint, motion1, motion2, r1, r2):
    """Writes the inverse of K = (1/m1 + 1/m2) 1 - [r1]x 1/I1 [r1]x - [r2]x 1/I2 [r2]x, softened [kg]."""
    i1 = motion1.inverse_inertia
    i2 = motion2.inverse_inertia
    free = motion1.inverse_mass + motion2.inverse_mass
    k_xx = free + i1 * r1.y * r1.y + i2 * r2.y * r2.y + joint.softness
    k_xy = -(i1 * r1.x * r1.y) - i2 * r2.x * r2.y
    k_yy = free + i1 * r1.x * r1.x + i2 * r2.x * r2.x + joint.softness
    inverse_determinant = over(const(1.0, k_xx), k_xx * k_yy - k_xy * k_xy)
    joint.mass_xx = inverse_determinant * k_yy
    joint.mass_xy = -inverse_determinant * k_xy
    joint.mass_yy = inverse_determinant * k_xx


@kernel
def prepare(joints, turns, order, bodies, motions, step):
    """Turns the anchors, computes effective masses and biases, and starts from the impulses of the last step.

    turns: None where no joint has a motor.
    """
    for rank in range(len(order)):
        joint = joints[order[rank]]
        body1 = bodies[joint.body1]
        body2 = bodies[joint.body2]
        motion1 = motions[joint.body1]
        motion2 = motions[joint.body2]
        lane = motion1.vx
        q1 = Vec2(motion1.cosine, motion1.sine)
        q2 = Vec2(motion2.cosine, motion2.sine)
        arm1 = Vec2(const(joint.anchor1_x - body1.local_x, lane), const(joint.anchor1_y - body1.local_y, lane))
        arm2 = Vec2(const(joint.anchor2_x - body2.local_x, lane), const(joint.anchor2_y - body2.local_y, lane))
        r1 = rotate(q1, arm1)
        r2 = rotate(q2, arm2)
        joint.r1_x = r1.x
        joint.r1_y = r1.y
        joint.r2_x = r2.x
        joint.r2_y = r2.y
        write_effective_mass(joint, motion1, motion2, r1, r2)

        rate = const(0.0, lane)
        if step.position_correction != 0:
            factor = joint.bias_factor
            if factor < const(0.0, lane):
                factor = const(JOINT_BIAS_FACTOR, lane)
            rate = factor * step.inverse_dt
        origin = origin_of(body1, lane)
        apart = (center_of(body2, origin, lane) + r2) - (center_of(body1, origin, lane) + r1)
        joint.bias_x = -rate * apart.x
        joint.bias_y = -rate * apart.y
        if step.warm_starting == 0:
            joint.impulse_x = 0
            joint.impulse_y = 0
        if turns is not None:
            start_motor(turns[order[rank]], motion1, motion2, step)
        impulse = Vec2(joint.impulse_x, joint.impulse_y)
        pull(motion1, r1, impulse)
        push(motion2, r2, impulse)


@kernel
def solve(joints, turns, order, motions, dt):
    """One pass over the joints, each removing what is left of its anchors' relative velocity, its motor first."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        motion1 = motions[joint.body1]
        motion2 = motions[joint.body2]
        if turns is not None:
            drive_motor(turns[order[rank]], motion1, motion2, dt)
        r1 = Vec2(joint.r1_x, joint.r1_y)
        r2 = Vec2(joint.r2_x, joint.r2_y)
        v1 = Vec2(motion1.vx, motion1.vy)
        v2 = Vec2(motion2.vx, motion2.vy)
        dv = v2 + spin(motion2.w, r2) - v1 - spin(motion1.w, r1)
        wanted_x = joint.bias_x - dv.x - joint.softness * joint.impulse_x
        wanted_y = joint.bias_y - dv.y - joint.softness * joint.impulse_y
        impulse = Vec2(
            joint.mass_xx * wanted_x + joint.mass_xy * wanted_y,
            joint.mass_xy * wanted_x + joint.mass_yy * wanted_y,
        )
        pull(motion1, r1, impulse)
        push(motion2, r2, impulse)
        joint.impulse_x += impulse.x
        joint.impulse_y += impulse.y


@kernel
def start_motor(turn, motion1, motion2, step):
    """Gives the bodies what the motor gave in the step before."""
    turn.motor_impulse = turn.motor_impulse * step.carried
    if step.warm_starting == 0 or turn.motored == 0:
        turn.motor_impulse = 0
    motion1.w -= motion1.inverse_inertia * turn.motor_impulse
    motion2.w += motion2.inverse_inertia * turn.motor_impulse


@kernel
def drive_motor(turn, motion1, motion2, dt):
    """One pass of a motor."""
    if turn.motored == 0:
        return
    inverse = motion1.inverse_inertia + motion2.inverse_inertia
    mass = over(const(1.0, inverse), inverse)
    most = const(turn.max_motor, inverse) * dt
    speed = motion2.w - motion1.w - const(turn.motor_speed, inverse)
    total = clamp(turn.motor_impulse - mass * speed, -most, most)
    change = total - turn.motor_impulse
    turn.motor_impulse = total
    motion1.w -= motion1.inverse_inertia * change
    motion2.w += motion2.inverse_inertia * change


@kernel
def store(joints, turns, order):
    """Notes what was given."""
    for rank in range(len(order)):
        joint = joints[order[rank]]
        joint.given_x = joint.impulse_x
        joint.given_y = joint.impulse_y
        if turns is not None:
            turns[order[rank]].motor_given = turns[order[rank]].motor_impulse
