"""What is fast stops where it would go through something: what calls for it. Its code stands in engine/continuous."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.effects.effect import Effect, Property, bodies_with
from engine.tables import DYNAMIC

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

SOLVERS = ("soft_step", "xpbd", "avbd")  # those that know it


def passing_through(state: State, settings: Settings) -> str:
    """Dynamic bodies that could go through what nothing pushes or, where there are bullets, through each other."""
    if not settings.continuous or settings.solver not in SOLVERS:
        return ""
    bodies, shapes = state.bodies.tables["bodies"], state.shapes.tables["shapes"]
    pieces = shapes[state.shapes.order]
    swept = bodies["kind"][pieces["body"]] == DYNAMIC
    count, fixed = len(np.unique(pieces["body"][swept])), len(np.unique(pieces["part_of"][~swept]))
    if not count or not (fixed or state.bodies.departing("bullet")):
        return ""
    what = f"{fixed} shape{'s' * (fixed != 1)} that nothing moves" if fixed else "each other"
    return f"{count} {'body' if count == 1 else 'bodies'} could go through {what}"


def is_bullet(name: str, value: Any) -> bool:
    return validate.switch(name, value)


CONTINUOUS = Effect("continuous collision", "what is fast stops at what it would go through", passing_through)

BULLETS = Effect(
    "bullets",
    "fast bodies stop at moving ones, too",
    bodies_with("bullet", "the property bullet"),
    body=(Property("bullet", False, is_bullet, "whether it goes through no moving body, however fast", np.bool_),),
    needs="continuous collision",
)
