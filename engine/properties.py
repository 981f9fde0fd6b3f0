"""Attributes of bodies and shapes that effects bring: each lives in a column that need not be there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine import validate
from engine.lacking import refuse_property

if TYPE_CHECKING:
    from engine.effects import Property
    from engine.storage import Storage
    from engine.world import World


class Attribute:
    """Reads and writes one property of a Part."""

    def __init__(self, item: Property) -> None:
        self.item = item
        self.__doc__ = item.meaning

    def __get__(self, part: Any, owner: type) -> Any:
        if part is None:
            return self
        part._check()
        return part._storage.get(self.item.name, int(np.ravel(part._places)[0]))

    def __set__(self, part: Any, value: Any) -> None:
        part._check()
        checked = check(part.world, {self.item.name: value}, part.properties)
        part._touch_property()
        part._storage.put(self.item.name, part._places, checked[self.item.name])
        part.world._content_changed()


class Part:
    """A body or a shape: what has properties."""

    __slots__ = ()

    properties: ClassVar[dict[str, Property]]
    noun: ClassVar[str]
    world: World
    serial: int

    def __init_subclass__(cls) -> None:
        for name, item in cls.properties.items():
            setattr(cls, name, Attribute(item))

    @property
    def alive(self) -> bool:
        raise NotImplementedError

    @property
    def _storage(self) -> Storage:
        raise NotImplementedError

    def _touch_property(self) -> None:
        raise NotImplementedError

    def _check(self) -> None:
        if not self.alive:
            this = f"{self.noun} = {type(self).__name__} {self.serial}"
            raise ValueError(f"{this}: must be a living {self.noun}, this one was destroyed")


def check(
    world: World, values: dict[str, Any], known: dict[str, Property], more: dict[str, Property] | None = None
) -> dict[str, Any]:
    """The values, each as its property takes it. ValueError names the one that is wrong; `more`: what else there is."""
    checked = {}
    for name, value in values.items():
        validate.choice("property", name, [*known, *(more or {})])
        checked[name] = known[name].check(name, value)
        if isinstance(checked[name], float):
            validate.in_range(world.precision, **{name: (checked[name],)})
        refuse_property(world.settings, name, checked[name], known[name])
    return checked
