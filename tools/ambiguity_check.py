#!/usr/bin/env python3
"""Whether `mstsl map ambiguity` foretells what robots then meet: buildings are simulated and surveyed, the share of short
drives that will be answered rightly is foretold from the maps alone, and robots drive.

    tools/ambiguity_check.py MSTSL OUT SEED [WORLD...]

Writes OUT/ambiguity.json; docs/results/ambiguity/SEED.json is a copy of one.
"""
import json
import math
import pathlib
import subprocess
import sys

WORLDS = ("symmetric-loop", "aisles", "h-wing", "office")
DRIVE_M, RUNS, NEAR_M = 2.0, 100, 1.5


def run(mstsl, *words):
    subprocess.run([mstsl, *map(str, words), "--quiet"], check=True)


def foretold(mstsl, folder):
    """Places asked about: where, and the share of drives from there that will be answered rightly."""
    run(mstsl, "map", "magnetic", "--map", folder / "map.yaml", "--pose-topic", "/ground_truth", "-o", folder / "field.nc",
        *sorted(folder.glob("survey_*.mcap")))
    run(mstsl, "map", "ambiguity", "--map", folder / "map.yaml", "--field", folder / "field.nc", "--drive", DRIVE_M,
        "-o", folder / "ambiguity.json")
    places = json.loads((folder / "ambiguity.json").read_text())["places"]
    return [(p["x"], p["y"], p["right"] / p["drives"]) for p in places if p["drives"]]


def right_in_time(mstsl, folder, k):
    """Whether the first pose came within the drive and was right."""
    estimates = folder / f"estimates_{k:02}.jsonl"
    subprocess.run([mstsl, "localize", "--map", folder / "map.yaml", "--field", folder / "field.nc", "--method", "joint",
                    "-o", estimates, folder / f"run_{k:02}.mcap", "--quiet"], check=False)  # exit 3: no pose
    done = subprocess.run([mstsl, "evaluate", "--truth", folder / f"truth_{k:02}.csv", estimates, "--json"],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["success"]["hits"] == 1


def start_of(folder, k):
    head, *rows = (folder / f"truth_{k:02}.csv").read_text().splitlines()
    names, first = head.split(","), rows[0].split(",")
    return float(first[names.index("x")]), float(first[names.index("y")])


def check(mstsl, out, seed, world):
    folder = out / world
    run(mstsl, "simulate", "--world", world, "--seed", seed, "--moved", 0, "--people", 0, "--runs", RUNS,
        "--run-length", DRIVE_M, "--scan-hz", 5, "--no-turn-to-wall", "--bias-sigma-uT", 3, "--noise-uT", 0.3, "-o", folder)
    places = foretold(mstsl, folder)
    drives = []
    for k in range(RUNS):
        x, y = start_of(folder, k)
        near = [share for px, py, share in places if math.hypot(px - x, py - y) <= NEAR_M]
        if near:
            drives.append({"foretold": sum(near) / len(near), "right": right_in_time(mstsl, folder, k)})
    return {"world": world, "seed": seed, "drive_m": DRIVE_M, "places": len(places), "drives": drives}


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    mstsl, out, seed = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    found = []
    for world in sys.argv[4:] or WORLDS:
        print(f"== {world}", file=sys.stderr)
        found.append(check(mstsl, out, seed, world))
    (out / "ambiguity.json").write_text(json.dumps(found) + "\n")


if __name__ == "__main__":
    main()
