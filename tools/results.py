#!/usr/bin/env python3
"""Writes the tables of docs/results.md and docs/mapping.md from the reports kept under docs/results/.

    tools/results.py           write them
    tools/results.py --check   exit 1 if they are not what the reports say

A table stands between the lines "<!-- table NAME -->" and "<!-- end -->". Reports are those of `mstsl bench --protocol
paper` (paper/WORLD_SEED.json, limits/WORLD_CURVE_POINT.json), of `mstsl bench --protocol real` (real.json, as
real/METHOD_SEED.json), of
tools/real_field.sh (field/real.json) and of `mstsl bench --protocol hard` (results_SET.json, as hard/METHOD_SEED.json, with cost_SET.json as hard_cost/SEED.json, and for
several methods on the same events baselines/SEED.json, those of an ordinary building ordinary/SEED.json, without a magnetometer no_magnetometer/SEED.json); mapping/: mapping_SEED.json of `mstsl bench --protocol mapping` and
real.json of tools/real_mapping.sh, mrpt.json of bench/mrpt_slam.sh; update/SEED.json of tools/map_update.sh; positions/SEED.json of tools/survey_positions.sh;
ambiguity/SEED.json of tools/ambiguity_check.py.
"""
import json
import math
import pathlib
import re
import sys

import standing

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"
MODELS = ("gpr", "bilinear", "fingerprint")


def reports(folder):
    return {path.stem: json.loads(path.read_text()) for path in sorted((DOCS / "results" / folder).glob("*.json"))}


def wilson_95(hits, of):
    z, share = 1.959964, hits / of
    middle = share + z * z / (2 * of)
    half = z * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    scale = 1 + z * z / of
    return (middle - half) / scale, (middle + half) / scale


def rate(shares):
    """Several shares of runs as one, with its interval."""
    hits, of = sum(share["hits"] for share in shares), sum(share["of"] for share in shares)
    low, high = wilson_95(hits, of)
    return f"{100 * hits / of:.1f} % ({100 * low:.0f} to {100 * high:.0f})"


def model_of(report, model):
    return next(entry["summary"] for entry in report["models"] if entry["model"] == model)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def paper_table():
    """Table I and Fig. 6 over all reported seeds of a world, and the seeds one by one."""
    rows, by_world = [], {}
    for name, report in reports("paper").items():
        by_world.setdefault(report["world"], []).append(report)
    for world, group in by_world.items():
        for model in MODELS:
            runs = [model_of(report, model) for report in group]
            printed = group[0]["paper"]["initialisation"][model]
            mean_m = sum(run["initial_error_m"]["mean"] for run in runs) / len(runs)
            rows.append([world, model, rate([run["initialised"] for run in runs]), f"{100 * printed['initialised']:.0f} %",
                         " ".join(f"{100 * run['initialised']['share']:.0f}" for run in runs),
                         f"{mean_m:.2f} m", f"{printed['initial_error_mean_m']:.2f} m",
                         rate([run["success"] for run in runs]),
                         f"{100 * group[0]['paper']['success']:.0f} %" if model == "gpr" else ""])
    return table(["world", "model", "within 3.0 m", "paper", "by seed", "mean error", "paper", "success", "paper"], rows)


def limits_table():
    """Initialised / success of the three models at each point of the three curves."""
    rows, found = [], reports("limits")
    points = sorted({name.split("_", 1)[1] for name in found}, key=lambda at: (at.split("_")[0], float(at.split("_")[1])))
    for point in points:
        curve, value = point.split("_")
        row = [{"bias": "bias, uT", "moved": "share of the steel moved", "lines": "survey's lines, m apart"}[curve], value]
        for world in ("corridor", "carpark"):
            for model in MODELS:
                summary = model_of(found[f"{world}_{point}"], model)
                row.append(f"{100 * summary['initialised']['share']:.0f} / {100 * summary['success']['share']:.0f}")
        rows.append(row)
    return table(["over", "at"] + [f"{world}, {model}" for world in ("corridor", "car park") for model in MODELS], rows)


def real_table():
    rows = []
    for name, data_sets in reports("real").items():
        for data_set in data_sets:
            of = data_set["evaluation"]
            rows.append([data_set["dataset"], data_set["real"].split(";")[0], data_set["method"], str(of["success"]["of"]),
                         rate([of["initialised"]]), rate([of["success"]]), rate([of["final_success"]]),
                         f"{of['runs_wrong_at_0.999']['hits']}",
                         f"{of['correct_distance_m']['median']:.1f}, {of['correct_distance_m']['max']:.1f} m",
                         f"{100 * of['first_error_m']['median']:.1f} cm"])
    return table(["data", "real", "method", "runs", "initialised", "success", "right at the end", "wrong at 0.999 (runs)",
                  "CLD median, max", "first error, median"], rows)


def three(values, factor=1.0, digits=2):
    return " ".join(f"{factor * value:.{digits}f}" for value in values)


def field_table():
    names = {"--kernel se": "gpr, squared exponential", "--kernel auto": "gpr, chosen by lanes",
             "--model bilinear": "bilinear", "--model fingerprint": "fingerprint"}
    drives = {"cea-corridor": ["the other pass"],
              "aalto-robot": ["drive 5, nothing changed"] + [f"drive {n}, steel brought in" for n in (6, 7, 8, 9)]}
    rows = []
    for entry in reports("field")["real"]:
        name = names[entry["way"]]
        if entry["report"].get("kernel", {}).get("chosen") == "harmonic":
            name += f": harmonic, steel {entry['report']['kernel']['harmonic']['steel']}"
        for drive, check in zip(drives[entry["dataset"]], entry["report"]["checks"]):
            rows.append([entry["dataset"], drive, name, three(check["rms_uT"]), three(check["within_1_sigma"], 100, 0),
                         three(check["within_2_sigma"], 100, 0)])
    rows.sort(key=lambda row: (row[0] == "aalto-robot", row[1]))
    return table(["survey of", "foretells", "model", "rms x y z, uT", "within 1 sigma, %", "2 sigma, %"], rows)


def hard_table():
    """Both seeds by world and disturbance, the whole of each first."""
    rows = []
    for report in reports("hard").values():
        for row in report["rows"] if report["set"] == "fix" else []:
            if "*" in (row["world"], row["disturbance"]) and row["world"] + row["disturbance"] != "**":
                continue
            wrong, distance, error = row["first_wrong_at_0.999"], row["correct_distance_m"], row["error_after_fix_m"]
            rows.append([str(report["seed"]), row["world"].replace("*", "all"), row["disturbance"].replace("*", "both"),
                         str(row["runs"]), rate([row["success"]]), str(row["answered"]["of"] - row["answered"]["hits"]),
                         f"{wrong['hits']} of {wrong['of']}", f"{distance['median']:.1f}, {distance['p95']:.1f} m",
                         f"{100 * error['median']:.1f}, {100 * error['p95']:.1f} cm"])
    return table(["seed", "world", "disturbed", "runs", "success", "silent", "first claims wrong at 0.999",
                  "CLD median, 95 %", "error after the fix"], rows)


def baselines_table():
    """Methods on the same events: over everything, then the ordinary building and the symmetric ones."""
    rows = []
    for report in reports("baselines").values():
        methods = list(dict.fromkeys(row["method"] for row in report["rows"]))
        for method in methods:
            of = {(r["world"], r["disturbance"]): r for r in report["rows"] if r["method"] == method}
            worlds = [w for w, d in of if w != "*" and d == "*"]
            symmetric = [of[w, "*"] for w in worlds if w != "office"]
            whole = of["*", "*"]
            answered, right = whole["answered"]["hits"], whole["success"]["hits"]
            distance = whole["correct_distance_m"]
            rows.append([method, str(whole["runs"]), rate([whole["success"]]), rate([of["office", "*"]["success"]]),
                         rate([row["success"] for row in symmetric]), str(whole["runs"] - answered),
                         str(answered - right),
                         "-" if distance["median"] is None else f"{distance['median']:.1f}, {distance['p95']:.1f} m"])
    return table(["method", "runs", "right within 10 m", "in the ordinary office", "in the symmetric ones", "silent",
                  "first pose wrong, or late", "CLD median, 95 %"], rows)


def ordinary_table():
    """LiDAR-only methods in an ordinary building, undisturbed: are they set as somebody who means them well would?"""
    rows = []
    for report in reports("ordinary").values():
        for row in report["rows"]:
            if (row["world"], row["disturbance"]) == ("*", "*"):
                distance = row["correct_distance_m"]
                rows.append([row["method"], f"{row['success']['hits']} of {row['runs']}", rate([row["success"]]),
                             f"{row['runs_wrong_at_0.999']['hits']}", f"{distance['median']:.1f}, {distance['p95']:.1f} m"])
    return table(["method", "right within 10 m", "", "wrong at 0.999 (runs)", "CLD median, 95 %"], rows)


def kidnap_table():
    rows = []
    for report in reports("hard").values():
        for row in report["rows"] if report["set"] == "kidnap" else []:
            if row["disturbance"] == "*":
                continue
            kidnap = row["kidnap"]
            rows.append([str(report["seed"]), row["world"].replace("*", "all"), str(row["runs"]),
                         rate([kidnap["noticed_within_3_m"]]),
                         f"{kidnap['noticed_m']['median']:.1f}, {kidnap['noticed_m']['p95']:.1f} m",
                         rate([kidnap["recovered_within_10_m"]]),
                         f"{kidnap['recovered_m']['median']:.1f}, {kidnap['recovered_m']['p95']:.1f} m",
                         rate([kidnap["wrong_after_notice"]]),
                         f"{row['false_alarms']} in {row['right_km']:.1f} km"])
    return table(["seed", "world", "runs", "noticed within 3 m", "median, 95 %", "found again within 10 m", "median, 95 %",
                  "wrong pose in between", "false alarms"], rows)


def spread(errors):
    return (f"{errors['translation_mean_m']:.3f} +- {errors['translation_sd_m']:.3f} m, "
            f"{errors['rotation_mean_deg']:.2f} +- {errors['rotation_sd_deg']:.2f} deg")


def mapping_real_table():
    rows = []
    for log, report in reports("mapping")["real"]["logs"].items():
        truth = report["against_truth"]
        rows.append([f"{log}, {report['driven_m']:.0f} m", "mstsl", f"{truth['ate_rms_m']:.3f} m", spread(truth["metre"]),
                     spread(truth["loops"]), f"{report['cpu_s']:.1f} s"])
        for way in ("icp", "icp-best", "rbpf"):
            other = reports("mapping")["mrpt"][f"{log}, {way}"]
            rows.append(["", f"MRPT {way}", f"{other['rms_m']:.3f} m", spread(other["metre"]), spread(other["loops"]),
                         f"{other['cpu_s']:.1f} s"])
    return table(["log", "by", "rms after alignment", "a metre apart", "over loops", "CPU"], rows)


def quantile(values, q):
    values = sorted(values)
    at = q * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def mapping_table():
    rows, groups = [], {}
    for name, report in reports("mapping").items():
        for run in report.get("runs", []):
            groups.setdefault((run["robot"], run["world"], run["with_field"]), []).append(run)
    for (robot, world, with_field), runs in groups.items():
        ate = [run["ate_rms_m"] for run in runs]
        total = lambda what: sum(run[what] for run in runs)
        rows.append([robot, world, "scans and field" if with_field else "scans", str(len(runs)), str(total("closures")),
                     str(total("wrong_closures")), f"{total('refused_by_field')}, {total('closed_only_with_field')}",
                     f"{quantile(ate, 0.5):.3f}, {quantile(ate, 0.95):.3f}, {max(ate):.3f}",
                     f"{100 * quantile([run['map_error'] for run in runs], 0.5):.1f} %"])
    return table(["robot", "world", "loops by", "drives", "loops", "wrong", "refused, won by the field",
                  "rms error of the way: median, 95 %, worst (m)", "walls drawn 0.2 m or more astray, median"], rows)


def update_table():
    """Drives held against a map as it was and as it was updated: root mean square error over axes, median over drives."""
    rms = lambda drive: math.sqrt(sum(v * v for v in drive["drives"][0]["rms_uT"]) / 3)
    rows = []
    for building in reports("update")["1016"]:
        drives = building["update"]["drives"]
        driven_m = sum(d["compared_m"] + d["new_ground_m"] for d in drives)
        before, after = [rms(d) for d in building["before"]], [rms(d) for d in building["after"]]
        better = sum(a < 0.95 * b for b, a in zip(before, after))
        worse = sum(a > 1.05 * b for b, a in zip(before, after))
        rows.append([building["world"], f"{100 * building['moved']:.0f} %",
                     f"{sum(d['changed_m'] for d in drives):.1f} m of {driven_m:.0f} m",
                     str(building["update"]["fingerprints_replaced"]),
                     f"{quantile(before, 0.5):.2f} uT, {quantile(after, 0.5):.2f} uT", f"{better}, {worse} of {len(before)}"])
    return table(["building", "things moved", "called changed", "fingerprints replaced",
                  "median error of other drives before, after", "better, worse by 5 %"], rows)


def ambiguity_table():
    """What was foretold from the maps, and what the drives met: all of them, and where less or more was foretold."""
    rows = []
    for report in reports("ambiguity").values():
        for building in report:
            drives = sorted(building["drives"], key=lambda drive: drive["foretold"])
            for name, group in (("all", drives), ("the worse half", drives[:len(drives) // 2]),
                                ("the better half", drives[len(drives) // 2:])):
                rows.append([building["world"] if name == "all" else "", name, str(len(group)),
                             f"{100 * sum(drive['foretold'] for drive in group) / len(group):.0f} %",
                             rate([{"hits": sum(drive["right"] for drive in group), "of": len(group)}])])
    return table(["building", "starts", "drives", "foretold", "answered rightly"], rows)


def positions_table():
    """A survey tracked on its map: how far off, and what maps of true and of tracked positions foretell of other drives."""
    rows = []
    for report in reports("positions").values():
        for world, of in report.items():
            uT = lambda what: f"{of[what]:.2f} uT"
            rows.append([world, f"{100 * of['survey_rms_m']:.1f} cm", f"{100 * of['survey_shift_m']:.1f} cm", uT("true_map_uT"),
                         uT("true_map_tracked_drives_uT"), uT("tracked_map_uT"), uT("tracked_map_tracked_drives_uT")])
    return table(["site", "off, rms", "of which the same everywhere", "map of true positions, true drives", "tracked drives",
                  "map of tracked positions, true drives", "tracked drives"], rows)


def method_reports():
    """Those in which several methods heard the same events, and what is to be said of all their places."""
    return ([("", report) for report in reports("baselines").values()] +
            [(", no magnetometer", report) for report in reports("no_magnetometer").values()])


def trust_table():
    return table(["place", "right most often", "no worse, as far as these runs can tell", "worse"],
                 standing.trust_rows(method_reports()))


def hard_facts_list():
    costs = reports("hard_cost")
    facts = [fact for name, report in reports("hard").items() if name.startswith("joint")
             for fact in standing.hard_facts(report, costs.get(str(report["seed"])))]
    return "\n".join(f"- {fact}" for fact in facts)


def losses_list():
    losses = [loss for report in reports("hard").values() for loss in standing.hard_losses(report)]
    losses += [loss for name, data_sets in reports("real").items() for loss in standing.real_losses(name, data_sets)]
    losses += [loss for label, report in method_reports() for loss in standing.place_losses(label, report)]
    return "\n".join(f"- {loss}" for loss in losses)


TABLES = {"trust": trust_table, "losses": losses_list, "hard_facts": hard_facts_list, "ambiguity": ambiguity_table, "paper": paper_table, "limits": limits_table, "real": real_table, "field": field_table,
          "hard": hard_table, "baselines": baselines_table, "kidnap": kidnap_table, "ordinary": ordinary_table, "positions": positions_table, "mapping": mapping_table,
          "mapping_real": mapping_real_table, "update": update_table}


def main():
    for page in (DOCS / "results.md", DOCS / "mapping.md"):
        text = page.read_text()
        written = re.sub(r"(<!-- table (\w+) -->\n).*?(<!-- end -->)",
                         lambda match: match[1] + TABLES[match[2]]() + "\n" + match[3], text, flags=re.DOTALL)
        if sys.argv[1:] != ["--check"]:
            page.write_text(written)
        elif written != text:
            sys.exit(f"docs/{page.name} does not say what docs/results/ holds: run tools/results.py")


if __name__ == "__main__":
    main()
