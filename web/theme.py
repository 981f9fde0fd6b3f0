"""Every colour of the page, and how a body gets its own."""

from __future__ import annotations

import numpy as np
import viser

from engine import BODY_KINDS

Colour = tuple[int, int, int]

BACKDROP: Colour = (35, 38, 45)
GRID: Colour = (46, 53, 67)
GRID_SECTION: Colour = (66, 76, 96)
BRAND: Colour = (86, 140, 188)

STATIC: Colour = (78, 88, 106)
KINEMATIC: Colour = (150, 154, 164)  # what moves, but is moved by nothing
DYNAMIC: tuple[Colour, ...] = (  # muted, of one lightness, so that no body shouts
    (88, 138, 182),
    (98, 156, 146),
    (134, 160, 98),
    (196, 160, 88),
    (198, 122, 86),
    (188, 102, 112),
    (146, 112, 168),
    (106, 120, 186),
)
ASLEEP: Colour = (70, 74, 84)  # what sleeps fades towards this
DULLNESS = 0.6  # and so far
RIM_TONE = 0.5  # how dark a body's outline is against its face
LINE_TONE = 1.7  # how light a line is that has no face
BAND_TONE = 0.75  # of the band on the side where a chain is solid

CONTACT: Colour = (255, 244, 214)
NORMAL: Colour = (240, 130, 150)
BOUNDS: Colour = (92, 128, 122)
NORMAL_IMPULSE: Colour = (255, 196, 84)
FRICTION_IMPULSE: Colour = (98, 218, 190)
HIT: Colour = (255, 236, 160)
JOINT: Colour = (196, 160, 255)
HAND: Colour = (255, 255, 255)

PLOT_LINES = ("#6e9ec7", "#d6b574", "#7eb2a8", "#cd7d86", "#a888bc", "#9db47c", "#d89270", "#8390cc")
PLOT_TEXT = "#9aa4b5"
PLOT_GRID = "#2b313c"


def body_colours(serials: np.ndarray, body_kinds: np.ndarray, asleep: np.ndarray) -> np.ndarray:
    """(N, 3) uint8, sRGB. By creation number, so that a body keeps its colour for life; duller while it sleeps."""
    scattered = (serials.astype(np.uint64) * np.uint64(2654435769) >> np.uint64(16)) % np.uint64(len(DYNAMIC))
    colours = np.array(DYNAMIC, np.uint8)[scattered.astype(np.int64)]
    for kind, colour in (("static", STATIC), ("kinematic", KINEMATIC)):
        colours[body_kinds == BODY_KINDS.index(kind)] = colour
    colours[asleep] = np.rint((1.0 - DULLNESS) * colours[asleep] + DULLNESS * np.array(ASLEEP))
    return colours


def toned(colours: np.ndarray, tone: float | np.ndarray) -> np.ndarray:
    """Lighter or darker, (N, 3) uint8; tone: one for all, or (N, 1)."""
    return np.minimum(colours * tone, 255.0).astype(np.uint8)


def to_linear(colours: np.ndarray) -> np.ndarray:
    """sRGB to linear light, uint8: what the renderer takes an instance's colour for (else it looks washed out)."""
    share = colours.astype(np.float64) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.rint(linear * 255.0).astype(np.uint8)


def apply_theme(server: viser.ViserServer) -> None:
    """Dark, calm, and evenly lit: shading would only suggest a depth that a plane has not."""
    server.gui.configure_theme(
        dark_mode=True, show_logo=False, show_share_button=False, brand_color=BRAND, control_width="medium"
    )
    server.scene.set_up_direction("+y")
    server.scene.configure_environment_map(hdri=None)
    server.scene.configure_default_lights(enabled=False)
    server.scene.add_light_ambient("/light", intensity=np.pi)
