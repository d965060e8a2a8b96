#!/usr/bin/env bash
# Makes what runs without a compiler and without any of the libraries: from a build (with CAROM_BUILD_PYTHON), a
# tarball of the program for any Linux, with its libraries, the C library and the loader; and a Python wheel. Of a cross
# build (cmake/aarch64.cmake), the tarball alone.
#   cmake/bundle.sh BUILD TARGET      packages land in the folder TARGET
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath "$1")
target=$(realpath -m "$2")
version=$(sed -n 's/^project(carom VERSION \([^ ]*\).*/\1/p' "$source/CMakeLists.txt")
machine=$(uname -m)
tools=
root=$(sed -n 's/^CAROM_ROOT:[A-Z]*=//p' "$build/CMakeCache.txt")
if [[ -n $root ]]; then
  machine=aarch64
  tools=$machine-linux-gnu-
fi
late=$(sed -n 's/^CAROM_LATE_FLINT:[A-Z]*=//p' "$build/CMakeCache.txt")  # opened while a program runs
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$target"

# What the loader says that a program is loaded with.
loaded_with() {
  if [[ -z $root ]]; then ldd "$1"; else qemu-aarch64-static -L "$root" "$root/lib/ld-linux-aarch64.so.1" --list "$1"; fi
}

# A file of this system, or of the one that is built for.
where_is() { if [[ -e $root$1 ]]; then echo "$root$1"; else echo "$1"; fi; }

# Shared libraries of a program, one path a line, those that it opens late too; without the kernel's and the loader.
libraries_of() {
  local library
  [[ -z $late ]] || echo "$late"
  { loaded_with "$1"; [[ -z $late ]] || loaded_with "$late"; } | sed -n 's/.*=> \(\/[^ ]*\) .*/\1/p' | grep -v '/ld-linux' |
    while read -r library; do where_is "$library"; done
}

# HDF5 of Debian can read archives in the cloud, which takes thirty libraries with it. Carom never does: what HDF5
# asks of two of them is answered by functions that refuse.
no_cloud() {
  local hdf5=$1 folder=$2 library names
  for library in libcurl.so.4:CURL_OPENSSL_4 libcrypto.so.3:OPENSSL_3.0.0; do
    names=$("${tools}nm" -D --undefined-only "$hdf5" | sed -n "s/.* U \(.*\)@${library#*:}\$/\1/p")
    [[ -n $names ]] || continue
    printf 'void* %s(void) { return 0; }\n' $names >"$work/none.c"
    printf '%s { global: *; };\n' "${library#*:}" >"$work/none.map"
    "${tools}gcc" -shared -fPIC -O2 -fno-builtin -w -Wl,-soname,"${library%:*}" -Wl,--version-script="$work/none.map" \
      "$work/none.c" -o "$folder/${library%:*}"
  done
}

# Copies the libraries that a program needs into a folder, except those named after it.
collect() {
  local program=$1 folder=$2 library name hdf5
  shift 2
  mkdir -p "$folder"
  hdf5=$(libraries_of "$program" | grep -m 1 hdf5 || true)  # programs hold it themselves (archives.cmake)
  [[ -z $hdf5 ]] || no_cloud "$hdf5" "$folder"
  # What is needed is found anew with the folder's own libraries in place: what only others needed stays behind.
  for library in $(LD_LIBRARY_PATH=$folder libraries_of "$program"); do
    name=$(basename "$library")
    [[ -e $folder/$name || " $* " == *" $name "* ]] && continue
    cp -L "$library" "$folder/$name"
    "${tools}strip" --strip-unneeded "$folder/$name"
  done
}

# The licences of what a folder of libraries holds, and of further ones: Debian's files of the packages that they come from.
licences() {
  local folder=$1 library package
  shift
  mkdir -p "$folder/licences"
  for library in $(ls "$folder" | grep -vE "libc(url|rypto)\.") "$@"; do
    package=$(dpkg-query -S "*/$(gcc -print-multiarch)/$library" 2>/dev/null | sed -n '1s/:.*//p') || true
    [[ -z $package ]] || cp -L "$root/usr/share/doc/$package/copyright" "$folder/licences/$package"
  done
}

# The page, where ./dev page has made it.
page_into() {
  [[ ! -e $source/build/page/carom.html ]] || install -D -m 644 "$source/build/page/carom.html" "$1/carom.html"
}

tarball() {
  local name=carom-$version-$machine-linux folder loader
  folder=$work/$name
  collect "$build/carom" "$folder/lib"
  loader=$(loaded_with "$build/carom" | sed -n 's/.* => //; s/^[[:space:]]*\(\/[^ ]*ld-[^ ]*\) .*/\1/p')
  cp -L "$(where_is "$loader")" "$folder/lib/"
  cp "$build/carom" "$folder/lib/carom"
  "${tools}strip" "$folder/lib/carom"
  cat >"$folder/carom" <<LAUNCHER
#!/bin/sh
# Starts lib/carom with the C library and the libraries beside it.
here=\$(dirname "\$(readlink -f "\$0")")
exec "\$here/lib/$(basename "$loader")" --argv0 carom --library-path "\$here/lib" "\$here/lib/carom" "\$@"
LAUNCHER
  chmod +x "$folder/carom"
  cp "$source/LICENSE" "$source/README.md" "$source/CHANGELOG.md" "$folder"
  cp -r "$source/examples" "$folder/examples"
  page_into "$folder/share/carom"
  mkdir "$folder/man"
  cp "$build"/man/*.1 "$folder/man"
  [[ ! -d $source/build/docs/html ]] || cp -r "$source/build/docs/html" "$folder/docs"
  [[ ! -e $folder/docs/carom.html ]] || ln -f "$folder/share/carom/carom.html" "$folder/docs/carom.html"  # once in the tarball
  licences "$folder/lib" libhdf5_serial.a libgsl.a libsundials_cvode.a libz.a libaec.a  # archives.cmake
  tar -C "$work" --owner=0 --group=0 --sort=name -cf - "$name" | gzip -9n >"$target/$name.tar.gz"
}

# Gives the libraries of a folder names of their own, as other modules of a Python may bring others of the same name.
private() {
  local folder=$1 module=$2 names name file
  names=$(ls "$folder" | grep '\.so')
  for name in $names; do
    mv "$folder/$name" "$folder/carom_$name"
    patchelf --set-soname "carom_$name" "$folder/carom_$name"
  done
  for file in "$module" "$folder"/carom_*; do
    for name in $names; do  # one by one: several at once confuse patchelf 0.14
      readelf -d "$file" | grep -qF "[$name]" && patchelf --replace-needed "$name" "carom_$name" "$file"
    done
    patchelf --set-rpath '$ORIGIN' "$file"
  done
  patchelf --set-rpath '$ORIGIN/lib' "$module"
}

# Needs the C library of the system that it was made on, or a newer one: the tag says so.
wheel() {
  local python folder=$work/wheel tag glibc module name
  python=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  mkdir -p "$folder/carom"
  cp "$build"/python/carom/*.py "$build"/python/carom/*.pyi "$build"/python/carom/*.so "$build/python/carom/py.typed" "$folder/carom"
  module=$(echo "$folder"/carom/_carom*.so)
  strip "$module"
  page_into "$folder/carom"
  collect "$module" "$folder/carom/lib" libc.so.6 libm.so.6 libgcc_s.so.1 libstdc++.so.6 libpthread.so.0 libdl.so.2 libresolv.so.2 librt.so.1
  licences "$folder/carom/lib"
  private "$folder/carom/lib" "$module"
  glibc=$(objdump -T "$module" "$folder"/carom/lib/*.so* | sed -n 's/.*GLIBC_2\.\([0-9]*\).*/\1/p' | sort -n | tail -n 1)
  tag=$python-$python-manylinux_2_${glibc}_$machine
  /usr/bin/python3 "$source/cmake/wheel.py" "$folder" "$target" "$version" "$tag" "$source"
}

case ${3-both} in
  tarball) tarball ;;
  wheel) wheel ;;
  *) tarball; [[ -n $root ]] || wheel ;;
esac
