#!/usr/bin/env python3
"""Checks that every listing in README.md and docs/*.md is real.

  ```cpp         must stand, word for word, in a program under examples/ (which the build compiles)
  ```sh          each `mstsl ...` line is run, block after block of one file in one folder, and must end as the block's
                 comment `# exit N` says (0 without one); `./run WORD` must be a command of ./run
  ```sh slow     the same, but only checked for options that exist, because it takes long or needs your files

Usage: check_listings.py PROJECT MSTSL [FILE.md...]
"""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```(\S+)(?:[ ]+(\S+))?\n(.*?)^```", re.MULTILINE | re.DOTALL)


def squeezed(text):
    return re.sub(r"\s+", " ", text).strip()


def options_exist(mstsl, words):
    """Whether `mstsl sub [sub] --help` knows every option of the command line."""
    subcommands = []
    for word in words[1:]:
        if word.startswith("-") or len(subcommands) == 2 or not word.isalpha():
            break
        subcommands.append(word)
    for depth in (len(subcommands), 1):
        shown = subprocess.run([mstsl, *subcommands[:depth], "--help"], capture_output=True, text=True)
        if shown.returncode == 0:
            break
    known = set(re.findall(r"(?<![\w-])--?[\w-]+", shown.stdout))
    return [word for word in words if re.match(r"--?[a-zA-Z]", word) and word.split("=")[0] not in known]


def check_shell(project, mstsl, body, slow, folder):
    run_commands = set(re.findall(r"^  (\w+) ", subprocess.run([project / "run", "help"], capture_output=True,
                                                              text=True).stdout, re.MULTILINE))
    for line in re.sub(r"\\\n", " ", body).splitlines():
        command, _, comment = line.partition("#")
        words = shlex.split(command)
        if not words:
            continue
        if words[0] == "./run" and words[1] not in run_commands:
            yield f"./run has no command {words[1]}"
        if words[0] == "mpirun" and "mstsl" in words:
            words = words[words.index("mstsl"):]
        if words[0] != "mstsl":
            continue
        for option in options_exist(mstsl, words):
            yield f"{command.strip()}: there is no option {option}"
        if slow:
            continue
        wanted = int((re.search(r"exit (\d)", comment) or [0, "0"])[1])
        done = subprocess.run(["bash", "-c", command.replace("mstsl", shlex.quote(str(mstsl)), 1)], cwd=folder,
                              capture_output=True, text=True)
        if done.returncode != wanted:
            yield f"{command.strip()}: exit {done.returncode}, not {wanted}: {done.stderr.strip()[-300:]}"


def problems(project, mstsl, file):
    examples = [squeezed(path.read_text()) for path in (project / "examples").glob("*.cpp")]
    with tempfile.TemporaryDirectory() as folder:
        for language, mark, body in FENCE.findall(file.read_text()):
            if language == "cpp" and not any(squeezed(body) in example for example in examples):
                yield f"this listing stands in no program under examples/: {body.strip().splitlines()[0]} ..."
            if language == "sh":
                yield from check_shell(project, mstsl, body, mark == "slow", folder)


def main():
    project, mstsl = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    files = [pathlib.Path(name) for name in sys.argv[3:]] or [project / "README.md", *sorted((project / "docs").glob("*.md"))]
    found = [f"{file.name}: {problem}" for file in files for problem in problems(project, mstsl, file)]
    print("\n".join(found) or "every listing holds")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
