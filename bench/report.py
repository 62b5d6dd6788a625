# SPDX-License-Identifier: MIT
"""What does a report of setka_bench hold? Its rows, each with the medians over the repetitions, as plot.py and ratios.py
read them."""

import json
import re
import statistics
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path

NAME = re.compile(
    r"(?:(?P<whole>build|frame)/(?:(?P<device>[a-z]+:\d+)/(?P<shape>\w+)|embree/(?P<quality>\w+))"
    r"|trace/(?P<kind>[\w-]+)/(?P<step>[\w-]+)/(?P<traced_on>[a-z]+:\d+|embree-\w+))"
    r"/(?P<scene>.+?)(?:/density:(?P<density>[^/]+))?/manual_time"
)


class BadInput(Exception):
    """A report that cannot be used; the message names the file."""


@dataclass(frozen=True)
class Row:
    """One benchmark of a scene."""

    file: Path
    task: str  # build, frame, or the kind of rays
    scene: str
    device: str  # opencl:0, embree-low
    label: str  # what a legend calls the device
    density: float | None  # of the grid; None for what has none
    is_of_several: bool  # whether the name says the density
    runs: tuple[dict, ...]

    @property
    def suffix(self) -> str:
        """What tells the row of a device from that at another density."""
        return f", density {self.density:g}" if self.is_of_several else ""

    def value(self, counter: str) -> float:
        """The median of the repetitions: the report's own where it holds aggregates only."""
        own = [run for run in self.runs if run.get("aggregate_name") == "median"]
        try:
            return statistics.median(run[counter] for run in (own or self.runs))
        except (KeyError, TypeError) as error:
            raise BadInput(f"{self.file}: {self.task} of {self.scene} on {self.device} has no {counter}") from error


def device_labels(context: dict[str, str]) -> dict[str, str]:
    """What a legend calls each device id of a report: its name and API, and the id where that is not enough."""
    labels = {}
    for key, name in context.items():
        if key.startswith("device "):
            identity = key.removeprefix("device ")
            api = {"cuda": ", CUDA", "opencl": ", OpenCL"}.get(identity.split(":")[0], "")
            labels[identity] = name + api
    count = Counter(labels.values())
    return {identity: f"{label} ({identity})" if count[label] > 1 else label for identity, label in labels.items()}


def read_json(file: Path) -> dict:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{file}: {error.strerror}") from error
    except ValueError as error:
        raise BadInput(f"{file}: not JSON, perhaps of a run that was stopped: {error}") from error


def rows_of(file: Path, report: dict, step: str) -> list[Row]:
    labels = device_labels(report["context"])
    repetitions = defaultdict(list)
    for run in report["benchmarks"]:
        if run.get("error_occurred"):
            print(f"{Path(sys.argv[0]).name}: {file}: {run['name']} was skipped: {run['error_message']}", file=sys.stderr)
        else:
            repetitions[run["run_name"]].append(run)
    matches = {name: match for name in repetitions if (match := NAME.fullmatch(name))}
    shapes: dict[str, str] = {}
    rows = []
    for name, match in matches.items():
        device = match["device"] or match["traced_on"] or f"embree-{match['quality']}"
        is_embree = device.startswith("embree-")
        if match["shape"] and match["shape"] != shapes.setdefault(device, match["shape"]):
            continue
        if match["step"] and match["step"] != step and not is_embree:
            continue
        density = None if is_embree else float(match["density"] or report["context"]["density"])
        task, is_of_several = match["whole"] or match["kind"], match["density"] is not None
        runs = tuple(repetitions[name])
        rows.append(Row(file, task, match["scene"], device, labels[device], density, is_of_several, runs))
    return rows


def read_report(file: Path, step: str) -> list[Row]:
    """The rows of builds, frames and rays, in the report's order. Of a device that was measured with several shapes of the
    primitives, those with the first, which is its default; of the rules by which setka's rays step, the one named."""
    try:
        return rows_of(file, read_json(file), step)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise BadInput(f"{file}: not a report of setka_bench: {error!r}") from error


def add_step_option(parser) -> None:
    parser.add_argument("--step", choices=("dda", "branch-free"), default="dda", help="stepping rule shown; default: dda")
