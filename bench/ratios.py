#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Who is how many times as fast as Embree? Prints reports of setka_bench as tables in Markdown.

Each report is one run and becomes one table, since only rates of one run can be compared. The baseline's row holds its
rates; those of the others hold how many times as fast they are. Bytes are for each triangle: what is kept, and what a build
needs for a time besides."""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # the sources' folder is not the place
from report import BadInput, Row, add_step_option, read_report  # noqa: E402

RATES = {"build": "Mtri/s", "frame": "frame/s", "primary": "Mray/s", "shadow": "Mray/s", "diffuse": "Mray/s"}
BYTES = {"tables, B/tri": "table_bytes_per_triangle", "scratch, B/tri": "peak_scratch_bytes_per_triangle"}


def number(value: float) -> str:
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def cells_of(rows: dict[str, Row], baseline: dict[str, Row] | None) -> list[str]:
    """The cells of a device by task: ratios to the baseline's rates, or rates if it is the baseline."""
    cells = []
    for task, unit in RATES.items():
        if task not in rows:
            cells.append("–")
        elif baseline is None:
            cells.append(f"{number(rows[task].value(unit))} {unit}")
        elif task not in baseline:
            cells.append("–")
        else:
            cells.append(f"{rows[task].value(unit) / baseline[task].value(unit):.2f}")
    for counter in BYTES.values():
        cells.append(number(rows["build"].value(counter)) if "build" in rows else "–")
    return cells


def rows_by_device(rows: list[Row]) -> dict[str, dict[tuple[str, str], dict[str, Row]]]:
    """Rows by scene, by device with its density, and by task."""
    tables: dict[str, dict[tuple[str, str], dict[str, Row]]] = {}
    for row in rows:
        tasks = tables.setdefault(row.scene, {}).setdefault((row.device, row.suffix), {})
        if row.task in tasks:
            raise BadInput(f"{row.file}: {row.task} of {row.scene} on {row.device} was measured twice")
        tasks[row.task] = row
    return tables


def print_table(file: Path, rows: list[Row], baseline: str) -> None:
    if not any(row.device == baseline for row in rows):
        known = ", ".join(dict.fromkeys(row.device for row in rows)) or "nothing"
        raise BadInput(f"{file}: {baseline} was not measured; measured: {known}")
    if any(row.device == baseline and row.is_of_several for row in rows):
        raise BadInput(f"{file}: {baseline} was measured with several densities, and a baseline has one")
    print(f"{file.name}: rates as multiples of {baseline}'s\n")
    print(line(["scene", "device", *RATES, *BYTES]))
    print(line(["---", "---", *["---:"] * (len(RATES) + len(BYTES))]))
    for scene, devices in rows_by_device(rows).items():
        base = devices.get((baseline, ""), {})
        if base:
            print(line([scene, baseline, *cells_of(base, None)]))
        for (device, suffix), tasks in devices.items():
            if device != baseline:
                print(line([scene, device + suffix, *cells_of(tasks, base)]))
    labels = {row.device: row.label for row in rows}
    print("\n" + "; ".join(f"{device}: {label}" for device, label in labels.items()) + "\n")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("reports", nargs="+", type=Path, metavar="JSON", help="what --benchmark_out=JSON wrote")
    parser.add_argument("--baseline", default="embree-low", metavar="DEVICE", help="opencl:0, …; default: embree-low")
    add_step_option(parser)
    arguments = parser.parse_args()
    try:
        for file in arguments.reports:
            print_table(file, read_report(file, arguments.step), arguments.baseline)
    except BadInput as error:
        print(f"ratios.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
