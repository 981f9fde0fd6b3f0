"""What the canvas sends of the bodies: little, and only what has changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.web.fake_session import BODY, PENTAGON, make_frame
from web.page import Page
from web.polygons import MOST_OUTLINES
from web.stage import Layer
from web.theme import DYNAMIC, body_colours, to_linear

TURNED: BODY = ("dynamic", "box", 4.0, 1.0, 2.0, 3.0, np.pi / 2)
DISC: BODY = ("dynamic", "circle", 0.5, 0.0, -3.0, 0.5, 0.0)
EVERY_KIND: list[BODY] = [
    DISC,
    ("dynamic", "capsule", 1.0, 0.5, 0.0, 0.0, 0.0),
    ("dynamic", "polygon", 0.0, 0.0, 3.0, 0.0, 0.0),
    ("dynamic", "polygon", 0.2, 0.0, 6.0, 0.0, 0.0),
    ("kinematic", "segment", 3.0, 0.0, 9.0, 0.0, 0.0),
    ("static", "chain", 3.0, 0.0, 12.0, 0.0, 0.0),
]


@pytest.mark.parametrize("count", [1, 1000])
def test_a_frame_is_a_few_messages_however_many_bodies_move(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    page = Page(lambda _: (0.0, 5.0, 20.0), "127.0.0.1", 0)
    sent: list[Any] = []
    try:
        frame = make_frame([TURNED, DISC] * count)
        page._draw(frame)
        monkeypatch.setattr(page.server._websock_server, "queue_message", sent.append)
        page._draw(replace(frame, step=1, positions=frame.positions + 0.01))
    finally:
        page.close()
    poses = [message.name for message in sent if "batched_positions" in getattr(message, "updates", {})]
    meshes = ("disc/face", "marked_disc/rim", "square/face", "square/rim")
    assert sorted(poses) == [f"/bodies/{mesh}" for mesh in meshes]
    assert len(sent) <= 16  # those, their turns, and the overlays
    assert not any("batched_scales" in getattr(message, "updates", {}) for message in sent)


@pytest.fixture
def drawing(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Page, list[Any]]]:
    """A page that draws, and the messages that it sends."""
    page = Page(lambda _: (0.0, 5.0, 20.0), "127.0.0.1", 0)
    sent: list[Any] = []
    queue_message = page.server._websock_server.queue_message
    monkeypatch.setattr(
        page.server._websock_server, "queue_message", lambda message: (sent.append(message), queue_message(message))
    )
    yield page, sent
    page.close()


Drawing = tuple[Page, list[Any]]


def test_shapes_are_sent_when_they_change_and_only_then(drawing: Drawing, monkeypatch: pytest.MonkeyPatch) -> None:
    page, sent = drawing
    selected, select = [], page.canvas._select
    monkeypatch.setattr(page.canvas, "_select", lambda *arguments: (selected.append(1), select(*arguments)))
    bodies = [TURNED, *EVERY_KIND]
    frame = make_frame(bodies)
    page._draw(frame)
    sent.clear()
    page._draw(replace(frame, step=1, positions=frame.positions + 0.01))
    assert not {"batched_scales", "batched_colors", "vertices", "faces"} & set(props(sent))
    assert props(sent).count("batched_positions") == len(page.canvas._batches)
    sent.clear()
    page._draw(replace(frame, step=2))
    page._draw(replace(frame, step=3))
    assert props(sent).count("batched_positions") == len(page.canvas._batches), "nothing moved in the second"
    assert len(selected) == 1
    page._draw(make_frame([*bodies, DISC]))
    assert "batched_scales" in props(sent)
    assert len(selected) == 2


def test_what_falls_asleep_changes_its_colour_and_nothing_else_is_sent(drawing: Drawing) -> None:
    page, sent = drawing
    polygons = [("dynamic", "polygon", 0.01 * k, 0.0, 3.0 * k, 0.0, 0.0) for k in range(MOST_OUTLINES + 1)]
    for bodies in (EVERY_KIND, polygons):
        frame = make_frame(bodies)
        page._draw(frame)
        sent.clear()
        asleep = np.arange(len(bodies)) < 3
        page._draw(replace(frame, asleep=asleep))
        assert "batched_scales" not in props(sent)
        told = props(sent).count("batched_colors")
        assert 0 < told < len(page.canvas._batches), "batches of those three, and of nobody else"
        duller = body_colours(frame.serials, frame.body_kinds, asleep)[:1]
        if bodies is EVERY_KIND:
            shown = page.canvas._batches["disc", Layer.FACE]._handle.batched_colors
            assert shown[0].tolist() == to_linear(duller)[0].tolist()
        else:
            shown = page.canvas._batches["polygon_0", Layer.FACE]._handle.batched_colors
            assert shown[0].tolist() == to_linear(duller)[0].tolist()
        sent.clear()
        page._draw(replace(frame, asleep=asleep, step=2))
        assert "batched_colors" not in props(sent), "once"


def test_what_is_gone_is_no_longer_drawn(drawing: Drawing) -> None:
    page, _ = drawing
    page._draw(make_frame([TURNED, *EVERY_KIND]))
    page._draw(make_frame([TURNED]))
    shown = {key: len(batch._handle.batched_positions) for key, batch in page.canvas._batches.items()}
    assert {name for (name, _), count in shown.items() if count} == {"square"}
    assert len(shown) > 8
    page._draw(make_frame([]))
    assert not any(len(batch._handle.batched_positions) for batch in page.canvas._batches.values())


def test_shapes_that_came_in_place_of_others_are_noticed(drawing: Drawing) -> None:
    """The same number of bodies with the same content number, as a recording may have it."""
    page, sent = drawing
    frame = make_frame([TURNED, DISC])
    page._draw(frame)
    sent.clear()
    other = make_frame([TURNED, TURNED])
    page._draw(replace(other, shape_serials=np.array([0, 7]), content=frame.content))
    assert len(page.canvas._batches["disc", Layer.FACE]._handle.batched_positions) == 0


def test_polygons_of_many_kinds_are_a_mesh_a_colour(drawing: Drawing) -> None:
    page, sent = drawing
    corners = [PENTAGON * (0.5 + 0.01 * k) for k in range(60)]
    frame = make_frame([("dynamic", "polygon", 0.0, 0.0, 1.5 * k, 3.0, 0.0) for k in range(60)], corners)
    page._draw(frame)
    loose = page.canvas._loose.values()
    assert 2 < len(loose) <= 2 * len(DYNAMIC)
    assert all(mesh._handle.visible for mesh in loose)
    assert sum(len(mesh._handle.faces) for mesh in loose) == 2 * 3 * (60 - MOST_OUTLINES)
    assert all(mesh._handle.faces.max() == len(mesh._handle.vertices) - 1 for mesh in loose)
    sent.clear()
    page._draw(replace(frame, step=1, positions=frame.positions + np.array([0.0, 0.5])))
    assert sorted(set(props(sent))) == ["batched_positions", "vertices"]
    for mesh in loose:
        low = mesh._handle.vertices[:, 1].min()
        assert 2.3 < low < 3.5
    page._draw(make_frame([TURNED]))
    assert not any(mesh._handle.visible for mesh in loose)


def props(sent: list[Any]) -> list[str]:
    """The properties of bodies that were sent, one after another."""
    bodies = [message for message in sent if getattr(message, "name", "").startswith("/bodies")]
    return [name for message in bodies for name in getattr(message, "updates", {})]
