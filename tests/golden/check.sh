#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# check.sh STAGE PROGRAMS: makes one stage from the committed files before it, and compares it with the committed
# result, dataset by dataset. Never writes into this folder.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
PATH=$2:$PATH
. "$here/stages.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/files/* "$work"
cd "$work"
make_stage "$1" made.hdf
# shellcheck disable=SC2046
knead-asset diff $(tolerances_of "$1") "$1.hdf" made.hdf
