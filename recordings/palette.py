"""Every colour of a recording: calm hues on a dark ground, the same in the scene and in the plots."""

from __future__ import annotations

import numpy as np

BACKGROUND = (17, 20, 26)
STATIC = (74, 84, 99)  # slate: what never moves stays in the back
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
JOINT = (186, 198, 214)

KINETIC = (226, 168, 93)
POTENTIAL = (106, 153, 201)
TOTAL = (225, 229, 235)
PENETRATION = (203, 123, 134)
COUNTS = ((120, 178, 148), (255, 221, 128), (186, 198, 214))  # bodies, contacts, joints
STAGES = np.concatenate([BODIES, BODIES // 2 + 100])  # time of each stage, in the order of the step


def body_colors(serials: np.ndarray, static: np.ndarray) -> np.ndarray:
    """RGB of each body, (N, 3) uint8; `static` says which never move, (N,) bool."""
    colors = BODIES[np.asarray(serials, np.int64) % len(BODIES)]
    colors[static] = STATIC
    return colors
