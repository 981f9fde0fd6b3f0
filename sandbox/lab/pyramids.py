"""The talk's pyramid, of any size: what the bench measures when no scene is named."""

from __future__ import annotations

from engine import Box, World
from sandbox.scenes import Scene
from sandbox.scenes.the_talk import FRICTION, add_ground

BASES = (12, 20, 30, 60)  # boxes in the lowest row
SPACING = 1.125  # of the boxes in a row [m]
RISE = 2.0  # from row to row [m]: the boxes fall before they stand
TALK_BASE, TALK_LEFT = 12, -6.0  # Box2D Lite's demo is not centred

# What the bar was measured with, whatever the defaults of a world become.
SETTINGS = {"solver": "sequential_impulses", "iterations": 10, "precision": "single"}


def pyramid(base: int) -> Scene:
    """A pyramid with `base` boxes in its lowest row: base (base + 1) / 2 boxes, and the ground."""

    def build(world: World) -> None:
        add_ground(world)
        left = leftmost(base)
        for row in range(base):
            for i in range(base - row):
                position = (left + 0.5 * SPACING * row + SPACING * i, 0.75 + RISE * row)
                world.create_body(Box(1, 1), position=position, mass=10, friction=FRICTION)

    summary = f"{base * (base + 1) // 2} boxes fall into a pyramid of base {base}."
    return Scene(f"pyramid of base {base}", build, summary, (0.0, float(base), 2.0 * base), SETTINGS)


def leftmost(base: int) -> float:
    """Where the lowest row begins [m]: as in the demo, but a larger pyramid is centred, to stay on the 100 m ground."""
    return TALK_LEFT if base <= TALK_BASE else -0.5 * SPACING * (base - 1)
