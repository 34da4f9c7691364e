#!/usr/bin/env python3
"""Our pictures beside ray-cast ones, on the same models and views.

    benches/peers/run pictures MODEL...

`outsight render` draws VIEWS pictures of each model. Open3D's `RaycastingScene` casts one ray for each of the 2 x 2 samples
of a pixel, from the mesh as read and framed here; the sample is shaded by the normal of the triangle that was hit, and
four of them are averaged. A pixel differs if it is more than one grey level of 255 off, which is what rounding to a PNG may
do. Counted are pixels that are not white in either picture; at most LIMIT of them may differ.
"""

import os
import pathlib
import sys
import tempfile

os.environ["OMP_NUM_THREADS"] = "2"

import numpy as np
import open3d as o3d
import pymeshlab

from outsight import outsight

VIEWS = [(1, 1, 1), (-1, 1, 1), (0, 0.618, 1.618), (1.618, 0, -0.618), (0.618, -1.618, 0)]
WIDTH = 512
UP = np.array((0.0, 0.0, 1.0))
LIMIT = 1e-3


def traced(scene, vertices, triangles, toward):
    """A picture by rays: grey per pixel, top row first, white where nothing is hit. `vertices` are centred on their box."""
    toward = np.array(toward, float) / np.linalg.norm(toward)
    right = np.cross(UP, toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    used = vertices[np.unique(triangles)]
    half = 1.05 * max(np.abs(used @ right).max(), np.abs(used @ up).max())
    along = ((np.arange(2 * WIDTH) + 0.5) / WIDTH - 1) * half
    columns, rows = np.meshgrid(along, along[::-1])
    far = 2 * np.linalg.norm(used, axis=1).max()
    origins = columns[..., None] * right + rows[..., None] * up + far * toward
    rays = np.concatenate([origins, np.broadcast_to(-toward, origins.shape)], axis=-1).astype(np.float32)
    hit = scene.cast_rays(o3d.core.Tensor(rays))["primitive_ids"].numpy()
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    cosines = np.abs(normals @ toward) / np.where(lengths > 0, lengths, 1)
    missed = hit == o3d.t.geometry.RaycastingScene.INVALID_ID
    grey = np.where(missed, 255, 255 * cosines[np.where(missed, 0, hit)])
    return grey.reshape(WIDTH, 2, WIDTH, 2).mean(axis=(1, 3)), missed.reshape(WIDTH, 2, WIDTH, 2).all(axis=(1, 3))


def main():
    print("model | triangles | pixels of 5 views | differ | share")
    print("--- | ---: | ---: | ---: | ---:")
    worst = 0
    for model in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            source, picture = pathlib.Path(folder) / "model.ply", pathlib.Path(folder) / "picture.png"
            outsight("convert", model, source)
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.load_new_mesh(str(source))
            vertices, triangles = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
            used = vertices[np.unique(triangles)]
            vertices = vertices - (used.min(axis=0) + used.max(axis=0)) / 2
            scene = o3d.t.geometry.RaycastingScene(nthreads=2)
            scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
            covered = different = 0
            for toward in VIEWS:
                camera = ",".join(map(str, toward))
                outsight("render", source, "-o", picture, "--camera", camera, "--up", "0,0,1", "--size", WIDTH, "--force")
                ours = np.asarray(o3d.io.read_image(str(picture))).astype(float)
                ours = ours[..., 0] if ours.ndim == 3 else ours
                theirs, empty = traced(scene, vertices, triangles, toward)
                covered += ((ours < 255) | ~empty).sum()
                different += (np.abs(ours - theirs) > 1).sum()
            worst = max(worst, different / covered)
            name = pathlib.Path(model).name.split(".")[0]
            print(f"{name} | {len(triangles):,} | {covered:,} | {different:,} | {100 * different / covered:.4f} %", flush=True)
    if worst > LIMIT:
        sys.exit(f"{100 * worst:.3f} % of the pixels differ, more than {100 * LIMIT:.1f} %")


if __name__ == "__main__":
    main()
