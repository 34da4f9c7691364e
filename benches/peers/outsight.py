"""The program under test, as every bench here calls it."""

import json
import pathlib
import resource
import subprocess

OUTSIGHT = pathlib.Path(__file__).resolve().parents[2] / "target" / "release" / "outsight"


def outsight(*arguments):
    """Runs the program; returns its JSON object and its processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([OUTSIGHT, *map(str, arguments), "--json", "-q"], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)
