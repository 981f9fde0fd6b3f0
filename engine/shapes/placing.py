"""Where shapes are: their own frames, carried along by their bodies."""

from __future__ import annotations

from engine.jit import kernel
from engine.vec2 import Vec2, rotate


@kernel
def write_placements(order, shapes, bodies, motions, placements):
    """Puts every shape where its body is now."""
    for rank in range(len(order)):
        row = order[rank]
        shape = shapes[row]
        body = bodies[shape.body]
        motion = motions[shape.body]
        place = placements[row]
        out = rotate(Vec2(motion.cosine, motion.sine), Vec2(shape.local_x, shape.local_y))
        place.x = body.x + out.x
        place.y = body.y + out.y
        place.cosine = motion.cosine * shape.local_cosine - motion.sine * shape.local_sine
        place.sine = motion.sine * shape.local_cosine + motion.cosine * shape.local_sine
