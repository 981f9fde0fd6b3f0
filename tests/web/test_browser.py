"""The page in a real browser: what it shows, and what a mouse does to it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sandbox.commands import Grab, MoveHand, Pause, Play, Release, Set, Spawn
from sandbox.scenes import SCENES
from tests.web.browser import CANVAS, KNOWN, look, open_page, text_field, to_pixel
from tests.web.fake_session import BODY, GROUND, FakeSession, wait_until
from web import App
from web.chains import BAND_WIDTH

pytestmark = pytest.mark.browser

VIEW = next(iter(SCENES.values())).view
LOW = VIEW[1] - 0.25 * VIEW[2]  # a height in the lower part of the view [m]
BOX: BODY = ("dynamic", "box", 2.0, 1.0, VIEW[0], VIEW[1], 0.6)
CIRCLE: BODY = ("dynamic", "circle", 0.8, 0.0, VIEW[0] + 3.0, LOW, 0.0)
EMPTY = (VIEW[0] + 2.5, VIEW[1] + 3.0)
LEFT = VIEW[0] - 0.45 * VIEW[2]
CAPSULE: BODY = ("dynamic", "capsule", 1.0, 0.4, LEFT, LOW, np.pi / 2)
POLYGON: BODY = ("dynamic", "polygon", 0.2, 0.0, LEFT + 2.5, LOW, 0.0)
SEGMENT: BODY = ("static", "segment", 2.0, 0.0, LEFT, VIEW[1] + 1.0, 0.0)
CHAIN: BODY = ("static", "chain", 2.0, 0.0, LEFT, VIEW[1], 0.0)


@pytest.fixture(scope="module")
def opened(chromium: Path) -> Iterator[tuple[FakeSession, Any]]:
    ground = (*GROUND[:4], VIEW[0], LOW - 2.0, 0.0)
    session = FakeSession([ground, BOX, CIRCLE, CAPSULE, POLYGON, SEGMENT, CHAIN])
    app = App(session, port=0)  # type: ignore[arg-type]
    with open_page(app.url, width=1200, height=700) as page:
        yield session, page
    app.close()
    session.close()


Opened = tuple[FakeSession, Any]


def test_bodies_are_drawn_where_the_frame_says(opened: Opened, tmp_path: Path) -> None:
    _, page = opened
    picture = look(page, tmp_path / "page.png")
    nothing = _colour(page, picture, *EMPTY)
    inside = [
        (BOX[4], BOX[5]),
        (BOX[4] + 0.6, BOX[5] + 0.41),
        (CIRCLE[4] - 0.5, CIRCLE[5]),
        (CIRCLE[4], CIRCLE[5] + 0.6),
    ]
    outside = [(BOX[4] + 0.6, BOX[5] - 0.41), (CIRCLE[4] + 0.7, CIRCLE[5] + 0.7), (CIRCLE[4] - 1.0, CIRCLE[5])]
    assert all(_differs(_colour(page, picture, *point), nothing) for point in inside)
    assert not any(_differs(_colour(page, picture, *point), nothing) for point in outside)
    ground, box = _colour(page, picture, VIEW[0] + 1.0, LOW - 2.0), _colour(page, picture, BOX[4], BOX[5])
    assert _differs(ground, nothing)
    assert np.ptp(box) > 2 * np.ptp(ground)  # static bodies are grey


def test_every_other_shape_is_drawn_as_it_is(opened: Opened, tmp_path: Path) -> None:
    _, page = opened
    picture = look(page, tmp_path / "page.png")
    nothing = _colour(page, picture, *EMPTY)
    depth = BAND_WIDTH * VIEW[2]
    inside = [
        (CAPSULE, 0.0, 0.75),
        (CAPSULE, 0.3, 0.0),
        (CAPSULE, 0.2, -0.7),
        (POLYGON, 1.1, 0.0),
        (POLYGON, -0.9, 0.0),
    ]
    outside = [(CAPSULE, 0.38, 0.85), (CAPSULE, 0.55, 0.0), (POLYGON, 0.9, 0.85), (POLYGON, -1.25, 0.0)]
    bright = [(SEGMENT, 0.5, 0.0), (CHAIN, 0.5, -0.1 * depth)]
    assert all(_differs(_colour(page, picture, body[4] + x, body[5] + y), nothing) for body, x, y in inside)
    assert not any(_differs(_colour(page, picture, body[4] + x, body[5] + y), nothing) for body, x, y in outside)
    assert all(_brightness(page, picture, body[4] + x, body[5] + y) > 100 for body, x, y in bright)
    above, below = (_brightness(page, picture, CHAIN[4] + 0.5, CHAIN[5] + side * depth) for side in (0.7, -0.7))
    assert below > above + 8, "its solid side is the lower one"


def test_a_click_spawns_where_it_is(opened: Opened, tmp_path: Path) -> None:
    session, page = opened
    before = look(page, tmp_path / "before.png")
    page.mouse.click(*to_pixel(page, VIEW, *EMPTY))
    (spawn,) = session.wait_for(Spawn)
    assert (spawn.x, spawn.y) == pytest.approx(EMPTY, abs=0.03)
    page.wait_for_timeout(1000)
    after = look(page, tmp_path / "after.png")
    assert _differs(_colour(page, before, *EMPTY), _colour(page, after, *EMPTY))


def test_a_drag_takes_hold_of_a_body_and_pulls(opened: Opened) -> None:
    session, page = opened
    end = (BOX[4] + 2.0, BOX[5] + 1.5)
    page.mouse.move(*to_pixel(page, VIEW, BOX[4], BOX[5]))
    page.mouse.down()
    page.mouse.move(*to_pixel(page, VIEW, *end), steps=8)
    wait_until(lambda: session.of(MoveHand) and abs(session.of(MoveHand)[-1].x - end[0]) < 0.05)
    page.mouse.up()
    (release,) = session.wait_for(Release)
    (grab,) = session.of(Grab)
    assert (grab.x, grab.y) == pytest.approx(BOX[4:6], abs=0.03)
    assert session.of(MoveHand)[-1].y == pytest.approx(end[1], abs=0.05)
    assert grab.hand == release.hand
    assert len(session.of(Spawn)) == 1  # the click of the test before


def test_a_slider_changes_gravity_and_follows_others(opened: Opened) -> None:
    session, page = opened
    field = text_field(page, "gravity y")
    field.fill("-3")
    field.press("Enter")
    assert session.wait_for(Set)[-1] == Set("gravity", (0.0, -3.0))
    field.blur()
    page.wait_for_timeout(800)
    session.submit(Set("gravity", (0.0, 7.0)))
    wait_until(lambda: field.input_value() == "7")
    assert len(session.of(Set)) == 2  # following is not a change of its own


def test_space_pauses_and_plays(opened: Opened) -> None:
    session, page = opened
    page.keyboard.press("Space")
    session.wait_for(Pause)
    page.get_by_role("button", name="Play", exact=True).wait_for(timeout=30_000)
    page.keyboard.press("Space")
    session.wait_for(Play)


def test_the_camera_pans_but_does_not_tilt(opened: Opened, tmp_path: Path) -> None:
    _, page = opened
    x, y = to_pixel(page, VIEW, *EMPTY)
    page.mouse.move(x, y)
    page.keyboard.down("ArrowLeft")
    page.wait_for_timeout(300)
    page.keyboard.up("ArrowLeft")
    page.wait_for_timeout(500)
    page.keyboard.press("f")
    page.wait_for_timeout(1500)
    picture = look(page, tmp_path / "page.png")
    centre, nothing = _colour(page, picture, BOX[4], BOX[5]), _colour(page, picture, *(VIEW[0] + 1.5, VIEW[1] + 4.0))
    assert _differs(centre, nothing)


def test_the_browser_had_nothing_to_complain_about(opened: Opened) -> None:
    complaints = opened[1].complaints
    assert complaints == []
    assert not KNOWN.fullmatch("WebGL: CONTEXT_LOST_WEBGL: loseContext: context lost")  # what a broken page would say


def test_the_palette_opens_with_the_mouse_in_the_view(opened: Opened) -> None:
    _, page = opened
    text_field(page, "gravity y").focus()  # where letters are text
    page.mouse.click(*to_pixel(page, VIEW, BOX[4], BOX[5]))  # on a body: nothing comes of it
    page.keyboard.press("Control+k")
    entry = page.get_by_text("Launch a bomb", exact=True)
    entry.wait_for(timeout=30_000)
    page.keyboard.press("Escape")
    entry.wait_for(state="hidden", timeout=30_000)


@pytest.mark.parametrize("size", [(1280, 800), (1400, 860), (1920, 1080)])
def test_no_part_of_a_scene_is_behind_the_window(opened: Opened, size: tuple[int, int]) -> None:
    _, page = opened
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_timeout(300)
    window = page.get_by_text("deepest overlap").locator("xpath=ancestor::div[contains(@style, 'width: 640px')][1]")
    window, canvas = window.bounding_box(), page.locator(CANVAS).first.bounding_box()
    x, y, height = VIEW
    left, top = to_pixel(page, VIEW, x - 0.75 * height, y + 0.5 * height)
    right, bottom = to_pixel(page, VIEW, x + 0.75 * height, y - 0.5 * height)
    assert window["height"] > 100
    assert top >= window["y"] + window["height"]
    assert left >= -0.5
    assert right <= canvas["width"] + 0.5
    assert bottom <= canvas["height"] + 0.5


def _colour(page: Any, picture: np.ndarray, x: float, y: float) -> np.ndarray:
    """The middle colour around a point of the world; lines of the grid do not count."""
    column, row = (round(value) for value in to_pixel(page, VIEW, x, y))
    return np.asarray(np.median(picture[row - 3 : row + 4, column - 3 : column + 4].reshape(-1, 3), axis=0))


def _brightness(page: Any, picture: np.ndarray, x: float, y: float) -> float:
    """Of the brightest of the few pixels above and below a point of the world, along a line."""
    column, row = (round(value) for value in to_pixel(page, VIEW, x, y))
    return float(picture[row - 1 : row + 2, column - 8 : column + 9].astype(float).mean(axis=(1, 2)).max())


def _differs(first: np.ndarray, second: np.ndarray) -> bool:
    return bool(np.abs(first - second).max() > 25)
