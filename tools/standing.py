"""What the kept reports say of the methods as a whole: which to trust where, and what `joint` loses at. Used by
tools/results.py. A difference is called one only where chance would hardly make it (Fisher's exact test, 5 %)."""
import math


def by_chance(hits_a, of_a, hits_b, of_b):
    """Two-sided p-value of Fisher's exact test: how often equally good methods differ by at least as much."""
    hits, of = hits_a + hits_b, of_a + of_b
    ways = lambda k: math.comb(of_a, k) * math.comb(of_b, hits - k)
    lowest, highest = max(0, hits - of_b), min(of_a, hits)
    seen = ways(hits_a)
    return sum(ways(k) for k in range(lowest, highest + 1) if ways(k) <= seen) / math.comb(of, hits)


def differ(a, b):
    return by_chance(a["hits"], a["of"], b["hits"], b["of"]) < 0.05


def counts(share):
    return f"{share['hits']} of {share['of']}"


def by_place(report):
    """The rows of each building (all disturbances together), by method."""
    places = {}
    for row in report["rows"]:
        if row["world"] != "*" and row["disturbance"] == "*":
            places.setdefault(row["world"], {})[row["method"]] = row
    return places


def rank(rows):
    """The methods from the one that is right most often on; among equals the one that is wrong least often first."""
    return sorted(rows, key=lambda m: (-rows[m]["success"]["hits"], rows[m]["runs_wrong_at_0.999"]["hits"],
                                       rows[m]["correct_distance_m"]["median"] or math.inf))


def trust_rows(reports_of_methods):
    """Place, the method that is right most often there, those that are no worse and those that are."""
    for label, report in reports_of_methods:
        for place, rows in by_place(report).items():
            best, *others = rank(rows)
            first = rows[best]
            like = [m for m in others if not differ(rows[m]["success"], first["success"])]
            worse = [m for m in others if m not in like]
            name = lambda m: f"{m} {counts(rows[m]['success'])}" + (
                f", wrong at 0.999 in {rows[m]['runs_wrong_at_0.999']['hits']}" if rows[m]["runs_wrong_at_0.999"]["hits"] else "")
            yield [place + label, name(best), "; ".join(map(name, like)) or "-", "; ".join(map(name, worse)) or "-"]


def hard_losses(report):
    where = f"{report['set']}, seed {report['seed']}"
    for row in report["rows"]:
        if row["method"] != "joint":
            continue
        total = row["world"] == "*" and row["disturbance"] == "*"
        if total and row["runs_wrong_at_0.999"]["hits"]:
            yield f"{where}: a wrong pose was claimed at 0.999 in {counts(row['runs_wrong_at_0.999'])} runs."
        if total and row["false_alarms"] > 0.1 * row["right_km"]:
            yield f"{where}: {row['false_alarms']} right poses were withdrawn in {row['right_km']:.1f} km (aim: one in 10 km)."
        if "*" in (row["world"], row["disturbance"]):
            continue
        of = row["success"]
        if of["hits"] < of["of"]:
            silent = row["answered"]["of"] - row["answered"]["hits"]
            yield (f"{where}, {row['world']}, {row['disturbance']}: right within 10 m in {counts(of)}, "
                   f"silent in {silent}.")
        kidnap = row["kidnap"]
        for what, share, wanted in (("the carry was noticed within 3 m", kidnap["noticed_within_3_m"], None),
                                    ("the robot was found again within 10 m", kidnap["recovered_within_10_m"], None),
                                    ("another wrong pose came first", kidnap["wrong_after_notice"], 0)):
            if share["of"] and share["hits"] != (share["of"] if wanted is None else wanted):
                yield f"{where}, {row['world']}: {what} in {counts(share)}."


def real_losses(name, data_sets):
    for entry in data_sets:
        of, seed = entry["evaluation"], entry["seed"]
        if entry["method"] != "joint":
            continue
        if of["success"]["hits"] < of["success"]["of"]:
            yield f"{entry['dataset']}, seed {seed}: the first pose was right, and within 10 m, in {counts(of['success'])}."
        if of["final_success"]["hits"] < of["final_success"]["of"]:
            yield f"{entry['dataset']}, seed {seed}: right at the end in {counts(of['final_success'])}."
        if of["runs_wrong_at_0.999"]["hits"]:
            yield f"{entry['dataset']}, seed {seed}: a wrong pose was claimed at 0.999 in {counts(of['runs_wrong_at_0.999'])} runs."


def place_losses(label, report):
    for place, rows in by_place(report).items():
        if "joint" not in rows:
            continue
        ours = rows["joint"]
        for method, row in rows.items():
            if row["success"]["hits"] > ours["success"]["hits"] and differ(row["success"], ours["success"]):
                yield f"{place}{label}: {method} is right in {counts(row['success'])}, joint in {counts(ours['success'])}."
            sooner, later = row["correct_distance_m"]["median"], ours["correct_distance_m"]["median"]
            as_often = row["success"]["hits"] >= ours["success"]["hits"]
            if as_often and sooner is not None and later is not None and sooner < 0.75 * later:
                yield (f"{place}{label}: {method} is right as often and sooner, after {sooner:.1f} m where joint takes "
                       f"{later:.1f} m (medians).")


def hard_facts(report, cost):
    """What the whole of a hard run says, in sentences."""
    row = next(r for r in report["rows"] if r["method"] == "joint" and (r["world"], r["disturbance"]) == ("*", "*"))
    first, nees, error = row["first_wrong_at_0.999"], row["nees"], row["error_after_fix_m"]
    yield (f"**{row['success']['hits']:,} of {row['success']['of']:,} first poses are right and within 10 m.** Runs with any wrong pose "
           f"claimed at 0.999: {row['runs_wrong_at_0.999']['hits']}, at 0.99: {row['runs_wrong_at_0.99']['hits']}. First claims at 0.999 that "
           f"were wrong: {counts(first)}, so at most {100 * first['wilson_95'][1]:.1f} % (95 %).")
    yield (f"After the fix {100 * error['median']:.1f} cm and {math.degrees(row['error_after_fix_rad']['median']):.2f} deg (median), "
           f"{100 * error['p95']:.1f} cm and {math.degrees(row['error_after_fix_rad']['p95']):.2f} deg (95 %).")
    yield (f"Covariances: NEES {nees['mean']:.2f} on average (3 if true), {100 * nees['within_95']['hits'] / nees['within_95']['of']:.1f} % of "
           "poses within their 95 % ellipsoid: on the modest side.")
    yield f"False alarms: {row['false_alarms']} right poses withdrawn in {row['right_km']:.1f} km (aim: less than 1 in 10 km)."
    if cost:
        of = next(r for r in cost["rows"] if r["method"] == "joint" and (r["world"], r["disturbance"]) == ("*", "*"))
        number = lambda ms: f"{ms:.0f}" if ms >= 10 else f"{ms:.2g}"
        ms = lambda c: (f"{number(c['median_ms'])} ms median, {number(c['p95_ms'])} at 95 %, {number(c['p99_ms'])} at 99 %, "
                        f"{number(c['max_ms'])} at worst")
        yield (f"CPU of a scan (541 beams, 10 Hz, one core, a machine busy with other work): searching {ms(of['searching'])} (the first search, "
               f"over the whole map); tracking {ms(of['tracking'])} (searches anew). Peak memory of the whole protocol: {cost['peak_memory_mb']:.0f} MB.")
