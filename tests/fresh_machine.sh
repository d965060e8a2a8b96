#!/usr/bin/env bash
# The proof of the fresh machine: a minimal Debian in a folder, the tracked files copied into it,
# and there the two commands of the README; or the packages of ./dev release; or another compiler, another machine. Needs root.
set -euo pipefail

usage() {
  cat <<'END'
./dev bare [--debian 12|13] [--libcxx | --arch arm64 | --release | --packages] [--no-test] [--keep] [FOLDER]
  FOLDER      where the small Debian is made (default: build/bare); it must not exist
  --debian    12 (default) or 13
  --libcxx    built by clang with libc++, as on a Mac
  --arch arm64  built for 64-bit ARM, run by qemu-user: digests compared with those of build/release, carom validate,
              the tests and the Python module (hours; Debian 12)
  --no-test   only ./dev run escape magnetic-square; with --libcxx and --arch no tests
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
other=
keep=
while [[ $# -gt 0 ]]; do
  case $1 in
    --debian) debian=${2-}; [[ $# -gt 1 ]] && shift ;;
    --no-test) what=run ;;
    --release) what=release ;;
    --packages) what=packages ;;
    --libcxx) other=libcxx ;;
    --arch)
      [[ ${2-} == arm64 ]] || { usage >&2; exit 2; }
      other=arm
      shift ;;
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
if [[ $other == arm ]]; then
  . "$root/tests/bare_arm.sh"
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

if [[ $other == libcxx ]]; then
  . "$root/tests/bare_libcxx.sh"
  exit
fi
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
