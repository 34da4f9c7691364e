"""The rivals, each in a process of its own, so that its memory is its own.

A rival is a function of a mesh file that loads its libraries and the mesh, and returns what simplifies to a count; that
in turn returns what hands out points and triangles. Only the middle step is measured.

As a program: rivals.py NAME SOURCE COUNT TARGET writes the mesh TARGET and prints what it took as JSON.
"""

import ctypes
import json
import pathlib
import sys
import time
from collections.abc import Callable
from importlib import metadata
from typing import NamedTuple


def meshlab(prepare=lambda meshes: None, **options):
    """MeshLab's quadric collapse, after `prepare`."""

    def rival(source):
        import pymeshlab

        meshes = pymeshlab.MeshSet(verbose=False)
        meshes.load_new_mesh(source)

        def simplify(count):
            prepare(meshes)
            meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=count, **options)
            return lambda: (meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix())

        return simplify

    return rival


def occlusion(meshes):
    """MeshLab's ambient occlusion as the quality of each vertex: 0 where no ray gets away."""
    meshes.compute_scalar_ambient_occlusion(rays=64)


def delete_hidden(meshes):
    """Deletes the triangles none of whose corners sees anything of the surroundings."""
    occlusion(meshes)
    meshes.compute_selection_by_condition_per_face(condselect="(q0 == 0) && (q1 == 0) && (q2 == 0)")
    meshes.meshing_remove_selected_faces()


def open3d(source):
    import open3d

    mesh = open3d.io.read_triangle_mesh(source)

    def simplify(count):
        result = mesh.simplify_quadric_decimation(count)
        return lambda: (result.vertices, result.triangles)

    return simplify


def vtk(name, **settings):
    """One of VTK's decimating filters, with `settings` that its Set… methods know."""

    def rival(source):
        from vtkmodules import vtkFiltersCore, vtkIOPLY
        from vtkmodules.util.numpy_support import vtk_to_numpy

        reader = vtkIOPLY.vtkPLYReader(file_name=source)
        reader.Update()
        mesh = reader.GetOutput()

        def simplify(count):
            decimate = getattr(vtkFiltersCore, name)(target_reduction=1 - count / mesh.GetNumberOfPolys(), **settings)
            decimate.SetInputData(mesh)
            decimate.Update()
            result = decimate.GetOutput()
            polygons = result.GetPolys().GetConnectivityArray()
            return lambda: (vtk_to_numpy(result.GetPoints().GetData()), vtk_to_numpy(polygons).reshape(-1, 3))

        return simplify

    return rival


def fast_simplification(source):
    import fast_simplification
    import ply

    mesh = ply.read(source)

    def simplify(count):
        result = fast_simplification.simplify(*mesh, target_count=count)
        return lambda: result

    return simplify


def meshoptimizer(update, options=0):
    """meshoptimizer with its borders free and no bound on the error; `update` also moves the vertices that are kept."""

    def rival(source):
        import numpy as np
        import ply

        library = ctypes.CDLL(str(meshoptimizer_library()))
        points, triangles = ply.read(source)
        points, indices = points.astype(np.float32), triangles.astype(np.uint32).ravel()
        pointer, size, real = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_float
        ending = (size, real, ctypes.c_uint, pointer)  # indices to keep, error allowed, options, error reached
        surface = (points.ctypes.data, len(points), 12)
        limits = (real(np.finfo(np.float32).max), options, None)

        def simplify(count):
            if update:
                function = library.meshopt_simplifyWithUpdate
                function.argtypes = (pointer, size, pointer, size, size, pointer, size, pointer, size, pointer, *ending)
                function.restype = size
                no_attributes = (None, 0, None, 0, None)
                kept = function(indices.ctypes.data, len(indices), *surface, *no_attributes, 3 * count, *limits)
                result = indices
            else:
                function = library.meshopt_simplify
                function.argtypes = (pointer, pointer, size, pointer, size, size, *ending)
                function.restype = size
                result = np.empty_like(indices)
                kept = function(result.ctypes.data, indices.ctypes.data, len(indices), *surface, 3 * count, *limits)
            return lambda: (points, result[:kept].reshape(-1, 3))

        return simplify

    return rival


def meshoptimizer_library():
    """The library that `run` built into the environment, named after the crate that its source came with."""
    return next(pathlib.Path(sys.prefix, "lib").glob("libmeshopt-*.so"))


# Bit of meshopt_SimplifyPrune: small pieces may vanish, whatever the topology says.
PRUNE = 1 << 3


class Rival(NamedTuple):
    """Where it comes from, what it does to a file, and how that reads in a record."""

    package: str
    load: Callable
    settings: str


FREE = "`meshopt_simplify`, error unbounded, borders free"
UPDATE = "`meshopt_simplifyWithUpdate`, error unbounded, borders free, no attributes"
OCCLUSION = "`compute_scalar_ambient_occlusion(rays=64)`"
COLLAPSE = "`meshing_decimation_quadric_edge_collapse(targetfacenum=COUNT"
REMOVE = "triangles with 0 at every corner removed"

RIVALS = {
    "MeshLab": Rival("pymeshlab", meshlab(), f"{COLLAPSE})`"),
    "MeshLab, occlusion as weight": Rival(
        "pymeshlab", meshlab(occlusion, qualityweight=True), f"{OCCLUSION}, {COLLAPSE}, qualityweight=True)`"
    ),
    "MeshLab, hidden deleted": Rival("pymeshlab", meshlab(delete_hidden), f"{OCCLUSION}, {REMOVE}, {COLLAPSE})`"),
    "meshoptimizer": Rival("meshopt", meshoptimizer(update=False), FREE),
    "meshoptimizer, update": Rival("meshopt", meshoptimizer(update=True), UPDATE),
    "meshoptimizer, update, prune": Rival(
        "meshopt", meshoptimizer(update=True, options=PRUNE), f"{UPDATE}, `meshopt_SimplifyPrune`"
    ),
    "Open3D": Rival("open3d", open3d, "`simplify_quadric_decimation(COUNT)`"),
    "VTK quadric": Rival("vtk", vtk("vtkQuadricDecimation"), "`vtkQuadricDecimation`, its defaults"),
    "VTK pro": Rival("vtk", vtk("vtkDecimatePro", preserve_topology=False), "`vtkDecimatePro`, `PreserveTopologyOff`"),
    "fast-simplification": Rival("fast-simplification", fast_simplification, "`simplify(target_count=COUNT)`"),
}


def version(package):
    """The package's name and version."""
    if package == "meshopt":
        return f"meshopt {meshoptimizer_library().stem.split('-')[1]}"
    return f"{package} {metadata.version(package)}"


def resident(line):
    """A line of the system's word about this process, in MiB: VmRSS now, VmHWM at most."""
    status = pathlib.Path("/proc/self/status").read_text()
    return int(status.split(f"{line}:")[1].split()[0]) / 1024


def main(name, source, count, target):
    import ply

    simplify = RIVALS[name].load(source)
    # What loading gave back leaves the process, and the highest mark starts anew.
    ctypes.CDLL(None).malloc_trim(0)
    pathlib.Path("/proc/self/clear_refs").write_text("5")
    base = resident("VmRSS")
    start = time.process_time()
    mesh = simplify(int(count))
    seconds = time.process_time() - start
    peak = resident("VmHWM")
    ply.write(target, *mesh())
    print(json.dumps({"seconds": seconds, "base_mib": base, "peak_mib": peak}))


if __name__ == "__main__":
    main(*sys.argv[1:])
