#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How do the devices compare at a glance, and how does their cost grow? Turns reports of setka_bench into a chart.

throughput: four panels, triangles a second of the build and rays a second of primary, shadow and diffuse rays, each with a
group of bars for a scene and in it a bar for a device.
growth: nanoseconds of build for each triangle against the number of triangles, for scenes that come in any size.
density: the four rates against the cells of the grid for each triangle; what has no grid is a level line.
Where a device was measured with several shapes of the primitives, those shown are of the first, which is its default."""

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path

sys.dont_write_bytecode = True  # the sources' folder is not the place
from report import BadInput, Row, add_step_option, read_report  # noqa: E402

PANELS = {
    "build": ("Build", "Mtri/s"),
    "primary": ("Primary rays, closest hit", "Mray/s"),
    "shadow": ("Shadow rays, any hit", "Mray/s"),
    "diffuse": ("Diffuse rays, closest hit", "Mray/s"),
}
SIZED = re.compile(r"(?P<family>\w+):\d+(?P<viewpoint>@\w+)?")  # spheres:1000000
LINES = ("-", "--", ":", "-.")
MARKERS = "osD^vXP*"


def series_by_place(rows: list[Row], place: Callable[[Row], tuple]) -> dict[tuple, Row]:
    """The rows by their place in a chart, of which there is one for each."""
    places: dict[tuple, Row] = {}
    for row in rows:
        if places.setdefault(place(row), row) is not row:
            raise BadInput(f"{row.file}: {row.task} of {row.scene} on {row.label}{row.suffix} was measured twice")
    return places


def style_panel(axes, title: str, y_label: str) -> None:
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold")
    axes.set_ylabel(y_label)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="y", color="0.88", linewidth=0.8)
    axes.set_axisbelow(True)


def scale_panel(axes, values: list[float], y_label: str) -> None:
    """Bars and lines on a logarithmic axis say little of ratios, but where some are invisible the others say nothing."""
    if max(values) > 20 * min(values):
        axes.set_yscale("log")
        axes.set_ylim(min(values) / 2, max(values) * 3)
        axes.set_ylabel(f"{y_label}, logarithmic")
    else:
        axes.set_ylim(0, max(values) * 1.15)


def say_not_measured(axes) -> None:
    axes.text(0.5, 0.5, "not measured", transform=axes.transAxes, ha="center", color="0.5")


def draw_bars(axes, values: dict[tuple, float], scenes: list[str], devices: list[str]) -> None:
    width = 0.8 / len(devices)
    for number, device in enumerate(devices):
        for place, scene in enumerate(scenes):
            value = values.get((scene, device))
            if value is None:
                continue
            x = place + (number - (len(devices) - 1) / 2) * width
            axes.bar(x, value, width * 0.92, color=f"C{number}")
            axes.annotate(f"{value:.3g}" if value < 1000 else f"{value:.0f}", (x, value), xytext=(0, 2),
                          textcoords="offset points", ha="center", fontsize=7,
                          rotation=90 if len(devices) * len(scenes) > 36 else 0)


def throughput_chart(pyplot, rows: list[Row]):
    from matplotlib.patches import Patch

    shown = [row for row in rows if row.task in PANELS]
    if not shown:
        raise BadInput(f"{rows[0].file}: no build or trace was measured")
    places = series_by_place(shown, lambda row: (row.task, row.scene, row.label + row.suffix))
    scenes = list(dict.fromkeys(row.scene for row in shown))
    devices = list(dict.fromkeys(row.label + row.suffix for row in shown))
    bars = len(scenes) * len(devices)
    figure, panels = pyplot.subplots(2, 2, figsize=(min(max(9.0, 0.5 * bars + 4), 22), 7.5), sharex=True)
    for axes, (panel, (title, unit)) in zip(panels.flat, PANELS.items()):
        values = {place[1:]: row.value(unit) for place, row in places.items() if place[0] == panel}
        style_panel(axes, title, unit)
        axes.set_xticks(range(len(scenes)), scenes, rotation=20, ha="right", rotation_mode="anchor")
        if values:
            scale_panel(axes, list(values.values()), unit)
            draw_bars(axes, values, scenes, devices)
        else:
            say_not_measured(axes)
    return figure, [Patch(color=f"C{number}", label=device) for number, device in enumerate(devices)]


def growth_chart(pyplot, rows: list[Row]):
    from matplotlib.lines import Line2D

    points: dict[str, dict[str, list[tuple[float, float]]]] = {}
    shown = [(row, SIZED.fullmatch(row.scene)) for row in rows if row.task == "build"]
    series_by_place([row for row, _ in shown], lambda row: (row.scene, row.label + row.suffix))
    for row, sized in shown:
        if sized:
            triangles = row.value("triangles")
            family = sized["family"] + (sized["viewpoint"] or "")
            of_device = points.setdefault(family, {}).setdefault(row.label + row.suffix, [])
            of_device.append((triangles, row.value("wall_ms") * 1e6 / triangles))
    if not any(len(line) > 1 for lines in points.values() for line in lines.values()):
        raise BadInput(f"{rows[0].file}: no build was measured in several sizes, such as spheres:10000 and spheres:100000")
    devices = list(dict.fromkeys(device for lines in points.values() for device in lines))
    figure, panels = pyplot.subplots(1, len(points), figsize=(max(7.0, 5.5 * len(points)), 5), squeeze=False)
    for axes, (family, lines) in zip(panels.flat, points.items()):
        style_panel(axes, family, "build, ns a triangle")
        scale_panel(axes, [y for line in lines.values() for _, y in line], "build, ns a triangle")
        axes.set_xscale("log")
        axes.set_xlabel("triangles")
        for device, line in lines.items():
            axes.plot(*zip(*sorted(line)), color=f"C{devices.index(device)}", marker="o", markersize=4)
    return figure, [Line2D([], [], color=f"C{i}", marker="o", label=device) for i, device in enumerate(devices)]


def density_chart(pyplot, rows: list[Row]):
    from matplotlib.lines import Line2D

    shown = [row for row in rows if row.task in PANELS]
    if len({row.density for row in shown if row.density is not None}) < 2:
        raise BadInput(f"{rows[0].file}: nothing was measured with several densities (setka_bench --density=1,2,4)")
    series_by_place(shown, lambda row: (row.task, row.scene, row.label, row.density))
    scenes = list(dict.fromkeys(row.scene for row in shown))
    devices = list(dict.fromkeys(row.label for row in shown))
    figure, panels = pyplot.subplots(2, 2, figsize=(11, 8), sharex=True)
    for axes, (panel, (title, unit)) in zip(panels.flat, PANELS.items()):
        style_panel(axes, title, unit)
        axes.set_xscale("log", base=2)
        axes.xaxis.set_major_formatter(lambda x, _: f"{x:g}")
        axes.set_xlabel("cells a triangle")
        lines: dict[tuple[str, str], list[tuple[float | None, float]]] = {}
        for row in shown:
            if row.task == panel:
                lines.setdefault((row.scene, row.label), []).append((row.density, row.value(unit)))
        if not lines:
            say_not_measured(axes)
            continue
        scale_panel(axes, [y for line in lines.values() for _, y in line], unit)
        for (scene, device), line in lines.items():
            look = {"color": f"C{scenes.index(scene)}", "linestyle": LINES[devices.index(device) % len(LINES)]}
            if line[0][0] is None:
                axes.axhline(line[0][1], **look)
            else:
                axes.plot(*zip(*sorted(line)), marker=MARKERS[devices.index(device) % len(MARKERS)], markersize=4, **look)
    of_scenes = [Line2D([], [], color=f"C{i}", linewidth=4, label=scene) for i, scene in enumerate(scenes)]
    return figure, of_scenes + [
        Line2D([], [], color="0.3", linestyle=LINES[i % len(LINES)], label=device) for i, device in enumerate(devices)
    ]


CHARTS = {"throughput": throughput_chart, "growth": growth_chart, "density": density_chart}


def draw(chart: str, rows: list[Row], output: Path, title: str) -> None:
    try:
        import matplotlib
    except ImportError as error:
        raise BadInput(f"{error}; on Debian: apt-get install python3-matplotlib, and /usr/bin/python3") from error
    matplotlib.use("agg")
    matplotlib.rcParams["svg.hashsalt"] = "setka"  # the same report gives the same file
    from matplotlib import pyplot

    figure, handles = CHARTS[chart](pyplot, rows)
    columns = min(len(handles), 3)
    height = (-(-len(handles) // columns) * 0.24 + (0.35 if title else 0) + 0.1) / figure.get_figheight()
    figure.tight_layout(rect=(0, 0, 1, 1 - height), h_pad=1.5)
    figure.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1 - height), ncol=columns, frameon=False)
    if title:
        figure.suptitle(title, y=1 - 0.1 / figure.get_figheight(), va="top")
    metadata = {".svg": {"Date": None}, ".png": {"Software": None}}.get(output.suffix.lower())
    try:
        figure.savefig(output, dpi=150, facecolor="white", metadata=metadata)
    except (OSError, ValueError) as error:
        raise BadInput(f"{output}: {error}") from error


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("reports", nargs="+", type=Path, metavar="JSON", help="what --benchmark_out=JSON wrote")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="CHART", help="chart.svg or chart.png")
    parser.add_argument("--chart", choices=CHARTS, default="throughput", help="which one; default: throughput")
    add_step_option(parser)
    parser.add_argument("--title", default="", help="a line above the chart")
    arguments = parser.parse_args()
    try:
        rows = [row for file in arguments.reports for row in read_report(file, arguments.step)]
        if not rows:
            raise BadInput(f"{arguments.reports[0]}: no build or trace was measured")
        draw(arguments.chart, rows, arguments.output, arguments.title)
    except BadInput as error:
        print(f"plot.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
