"""All substeps of a step, in compiled code."""

from __future__ import annotations

from engine.jit import kernel
from engine.joints import revolute_soft
from engine.solvers.soft_step import contacts, friction, rolling
from engine.solvers.soft_step.movers import integrate_positions, integrate_velocities
from engine.solvers.soft_step.passes import add_given, relax, solve_biased


@kernel
def run_substeps(
    bodies, motions, movers, dynamic, moving, constraints, frictions, belts, rollings, count, joints, joint_order,
    gravity, scales, linear, angular, steps,
):  # fmt: skip
    """frictions, belts, rollings, joints, gravity, scales, linear, angular: None where nothing calls for them."""
    step = steps[0]
    if joints is not None:
        revolute_soft.prepare(joints, joint_order, bodies, motions, step)
    for _ in range(step.substeps):
        integrate_velocities(dynamic, bodies, motions, movers, gravity, scales, linear, angular, step)
        if step.warm_starting != 0:
            if joints is not None:
                revolute_soft.warm_start(joints, joint_order, motions, movers)
            contacts.warm_start(constraints, count, movers)
            if frictions is not None:
                friction.warm_start(constraints, frictions, count, movers)
            if rollings is not None:
                rolling.warm_start(constraints, rollings, count, movers)
        else:
            forget(constraints, frictions, rollings, count)
            if joints is not None:
                revolute_soft.forget(joints, joint_order)
        for _ in range(step.iterations):
            if joints is not None:
                revolute_soft.solve_biased(joints, joint_order, motions, movers, step)
            solve_biased(constraints, count, movers, step.push_out_speed, step.inverse_h)
        integrate_positions(moving, movers, step.h)
        for _ in range(step.iterations):
            if joints is not None:
                revolute_soft.relax(joints, joint_order, motions, movers, step)
            relax(constraints, frictions, belts, rollings, count, movers, step.inverse_h)
        add_given(constraints, frictions, count)
        if joints is not None:
            revolute_soft.add_given(joints, joint_order)
    if joints is not None:
        revolute_soft.store_impulses(joints, joint_order, step)


@kernel
def forget(constraints, frictions, rollings, count):
    """Without warm starting each substep begins with nothing."""
    for k in range(count):
        constraints[k].a_impulse = 0
        constraints[k].b_impulse = 0
        if frictions is not None:
            frictions[k].a_impulse = 0
            frictions[k].b_impulse = 0
        if rollings is not None:
            rollings[k].impulse = 0
