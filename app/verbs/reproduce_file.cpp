// SPDX-License-Identifier: BSD-3-Clause
// unfurl reproduce FILE: a picture, figure, film or page made again from the receipt in it.
#include "app/verbs/reproduce_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/output/command_line.hpp"
#include "app/output/output_directory.hpp"
#include "app/output/receipt.hpp"
#include "app/output/receipt_formats.hpp"
#include "app/output/written_files.hpp"
#include "app/own_options.hpp"
#include "core/export/formats.hpp"
#include "core/text/version.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "unfurl_reproduce_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw FileError(name, errno);
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path path;
};

// What makes this one file and no more of the directory than must be.
std::vector<std::string> only(const std::string& file, const std::string& verb) {
  const fs::path path = file;
  const std::string extension = path.extension().string(), stem = path.stem().string();
  std::vector<std::string> words;
  if (verb == "render" && path.parent_path() == "frames") {
    const int k = std::atoi(stem.substr(stem.find('_') + 1).c_str());
    return {"--frames", std::to_string(k) + ":" + std::to_string(k + 1)};
  }
  const bool page = stem == "viewer";
  // A share beside the results of the whole sweep, whose command makes none.
  if (const std::size_t of = stem.find("_of_");
      verb == "sweep" && extension == ".csv" && stem.starts_with("sweep_") && of != std::string::npos)
    return {"--shard", stem.substr(6, of - 6) + "/" + stem.substr(of + 4)};
  if (extension == ".glb" || page) words = {"--export", page ? "html" : "gltf"};
  // A film, and the report that shows it, need every frame.
  const bool film = stem == "report" || (stem == "animation" && extension != ".glb");
  if (verb == "render" && !film) words.insert(words.end(), {"--frames", "0:1"});
  return words;
}

// The directory of results around a file: the next one above it with a list of what unfurl wrote there.
std::optional<fs::path> results_with(const fs::path& absolute) {
  std::error_code error;
  for (fs::path folder = absolute.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder / WrittenFiles::list_name, error)) return folder;
  return std::nullopt;
}

// The receipt of a figure that the same command wrote into the directory: that with the table's own name,
// else any.
std::optional<Receipt> receipt_of_figure(const fs::path& folder, const WrittenFiles::Verdict& table,
                                         const std::vector<WrittenFiles::Verdict>& listed) {
  const std::string own_figure = fs::path(table.name).replace_extension(".svg").string();
  std::optional<Receipt> found;
  for (const WrittenFiles::Verdict& other : listed) {
    const bool own = other.name == own_figure;
    if (other.owner != table.owner || !other.name.ends_with(".svg") || (found && !own) ||
        other.kind != WrittenFiles::Verdict::same)
      continue;
    auto receipt = receipt_of(folder / other.name);
    if (receipt && !receipt->command.empty() && !receipt->file.empty()) found = std::move(receipt);
  }
  return found;
}

const ExportFormat* format_of(const std::string& name) {
  for (const ExportFormat& format : export_formats())
    if (name == format.result || name.starts_with(std::string(format.result) + "/")) return &format;
  return nullptr;
}

// What was exported is by its own format. Beside it, a run that was exported is kept whole, and sums over its
// motion differ in their last digits from those of one in parts: some format that it was exported to.
std::vector<std::string> export_of_run(const std::string& name,
                                       const std::vector<WrittenFiles::Verdict>& listed) {
  const ExportFormat* format = format_of(name);
  for (auto file = listed.begin(); !format && file != listed.end(); ++file)
    if (file->owner == "run") format = format_of(file->name);
  if (!format) return {};
  return {"--export", std::string(format->name)};
}

// Files for ParaView are named after their scene; nothing else tells its name.
std::string name_of_run(const std::vector<WrittenFiles::Verdict>& listed) {
  for (const WrittenFiles::Verdict& file : listed)
    if (const fs::path path = file.name; file.owner == "run" && path.extension() == ".pvd")
      return path.stem().string();
  return "scene";
}

// Tables, arrays and words carry no receipt themselves: a figure beside them does or, of a run, scene.toml
// says all.
Receipt receipt_beside(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (takes_note(extension) || extension == ".mp4")
    throw FileError(file,
                    damaged_receipt(file)
                        ? "its receipt is damaged: the file is not as it was written"
                        : "carries no receipt: it was not made by unfurl, or another program wrote it anew");
  const std::string none = "carries no receipt, as files of its kind do not, and ";
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error).lexically_normal();
  const auto folder = results_with(absolute);
  if (!folder) throw FileError(file, none + "lies in no directory of results (.unfurl) that has its command");
  const std::string name = absolute.lexically_relative(*folder).string();
  const auto listed = WrittenFiles::verify(*folder);
  const auto own = std::ranges::find(listed, name, &WrittenFiles::Verdict::name);
  if (own == listed.end())
    throw FileError(file, none + "is not in the list of what unfurl wrote there (.unfurl)");
  Receipt receipt;
  const bool table = extension == ".csv" && name.find('/') == std::string::npos;
  const bool words = extension == ".txt" || name == "margin.json";
  if (const auto figure =
          extension == ".csv" || words ? receipt_of_figure(*folder, *own, listed) : std::nullopt) {
    receipt = *figure;
  } else if (own->owner == "run" && (table || format_of(name))) {
    receipt.name = name_of_run(listed);
    receipt.command = {"run", word_of_scene(receipt.name)};
    for (const std::string& word : export_of_run(name, listed)) receipt.command.push_back(word);
    receipt.scene = bytes_of(*folder / "scene.toml");
  }
  if (receipt.command.empty())
    throw FileError(file, none +
                              "nothing beside it has its command; unfurl verify tells whether it is as "
                              "unfurl wrote it");
  receipt.file = name;
  return receipt;
}

void refuse_what_is_not_repeated(const fs::path& file, const Receipt& receipt) {
  const std::string made = "was made by " + command_in_words(receipt) + "; ";
  if (receipt.command.front() == from_python)
    throw FileError(file, made + "commands of the program are what can be repeated");
  if (receipt.command.front() == "view")
    throw FileError(file, made +
                              "the window shows how long things took, so that no picture of it is made "
                              "again to the byte: draw another with --picture");
}

// Formats that the command shall write, too.
void add_exports(const std::vector<std::string>& formats, std::vector<std::string>& words) {
  if (formats.empty()) return;
  if (words.front() != "run" && words.front() != "render")
    throw UsageError("--export is for what unfurl run or unfurl render has made; this is made by unfurl " +
                     words.front());
  for (const std::string& format : formats) words.insert(words.end(), {"--export", format});
}

}  // namespace

int reproduce_file(const Arguments& arguments) {
  if (!arguments.style.empty() || !arguments.font.empty() || arguments.dpi > 0 || arguments.study.validation)
    throw UsageError(
        "a file is made again as its receipt says: with its path, --style, --font, --dpi and --validation "
        "mean nothing");
  const fs::path file = arguments.names.front();
  auto receipt = receipt_of(file);
  if (!receipt || receipt->command.empty()) receipt = receipt_beside(file);
  refuse_what_is_not_repeated(file, *receipt);
  if (fs::path(receipt->name + ".toml").filename() != receipt->name + ".toml")
    throw FileError(file, "has a receipt that unfurl did not write, in which a scene's name is a path");
  if (!receipt->build.empty() && receipt->build != checksum_of_this_program())
    std::cerr << "unfurl: warning: made by another build (unfurl " << receipt->version
              << "); its bytes may differ\n";
  std::vector<std::string> words = receipt->command;
  add_exports(arguments.exports, words);
  const TemporaryFolder scratch;
  const fs::path into = arguments.output.empty() ? scratch.path / "out" : fs::path(arguments.output);
  if (!receipt->name.empty()) {
    const fs::path scene = scratch.path / (receipt->name + ".toml");
    write_file_atomically(scene, receipt->scene);
    const std::size_t at = place_of_first_name(words);
    if (at > 0 && words[at] == word_of_scene(receipt->name)) words[at] = scene.string();
  }
  const bool alone = receipt->file.empty();
  const fs::path made = into / (alone ? fs::path(file).filename() : fs::path(receipt->file));
  std::error_code error;
  if (alone) fs::create_directories(into, error);
  if (error) throw FileError(into, error.value());
  for (const std::string& word : only(receipt->file, words.front())) words.push_back(word);
  words.insert(words.end(), {"-o", (alone ? made : into).string(), "--quiet"});
  words.insert(words.begin(), fs::read_symlink("/proc/self/exe").string());
  ChildProcess again;
  if (const int trouble = again.start(words, {.input = -1, .output = -1, .error = 2}); trouble != 0)
    throw FileError(words.front(), trouble);
  const int code = again.wait().value_or(exit_internal);
  if (!fs::exists(made, error)) {
    std::cerr << "unfurl: could not be made again: " << as_typed(receipt->command) << " ended with " << code
              << "\n";
    return code == exit_ok ? exit_verification_failed : code;
  }
  const bool same = bytes_of(made) == bytes_of(file);
  const std::string where = arguments.output.empty() ? "" : ": " + made.string();
  if (same)
    std::cout << "the same, byte by byte" << where << "\n";
  else
    std::cerr << "unfurl: made again it differs from " << file.string() << where << "\n";
  return same ? exit_ok : exit_verification_failed;
}

}  // namespace unfurl
