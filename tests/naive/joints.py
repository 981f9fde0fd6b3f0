"""Joints solved at once, slowly: one dense matrix, and Jacobians by differences."""

from __future__ import annotations

import numpy as np

from engine import World
from engine.solvers.soft_step.direct import rows, system
from engine.solvers.soft_step.direct.chains import Chains


def dense_matrix(chains: Chains, give: float) -> np.ndarray:
    """K = J M^-1 J^T of all rows, each softened by a part of its own; 1 on the diagonal for a row that is not there."""
    table, bodies = chains.rows, int(max(chains.rows["body1"].max(), chains.rows["body2"].max())) + 1
    jacobian = np.zeros((3 * len(table), 3 * bodies))
    inverse = np.zeros(3 * bodies)
    for k, row in enumerate(table):
        one, two = 3 * int(row["body1"]), 3 * int(row["body2"])
        inverse[one : one + 3] = row["inverse_mass1"], row["inverse_mass1"], row["inverse_inertia1"]
        inverse[two : two + 3] = row["inverse_mass2"], row["inverse_mass2"], row["inverse_inertia2"]
        for i in range(3):
            x, y, arm1, arm2 = chains.jacobians[k, i]
            jacobian[3 * k + i, one : one + 3] -= x, y, arm1
            jacobian[3 * k + i, two : two + 3] += x, y, arm2
    matrix = (jacobian * inverse) @ jacobian.T
    diagonal = matrix.diagonal()
    return matrix + np.diag(np.where(diagonal > 0.0, give * diagonal, 1.0))


def solve_in_blocks(chains: Chains, wanted: np.ndarray, give: float) -> np.ndarray:
    """The engine's factors and substitution, for a right-hand side (joints, 3)."""
    c, p = chains, chains.plan
    c.blocks[:] = 0.0
    system.write_diagonals(0, len(p.order), c.rows, c.jacobians, c.diagonals, give)
    system.write_couplings(0, len(p.couplings), p.couplings, c.rows, c.jacobians, c.blocks)
    found = wanted.copy()
    for island in p.islands:
        first, last = int(island["first"]), int(island["last"])
        system.factor(first, last, p.columns, p.updates, c.diagonals, c.blocks, c.factors)
        system.substitute(first, last, p.columns, p.places, c.diagonals, c.factors, found)
    return found


def prepare(world: World, chains: Chains) -> None:
    """Errors and Jacobians where the bodies are."""
    state = world._state
    joints, bodies = state.joints.tables, state.bodies.tables
    rows.prepare(
        0, len(chains.plan.order), chains.plan.order, joints["joints"], joints["turns"], joints["slides"],
        bodies["bodies"], bodies["motions"], chains.rows, chains.errors, chains.jacobians,
    )  # fmt: skip


def jacobian_by_differences(world: World, chains: Chains, step: float = 1e-6) -> np.ndarray:
    """(rows, 3, bodies): how errors change as each body is moved along x and y, and turned about its centre."""
    bodies = world.bodies
    found = np.zeros((chains.errors.size, 3, len(bodies)))
    for k, body in enumerate(bodies):
        place, angle = body.position, body.angle
        for way in range(3):
            errors = []
            for sign in (1.0, -1.0):
                x, y, turn = (sign * step * (axis == way) for axis in range(3))
                body.position, body.angle = (place.x + x, place.y + y), angle + turn
                prepare(world, chains)
                errors.append(chains.errors.ravel().copy())
            body.position, body.angle = place, angle
            found[:, way, k] = (errors[0] - errors[1]) / (2 * step)
    prepare(world, chains)
    return found
