"""Makes the pictures of the documents: `make pictures`. They need Chromium and a software Vulkan, as the tests do."""

from __future__ import annotations

import io
import tempfile
import time
from pathlib import Path

import rerun_cli
from PIL import Image
from rerun.experimental import ViewerClient

import recordings
from sandbox import commands as ask
from sandbox.recorder import recording_start
from sandbox.session import Session
from sandbox.simulation import Simulation
from tests.web.browser import save_picture
from web import App

DOCS = Path(__file__).parents[1] / "docs"
PORT = 9877  # of the headless viewer, for a few seconds


def picture_of_page(path: Path) -> None:
    """The pyramid, just after the bomb hit it."""
    session = Session("The Talk/Pyramid")
    app = App(session, port=0)
    session.start()
    try:
        run_until(session, 150)
        session.submit(ask.Spawn("circle", x=-9.0, y=6.0, width=1.2, mass=5.0, count=9))
        session.submit(ask.Bomb(x=-15.0, y=14.0, angle=0.5, vx=22.0, vy=-14.0, spin=6.0))
        run_until(session, 150 + 52)
        session.submit(ask.Pause())
        save_picture(app.url, path, wait=6.0)
    finally:
        session.close()
        app.close()


def run_until(session: Session, step: int) -> None:
    """Waits for a step."""
    while session.frame.step < step:
        time.sleep(0.002)


def picture_of_recording(path: Path) -> None:
    """Dominos in the rerun viewer, while the row falls."""
    simulation = Simulation("The Talk/Dominos")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "dominos.rrd"
        writer = recordings.Writer(file, recording_start(simulation))
        writer.show(simulation.frame())
        for _ in range(400):
            simulation.step()
            writer.show(simulation.frame())
        writer.close()
        executable = Path(rerun_cli.__file__).parent / "rerun"
        with ViewerClient.spawn(headless=True, port=PORT, executable_path=str(executable)) as viewer:
            viewer.open(str(file))
            time.sleep(4.0)
            viewer.set_time("step", sequence=140, play_state="paused")
            time.sleep(2.0)
            picture = Image.open(io.BytesIO(viewer.take_screenshot()))
            picture.resize((1440, 810), Image.Resampling.LANCZOS).save(path)


if __name__ == "__main__":
    picture_of_page(DOCS / "page.png")
    picture_of_recording(DOCS / "recording.png")
