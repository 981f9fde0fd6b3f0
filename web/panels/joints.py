"""Joining bodies: what kind of joint; two clicks in the view say where, and one takes a body's joints away."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import viser

from sandbox.commands import JOINS, LIMITED, POINT, Join, Unjoin, strength_of
from sandbox.frame import Frame
from web.hit import in_body, solid_at
from web.panels.desk import Desk, Event

ASKED = "click a body, or empty space for a point that never moves"
THEN = {
    "distance": "now click the body, or the point, that it is to be joined to",
    "prismatic": "now click what is to slide: the axis goes there",
    "wheel": "now click the middle of the wheel: the axis goes there",
    "motor": "now click the body that is to be held in place",
    "filter": "now click the body that it is to pass through",
}  # of all others: where they are to be joined
WHERE = "now click the other body, where the two are to be joined"
REMOVE = "click a body to take its joints away"


class Form(NamedTuple):
    """What a kind of joint has other than most, and how it begins."""

    unit: str = "m, from where it is now"  # of its limits
    hertz: float = 0.0


FORMS = {"revolute": Form("degrees, from where it is now"), "wheel": Form(hertz=4.0)}


@dataclass
class End:
    """What a first click was on: a body, by its serial, or a point of the world; and where in it."""

    serial: int
    x: float
    y: float


class JointsPanel:
    """One tool for all: it acts on the clicks of the client who took it last."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._client: viser.ClientHandle | None = None  # who has the tool
        self._removes = False  # what it is for
        self._first: End | None = None
        self._scene = ""
        self._note: viser.NotificationHandle | None = None
        gui = desk.gui
        with gui.add_folder("Joints", expand_by_default=False):
            self._kind = gui.add_dropdown("joint", JOINS)
            self._hertz: Any = gui.add_slider(
                "joint spring", 0.0, 20.0, 0.1, 0.0, hint="Hz: how stiff its spring is, 0: none, or as stiff as joints"
            )
            self._damping = gui.add_slider("damping", 0.0, 2.0, 0.05, 0.7, hint="of the spring: 1 is critical")
            self._limited = gui.add_checkbox("limits", False)
            self._lower = gui.add_number("lower", 0.0, max=0.0, step=0.1)
            self._upper = gui.add_number("upper", 0.0, min=0.0, step=0.1)
            self._strength = gui.add_number(
                "motor strength", 0.0, min=0.0, max=1e6, step=0.1, hint="N or N m, at most; 0: it has no motor"
            )
            self._speed = gui.add_slider("motor speed", -20.0, 20.0, 0.1, 2.0, hint="rad/s or m/s")
            self._break = gui.add_number(
                "break force", 0.0, min=0.0, max=1e6, step=0.1, hint="N: beyond it the joint breaks; 0: never"
            )
            self._collide = gui.add_checkbox("they collide", False, hint="whether the two bodies collide")
            self._join = gui.add_button("Join", icon=viser.Icon.LINK, hint="then click two bodies; Esc cancels")
            self._remove = gui.add_button("Remove", icon=viser.Icon.UNLINK, hint="then click a body; Esc cancels")
        self._connect()
        self._show_kind()

    def _connect(self) -> None:
        for button, removes in ((self._join, False), (self._remove, True)):

            @button.on_click
            async def pressed(event: Event, removes: bool = removes) -> None:
                self._press(event.client, removes)

        for control in (self._limited, self._strength):
            control.on_update(self._update_shown)
        self._kind.on_update(self._update_kind)

        @self._desk.gui.add_command("Put the joint tool away", hotkey="escape").on_trigger
        async def cancelled(event: viser.CommandEvent) -> None:
            if self._client is not None and event.client_id == self._client.client_id:
                self._put_away()

        @self._desk.page.server.on_client_disconnect
        async def gone(client: viser.ClientHandle) -> None:
            if self._client is not None and client.client_id == self._client.client_id:
                self._put_away()

    # --- the tool -----------------------------------------------------------------------------------------------

    def clicked(self, client: int, x: float, y: float) -> bool:
        """A client clicked a point of the world; whether that was for this tool."""
        frame = self._desk.page.publisher.frame
        if self._client is None or client != self._client.client_id or frame is None:
            return False
        index = solid_at(frame, x, y)
        if self._removes:
            self._take_joints(index)
        elif self._first is None:
            self._begin(frame, index, x, y)
        else:
            self._finish(frame, self._first, index, x, y)
        return True

    def update(self, frame: Frame) -> None:
        if frame.scene != self._scene:
            self._scene = frame.scene
            self._put_away()

    def _press(self, client: viser.ClientHandle | None, removes: bool) -> None:
        was_on = self._client is not None and self._removes == removes
        self._put_away()
        if client is not None and not was_on:
            self._client, self._removes = client, removes
            button = self._remove if removes else self._join
            button.label, button.color = "Cancel", "orange"
            self._say(REMOVE if removes else ASKED)

    def _put_away(self) -> None:
        if self._note is not None:
            self._note.remove()
        if self._client is not None:
            for button, label in ((self._join, "Join"), (self._remove, "Remove")):
                button.label, button.color = label, None
        self._client = self._first = self._note = None

    def _say(self, text: str) -> None:
        """Tell who has the tool what to do next."""
        if self._note is not None:
            self._note.body = text
        elif self._client is not None:
            self._note = self._client.add_notification("Joints", text, with_close_button=False)

    def _take_joints(self, index: int | None) -> None:
        if index is None:
            self._say(f"no body there: {REMOVE}")
        else:
            self._put_away()
            self._desk.submit(lambda: Unjoin(index))

    def _begin(self, frame: Frame, index: int | None, x: float, y: float) -> None:
        if index is None and self._kind.value == "filter":
            self._say("no body there: click one of the two bodies")
            return
        self._first = _end(frame, index, x, y)
        self._say(THEN.get(self._kind.value, WHERE))

    def _finish(self, frame: Frame, first: End, index: int | None, x: float, y: float) -> None:
        second = _end(frame, index, x, y)
        needs_body = first.serial == POINT or self._kind.value == "filter"
        if second.serial == POINT and needs_body:
            self._say("no body there: click the other body")
        elif second.serial == first.serial:
            self._say("that is the same body: click another one, or empty space")
        elif (place := _place(frame, first.serial)) is None:
            self._first = None
            self._say(f"the first body is gone: {ASKED}")
        else:
            self._put_away()
            self._desk.submit(lambda: self.command(place, first, POINT if index is None else index, second))

    # --- the form -----------------------------------------------------------------------------------------------

    def command(self, place1: int, first: End, place2: int, second: End) -> Join:
        """What the controls say, between two ends. What is not shown is not asked for."""
        angle = math.radians(1.0) if self._kind.value == "revolute" else 1.0
        return Join(
            self._kind.value, place1, first.x, first.y, place2, second.x, second.y,
            hertz=self._hertz.value,
            damping_ratio=self._damping.value,
            limited=self._limited.value,
            lower=angle * self._lower.value,
            upper=angle * self._upper.value,
            speed=self._speed.value,
            strength=self._strength.value,
            break_force=self._break.value,
            collide=self._collide.value,
        )  # fmt: skip

    async def _update_kind(self, _: object) -> None:
        self._hertz.value = FORMS.get(self._kind.value, Form()).hertz
        self._show_kind()
        if self._client is not None and not self._removes:  # the clicks are of another kind now
            self._first = None
            self._say(ASKED)

    async def _update_shown(self, _: object) -> None:
        self._show_kind()

    def _show_kind(self) -> None:
        """The controls of this kind, under its own names."""
        kind = self._kind.value
        limited, holds = kind in LIMITED, kind != "filter"
        for control in (self._hertz, self._damping, self._break, self._collide):
            control.visible = holds
        self._limited.visible = limited
        for control in (self._lower, self._upper):
            control.visible = limited and self._limited.value
            control.hint = FORMS.get(kind, Form()).unit
        self._strength.visible = limited or kind == "motor"
        self._strength.label = "largest force" if kind == "motor" else f"motor {strength_of(kind)}"
        self._strength.hint = "N and N m; 0: any" if kind == "motor" else "N or N m, at most; 0: it has no motor"
        self._speed.visible = limited and self._strength.value > 0.0


def _end(frame: Frame, index: int | None, x: float, y: float) -> End:
    """What a click on the body of this index was on, or on none."""
    if index is None:
        return End(POINT, x, y)
    local: Any = in_body(frame, index, x, y)
    return End(int(frame.serials[index]), float(local[0]), float(local[1]))


def _place(frame: Frame, serial: int) -> int | None:
    """Of a body in the order of creation, if it is still there."""
    if serial == POINT:
        return POINT
    places = np.flatnonzero(frame.serials == serial)
    return int(places[0]) if len(places) else None
