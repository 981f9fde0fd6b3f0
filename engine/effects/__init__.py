"""Everything a scene may do without: one effect a constant, one line here.

What a world calls for is read from its content when that changes (State.refresh), never in a step. The table of an
effect that is not called for is None, its kernel is neither compiled nor run, and no inner loop asks about it.
"""

from __future__ import annotations

from engine.effects.buoyancy import BUOYANCY
from engine.effects.contact import CONVEYOR, FRICTION, RESTITUTION, ROLLING_RESISTANCE
from engine.effects.continuous import BULLETS, CONTINUOUS
from engine.effects.drag import DRAG, WIND
from engine.effects.effect import Effect, EffectStatus, Property
from engine.effects.explosion import EXPLOSION
from engine.effects.filters import FILTERS
from engine.effects.joints import BREAKING, CHAINS, JOINT_LIMITS, JOINT_MOTORS, JOINT_SPRINGS, KINDS, PASSING
from engine.effects.magnets import MAGNETS
from engine.effects.motion import ANGULAR_DAMPING, GRAVITY, GRAVITY_SCALE, LINEAR_DAMPING
from engine.effects.others import DIAGNOSTICS, EVENTS
from engine.effects.point_gravity import POINT_GRAVITY
from engine.effects.sleeping import SLEEPING

EFFECTS: tuple[Effect, ...] = (
    GRAVITY,
    GRAVITY_SCALE,
    LINEAR_DAMPING,
    ANGULAR_DAMPING,
    DRAG,
    WIND,
    BUOYANCY,
    MAGNETS,
    POINT_GRAVITY,
    EXPLOSION,
    FRICTION,
    RESTITUTION,
    ROLLING_RESISTANCE,
    CONVEYOR,
    FILTERS,
    *KINDS,
    JOINT_SPRINGS,
    JOINT_MOTORS,
    JOINT_LIMITS,
    CHAINS,
    BREAKING,
    CONTINUOUS,
    BULLETS,
    PASSING,
    EVENTS,
    SLEEPING,
    DIAGNOSTICS,
)

BODY_PROPERTIES: dict[str, Property] = {p.name: p for effect in EFFECTS for p in effect.body}
SHAPE_PROPERTIES: dict[str, Property] = {p.name: p for effect in EFFECTS for p in effect.shape}

__all__ = ["BODY_PROPERTIES", "EFFECTS", "SHAPE_PROPERTIES", "Effect", "EffectStatus", "Property"]
