#!/usr/bin/env python3
"""One line a protocol report and field model: initialised within 3 m, and success.

    tools/limits_table.py REPORT.json...
"""
import json
import pathlib
import sys


def percent(share):
    return f"{100 * share['share']:.0f} %"


def main():
    print("| point | world | seed | model | initialised | success |\n|---|---|---|---|---|---|")
    for name in sys.argv[1:]:
        path = pathlib.Path(name)
        report = json.loads(path.read_text())
        for model in report["models"]:
            summary = model["summary"]
            print(f"| {path.parent.name} | {report['world']} | {report['seed']} | {model['model']} "
                  f"| {percent(summary['initialised'])} | {percent(summary['success'])} |")


if __name__ == "__main__":
    main()
