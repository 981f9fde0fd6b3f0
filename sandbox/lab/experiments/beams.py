"""Beams of welds: moments and forces in them, and how far they sag."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import G, Measure, Watch, experiment, late, levels, of_soft_step
from sandbox.lab.experiments.joined import held_hertz

PIECES, PIECE, PIECE_MASS, DEPTH = 4, 2.0, 1.0, 0.5  # -, [m], [kg], [m]
PIECE_INERTIA = PIECE_MASS * (PIECE**2 + DEPTH**2) / 12.0  # [kg m^2]
MOMENTS = references.cantilever_moments(PIECES, PIECE, PIECE_MASS, G)
SHEARS = references.hanging_loads((PIECE_MASS,) * PIECES, G)


def predicted_tip(world: World, dt: float) -> float:
    """How far the middle of the last piece sinks, as soft welds give way [m].

    A weld turns by M / (m_e w^2), 1 / m_e = 1/I1 + 1/I2, and its point gives way by F (1/m1 + 1/m2 + (L/2)^2 (1/I1 +
    1/I2)) / w^2; what lies beyond goes along.
    """
    sides = np.full(PIECES, 2.0)
    sides[0] = 1.0  # the wall does not move
    easy, reach = sides / PIECE_INERTIA, PIECE * (PIECES - 0.5)
    hertz = held_hertz(world, dt, float((SHEARS * (sides / PIECE_MASS + reach * reach * easy)).max()))
    gaps = SHEARS * (sides / PIECE_MASS + 0.25 * PIECE * PIECE * easy)
    beyond = PIECE * (PIECES - 0.5 - np.arange(PIECES))
    return float(np.sum(MOMENTS * easy * beyond + gaps)) / (2.0 * math.pi * hertz) ** 2


@experiment(
    "cantilever",
    f"a beam of {PIECES} pieces, welded to a wall and to each other, carries itself",
    seconds=2.0,
    measures=(
        Measure(
            "moment",
            "relative",
            "the moment at its welds, at worst",
            lambda history, dt: float(np.abs(late(history, dt)[:, :PIECES] / (MOMENTS * dt) - 1.0).max(axis=1).mean()),
            against="what the weights beyond each come to",
        ),
        Measure(
            "force",
            "relative",
            "the force at its welds, at worst",
            lambda history, dt: float(
                np.abs(late(history, dt)[:, PIECES : 2 * PIECES] / (SHEARS * dt) - 1.0).max(axis=1).mean()
            ),
            against="the weight beyond each",
        ),
        Measure(
            "sag",
            "m",
            "how far its last piece sinks",
            lambda history, dt: abs(float(history[-1, -1])),
            of_soft_step(predicted_tip),
            scale=PIECE * PIECES,
            against="its length",
        ),
    ),
    needs=("weld joints",),
)
def build_cantilever(world: World) -> Watch:
    wall = world.create_body(kind="static")
    for y in levels(8):
        before = wall
        for k in range(PIECES):
            piece = world.create_body(Box(PIECE, DEPTH), position=(PIECE * (k + 0.5), y), mass=PIECE_MASS)
            world.create_joint_weld(before, piece, anchor=(PIECE * k, y), collide_connected=False)
            before = piece
    tip = world.bodies[PIECES]

    def watch(world: World) -> np.ndarray:
        records = world.joint_records()[:PIECES]
        return np.concatenate([np.abs(records["turn_impulse"]), records["impulse_y"], [-tip.position.y]])

    return watch
