// SPDX-License-Identifier: BSD-3-Clause
// CSV of nodes and rods, axes of sweeps, names of measures, changes written back into a file, and files of
// other programs: the first byte picks which.
#include "tests/fuzz/fuzz.hpp"

#include <algorithm>

#include "core/diagnostics/measures.hpp"
#include "core/scene/csv_table.hpp"
#include "core/scene/import_scene.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write_back.hpp"
#include "core/study/sweep.hpp"
#include "core/study/table.hpp"
#include "core/text/error.hpp"

using namespace unfurl;

namespace {

template <class Call>
void may_refuse(const Call& call) {
  try {
    call();
  } catch (const Error&) {
  }
}

}  // namespace

void unfurl::fuzz::try_text(std::string_view text) {
  static const std::vector<CsvColumn> columns = {
      {"name", "", false, true}, {"x", "m", true, true}, {"vx", "m_s", true}, {"mass", "kg", true}};
  if (text.empty() || text.size() > 8000) return;
  const char which = text[0];
  text.remove_prefix(1);
  if (which % 4 == 0) {
    SceneNotes notes;
    read_csv(text, "fuzz.csv", columns, notes);
    csv_records(text);
    const std::string key(text.substr(0, text.size() / 2)), value(text.substr(text.size() / 2));
    const std::vector<std::vector<std::string>> rows = {{key, value}, {value, key}};
    require(csv_records(csv_line(rows[0]) + csv_line(rows[1])) == rows,
            "cells read back as they were written");
  } else if (which % 4 == 1) {
    may_refuse([&] { parse_axis(std::string(text)); });
    may_refuse([&] { parse_shard(std::string(text)); });
    may_refuse([&] { find_measure(std::string(text)); });
  } else if (which % 4 == 3) {
    // The first line is the ending of the name; the second list of CSV is behind a blank line.
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string file = "fuzz." + std::string(text.substr(0, end));
    if (import_format(file).empty()) return;
    const std::size_t blank = std::min(text.find("\n\n"), text.size());
    const std::string all(text.substr(end)), second(text.substr(blank));
    may_refuse([&] {
      import_scene({{file, file == "fuzz.csv" ? all.substr(0, blank - end) : all, ""}, {file, second, ""}});
    });
  } else if (const auto end = text.find('\n'); end != text.npos) {
    may_refuse([&] {
      const auto back = write_back(text.substr(end + 1), "fuzz.toml", {std::string(text.substr(0, end))}, "");
      read_scene_text(back.text, "fuzz.toml");
    });
  }
}
