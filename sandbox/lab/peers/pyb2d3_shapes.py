"""Our shapes as Box2D has them: form, surface and filter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from engine import Settings
from sandbox.lab.peers.description import BodyDescription, Outline
from sandbox.lab.peers.protocol import CannotMirror
from sandbox.lab.peers.surfaces import Coefficient, Values, for_rule

CREATED_AS = {"box": "polygon", "polygon": "polygon", "circle": "circle", "capsule": "capsule", "segment": "segment"}


class ShapeMaker:
    """Gives bodies of the copy their shapes; what many have in common is made once."""

    def __init__(self, module: Any, settings: Settings, bodies: Sequence[BodyDescription]) -> None:
        self._module = module
        self._friction = _rule("friction", "geometric", settings.friction_mixing, bodies)
        self._restitution = _rule("restitution", "greatest", settings.restitution_mixing, bodies)
        self._made: dict[Any, Any] = {}

    def add(self, copy: Any, outline: Outline, body: BodyDescription) -> None:
        """Adds one to a body's copy. CannotMirror if Box2D takes none like it."""
        moving = body.kind == "dynamic"
        if outline.kind == "chain":
            copy.create_chain(self._chain(outline, moving))
            return
        create = getattr(copy, f"create_{CREATED_AS[outline.kind]}_shape")
        create(self._definition(outline, moving), self._form(outline, body))

    def _definition(self, outline: Outline, moving: bool) -> Any:
        """What holds for a shape whatever its form."""
        key = (
            moving, outline.friction, outline.restitution, outline.rolling_resistance, outline.tangent_speed,
            outline.category, outline.mask, outline.group,
        )  # fmt: skip
        if key not in self._made:
            definition = self._module.ShapeDef()
            definition.material = self._material(outline, moving)
            definition.filter = self._filter(outline)
            definition.enable_contact_events = False  # nobody listens
            self._made[key] = definition
        return self._made[key]

    def _material(self, outline: Outline, moving: bool) -> Any:
        material = self._module.SurfaceMaterial()
        material.friction = self._friction(outline.friction, moving)
        material.restitution = self._restitution(outline.restitution, moving)
        material.rolling_resistance = outline.rolling_resistance
        material.tangent_speed = outline.tangent_speed
        return material

    def _filter(self, outline: Outline) -> Any:
        filters = self._module.Filter()
        filters.category_bits = outline.category
        filters.mask_bits = outline.mask
        filters.group_index = outline.group
        return filters

    def _form(self, outline: Outline, body: BodyDescription) -> Any:
        key = (outline.kind, outline.radius, outline.half, outline.place, tuple(map(tuple, outline.points)))
        if key not in self._made:
            self._made[key] = self._make_form(outline, body)
        return self._made[key]

    def _make_form(self, outline: Outline, body: BodyDescription) -> Any:
        module = self._module
        points = [(x, y) for x, y in outline.points]
        if outline.kind == "box":  # not from its corners: those may be nearer to each other than a hull's may be
            x, y, angle = outline.place
            return module.box(*outline.half, center=(x, y), rotation=rotation(module, angle))
        if outline.kind == "circle":
            return module.circle(points[0], outline.radius)
        if outline.kind == "capsule":
            return module.capsule(*points, outline.radius)
        if outline.kind == "segment":
            return module.segment(*points)
        hull = module.compute_hull(np.array(points, np.float32))
        if hull.count != len(points):
            raise CannotMirror(f"it takes no polygon as thin, or with corners as near, as that of body {body.serial}")
        return module.polygon(hull=hull, radius=outline.radius)

    def _chain(self, outline: Outline, moving: bool) -> Any:
        """As one of Box2D's, which goes the other way: it is touched from its right.

        Of its points the first and last are only there to be known; where ours ends it is told to go straight on.
        """
        points = outline.points[::-1]
        if outline.closed:
            points = [points[-1], *points, points[0], points[1]]
        else:
            points = [_beyond(points[1], points[0]), *points, _beyond(points[-2], points[-1])]
        definition = self._module.ChainDef()
        definition.points = np.array(points, np.float32)
        definition.materials = [self._material(outline, moving)]
        definition.filter = self._filter(outline)
        return definition


def rotation(module: Any, angle: float) -> Any:
    """Not by its make_rot, which takes sine and cosine from a polynomial and is off by 1e-3."""
    turned = module.Rot()
    turned.c, turned.s = math.cos(angle), math.sin(angle)
    return turned


def _rule(name: str, theirs: str, rule: str, bodies: Sequence[BodyDescription]) -> Coefficient:
    found = for_rule(theirs, rule, Values.of(name, bodies))
    if found is None:
        raise CannotMirror(f"it mixes {name} by the rule {theirs!r}, this scene by {rule!r}")
    return found


def _beyond(before: Sequence[float], end: Sequence[float]) -> list[float]:
    """As far beyond the end as the point before lies on this side of it."""
    return [2.0 * end[0] - before[0], 2.0 * end[1] - before[1]]
