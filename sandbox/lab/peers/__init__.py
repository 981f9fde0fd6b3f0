"""Engines to compare with: one file each, one line here."""

from __future__ import annotations

from collections.abc import Callable

from sandbox.lab.peers.box2d_lite import Box2DLite
from sandbox.lab.peers.protocol import CannotMirror, Peer, PeerError, PeerWorld, WatchedWorld
from sandbox.lab.peers.pyb2d3_peer import Pyb2d3
from sandbox.lab.peers.pymunk_peer import Pymunk

INSTALLABLE: tuple[Callable[[int], Peer], ...] = (Pyb2d3, Pymunk)
"""What `tumble bench --peers` compares with: all from the extra `peers`, none imported before it is asked for.
Each is called with the number of threads."""

KNOBS = {"pyb2d3": "substeps", "pymunk": "iterations"}
"""The setting beside the time step that each has."""

__all__ = [
    "INSTALLABLE",
    "KNOBS",
    "Box2DLite",
    "CannotMirror",
    "Peer",
    "PeerError",
    "PeerWorld",
    "Pyb2d3",
    "Pymunk",
    "WatchedWorld",
]
