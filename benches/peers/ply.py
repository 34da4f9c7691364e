"""The one kind of mesh file that goes between the programs here: binary PLY, triangles only, as Outsight writes it."""

import numpy as np

FACE = np.dtype([("corners", "u1"), ("vertices", "<i4", 3)])


def read(path):
    """Points (n × 3, as precise as the file) and triangles (m × 3, int32)."""
    with open(path, "rb") as file:
        header = list(iter(file.readline, b"end_header\n"))
        count = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith(b"element")}
        real = "<f8" if b"property double x\n" in header else "<f4"
        points = np.fromfile(file, real, 3 * count[b"vertex"]).reshape(-1, 3)
        return points, np.fromfile(file, FACE, count[b"face"])["vertices"].copy()


def write(path, points, triangles):
    """Writes in double precision, so that no rival loses by the file."""
    faces = np.zeros(len(triangles), FACE)
    faces["corners"], faces["vertices"] = 3, triangles
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    with open(path, "wb") as file:
        file.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{axes}"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
        )
        np.ascontiguousarray(points, "<f8").tofile(file)
        faces.tofile(file)
