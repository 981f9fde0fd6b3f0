"""What a client may do to the page: nothing but what its controls allow, however hard it tries."""

from __future__ import annotations

import asyncio
import logging
import math
import socket
import time
import urllib.error
import urllib.request
from types import SimpleNamespace
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from sandbox.commands import Grab, MoveHand, Pause, Release, Set, Spawn
from tests.web.fake_session import FakeSession, pyramid, wait_until
from tests.web.raw_client import CAMERA, CLICK, DRAG, raw_client
from web import App, ListenError, PortInUse
from web.guard import LARGEST_MESSAGE, LOG_LINES_PER_CLIENT, PATIENCE, Allowance, FilteredConnection
from web.panels import Desk

Served = tuple[FakeSession, App]


@pytest.fixture(autouse=True)
def _fresh_log(served: Served) -> None:
    """The log has a limit of its own, which the tests together would reach."""
    served[1]._page._guard._log_allowance = Allowance(1.0, 100.0)


BAD_VALUES = [
    ("gravity y", math.nan),
    ("gravity y", math.inf),
    ("gravity y", 1e308),
    ("gravity y", 30.5),
    ("gravity y", "5"),
    ("gravity y", True),
    ("gravity y", None),
    ("gravity y", [1.0]),
    ("iterations", 2.5),
    ("iterations", 0),
    ("iterations", 10**12),
    ("warm starting", 1),
    ("solver", "no such solver"),
    ("solver", ["sequential_impulses"]),
    ("scene", "../../etc/passwd"),
    ("scene", "x" * 10_000),
    ("mass", 0.0),
    ("mass", -1.0),
    ("count", 201),
    ("Pause", "yes"),
    ("Download", True),  # switched off as long as there is nothing to download
    ("", "Explode"),  # the group of buttons
]

BAD_MESSAGES: list[Any] = [
    b"",
    b"\xc1",
    b"\x91" * 3000,
    "text",
    [1, 2],
    {"type": 5},
    {"type": "NoSuchMessage"},
    {"type": "ShareUrlRequest"},
    {"type": "ShareUrlDisconnect"},
    {"type": "GuiRemoveMessage", "uuid": "x"},
    {"type": "FileTransferStartUpload", "source_component_uuid": "x", "transfer_uuid": "x"},
    {"type": "RunJavascriptMessage", "source": "alert(1)"},
    {"type": "GuiUpdateMessage", "uuid": "x", "updates": {"value": 1}},
    {"type": "GuiUpdateMessage", "uuid": "x"},
    {"type": "GuiUpdateMessage", "uuid": ["x"], "updates": {"value": 1}},
    {"type": "GuiUpdateMessage", "uuid": "x", "updates": 3},
    {"type": "CommandTriggerMessage", "uuid": "x"},
    CAMERA | {"position": [math.nan, 0.0, 1.0]},
    CAMERA | {"position": [0.0, 0.0]},
    CAMERA | {"position": CAMERA["look_at"]},
    CAMERA | {"image_height": -1},
    CAMERA | {"extra": 1},
    CLICK | {"ray_direction": [math.inf, 0.0, -1.0]},
    CLICK | {"ray_direction": [0.1, 0.1, -1e308]},
    CLICK | {"name": "/no/such/node"},
    DRAG | {"phase": "explode"},
    DRAG | {"end_position": "here"},
    {name: value for name, value in DRAG.items() if name != "owner"},
]


def test_a_good_value_reaches_the_session(served: Served) -> None:
    session, app = served
    with raw_client(app.url) as client:
        client.set("gravity y", 5)
        assert session.wait_for(Set)[-1] == Set("gravity", (0.0, 5.0))
        client.set("warm starting", False)
        assert session.wait_for(Set, 2)[-1] == Set("warm_starting", False)


@pytest.mark.parametrize(("label", "value"), BAD_VALUES)
def test_a_bad_value_is_ignored_and_logged(
    served: Served, label: str, value: Any, caplog: pytest.LogCaptureFixture
) -> None:
    session, app = served
    session.submitted.clear()
    with raw_client(app.url) as client, caplog.at_level(logging.WARNING, "tumble.web"):
        client.set(label, value)
        _assert_page_goes_on(session, client)
    assert len(session.submitted) == 1
    assert "ignored" in caplog.text
    assert max(map(len, caplog.text.splitlines())) < 300


@pytest.mark.parametrize("updates", [{"removed": True}, {"update_cb": []}, {"value": 1.0, "max": 9}, {}])
def test_nothing_but_a_value_can_be_set(served: Served, updates: dict[str, Any]) -> None:
    session, app = served
    session.submitted.clear()
    with raw_client(app.url) as client:
        client.send({"type": "GuiUpdateMessage", "uuid": client.control("gravity x"), "updates": updates})
        _assert_page_goes_on(session, client)
    assert len(session.submitted) == 1


def test_bad_messages_are_ignored_and_the_log_stays_short(served: Served, caplog: pytest.LogCaptureFixture) -> None:
    session, app = served
    session.submitted.clear()
    with raw_client(app.url) as client, caplog.at_level(logging.INFO):
        for message in BAD_MESSAGES:
            if isinstance(message, bytes | str):
                client.socket.send(message)
            else:
                client.send(message)
        _assert_page_goes_on(session, client)
    assert len(session.submitted) == 1
    assert caplog.text.count("ignored") == LOG_LINES_PER_CLIENT
    assert "Traceback" not in caplog.text


def test_an_oversized_message_ends_only_its_sender(served: Served) -> None:
    session, app = served
    with raw_client(app.url) as other:
        with raw_client(app.url) as client:
            client.socket.send(b"x" * (LARGEST_MESSAGE + 1))
            with pytest.raises(ConnectionClosed):
                client.read_until("no message")
        _assert_page_goes_on(session, other)


def test_a_flood_slows_down_only_its_sender(served: Served, caplog: pytest.LogCaptureFixture) -> None:
    session, app = served
    session.submitted.clear()
    with raw_client(app.url) as flooder, raw_client(app.url) as other:
        start = time.monotonic()
        for number in range(1500):
            flooder.set("iterations", 1 + number % 50)
        other.set("gravity x", 3.0)
        wait_until(lambda: any(command.setting == "gravity" for command in session.of(Set)), 2.0)
        accepted = sum(command.setting == "iterations" for command in session.of(Set))
        assert accepted <= 400 + 200 * (time.monotonic() - start) + 5
    assert "slowed down" in caplog.text


def test_who_floods_for_too_long_is_thrown_out(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    session, app = served
    monkeypatch.setattr("web.guard.PATIENCE", 0.1)
    with raw_client(app.url) as flooder, raw_client(app.url) as other:
        for number in range(1500):
            flooder.set("iterations", 1 + number % 50)
        with pytest.raises(ConnectionClosed):
            flooder.read_until("no message")
        _assert_page_goes_on(session, other)


class Clock:
    """Time that passes only while somebody sleeps, and then always for too long, as on a busy machine."""

    overshoot = 0.012  # s

    def __init__(self) -> None:
        self.now = 0.0

    def monotonic(self) -> float:
        return self.now

    async def sleep(self, seconds: float) -> None:
        self.now += seconds + self.overshoot
        assert self.now < 10 * PATIENCE, "the flood goes on and on"


class Flood:
    """A connection on which there is always another message, and none of them is any good."""

    remote_address = ("127.0.0.1", 1)

    def __init__(self) -> None:
        self.transport = SimpleNamespace(abort=lambda: None)
        self.lines: list[str] = []

    async def recv(self) -> str:
        return "text"

    def report(self, line: str, *values: object) -> None:
        self.lines.append(line % values)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr("web.guard.time", clock)
    monkeypatch.setattr("web.guard.asyncio", clock)
    return clock


def test_a_flood_ends_when_its_time_is_up_however_inexact_sleep_is(clock: Clock) -> None:
    flood = Flood()
    connection = FilteredConnection(flood, None, flood.report)  # type: ignore[arg-type]
    with pytest.raises(ConnectionClosed):
        asyncio.run(connection.recv())
    assert PATIENCE <= clock.now < PATIENCE + 0.1
    assert len(flood.lines) == LOG_LINES_PER_CLIENT + 2
    assert sum("slowed down" in line for line in flood.lines) == 1
    assert "thrown out" in flood.lines[-1]


def test_who_pauses_between_floods_may_stay_and_is_warned_once(clock: Clock) -> None:
    flood = Flood()
    connection = FilteredConnection(flood, None, flood.report)  # type: ignore[arg-type]

    async def send(count: int) -> None:
        for _ in range(count):
            await connection._keep_pace()

    for _ in range(10):
        asyncio.run(send(600))
        clock.now += 1.1  # in which half the burst comes back
    assert clock.now > 2 * PATIENCE
    assert [line.endswith("slowed down: too many messages") for line in flood.lines] == [True]


def test_there_is_a_limit_to_the_number_of_clients(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    session, app = served
    monkeypatch.setattr("web.guard.MOST_CLIENTS", 1)
    with raw_client(app.url) as first:
        with pytest.raises(ConnectionClosed), raw_client(app.url):
            pass
        _assert_page_goes_on(session, first)
    wait_until(lambda: not app._page.server.get_clients())
    with raw_client(app.url) as next_one:
        _assert_page_goes_on(session, next_one)


def test_the_allowance_is_a_burst_and_then_a_rate() -> None:
    allowance = Allowance(per_second=100.0, burst=5.0)
    waits = [allowance.take() for _ in range(15)]
    assert waits[:5] == [0.0] * 5
    assert waits[-1] == pytest.approx(0.1, abs=0.03)
    assert not allowance.spend()
    assert Allowance(per_second=1.0, burst=1.0).spend()


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 200),
        ({"Host": "localhost"}, 200),
        ({"Host": "evil.example"}, 403),
        ({"Host": "127.0.0.1.evil.example"}, 403),
        ({"Host": ""}, 403),
        ({"Host": "[::1"}, 403),
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "http://localhost:1"}, 403),
        ({"Origin": "null"}, 403),
        ({"Upgrade": "websocket"}, 403),  # without viser's protocol
    ],
)
def test_who_may_ask(served: Served, headers: dict[str, str], status: int) -> None:
    request = urllib.request.Request(served[1].url, headers=headers)
    try:
        with urllib.request.urlopen(request) as response:
            got, hardened = response.status, response.headers["X-Frame-Options"]
            assert hardened == "SAMEORIGIN"
    except urllib.error.HTTPError as error:
        got = error.code
    assert got == status


def test_a_foreign_site_and_a_foreign_version_get_no_socket(served: Served) -> None:
    url = served[1].url
    for options in ({"origin": "http://evil.example"}, {"subprotocols": ["viser-v0.1.0"]}, {"subprotocols": None}):
        with pytest.raises(InvalidStatus), raw_client(url, **options):
            pass
    with raw_client(url, origin=url.rstrip("/")):
        pass


def test_a_busy_port_is_an_error_of_one_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(PortInUse, match=f"port {port} .*in use") as caught:
            App(FakeSession(pyramid(1), runs=False), port=port)  # type: ignore[arg-type]
        assert "\n" not in str(caught.value)
    with pytest.raises(ListenError, match="cannot listen on 203"):
        App(FakeSession(pyramid(1), runs=False), host="203.0.113.1", port=0)  # type: ignore[arg-type]
    with pytest.raises(ListenError, match="port is 70000"):
        App(FakeSession(pyramid(1), runs=False), port=70_000)  # type: ignore[arg-type]


def test_a_click_spawns_only_where_no_body_moves(served: Served) -> None:
    session, app = served
    with raw_client(app.url) as client:
        session.submitted.clear()
        on_a_box = CLICK | {"ray_origin": [0.0, 3.5, 200.0], "ray_direction": [0.0, 0.0, -1.0]}
        client.send(on_a_box)
        client.send(CLICK)
        (spawn,) = session.wait_for(Spawn)
    assert (spawn.x, spawn.y) == pytest.approx((10.0, 7.0))


def test_a_client_that_leaves_in_the_middle_of_a_drag_lets_go(served: Served) -> None:
    session, app = served
    session.submitted.clear()
    with raw_client(app.url) as client:
        client.send(DRAG)
        (grab,) = session.wait_for(Grab)
        assert (grab.x, grab.y) == (0.0, 0.5)
        assert (session.wait_for(MoveHand)[0].x, session.of(MoveHand)[0].y) == (1.0, 2.0)
    assert session.wait_for(Release) == [Release(grab.hand)]


def test_one_who_comes_late_sees_everything(served: Served) -> None:
    session, app = served
    with raw_client(app.url) as first:
        first.set("count", 7)
        first.send({"type": "CommandTriggerMessage", "uuid": first.control("Pause or play")})
        session.wait_for(Pause)
        first.send({"type": "GuiUpdateMessage", "uuid": first.control("Spawn"), "updates": {"value": True}})
        wait_until(lambda: session.of(Spawn) and session.of(Spawn)[-1].count == 7)
        time.sleep(0.3)
    with raw_client(app.url) as late:
        rims = [message for message in late.messages if message.get("name") == "/bodies/square/rim"]
        state: dict[str, Any] = {}
        for message in rims:
            state |= message.get("updates") or message.get("props") or {}
        assert {"batched_positions", "batched_wxyzs", "batched_scales", "batched_colors"} <= state.keys()
        count = [
            m["updates"]["value"] for m in late.messages if m.get("uuid") == late.control("count") and "updates" in m
        ]
        assert count == [7]


def test_a_refused_command_is_logged_and_nothing_else(served: Served, caplog: pytest.LogCaptureFixture) -> None:
    session, app = served

    def refuse(_: Any) -> bool:
        raise ValueError("no room for it")

    keep, session.submit = session.submit, refuse  # type: ignore[method-assign]
    try:
        with raw_client(app.url) as client:
            client.set("gravity x", 1.5)
            wait_until(lambda: "ignored: no room for it" in caplog.text)
    finally:
        session.submit = keep  # type: ignore[method-assign]
    with raw_client(app.url) as client:
        _assert_page_goes_on(session, client)


def test_refusals_without_end_are_not_logged_without_end(served: Served, caplog: pytest.LogCaptureFixture) -> None:
    def refuse(_: Any) -> bool:
        raise ValueError("no room for it")

    page = served[1]._page
    desk = Desk.__new__(Desk)  # without another window on the page
    desk.page, desk.session = page, SimpleNamespace(submit=refuse)  # type: ignore[assignment]
    for _ in range(1000):
        desk.submit(Pause)
    assert 50 < caplog.text.count("no room for it") < 150  # the allowance of `_fresh_log`


def _assert_page_goes_on(session: FakeSession, client: Any) -> None:
    """A command that comes after the bad ones still arrives."""
    before = len(session.submitted)
    client.send({"type": "CommandTriggerMessage", "uuid": client.control("Reset the scene")})
    wait_until(lambda: len(session.submitted) > before)
