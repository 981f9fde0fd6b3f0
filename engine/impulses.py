"""The talk's velocity update: what an impulse does to a body (Newton's second law, again)."""

from __future__ import annotations

from engine.jit import kernel


@kernel
def push(motion, r, impulse):
    """Gives a body the impulse at r from its centre: v += P / m, w += (r x P) / I."""
    motion.vx += motion.inverse_mass * impulse.x
    motion.vy += motion.inverse_mass * impulse.y
    motion.w += motion.inverse_inertia * (r.x * impulse.y - r.y * impulse.x)


@kernel
def pull(motion, r, impulse):
    """Gives a body the opposite impulse at r from its centre."""
    motion.vx -= motion.inverse_mass * impulse.x
    motion.vy -= motion.inverse_mass * impulse.y
    motion.w -= motion.inverse_inertia * (r.x * impulse.y - r.y * impulse.x)
