#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# regenerate.sh PROGRAMS: writes every golden file anew, after a change of a result that is meant. Says what changes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
PATH=$(cd "$1" && pwd):$PATH
. "$here/stages.sh"
cd "$here/files"
# The start: the paper's cubes, which no mesher has a hand in.
knead-mesh cubes --divisions 3 --size 0.1 -o fine.hdf
knead-mesh cubes --divisions 2 --size 0.1 -o coarse.hdf
for stage in $stages; do
    make_stage "$stage" "$stage.new"
    if [ -f "$stage.hdf" ]; then
        knead-asset diff "$stage.hdf" "$stage.new" || echo "$stage.hdf: written anew"
    fi
    mv "$stage.new" "$stage.hdf"
done
