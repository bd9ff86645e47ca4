"""Inserted or jammed: the project's contact of a peg and a hole against MuJoCo's, over a grid.

Usage: insertions.py OURS [--processes N] [--every N] [--rounding MM] [--out FILE]
OURS is the program built from crates/sim/examples/insertions.rs. Exits with 1 below the targets.
"""

import argparse
import dataclasses
import functools
import itertools
import json
import math
import multiprocessing
import statistics
import subprocess
import sys
import time

import mujoco_peg

# A peg of 20 mm in a hole with a chamfer of 1 mm, held as in programs/peg_in_hole.toml.
FIXED = {
    "peg_radius_mm": 10.0,
    "hole_chamfer_mm": 1.0,
    "depth_mm": 30.0,
    "axial_n_per_mm": 50.0,
    "lateral_n_per_mm": 8.0,
    "angular_nmm_per_rad": 2000.0 * 180.0 / math.pi,
    "force_limit_n": 20.0,
}
# Clearances are of the radius; directions are those of the offset against the tilt.
FRICTIONS = (0.15, 0.4)
DIRECTIONS_DEG = (0, 90, 180)
CLEARANCES_MM = (0.02, 0.05, 0.1, 0.2)
TILTS_DEG = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0)
OFFSETS_MM = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4)

TARGET_OVERALL, TARGET_AWAY = 0.90, 0.97


def cells():
    """The grid, by index; without an offset there are no directions."""
    axes = (FRICTIONS, DIRECTIONS_DEG, CLEARANCES_MM, TILTS_DEG, OFFSETS_MM)
    grid = itertools.product(*(range(len(axis)) for axis in axes))
    return [cell for cell in grid if not (cell[1] > 0 and OFFSETS_MM[cell[4]] == 0.0)]


def canonical(cell):
    friction, direction, clearance, tilt, offset = cell
    return (friction, 0 if OFFSETS_MM[offset] == 0.0 else direction, clearance, tilt, offset)


def trial(cell, rounding_mm=mujoco_peg.SETTINGS.rounding_mm):
    friction, direction, clearance, tilt, offset = cell
    angle = math.radians(DIRECTIONS_DEG[direction])
    length = OFFSETS_MM[offset]
    return {
        **FIXED,
        "peg_chamfer_mm": mujoco_peg.ROUNDING_AS_CHAMFER * rounding_mm,
        "friction": FRICTIONS[friction],
        "clearance_mm": CLEARANCES_MM[clearance],
        "tilt_rad": math.radians(TILTS_DEG[tilt]),
        "offset_mm": [length * math.cos(angle), length * math.sin(angle)],
    }


def neighbours(cell):
    """One step further in clearance, tilt or offset."""
    for axis, count in ((2, len(CLEARANCES_MM)), (3, len(TILTS_DEG)), (4, len(OFFSETS_MM))):
        for step in (-1, 1):
            index = cell[axis] + step
            if 0 <= index < count:
                yield canonical(cell[:axis] + (index,) + cell[axis + 1:])


def by_ours(program, trials):
    text = "\n".join(json.dumps(trial) for trial in trials) + "\n"
    done = subprocess.run([program], input=text, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def is_away(cell, results):
    """Whether all neighbours end alike, where they were tried."""
    tried = (results.get(near) for near in neighbours(cell))
    return all(near["inserted"] == results[cell]["inserted"] for near in tried if near)


def name(result):
    return "in" if result["inserted"] else "jams"


def report(ours, theirs):
    """Print the tables; whether the targets are met."""
    same = {cell: ours[cell]["inserted"] == theirs[cell]["inserted"] for cell in theirs}
    by_theirs = [cell for cell in theirs if is_away(cell, theirs)]
    by_own = [cell for cell in theirs if is_away(cell, ours)]

    def share(chosen):
        return sum(same[cell] for cell in chosen) / max(len(chosen), 1)

    def row(what, chosen):
        inserted = sum(theirs[cell]["inserted"] for cell in chosen)
        agreed = sum(same[cell] for cell in chosen)
        print(f"| {what} | {len(chosen)} | {inserted} | {agreed} | {100 * share(chosen):.2f} % |")

    print("| cells | count | inserted in MuJoCo | agree | |")
    print("| --- | ---: | ---: | ---: | ---: |")
    row("all", list(theirs))
    row("away from the boundary, MuJoCo's", by_theirs)
    row("away from the boundary, ours", by_own)
    for index, friction in enumerate(FRICTIONS):
        row(f"friction {friction}", [cell for cell in theirs if cell[0] == index])
    for index, clearance in enumerate(CLEARANCES_MM):
        row(f"clearance {clearance} mm", [cell for cell in theirs if cell[2] == index])
    forces = [
        abs(ours[cell]["force_n"] - theirs[cell]["force_n"])
        for cell in theirs
        if ours[cell]["inserted"] and theirs[cell]["inserted"]
    ]
    if forces:
        ninth = sorted(forces)[int(0.9 * (len(forces) - 1))]
        print(f"\nGreatest force, where both go in: differs by {statistics.median(forces):.2f} N "
              f"in the middle, by {ninth:.2f} N at most in nine of ten.")
    differ = sorted(cell for cell in theirs if not same[cell])
    print(f"\n{len(differ)} cells differ.\n")
    if differ:
        print("| friction | clearance | tilt | offset | direction | ours | MuJoCo | away |")
        print("| ---: | ---: | ---: | ---: | ---: | --- | --- | --- |")
    for cell in differ:
        friction, direction, clearance, tilt, offset = cell
        told = [
            f"{name(result)}, {result['force_n']:.1f} N at {result['depth_mm']:.1f} mm"
            for result in (ours[cell], theirs[cell])
        ]
        away = " and ".join(
            who for who, chosen in (("MuJoCo's", by_theirs), ("ours", by_own)) if cell in chosen
        )
        print(f"| {FRICTIONS[friction]} | {CLEARANCES_MM[clearance]} mm | {TILTS_DEG[tilt]} deg | "
              f"{OFFSETS_MM[offset]} mm | {DIRECTIONS_DEG[direction]} deg | {told[0]} | {told[1]} | "
              f"{away} |")
    return share(list(theirs)) >= TARGET_OVERALL and min(
        share(by_theirs), share(by_own)
    ) >= TARGET_AWAY


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ours")
    parser.add_argument("--processes", type=int, default=multiprocessing.cpu_count())
    parser.add_argument("--every", type=int, default=1, help="only every so many cells")
    parser.add_argument("--rounding", type=float, default=mujoco_peg.SETTINGS.rounding_mm,
                        metavar="MM", help="of the edges in MuJoCo")
    parser.add_argument("--out", help="write each cell as a line of JSON")
    arguments = parser.parse_args()
    chosen = cells()[:: arguments.every]
    trials = [trial(cell, arguments.rounding) for cell in chosen]
    settings = dataclasses.replace(mujoco_peg.SETTINGS, rounding_mm=arguments.rounding)
    insert = functools.partial(mujoco_peg.insert, settings=settings)
    began = time.time()
    ours = dict(zip(chosen, by_ours(arguments.ours, trials)))
    with multiprocessing.Pool(arguments.processes) as pool:
        theirs = dict(zip(chosen, pool.map(insert, trials, chunksize=8)))
    print(f"{len(chosen)} insertions in {time.time() - began:.0f} s, "
          f"MuJoCo {mujoco_peg.mujoco.__version__}\n")
    if arguments.out:
        with open(arguments.out, "w", encoding="utf-8") as out:
            for cell, asked in zip(chosen, trials):
                line = {"trial": asked, "ours": ours[cell], "mujoco": theirs[cell]}
                out.write(json.dumps(line) + "\n")
    sys.exit(0 if report(ours, theirs) else 1)


if __name__ == "__main__":
    main()
