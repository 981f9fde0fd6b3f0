"""Taking bodies, shapes and joints out of a world."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.sleeping import touch
from engine.weights import reweigh

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.shape_handle import ShapeHandle
    from engine.state import State


def remove_shapes(state: State, rows: np.ndarray) -> None:
    """Pieces, with their contacts and hulls."""
    shapes = state.shapes.tables["shapes"]
    state.drop_arbiters(shapes["serial"][rows])
    for hull in shapes["hull"][rows]:
        if hull >= 0:
            state.hulls.remove(int(hull))
    for row in rows:
        state.shapes.remove(int(row))


def destroy_shape(state: State, handle: ShapeHandle) -> None:
    """A shape; its body's mass, centre and inertia follow."""
    row = handle.body._row
    touch(state, row, going=True)
    remove_shapes(state, handle.rows)
    reweigh(state, row)


def destroy_body(state: State, body: Body) -> None:
    """A body with its shapes, contacts and joints."""
    touch(state, body._row, going=True)
    joints = state.joints.tables["joints"]
    for row in state.joints.order:
        if body._row in (joints["body1"][row], joints["body2"][row]):
            state.joints.remove(int(row))
    order = state.shapes.order
    remove_shapes(state, order[state.shapes.tables["shapes"]["body"][order] == body._row])
    state.bodies.remove(body._row)
