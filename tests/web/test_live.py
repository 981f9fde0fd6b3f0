"""The page over a real session: what is done in it happens in the world."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from engine import SOLVERS
from sandbox.session import Session
from sandbox.simulation import Simulation
from tests.web.fake_session import wait_until
from tests.web.raw_client import CLICK, DRAG, RawClient, raw_client
from web import App


@pytest.fixture(scope="module", autouse=True)
def _compiled() -> None:
    """Whatever these tests run is on disk before anybody waits for it."""
    for solver in SOLVERS:
        simulation = Simulation("The Talk/Dominos", solver=solver)
        for _ in range(2):
            simulation.step()
        simulation.frame()


@pytest.fixture
def live() -> Iterator[tuple[Session, RawClient]]:
    session = Session("The Talk/Single Box")
    app = App(session, port=0)
    session.start()
    with raw_client(app.url) as client:
        yield session, client
    session.close()
    app.close()


def test_what_clients_do_happens_in_the_world(live: tuple[Session, RawClient]) -> None:
    session, client = live
    client.set("count", 3)
    client.send(CLICK | {"ray_origin": [8.0, 5.0, 200.0], "ray_direction": [0.0, 0.0, -1.0]})
    wait_until(lambda: len(session.frame.serials) == 5)
    client.set("iterations", 25)
    client.set("warm starting", False)
    wait_until(lambda: session.frame.settings.iterations == 25 and not session.frame.settings.warm_starting)
    client.set("scene", "The Talk/Dominos")
    wait_until(lambda: session.frame.scene == "The Talk/Dominos")
    client.send({"type": "CommandTriggerMessage", "uuid": client.control("Pause or play")})
    wait_until(lambda: session.frame.status.paused)
    before = session.frame.step
    client.send({"type": "CommandTriggerMessage", "uuid": client.control("Single step")})
    wait_until(lambda: session.frame.step == before + 1)


def test_one_who_comes_while_all_stands_still_sees_the_scene_at_once(live: tuple[Session, RawClient]) -> None:
    session, client = live
    client.send({"type": "CommandTriggerMessage", "uuid": client.control("Pause or play")})
    wait_until(lambda: session.frame.status.paused)
    with raw_client(client.url) as late:  # which has been told all that there is, and nothing comes after it
        told = [_props(message).get("batched_positions") for message in late.messages if _is_face(message)]
        shown = np.frombuffer([places for places in told if places][-1], np.float32).reshape(-1, 3)
        np.testing.assert_allclose(shown[:, :2], session.frame.positions, atol=1e-3)


def _is_face(message: dict[str, Any]) -> bool:
    return message.get("name") == "/bodies/square/face"


def _props(message: dict[str, Any]) -> dict[str, Any]:
    return dict(message.get("updates") or message.get("props") or {})


def test_a_drag_pulls_a_body_softly(live: tuple[Session, RawClient]) -> None:
    session, client = live
    wait_until(lambda: len(session.frame.contacts) == 2, 8.0)  # the box has landed
    x, y = session.frame.positions[1].tolist()
    target = (x + 2.0, y + 2.0)
    client.send(DRAG | {"start_position": [x, y, 0.0], "end_position": [*target, 0.0]})
    speeds: list[float] = []

    def hangs_there() -> bool:
        speeds.append(float(np.abs(session.frame.velocities[1]).max()))
        return speeds[-1] < 0.1 and np.allclose(session.frame.positions[1], target, atol=0.5)

    wait_until(hangs_there)
    assert 1.0 < max(speeds) < 60.0  # on its way there, not there at once
    client.send(DRAG | {"phase": "end", "end_position": [*target, 0.0]})
    wait_until(lambda: session.frame.positions[1][1] < y + 0.3)  # let go, it falls
