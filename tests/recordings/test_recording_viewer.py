"""rerun's own viewer opens a recording: filled, y up, playing, plots beside it, and without a warning."""

from __future__ import annotations

import io
import json
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import rerun_cli
from PIL import Image
from recorded_frames import tumbling, write
from rerun.experimental import ViewerClient

from recordings import palette, schema

pytestmark = pytest.mark.vulkan
SLOW_MACHINE = "Software rasterizer"  # the one warning that is about this machine and not about the recording


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture(scope="module")
def viewer(vulkan: list[Path], tmp_path_factory: pytest.TempPathFactory) -> Iterator[ViewerClient]:
    """A viewer that has a recording open."""
    path = write(tmp_path_factory.mktemp("viewer") / "tumbling.rrd", list(tumbling(120)))
    executable = Path(rerun_cli.__file__).parent / "rerun"
    with ViewerClient.spawn(headless=True, port=free_port(), executable_path=str(executable)) as client:
        client.open(str(path))
        deadline = time.monotonic() + 20
        while client.get_state().loading or not client.get_state().views:
            assert time.monotonic() < deadline, "the viewer did not load the recording"
            time.sleep(0.1)
        yield client


def test_it_plays_in_simulated_time(viewer: ViewerClient) -> None:
    seen = set()
    deadline = time.monotonic() + 10
    while len(seen) < 3 and time.monotonic() < deadline:
        (recording,) = viewer.get_state().recordings
        assert recording.current_timeline == schema.TIME_TIMELINE
        seen.add(recording.current_time)
        time.sleep(0.2)
    assert len(seen) >= 3, "the recording does not play"


def test_timelines_cover_the_whole_recording(viewer: ViewerClient) -> None:
    (recording,) = viewer.get_state().recordings
    timelines = {timeline.name: timeline for timeline in recording.timelines}
    assert set(timelines) == {schema.STEP_TIMELINE, schema.TIME_TIMELINE}  # and no time of the day
    steps = timelines[schema.STEP_TIMELINE]
    assert (steps.time_type, steps.start, steps.end) == ("sequence", 0, 119)


def test_the_scene_stands_beside_the_plots(viewer: ViewerClient) -> None:
    names = {view.name for view in viewer.get_state().views}
    assert names == {"Scene", "Commands", "Events", "Energy [J]", "Penetration [m]", "Counts", "Stage times [ms]"}


def test_bodies_are_filled_and_up_is_up(viewer: ViewerClient) -> None:
    picture = picture_at(viewer, 90)
    ground = _near(picture, np.array(palette.STATIC) * 0.6, 22)
    rows, columns = np.nonzero(ground[:, : picture.shape[1] * 2 // 3])
    assert len(rows) > 20_000, "the ground is not a filled shape"
    assert np.median(rows) > picture.shape[0] * 0.6, "the ground is not at the bottom"
    assert columns.min() < 200 < columns.max()
    sky = picture[120:600, 20:1300]
    colourful = np.ptp(sky.astype(int), axis=2) > 40
    assert 20_000 < colourful.sum() < 300_000, "no filled bodies above the ground"


def test_curves_and_marks_are_drawn(viewer: ViewerClient) -> None:
    picture = picture_at(viewer, 100)
    plots, scene = picture[:, 1350:], picture[:, :1340]
    for color in (palette.KINETIC, palette.POTENTIAL, palette.PENETRATION, *palette.COUNTS):
        assert _near(plots, np.array(color), 30).sum() > 100, color
    for color in (palette.CONTACT, palette.IMPULSE, palette.JOINT):
        assert _near(scene, np.array(color), 40).sum() > 20, color


def test_nothing_is_warned_about(viewer: ViewerClient) -> None:
    """Runs last: every step was loaded and some were drawn by now."""
    picture_at(viewer, 40)
    picture_at(viewer, 119)
    state = viewer.get_state()
    assert [(view.name, view.reports) for view in state.views if view.reports] == []
    warnings = [log.message for log in viewer.get_logs() if log.level != "INFO" and SLOW_MACHINE not in log.message]
    assert warnings == []


def test_the_file_describes_itself(viewer: ViewerClient) -> None:
    described = viewer.get_recording_schema(viewer.get_state().recordings[0].store_id)
    paths = {entity.entity_path for entity in described.entities}
    assert {"/__properties/tumble", schema.EVENTS, schema.BODIES.path, schema.CONTACTS.path} <= paths
    (bodies,) = [entity for entity in described.entities if entity.entity_path == schema.BODIES.path]
    assert {component.datatype for component in bodies.components} == {"Float64"}, json.dumps(str(bodies))


def test_a_cut_file_is_shown_from_standard_input(tmp_path: Path) -> None:
    """As `tumble replay --partial --viewer rerun` hands it over: by its path, rerun refuses it."""
    path = write(tmp_path / "cut.rrd", list(tumbling(60)))
    path.write_bytes(path.read_bytes()[:-100])
    port = free_port()
    command = [str(Path(rerun_cli.__file__).parent / "rerun"), "--headless", "--bind", "127.0.0.1", "--port", str(port)]
    with path.open("rb") as content:
        process = subprocess.Popen([*command, "-"], stdin=content, stderr=subprocess.DEVNULL)
    try:
        steps = wait_for_steps(f"rerun+http://127.0.0.1:{port}/proxy")
    finally:
        process.kill()
        process.wait()
    assert steps == (0, 59)


def wait_for_steps(url: str) -> tuple[int, int]:
    """First and last step of what a viewer has open."""
    deadline = time.monotonic() + 20
    while True:
        try:
            (recording,) = ViewerClient.connect(url).get_state().recordings
            (steps,) = [timeline for timeline in recording.timelines if timeline.name == schema.STEP_TIMELINE]
            if steps.end >= 59:
                return steps.start, steps.end
        except (ConnectionError, RuntimeError, ValueError):  # not there yet
            pass
        assert time.monotonic() < deadline, "the viewer did not load the recording"
        time.sleep(0.2)


def picture_at(viewer: ViewerClient, step: int) -> np.ndarray:
    """The viewer's window at a step, (height, width, 3) uint8."""
    viewer.set_time(schema.STEP_TIMELINE, sequence=step, play_state="paused")
    time.sleep(0.5)
    return np.array(Image.open(io.BytesIO(viewer.take_screenshot())).convert("RGB"))


def _near(picture: np.ndarray, color: np.ndarray, tolerance: int) -> np.ndarray:
    """Which pixels are close to a colour."""
    return (np.abs(picture.astype(int) - color.astype(int)) < tolerance).all(axis=2)
