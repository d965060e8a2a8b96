# ./dev bare --libcxx: clang with libc++, as on a Mac, in a minimal Debian: warnings are errors, and every test runs.
declare -A clang_of=([12]=16 [13]=19)
clang=${clang_of[$debian]}
eval "$(packages_of_dev)"

say "./dev setup, clang-$clang"
inside ./dev setup </dev/null
inside env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "clang-$clang" "libc++-$clang-dev" \
  "libc++abi-$clang-dev" "libomp-$clang-dev" libfast-float-dev googletest "${python_packages[@]}" "${python_test_packages[@]}" \
  </dev/null >"$folder/carom/apt.log" 2>&1 || { tail -n 30 "$folder/carom/apt.log" >&2; die "apt-get failed"; }
say "building with clang-$clang and libc++"
inside cmake -S . -B build/libcxx -G Ninja -DCMAKE_C_COMPILER="clang-$clang" -DCMAKE_CXX_COMPILER="clang++-$clang" \
  -DCMAKE_CXX_FLAGS=-stdlib=libc++ -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" \
  -DCAROM_WARNINGS_AS_ERRORS=ON -DCAROM_BUILD_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3 </dev/null >&2
inside cmake --build build/libcxx </dev/null >&2
inside build/libcxx/carom escape magnetic-square </dev/null
if [[ $what == tests ]]; then
  inside ctest --test-dir build/libcxx --output-on-failure --parallel "$(nproc)" --label-exclude soak </dev/null
  say "all tests passed; $SECONDS s"
fi
