# ./dev bare --packages: each package of ./dev release is installed in a minimal Debian, used and removed. A package
# must bring what it needs, so it is installed with its dependencies alone; what was there before must be there after it.
packages=$root/build/packages
compgen -G "$packages/*~deb$debian"_*.deb >/dev/null ||
  die "no packages for Debian $debian in $packages: ./dev release makes them, or ./dev bare --debian $debian --release"

quiet_apt() {
  inside env DEBIAN_FRONTEND=noninteractive apt-get -y --no-install-recommends "$@" </dev/null >"$folder/carom/apt.log" 2>&1 ||
    { tail -n 30 "$folder/carom/apt.log" >&2; die "apt-get $* failed"; }
}

# Names of all files but those that change by themselves.
list_files() {
  inside find / -xdev \( -path /carom -o -path /proc -o -path /tmp -o -path /var/cache -o -path /var/log \) -prune \
    -o -print | LC_ALL=C sort
}

# Installs what the package needs, then the package; runs use_NAME; purges it and compares the files.
try() {
  local package=$1 deb needed begin=$SECONDS
  deb=$(basename "$packages/${package}"_*"~deb$debian"_*.deb)
  cp "$packages/$deb" "$folder/carom"
  mapfile -t needed < <(inside apt-get -s --no-install-recommends install "./$deb" |
    sed -n 's/^Inst \([^ ]*\).*/\1/p' | grep -vx "$package")
  [[ ${#needed[@]} -eq 0 ]] || quiet_apt install "${needed[@]}"
  list_files >"$folder/carom/files"
  quiet_apt install "./$deb"
  say "$package: installed with ${#needed[@]} packages that it needs after $((SECONDS - begin)) s"
  begin=$SECONDS
  "use_${package//-/_}"
  say "$package: used in $((SECONDS - begin)) s"
  quiet_apt purge "$package"
  list_files | diff "$folder/carom/files" - >&2 || die "$package: files were left behind or lost"
  say "$package: removed, nothing is left"
}

small=(escape stadium --trajectories 1e4)
use_carom() {
  inside carom escape stadium </dev/null
  inside carom "${small[@]}" --json </dev/null | grep -o '"digest": *"[0-9a-f]*"' | cut -d '"' -f 4 >"$folder/carom/digest" ||
    die "no digest"
  inside carom run circle --precision certified --digits 30 </dev/null >/dev/null || die "no certified run: it needs FLINT"
  inside bash -c 'gunzip -c /usr/share/man/man1/carom-escape.1.gz | grep -q "^.SH EXAMPLES"' || die "no man page"
  inside bash -c '. /usr/share/bash-completion/completions/carom && complete -p carom' >/dev/null || die "no completion"
  inside cp -r /usr/share/doc/carom/examples /carom/examples
}

use_python3_carom() {
  cat >"$folder/carom/three_lines.py" <<'PYTHON'
import carom
result = carom.escape("stadium", trajectories=10_000)
print(result, result.digest, sep="\n")
PYTHON
  inside python3 three_lines.py </dev/null | tee "$folder/carom/python_result"
  inside python3 -c 'import carom; carom.run("circle", precision="certified", digits=30)' || die "no certified run in Python"
  grep -qxF "$(cat "$folder/carom/digest")" "$folder/carom/python_result" || die "Python's digest is not that of the program"
}

use_libcarom_dev() {
  inside cmake -S examples -B examples/build >"$folder/carom/apt.log"
  inside cmake --build examples/build --parallel "$(nproc)"
  inside ctest --test-dir examples/build --output-on-failure --no-tests=error
}

make_debian
quiet_apt update
try carom
try python3-carom
quiet_apt install cmake g++ make
try libcarom-dev
