#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How do the devices compare at a glance? Turns reports of setka_bench into a chart.

Four panels: triangles a second of the build, and rays a second of primary, shadow and diffuse rays. Each has a group of
bars for a scene and in it a bar for a device. Where a device was measured with several shapes of the primitives, the
build shown is the one with the first, which is the device's default."""

import argparse
import json
import re
import statistics
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from pathlib import Path

PANELS = {
    "build": ("Build", "Mtri/s"),
    "primary": ("Primary rays, closest hit", "Mray/s"),
    "shadow": ("Shadow rays, any hit", "Mray/s"),
    "diffuse": ("Diffuse rays, closest hit", "Mray/s"),
}
NAME = re.compile(
    r"(?:build/(?P<build_device>[a-z]+:\d+)/(?P<shape>\w+)"
    r"|trace/(?P<kind>[\w-]+)/(?P<step>[\w-]+)/(?P<device>[a-z]+:\d+))/(?P<scene>.+)/manual_time"
)


class BadInput(Exception):
    """A report that cannot be used; the message names the file."""


@dataclass
class Results:
    """Throughputs by panel, scene and device, each scene and device in the order it was met in."""

    values: dict[tuple[str, str, str], float] = field(default_factory=dict)
    scenes: dict[str, None] = field(default_factory=dict)
    devices: dict[str, None] = field(default_factory=dict)

    def add(self, file: Path, panel: str, scene: str, device: str, value: float) -> None:
        if (panel, scene, device) in self.values:
            raise BadInput(f"{file}: {panel} of {scene} on {device} was measured twice")
        self.values[panel, scene, device] = value
        self.scenes[scene] = None
        self.devices[device] = None


def device_labels(context: dict[str, str]) -> dict[str, str]:
    """What the legend calls each device id of a report: its name and API, and the id where that is not enough."""
    labels = {}
    for key, name in context.items():
        if key.startswith("device "):
            identity = key.removeprefix("device ")
            api = {"cuda": "CUDA", "opencl": "OpenCL"}.get(identity.split(":")[0], identity.split(":")[0])
            labels[identity] = f"{name}, {api}"
    count = Counter(labels.values())
    return {identity: f"{label} ({identity})" if count[label] > 1 else label for identity, label in labels.items()}


def throughput(rows: list[dict], unit: str) -> float:
    """The median of the repetitions: the report's own where it holds aggregates only."""
    own = [row for row in rows if row.get("aggregate_name") == "median"]
    return statistics.median(row[unit] for row in (own or rows))


def read_report(file: Path, step: str, results: Results) -> None:
    try:
        report = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{file}: {error.strerror}") from error
    except ValueError as error:
        raise BadInput(f"{file}: not JSON, perhaps of a run that was stopped: {error}") from error
    try:
        labels = device_labels(report["context"])
        repetitions = defaultdict(list)
        for row in report["benchmarks"]:
            if row.get("error_occurred"):
                print(f"plot.py: {file}: {row['name']} was skipped: {row['error_message']}", file=sys.stderr)
            else:
                repetitions[row["run_name"]].append(row)
        shapes: dict[str, str] = {}
        for name, rows in repetitions.items():
            match = NAME.fullmatch(name)
            if match is None:
                continue
            panel = match["kind"] or "build"
            device = match["build_device"] or match["device"]
            if match["kind"]:
                is_shown = match["step"] == step
            else:
                is_shown = match["shape"] == shapes.setdefault(device, match["shape"])
            if panel in PANELS and is_shown:
                results.add(file, panel, match["scene"], labels[device], throughput(rows, PANELS[panel][1]))
    except (KeyError, TypeError, AttributeError) as error:
        raise BadInput(f"{file}: not a report of setka_bench: {error!r}") from error


def draw_panel(axes, results: Results, panel: str) -> None:
    title, unit = PANELS[panel]
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold")
    axes.set_ylabel(unit)
    axes.set_xticks(range(len(results.scenes)), list(results.scenes), rotation=20, ha="right", rotation_mode="anchor")
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="y", color="0.88", linewidth=0.8)
    axes.set_axisbelow(True)
    shown = [value for (of_panel, _, _), value in results.values.items() if of_panel == panel]
    if not shown:
        axes.text(0.5, 0.5, "not measured", transform=axes.transAxes, ha="center", color="0.5")
        return
    # Bars on a logarithmic axis say little of ratios, but where some are invisible the others say nothing.
    is_log = max(shown) > 20 * min(shown)
    if is_log:
        axes.set_yscale("log")
        axes.set_ylim(min(shown) / 2, max(shown) * 3)
        axes.set_ylabel(f"{unit}, logarithmic")
    else:
        axes.set_ylim(0, max(shown) * 1.15)
    width = 0.8 / len(results.devices)
    for number, device in enumerate(results.devices):
        for place, scene in enumerate(results.scenes):
            value = results.values.get((panel, scene, device))
            if value is None:
                continue
            x = place + (number - (len(results.devices) - 1) / 2) * width
            axes.bar(x, value, width * 0.92, color=f"C{number}")
            axes.annotate(f"{value:.3g}" if value < 1000 else f"{value:.0f}", (x, value), xytext=(0, 2),
                          textcoords="offset points", ha="center", fontsize=7,
                          rotation=90 if len(results.devices) * len(results.scenes) > 36 else 0)


def draw(results: Results, output: Path, title: str) -> None:
    try:
        import matplotlib
    except ImportError as error:
        raise BadInput(f"{error}; on Debian: apt-get install python3-matplotlib, and /usr/bin/python3") from error
    matplotlib.use("agg")
    matplotlib.rcParams["svg.hashsalt"] = "setka"  # the same report gives the same file
    from matplotlib import pyplot
    from matplotlib.patches import Patch

    bars = len(results.scenes) * len(results.devices)
    figure, panels = pyplot.subplots(2, 2, figsize=(min(max(9.0, 0.5 * bars + 4), 22), 7.5), sharex=True)
    for axes, panel in zip(panels.flat, PANELS):
        draw_panel(axes, results, panel)
    handles = [Patch(color=f"C{number}", label=device) for number, device in enumerate(results.devices)]
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
    parser.add_argument("--step", choices=("dda", "branch-free"), default="dda", help="stepping rule shown; default: dda")
    parser.add_argument("--title", default="", help="a line above the chart")
    arguments = parser.parse_args()
    results = Results()
    try:
        for file in arguments.reports:
            read_report(file, arguments.step, results)
        if not results.values:
            raise BadInput(f"{arguments.reports[0]}: no build or trace was measured")
        draw(results, arguments.output, arguments.title)
    except BadInput as error:
        print(f"plot.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
