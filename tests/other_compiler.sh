#!/usr/bin/env bash
# Builds the program with clang++ into build/clang and compares its digests with the release build's.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake -G Ninja -S . -B build/clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DBUILD_TESTING=OFF \
  -DCAROM_BUILD_BENCHMARKS=OFF >&2
cmake --build build/clang --target carom_program >&2
CAROM_OTHER_PROGRAM=$PWD/build/clang/carom build/release/tests/test_cli --gtest_filter='SameBits.*'
