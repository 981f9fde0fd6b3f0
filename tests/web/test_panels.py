"""The panels that are made from what the engine knows: settings, shapes, effects."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import SHAPE_KINDS, EffectStatus, Settings
from engine.settings import describe
from sandbox.commands import DriveMotor, Set, Spawn
from sandbox.commands.settings import CHANGEABLE
from sandbox.scenes import SCENES
from tests.web.fake_session import EFFECTS, PATIENCE, FakeSession, pyramid, wait_until
from tests.web.raw_client import CLICK, RawClient, raw_client
from web import App, Cost
from web.panels.effects import effects_html
from web.panels.physics import MAIN, NEEDS, SURROUNDINGS, matters_now
from web.panels.spawn import FORMS

Page = tuple[FakeSession, RawClient]


@pytest.fixture
def page() -> Iterator[Page]:
    session = FakeSession(pyramid(2))
    app = App(session, port=0)  # type: ignore[arg-type]
    with raw_client(app.url) as client:
        yield session, client
    app.close()
    session.close()


def prop(client: RawClient, label: str, name: str) -> Any:
    """What a control shows by now."""
    uuid = client.control(label)
    values = [
        holder[name]
        for message in client.messages
        if message.get("uuid") == uuid
        for holder in (message, message.get("props") or {}, message.get("updates") or {})
        if name in holder
    ]
    return values[-1]


def comes(client: RawClient, label: str, name: str, wanted: Any) -> bool:
    client.read()
    return bool(prop(client, label, name) == wanted)


# --- physics ----------------------------------------------------------------------------------------------------------


def test_every_setting_but_the_precision_has_a_control(page: Page) -> None:
    _, client = page
    for info in describe():
        labels = [f"{info.name} x", f"{info.name} y"] if info.kind == "vector" else [info.name.replace("_", " ")]
        for label in labels:
            if info.name == "precision":
                with pytest.raises(LookupError):
                    client.control(label)
            else:
                assert info.hint in prop(client, label, "hint")
    assert set(MAIN) | set(SURROUNDINGS) | set(NEEDS) <= set(CHANGEABLE)


@pytest.mark.parametrize(
    ("label", "value", "command"),
    [
        ("substeps", 8, Set("substeps", 8)),
        ("wind x", 4.5, Set("wind", (4.5, 0.0))),
        ("gravity y", -3, Set("gravity", (0.0, -3.0))),
        ("recycling", False, Set("recycling", False)),
        ("friction mixing", "least", Set("friction_mixing", "least")),
        ("push out speed", 1.5, Set("push_out_speed", 1.5)),
    ],
)
def test_a_control_sets_its_setting(page: Page, label: str, value: Any, command: Set) -> None:
    session, client = page
    client.set(label, value)
    assert session.wait_for(Set)[-1] == command


def test_only_what_matters_to_the_solver_is_shown(page: Page) -> None:
    session, client = page
    assert prop(client, "substeps", "visible")
    assert not prop(client, "accumulate impulses", "visible")
    assert not prop(client, "contact hertz", "visible"), "the stiffness follows"
    client.set("stiffness", "fixed")
    wait_until(lambda: comes(client, "contact hertz", "visible", True))
    client.set("recycling", False)
    wait_until(lambda: comes(client, "recycling distance", "visible", False))
    client.set("solver", "sequential_impulses")
    wait_until(lambda: comes(client, "substeps", "visible", False))
    wait_until(lambda: comes(client, "accumulate impulses", "visible", True))
    assert not prop(client, "contact hertz", "visible")
    assert prop(client, "iterations", "visible")
    session.wait_for(Set, 3)
    wait_until(lambda: comes(client, "iterations", "value", 10))  # the solver's own


def test_each_setting_matters_in_some_world() -> None:
    worlds = [
        Settings(solver="sequential_impulses"), Settings(), Settings(stiffness="fixed"), Settings(recycling=False),
        Settings(tell_events=True),
    ]  # fmt: skip
    for info in CHANGEABLE.values():
        assert any(matters_now(info, settings) for settings in worlds), info.name


# --- spawning ---------------------------------------------------------------------------------------------------------


def spawned(session: FakeSession, client: RawClient) -> Spawn:
    before = len(session.of(Spawn))
    client.set("Spawn", True)
    return session.wait_for(Spawn, before + 1)[-1]


@pytest.mark.parametrize("shape", SHAPE_KINDS)
def test_every_shape_can_be_spawned(page: Page, shape: str) -> None:
    session, client = page
    client.set("shape", shape)
    client.set("count", 3)
    spawn = spawned(session, client)
    assert (spawn.shape, spawn.count) == (shape, 3)
    assert spawn.kind == ("static" if shape in ("segment", "chain") else "dynamic")


def test_a_click_spawns_what_the_panel_says(page: Page) -> None:
    session, client = page
    for label, value in (
        ("shape", "polygon"), ("width", 2.0), ("height", 0.5), ("corners", 7), ("rounding", 0.1), ("angle", 45),
        ("static", True), ("friction", 0.9), ("restitution", 0.5), ("rolling resistance", 0.2),
    ):  # fmt: skip
        client.set(label, value)
    client.send(CLICK | {"ray_origin": [8.0, 5.0, 200.0], "ray_direction": [0.0, 0.0, -1.0]})
    (spawn,) = session.wait_for(Spawn)
    expected = Spawn(
        "polygon", 8.0, 5.0, 2.0, 0.5, friction=0.9, kind="static", angle=np.pi / 4, restitution=0.5,
        rolling_resistance=0.2, corners=7, rounding=0.1,
    )  # fmt: skip
    assert spawn == expected


def test_what_a_shape_does_not_have_is_not_shown(page: Page) -> None:
    _, client = page
    width, mass = client.control("width"), "mass"
    assert set(FORMS) <= set(SHAPE_KINDS)
    for shape, label, shown in (
        ("circle", "diameter", {"height": False, "corners": False, mass: True, "static": True}),
        ("polygon", "width", {"height": True, "corners": True, "rounding": True, mass: True, "static": True}),
        ("segment", "length", {"height": False, "corners": False, "rounding": False, mass: False, "static": False}),
        ("chain", "width", {"height": True, "corners": False, mass: False, "static": False}),
        ("box", "width", {"height": True, "corners": False, "rounding": False, mass: True, "static": True}),
    ):
        client.set("shape", shape)
        for name, visible in shown.items():
            wait_until(lambda name=name, visible=visible: comes(client, name, "visible", visible))
        labels = [m["updates"]["label"] for m in client.messages if m.get("uuid") == width and "updates" in m]
        assert labels[-1] == label
    client.set("static", True)
    wait_until(lambda: comes(client, mass, "visible", False))


# --- effects ----------------------------------------------------------------------------------------------------------


def test_the_table_says_what_is_called_for_and_why_in_safe_text() -> None:
    text = effects_html(EFFECTS)
    assert "2 of 3 called for" in text
    assert text.index("gravity") < text.index("friction") < text.index("restitution")
    assert "3 of 3 shapes have &lt;friction&gt;" in text
    assert "µs" not in text
    assert "waiting" in effects_html(())


def test_costs_stand_beside_the_effects_once_they_are_measured() -> None:
    text = effects_html(EFFECTS, {"gravity": Cost(1.25, 0.5), "restitution": Cost(-0.3, 0.75), "friction": Cost()})
    assert text.count("µs") == 3  # and once in the legend
    assert ">1.2 µs · 0.5 s<" in text
    assert ">saves 0.0 µs · 0.8 s<" in text


def html(client: RawClient) -> str:
    """What the table of effects says by now."""
    contents = [
        holder["content"]
        for message in client.messages
        for holder in (message.get("props") or {}, message.get("updates") or {})
        if "called for by this scene" in str(holder.get("content"))
    ]
    return str(contents[-1]) if contents else ""


def test_the_table_is_live(page: Page) -> None:
    session, client = page
    wait_until(lambda: (client.read(), "2 of 3" in html(client))[1])
    session.publish(effects=(*EFFECTS[:1], EffectStatus("restitution", True, "1 shape has it"), EFFECTS[2]))
    wait_until(lambda: (client.read(), "3 of 3" in html(client))[1])


def test_without_something_that_measures_there_is_no_button(page: Page) -> None:
    _, client = page
    with pytest.raises(LookupError):
        client.control("Measure their costs")


def test_measuring_fills_the_costs_one_at_a_time_until_another_scene_comes() -> None:
    session, gate, calls = FakeSession(pyramid(2)), threading.Event(), []

    def measure() -> Iterator[dict[str, Cost]]:
        calls.append(1)
        yield {"gravity": Cost(3.5)}
        assert gate.wait(PATIENCE)
        yield {"gravity": Cost(3.5, 0.4)}

    app = App(session, port=0, measure_effects=measure)  # type: ignore[arg-type]
    try:
        with raw_client(app.url) as client:
            client.set("Measure their costs", True)
            client.set("Measure their costs", True)
            wait_until(lambda: calls)
            wait_until(lambda: comes(client, "Measure their costs", "disabled", True))
            wait_until(lambda: (client.read(), "3.5 µs<" in html(client))[1])
            gate.set()
            wait_until(lambda: (client.read(), "3.5 µs · 0.4 s<" in html(client))[1])
            wait_until(lambda: comes(client, "Measure their costs", "disabled", False))
            assert len(calls) == 1, "a second press meanwhile does nothing"
            session.publish(scene=list(SCENES)[1])
            wait_until(lambda: (client.read(), "µs" not in html(client))[1])
    finally:
        app.close()
        session.close()


def test_a_measurement_that_fails_says_so_and_nothing_else_happens(caplog: pytest.LogCaptureFixture) -> None:
    session = FakeSession(pyramid(2))

    def measure() -> dict[str, Cost]:
        raise RuntimeError("no such effect")

    app = App(session, port=0, measure_effects=measure)  # type: ignore[arg-type]
    try:
        with raw_client(app.url) as client:
            client.set("Measure their costs", True)
            assert client.read_until("NotificationShowMessage")["props"]["body"] == "no such effect"
            wait_until(lambda: comes(client, "Measure their costs", "disabled", False))
            assert "Traceback" not in caplog.text
    finally:
        app.close()
        session.close()


def test_a_setting_that_others_changed_is_followed(page: Page) -> None:
    session, client = page
    settings = replace(session.frame.settings, wind=(0.0, 2.5), contact_damping_ratio=4.0)
    session.publish(settings=settings)
    wait_until(lambda: comes(client, "wind y", "value", 2.5))
    wait_until(lambda: comes(client, "contact damping ratio", "value", 4.0))
    assert session.of(Set) == [], "following is no change of its own"


# --- driving ----------------------------------------------------------------------------------------------------------


def driven(scene: str) -> tuple[FakeSession, App]:
    """A page that shows a scene with drives."""
    session = FakeSession(pyramid(2), scene=scene, drives=tuple(0.0 for _ in SCENES[scene].drives))
    return session, App(session, port=0)  # type: ignore[arg-type]


def folder_is_shown(client: RawClient, name: str) -> bool:
    """Whether there is a folder of that name, and it is not hidden."""
    (uuid,) = {m["uuid"] for m in client.messages if m["type"] == "GuiFolderMessage" and m["props"]["label"] == name}
    changes = [m.get("props") or m.get("updates") for m in client.messages if m.get("uuid") == uuid]
    return bool([change["visible"] for change in changes if "visible" in change][-1])


def test_a_drive_has_a_slider_buttons_and_keys_that_drive_its_motors() -> None:
    session, app = driven("Joints/Car")
    (drive,) = SCENES["Joints/Car"].drives
    try:
        with raw_client(app.url) as client:
            assert folder_is_shown(client, "Drive")
            client.set("throttle", 0.5)
            assert session.wait_for(DriveMotor, 2) == [DriveMotor(joint, 0.5 * drive.gain) for joint in drive.joints]
            client.send({"type": "CommandTriggerMessage", "uuid": client.control("throttle: brake")})
            assert session.wait_for(DriveMotor, 4)[2:] == [DriveMotor(joint, 0.0) for joint in drive.joints]
            session.publish(drives=(0.75,))
            wait_until(lambda: comes(client, "throttle", "value", 0.75))
            assert len(session.of(DriveMotor)) == 4, "following is no driving"
    finally:
        app.close()
        session.close()


def test_a_drive_that_does_not_stay_is_let_go_a_moment_later() -> None:
    session, app = driven("Joints/Pinball")
    _, right = SCENES["Joints/Pinball"].drives
    try:
        with raw_client(app.url) as client:
            with pytest.raises(LookupError):
                client.control("left flipper")  # no slider
            client.send({"type": "CommandTriggerMessage", "uuid": client.control("right flipper: flip right")})
            assert session.wait_for(DriveMotor, 2) == [DriveMotor(1, right.gain), DriveMotor(1, -right.gain)]
    finally:
        app.close()
        session.close()


def test_controls_to_drive_with_come_and_go_with_the_scene(page: Page) -> None:
    session, client = page
    assert not folder_is_shown(client, "Drive")
    with pytest.raises(LookupError):
        client.control("throttle")
    session.publish(scene="Joints/Car", drives=(0.0,))
    wait_until(lambda: (client.read(), folder_is_shown(client, "Drive"))[1])
    slider = client.control("throttle")
    session.publish(scene="The Talk/Pyramid", drives=())
    wait_until(lambda: (client.read(), not folder_is_shown(client, "Drive"))[1])
    removed = [m["uuid"] for m in client.messages if m["type"] == "GuiRemoveMessage"]
    assert slider in removed
