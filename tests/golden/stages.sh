# SPDX-License-Identifier: Apache-2.0
# How each golden file is made from the ones before it. Read by check.sh and regenerate.sh.

stages="material clusters aggregated overlap coarsened asset"

# make_stage STAGE OUTPUT: runs the tool of STAGE in the current folder, which holds the files before it.
make_stage() {
    case $1 in
        material) knead-material fine.hdf --scenario 4 --seed 1 --poissons-ratio 0.35 -o "$2" ;;
        clusters) knead-cluster material.hdf --bins 2 --clusters 3 --seed 1 -o "$2" ;;
        aggregated) knead-aggregate clusters.hdf -o "$2" ;;
        overlap) knead-overlap fine.hdf coarse.hdf -o "$2" ;;
        coarsened) knead-coarsen aggregated.hdf coarse.hdf overlap.hdf -o "$2" ;;
        asset) knead-bake scene.toml coarsened.hdf --level k3 -o "$2" ;;
    esac
}

# Integers and texts must be equal. Floats may differ as far as compilers and mathematical libraries round
# differently: a few hundred operations on a value, 1e-16 each. Shared volumes are differences of products of
# coordinates of 0.1 m: below 1e-18 m^3 they are rounding.
tolerances_of() {
    echo "--rel 1e-12 --abs 1e-18"
    # Weights are rounded to float32: the last of 24 bits may differ. Those of size 1 differ by 1.2e-7.
    if [ "$1" = asset ]; then echo "--rel weights=2e-7 --abs weights=2e-7"; fi
}
