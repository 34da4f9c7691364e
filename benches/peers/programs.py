"""Who takes part, and how each is run: Outsight by its command line, every rival in a process of its own."""

import functools
import json
import os
import pathlib
import subprocess
import sys

import rivals
from outsight import OUTSIGHT, outsight

HERE = pathlib.Path(__file__).resolve().parent

# Wall seconds that a rival may take.
TIME_LIMIT = 1800

OURS = {
    "Outsight VG": [],
    "Outsight VG, preset paper": ["--preset", "paper"],
    "Outsight QB": ["--metric", "quadric"],
    "Outsight, hidden deleted, then QB": ["--visibility-power", 0],
}

# Rivals that get what Outsight leaves after deleting what it finds hidden. They count as rivals: whoever has one program
# may have both.
AFTER_OURS = {f"hidden deleted by Outsight, then {name}": name for name in ("MeshLab", "VTK quadric")}

PROGRAMS = [*OURS, *rivals.RIVALS, *AFTER_OURS]


def ours(flags, source, target, *size):
    """Outsight: processor seconds without the share of reading and writing, and the whole process's memory."""
    report, seconds = outsight("simplify", source, "-o", target, *size, *flags, "--threads", 1, "--force")
    wall = report["seconds"]
    share = 1 - (wall["read"] + wall["write"]) / wall["total"]
    return {"seconds": share * seconds, "memory_mib": report["peak_mb"]}


def rival(name, source, target, count):
    """A rival: processor seconds of its work, and the memory that this took above its libraries and the mesh."""
    command = [sys.executable, HERE / "rivals.py", name, source, str(count), target]
    one_thread = os.environ | {"OMP_NUM_THREADS": "1", "VTK_SMP_MAX_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT, env=one_thread)
    if done.returncode:
        raise RuntimeError((done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1])
    took = json.loads(done.stdout.splitlines()[-1])
    memory = {"memory_mib": took["peak_mib"] - took["base_mib"], "base_mib": took["base_mib"]}
    return {"seconds": took["seconds"]} | memory


@functools.cache
def without_hidden(source):
    """The mesh less what Outsight finds hidden, and what finding it took; the same for every count."""
    target = source.with_name("seen.ply")
    return target, ours([], source, target, "-r", 1)


def run(name, source, target, count):
    """Simplifies by the program of that name; says what it took."""
    if name in OURS:
        return ours(OURS[name], source, target, "-t", count)
    if name in rivals.RIVALS:
        return rival(name, source, target, count)
    seen, before = without_hidden(source)
    after = rival(AFTER_OURS[name], seen, target, count)
    memory = {"memory_mib": max(before["memory_mib"], after["memory_mib"])}
    return after | {"seconds": before["seconds"] + after["seconds"]} | memory


def settings(name):
    """How the program is called, in a line."""
    if name in OURS:
        return " ".join(["`outsight simplify MESH -o FILE -t COUNT", *map(str, OURS[name]), "--threads 1`"])
    if name in rivals.RIVALS:
        return rivals.RIVALS[name].settings
    return f"`outsight simplify MESH -o FILE -r 1 --threads 1`, then as {AFTER_OURS[name]}"


@functools.cache
def version(name):
    """The version of a program; Outsight's is its own and the last commit of its sources."""
    if name in rivals.RIVALS:
        return rivals.version(rivals.RIVALS[name].package)
    if name in AFTER_OURS:
        return f"{version(AFTER_OURS[name])} after {version('Outsight VG')}"
    commands = [OUTSIGHT, "--version"], ["git", "-C", HERE, "log", "-1", "--format=%h", "--", ":/src", ":/Cargo.lock"]
    return " ".join(subprocess.run(c, check=True, capture_output=True, text=True).stdout.strip() for c in commands)
