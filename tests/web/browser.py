"""A headless Chromium looking at the page: for the tests, and for the pictures of the documentation."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import Locator, Page, sync_playwright

from web.camera import HUD_SHARE, shown_height

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
KNOWN = re.compile(  # all that the console may say, and why
    # viser's client is built on three.js, and calls what three.js has since renamed
    r"THREE\.Clock: This module has been deprecated\. Please use THREE\.Timer instead\."
    # SwiftShader, which draws where there is no GPU, lacks this extension, and is slow when a picture is read back
    r"|THREE\.WebGLRenderer: KHR_parallel_shader_compile extension not supported\."
    r"|\[\.WebGL-0x[0-9a-f]+\] ?GL Driver Message \(OpenGL, Performance, GL_CLOSE_PATH_NV, High\): "
    r"GPU stall due to ReadPixels( \(this message will no longer repeat\))?"
    # viser's client wants to keep the page from scrolling, in a listener that the browser does not let
    r"|Unable to preventDefault inside passive event listener invocation\."
)
CANVAS = "canvas[data-engine]"  # the one with the scene
FRAMES = 30  # until the camera stands where it should; on a busy machine that takes a while
DRAW = "count => new Promise(done => { const draw = () => count-- ? requestAnimationFrame(draw) : done(); draw(); })"


def find_chromium() -> Path | None:
    """The browser that all tests and pictures use; None if there is none."""
    path = next(filter(None, map(shutil.which, NAMES)), None)
    return Path(path) if path else None


@contextmanager
def open_page(url: str, width: int = 1280, height: int = 800, scale: float = 1.0) -> Iterator[Page]:
    """The page in a browser of its own, once the scene is there. `page.complaints` is what the console said."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_chromium(), args=FLAGS)
        try:
            page = browser.new_page(viewport={"width": width, "height": height}, device_scale_factor=scale)
            page.complaints = []  # type: ignore[attr-defined]
            page.on("console", lambda message: _note(page, message.type, message.text))
            page.on("pageerror", lambda error: _note(page, "error", str(error)))
            page.goto(url)
            page.wait_for_selector(CANVAS, timeout=60_000)
            page.wait_for_timeout(2500)
            page.evaluate(DRAW, FRAMES)
            _dismiss_notifications(page)
            yield page
        finally:
            browser.close()


def save_picture(url: str, path: Path, width: int = 1400, height: int = 860, wait: float = 1.0) -> None:
    """A screenshot of the page, as a PNG."""
    with open_page(url, width, height) as page:
        page.wait_for_timeout(1000.0 * wait)
        page.screenshot(path=str(path))


def look(page: Page, path: Path) -> np.ndarray:
    """What is on the screen, (height, width, 3) uint8."""
    page.screenshot(path=str(path))
    return np.asarray(Image.open(path).convert("RGB"))


def to_pixel(page: Page, view: tuple[float, float, float], x: float, y: float) -> tuple[float, float]:
    """Where in the window a point of the world is, as long as nobody moved the camera."""
    box: Any = page.locator(CANVAS).first.bounding_box()
    center_x, center_y, view_height = view
    per_metre = box["height"] / shown_height(view_height, box["width"] / box["height"])
    return (
        box["x"] + box["width"] / 2 + (x - center_x) * per_metre,
        box["y"] + box["height"] * (1.0 + HUD_SHARE) / 2 - (y - center_y) * per_metre,
    )


def text_field(page: Page, label: str) -> Locator:
    """Where one types the value of the control with this label."""
    row = page.get_by_text(label, exact=True).locator("xpath=ancestor::div[contains(@class, 'Flex-root')][1]")
    return row.locator("input[type=text]")


def _dismiss_notifications(page: Page) -> None:
    """The browser without a GPU is told so by viser; that is not part of the picture."""
    for button in page.locator(".mantine-Notification-closeButton").all():
        button.click()
    page.wait_for_timeout(400)


def _note(page: Page, kind: str, text: str) -> None:
    if kind in ("error", "warning") and not KNOWN.fullmatch(text):
        page.complaints.append(f"{kind}: {text}")  # type: ignore[attr-defined]
