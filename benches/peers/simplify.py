#!/usr/bin/env python3
"""Outsight beside other simplifiers: errors at equal counts, processor seconds and memory, all in one run.

    benches/peers/run simplify MODEL... [--ratios R,R...] [--repeats N] [--output DIR]

Every program is asked for the same count; `outsight compare` judges them all against the original. Programs take turns
within a count, so that what else the machine does falls on all of them. DIR/rivals.json is written after every cell, and
cells that are in it are not computed again unless their program has another version.
"""

import argparse
import datetime
import itertools
import json
import os
import pathlib
import platform
import tempfile

import judge
import ply
import programs
import table
from outsight import outsight

TARGET = pathlib.Path(__file__).resolve().parents[2] / "target"

# Whose pictures are looked at by the second judge too.
JUDGED_TWICE = ["Outsight VG", "MeshLab", "meshoptimizer, update"]


class Contest:
    """One model in a folder of its own, and how the programs fare with it."""

    def __init__(self, model, folder):
        self.source, self.target = folder / "original.ply", folder / "simplified.ply"
        outsight("convert", model, self.source)
        self.facts = {"model": pathlib.Path(model).name.split(".")[0], "of": len(ply.read(self.source)[1])}

    def blank(self, ratio, name):
        """The cell of a program at a ratio, before anything is measured."""
        asked = {"ratio": ratio, "count": round(ratio * self.facts["of"]), "program": name}
        return self.facts | asked | {"ours": name in programs.OURS, "version": programs.version(name)}

    def first(self, cell):
        """The cell filled: what the program took, and what the judges say of its mesh."""
        cell = cell | {"date": datetime.date.today().isoformat(), "machine": machine()}
        cell["judge"] = programs.version("Outsight VG")
        self.target.unlink(missing_ok=True)
        try:
            took = programs.run(cell["program"], self.source, self.target, cell["count"])
        except Exception as error:  # a rival that fails is part of the record
            return cell | {"failed": str(error)}
        cell |= took | {"seconds": [took["seconds"]]} | judge.errors(self.source, self.target)
        if cell["program"] in JUDGED_TWICE:
            cell["second_image_rmse"] = judge.second_image_rmse(self.source, self.target)
        return cell

    def again(self, cell):
        """The cell with the seconds of one more run."""
        took = programs.run(cell["program"], self.source, self.target, cell["count"])
        return cell | {"seconds": [*cell["seconds"], took["seconds"]]}


class Record:
    """The cells measured so far, in DIR/rivals.json, and as tables in DIR/rivals.md."""

    # What stands above this line in rivals.md was written by people and stays.
    MARK = "<!-- Below: written by benches/peers/run simplify -->"

    def __init__(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        self.json, self.markdown = folder / "rivals.json", folder / "rivals.md"
        cells = json.loads(self.json.read_text())["cells"] if self.json.exists() else []
        self.cells = {self.key(cell): cell for cell in cells}

    @staticmethod
    def key(cell):
        return cell["model"], cell["ratio"], cell["program"]

    def keep(self, cell):
        """Adds the cell and writes both files, each whole or not at all."""
        self.cells[self.key(cell)] = cell
        self.write()

    def write(self):
        """Writes both files anew."""
        models = list(dict.fromkeys(cell["model"] for cell in self.cells.values()))
        order = lambda cell: (models.index(cell["model"]), -cell["ratio"], programs.PROGRAMS.index(cell["program"]))
        cells = sorted(self.cells.values(), key=order)
        replace(self.json, json.dumps({"samples": judge.SAMPLES, "cells": cells}, indent=1) + "\n")
        above = self.markdown.read_text().split(self.MARK)[0] if self.markdown.exists() else "# Beside the rivals\n\n"
        settings = {name: programs.settings(name) for name in programs.PROGRAMS}
        replace(self.markdown, above + self.MARK + "\n\n" + table.page(cells, settings, judge.SAMPLES))


def replace(path, text):
    """Puts `text` in the place of what was there, or changes nothing."""
    beside = path.with_suffix(".part")
    beside.write_text(text)
    beside.replace(path)


def machine():
    """Name of the processor, and of the system."""
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return f"{model[0] if model else platform.machine()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}"


def study(contest, options, record):
    """Fills the cells of one model, the programs taking turns."""
    for ratio, repeat, name in itertools.product(options.ratios, range(options.repeats), programs.PROGRAMS):
        blank = contest.blank(ratio, name)
        earlier = record.cells.get(Record.key(blank))
        if not earlier or earlier["version"] != blank["version"]:
            cell = contest.first(blank)
        elif "failed" in earlier or len(earlier["seconds"]) > repeat:
            continue
        else:
            cell = contest.again(earlier)
        record.keep(cell)
        print(table.rows([cell]).splitlines()[-1].replace("*", ""), flush=True)


def main():
    parser = argparse.ArgumentParser(prog="benches/peers/run simplify")
    parser.add_argument("models", nargs="+", metavar="MODEL")
    parser.add_argument("--ratios", default=[0.2, 0.05, 0.005], type=lambda text: [float(r) for r in text.split(",")])
    parser.add_argument("--repeats", default=1, type=int, help="runs of each, of whose seconds the least counts")
    parser.add_argument("--output", default=TARGET / "rivals", type=pathlib.Path, metavar="DIR")
    options = parser.parse_args()
    record = Record(options.output)
    for model in options.models:
        with tempfile.TemporaryDirectory() as folder:
            study(Contest(model, pathlib.Path(folder)), options, record)
    record.write()
    print(record.markdown)


if __name__ == "__main__":
    main()
