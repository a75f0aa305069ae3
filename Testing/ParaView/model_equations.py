# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces of the models as equations, with which the tests compare the models.

Nothing here uses the models' own maps. Each function named as a model takes a shape and points
(n, 3) and gives (#surfaces, n): signed distances to the unbounded cylinders, cones, tori and
planes, positive outside the solid, in the order of the model's Surface. Each `*_volume` takes a
shape."""

import math

import numpy as np


def bore(p, points):
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    half = math.radians(p.cone_angle) / 2
    cone = (r - p.mouth_radius) * math.cos(half) - (z - p.height) * math.sin(half)
    return np.array([-cone, p.bore_radius - r, r - p.outer_radius, z - p.height, -z])


def bore_volume(p):
    half = math.radians(p.cone_angle) / 2
    depth = (p.mouth_radius - p.bore_radius) / math.tan(half)
    frustum = math.pi * depth / 3 * (
        p.mouth_radius**2 + p.mouth_radius * p.bore_radius + p.bore_radius**2)
    return (math.pi * p.outer_radius**2 * p.height
            - math.pi * p.bore_radius**2 * (p.height - depth) - frustum)


def pipe(p, points):
    x, y, z = points.T
    bend, straight = p.elbow_radius, p.straight
    radii = [np.hypot(x, y), np.hypot(np.hypot(x - bend, z - straight) - bend, y),
             np.hypot(y, z - straight - bend)]
    inner = p.outer_radius - p.thickness
    return np.array([*(inner - r for r in radii), *(r - p.outer_radius for r in radii),
                     -z, x - bend - straight])


def pipe_volume(p):
    area = math.pi * (p.outer_radius**2 - (p.outer_radius - p.thickness)**2)
    return area * (2 * p.straight + math.pi * p.elbow_radius / 2)


def canister(p, points):
    x, y, z = points.T
    return np.array([p.hole_radius - np.hypot(x - p.offset, y), np.hypot(x, y) - p.radius,
                     -z, z - p.height])


def canister_volume(p):
    return math.pi * (p.radius**2 - p.hole_radius**2) * p.height


def bore_twist(p, points):
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    slope = math.atan2(p.top_radius - p.foot_radius, p.height)
    cone = (r - p.foot_radius) * math.cos(slope) - z * math.sin(slope)
    return np.array([p.bore_radius - r, cone, -z, z - p.height])


def bore_twist_volume(p):
    foot, top = p.foot_radius, p.top_radius
    frustum = math.pi * p.height * (foot * foot + foot * top + top * top) / 3
    return frustum - math.pi * p.bore_radius**2 * p.height


def canister_blind(p, points):
    return np.array([*canister(p, points), points[:, 2] - p.height / 4])


def canister_blind_volume(p):
    return math.pi * (p.radius**2 - 0.75 * p.hole_radius**2) * p.height


def courier(p, points):
    x, y, z = points.T
    low, high = p.plate_thickness, p.plate_thickness + p.boss_height
    rib = (0.4 * p.boss_spacing / 2, p.rib_thickness / 2)
    slot = (0.7 * 0.4 * p.boss_spacing / 2, 0.4 * p.rib_thickness / 2)
    left = np.hypot(x + p.boss_spacing / 2, y)
    right = np.hypot(x - p.boss_spacing / 2, y)
    return np.array([
        -z, z - low,
        -x - p.length / 2, x - p.length / 2, -y - p.width / 2, y - p.width / 2,
        p.bore_radius - left, left - p.boss_radius, z - high,
        p.bore_radius - right, right - p.boss_radius, z - high,
        -x - rib[0], x - rib[0], -y - rib[1], y - rib[1], z - high,
        x + slot[0], slot[0] - x, y + slot[1], slot[1] - y, z - low])


def courier_volume(p):
    bore_area, boss_area = math.pi * p.bore_radius**2, math.pi * p.boss_radius**2
    rib = 0.4 * p.boss_spacing * p.rib_thickness * (1 - 0.7 * 0.4)
    return (p.length * p.width * p.plate_thickness + (2 * boss_area + rib) * p.boss_height
            - 2 * bore_area * (p.plate_thickness + p.boss_height))


def normals(equations, shape, surfaces, points):
    """(n, 3): unit gradient of the distance to each point's surface, by central differences."""
    step, which = 1e-5, np.arange(len(points))
    gradient = np.empty((len(points), 3))
    for axis, direction in enumerate(np.eye(3)):
        ahead = equations(shape, points + step * direction)[surfaces, which]
        behind = equations(shape, points - step * direction)[surfaces, which]
        gradient[:, axis] = (ahead - behind) / (2 * step)
    return gradient / np.linalg.norm(gradient, axis=1)[:, None]
