// SPDX-License-Identifier: BSD-3-Clause
// unfurl reproduce FILE: a picture, figure, film or page made again from the receipt in it.
#include "app/verbs/reproduce_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "app/output/command_line.hpp"
#include "app/output/output_directory.hpp"
#include "app/output/receipt.hpp"
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
  if (extension == ".glb" || page) words = {"--export", page ? "html" : "gltf"};
  // A film, and the report that shows it, need every frame.
  const bool film = stem == "report" || (stem == "animation" && extension != ".glb");
  if (verb == "render" && !film) words.insert(words.end(), {"--frames", "0:1"});
  return words;
}

}  // namespace

int reproduce_file(const Arguments& arguments) {
  if (!arguments.style.empty() || !arguments.font.empty() || arguments.dpi > 0 || arguments.study.validation)
    throw UsageError(
        "a file is made again as its receipt says: with its path, --style, --font, --dpi and --validation "
        "mean nothing");
  const fs::path file = arguments.names.front();
  const auto receipt = receipt_of(file);
  if (!receipt || receipt->command.empty())
    throw FileError(file, "carries no receipt: it was not made by unfurl, or another program wrote it anew");
  if (receipt->build != checksum_of_this_program())
    std::cerr << "unfurl: warning: made by another build (unfurl " << receipt->version
              << "); its bytes may differ\n";
  const TemporaryFolder scratch;
  const fs::path into = arguments.output.empty() ? scratch.path / "out" : fs::path(arguments.output);
  std::vector<std::string> words = receipt->command;
  if (!receipt->name.empty()) {
    const fs::path scene = scratch.path / (receipt->name + ".toml");
    write_file_atomically(scene, receipt->scene);
    for (std::string& word : words)
      if (word == receipt->name) {
        word = scene.string();
        break;
      }
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
