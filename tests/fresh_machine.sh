#!/usr/bin/env bash
# The proof of the fresh machine: a minimal Debian in a folder, the tracked files copied into it,
# and there the two commands of the README; or the packages of ./dev release. Needs root.
set -euo pipefail

usage() {
  cat <<'END'
./dev bare [--debian 12|13] [--no-test | --release | --packages] [--keep] [FOLDER]
  FOLDER      where the small Debian is made (default: build/bare); it must not exist
  --debian    12 (default) or 13
  --no-test   only ./dev run escape magnetic-square
  --release   run ./dev release there, of what is committed: its Debian packages and its wheel land in build/packages
  --packages  install each package of ./dev release, use it, remove it: nothing may be left
  --keep      leave the folder for a look around
Fails if a command fails there or the first result takes longer than 6 minutes.
END
}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
limit=360
folder=$root/build/bare
what=tests
debian=12
keep=
while [[ $# -gt 0 ]]; do
  case $1 in
    --debian) debian=${2-}; [[ $# -gt 1 ]] && shift ;;
    --no-test) what=run ;;
    --release) what=release ;;
    --packages) what=packages ;;
    --keep) keep=yes ;;
    -h | --help) usage; exit ;;
    -*) usage >&2; exit 2 ;;
    *) folder=$(realpath -m "$1") ;;
  esac
  shift
done
say() { echo "bare: $*" >&2; }
die() { say "$*"; exit 1; }

. "$root/tests/bare_debian.sh"

if [[ $what == packages ]]; then
  . "$root/tests/packages.sh"
  exit
fi
make_debian
if [[ $what == release ]]; then
  rmdir "$folder/carom"
  git clone --quiet --depth 1 "file://$root" "$folder/carom"
  inside ./dev release </dev/null
  mkdir -p "$root/build/packages"
  cp "$folder"/carom/build/packages/*.{deb,whl} "$root/build/packages"
  exit
fi
git -C "$root" ls-files -z | (cd "$root" && xargs -0 cp --parents -t "$folder/carom")

begin=$SECONDS
say "./dev run escape magnetic-square"
inside ./dev run escape magnetic-square </dev/null | tee "$folder/first_result"
first=$((SECONDS - begin))
[[ -s $folder/first_result ]] || die "no result"
say "first result after $first s on $(nproc) cores (limit $limit s)"
if [[ $what == tests ]]; then
  say "./dev test"
  inside ./dev test </dev/null
  say "./dev test passed; $((SECONDS - begin)) s in all"
fi
[[ $first -le $limit ]] || die "the first result came too late"
