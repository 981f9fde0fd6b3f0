"""The tool for joints: what the next clicks are for, and the commands that come of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import pytest

from sandbox.commands import JOINS, POINT, Join, Spawn, Unjoin
from tests.web.fake_session import FakeSession, wait_until
from tests.web.raw_client import CLICK, RawClient, raw_client
from tests.web.test_panels import comes, prop
from web import App
from web.hit import solid_at
from web.panels.joints import ASKED, REMOVE, THEN, WHERE

GROUND = ("static", "box", 40.0, 2.0, 0.0, -1.0, 0.0)
LEFT = ("dynamic", "box", 1.0, 1.0, -2.0, 3.0, 0.0)
RIGHT = ("dynamic", "box", 2.0, 1.0, 2.0, 3.0, math.pi / 2)  # turned: its own x is up
BODIES: Any = [GROUND, LEFT, RIGHT]
ESCAPE = "Put the joint tool away"


@pytest.fixture
def app() -> Iterator[tuple[FakeSession, App]]:
    session = FakeSession(BODIES)
    app = App(session, port=0)  # type: ignore[arg-type]
    yield session, app
    app.close()
    session.close()


@pytest.fixture
def page(app: tuple[FakeSession, App]) -> Iterator[tuple[FakeSession, RawClient]]:
    session, app_ = app
    with raw_client(app_.url) as client:
        yield session, client


def click(client: RawClient, x: float, y: float) -> None:
    client.send(CLICK | {"ray_origin": [x, y, 200.0], "ray_direction": [0.0, 0.0, -1.0]})


def said(client: RawClient, text: str) -> None:
    """Waits until this is what the notice says."""

    def says() -> bool:
        client.read()
        notes = [m for m in client.messages if m["type"].startswith("Notification") and m["props"]["title"] == "Joints"]
        return bool(notes) and notes[-1]["props"]["body"] == text

    wait_until(says, what=text)


def labels_of(client: RawClient, uuid: str) -> list[str]:
    """What a control was called since."""
    client.read()
    return [m["updates"]["label"] for m in client.messages if m.get("uuid") == uuid and "label" in m.get("updates", {})]


def put_away(client: RawClient) -> None:
    """Waits until the notice is gone."""
    wait_until(lambda: (client.read(), any(m["type"] == "RemoveNotificationMessage" for m in client.messages))[1])


def test_two_clicks_join_two_bodies_at_what_was_clicked_of_each(page: tuple[FakeSession, RawClient]) -> None:
    session, client = page
    for label, value in (
        ("joint spring", 3.0), ("damping", 0.5), ("limits", True), ("lower", -90.0), ("upper", 45.0),
        ("motor torque", 60.0), ("motor speed", -4.0), ("break force", 900.0), ("they collide", True),
    ):  # fmt: skip
        client.set(label, value)
    client.set("Join", True)
    said(client, ASKED)
    click(client, -1.75, 3.25)
    said(client, WHERE)
    moved = session.frame.positions.copy()
    moved[1] += (5.0, 5.0)  # until the second click the first body goes on
    session.publish(positions=moved)
    click(client, 2.25, 3.75)
    (join,) = session.wait_for(Join)
    assert (join.body1, join.x1, join.y1, join.body2) == (1, pytest.approx(0.25), pytest.approx(0.25), 2)
    assert (join.x2, join.y2) == pytest.approx((0.75, -0.25))
    assert (join.lower, join.upper) == pytest.approx((-math.pi / 2, math.pi / 4))
    assert (join.kind, join.hertz, join.damping_ratio, join.limited) == ("revolute", 3.0, 0.5, True)
    assert (join.strength, join.speed, join.break_force, join.collide) == (60.0, -4.0, 900.0, True)
    put_away(client)
    click(client, 8.0, 5.0)
    session.wait_for(Spawn)
    assert len(session.of(Join)) == 1, "the tool is away: a click spawns again"


@pytest.mark.parametrize("order", [1, -1])
def test_empty_space_is_a_point_that_never_moves(page: tuple[FakeSession, RawClient], order: int) -> None:
    session, client = page
    client.set("joint", "distance")
    client.set("Join", True)
    for x, y in [(-2.0, 3.0), (0.0, 8.0)][::order]:
        click(client, x, y)
    (join,) = session.wait_for(Join)
    ends = [(join.body1, join.x1, join.y1), (join.body2, join.x2, join.y2)][::order]
    assert ends == [(1, pytest.approx(0.0), pytest.approx(0.0)), (POINT, pytest.approx(0.0), pytest.approx(8.0))]
    assert not session.of(Spawn)


def test_the_ground_can_be_joined_too(page: tuple[FakeSession, RawClient]) -> None:
    session, client = page
    client.set("Join", True)
    click(client, 2.0, 3.0)
    click(client, 2.0, -0.5)
    (join,) = session.wait_for(Join)
    assert (join.body1, join.body2, join.x2, join.y2) == (2, 0, pytest.approx(2.0), pytest.approx(0.5))


def test_clicks_that_join_nothing_are_explained_and_may_be_done_again(page: tuple[FakeSession, RawClient]) -> None:
    session, client = page
    client.set("Join", True)
    said(client, ASKED)
    click(client, 0.0, 8.0)
    said(client, WHERE)
    click(client, 0.0, 9.0)
    said(client, "no body there: click the other body")
    client.set("joint", "filter")  # begins again
    said(client, ASKED)
    click(client, 0.0, 8.0)
    said(client, "no body there: click one of the two bodies")
    click(client, -2.0, 3.0)
    said(client, THEN["filter"])
    click(client, -2.2, 3.2)
    said(client, "that is the same body: click another one, or empty space")
    session.publish(serials=session.frame.serials + 5)  # other bodies than before
    click(client, 2.0, 3.0)
    said(client, f"the first body is gone: {ASKED}")
    assert not session.of(Join)
    assert not session.of(Spawn)


def test_a_click_on_a_body_takes_its_joints_away(page: tuple[FakeSession, RawClient]) -> None:
    session, client = page
    client.set("Remove", True)
    said(client, REMOVE)
    click(client, 0.0, 8.0)
    said(client, f"no body there: {REMOVE}")
    click(client, 2.0, 3.0)
    assert session.wait_for(Unjoin) == [Unjoin(2)]
    put_away(client)
    assert not session.of(Spawn)


@pytest.mark.parametrize("how", ["Escape", "button", "scene"])
def test_the_tool_can_be_put_away(page: tuple[FakeSession, RawClient], how: str) -> None:
    session, client = page
    button = client.control("Join")
    client.set("Join", True)
    wait_until(lambda: labels_of(client, button) == ["Cancel"])  # before it is another: what is late is told once
    click(client, -2.0, 3.0)
    said(client, WHERE)
    if how == "Escape":
        client.send({"type": "CommandTriggerMessage", "uuid": client.control(ESCAPE)})
    elif how == "button":
        client.send({"type": "GuiUpdateMessage", "uuid": button, "updates": {"value": True}})
    else:
        session.publish(scene="The Talk/Dominos")
    put_away(client)
    wait_until(lambda: labels_of(client, button) == ["Cancel", "Join"])
    click(client, 8.0, 5.0)
    session.wait_for(Spawn)
    assert not session.of(Join)


def test_the_clicks_of_others_stay_their_own(app: tuple[FakeSession, App]) -> None:
    session, app_ = app
    with raw_client(app_.url) as other:
        with raw_client(app_.url) as client:
            client.set("Join", True)
            said(client, ASKED)
            click(other, 8.0, 5.0)
            session.wait_for(Spawn)
            other.send({"type": "CommandTriggerMessage", "uuid": other.control(ESCAPE)})
            click(other, 8.0, 9.0)
            session.wait_for(Spawn, 2)
            click(client, -2.0, 3.0)
            said(client, WHERE)
        button = other.control("Join")  # who had the tool has gone
        wait_until(lambda: labels_of(other, button)[-1:] == ["Join"])


def test_only_the_numbers_of_the_kind_are_shown(page: tuple[FakeSession, RawClient]) -> None:
    _, client = page
    strength = client.control("motor torque")
    shown = {
        "distance": {"joint spring": True, "limits": True, "break force": True, "they collide": True},
        "weld": {"joint spring": True, "limits": False, "break force": True, "motor speed": False},
        "filter": {"joint spring": False, "damping": False, "limits": False, "break force": False},
        "wheel": {"joint spring": True, "limits": True, "lower": False},
    }
    for kind, controls in shown.items():
        client.set("joint", kind)
        for label, visible in controls.items():
            wait_until(partial(comes, client, label, "visible", visible))
    wait_until(lambda: comes(client, "joint spring", "value", 4.0))  # or it would fall off its axis
    client.set("limits", True)
    wait_until(lambda: comes(client, "upper", "visible", True))
    client.set("motor torque", 5.0)
    wait_until(lambda: comes(client, "motor speed", "visible", True))
    client.set("joint", "prismatic")
    wait_until(lambda: labels_of(client, strength)[-3:] == ["motor force", "motor torque", "motor force"])
    assert "m," in prop(client, "lower", "hint")
    assert set(THEN) < set(JOINS)


def test_what_is_clicked_is_what_moves_then_what_came_last() -> None:
    session = FakeSession([("dynamic", "box", 1.0, 1.0, 0.0, 0.0, 0.0), GROUND, ("static", "box", 9.0, 9.0, 0, 0, 0)])
    frame = session.frame
    session.close()
    assert [solid_at(frame, x, y) for x, y in ((0.0, 0.0), (0.0, -1.5), (18.0, -1.5), (0.0, 60.0))] == [0, 2, 1, None]
