# A minimal Debian in a folder, for scripts that read this file and set say, die, folder, keep and debian (12 or 13).
# Needs root. Where packages come from is asked of the apt of this machine. The folder is removed at the end unless keep
# is set.
case $debian in
  12) release=bookworm ;;
  13) release=trixie ;;
  *) die "no such Debian: $debian; 12 or 13" ;;
esac

# The lists of packages in ./dev.
packages_of_dev() { awk '/^[a-z_]+_packages=\(/ { within = 1 } within; /\)/ { within = 0 }' "$root/dev"; }

# Sets mirror, and sources: one line "URI suite component" for each place where this machine gets Debian from. Makes the
# folder that holds FOLDER.
find_mirror() {
  [[ $EUID -eq 0 ]] || die "needs root"
  [[ ! -e $folder ]] || die "$folder exists"
  if ! command -v debootstrap >/dev/null; then
    say "installing debootstrap"
    { apt-get install -y --no-install-recommends debootstrap ||
      { apt-get update && apt-get install -y --no-install-recommends debootstrap; }; } </dev/null >&2
  fi

  local here
  here=$(. /etc/os-release && echo "${VERSION_CODENAME-}")
  mapfile -t sources < <(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' \
    'Created-By: Packages' 'Origin: Debian' |
    sed -En "s/ $here((-[a-z]+)? main)\$/ $release\1/p" | sort -u)
  mirror=$(printf '%s\n' "${sources[@]}" | sed -n "s/ $release main\$//p" | head -n 1)
  [[ -n $mirror ]] || die "apt on this machine knows no mirror of Debian $release"
  eval "$(apt-config shell proxy Acquire::http::Proxy)"
  [[ -z ${proxy-} ]] || export http_proxy=$proxy

  mkdir -p "$(dirname "$folder")"
  [[ -n $keep ]] || trap 'rm -rf --one-file-system "$folder"' EXIT
}

make_debian() {
  local include= file
  find_mirror
  say "making a minimal Debian in $folder"
  [[ $mirror == https:* ]] && include=--include=ca-certificates
  debootstrap --variant=minbase $include "$release" "$folder" "$mirror" >"$folder.log" 2>&1 ||
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
}

# Runs a command in the folder's /carom as in a machine of its own: its mounts vanish with its processes.
inside() {
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount --rbind /sys "$0/sys" &&
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
      ${http_proxy:+http_proxy="$http_proxy"} bash -c "cd /carom && exec \"\$@\"" bash "$@"' "$folder" "$@"
}
