# ./dev bare --arch arm64: a cross build against an arm64 Debian in FOLDER/root, run by qemu-user. Nothing of that Debian
# is run to make it, so the kernel need not know of qemu. A FOLDER that was kept is gone on with.
cross_packages=(cmake debootstrap g++-aarch64-linux-gnu help2man ninja-build python3 qemu-user-static)
eval "$(packages_of_dev)"
arm=$(realpath -m "$folder/root")
made=$(realpath -m "$folder/build")

say "./dev build: digests are compared with build/release"
"$root/dev" run --version </dev/null >&2
missing=()
for package in "${cross_packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] || apt-get install -y --no-install-recommends "${missing[@]}" </dev/null >&2
make_arm() {
  local there=(libflint-arb-dev) package link target
  find_mirror
  mkdir -p "$folder"
  say "an arm64 Debian in $arm"
  for package in "${build_packages[@]}" "${python_packages[@]}"; do
    case $package in
      ca-certificates | cmake | g++ | help2man | ninja-build | *mpi* | python3-dev) ;;
      *) there+=("$package") ;;
    esac
  done
  there+=(libpython3-dev libstdc++-12-dev python3-pytest)
  debootstrap --arch=arm64 --foreign --variant=minbase --include="$(IFS=,; echo "${there[*]}")" "$release" "$arm" "$mirror" \
    >"$folder/debootstrap.log" 2>&1 || { tail -n 20 "$folder/debootstrap.log" >&2; die "debootstrap failed"; }
  for package in "$arm"/var/cache/apt/archives/*.deb; do dpkg -x "$package" "$arm"; done
  # Links to /… would lead out of the folder.
  find "$arm" -xdev -type l -lname '/*' ! -path "$arm/dev/*" -printf '%p\t%l\n' |
    while IFS=$'\t' read -r link target; do ln -sfnr "$arm$target" "$link"; done
}
[[ -d $arm/usr ]] || make_arm

emulator="qemu-aarch64-static -L $arm"
mkdir -p "$made/emulated"
# What Debian chooses among when it is installed, libraries of linear algebra, has no name yet.
cat >"$made/emulated/python3" <<PYTHON
#!/bin/sh
exec $emulator -E LD_LIBRARY_PATH=\${LD_LIBRARY_PATH:+\$LD_LIBRARY_PATH:}/usr/lib/aarch64-linux-gnu/blas:/usr/lib/aarch64-linux-gnu/lapack \
  $arm/usr/bin/python3 "\$@"
PYTHON
chmod +x "$made/emulated/python3"

say "building for arm64"
cmake -S "$root" -B "$made" -G Ninja --toolchain "$root/cmake/aarch64.cmake" -DCAROM_ROOT="$arm" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DCAROM_USE_MPI=OFF -DCAROM_WARNINGS_AS_ERRORS=ON -DCAROM_BUILD_PYTHON=ON \
  -DPython_EXECUTABLE="$made/emulated/python3" -DCAROM_BUILD_BENCHMARKS=OFF </dev/null >&2
cmake --build "$made" --target carom_program carom_python man_pages --parallel "$(nproc)" </dev/null >&2

say "digests"
"$root/tests/same_bits.sh" "$root/build/release/carom" "$made/emulated/carom"
say "the Python module"
digest='import carom; print(carom.escape("stadium", trajectories=10_000).digest)'
PYTHONPATH=$made/python "$made/emulated/python3" -c "$digest" >"$folder/digest"
"$root/dev" python -c "$digest" | diff - "$folder/digest"
say "a tarball with its libraries, which runs without the Debian beside it"
"$root/cmake/bundle.sh" "$made" "$folder/packages" >&2
tar -xzf "$folder"/packages/carom-*.tar.gz -C "$folder/packages"
lib=$(echo "$folder"/packages/carom-*/lib)
qemu-aarch64-static "$lib/ld-linux-aarch64.so.1" --library-path "$lib" "$lib/carom" \
  escape stadium --trajectories 1e4 --json --quiet </dev/null | grep -F "$(cat "$folder/digest")" >&2 || die "another digest"
if [[ $what == tests ]]; then
  say "carom validate"
  "$made/emulated/carom" validate </dev/null
  say "the tests"
  cmake --build "$made" --parallel "$(nproc)" </dev/null >&2
  ctest --test-dir "$made" --output-on-failure --parallel "$(nproc)" --label-exclude soak </dev/null
fi
say "all is well; $SECONDS s"
