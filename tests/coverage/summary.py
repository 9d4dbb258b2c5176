#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints what a coverage report of gcovr (JSON) says of formats and runtime: share of lines by folder and file,
and every uncovered line that makes or passes on an error."""
import argparse
import json
import pathlib
import re
import sys

ERROR_PATH = re.compile(r"\bfail(_\w+)?\(|\bError\{|ErrorCode::|\bthrow\b|catch \(|return .*\.error\(\)")


def covered_lines(report):
    """File name to {line number: times run}; a line of a template counts as often as its best instance."""
    files = {}
    for entry in report["files"]:
        lines = files.setdefault(entry["file"], {})
        for line in entry["lines"]:
            if not line.get("gcovr/noncode"):
                number = line["line_number"]
                lines[number] = max(lines.get(number, 0), line["count"])
    return files


def share(files):
    total = sum(len(lines) for lines in files.values())
    run = sum(sum(count > 0 for count in lines.values()) for lines in files.values())
    return run, total, 100.0 * run / total if total else 100.0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("--least", type=float, default=0, help="percent that formats and runtime each need")
    arguments = parser.parse_args()
    files = covered_lines(json.loads(arguments.report.read_text()))
    enough = True
    for folder in ("formats", "runtime"):
        inside = {name: lines for name, lines in files.items() if name.startswith(folder + "/")}
        run, total, percent = share(inside)
        enough = enough and total > 0 and percent >= arguments.least
        print(f"{folder}: {percent:.1f} % of {total} lines ({total - run} not run)")
        for name in sorted(inside, key=lambda name: share({name: inside[name]})[2]):
            run, total, percent = share({name: inside[name]})
            if percent < 90:
                print(f"  {percent:5.1f} %  {name}")
    print("error paths that no test walks:")
    for name in sorted(files):
        text = (arguments.source / name).read_text().splitlines()
        for number, count in sorted(files[name].items()):
            if count == 0 and ERROR_PATH.search(text[number - 1]):
                print(f"  {name}:{number}: {text[number - 1].strip()}")
    return 0 if enough else 1


if __name__ == "__main__":
    sys.exit(main())
