"""Colours: contacts of one colour share no body that moves, so they can be solved side by side.

An arbiter gets a colour when its shapes begin to touch, the lowest that neither body has among its other contacts, with
what no impulse moves the lowest from HELD_FROM on, and keeps it until they part. So little changes from step to step;
and since the colour stands in the arbiter's row, a restored snapshot goes on with the same ones. Which arbiter comes
first follows from their order, hence from the order of creation. A body with more contacts than there are colours
leaves the rest to the overflow, solved one by one.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

COLOURS = 24
"""Most contacts of one body that can be solved side by side with others'. More: a stage more for each; fewer: what is
left over is solved one by one."""

HELD_FROM = 12
"""Contacts with what no impulse moves take colours from here on, so they are solved last and have the last word: what
cannot give way. With the lowest ones, boxes that were put into each other part faster (docs/decisions.md)."""

OVERFLOW = COLOURS
NONE = -1


@kernel
def any_change(arbiters, count, indices):
    """Whether something began or ceased to touch since colours were given. indices: not looked at, see below."""
    changed = 0
    for k in range(count):
        changed += (arbiters[k].count > 0) != (arbiters[k].colour >= 0)
    return changed > 0


@kernel
def any_change_among(arbiters, count, indices):
    """The same for the arbiters at these indices (K,) int64."""
    changed = count * 0  # a literal would be a type of its own
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        changed += (arbiter.count > 0) != (arbiter.colour >= 0)
    return changed > 0


@kernel
def lowest_free(taken, held):
    """The first colour not in a set, OVERFLOW if all are. held: whether it is for what cannot give way."""
    for k in range(COLOURS):
        colour = (k + HELD_FROM) % COLOURS if held else k
        if taken >> colour & 1 == 0:
            return colour
    return OVERFLOW


@kernel
def colours_at(body, motions, taken):
    """Which colours a body's contacts have. One that no impulse moves may have as many of a colour as it likes."""
    return taken[body] if motions[body].inverse_mass > 0 else np.int64(0)


@kernel
def give_colours(arbiters, indices, motions, taken):
    """Brings the colours of the arbiters at these indices (K,) int64, ascending, up to date with what touches. They are
    all that the bodies concerned have. taken: (N,) int64 of scratch, one a body.

    A colour that is none, or is another's already because a body has begun to move, is given anew.
    """
    taken[:] = 0
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        others = colours_at(arbiter.body1, motions, taken) | colours_at(arbiter.body2, motions, taken)
        colour = arbiter.colour
        if arbiter.count == 0 or colour < 0 or colour > OVERFLOW or (others >> colour) & 1 != 0:
            arbiter.colour = NONE
        elif colour < OVERFLOW:
            taken[arbiter.body1] |= np.int64(1) << colour
            taken[arbiter.body2] |= np.int64(1) << colour
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        if arbiter.count > 0 and arbiter.colour < 0:
            arbiter.colour = take_lowest(arbiter.body1, arbiter.body2, motions, taken)


@kernel
def take_lowest(body1, body2, motions, taken):
    """The first colour that neither body has yet; from now on both have it."""
    held = motions[body1].inverse_mass == 0 or motions[body2].inverse_mass == 0
    colour = lowest_free(colours_at(body1, motions, taken) | colours_at(body2, motions, taken), held)
    if colour < OVERFLOW:
        taken[body1] |= np.int64(1) << np.int64(colour)
        taken[body2] |= np.int64(1) << np.int64(colour)
    return colour


@kernel
def colour_joints(joints, order, motions, taken, colours):
    """The colours of joints, in the order of creation. Who is joined changes seldom, so they are all given anew."""
    taken[:] = 0
    for k in range(len(order)):
        colours[k] = take_lowest(joints[order[k]].body1, joints[order[k]].body2, motions, taken)


@kernel
def count_colours(colours, sizes):
    """How many there are of each, the overflow last: sizes (COLOURS + 1,) int64."""
    sizes[:] = 0
    for k in range(len(colours)):
        if colours[k] >= 0:
            sizes[colours[k]] += 1


@kernel
def arrange(colours, sizes, width, nothing, slots, firsts):
    """Writes who is of which colour, colour by colour, each in blocks of `width`; then the overflow, one a block.

    slots (blocks * width,) int32: index into `colours`; where there is none, `nothing`.
    firsts (COLOURS + 2,) int64: the first block of each colour, of the overflow, and the end.
    """
    slots[:] = nothing
    places = np.empty(COLOURS + 1, np.int64)
    block = 0
    for colour in range(COLOURS + 1):
        firsts[colour] = block
        places[colour] = block * width
        block += sizes[colour] if colour == OVERFLOW else (sizes[colour] + width - 1) // width
    firsts[COLOURS + 1] = block
    for k in range(len(colours)):
        colour = colours[k]
        if colour >= 0:
            slots[places[colour]] = k
            places[colour] += width if colour == OVERFLOW else 1


class Layout:
    """Who is of which colour, as blocks of rows to solve side by side."""

    def __init__(self) -> None:
        self.sizes = np.zeros(COLOURS + 1, np.int64)  # how many of each colour, the overflow last
        self.firsts = np.zeros(COLOURS + 2, np.int64)  # the first block of each, and the end
        self.slots = np.empty(0, np.int32)  # who is in which place of which block

    @property
    def blocks(self) -> int:
        return int(self.firsts[-1])

    def arrange(self, colours: np.ndarray, width: int, nothing: int) -> None:
        """Takes up new colours (M,) int32; `nothing` fills up blocks."""
        count_colours(colours, self.sizes)
        blocks = int(((self.sizes[:COLOURS] + width - 1) // width).sum() + self.sizes[COLOURS])
        if len(self.slots) != blocks * width:
            self.slots = np.empty(blocks * width, np.int32)
        arrange(colours, self.sizes, width, nothing, self.slots, self.firsts)
