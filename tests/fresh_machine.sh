#!/usr/bin/env bash
# The proof of the fresh machine: a minimal Debian 12 in a folder, the tracked files copied into it,
# and there the two commands of the README. Needs root. Where packages come from is asked of the apt of
# this machine; the folder is removed at the end.
set -euo pipefail

usage() {
  cat <<'END'
./dev bare [--no-test] [--keep] [FOLDER]
  FOLDER     where the small Debian is made (default: build/bare); it must not exist
  --no-test  only ./dev run escape magnetic-square
  --keep     leave the folder for a look around
Fails if a command fails there or the first result takes longer than 6 minutes.
END
}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
release=bookworm
limit=360
folder=$root/build/bare
tests=yes
keep=
for argument; do
  case $argument in
    --no-test) tests= ;;
    --keep) keep=yes ;;
    -h | --help) usage; exit ;;
    -*) usage >&2; exit 2 ;;
    *) folder=$(realpath -m "$argument") ;;
  esac
done
say() { echo "bare: $*" >&2; }
die() { say "$*"; exit 1; }

[[ $EUID -eq 0 ]] || die "needs root: sudo ./dev bare"
[[ ! -e $folder ]] || die "$folder exists"
if ! command -v debootstrap >/dev/null; then
  say "installing debootstrap"
  { apt-get install -y --no-install-recommends debootstrap ||
    { apt-get update && apt-get install -y --no-install-recommends debootstrap; }; } </dev/null >&2
fi

# Where this machine gets Debian from: one line "URI suite component" for each source.
mapfile -t sources < <(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' \
  'Created-By: Packages' 'Origin: Debian' | grep -E " $release(-[a-z]+)? main\$" | sort -u)
mirror=$(printf '%s\n' "${sources[@]}" | sed -n "s/ $release main\$//p" | head -n 1)
[[ -n $mirror ]] || die "apt on this machine knows no mirror of Debian $release"
eval "$(apt-config shell proxy Acquire::http::Proxy)"
[[ -z ${proxy-} ]] || export http_proxy=$proxy

mkdir -p "$(dirname "$folder")"
[[ -n $keep ]] || trap 'rm -rf --one-file-system "$folder"' EXIT

say "making a minimal Debian in $folder"
[[ $mirror == https:* ]] && include=--include=ca-certificates
debootstrap --variant=minbase ${include-} "$release" "$folder" "$mirror" >"$folder.log" 2>&1 ||
  { tail -n 20 "$folder.log" >&2; die "debootstrap failed"; }
rm -f "$folder.log"
printf 'deb %s\n' "${sources[@]}" >"$folder/etc/apt/sources.list"
# How apt reaches its mirror (proxies, checks of dates); settings that name scripts stay behind.
apt-config dump Acquire | grep -E '^Acquire::(https?|Check-|Retries)' | grep -v Auto-Detect \
  >"$folder/etc/apt/apt.conf.d/90from-host" || true
for file in /etc/resolv.conf /etc/hosts; do
  [[ ! -e $file ]] || cp -L "$file" "$folder$file"
done
mkdir "$folder/carom"
git -C "$root" ls-files -z | (cd "$root" && xargs -0 cp --parents -t "$folder/carom")

# Runs a command in the folder as in a machine of its own: its mounts vanish with its processes.
inside() {
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" &&
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
      ${http_proxy:+http_proxy="$http_proxy"} bash -c "cd /carom && exec \"\$@\"" bash "$@"' "$folder" "$@"
}

begin=$SECONDS
say "./dev run escape magnetic-square"
inside ./dev run escape magnetic-square </dev/null | tee "$folder/first_result"
first=$((SECONDS - begin))
[[ -s $folder/first_result ]] || die "no result"
say "first result after $first s on $(nproc) cores (limit $limit s)"
if [[ -n $tests ]]; then
  say "./dev test"
  inside ./dev test </dev/null
  say "./dev test passed; $((SECONDS - begin)) s in all"
fi
[[ $first -le $limit ]] || die "the first result came too late"
