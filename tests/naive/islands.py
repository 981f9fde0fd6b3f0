"""Which bodies hang together, the slow and obvious way: by walking from body to body."""

from __future__ import annotations

from engine import World


def links(world: World) -> set[tuple[int, int]]:
    """Pairs of bodies with weight, by their numbers of creation among the living, that touch or are joined."""
    number = {body.serial: k for k, body in enumerate(world.bodies)}
    weighs = [body.kind == "dynamic" and body.inverse_mass > 0 for body in world.bodies]
    found = {(number[int(r["body1"])], number[int(r["body2"])]) for r in world.contact_records()}
    found |= {(number[int(r["body1"])], number[int(r["body2"])]) for r in world.joint_records()}
    return {(a, b) for a, b in found if weighs[a] and weighs[b]}


def names(world: World) -> list[int]:
    """For each body the first one, by number, that can be reached from it."""
    near: dict[int, set[int]] = {k: set() for k in range(world.body_count)}
    for a, b in links(world):
        near[a].add(b)
        near[b].add(a)
    result = []
    for start in near:
        reached, waiting = {start}, [start]
        while waiting:
            new = near[waiting.pop()] - reached
            reached |= new
            waiting += new
        result.append(min(reached))
    return result
