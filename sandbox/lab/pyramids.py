"""The talk's pyramid, of any size: what the bench measures beside Box2D Lite when no scene is named."""

from __future__ import annotations

from engine import World
from sandbox.scenes import Scene
from sandbox.scenes.the_talk import PYRAMID_SPACING, add_ground, add_pyramid

BASES = (12, 20, 30, 60)  # boxes in the lowest row
TALK_BASE, TALK_LEFT = 12, -6.0  # Box2D Lite's demo is not centred

# What the bar was measured with, whatever the defaults of a world become.
SETTINGS = {"solver": "sequential_impulses", "iterations": 10, "precision": "single"}


def pyramid(base: int) -> Scene:
    """A pyramid with `base` boxes in its lowest row: base (base + 1) / 2 boxes, and the ground."""

    def build(world: World) -> None:
        add_ground(world)
        add_pyramid(world, base, leftmost(base))

    summary = f"{base * (base + 1) // 2} boxes fall into a pyramid of base {base}."
    return Scene(f"pyramid of base {base}", build, summary, (0.0, float(base), 2.0 * base), SETTINGS)


def leftmost(base: int) -> float:
    """Where the lowest row begins [m]: as in the demo, but a larger pyramid is centred, to stay on the 100 m ground."""
    return TALK_LEFT if base <= TALK_BASE else -0.5 * PYRAMID_SPACING * (base - 1)
