"""Contacts and joints as the outside sees them: copies, in tables or one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.state import State
from engine.tables import ALONG_WAY, CONTACT_RECORD, JOINT_RECORD, POINT, empty
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class Contact(NamedTuple):
    """One contact point, as the last step left it."""

    position: Vec2  # [m]
    normal: Vec2  # unit, from body1 to body2
    separation: float  # < 0: overlap [m]
    normal_impulse: float  # what the last step gave, P_n >= 0 [N s]
    tangent_impulse: float  # likewise P_t, along (normal.y, -normal.x) [N s]
    feature: int  # which edges meet, see narrow_phase/clip.py


class Arbiter(NamedTuple):
    """The contact points between two shapes of two bodies; body1 is that of the shape created first."""

    body1: Body
    body2: Body
    friction: float  # of the pair
    contacts: tuple[Contact, ...]


@kernel
def write_contacts(arbiters, contacts, count, bodies, motions, dt, records):
    """Writes the contacts of the first `count` arbiters as CONTACT_RECORD rows; returns how many there are.

    Positions are those of the step's beginning: body1 has moved on by v dt since.
    """
    total = 0
    for index in range(count):
        arbiter = arbiters[index]
        if arbiter.count == 0:
            continue
        body1, motion1 = bodies[arbiter.body1], motions[arbiter.body1]
        x = body1.center_x - dt * np.float64(motion1.vx)
        y = body1.center_y - dt * np.float64(motion1.vy)
        for i in range(arbiter.count):
            contact = contacts[index, i]
            record = records[total]
            record.body1 = body1.serial
            record.body2 = bodies[arbiter.body2].serial
            record.feature = contact.feature
            record.x = x + contact.r1_x
            record.y = y + contact.r1_y
            record.nx = arbiter.nx
            record.ny = arbiter.ny
            record.separation = contact.separation
            record.normal_impulse = contact.given_normal
            record.tangent_impulse = contact.given_tangent
            total += 1
    return total


def contact_records(state: State) -> np.ndarray:
    """(C,) CONTACT_RECORD: all contacts of the last step, in the solver's order."""
    table = state.arbiters
    records = empty(2 * table.count, CONTACT_RECORD)
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    total = write_contacts(table.rows, table.contacts, table.count, bodies, motions, state.last_dt, records)
    return np.array(records[:total], copy=True)


def joint_records(state: State, rows: np.ndarray | None = None) -> np.ndarray:
    """(J,) JOINT_RECORD: joints in the order of creation, or those in `rows`, anchors where the bodies are now."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    order = state.joints.order if rows is None else rows
    joints = state.joints.tables["joints"][order]
    records = np.zeros(len(joints), JOINT_RECORD)
    records["joint"] = joints["serial"]
    records["kind"] = joints["kind"]
    for number in ("1", "2"):
        rows = joints["body" + number]
        body, c, s = bodies[rows], motions["cosine"][rows], motions["sine"][rows]
        x, y = joints[f"anchor{number}_x"], joints[f"anchor{number}_y"]
        records["body" + number] = body["serial"]
        records["x" + number] = body["x"] + (c * x - s * y)
        records["y" + number] = body["y"] + (s * x + c * y)
    x, y, turn = joint_impulses(state, order, joints, records)
    records["impulse_x"], records["impulse_y"], records["turn_impulse"] = x, y, turn
    return records


def joint_impulses(
    state: State, order: np.ndarray, joints: np.ndarray, records: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What the last step gave body2 of each joint: x and y [N s], and what turned it [N m s].

    Along and across axes as they are now, at the end of the step.
    """
    lines = joints["held"] > POINT
    held_x, held_y = joints["given_x"].astype(np.float64), joints["given_y"].astype(np.float64)
    turns, slides = (state.joints.tables[name][order] for name in ("turns", "slides"))
    turn, slide = (
        (part["spring_given"] + part["motor_given"] + part["lower_given"] - part["upper_given"]).astype(np.float64)
        for part in (turns, slides)
    )
    motions = state.bodies.tables["motions"][joints["body1"]]
    axis_x = motions["cosine"] * joints["axis_x"] - motions["sine"] * joints["axis_y"]
    axis_y = motions["sine"] * joints["axis_x"] + motions["cosine"] * joints["axis_y"]
    way_x, way_y = records["x2"] - records["x1"], records["y2"] - records["y1"]
    length = np.maximum(np.hypot(way_x, way_y), 1e-300)
    by_way = slides["along"] == ALONG_WAY
    along_x, along_y = np.where(by_way, way_x / length, axis_x), np.where(by_way, way_y / length, axis_y)
    x = np.where(lines, -axis_y * held_x, held_x) + along_x * slide
    y = np.where(lines, axis_x * held_x, held_y) + along_y * slide
    return x, y, turn + np.where(lines, held_y, 0.0)


def arbiter_list(world: World) -> list[Arbiter]:
    """The arbiters of the last step, in the solver's order: by the order of creation of body1, then of body2."""
    state = world._state
    result = []
    table, k = state.arbiters, 0
    records = contact_records(state)
    for arbiter in table.rows[: table.count]:
        count = int(arbiter["count"])
        points = tuple(
            Contact(
                Vec2(float(contact["x"]), float(contact["y"])),
                Vec2(float(contact["nx"]), float(contact["ny"])),
                float(contact["separation"]),
                float(contact["normal_impulse"]),
                float(contact["tangent_impulse"]),
                int(contact["feature"]),
            )
            for contact in records[k : k + count]
        )
        k += count
        if count:
            body1 = world._body_in_row(int(arbiter["body1"]))
            body2 = world._body_in_row(int(arbiter["body2"]))
            result.append(Arbiter(body1, body2, float(arbiter["friction"]), points))
    return result
