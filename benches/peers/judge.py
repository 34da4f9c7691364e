"""Who judges: `outsight compare`, and an image error of our own making beside it, so that our judge is judged too."""

import functools

import numpy as np

import ply
from outsight import outsight

# Points on each surface for the distances.
SAMPLES = 500_000
# `compare` also looks at the original, which nobody asks for here.
GLANCE = ("--cameras", 6, "--resolution", 64)
# Pixels along a picture's side, and samples along a pixel's side.
WIDTH, FINE = 512, 2


def errors(source, mesh):
    """What `outsight compare` says."""
    report, _ = outsight("compare", source, mesh, "--surface-samples", SAMPLES, *GLANCE, "--threads", 1)
    test = report["tests"][0]
    return {
        "triangles": test["triangles"],
        "image_rmse": test["image_rmse"],
        "silhouette_xor": test["silhouette_xor"],
        "geometric_mean": test["geometric"]["mean"],
        "geometric_rms": test["geometric"]["rms"],
    }


def second_image_rmse(source, mesh):
    """The same image error from rays that Open3D casts, shaded here: shares with our judge no more than its definition."""
    centre, radius, original = reference(source)
    squares = [np.square(a - b).mean() for a, b in zip(original, pictures(mesh, centre, radius))]
    return float(np.sqrt(np.mean(squares)))


@functools.lru_cache(maxsize=1)
def reference(source):
    """Centre and half diagonal of the box of the vertices in use, and the pictures."""
    points, triangles = ply.read(source)
    used = points[np.unique(triangles)].astype(float)
    low, high = used.min(axis=0), used.max(axis=0)
    centre, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    return centre, radius, list(pictures(source, centre, radius))


def dodecahedron():
    """Unit vectors to the 20 vertices."""
    golden = (1 + 5**0.5) / 2
    signs = (-1, 1)
    corners = [(x, y, z) for x in signs for y in signs for z in signs]
    for a in (-1 / golden, 1 / golden):
        for b in (-golden, golden):
            corners += [(0, a, b), (a, b, 0), (b, 0, a)]
    return np.array(corners) / 3**0.5


def pictures(mesh, centre, radius):
    """Grey pictures from the 20 directions, flat shaded by a head light."""
    import open3d

    points, triangles = ply.read(mesh)
    points = (points - centre) / radius
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals /= np.where(lengths > 0, lengths, 1)
    scene = open3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(points.astype(np.float32), triangles.astype(np.uint32))
    steps = (np.arange(WIDTH * FINE) + 0.5) / (WIDTH * FINE) * 2 - 1
    for toward in dodecahedron():
        right = np.cross(np.eye(3)[np.argmin(np.abs(toward))], toward)
        right /= np.linalg.norm(right)
        up = np.cross(toward, right)
        rays = np.empty((len(steps), len(steps), 6), np.float32)
        rays[..., :3] = steps[:, None, None] * up + steps[None, :, None] * right + 2 * toward
        rays[..., 3:] = -toward
        hit = scene.cast_rays(open3d.core.Tensor(rays), nthreads=1)["primitive_ids"].numpy()
        missed = hit == scene.INVALID_ID
        grey = 255 * np.abs(normals @ toward)[np.where(missed, 0, hit)]
        grey[missed] = 0
        yield grey.reshape(WIDTH, FINE, WIDTH, FINE).mean(axis=(1, 3)).astype(np.float32)
