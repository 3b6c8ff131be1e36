// SPDX-License-Identifier: BSD-3-Clause
// unfurl verify PATH: are results still what was written?
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/output/command_line.hpp"
#include "app/output/receipt.hpp"
#include "app/output/written_files.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

std::optional<fs::path> results_above(const fs::path& absolute) {
  std::error_code error;
  for (fs::path folder = absolute; folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder / WrittenFiles::list_name, error)) return folder;
  return std::nullopt;
}

bool in_results(const fs::path& path) {
  std::error_code error;
  return results_above(fs::absolute(path, error).lexically_normal()).has_value();
}

// The directory of results that a path lies in: itself or one above it.
fs::path results_around(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error).lexically_normal();
  if (!fs::exists(fs::symlink_status(absolute, error))) throw FileError(path, "there is no such file");
  if (const auto folder = results_above(absolute)) return *folder;
  throw FileError(path,
                  "lies in no directory of results: none above it has a list of what unfurl wrote (.unfurl)");
}

using Json = nlohmann::ordered_json;

// A file that went where no list of results is: by the receipt in it.
int verify_by_receipt(const fs::path& file, bool json) {
  const auto receipt = receipt_of(file);
  if (!receipt && !damaged_receipt(file))
    throw FileError(
        file,
        "lies in no directory of results (none above it has a list of what unfurl wrote, .unfurl) "
        "and carries no receipt");
  const bool same = receipt && as_written(file);
  if (json) {
    Json said{{"as_written", same}, {"files", 1}};
    if (receipt) said["unfurl"] = receipt->version, said["command"] = command_in_words(*receipt);
    std::cout << said.dump(2) << "\n";
  }
  if (!same) {
    if (!json) std::cout << "changed: " << file.string() << "\n";
    std::cerr << "unfurl: the file is not as it was written"
              << (receipt ? "\n" : ": its receipt is damaged\n");
    return exit_verification_failed;
  }
  if (!json)
    std::cout << "1 file as written by unfurl " << receipt->version << ": " << command_in_words(*receipt)
              << "\n";
  return exit_ok;
}

// What is not as it was on standard output, a line each or as JSON.
int tell_of_files(const std::vector<WrittenFiles::Verdict>& verdicts, bool json) {
  using K = WrittenFiles::Verdict;
  std::size_t open = 0;
  std::vector<std::string> changed, missing, earlier;
  for (const WrittenFiles::Verdict& verdict : verdicts) {
    open += verdict.kind == K::growing;
    if (verdict.kind == K::changed) changed.push_back(verdict.name);
    if (verdict.kind == K::missing) missing.push_back(verdict.name);
    if (verdict.kind == K::earlier) earlier.push_back(verdict.name);
    if (json) continue;
    if (verdict.kind == K::changed) std::cout << "changed: " << verdict.name << "\n";
    if (verdict.kind == K::missing) std::cout << "missing: " << verdict.name << "\n";
    if (verdict.kind == K::earlier)
      std::cout << "earlier: " << verdict.name
                << " is as an earlier command wrote it, not as the last one did\n";
  }
  const std::size_t bad = changed.size() + missing.size() + earlier.size();
  const std::string count = std::to_string(verdicts.size()) + (verdicts.size() == 1 ? " file" : " files");
  if (json)
    std::cout << Json{{"as_written", bad == 0}, {"files", verdicts.size()}, {"growing", open},
                      {"changed", changed},     {"missing", missing},       {"earlier", earlier}}
                     .dump(2)
              << "\n";
  if (bad > 0) {
    std::cerr << "unfurl: " << bad << " of " << count << " are not as they were written\n";
    return exit_verification_failed;
  }
  if (!json)
    std::cout << count << " as written"
              << (open > 0 ? ", " + std::to_string(open) + " of them of growing content" : "") << "\n";
  return exit_ok;
}

}  // namespace

int cmd_verify(const Arguments& arguments) {
  std::error_code ignored;
  if (fs::is_regular_file(arguments.names.front(), ignored) && !in_results(arguments.names.front()))
    return verify_by_receipt(arguments.names.front(), arguments.json);
  const fs::path path = arguments.names.front(), directory = results_around(path);
  auto verdicts = WrittenFiles::verify(directory);
  std::error_code error;
  std::string inside = fs::absolute(path, error).lexically_normal().lexically_relative(directory).string();
  while (inside.ends_with('/')) inside.pop_back();
  if (inside != ".") {
    std::erase_if(verdicts, [&](const WrittenFiles::Verdict& v) {
      return v.name != inside && !v.name.starts_with(inside + "/");
    });
    // A figure that somebody put beside the results says itself what it is.
    if (verdicts.empty() && fs::is_regular_file(path, error) && receipt_of(path))
      return verify_by_receipt(path, arguments.json);
    if (verdicts.empty()) throw FileError(path, "is not in the list of what unfurl wrote there");
  }
  return tell_of_files(verdicts, arguments.json);
}

}  // namespace unfurl
