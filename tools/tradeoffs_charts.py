#!/usr/bin/env python3
"""Draws the charts of docs/tradeoffs.md with matplotlib: tradeoffs_charts.py.

One for each topic, error against the cost on a CPU and on a GPU, one for the README, one of whole
pictures, and one of light culling where it has been measured. The files are the same for the same
numbers: no date, fixed identifiers.
"""
import math
from dataclasses import dataclass

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as pyplot  # noqa: E402  (after the backend is chosen)
from matplotlib import ticker  # noqa: E402

import tradeoffs  # noqa: E402

IMAGES = tradeoffs.ROOT / "docs/images"
RECOMMENDED, OTHER, INK, SOFT = "#0b6e4f", "#7a8699", "#303030", "#8a8a8a"
# Topics of the chart in the README: what a reader meets first.
README_TOPICS = ("normal codec 12 bits", "acos", "FGD", "iridescence", "sRGB encoding",
                 "colour temperature")
CPU = ("ns", "ns a call, CPU loop")
GPU = ("instructions", f"instructions, {tradeoffs.GPU}")
# Parts of the height of a panel below which two labels would touch, and in that of light culling.
LABEL_HEIGHT, CULL_LABEL_HEIGHT = 0.085, 0.05
# Width of a letter of a label: in parts of a figure as wide as FULL_WIDTH inches.
LABEL_WIDTH, FULL_WIDTH = 0.0068, 9.0

matplotlib.rcParams.update({
    "svg.hashsalt": "hdrp", "font.family": "DejaVu Sans", "font.size": 9,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": SOFT,
    "axes.labelcolor": INK, "xtick.color": SOFT, "ytick.color": SOFT, "axes.grid": True,
    "grid.color": "#ececec", "axes.axisbelow": True, "figure.facecolor": "white"})


def points_of(variants, cost):
    """(cost, worst error, variant) of those that have both."""
    return [(float(getattr(v, cost)), float(v.worst), v) for v in variants
            if float(getattr(v, cost) or 0) > 0 and float(v.worst or 0) > 0]


def scatter(axes, variants, cost, label):
    """Worst error over cost, both logarithmic, one named point per variant."""
    points = points_of(variants, cost)
    axes.set(xscale="log", yscale="log", xlabel=label)
    for x, y, variant in points:
        axes.plot(x, y, "o", markersize=7.5 if variant.take else 6,
                  color=RECOMMENDED if variant.take else OTHER)
    # The same for all panels of a topic, whatever costs are known of a variant.
    ys = [float(v.worst) for v in variants if float(v.worst or 0) > 0]
    axes.set_ylim(min(ys) / 2.5, max(ys) * 2.5)
    if points:
        xs = [p[0] for p in points]
        axes.set_xlim(min(xs) / 1.5, max(xs) * (max(xs) / min(xs)) ** 0.5 * 2.0)
        label_points(axes, points)
    axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())


def label_points(axes, points, label_height=LABEL_HEIGHT):
    """Names to the right of their points, moved away where two would touch."""
    to_part = (axes.transScale + axes.transLimits).transform  # of the panel, 0 to 1
    width = LABEL_WIDTH * FULL_WIDTH / axes.get_position().width / axes.figure.get_figwidth()
    taken = [(*to_part((x, y)), 0.0) for x, y, _ in points]
    for x, y, variant in sorted(points, key=lambda p: (-p[1], p[0])):
        left, height = to_part((x, y))
        left += 0.03
        length = width * len(variant.label)

        def touches(at):
            return any(abs(at - other) < label_height and left < right_of and left + length > begin
                       for begin, other, right_of in
                       ((b - 0.01, h, b + max(w, 0.01)) for b, h, w in taken))
        shift = next(s for i in range(40) for s in (i * 0.02, -i * 0.02)
                     if not touches(height + s))
        taken.append((left, height + shift, length))
        axes.annotate(variant.label, (left, height + shift), xycoords="axes fraction", va="center",
                      fontsize=8, color=INK)


def save(figure, name):
    figure.savefig(IMAGES / name, metadata={"Date": None}, bbox_inches="tight")
    pyplot.close(figure)


def draw_topic(topic, variants):
    figure, panels = pyplot.subplots(1, 2, figsize=(9, 2.9), sharey=True)
    for axes, (cost, label) in zip(panels, (CPU, GPU)):
        scatter(axes, variants, cost, label)
    panels[0].set_ylabel(f"worst error, {variants[0].unit}")
    save(figure, f"tradeoffs_{tradeoffs.slug(topic)}.svg")


def draw_overview(topics):
    shown = [topic for topic in README_TOPICS if topic in topics]
    figure, panels = pyplot.subplots(2, 3, figsize=(11, 6))
    for axes, topic in zip(panels.flat, shown):
        scatter(axes, topics[topic], *CPU)
        axes.set_title(f"{tradeoffs.TOPICS[topic][0]}: worst error, {topics[topic][0].unit}",
                       fontsize=9.5, loc="left", color=INK)
    figure.tight_layout()
    save(figure, "tradeoffs.svg")


def draw_pictures(rows):
    """Each feature as a line from off to on, in the scene that needs it."""
    qualities = list(dict.fromkeys(row["quality"] for row in rows))
    figure, panels = pyplot.subplots(1, len(qualities), figsize=(10, 3.6), sharey=True)
    for axes, quality in zip(panels, qualities):
        ends = []
        for feature in dict.fromkeys(row["feature"] for row in rows):
            off, on = changed_pair(rows, quality, feature)
            xs = [float(off["milliseconds"]), float(on["milliseconds"])]
            ys = [float(off["error"]), float(on["error"])]
            axes.plot(xs, ys, "-", color=SOFT, linewidth=1)
            axes.plot(xs[0], ys[0], "o", color=RECOMMENDED, markerfacecolor="white")
            axes.plot(xs[1], ys[1], "o", color=RECOMMENDED)
            beside = sum(abs(math.log(ys[1] / y)) < 0.1 and x > xs[1] / 2 for x, y in ends)
            ends.append((xs[1], ys[1]))
            axes.annotate(f"{feature}, {on['scene']}", (xs[1], ys[1]), xytext=(7, 10 * beside),
                          textcoords="offset points", va="center", fontsize=8, color=INK)
        axes.set_title(f"{quality}: hollow without the feature, filled with it", fontsize=9.5,
                       loc="left", color=INK)
        axes.set_xlabel("ms of the lighting passes")
        axes.margins(x=0.35, y=0.12)
    panels[0].set_ylabel("mean relative error")
    figure.tight_layout()
    save(figure, "tradeoffs_render.svg")


def changed_pair(rows, quality, feature):
    """(row with the feature off, row with it on) of the scene whose picture it changes most."""
    own = [row for row in rows if (row["quality"], row["feature"]) == (quality, feature)]
    pairs = [(off, on) for off in own for on in own
             if off["scene"] == on["scene"] and (off["on"], on["on"]) == ("0", "1")]
    return max(pairs, key=lambda pair: abs(float(pair[0]["error"]) - float(pair[1]["error"])))


@dataclass
class CullPoint:
    """A way to cull."""
    label: str
    ms: float
    visits: float
    take: bool


def cull_points(rows, mix):
    """way -> its point, of those that have both numbers."""
    shown = (tradeoffs.CULL_PICTURE, mix, tradeoffs.CULL_LIGHTS)
    return {row["way"]: CullPoint(row["way"], float(row["build_ms"]),
                                  float(row["visits_over_true"]), row["way"] in tradeoffs.CULL_TAKE)
            for row in rows if (row["picture"], row["mix"], row["lights"]) == shown
            and row["build_ms"] and row["visits_over_true"]}


def round_ticks(axis, firsts):
    """Few numbers, as people write them, on a logarithmic axis: firsts are those from 1 to 10."""
    axis.set_major_locator(ticker.LogLocator(subs=firsts))
    axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axis.set_minor_locator(ticker.NullLocator())


def draw_culling(rows):
    """Lights that pixels visit over the time of lists; a line leads from a way to its fast form."""
    figure, panels = pyplot.subplots(1, 2, figsize=(10, 4.6))
    for axes, mix in zip(panels, ("points", "spots")):
        points = cull_points(rows, mix)
        ms, visits = [p.ms for p in points.values()], [p.visits for p in points.values()]
        axes.set(xscale="log", yscale="log", xlabel="ms to build the lists")
        axes.set_xlim(min(ms) / 1.5, max(ms) * (max(ms) / min(ms)) ** 0.4)
        axes.set_ylim(max(visits) ** -0.06, max(visits) ** 1.06)
        round_ticks(axes.xaxis, (1.0, 2.0, 5.0))
        round_ticks(axes.yaxis, (1.0, 1.5, 2.0, 3.0, 5.0))
        labels = []
        for way, point in points.items():
            if way.endswith(", fast"):
                continue
            fast = points.get(f"{way}, fast", point)
            axes.plot([point.ms, fast.ms], [point.visits, fast.visits], "-", color=SOFT,
                      linewidth=1)
            colour = RECOMMENDED if point.take else OTHER
            axes.plot(fast.ms, fast.visits, "o", color=colour, markerfacecolor="white")
            axes.plot(point.ms, point.visits, "o", color=colour,
                      markersize=7.5 if point.take else 6)
            # Beyond the fast one where that is in the place of the name.
            beside = fast.visits < 1.05 * point.visits
            labels.append((max(point.ms, fast.ms) if beside else point.ms, point.visits, point))
        label_points(axes, labels, CULL_LABEL_HEIGHT)
        axes.set_title(f"{tradeoffs.CULL_LIGHTS} {mix}: hollow with HDRP_CULL_FAST", fontsize=9.5,
                       loc="left", color=INK)
    panels[0].set_ylabel("visited / true: lights of pixels, over those in range")
    figure.tight_layout()
    save(figure, "tradeoffs_culling.svg")


def main():
    data = tradeoffs.Data()
    topics = data.topics()
    for topic, variants in topics.items():
        draw_topic(topic, variants)
    draw_overview(topics)
    if data.features_render:
        draw_pictures(data.features_render)
    if data.cull:
        draw_culling(data.cull)


if __name__ == "__main__":
    main()
