#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pages of ./dev docs and asks that doxygen has nothing to say against the comments, and that every public header
# and what a client begins with have a page.
#   tests/support/check_docs.sh BUILD_DIRECTORY SOURCE_DIRECTORY
set -eu
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source"
{ cat docs/Doxyfile; printf '%s\n' "OUTPUT_DIRECTORY=$work" "INPUT=$build/include/unfurl docs/library.md" \
  "STRIP_FROM_PATH=$build/include" "STRIP_FROM_INC_PATH=$build/include"; } | doxygen - >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
for name in Stepper Simulation Trajectory Structure Scene System Diagnostics Error; do
  ls "$work"/html/*"unfurl_1_1$name.html" >/dev/null || { echo "docs: $name has no page"; exit 1; }
done
for header in $(cd "$build/include/unfurl" && find . -name '*.hpp' | sed 's|.*/||; s|\.hpp$||'); do
  page=$(echo "$header" | sed 's/_/__/g')
  ls "$work"/html/"${page}_8hpp.html" >/dev/null 2>&1 || { echo "docs: $header.hpp has no page"; exit 1; }
done
grep -q "find_package(unfurl" "$work/html/index.html" || { echo "docs: the main page does not say how to link"; exit 1; }
echo "docs: $(find "$work/html" -name '*_8hpp.html' | wc -l) headers, no warning"
