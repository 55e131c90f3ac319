#!/bin/sh
# Installs the npm packages pinned in SOURCE into FOLDER, with SOURCE's scripts. Exit status 77: npm is absent, or gives
# no packages here (no network).
# usage: install_npm.sh SOURCE FOLDER
mkdir -p "$2" && cp "$1"/package.json "$1"/package-lock.json "$1"/*.mjs "$2" || exit 1
cmp -s "$2/package-lock.json" "$2/node_modules/installed.json" && exit 0
if ! command -v npm >/dev/null; then
  echo "skipped: npm is not installed"
  exit 77
fi
cd "$2" || exit 1
if ! npm ci --ignore-scripts --no-audit --no-fund; then
  echo "skipped: npm could not fetch the packages of package-lock.json"
  exit 77
fi
cp package-lock.json node_modules/installed.json
