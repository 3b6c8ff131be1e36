#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Installs a build into a scratch prefix, moves that elsewhere, and builds assets/examples/client against it by CMake and by
# pkg-config: what a user of the library does. Nothing installed may name the source or build tree.
#   tests/support/check_client.sh BUILD_DIRECTORY SOURCE_DIRECTORY
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
say() { echo "client: $*"; }

cmake --install "$build" --prefix "$work/first" >"$work/install.log"
mv "$work/first" "$work/prefix"  # a prefix can be moved
if grep -rlaF -e "$source/" -e "$build/" "$work/prefix"; then say "the files above name the tree they were built in"; exit 1; fi
for private in structures/hoop.hpp math/saddle_solver.hpp; do
  [ ! -e "$work/prefix/include/unfurl/$private" ] || { say "$private should be private"; exit 1; }
done
desktop-file-validate "$work/prefix/share/applications/unfurl.desktop"
appstreamcli validate --no-net "$work/prefix/share/metainfo/io.unfurl.Unfurl.metainfo.xml" >"$work/log" || { cat "$work/log"; exit 1; }
for listed in man/man1/unfurl.1 bash-completion/completions/unfurl zsh/vendor-completions/_unfurl \
    fish/vendor_completions.d/unfurl.fish icons/hicolor/scalable/apps/unfurl.svg; do
  [ -s "$work/prefix/share/$listed" ] || { say "share/$listed is not installed"; exit 1; }
done
say "desktop entry, AppStream, manual page, completions, icon: installed and valid"
cp -r "$source/assets/examples/client" "$work/client"

cmake -S "$work/client" -B "$work/by_cmake" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release >"$work/log" || { cat "$work/log"; exit 1; }
cmake --build "$work/by_cmake" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
export UNFURL_ASSETS="$work/prefix/share/unfurl"
"$work/by_cmake/client" >"$work/by_cmake.txt"
grep -q '^deployed at ' "$work/by_cmake.txt" || { cat "$work/by_cmake.txt"; exit 1; }
say "find_package: $(grep '^deployed' "$work/by_cmake.txt")"

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name unfurl.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
c++ -O1 "$work/client/client.cpp" -o "$work/by_pkg" $(pkg-config --cflags --libs unfurl)
"$work/by_pkg" >"$work/by_pkg.txt"
cmp "$work/by_cmake.txt" "$work/by_pkg.txt"
say "pkg-config: the same output"

# As a part of another project, the solver alone: needs neither a test library nor anything that draws.
mkdir "$work/outer"
cat >"$work/outer/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
set(UNFURL_CORE_ONLY ON)
add_subdirectory($source unfurl)
add_executable(outer outer.cpp)
target_link_libraries(outer PRIVATE unfurl::core)
END
echo '#include <unfurl/simulate/stepper.hpp>
int main() {}' >"$work/outer/outer.cpp"
cmake -S "$work/outer" -B "$work/outer/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
for wanted in imgui CLI11 GIF SDL2 Catch2; do
  if grep -qi "^${wanted}_DIR\|${wanted}_FOUND" "$work/outer/build/CMakeCache.txt"; then say "the core alone looks for $wanted"; exit 1; fi
done
say "add_subdirectory: configured, $(grep -c . "$work/outer/build/CMakeCache.txt") cache lines, no drawing library"
