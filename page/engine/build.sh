#!/usr/bin/env bash
# Makes the engine as WebAssembly, build/page/carom.mjs and carom.wasm, and of it the page, build/page/carom.html.
# ./dev page calls it, with the packages of Debian 12 installed.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
build=$root/build/page
libraries=$build/libraries
jobs=$(nproc)
export NODE_PATH=/usr/share/nodejs  # where emscripten's modules are: a Node of other origin does not look there

# Downloads the source packages of GMP and MPFR by a list of their own, from where this machine has its packages.
fetch() {
  local apt=$libraries/apt suite mirror
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $suite" | sort -u | head -1)
  mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$apt/list"
  local ours=(-o "Dir::Etc::sourcelist=$apt/list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$apt/lists" -o "Dir::Cache=$apt/cache")
  apt-get "${ours[@]}" update
  (cd "$libraries" && apt-get "${ours[@]}" source --download-only gmp mpfr4)
  rm -rf "$apt"
  for name in gmp mpfr; do
    rm -rf "${libraries:?}/$name"
    mkdir "$libraries/$name"
    tar -xf "$libraries/$name"*.orig.tar.* -C "$libraries/$name" --strip-components=1
  done
}

# Without assembly, and without printing, which asks for a header that emscripten has not.
make_gmp() {
  local flags="-target wasm32-unknown-emscripten --sysroot=/usr/share/emscripten/cache/sysroot -O2"
  mkdir -p "$libraries/gmp/build" "$libraries/gmp/doc"
  touch "$libraries/gmp/doc/Makefile.in"  # Debian's source is without the manual
  cd "$libraries/gmp/build"
  CC_FOR_BUILD=gcc CC="clang-14 $flags" AR=llvm-ar-14 NM=llvm-nm-14 RANLIB=llvm-ranlib-14 \
    LDFLAGS="-nostdlib -Wl,--no-entry,--allow-undefined" ac_cv_func_obstack_vprintf=no \
    ../configure --host=none --disable-assembly --disable-shared
  make -j"$jobs" all SUBDIRS="mpn mpz mpq mpf printf scanf rand ."
}

mkdir -p "$libraries"
[[ -e $libraries/mpfr/src ]] || fetch
[[ -e $libraries/gmp/build/.libs/libgmp.a ]] || (make_gmp)
cmake -S "$root/page/engine" -B "$build/engine" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/page/engine/wasm.cmake" \
  -DCAROM_LIBRARIES="$libraries"
cmake --build "$build/engine" --parallel "$jobs"
cp "$build/engine/carom.mjs" "$build/engine/carom.wasm" "$build"

[[ -e $root/page/app/bundle.mjs ]] || exit 0
[[ -e $root/page/node_modules ]] || npm ci --prefix "$root/page"
node "$root/page/app/bundle.mjs" "$build/carom.mjs" "$build/carom.wasm" "$build/carom.html"
