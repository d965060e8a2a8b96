#!/usr/bin/env bash
# Do two builds of the program, of different compilers or machines, give the same bits?
#   tests/same_bits.sh CAROM OTHER      exit status 1: they do not
set -euo pipefail
one=$1
other=$2
differ=0
while read -r command; do
  results=()
  for program in "$one" "$other"; do
    # shellcheck disable=SC2086
    results+=("$("$program" $command --json --quiet </dev/null | grep -E '^  "(digest|lost|x|y|vx|vy|t)":')")
  done
  if [[ -n ${results[0]} && ${results[0]} == "${results[1]}" ]]; then
    echo "the same: $command"
  else
    printf 'DIFFERENT: %s\n%s\n%s\n' "$command" "${results[@]}"
    differ=1
  fi
done <<'COMMANDS'
escape magnetic-square --trajectories 2e4 --t-max 100
escape magnetic-square --trajectories 2e4 --t-max 100 --isa baseline
escape stadium --trajectories 1e4 --t-max 100
escape mushroom --trajectories 4096 --t-max 100 --set initial.kind=sobol
escape ellipse-magnetic --trajectories 2000 --t-max 50
escape lorentz-random --trajectories 1000 --t-max 20
escape soft-lorentz --trajectories 200 --t-max 10
escape coulomb-circle --trajectories 4 --t-max 2
escape wigner --trajectories 4 --t-max 5
escape three-disc --splitting lin:0:4:5
diffusion lorentz-triangular --trajectories 2000 --t-max 100
lyapunov henon-heiles --trajectories 10 --t-max 100
run ellipse-magnetic --collisions 20000
run henon-heiles --t-max 100
run circle --closed --set table.shape=cardioid --collisions 3000
run circle --closed --set table.shape=cardioid --set field.B=0.4 --collisions 3000
run stadium --closed --precision certified --digits 20 --collisions 200
section henon-heiles --orbits 4 --points 50 --set section.on="x=0"
COMMANDS
exit $differ
