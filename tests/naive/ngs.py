"""One step of ngs in plain numpy, from what the outside sees: contacts and revolute joints as rows of full length."""

from __future__ import annotations

import numpy as np

from engine import World
from engine.constants import SLOP


def cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def turned(angle: float, a: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * a[0] - s * a[1], s * a[0] + c * a[1]])


class NaiveStep:
    """Bodies (N, 3): x, y, angle, and their velocities, in the order of creation."""

    def __init__(self, world: World, dt: float) -> None:
        self.dt = dt
        bodies = world.bodies
        self.places = np.column_stack([world.positions, world.angles]).copy()
        self.velocities = np.column_stack([world.velocities, world.angular_velocities]).copy()
        weights = [(body.mass, body.mass, body.inertia) for body in bodies]
        self.inverse = np.array([[0.0 if np.isinf(w) else 1.0 / w for w in row] for row in weights])
        self.number = {body.serial: k for k, body in enumerate(bodies)}
        self.kept = {self.key(record): record for record in world.contact_records()}
        self.joints = [self.joint(joint) for joint in world.joints]

    @staticmethod
    def key(record: np.void) -> tuple[int, int, int]:
        return int(record["body1"]), int(record["body2"]), int(record["feature"])

    def joint(self, joint) -> dict:
        a, b = self.number[joint.body1.serial], self.number[joint.body2.serial]
        arms = [
            turned(-self.places[k, 2], np.array(tuple(anchor)) - self.places[k, :2])
            for k, anchor in zip((a, b), joint.anchors, strict=True)
        ]
        return {"a": a, "b": b, "arms": arms, "impulse": np.array(tuple(joint.impulse))}

    def row(self, a: int, b: int, n: np.ndarray, r1: np.ndarray, r2: np.ndarray) -> np.ndarray:
        """A Jacobian of full length."""
        j = np.zeros(self.velocities.shape)
        j[a] -= (*n, cross(r1, n))
        j[b] += (*n, cross(r2, n))
        return j

    def mass(self, j: np.ndarray) -> float:
        return 1.0 / float((j * self.inverse * j).sum())

    def solve(self, world: World, passes: int, part: float, most: float) -> None:
        """The step whose contacts the world now tells; their impulses are found anew."""
        self.velocities[:, 1] -= 10.0 * self.dt * (self.inverse[:, 0] > 0)
        contacts = [self.contact(record, world) for record in world.contact_records()]
        for joint in self.joints:
            joint["rows"], joint["error"] = self.pin(joint)
        for row in contacts:
            self.velocities += self.inverse * (row["j"] * row["p"] + row["jt"] * row["pt"])
        for joint in self.joints:
            self.velocities += self.inverse * np.tensordot(joint["impulse"], joint["rows"], 1)
        for _ in range(world.iterations):
            for joint in self.joints:
                rows = joint["rows"]
                matrix = np.einsum("iab,ab,jab->ij", rows, self.inverse, rows)
                change = np.linalg.solve(matrix, -(rows * self.velocities).sum(axis=(1, 2)))
                self.velocities += self.inverse * np.tensordot(change, rows, 1)
            for row in contacts:
                self.visit(row)
        self.places += self.dt * self.velocities
        start = self.places - self.dt * self.velocities
        for _ in range(passes):
            for row in contacts:
                self.push_out(row, start, part, most)
            for joint in self.joints:
                rows, error = self.pin(joint)
                matrix = np.einsum("iab,ab,jab->ij", rows, self.inverse, rows)
                change = np.linalg.solve(matrix, -np.clip(error, -most, most))
                self.places += self.inverse * np.tensordot(change, rows, 1)

    def pin(self, joint: dict) -> tuple[np.ndarray, np.ndarray]:
        """Both rows and the error of a revolute joint."""
        a, b = joint["a"], joint["b"]
        r1, r2 = (turned(self.places[k, 2], arm) for k, arm in zip((a, b), joint["arms"], strict=True))
        rows = np.stack([self.row(a, b, n, r1, r2) for n in np.eye(2)])
        return rows, self.places[b, :2] + r2 - self.places[a, :2] - r1

    def contact(self, record: np.void, world: World) -> dict:
        """A contact as the step found it."""
        a, b = self.number[int(record["body1"])], self.number[int(record["body2"])]
        n = np.array([record["nx"], record["ny"]])
        found = next(
            arbiter for arbiter in world.arbiters
            if (arbiter.body1.serial, arbiter.body2.serial) == (record["body1"], record["body2"])
        )  # fmt: skip
        index = world._state.arbiters
        for k in range(index.count):
            pair = index.rows[k]
            serials = world._state.bodies.tables["bodies"]["serial"]
            if (serials[pair["body1"]], serials[pair["body2"]]) == (record["body1"], record["body2"]):
                point = next(p for p in index.contacts[k, : pair["count"]] if p["feature"] == record["feature"])
                break
        r1, r2 = np.array([point["r1_x"], point["r1_y"]]), np.array([point["r2_x"], point["r2_y"]])
        tangent = np.array([n[1], -n[0]])
        before = self.kept.get(self.key(record))
        j, jt = self.row(a, b, n, r1, r2), self.row(a, b, tangent, r1, r2)
        return {
            "a": a, "b": b, "n": n, "r1": r1, "r2": r2, "s": float(record["separation"]), "j": j, "jt": jt,
            "p": float(before["normal_impulse"]) if before is not None else 0.0,
            "pt": float(before["tangent_impulse"]) if before is not None else 0.0,
            "friction": found.friction,
        }  # fmt: skip

    def visit(self, row: dict) -> None:
        """Normal impulse, then friction."""
        speed = float((row["j"] * self.velocities).sum())
        total = max(row["p"] - self.mass(row["j"]) * (speed + max(row["s"], 0.0) / self.dt), 0.0)
        self.velocities += self.inverse * row["j"] * (total - row["p"])
        row["p"] = total
        speed = float((row["jt"] * self.velocities).sum())
        most = row["friction"] * total
        total = min(max(row["pt"] - self.mass(row["jt"]) * speed, -most), most)
        self.velocities += self.inverse * row["jt"] * (total - row["pt"])
        row["pt"] = total

    def push_out(self, row: dict, start: np.ndarray, part: float, most: float) -> None:
        """Overlap, where the bodies are."""
        moved = self.places - start
        r1, r2 = (turned(moved[row[k], 2], row[r]) for k, r in (("a", "r1"), ("b", "r2")))
        apart = moved[row["b"], :2] - moved[row["a"], :2] + r2 - r1 - row["r2"] + row["r1"]
        wanted = min(max(part * (float(apart @ row["n"]) + row["s"] + SLOP), -most), 0.0)
        j = self.row(row["a"], row["b"], row["n"], r1, r2)
        self.places -= self.inverse * j * (self.mass(j) * wanted)
