"""Dragging: a hand pulls a body after it with a spring, softly and without ever blowing up."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from engine import Body, validate

FREQUENCY = 5.0  # of the spring for the body's own mass [Hz]: higher follows more stiffly
DAMPING_RATIO = 0.7
LARGEST_ACCELERATION = 500.0  # most that a hand gives a body [m/s^2]: what is stuck is not torn through walls


@dataclass
class Hand:
    """What one pointer holds."""

    serial: int  # of the body
    anchor_x: float  # where it is held, in the body's frame [m]
    anchor_y: float
    x: float  # where the hand is, in the world [m]
    y: float

    @classmethod
    def on(cls, body: Body, point: tuple[float, float]) -> Hand:
        """A hand that takes hold of a body at a point of the world."""
        q = body.direction
        x, y = point[0] - body.position.x, point[1] - body.position.y
        return cls(body.serial, q.x * x + q.y * y, q.x * y - q.y * x, point[0], point[1])

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Hand:
        """What `to_dict` gave. ValueError if a number of it is not finite."""
        hand = cls(**values)
        for name, value in hand.to_dict().items():
            validate.number(name, value)
        return hand

    def held_point(self, body: Body) -> tuple[float, float]:
        """Where on the body it holds, in the world [m]."""
        q = body.direction
        x = body.position.x + (q.x * self.anchor_x - q.y * self.anchor_y)
        y = body.position.y + (q.y * self.anchor_x + q.x * self.anchor_y)
        return x, y

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


def pull(hand: Hand, body: Body, dt: float) -> None:
    """Gives the body one step's impulse of a damped spring between hand and anchor.

    P = -(K + gamma)^-1 (v + beta C), the implicit spring of E. Catto, "Soft Constraints" (GDC 2011): stable for every
    stiffness, mass and time step.
    """
    px, py = hand.held_point(body)
    rx, ry = px - body.center.x, py - body.center.y
    omega = 2.0 * math.pi * FREQUENCY
    damper = 2.0 * body.mass * DAMPING_RATIO * omega
    spring = body.mass * omega * omega
    gamma = 1.0 / (dt * (damper + dt * spring))
    rate = dt * spring * gamma
    velocity = body.velocity_at((px, py))
    wanted_x = velocity.x + rate * (px - hand.x)
    wanted_y = velocity.y + rate * (py - hand.y)

    im, ii = body.inverse_mass, body.inverse_inertia
    k_xx = im + ii * ry * ry + gamma
    k_xy = -ii * rx * ry
    k_yy = im + ii * rx * rx + gamma
    determinant = k_xx * k_yy - k_xy * k_xy
    impulse_x = -(k_yy * wanted_x - k_xy * wanted_y) / determinant
    impulse_y = -(k_xx * wanted_y - k_xy * wanted_x) / determinant
    limit = LARGEST_ACCELERATION * body.mass * dt
    size = math.sqrt(impulse_x * impulse_x + impulse_y * impulse_y)
    if size > limit:
        impulse_x, impulse_y = impulse_x * (limit / size), impulse_y * (limit / size)
    body.apply_impulse((impulse_x, impulse_y), (px, py))
