"""Every colour of a recording: calm hues on a dark ground, the same in the scene and in the plots."""

from __future__ import annotations

import numpy as np

from engine import BODY_KINDS

BACKGROUND = (17, 20, 26)
STATIC = (74, 84, 99)  # slate: what never moves stays in the back
KINEMATIC = (150, 158, 170)  # lighter: what moves, but is moved by nothing
BODIES = np.array(  # moving bodies by serial
    [
        (106, 153, 201),  # steel blue
        (226, 168, 93),  # amber
        (120, 178, 148),  # sage
        (203, 123, 134),  # rose
        (148, 132, 194),  # lavender
        (103, 179, 188),  # teal
    ],
    np.uint8,
)
CONTACT = (255, 221, 128)
IMPULSE = (255, 138, 101)
HIT = (255, 244, 214)
JOINT = (186, 198, 214)

KINETIC = (226, 168, 93)
POTENTIAL = (106, 153, 201)
TOTAL = (225, 229, 235)
PENETRATION = (203, 123, 134)
COUNTS = ((120, 178, 148), (255, 221, 128), (186, 198, 214))  # bodies, contacts, joints
STAGES = np.concatenate([BODIES, BODIES // 2 + 100])  # time of each stage, in the order of the step


def body_colors(serials: np.ndarray, body_kinds: np.ndarray) -> np.ndarray:
    """RGB of each body, (N, 3) uint8."""
    colors = BODIES[np.asarray(serials, np.int64) % len(BODIES)]
    for kind, color in (("static", STATIC), ("kinematic", KINEMATIC)):
        colors[body_kinds == BODY_KINDS.index(kind)] = color
    return colors


def faded(colors: np.ndarray) -> np.ndarray:
    """As a translucent fill looks on the background."""
    return np.asarray(0.6 * colors + 0.4 * np.array(BACKGROUND)).astype(np.uint8)
