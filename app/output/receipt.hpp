// SPDX-License-Identifier: BSD-3-Clause
// What a picture, figure, film or page says of its origin: the program, the command, the scene, the errors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/export/atomic_file.hpp"

namespace unfurl {

// What was read from a file.
struct Receipt {
  std::string version, build;  // of the program; the build is the checksum of its executable
  // Verb, scene, and what else decides about the file; of the Python module `from_python`, the scene's name
  // and a call.
  std::vector<std::string> command;
  std::string name;   // the word of it that is the scene; empty: the command has none
  std::string file;   // its name in the directory of -o; empty: -o named it
  std::string scene;  // its text, every --set in it
  std::map<std::string, double> errors;
};

inline constexpr std::string_view from_python = "python";
// For a person: "unfurl figure hoop6 energy", "Python, hoop6: run().plot("energy")".
std::string command_in_words(const Receipt& receipt);

// Every byte of a file. Throws FileError where it cannot be read.
std::string bytes_of(const std::filesystem::path& file);
// Nothing where the file carries no receipt. Throws FileError where it cannot be read.
std::optional<Receipt> receipt_of(const std::filesystem::path& file);
// Whether a file in which there is no receipt has what is left of one.
bool damaged_receipt(const std::filesystem::path& file);
// Is every byte of a file with a receipt as it was written?
bool as_written(const std::filesystem::path& file);

std::string checksum_of_this_program();  // or of the Python module

// While it lives, every file of a format that takes a note gets a receipt before it gets its name.
class ReceiptWriter final : public FileFinisher {
 public:
  // The words of the command line, from the verb on, which of them is the scene (0: none), and what follows
  // -o.
  ReceiptWriter(std::vector<std::string> words, std::size_t scene_at, std::string output);
  ~ReceiptWriter();
  ReceiptWriter(const ReceiptWriter&) = delete;
  ReceiptWriter& operator=(const ReceiptWriter&) = delete;

  std::string note(const std::filesystem::path& target) override;
  bool finish(const std::filesystem::path& temporary, const std::filesystem::path& target) override;

 private:
  std::vector<std::string> words_;
  std::size_t scene_at_;
  std::filesystem::path output_;
  FileFinisher* before_ = nullptr;
};

// How a command names the scene of this name: one that begins with '-' is no option.
std::string word_of_scene(const std::string& name);
// What files that are written from now on say of their scene, and of the run that they show. Options that
// change the scene, as --set does, are in its text already or, where that is as it was read, stay in the
// command.
enum class SceneOptions { in_text, in_command };
void receipt_scene(const std::string& name, const std::string& text,
                   SceneOptions options = SceneOptions::in_text);
void receipt_errors(std::map<std::string, double> errors);
// The command as results tell it: the scene, words[scene_at] (0: there is none), by its name, without what
// only says where and by whom the work is done, and without what is in the scene's text already.
std::vector<std::string> command_of_result(std::vector<std::string> words, std::size_t scene_at,
                                           const std::string& scene_name,
                                           SceneOptions options = SceneOptions::in_text);

}  // namespace unfurl
