"""Contacts by position: what overlaps is moved apart, what slides is moved back, and velocities are put right after.

A push of lambda n moves a body by lambda n / m and, velocities being what bodies moved by over h, adds lambda n / (m h)
to its velocity; both are done at once, which is the paper's x - x_prev without the rounding of two large numbers.
"""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, minimum, over
from engine.mixing import mix
from engine.solvers.soft_step.contacts import (
    Arms,
    Speeds,
    approach,
    mass_along,
    pushed,
    separation_now,
)  # fmt: skip
from engine.solvers.soft_step.movers import Mover, turned_by
from engine.vec2 import Vec2, cross, dot, right_of

SINGULAR = 1e-3
"""Two points of a pair are solved together where det K is more than this part of its largest possible value."""


@kernel
def prepare(slots, arbiters, contacts, motions, pairs, points, frictional):
    """Writes the pairs whose arbiters, by index in `slots`, have contacts, and returns how many there are.

    frictional: the table of steps, or None where nothing rubs.
    """
    count = 0
    for k in range(len(slots)):
        if slots[k] == len(arbiters) - 1:  # that of no arbiter
            continue
        arbiter = arbiters[slots[k]]
        motion1 = motions[arbiter.body1]
        motion2 = motions[arbiter.body2]
        m1, i1 = motion1.inverse_mass, motion1.inverse_inertia
        m2, i2 = motion2.inverse_mass, motion2.inverse_inertia
        zero = const(0.0, m1)
        if m1 + m2 == zero:
            continue
        pair = pairs[count]
        pair.index = slots[k]
        pair.body1, pair.body2, pair.count = arbiter.body1, arbiter.body2, arbiter.count
        pair.nx, pair.ny = arbiter.nx, arbiter.ny
        pair.inverse_mass1, pair.inverse_inertia1 = m1, i1
        pair.inverse_mass2, pair.inverse_inertia2 = m2, i2
        pair.friction = zero
        if frictional is not None:
            pair.friction = arbiter.friction
        pair.belt, pair.restitution, pair.reach, pair.turn_mass, pair.turn = zero, zero, zero, zero, zero
        pair.coupling = zero
        normal = Vec2(pair.nx, pair.ny)
        tangent = right_of(normal)
        for i in range(pair.count):
            contact = contacts[slots[k], i]
            point = points[count, i]
            point.r1_x, point.r1_y = contact.r1_x, contact.r1_y
            point.r2_x, point.r2_y = contact.r2_x, contact.r2_y
            arms = arms_of(point)
            point.separation = contact.separation - dot(arms.r2 - arms.r1, normal)
            point.normal_mass = mass_along(m1 + m2, i1, i2, arms.r1, arms.r2, normal)
            point.tangent_mass = mass_along(m1 + m2, i1, i2, arms.r1, arms.r2, tangent)
            point.given_normal = zero
            point.given_tangent = zero
        if pair.count > 1:
            one, other = arms_of(points[count, 0]), arms_of(points[count, 1])
            turn1 = i1 * cross(one.r1, normal) * cross(other.r1, normal)
            turn2 = i2 * cross(one.r2, normal) * cross(other.r2, normal)
            pair.coupling = m1 + m2 + turn1 + turn2
        count += 1
    return count


@kernel
def prepare_effects(count, arbiters, shapes, pairs, tangent_speed, rolling_resistance, restitutions, rule):
    """What belts, rolling resistance and restitution add; None where the effect is not called for."""
    for k in range(count):
        pair = pairs[k]
        arbiter = arbiters[pair.index]
        one, other = arbiter.shape1, arbiter.shape2
        lane = pair.nx
        if tangent_speed is not None:
            pair.belt = const(tangent_speed[one] + tangent_speed[other], lane)
        if restitutions is not None:
            pair.restitution = const(mix(rule, restitutions[one], restitutions[other]), lane)
        if rolling_resistance is not None:
            reach1 = const(rolling_resistance[one] * shapes[one].radius, lane)
            reach2 = const(rolling_resistance[other] * shapes[other].radius, lane)
            pair.reach = maximum(reach1, reach2)
            pair.turn_mass = over(const(1.0, lane), pair.inverse_inertia1 + pair.inverse_inertia2)


@kernel
def arms_of(point):
    """Where a point is from the two centres of mass."""
    return Arms(Vec2(point.r1_x, point.r1_y), Vec2(point.r2_x, point.r2_y))


@kernel
def mover_of(movers, row):
    """One body, in numbers."""
    m = movers[row]
    return Mover(Vec2(m.vx, m.vy), m.w, m.turned, Vec2(m.dx, m.dy), Vec2(m.cosine, m.sine))


@kernel
def speeds_of(movers, pair):
    """How the two bodies of a pair move."""
    one, other = movers[pair.body1], movers[pair.body2]
    return Speeds(Vec2(one.vx, one.vy), one.w, Vec2(other.vx, other.vy), other.w)


@kernel
def keep_speeds(movers, pair, speeds):
    """Writes how they move after a push."""
    one, other = movers[pair.body1], movers[pair.body2]
    one.vx, one.vy, one.w = speeds.v1.x, speeds.v1.y, speeds.w1
    other.vx, other.vy, other.w = speeds.v2.x, speeds.v2.y, speeds.w2


@kernel
def move(mover, inverse_mass, inverse_inertia, push, turn, inverse_h):
    """Moves one body by a push p [kg m] and a turn r x p: x += p / m, the angle += turn / I, velocities by that over h.

    (eq. 6 to 9)
    """
    x, y = inverse_mass * push.x, inverse_mass * push.y
    angle = inverse_inertia * turn
    mover.dx += x
    mover.dy += y
    mover.turned += angle
    q = turned_by(Vec2(mover.cosine, mover.sine), angle)
    mover.cosine, mover.sine = q.x, q.y
    mover.vx += x * inverse_h
    mover.vy += y * inverse_h
    mover.w += angle * inverse_h


@kernel
def move_pair(movers, pair, arms, push, inverse_h):
    """Moves body2 by a push, and body1 against it."""
    move(movers[pair.body1], pair.inverse_mass1, pair.inverse_inertia1, -push, -cross(arms.r1, push), inverse_h)
    move(movers[pair.body2], pair.inverse_mass2, pair.inverse_inertia2, push, cross(arms.r2, push), inverse_h)


@kernel
def separation_of(movers, pair, point):
    """The separation of a point now [m]."""
    one, other = mover_of(movers, pair.body1), mover_of(movers, pair.body2)
    return separation_now(one, other, arms_of(point), Vec2(pair.nx, pair.ny), point.separation)


@kernel
def begin(count, movers, pairs, points, step):
    """As a substep begins: no multiplier yet; how fast points approach; and how much overlap may go.

    Overlap that is there already goes at most at the push-out speed, and not at all without position correction.
    """
    for k in range(count):
        pair = pairs[k]
        speeds = speeds_of(movers, pair)
        normal = Vec2(pair.nx, pair.ny)
        zero = const(0.0, pair.nx)
        most = step.push_out_speed * step.h if step.position_correction != 0 else zero
        pair.turn = zero
        for i in range(pair.count):
            point = points[k, i]
            point.before = approach(speeds, arms_of(point), normal)
            point.rest = minimum(separation_of(movers, pair, point) + most, zero)
            point.normal = zero
            point.tangent = zero


@kernel
def both(mass_a, mass_b, coupling, gap_a, gap_b, old_a, old_b):
    """Multipliers a, b >= 0 of the two points of a pair, where neither gap stays below 0, or only where it is pushed.

    mass_a, mass_b: 1 / K_aa, 1 / K_bb; coupling: K_ab; gap: as things are, with the multipliers old_a and old_b. The
    gaps are K (a, b) + q; of the four cases, both pushed, either, none, the one that agrees with itself holds. Where K
    is nearly singular, as of a body that does not turn, one point is pushed after the other.
    """
    one, zero = const(1.0, mass_a), const(0.0, mass_a)
    k_aa, k_bb = one / mass_a, one / mass_b
    q_a = gap_a - k_aa * old_a - coupling * old_b
    q_b = gap_b - coupling * old_a - k_bb * old_b
    determinant = k_aa * k_bb - coupling * coupling
    if determinant > const(SINGULAR, one) * k_aa * k_bb:
        a = (coupling * q_b - k_bb * q_a) / determinant
        b = (coupling * q_a - k_aa * q_b) / determinant
        if a >= zero and b >= zero:
            return a, b
        a = maximum(-mass_a * q_a, zero)
        if q_b + coupling * a >= zero:
            return a, zero
        return zero, maximum(-mass_b * q_b, zero)
    a = maximum(-mass_a * (q_a + coupling * old_b), zero)
    return a, maximum(-mass_b * (q_b + coupling * a), zero)


@kernel
def solve_positions(count, movers, pairs, points, frictional, step):
    """One pass: each pair is moved out of overlap, and then back along the surface, within the friction cone.

    The multipliers are accumulated and their sums bounded, lambda_n >= 0 and |lambda_t| <= mu lambda_n. frictional:
    None where nothing rubs.
    """
    for k in range(count):
        pair = pairs[k]
        normal = Vec2(pair.nx, pair.ny)
        zero = const(0.0, pair.nx)
        point, other = points[k, 0], points[k, 1]
        gap = separation_of(movers, pair, point) - point.rest
        if pair.count > 1:
            other_gap = separation_of(movers, pair, other) - other.rest
            total, other_total = both(
                point.normal_mass, other.normal_mass, pair.coupling, gap, other_gap, point.normal, other.normal
            )
            change, other.normal = other_total - other.normal, other_total
            if change != zero:
                move_pair(movers, pair, arms_of(other), normal * change, step.inverse_h)
        else:
            total = maximum(point.normal - point.normal_mass * gap, zero)
        change, point.normal = total - point.normal, total
        if change != zero:
            move_pair(movers, pair, arms_of(point), normal * change, step.inverse_h)
        if frictional is not None:
            for i in range(pair.count):
                if points[k, i].normal != zero:
                    hold_back(movers, pair, points[k, i], step)


@kernel
def hold_back(movers, pair, point, step):
    """Static friction: what a point slid in this substep, it is moved back (3.5)."""
    arms, tangent, limit = arms_of(point), right_of(Vec2(pair.nx, pair.ny)), pair.friction * point.normal
    slid = step.h * (approach(speeds_of(movers, pair), arms, tangent) - pair.belt)
    total = clamp(point.tangent - point.tangent_mass * slid, -limit, limit)
    change, point.tangent = total - point.tangent, total
    move_pair(movers, pair, arms, tangent * change, step.inverse_h)


@kernel
def solve_velocities(count, movers, pairs, points, frictional, rolls, bounces, step):
    """After the positions: speed that only came of pushing out is taken back, shapes bounce, friction acts (3.6).

    A point counts if it was pushed in this substep. Its impulses of both passes stay in the cone together, so that a
    contact never pulls and never rubs twice. frictional, rolls, bounces: None where the effect is not called for.
    """
    for k in range(count):
        pair = pairs[k]
        for i in range(pair.count):
            point = points[k, i]
            point.normal *= step.inverse_h  # from here on impulses [N s]
            point.tangent *= step.inverse_h
        speeds = put_right(pair, points[k, 0], points[k, 1], speeds_of(movers, pair), bounces, step)
        load = const(0.0, pair.nx)
        for i in range(pair.count):
            point = points[k, i]
            load = load + point.normal
            if frictional is not None:
                speeds = rub(pair, point, speeds)
            point.given_normal += point.normal
            point.given_tangent += point.tangent
        w1, w2 = speeds.w1, speeds.w2
        if rolls is not None:
            most = pair.reach * load
            pair.turn = clamp(-pair.turn_mass * (w2 - w1), -most, most)
            w1 = w1 - pair.inverse_inertia1 * pair.turn
            w2 = w2 + pair.inverse_inertia2 * pair.turn
        keep_speeds(movers, pair, Speeds(speeds.v1, w1, speeds.v2, w2))


@kernel
def wanted(pair, point, bounces, step):
    """Speed along the normal at which shapes are to part (eq. 34): 0 unless they bounce."""
    if bounces is not None:
        if point.before < -step.restitution_threshold:
            return -pair.restitution * point.before
    return const(0.0, point.before)


@kernel
def put_right(pair, point, other, speeds, bounces, step):
    """The normal part: shapes that were pushed apart neither part nor approach, or bounce. Returns the speeds after."""
    zero = const(0.0, pair.nx)
    normal, arms, other_arms = Vec2(pair.nx, pair.ny), arms_of(point), arms_of(other)
    first, second = point.normal > zero, pair.count > 1 and other.normal > zero
    gap, other_gap = zero, zero
    if first:
        gap = approach(speeds, arms, normal) - wanted(pair, point, bounces, step)
    if second:
        other_gap = approach(speeds, other_arms, normal) - wanted(pair, other, bounces, step)
    if first and second:
        total, other_total = both(
            point.normal_mass, other.normal_mass, pair.coupling, gap, other_gap, point.normal, other.normal
        )
    else:
        total = maximum(point.normal - point.normal_mass * gap, zero)
        other_total = maximum(other.normal - other.normal_mass * other_gap, zero) if second else zero
    if first:
        change, point.normal = total - point.normal, total
        speeds = pushed(speeds, pair, arms, normal * change)
    if second:
        change, other.normal = other_total - other.normal, other_total
        speeds = pushed(speeds, pair, other_arms, normal * change)
    return speeds


@kernel
def rub(pair, point, speeds):
    """Dynamic friction, within what is left of the cone (eq. 30)."""
    arms, tangent, limit = arms_of(point), right_of(Vec2(pair.nx, pair.ny)), pair.friction * point.normal
    speed = approach(speeds, arms, tangent) - pair.belt
    total = clamp(point.tangent - point.tangent_mass * speed, -limit, limit)
    change, point.tangent = total - point.tangent, total
    return pushed(speeds, pair, arms, tangent * change)


@kernel
def store(count, pairs, points, arbiters, contacts):
    """Notes for whoever asks what contacts gave. The next step starts from nothing: see docs/solvers.md."""
    for k in range(count):
        pair = pairs[k]
        arbiters[pair.index].rolling_impulse = pair.turn
        for i in range(pair.count):
            contact, point = contacts[pair.index, i], points[k, i]
            contact.normal_impulse = contact.given_normal = point.given_normal
            contact.tangent_impulse = contact.given_tangent = point.given_tangent
