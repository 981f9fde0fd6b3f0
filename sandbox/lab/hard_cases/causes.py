"""Why soft_step's defaults fail where they do: told beside each failure. A test holds that none is told in vain."""

from __future__ import annotations

CAUSES: dict[str, str] = {
    "mass_ratio_1000": """
        The springs between a box and one of a thousandth of its mass give way by 0.35 m, statics say; so deep in a box
        of 1 m the nearest face is soon another one, and the light box is squeezed out sideways.""",
    "all_in_one_place": """
        All pairs overlap fully, and each is pushed apart at up to 3 m/s along the same axis: in a row of sixty the
        speeds add up, and the outermost leave at tens of metres a second.""",
    "seams": """
        At a seam the next tile's side is nearer than its top, which a box that sank by a tenth of a millimetre has
        passed: it is a wall to every shape that knows no neighbours. A chain, which knows them, is slid over
        (ghost_bumps).""",
    "load_removed_100": """
        The stack carried a hundred boxes; the impulses that held them are where the next step starts from, and one
        pass over four boxes on each other does not take them all back.""",
}
