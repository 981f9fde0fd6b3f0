"""Slow, obvious references for xpbd and avbd on worlds of contacts alone: plain numpy, one body after the other.

They are given the contacts that the narrow phase found (anchors, normals, separations), and share nothing else with the
engine.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass
class Body:
    """(x, y, angle), and how fast they change."""

    place: Vector
    speed: Vector
    masses: Vector  # (m, m, I); infinite where nothing moves it
    seen: float = 0.0  # angle since the step began by which anchors turned: each turn a counts as 2 atan(a / 2)

    def shift(self, way: Vector) -> None:
        self.place = self.place + way
        self.seen += 2 * np.arctan(way[2] / 2)


@dataclass
class Point:
    """A contact of two bodies, numbers into a list of them."""

    one: int
    other: int
    normal: Vector
    arms: tuple[Vector, Vector]  # from either centre, as the step began
    separation: float
    friction: float
    pushed: float = 0.0
    rubbed: float = 0.0
    total: Vector = field(default_factory=lambda: np.zeros(2))

    def jacobian(self, direction: Vector) -> tuple[Vector, Vector]:
        """Along it body2's point moves away from body1's: J . (dx, dy, dangle) of either."""
        rows = [np.array([*direction, r[0] * direction[1] - r[1] * direction[0]]) for r in self.arms]
        return -rows[0], rows[1]


def tangent(normal: Vector) -> Vector:
    return np.array([normal[1], -normal[0]])


def turned(angle: float, r: Vector) -> Vector:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * r[0] - s * r[1], s * r[0] + c * r[1]])


def separation_now(point: Point, bodies: list[Body], starts: list[Vector]) -> float:
    """With anchors that turn with the bodies."""
    one, other = bodies[point.one], bodies[point.other]
    anchors = [turned(body.seen, r) - r for body, r in zip((one, other), point.arms, strict=True)]
    way = (other.place - starts[point.other])[:2] + anchors[1] - (one.place - starts[point.one])[:2] - anchors[0]
    return float(point.separation + way @ point.normal)


def couple(a: tuple[Vector, Vector], b: tuple[Vector, Vector], bodies: list[Body], point: Point) -> float:
    """J M^-1 J^T of two rows."""
    return float((a[0] / bodies[point.one].masses) @ b[0] + (a[1] / bodies[point.other].masses) @ b[1])


def complementary(k: Vector, q: Vector) -> Vector:
    """x >= 0 with k x + q >= 0, one of the two 0 everywhere: tried case by case."""
    for case in product((True, False), repeat=len(q)):
        chosen = np.array(case)
        x = np.zeros(len(q))
        if chosen.any():
            x[chosen] = np.linalg.solve(k[np.ix_(chosen, chosen)], -q[chosen])
        if (x >= 0).all() and ((k @ x + q)[~chosen] >= -1e-15).all():
            return x
    raise ArithmeticError("no case fits")


def xpbd_step(bodies: list[Body], pairs: list[list[Point]], gravity: Vector, dt: float, substeps: int) -> None:
    """One step: Mueller et al. 2020, algorithm 2; the points of a pair are solved together, one cone holds both passes.

    gravity: (x, y, 0) [m/s^2]
    """
    h = dt / substeps
    starts = [body.place.copy() for body in bodies]
    for _ in range(substeps):
        before = [body.place.copy() for body in bodies]
        for body in bodies:
            if np.isfinite(body.masses[0]):
                body.speed = body.speed + h * gravity
            body.shift(h * body.speed)
        for points in pairs:
            for point in points:
                point.pushed = point.rubbed = 0.0
            rows = [point.jacobian(point.normal) for point in points]
            k = np.array([[couple(a, b, bodies, points[0]) for b in rows] for a in rows])
            pushes = complementary(k, np.array([separation_now(point, bodies, starts) for point in points]))
            for point, row, push in zip(points, rows, pushes, strict=True):
                point.pushed = float(push)
                move(bodies, point, row, point.pushed)
            for point in points:
                if point.pushed > 0.0:
                    row = point.jacobian(tangent(point.normal))
                    slid = row[0] @ (bodies[point.one].place - before[point.one])
                    slid += row[1] @ (bodies[point.other].place - before[point.other])
                    most = point.friction * point.pushed
                    point.rubbed = float(np.clip(-slid / couple(row, row, bodies, point), -most, most))
                    move(bodies, point, row, point.rubbed)
        for body, place in zip(bodies, before, strict=True):
            body.speed = (body.place - place) / h
        for points in pairs:
            put_speeds_right(bodies, [point for point in points if point.pushed > 0.0], h)


def put_speeds_right(bodies: list[Body], points: list[Point], h: float) -> None:
    """Neither parting nor approaching where it was pushed, then friction; impulses of both passes together."""
    rows = [point.jacobian(point.normal) for point in points]
    if points:
        k = np.array([[couple(a, b, bodies, points[0]) for b in rows] for a in rows])
        old = np.array([point.pushed / h for point in points])
        speeds = np.array([speed_along(bodies, point, row) for point, row in zip(points, rows, strict=True)])
        for point, row, new in zip(points, rows, complementary(k, speeds - k @ old), strict=True):
            hit(bodies, point, row, float(new) - point.pushed / h)
            point.pushed = float(new) * h
    for point in points:
        row = point.jacobian(tangent(point.normal))
        most = point.friction * point.pushed / h
        new = point.rubbed / h - speed_along(bodies, point, row) / couple(row, row, bodies, point)
        new = float(np.clip(new, -most, most))
        hit(bodies, point, row, new - point.rubbed / h)
        point.total = point.total + np.array([point.pushed / h, new])


def move(bodies: list[Body], point: Point, row: tuple[Vector, Vector], push: float) -> None:
    for index, j in ((point.one, row[0]), (point.other, row[1])):
        bodies[index].shift(push * j / bodies[index].masses)


def hit(bodies: list[Body], point: Point, row: tuple[Vector, Vector], impulse: float) -> None:
    for index, j in ((point.one, row[0]), (point.other, row[1])):
        bodies[index].speed = bodies[index].speed + impulse * j / bodies[index].masses


def speed_along(bodies: list[Body], point: Point, row: tuple[Vector, Vector]) -> float:
    return float(row[0] @ bodies[point.one].speed + row[1] @ bodies[point.other].speed)


def avbd_step(
    bodies: list[Body], points: list[Point], carried: list[Vector], gravity: Vector, dt: float, iterations: int,
    alpha: float, gamma: float, penalties: tuple[float, float], growth: float,
) -> None:  # fmt: skip
    """One step: Giles et al. 2025, algorithm 1, in forces and stiffnesses as the paper has them.

    carried: impulses of the step before, along and across each point [N s]; penalties and growth: as the engine's
    constants tell them, in effective masses over dt^2.
    """
    starts = [body.place.copy() for body in bodies]
    targets = []
    for body in bodies:
        falls = gravity if np.isfinite(body.masses[0]) else 0 * gravity
        targets.append(body.place + dt * (body.speed + dt * falls))
        body.place = body.place + dt * body.speed
    rows, forces, stiff, inverse = [], [], [], []
    for point, impulses in zip(points, carried, strict=True):
        for k, direction in enumerate((point.normal, tangent(point.normal))):
            row = point.jacobian(direction)
            rows.append((point, row, k))
            inverse.append(couple(row, row, bodies, point))
            forces.append(alpha * gamma * impulses[k] / dt)
            stiff.append(penalties[k] / inverse[-1] / dt**2)

    def error(r: int) -> float:
        point, row, k = rows[r]
        moved = row[0] @ (bodies[point.one].place - starts[point.one])
        moved += row[1] @ (bodies[point.other].place - starts[point.other])
        return float(moved + (point.separation - alpha * min(point.separation, 0.0) if k == 0 else 0.0))

    def push(r: int) -> tuple[float, bool]:
        point, _, k = rows[r]
        wanted = forces[r] - stiff[r] * error(r)
        low, high = (0.0, np.inf) if k == 0 else (-point.friction * forces[r - 1], point.friction * forces[r - 1])
        return float(np.clip(wanted, low, high)), low <= wanted <= high

    for _ in range(iterations):
        for index, body in enumerate(bodies):
            if not np.isfinite(body.masses[0]):
                continue
            matrix = np.diag(body.masses) / dt**2
            force = -matrix @ (body.place - targets[index])
            for r, (point, row, _) in enumerate(rows):
                if index in (point.one, point.other):
                    j = row[0] if index == point.one else row[1]
                    force = force + push(r)[0] * j
                    matrix = matrix + stiff[r] * np.outer(j, j)
            body.place = body.place + np.linalg.solve(matrix, force)
        for r in range(len(rows)):
            forces[r], free = push(r)
            if free:
                stiff[r] += growth * abs(error(r)) / inverse[r] / dt**2
    for body, start in zip(bodies, starts, strict=True):
        body.speed = (body.place - start) / dt
    for r, (point, _, k) in enumerate(rows):
        point.total[k] = forces[r] * dt
