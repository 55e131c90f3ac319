#!/usr/bin/env python3
"""Checks that includes follow the layers.

A module may include itself and the modules that its CMakeLists.txt names, directly or through others; the list of
modules in the top CMakeLists.txt is the order of the layers, so no module may name one that stands after it.
Public headers show no type of Ceres, ROS, YAML, NetCDF, cairo, JSON or the compression libraries.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HIDDEN = re.compile(r"^(ceres/|glog/|ros/|sensor_msgs/|yaml-cpp/|netcdf|cairo|nlohmann/|zstd|lz4|bzlib|zlib|png\.h|tbb/)")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def includes(file):
    for number, line in enumerate(file.read_text().splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match.group(1)


def layer_order():
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"foreach\(module ([^)]+)\)", text).group(1).split()


def declared_dependencies(module):
    text = (ROOT / "src" / module / "CMakeLists.txt").read_text()
    return set(re.findall(r"mstsl::(\w+)", text))


def reachable(module, direct):
    seen, todo = set(), [module]
    while todo:
        for name in direct[todo.pop()] - seen:
            seen.add(name)
            todo.append(name)
    return seen | {module}


def problems():
    order = layer_order()
    direct = {module: declared_dependencies(module) for module in order}
    for module in order:
        for name in direct[module]:
            if name not in order or order.index(name) >= order.index(module):
                yield f"src/{module}/CMakeLists.txt: depends on {name}, which is not a lower layer"
    allowed = {module: reachable(module, direct) for module in order}
    for module in order:
        for folder in (ROOT / "include" / "mstsl" / module, ROOT / "src" / module):
            for file in sorted(folder.rglob("*.[ch]pp")):
                public = folder.parts[-3] == "include"
                for number, name in includes(file):
                    place = f"{file.relative_to(ROOT)}:{number}"
                    if public and HIDDEN.match(name):
                        yield f"{place}: a public header includes <{name}>; hide it in the .cpp file"
                    target = re.match(r"mstsl/(\w+)/", name)
                    if target and target.group(1) not in allowed[module]:
                        yield f"{place}: {module} includes {name}, but does not depend on {target.group(1)}"


def main():
    found = list(problems())
    for problem in found:
        print(problem, file=sys.stderr)
    print(f"layers: {len(found)} problems")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
