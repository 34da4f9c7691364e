#!/usr/bin/env python3
"""Outsight beside other simplifiers: image error at equal counts and processor seconds, all in one run.

    benches/peers/run simplify MODEL...

Each rival simplifies to Outsight's count; `outsight compare` judges them all against the original. Seconds are
processor time of the simplification alone: for Outsight, of the whole process less reading and writing, on one thread,
looking included. A rival that stops above the count is shown with its count, and is not the best.
"""

import pathlib
import sys
import tempfile
import time

import fast_simplification
import numpy as np
import pymeshlab

from program import outsight

RATIOS = [0.2, 0.05, 0.005]


def meshlab(source, target, count, by_occlusion):
    """MeshLab's quadric collapse, optionally with ambient occlusion as the quality that weighs the quadrics."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(source))
    start = time.process_time()
    if by_occlusion:
        meshes.compute_scalar_ambient_occlusion(rays=64)
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=count, qualityweight=by_occlusion)
    seconds = time.process_time() - start
    meshes.save_current_mesh(str(target), save_vertex_quality=False)
    return seconds


def fast(source, target, count):
    """The package fast-simplification, a quadric collapse with thresholds instead of a queue."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(source))
    mesh = meshes.current_mesh()
    points, faces = mesh.vertex_matrix().astype(np.float32), mesh.face_matrix().astype(np.int32)
    start = time.process_time()
    points, faces = fast_simplification.simplify(points, faces, target_count=count)
    seconds = time.process_time() - start
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points.astype(float), face_matrix=faces))
    meshes.save_current_mesh(str(target))
    return seconds


def study(model, folder):
    """Prints a row per program and level for one model."""
    source = folder / "original.ply"
    outsight("convert", model, source, "--force")
    for ratio in RATIOS:
        ours = folder / "outsight.ply"
        report, seconds = outsight("simplify", source, "-o", ours, "-r", ratio, "--threads", 1, "--force")
        count = report["levels"][0]["output"]
        rows = {"Outsight VG": (ours, seconds - report["seconds"]["read"] - report["seconds"]["write"])}
        shape = folder / "shape.ply"
        report, seconds = outsight("simplify", source, "-o", shape, "-t", count, "--metric", "quadric", "--threads", 1, "--force")
        rows["Outsight QB"] = (shape, seconds - report["seconds"]["read"] - report["seconds"]["write"])
        rivals = {
            "MeshLab": lambda target: meshlab(source, target, count, False),
            "MeshLab, occlusion": lambda target: meshlab(source, target, count, True),
            "fast-simplification": lambda target: fast(source, target, count),
        }
        for name, run in rivals.items():
            target = folder / (name.split(",")[0].lower() + str(len(name)) + ".ply")
            try:
                rows[name] = (target, run(target))
            except Exception as error:  # a rival that fails is part of the record
                print(f"{pathlib.Path(model).name} | {count:,} | {name} | failed: {error} | |")
        # Pictures alone are wanted here: few samples, and no more than a glance at the original.
        glance = ("--surface-samples", 1000, "--cameras", 6, "--resolution", 64)
        compared, _ = outsight("compare", source, *(path for path, _ in rows.values()), *glance)
        rivals = [t for t, n in zip(compared["tests"], rows) if not n.startswith("Outsight")]
        best = min((t["image_rmse"] for t in rivals if t["triangles"] <= 1.05 * count), default=float("nan"))
        for test, (name, (_, seconds)) in zip(compared["tests"], rows.items()):
            error = test["image_rmse"]
            label = pathlib.Path(model).name.split(".")[0]
            print(f"{label} | {test['triangles']:,} | {name} | {error:.2f} | {error / best:.2f} | {seconds:.2f}", flush=True)


def main():
    print("model | triangles | program | image RMSE | ÷ best rival | CPU s")
    print("--- | ---: | --- | ---: | ---: | ---:")
    for model in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            study(model, pathlib.Path(folder))


if __name__ == "__main__":
    main()
