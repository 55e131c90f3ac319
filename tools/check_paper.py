#!/usr/bin/env python3
"""Checks that docs/paper.md names functions, headers and tests that exist.

    tools/check_paper.py [ROOT]

Of each row of its first table, every header must be under include/mstsl, every test file must be there, and every name
of a function or type must occur in a public header and, where the row names a test file, in a test of that module.
Exit status 1 and one line for each that does not.
"""
import pathlib
import re
import sys


def words_of(files):
    return set(re.findall(r"\w+", " ".join(file.read_text() for file in files)))


def mistakes(root):
    headers = words_of((root / "include").rglob("*.hpp"))
    tests = words_of((root / "tests").rglob("*.[ch]pp"))
    for number, line in enumerate((root / "docs/paper.md").read_text().splitlines(), 1):
        cells = line.split("|")
        if len(cells) != 6:  # the table of equations has four columns
            continue
        for token in re.findall(r"`([^`]+)`", cells[3] + cells[4]):
            if token.endswith(".hpp"):
                known = (root / "include/mstsl" / token).is_file()
            elif token.endswith((".cpp", "/")):
                known = (root / token).exists()
            else:
                known = re.findall(r"\w+", token)[-1] in headers and re.findall(r"\w+", token)[-1] in tests
            if not known:
                yield f"docs/paper.md:{number}: `{token}` is not there, or no test uses it"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    found = list(mistakes(root))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
