"""Transformations as 4 x 4 arrays that act on column vectors, with the meaning of pbrt's directives."""

from __future__ import annotations

from typing import Sequence

import numpy as np


def translation(x: float, y: float, z: float) -> np.ndarray:
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def scaling(x: float, y: float, z: float) -> np.ndarray:
    return np.diag([x, y, z, 1.0])


def rotation(degrees: float, x: float, y: float, z: float) -> np.ndarray:
    """Rodrigues' formula: counterclockwise around the axis (x, y, z)."""
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
    cross = np.cross(np.eye(3), axis)  # cross @ v is axis x v
    angle = np.radians(degrees)
    m = np.eye(4)
    m[:3, :3] = np.cos(angle) * np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * np.outer(axis, axis)
    return m


def camera_from_world(numbers: Sequence[float]) -> np.ndarray:
    """LookAt eye, target, up: the camera looks along +z, its y is up, its x to the right."""
    eye, target, up = np.array(numbers, dtype=float).reshape(3, 3)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(up, forward)
    right /= np.linalg.norm(right)
    m = np.eye(4)
    m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = right, np.cross(forward, right), forward, eye
    return np.linalg.inv(m)


def matrix(numbers: Sequence[float]) -> np.ndarray:
    """Transform and ConcatTransform list columns."""
    return np.array(numbers, dtype=float).reshape(4, 4).T


def mirrors(m: np.ndarray) -> bool:
    """Whether the handedness changes."""
    return bool(np.linalg.det(m[:3, :3]) < 0)


def uniform_scale(m: np.ndarray) -> float:
    """The factor of a rotation (or mirroring) times a scale; 0 for all others."""
    gram = m[:3, :3].T @ m[:3, :3]
    scale = np.sqrt(np.trace(gram) / 3)
    return float(scale) if np.allclose(gram, scale**2 * np.eye(3), rtol=0, atol=1e-4 * scale**2) else 0.0
