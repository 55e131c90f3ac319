#!/bin/sh
# Runs a script in the folder where install_npm.sh put the packages. Exit status 77: they are not there.
# usage: run_node.sh FOLDER SCRIPT ARGUMENT...
if ! test -e "$1/node_modules/installed.json"; then
  echo "skipped: node's packages are not installed"
  exit 77
fi
folder=$1
script=$2
shift 2
exec node "$folder/$script" "$@"
