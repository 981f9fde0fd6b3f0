"""Everything at once: a browser, the page, the engine and the recorder, and the run computed again from its file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from recordings import compare, read
from sandbox.repeat import repeat
from sandbox.session import Session
from sandbox.verbs.run import open_recorder
from tests.web.browser import look, open_page, text_field, to_pixel
from tests.web.fake_session import wait_until
from web import App

pytestmark = pytest.mark.browser

SCENE = "The Talk/Single Box"
BOX = 1  # its place in a frame; the ground is the first
SPAWNED_AT, DRAGGED_TO, NOTHING = (3.0, 4.0), (-3.0, 3.5), (-1.5, 2.0)  # m


@pytest.fixture
def opened(chromium: Path, tmp_path: Path) -> Iterator[tuple[Session, Any]]:
    session = Session(SCENE, open_recorder=open_recorder, record_dir=tmp_path / "runs")
    app = App(session, port=0)
    session.start()
    try:
        with open_page(app.url) as page:
            yield session, page
    finally:
        session.close()
        app.close()


def test_what_was_done_in_the_browser_is_in_the_file_and_can_be_computed_again(
    opened: tuple[Session, Any], tmp_path: Path
) -> None:
    session, page = opened
    wait_until(lambda: len(session.frame.contacts) == 2, 30.0)  # it has landed; the first step may compile
    _bodies_are_drawn(session, page, tmp_path / "page.png")
    page.get_by_text("Recording", exact=True).click()
    page.get_by_role("button", name="Record", exact=True).click()
    wait_until(lambda: session.frame.status.recording)
    _click_spawns(session, page)
    _drag_moves(session, page)
    _slider_sets_gravity(session, page)
    page.get_by_role("button", name="Stop recording").click()
    wait_until(lambda: session.last_recording)
    with page.expect_download() as download:
        page.get_by_role("button", name="Download").click()
    download.value.save_as(tmp_path / "downloaded.rrd")
    _run_is_the_same_again(tmp_path / "downloaded.rrd")
    assert page.complaints == []


def _bodies_are_drawn(session: Session, page: Any, path: Path) -> None:
    picture, view = look(page, path).astype(int), session.scene.view
    x, y = session.frame.positions[BOX].tolist()

    def colour(x: float, y: float) -> np.ndarray:
        column, row = (round(value) for value in to_pixel(page, view, x, y))
        return np.median(picture[row - 3 : row + 4, column - 3 : column + 4].reshape(-1, 3), axis=0)

    nothing = colour(*NOTHING)
    assert (x, y) == pytest.approx((0.0, 0.5), abs=0.05)
    for dx, dy in ((0.0, 0.0), (0.35, 0.3), (-0.35, 0.3)):
        assert np.abs(colour(x + dx, y + dy) - nothing).max() > 40
    for dx, dy in ((0.75, 0.2), (-0.75, 0.2), (0.2, 0.75)):
        assert np.abs(colour(x + dx, y + dy) - nothing).max() < 25


def _click_spawns(session: Session, page: Any) -> None:
    page.mouse.click(*to_pixel(page, session.scene.view, *SPAWNED_AT))
    wait_until(lambda: len(session.frame.serials) == 3)
    assert session.frame.positions[2][0] == pytest.approx(SPAWNED_AT[0], abs=0.05)
    wait_until(lambda: session.frame.positions[2][1] < 0.6)  # it fell, so it is in the world


def _drag_moves(session: Session, page: Any) -> None:
    view = session.scene.view
    page.mouse.move(*to_pixel(page, view, *session.frame.positions[BOX]))
    page.mouse.down()
    page.mouse.move(*to_pixel(page, view, *DRAGGED_TO), steps=10)
    wait_until(lambda: np.allclose(session.frame.positions[BOX], DRAGGED_TO, atol=0.6))
    page.mouse.up()
    wait_until(lambda: session.frame.positions[BOX][1] < 0.8)


def _slider_sets_gravity(session: Session, page: Any) -> None:
    field = text_field(page, "gravity y")
    field.fill("6")
    field.press("Enter")
    wait_until(lambda: session.frame.settings.gravity == (0.0, 6.0))
    wait_until(lambda: session.frame.positions[BOX][1] > 2.0)  # it falls upwards


def _run_is_the_same_again(path: Path) -> None:
    recording = read(path)
    kinds = {command["command"] for commands in recording.commands.values() for command in commands}
    assert {"spawn", "grab", "move_hand", "release", "set"} <= kinds, kinds
    assert len(recording.steps) > 60
    assert compare(recording, repeat(recording)) is None
