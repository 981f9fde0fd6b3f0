"""The two halves of an iteration: each body is moved to where its forces balance; then multipliers take up errors."""

from __future__ import annotations

import numpy as np

from engine.constants import AVBD_GROWTH
from engine.jit import kernel
from engine.lanes import clamp, const
from engine.solvers.avbd.rows import evaluate
from engine.trigonometry import cos_sin


@kernel
def push_of(row, rows):
    """What a row pushes with, where the bodies are, within its bounds [kg m]; and whether a bound holds it."""
    least, most = row.least, row.most
    if row.normal >= 0:
        most = row.friction * rows[row.normal].multiplier
        least = -most
    change = row.error + row.left - row.start
    wanted = row.multiplier - row.penalty * row.error - row.damper * change
    return clamp(wanted, least, most), wanted < least or wanted > most


@kernel
def move_body(index, bodies, rows, incident, joint_rows, frames, movers):
    """One body: (M + sum of k J J^T) dx = -M (x - target) + sum of J f, its 3x3 system (eq. 5 to 7 and 17).

    Rows that a bound holds, and contacts that are apart, count with their penalty, too. Without, boxes are thrown about
    as contacts come and go from body to body.
    """
    body = bodies[index]
    a_xx, a_yy, a_tt, a_xy, a_xt, a_yt = body.mass, body.mass, body.inertia, 0.0, 0.0, 0.0
    f_x = -body.mass * (body.x - body.target_x)
    f_y = -body.mass * (body.y - body.target_y)
    f_t = -body.inertia * (body.turn - body.target_turn)
    for k in range(body.first, body.first + body.count):
        row = rows[incident[k]]
        evaluate(row, bodies, joint_rows, frames, movers)
        push, _ = push_of(row, rows)
        second = row.body2 == index
        arm, lever, side = (row.arm2, row.lever2, 1.0) if second else (row.arm1, row.lever1, -1.0)
        f_x += side * push * row.nx
        f_y += side * push * row.ny
        f_t += side * push * arm
        a_tt += abs(push) * lever
        stiff = row.penalty + row.damper
        a_xx += stiff * row.nx * row.nx
        a_yy += stiff * row.ny * row.ny
        a_xy += stiff * row.nx * row.ny
        a_xt += stiff * row.nx * arm
        a_yt += stiff * row.ny * arm
        a_tt += stiff * arm * arm
    if body.mass == 0.0:
        a_xx, a_yy, a_xy, a_xt, a_yt, f_x, f_y = 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if body.inertia == 0.0:
        a_tt, a_xt, a_yt, f_t = 1.0, 0.0, 0.0, 0.0
    # L D L^T
    l_yx = a_xy / a_xx
    l_tx = a_xt / a_xx
    d_y = a_yy - l_yx * a_xy
    u_yt = a_yt - l_yx * a_xt
    l_ty = u_yt / d_y
    d_t = a_tt - l_tx * a_xt - l_ty * u_yt
    g_y = f_y - l_yx * f_x
    g_t = f_t - l_tx * f_x - l_ty * g_y
    turn = g_t / d_t
    y = g_y / d_y - l_ty * turn
    x = f_x / a_xx - l_yx * y - l_tx * turn
    body.x += x
    body.y += y
    body.turn += turn
    if joint_rows is not None:
        show(body, movers[index])


@kernel
def show(body, mover):
    """Tells joints' rows where a body is."""
    lane = mover.vx
    mover.dx, mover.dy, mover.turned = const(body.x, lane), const(body.y, lane), const(body.turn, lane)
    cosine, sine = cos_sin(body.turn)
    mover.cosine, mover.sine = const(cosine, lane), const(sine, lane)


@kernel
def take_up(rows, count, bodies, joint_rows, frames, movers):
    """Multipliers take up what the penalty pushed with, and penalties grow with the error that is left (eq. 11 to 13).

    Those that a bound holds do not grow; those of springs take up nothing, and grow up to the spring's stiffness.
    """
    for k in range(count):
        row = rows[k]
        evaluate(row, bodies, joint_rows, frames, movers)
        push, bounded = push_of(row, rows)
        if row.most_penalty == np.inf:
            row.multiplier = push
        if not bounded:
            row.penalty = min(row.penalty + AVBD_GROWTH * row.mass * abs(row.error), row.most_penalty)
