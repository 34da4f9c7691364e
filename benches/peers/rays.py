#!/usr/bin/env python3
"""Occlusion rays a second, Outsight beside Open3D and MeshLab, on the same mesh and the same number of threads.

    benches/peers/run rays MODEL...

Outsight casts one ray from the middle of each triangle toward every camera of 258 that its front faces (estimator
`surface`). Open3D's `RaycastingScene` gets the very same rays in the same order, made beforehand and not counted.
MeshLab's ambient occlusion casts 258 rays a vertex; the half below the surface is part of what it does for a ray, so
only the half above is counted. Seconds are processor time divided by the threads, of the casting alone: for Outsight, what
258 cameras take more than 6. Best of REPEATS.
"""

import os
import pathlib
import sys
import tempfile
import time

THREADS = 2
REPEATS = 3
CAMERAS = 258
BATCH = 1 << 22

# Before the libraries start their threads.
os.environ["OMP_NUM_THREADS"] = str(THREADS)

import numpy as np
import open3d as o3d
import pymeshlab

from outsight import outsight


def octahedral_cameras():
    """The 258 directions: an octahedron whose edges are halved three times, each midpoint carried to the sphere."""
    corners = [np.array(c, float) for c in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    triangles = [(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    for _ in range(3):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                corners.append((corners[a] + corners[b]) / np.linalg.norm(corners[a] + corners[b]))
                middles[key] = len(corners) - 1
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return np.array(corners)


def best(run):
    """Least processor time of several runs."""
    seconds = []
    for _ in range(REPEATS):
        start = time.process_time()
        run()
        seconds.append(time.process_time() - start)
    return min(seconds)


def surface_rays(vertices, triangles):
    """The rays that Outsight casts, triangle by triangle, in batches of at most BATCH."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        normals /= lengths
    middles = corners.mean(axis=1) + 1e-6 * normals
    cameras = octahedral_cameras()
    step = BATCH // CAMERAS
    for start in range(0, len(triangles), step):
        part = slice(start, start + step)
        facing = normals[part] @ cameras.T > 1e-9
        triangle, camera = np.nonzero(facing)
        yield np.concatenate([middles[part][triangle], cameras[camera]], axis=1).astype(np.float32)


def open3d(vertices, triangles):
    """Processor seconds and rays of Open3D."""
    scene = o3d.t.geometry.RaycastingScene(nthreads=THREADS)
    scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
    scene.test_occlusions(np.zeros((1, 6), np.float32))  # builds the tree
    seconds = rays = 0
    for batch in surface_rays(vertices, triangles):
        tensor = o3d.core.Tensor(batch)
        seconds += best(lambda: scene.test_occlusions(tensor, nthreads=THREADS))
        rays += len(batch)
    return seconds, rays


def meshlab(source):
    """Processor seconds and rays of MeshLab's ambient occlusion."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(source))
    seconds = best(lambda: meshes.compute_scalar_ambient_occlusion(rays=CAMERAS))
    return seconds, meshes.current_mesh().vertex_number() * CAMERAS // 2


def ours(source):
    """Processor seconds and rays of Outsight: what 258 cameras take more than 6, so that reading and building cancel."""

    def run(cameras):
        report, seconds = outsight(
            "measure", source, "--backend", "embree", "--estimator", "surface", "--points", 1, "--sides", "one",
            "--cameras", cameras, "--threads", THREADS,
        )
        return seconds, report["rays"]

    (many, rays), (few, start_rays) = (min(run(cameras) for _ in range(REPEATS)) for cameras in (CAMERAS, 6))
    return many - few, rays - start_rays


def main():
    print("model | program | rays | CPU s / threads | Mray/s | Outsight is faster by")
    print("--- | --- | ---: | ---: | ---: | ---:")
    for model in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "model.ply"
            outsight("convert", model, source)
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.load_new_mesh(str(source))
            mesh = meshes.current_mesh()
            box = mesh.bounding_box()
            vertices = (mesh.vertex_matrix() - box.center()) / (box.diagonal() / 2)
            rows = {"Outsight": ours(source)}
            rows["Open3D"] = open3d(vertices, mesh.face_matrix())
            rows["MeshLab, ambient occlusion"] = meshlab(source)
            own = rows["Outsight"][1] / rows["Outsight"][0]
            for program, (seconds, rays) in rows.items():
                name = pathlib.Path(model).name.split(".")[0]
                rate = rays / seconds
                print(
                    f"{name} | {program} | {rays:,} | {seconds / THREADS:.2f} | {rate * THREADS / 1e6:.2f} | "
                    f"{own / rate:.2f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
