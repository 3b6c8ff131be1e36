// SPDX-License-Identifier: BSD-3-Clause
// A journal that something else wrote or cut: refused, or read; what is appended is found by the next.
#include "tests/fuzz/fuzz.hpp"

#include "core/study/journal.hpp"

using namespace unfurl;

void unfurl::fuzz::try_text(std::string_view text) {
  if (text.size() > 8000) return;
  const ScratchFile file("journal.csv", text);
  const std::vector<std::string> columns = {"a", "b", "c"}, row = {"1", "2", "3"};
  try {
    {
      Journal journal(file.path(), columns, 2);
      journal.append(row);
    }
    const Journal again(file.path(), columns, 2);
    const auto* found = again.find({"1", "2"});
    require(found != nullptr && *found == row, "a journal keeps what was appended");
  } catch (const JournalMismatch&) {
  }
}
