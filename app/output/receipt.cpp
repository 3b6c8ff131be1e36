// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/receipt.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/output/command_line.hpp"
#include "app/output/json_text.hpp"
#include "app/output/receipt_formats.hpp"
#include "core/export/checksum.hpp"
#include "core/scene/text_file.hpp"
#include "core/text/version.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

struct Shown {
  std::mutex mutex;
  std::string name, scene;
  SceneOptions options = SceneOptions::in_text;
  std::map<std::string, double> errors;
};
Shown& shown() {
  static Shown shown;
  return shown;
}

// The program or, loaded into another one (Python's), the module.
std::string file_of_this_code() {
  Dl_info found{};
  const bool module = ::dladdr(static_cast<const void*>(&shown().mutex), &found) != 0 &&
                      found.dli_fname != nullptr && fs::path(found.dli_fname).extension() == ".so";
  return module ? found.dli_fname : "/proc/self/exe";
}

// Without the characters that mean something in XML and HTML.
std::string plain(const std::string& json) {
  std::string text;
  for (const char c : json)
    text += c == '<' ? "\\u003c" : c == '>' ? "\\u003e" : c == '&' ? "\\u0026" : std::string(1, c);
  return text;
}

}  // namespace

std::string checksum_of_this_program() {
  static const std::string sum = [] {
    Checksum build;
    build.add(read_text_file(file_of_this_code()).text);
    return build.text();
  }();
  return sum;
}

std::string word_of_scene(const std::string& name) {
  return (name.starts_with('-') ? "./" : "") + name;
}

std::vector<std::string> command_of_result(std::vector<std::string> kept, std::size_t scene_at,
                                           const std::string& scene_name, SceneOptions options) {
  if (scene_at > 0 && !scene_name.empty()) kept.at(scene_at) = word_of_scene(scene_name);
  for (const char* option : {"-o", "--output", "--frames", "--lease", "--shard", "--merge", "--threads",
                             "--export", "--script", "--jobs", "--picture"})
    kept = without_option(kept, option);
  std::erase_if(kept, [](const std::string& word) {
    return word == "--join" || word == "--quiet" || word == "--json" || word == "--force" ||
           word == "--encode-only";
  });
  if (options == SceneOptions::in_command) return kept;
  for (const char* option : {"--set", "--tolerance", "--size", "--fps", "--look", "--supersample"})
    kept = without_option(kept, option);
  std::erase(kept, "--transparent");
  return kept;
}

void receipt_scene(const std::string& name, const std::string& text, SceneOptions options) {
  const std::lock_guard lock(shown().mutex);
  shown().name = name;
  shown().scene = text;
  shown().options = options;
}

void receipt_errors(std::map<std::string, double> errors) {
  const std::lock_guard lock(shown().mutex);
  shown().errors = std::move(errors);
}

ReceiptWriter::ReceiptWriter(std::vector<std::string> words, std::size_t scene_at, std::string output)
    : words_(std::move(words)), scene_at_(scene_at), output_(fs::path(std::move(output)).lexically_normal()) {
  before_ = finish_files(this);
}

ReceiptWriter::~ReceiptWriter() {
  finish_files(before_);
}

std::string ReceiptWriter::note(const fs::path& target) {
  const std::lock_guard lock(shown().mutex);
  const fs::path inside = target.lexically_normal().lexically_relative(output_);
  Checksum scene;
  scene.add(shown().scene);
  nlohmann::ordered_json json = {
      {"unfurl", version()},
      {"build", checksum_of_this_program()},
      {"command", command_of_result(words_, scene_at_, shown().name, shown().options)}};
  if (!shown().name.empty()) json["name"] = shown().name;
  if (inside != "." && !inside.empty() && *inside.begin() != "..") json["file"] = inside.string();
  if (!shown().scene.empty()) json["scene_hash"] = scene.text(), json["scene"] = shown().scene;
  for (const auto& [name, value] : shown().errors)
    if (std::isfinite(value)) json["errors"][name] = value;
  const std::string text = plain(json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  return std::string(note_begin) + std::string(checksum_digits, '0') + "\"," + text.substr(1);
}

bool ReceiptWriter::finish(const fs::path& temporary, const fs::path& target) {
  const std::string extension = target.extension().string();
  if (!takes_note(extension)) return false;
  TextFile read = read_result_file(temporary.string());
  if (!read.error.empty()) return false;  // no longer there: whoever wanted it is told
  std::string file = std::move(read.text);
  if (extension != ".mp4") file = with_note(std::move(file), extension, note(target));
  file = sealed(std::move(file), extension);
  replace_bytes(temporary, file);
  return true;
}

std::string command_in_words(const Receipt& receipt) {
  const std::vector<std::string>& words = receipt.command;
  if (words.size() < 3 || words[0] != from_python) return as_typed(words);
  return "Python, " + words[1] + ": " + words[2];
}

std::string bytes_of(const fs::path& file) {
  TextFile text = read_result_file(file.string());
  if (!text.error.empty()) throw FileError(file, text.error);
  return std::move(text.text);
}

std::optional<Receipt> receipt_of(const fs::path& file) {
  const std::string note = note_in(bytes_of(file), file.extension().string());
  const auto json = nlohmann::json::parse(note, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Receipt receipt{text_in(json, "unfurl"), text_in(json, "build"), {}, text_in(json, "name"),
                  text_in(json, "file"),   text_in(json, "scene"), {}};
  if (const auto words = json.find("command"); words != json.end() && words->is_array())
    for (const auto& word : *words)
      if (word.is_string()) receipt.command.push_back(word);
  if (const auto errors = json.find("errors"); errors != json.end() && errors->is_object())
    for (const auto& [name, value] : errors->items())
      if (value.is_number()) receipt.errors[name] = value;
  return receipt;
}

bool damaged_receipt(const fs::path& file) {
  const std::string bytes = bytes_of(file);
  const std::size_t half = note_begin.size() / 2;  // one of which one damage leaves as it was
  return bytes.find(note_begin.substr(0, half)) != bytes.npos ||
         bytes.find(note_begin.substr(half)) != bytes.npos;
}

bool as_written(const fs::path& file) {
  std::string bytes = bytes_of(file);
  return sealed(bytes, file.extension().string()) == bytes;
}

}  // namespace unfurl
