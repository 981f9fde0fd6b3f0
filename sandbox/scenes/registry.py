"""How a scene is made known: `@scene("Folder/Name", shows=...)` above a function that fills a world."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from engine import Settings, World, validate
from sandbox.scenes.criterion import Criterion

Build = Callable[[World], None]
View = tuple[float, float, float]


@dataclass(frozen=True)
class Drive:
    """Motors of a scene that whoever watches it drives, all of them alike, from -1 to 1."""

    name: str
    joints: tuple[int, ...]  # by their numbers of creation
    gain: float  # their motors' speed at 1 [rad/s], or [m/s] where they slide
    buttons: Mapping[str, float] = field(default_factory=dict)  # what they set it to, by their labels
    keys: Mapping[str, str] = field(default_factory=dict)  # by the same labels
    released: float | None = None  # what it is again a moment after a button was pressed; None: it stays


@dataclass(frozen=True)
class Scene:
    """A world's beginning. `build` fills an empty world; `summary` is the first line of its docstring."""

    name: str
    build: Build
    summary: str
    view: View  # what to look at: centre x, centre y, height [m]
    settings: Mapping[str, Any] = field(default_factory=dict)  # where it departs from a world's defaults
    shows: tuple[Criterion, ...] = ()  # what there is to see, as numbers
    drives: tuple[Drive, ...] = ()  # motors that the page has controls for

    def make(self, *, threads: int = 1, **settings: Any) -> World:
        """A world with this scene in it; settings win over the scene's own. ValueError if they do not suit it."""
        world = World(threads=threads, **self.defaults().changed(settings).to_dict())
        self.build(world)
        return world

    def defaults(self) -> Settings:
        """The settings that it asks for."""
        return Settings(**self.settings)


SCENES: dict[str, Scene] = {}


class UnknownScene(ValueError):
    """There is no scene of that name; the message says which come close."""


def scene(
    name: str,
    *,
    shows: Criterion | tuple[Criterion, ...],
    view: View = (0.0, 7.0, 20.0),
    drives: tuple[Drive, ...] = (),
    **settings: Any,
) -> Callable[[Build], Build]:
    """Registers the function below as a scene.

    shows: what it shows, as a number or several; a test holds it to them, with the settings that the scene asks for.
    view: centre x, y and height of what to look at [m]; drives: motors that the page has controls for.
    """
    criteria = (shows,) if isinstance(shows, Criterion) else tuple(shows)
    if not criteria:
        raise ValueError("shows = (): must say what the scene shows, at least one Criterion")

    def register(build: Build) -> Build:
        if name in SCENES:
            raise ValueError(f"name = {name!r}: must be a scene's name that is not taken yet")
        summary = (build.__doc__ or "").strip().split("\n")[0]
        SCENES[name] = Scene(name, build, summary, view, settings, criteria, drives)
        return build

    return register


def find_scene(name: str) -> Scene:
    """The scene of that name, by its full name or, whatever the case, by the part after the folder: of several, the
    first that is listed.
    """
    if not isinstance(name, str):
        raise UnknownScene(str(validate.refuse("scene", name, "the name of a scene")))
    if name in SCENES:
        return SCENES[name]
    name = name[:80]
    wanted = name.casefold()
    matches = [s for s in SCENES.values() if wanted in (s.name.casefold(), s.name.casefold().split("/")[-1])]
    if matches:
        return matches[0]
    close = difflib.get_close_matches(name, SCENES, n=3, cutoff=0.4)
    hint = f"; did you mean {' or '.join(repr(c) for c in close)}? " if close else ""
    raise UnknownScene(f"there is no scene {name!r}{hint or '; '}`tumble scenes` lists all")
