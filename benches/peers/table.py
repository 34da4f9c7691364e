"""The table: which rows count, which is best, and how it reads as Markdown. Plain Python, so that ./test can check it.

A cell is one program at one ratio of one model, a dict with at least `model`, `ratio`, `count`, `program` and `ours`; then
either `failed`, or `triangles`, `seconds` and the errors.
"""

from itertools import groupby

# A program that keeps more than this share above the count has stopped early, and wins nothing by it.
EXCESS = 0.01
# One that goes farther below has done something else; a few collapses that take more at once are no matter.
SHORTFALL = 0.1

# Key in a cell, heading, digits; of each the least is the best.
MEASURES = [
    ("image_rmse", "image RMSE", 2),
    ("silhouette_xor", "silhouette px", 1),
    ("geometric_mean", "distance mean %", 4),
    ("geometric_rms", "distance RMS %", 4),
    ("cpu_s", "CPU s", 2),
    ("memory_mib", "MiB", 0),
]


def reached(cell):
    """Whether the cell may be compared with others of its count."""
    return "failed" not in cell and not mark(cell)


def mark(cell):
    """What stands beside a count that is not the one asked for: ↑ above it, ↓ below; empty near it."""
    share = cell["triangles"] / cell["count"]
    return " ↑" if share > 1 + EXCESS else " ↓" if share < 1 - SHORTFALL else ""


def value(cell, key):
    return min(cell["seconds"]) if key == "cpu_s" else cell[key]


def best(cells, key):
    """The cell with the least of `key` among those that reached the count; `None` if none did."""
    return min(filter(reached, cells), key=lambda cell: value(cell, key), default=None)


def groups(cells):
    """The cells by model and ratio, as (model, count, list), in the order given."""
    key = lambda cell: (cell["model"], cell["ratio"])
    return [(*group[:1], cells[0]["count"], cells) for group, of in groupby(cells, key) if (cells := list(of))]


def summary(cells):
    """A line per model and count: Outsight's default against the best of the rivals."""
    lines = [
        "model | triangles | best rival by image | RMSE | Outsight VG | less error | best rival's silhouette | Outsight VG",
        "--- | ---: | --- | ---: | ---: | ---: | ---: | ---:",
    ]
    for model, count, group in groups(cells):
        rivals = [cell for cell in group if not cell["ours"]]
        ours = next((cell for cell in group if cell["program"] == "Outsight VG" and reached(cell)), None)
        rival, outline = best(rivals, "image_rmse"), best(rivals, "silhouette_xor")
        if ours and rival:
            less = 100 * (1 - ours["image_rmse"] / rival["image_rmse"])
            lines.append(
                f"{model} | {count:,} | {rival['program']} | {rival['image_rmse']:.2f} | {ours['image_rmse']:.2f} | "
                f"{less:+.1f} % | {outline['silhouette_xor']:.1f} | {ours['silhouette_xor']:.1f}"
            )
    return "\n".join(lines)


def rows(cells):
    """Every cell; the best of each measure at each count in bold, a program that missed the count marked."""
    headings = ["model", "asked", "program", "triangles", *(heading for _, heading, _ in MEASURES)]
    lines = [" | ".join(headings), "--- | ---: | --- | ---:" + " | ---:" * len(MEASURES)]
    for model, count, group in groups(cells):
        winners = {key: best(group, key) for key, _, _ in MEASURES}
        for cell in group:
            start = f"{model} | {count:,} | {cell['program']} | "
            if "failed" in cell:
                lines.append(start + "failed: " + cell["failed"].replace("|", "/") + " |" * len(MEASURES))
                continue
            shown = [f"{cell['triangles']:,}{mark(cell)}"]
            for key, _, digits in MEASURES:
                text = f"{value(cell, key):.{digits}f}"
                shown.append(f"**{text}**" if winners[key] is cell else text)
            lines.append(start + " | ".join(shown))
    return "\n".join(lines)


def second_judge(cells):
    """What the second judge says of the first: how many cells, and the largest relative difference."""
    twice = [cell for cell in cells if cell.get("second_image_rmse")]
    if not twice:
        return "The second judge saw no cell."
    difference = lambda cell: abs(cell["image_rmse"] / cell["second_image_rmse"] - 1)
    worst = max(twice, key=difference)
    return (
        f"The second judge saw {len(twice)} cells; its image RMSE differs by {100 * difference(worst):.4f} % at most "
        f"({worst['model']}, {worst['program']}, {worst['count']:,} triangles)."
    )


def page(cells, settings, samples):
    """Everything as Markdown: the tables, and how they came about. `settings` says how each program is called."""
    size = {cell["model"]: cell["of"] for cell in cells}
    commands = {}
    for model in size:
        ratios = sorted({cell["ratio"] for cell in cells if cell["model"] == model}, reverse=True)
        commands.setdefault(",".join(map(str, ratios)), []).append(f"{model}.ply.zst")
    facts = {fact: sorted({cell[fact] for cell in cells}) for fact in ("date", "machine", "version", "judge")}
    return "\n".join([
        "## Outsight's default against the best rival\n", summary(cells), "", second_judge(cells), "",
        "## All programs\n", HOW.format(excess=EXCESS, shortfall=SHORTFALL, samples=samples), "", rows(cells), "",
        "## Made with\n",
        *(f"    benches/peers/run simplify --ratios {ratios} {' '.join(models)}" for ratios, models in commands.items()), "",
        "* Models: " + ", ".join(f"{model} {of:,} triangles" for model, of in size.items()),
        *(f"* {fact.capitalize()}: {'; '.join(found)}" for fact, found in facts.items()), "",
        "program | called as", "--- | ---", *(f"{name} | {how}" for name, how in settings.items()), "",
    ])


HOW = """\
Bold: the best of its column among those that reached the count. ↑: stopped more than {excess:.0%} above it; ↓: went more
than {shortfall:.0%} below it; compared with nobody. Image RMSE in grey levels and silhouette in pixels that differ, both over 20 views of 512² pixels. Distance between
the surfaces in % of the diagonal, the worse way, {samples:,} points each; hidden surface counts like any other. CPU s:
processor time on one thread, without reading and writing, the least of the repeats; the machine is shared, so compare
only within a count. MiB: for a rival what its work takes above its libraries and the mesh, for Outsight the whole
process."""
