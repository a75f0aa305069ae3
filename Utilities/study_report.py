# SPDX-License-Identifier: BSD-3-Clause
"""Tables and plots of a study, laid out as the paper's, with the paper's numbers beside ours."""

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (needs the back end)
from matplotlib.ticker import MaxNLocator  # noqa: E402

import Models  # noqa: E402
import study_paper as paper  # noqa: E402
import study_scaling as scaling  # noqa: E402
import study_timing as timing  # noqa: E402
from study_records import Series, last_valid  # noqa: E402
from study_series import METHODS  # noqa: E402

#: Told apart by color and by marker.
STYLES = dict(zip(METHODS, (("#7f7f7f", "v"), ("#e69f00", "s"), ("#0072b2", "o"), ("#56b4e9", "D"),
                            ("#009e73", "^"), ("#cc79a7", "x"), ("#000000", "P"),
                            ("#d55e00", "*"))))

LEGEND = ("The minimum scaled Jacobian at S_F. In parentheses: inverted cells of the method's own "
          "+ those that the boundary inverts, at a folded face or a corner. t* is the t of the "
          "last step up to which no cell of the method's own is inverted, if a series ended by "
          "one. results.csv has all steps, also with the paper's surfaces.")

SECONDS = ("## Seconds per step\n\n"
           "Relative: the first of 20 steps, prepare and evaluate, since each step prepares again. "
           "Absolute: evaluate at S_F, and in brackets prepare, once for all steps. Exact "
           "surfaces.")


def write_report(folder, records, steps):
    """Writes Results.md and figure-*.png to the folder, as far as there are results.

    `steps`: to S_F."""
    text = ["# Results", "", LEGEND, ""]
    for surfaces in sorted({series.surfaces for series in records.series()}):
        found = [series for series in records.series() if series.surfaces == surfaces]
        for model in [name for name in Models.NAMES + Models.VARIANTS
                      if any(series.model == name for series in found)]:
            picture = folder / f"figure-{model}-{surfaces.replace(' ', '-')}.png"
            _draw_quality(picture, records, model, surfaces, steps)
            text += _quality_table(records, model, surfaces, steps, picture.name)
    if (folder / "timing.csv").is_file():
        timings = timing.read(folder / "timing.csv")
        text += [SECONDS, ""]
        for model in [name for name in paper.TABLES if any(key[0] == name for key in timings)]:
            text += _seconds_table(timings, model)
    if (folder / "scaling.csv").is_file():
        text += _scaling_table(folder, scaling.read(folder / "scaling.csv"))
    (folder / "Results.md").write_text("\n".join(text) + "\n", encoding="utf-8")


def _table(head, rows):
    def line(cells):
        return "| " + " | ".join(cells) + " |"
    return [line(head), "|" + "---|" * len(head)] + [line(row) for row in rows] + [""]


def _methods(records, model, surfaces):
    return [method for method in METHODS
            if any(records.steps(Series(model, *panel_series, method))
                   for panel_series in _panel_series(surfaces))]


def _panel_series(surfaces):
    """(kind, surfaces, stepping) of each panel."""
    return [(kind, surfaces, stepping) for kind, stepping in paper.PANELS]


def _quality_table(records, model, surfaces, steps, picture):
    figure = f" (the paper's Figure {paper.FIGURES[model]})" if model in paper.FIGURES else ""
    rows = []
    for method in _methods(records, model, surfaces) if surfaces == "exact" else []:
        rows.append([method] + [_quality_cell(records.steps(Series(model, *key, method)), steps)
                                for key in _panel_series(surfaces)])
    head = ["method"] + [f"{kind} {stepping}" for kind, stepping in paper.PANELS]
    return ([f"## {model.capitalize()}, {surfaces} surfaces{figure}", "",
             f"![Minimum scaled Jacobian, step by step]({picture})", ""]
            + (_table(head, rows) if rows else []))


def _quality_cell(steps, to_final):
    if len(steps) <= to_final:
        return "not run" if not steps else f"ended at step {len(steps) - 1}"
    survived = "" if all(step.valid for step in steps) else f"; t* {_survived(steps)}"
    return _minimum(steps[to_final]) + survived


def _minimum(step):
    parts = [step.own] + [count for count in (step.boundary + step.folded,) if count]
    count = f" ({' + '.join(f'{part:,}' for part in parts)})" if step.inverted else ""
    return f"{step.minimum:.3f}{count}"


def _survived(steps):
    """t*, as a text."""
    last = last_valid(steps)
    return "none" if last is None else f"{last:.2f}"


def _draw_quality(path, records, model, surfaces, steps):
    figure, axes = pyplot.subplots(2, 2, figsize=(11, 8), sharex=True, sharey="row")
    for axis, key, letter in zip(axes.flat, _panel_series(surfaces), "abcd"):
        for method in METHODS:
            found = records.steps(Series(model, *key, method))[:steps + 1]
            if found:
                color, marker = STYLES[method]
                axis.plot([step.step for step in found], [step.minimum for step in found],
                          color=color, marker=marker, markersize=4, linewidth=1.2, label=method)
        if not axis.lines:
            axis.text(0.5, 0.5, "not run", transform=axis.transAxes, ha="center", color="gray")
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        axis.axhline(0, color="black", linewidth=0.6)
        axis.set_title(f"({letter}) {key[0]} mesh, {key[2]} morph")
        axis.set_xlabel("step")
        axis.set_ylabel("minimum scaled Jacobian")
    for row in axes:  # both share it
        low, high = row[0].get_ylim()
        row[0].set_ylim(min(low, -0.02), max(high, 0.02))
    handles, labels = max((axis.get_legend_handles_labels() for axis in axes.flat),
                          key=lambda found: len(found[0]))
    figure.legend(handles, labels, loc="lower center", ncol=4, frameon=False)
    figure.suptitle(f"{model.capitalize()}, {surfaces} surfaces")
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    figure.savefig(path, dpi=100)
    pyplot.close(figure)


def _seconds_table(timings, model):
    """Of the model's timings, as study_timing.read() gives them."""
    mine = {key[1:]: value for key, value in timings.items() if key[0] == model}
    rows = []
    for method in METHODS:
        row = [method]
        for kind, stepping in paper.PANELS:
            theirs = paper.seconds(model, method, kind, stepping)
            row.append(f"{_seconds_cell(mine.get((kind, stepping, method)), stepping)};"
                       f" {'-' if theirs is None else f'{theirs:.2f}'}")
        rows.append(row)
    head = ["method"] + [f"{kind} {stepping}: ours; paper" for kind, stepping in paper.PANELS]
    runs, threads = (" or ".join(sorted({value[k] for value in mine.values()})) for k in (2, 3))
    return ([f"### {model.capitalize()} (the paper's Table {paper.TABLES[model]})", "",
             f"Runs, of which these are medians: {runs}. Threads: {threads}.", ""]
            + _table(head, rows))


def _seconds_cell(timing, stepping):
    if timing is None:
        return "not run"
    prepare, evaluate = timing[:2]
    return (f"{prepare + evaluate:.3f}" if stepping == "relative"
            else f"{evaluate:.3f} ({prepare:.3f})")


def _scaling_table(folder, rows):
    runs, threads = (" or ".join(sorted({row[field] for row in rows}))
                     for field in ("runs", "threads"))
    text = ["## Time against size (the paper's Section 4.5 and Figure 10)", "",
            "Bricks of N x 20 x 20 hexahedra. The power of the number of nodes that prepare and "
            "evaluate together, and evaluate alone, grow with over N = 60 and more, and seconds of "
            "both at the largest N. "
            f"Runs, of which these are medians: {runs}. Threads: {threads}.", ""]
    table = []
    figure, axes = pyplot.subplots(1, 2, figsize=(11, 4.5), sharey=True)
    for axis, motion in zip(axes, scaling.MOTIONS):
        for method in METHODS:
            found = sorted((int(row["nodes"]), float(row["prepare"]), float(row["evaluate"]))
                           for row in rows if row["motion"] == motion and row["method"] == method)
            if not found:
                continue
            nodes, prepare, evaluate = zip(*found)
            whole = [p + e for p, e in zip(prepare, evaluate)]
            color, marker = STYLES[method]
            axis.loglog(nodes, whole, color=color, marker=marker, markersize=4, label=method)
            powers = [scaling.exponent(nodes, values) for values in (whole, evaluate)]
            table.append([motion, method, f"{nodes[-1]:,}"]
                         + ["-" if power is None else f"{power:.2f}" for power in powers]
                         + [f"{whole[-1]:.3f}"])
        axis.set_title(motion)
        axis.set_xlabel("nodes")
    axes[0].set_ylabel("seconds, prepare and evaluate")
    axes[0].legend(fontsize=8, frameon=False)
    figure.tight_layout()
    figure.savefig(folder / "figure-scaling.png", dpi=100)
    pyplot.close(figure)
    head = ["motion", "method", "nodes", "power", "power of evaluate", "seconds"]
    return text + ["![Seconds against nodes](figure-scaling.png)", ""] + _table(head, table)
