#!/usr/bin/env python3
"""Geometric error beside MeshLab's Hausdorff filter, on the same pairs and with the same number of samples.

    benches/peers/run hausdorff MODEL...

Each model is compared with its own simplification to 5 %. Both programs spread SAMPLES points over the area of one mesh and
take the distance to the other, each way; MeshLab's are drawn at random. Vertices are left out of its mean and RMS as they
are of ours. The last column is the largest of the four deviations, and must stay below LIMIT.
"""

import pathlib
import sys
import tempfile

import pymeshlab

from outsight import outsight

SAMPLES = 1_000_000
LIMIT = 0.02


def meshlab(source, target):
    """Mean and RMS of MeshLab from one mesh to the other."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(source))
    meshes.load_new_mesh(str(target))
    found = meshes.get_hausdorff_distance(
        sampledmesh=0,
        targetmesh=1,
        samplevert=False,
        sampleedge=False,
        samplefauxedge=False,
        sampleface=True,
        samplenum=SAMPLES,
        maxdist=pymeshlab.PercentageValue(100),
    )
    return found["mean"], found["RMS"]


def main():
    print("model | triangles | test | direction | mean | MeshLab | RMS | MeshLab | off by")
    print("--- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---:")
    worst = 0
    for model in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            original, small = pathlib.Path(folder) / "original.ply", pathlib.Path(folder) / "small.ply"
            outsight("convert", model, original)
            made, _ = outsight("simplify", original, "-o", small, "-r", 0.05, "--metric", "quadric")
            few_cameras = ("--cameras", 6, "--resolution", 64)
            report, _ = outsight("compare", original, small, "--surface-samples", SAMPLES, *few_cameras)
            test = report["tests"][0]
            ways = {"forward": (original, small), "backward": (small, original)}
            for direction, (source, target) in ways.items():
                ours = test["distances"][direction]
                mean, rms = meshlab(source, target)
                off = max(abs(ours["mean"] / mean - 1), abs(ours["rms"] / rms - 1))
                worst = max(worst, off)
                name = pathlib.Path(model).name.split(".")[0]
                print(
                    f"{name} | {made['triangles']:,} | {test['triangles']:,} | {direction} | {ours['mean']:.5g} | "
                    f"{mean:.5g} | {ours['rms']:.5g} | {rms:.5g} | {100 * off:.2f} %",
                    flush=True,
                )
    if worst > LIMIT:
        sys.exit(f"off by {100 * worst:.2f} %, more than {100 * LIMIT:.0f} %")


if __name__ == "__main__":
    main()
