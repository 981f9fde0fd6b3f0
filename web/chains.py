"""What a chain looks like: a line along its surface, and a darker band on the side where it is solid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sandbox.frame import Frame
from web.parts import SQUARE, WEDGE, Part, Pieces
from web.stage import Layer
from web.theme import BAND_TONE, LINE_TONE

LINE_WIDTH = 0.004  # of the view's height
BAND_WIDTH = 0.014
SHARPEST = 3.0  # a mitre reaches at most this many times the strip's width along the piece
TOGETHER = 1e-9  # of a piece's length: how near its end the next one begins


def chains(pieces: Pieces) -> Iterator[Part]:
    """Outward is to the left of a piece's direction: both strips lie on its right, so that the surface is exact."""
    turns = joint_turns(pieces.frame, pieces.members)
    for width, layer, tone in ((BAND_WIDTH, Layer.RIM, BAND_TONE), (LINE_WIDTH, Layer.FACE, LINE_TONE)):
        yield from _strip(pieces, turns, width * pieces.view_height, layer, tone)


def joint_turns(frame: Frame, members: np.ndarray) -> np.ndarray:
    """(K, 2): by how much the way turns left where each piece begins, and where it ends; 0 at open ends [rad]."""
    turns = np.zeros((len(members), 2))
    if not len(members):
        return turns
    owners, (x, y, angle), length = frame.owners[members], frame.places[members].T, frame.sizes[members, 0]
    half = np.column_stack([np.cos(angle), np.sin(angle)]) * (length / 2.0)[:, None]
    middle = np.column_stack([x, y])
    starts, ends = middle - half, middle + half

    def meet(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        away = np.abs(ends[one] - starts[other]).max(axis=1)
        reach = np.abs(middle[one]).max(axis=1) + length[one]
        return (owners[one] == owners[other]) & (away <= TOGETHER * reach)

    places = np.arange(len(members))
    linked = meet(places[:-1], places[1:])
    firsts = places[np.concatenate([[True], ~linked])]
    lasts = places[np.concatenate([~linked, [True]])]
    closed = (lasts - firsts > 1) & meet(lasts, firsts)
    before = np.concatenate([places[:-1][linked], lasts[closed]])
    after = np.concatenate([places[1:][linked], firsts[closed]])
    turn = np.remainder(angle[after] - angle[before] + np.pi, 2.0 * np.pi) - np.pi
    turns[before, 1] = turn
    turns[after, 0] = turn
    return turns


def _strip(pieces: Pieces, turns: np.ndarray, width: float, layer: Layer, tone: float) -> Iterator[Part]:
    """A strip along the pieces' right, mitred where they meet: from a rectangle and a wedge at either end each."""
    length = pieces.sizes[:, 0]
    reach = width * np.minimum(np.tan(np.abs(turns) / 2.0), SHARPEST)
    # Where the way turns left, the strip opens and a wedge is added; where it turns right, one takes a corner's place.
    cut = np.where(turns < 0.0, np.minimum(reach, length[:, None] / 2.0), 0.0)
    ends = np.column_stack([cut[:, 0] - length / 2.0, length / 2.0 - cut[:, 1]])
    middle, deep = ends.mean(axis=1), np.full(len(length), -width / 2.0)
    half = np.column_stack([(ends[:, 1] - ends[:, 0]) / 2.0, -deep])
    yield Part(SQUARE, layer, tone, pieces.members, half, np.column_stack([middle, deep]))
    for end, side in enumerate((-1.0, 1.0)):
        at = np.flatnonzero(turns[:, end])
        if not len(at):
            continue
        opens = turns[at, end] > 0.0
        scales = np.column_stack([np.where(opens, reach[at, end], cut[at, end]) * side, np.where(opens, width, -width)])
        offsets = np.column_stack([ends[at, end], np.where(opens, 0.0, -width)])
        yield Part(WEDGE, layer, tone, pieces.members[at], scales, offsets)
