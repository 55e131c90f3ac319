#!/bin/sh
# Installs the pinned npm packages into FOLDER. Exit status 77: npm is absent, or gives no packages here (no network).
# usage: install_npm.sh FOLDER
here=$(dirname "$0")
mkdir -p "$1" && cp "$here"/package.json "$here"/package-lock.json "$here"/*.mjs "$1" || exit 1
cmp -s "$1/package-lock.json" "$1/node_modules/installed.json" && exit 0
if ! command -v npm >/dev/null; then
  echo "skipped: npm is not installed"
  exit 77
fi
cd "$1" || exit 1
if ! npm ci --ignore-scripts --no-audit --no-fund; then
  echo "skipped: npm could not fetch the packages of package-lock.json"
  exit 77
fi
cp package-lock.json node_modules/installed.json
