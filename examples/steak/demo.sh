#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes the steak and presses its levels. Usage: demo.sh BUILD_FOLDER
set -euo pipefail
build=$1
out=$build/steak
here=$(dirname "$0")

"$build/bin/knead" build "$here/steak.toml" -o "$out" >/dev/null
echo
"$build/bin/steak_press" "$out" steak fine homogenised k1 k3 k10
cat <<TEXT

Files are in $out/:
  steak.k10.hdf           an asset; "$build/bin/knead-asset info $out/steak.k10.hdf" says what is in it
  steak.*.hdf             every stage; all of them open in ParaView (5.11 or newer) as they are
  steak.press.csv         force over time of each level
TEXT
