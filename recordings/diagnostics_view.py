"""Contacts, impulses and joints over the bodies, the plots beside them, and the log of commands."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np
import rerun as rr

from engine import BODY_KINDS
from recordings import schema
from recordings.columns import Sheet, time_columns
from recordings.shot import Shot

_ABOVE = 0.1  # how far over the bodies marks lie [m], little enough not to shift them in the picture
_ARROW_GAIN = 0.012  # an arrow is this long for 1 N s, in heights of the view; it grows with the impulse's root
_ARROW_LIMIT = 0.1  # and never longer than this, in heights of the view
_STATIC = BODY_KINDS.index("static")


class MarksView:
    """Contacts as points, their impulses as arrows, joints as lines."""

    def __init__(self, view_height: float) -> None:
        self._height = view_height  # [m]
        self._shown = dict.fromkeys((schema.CONTACT_POINTS, schema.IMPULSE_ARROWS, schema.JOINT_LINES), False)

    def sheets(self, shots: list[Shot]) -> Iterator[Sheet]:
        """Up to three sheets, without entities that have nothing to show and had nothing before."""
        times = time_columns([shot.step for shot in shots], [shot.time for shot in shots])
        contacts = np.concatenate([shot.contacts for shot in shots])
        counts = np.array([len(shot.contacts) for shot in shots])
        if self._wanted(schema.CONTACT_POINTS, counts):
            origins = _raised(contacts["x"], contacts["y"])
            points = rr.Points3D.columns(positions=origins).partition(counts)
            yield Sheet(schema.CONTACT_POINTS, times, list(points))
            vectors = self._arrows(contacts)
            arrows = rr.Arrows3D.columns(origins=origins, vectors=vectors).partition(counts)
            yield Sheet(schema.IMPULSE_ARROWS, times, list(arrows))
        counts = np.array([len(shot.joints) for shot in shots])
        if self._wanted(schema.JOINT_LINES, counts):
            strips = [strip for shot in shots for strip in _joint_strips(shot)]
            lines = rr.LineStrips3D.columns(strips=strips).partition(counts)
            yield Sheet(schema.JOINT_LINES, times, list(lines))

    def _wanted(self, path: str, counts: np.ndarray) -> bool:
        wanted = bool(counts.any()) or self._shown[path]
        self._shown[path] = bool(counts[-1])
        return wanted

    def _arrows(self, contacts: np.ndarray) -> np.ndarray:
        """The impulse that each contact gave to its second body, (C, 3), to be seen rather than measured."""
        normal, tangent = contacts["normal_impulse"], contacts["tangent_impulse"]
        x = contacts["nx"] * normal + contacts["ny"] * tangent  # the tangent is the normal turned by -90 degrees
        y = contacts["ny"] * normal - contacts["nx"] * tangent
        size = np.hypot(x, y)
        length = self._height * np.minimum(_ARROW_GAIN * np.sqrt(size), _ARROW_LIMIT)
        scale = np.divide(length, size, out=np.zeros_like(size), where=size > 0)
        return np.column_stack([x * scale, y * scale, np.zeros_like(x)]).astype(np.float32)


def _raised(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.column_stack([x, y, np.full(len(x), _ABOVE)]).astype(np.float32)


def _joint_strips(shot: Shot) -> Iterator[np.ndarray]:
    """A line for each joint, from one body's centre over both anchors to the other's; static bodies have none."""
    index = {int(serial): i for i, serial in enumerate(shot.serials)}
    for joint in shot.joints:
        points = [(joint["x1"], joint["y1"]), (joint["x2"], joint["y2"])]
        for end, place in (("body1", 0), ("body2", 3)):
            body = index.get(int(joint[end]))
            if body is not None and shot.body_kinds[body] != _STATIC:
                points.insert(place, tuple(shot.positions[body]))
        line = np.array(points)
        yield _raised(line[:, 0], line[:, 1])


class PlotsView:
    """The curves beside the scene."""

    def __init__(self) -> None:
        self.stages: list[str] = []  # in the order in which they first came

    def sheets(self, shots: list[Shot]) -> Iterator[Sheet]:
        """A row for each shot in every plot."""
        times = time_columns([shot.step for shot in shots], [shot.time for shot in shots])
        numbers = np.array([shot.diagnostics for shot in shots], np.float64)
        kinetic, potential = numbers[:, 0], numbers[:, 1]
        yield _curves(schema.ENERGY, times, np.column_stack([kinetic, potential, kinetic + potential]))
        yield _curves(schema.PENETRATION, times, numbers[:, 5:6])
        counts = [(len(shot.serials), shot.diagnostics[6], len(shot.joints)) for shot in shots]
        yield _curves(schema.COUNTS, times, np.array(counts, np.float64))
        for shot in shots:
            self.stages.extend(name for name in shot.stage_ms if name not in self.stages)
        if self.stages:
            stages = [[shot.stage_ms.get(name, np.nan) for name in self.stages] for shot in shots]
            yield _curves(schema.STAGE_TIMES, times, np.array(stages))


def _curves(path: str, times: list[rr.TimeColumn], values: np.ndarray) -> Sheet:
    columns = rr.Scalars.columns(scalars=values.reshape(-1)).partition(np.full(len(values), values.shape[1]))
    return Sheet(path, times, list(columns))


def event_sheets(shots: list[Shot]) -> Iterator[Sheet]:
    """A line in the log for each command."""
    lines = [(shot.step, shot.time, text) for shot in shots for text in shot.commands]
    if lines:
        steps, times, texts = zip(*lines, strict=True)
        readable = [_readable(text) for text in texts]
        columns = rr.TextLog.columns(text=readable, level=["INFO"] * len(readable))
        yield Sheet(schema.EVENTS, time_columns(steps, times), list(columns))


def _readable(text: str) -> str:
    """`{"command": "spawn", "x": 1.0}` as `spawn  x=1`."""
    fields = json.loads(text)
    if not isinstance(fields, dict):
        return text
    name = str(fields.pop("command", "command"))
    values = (f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}" for key, value in fields.items())
    return "  ".join([name, *values])
