// SPDX-License-Identifier: BSD-3-Clause
// Every command in README.md and docs/ works, every scene in them can be run, and what is printed by a
// command is what that command prints. A document's scenes are its ```toml blocks that begin with "#
// NAME.toml" (or
// "# NAME.toml = OTHER.toml +", which are behind each other), its other files blocks that begin with ```KIND
// NAME; its commands are the lines of code that begin with unfurl. Those that take long are run where
// UNFURL_DOCS=all is set (./dev check); elsewhere it is looked up that their verb has their options.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace documents_test {

namespace {

namespace fs = std::filesystem;

struct Document {
  std::map<std::string, std::string> scenes;  // file name -> text
  std::map<std::string, std::string> files;   // the same of others
  std::vector<std::string> commands;          // "unfurl run hoop6 -o data"
};

std::vector<fs::path> pages() {
  const fs::path root = UNFURL_ROOT;
  std::vector<fs::path> found = {root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

// "# driven.toml = linkage.toml +" -> the scenes' names; none where the line is another comment.
std::vector<std::string> names_in(const std::string& line) {
  std::istringstream words(line);
  std::vector<std::string> names;
  for (std::string word; words >> word;)
    if (word.ends_with(".toml")) names.push_back(word);
  return line.starts_with("# ") ? names : std::vector<std::string>{};
}

void add_scene(Document& document, const std::string& block) {
  const auto names = names_in(block.substr(0, block.find('\n')));
  if (names.empty()) return;
  std::string& text = document.scenes[names[0]];
  if (names.size() > 1) text = document.scenes[names[1]];
  text += block;
}

void add_command(Document& document, std::string line) {
  line.erase(0, line.find_first_not_of(' '));
  const std::string built = "build/release/";
  if (line.starts_with(built)) line.erase(0, built.size());
  if (!line.starts_with("unfurl ")) return;
  if (!document.commands.empty() && document.commands.back().ends_with('\\')) return;
  document.commands.push_back(line);
}

Document read(const fs::path& path) {
  Document document;
  std::istringstream text(file_text(path.string()));
  std::string block, file;
  bool toml = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      if (toml) add_scene(document, block);
      if (!file.empty()) document.files[file] = block;
      toml = line == "```toml";
      const std::size_t name = line.find(' ');
      file = name == std::string::npos ? "" : line.substr(name + 1);
      block.clear();
    } else if (toml || !file.empty()) {
      block += line + "\n";
    } else if (!document.commands.empty() && document.commands.back().ends_with('\\')) {
      document.commands.back().pop_back();
      document.commands.back() += line.substr(std::min(line.size(), line.find_first_not_of(' ')));
    } else if (line.starts_with("    ")) {
      add_command(document, line);
    }
  }
  return document;
}

std::vector<std::string> words_of(const std::string& command) {
  std::istringstream text(command.substr(0, command.find(" #")));
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

// Placeholders instead of names, or a window that needs a display.
bool cannot_run(const std::string& command) {
  for (const char* mark : {"NAME", "SCENE", "DIR", "FILE", "KIND", "KEY", "TABLE", "COMMAND", "..."})
    if (command.find(mark) != std::string::npos) return true;
  return command.starts_with("unfurl view") && command.find("--picture") == std::string::npos;
}

bool takes_long(const std::string& verb) {
  for (const char* name : {"render", "study", "stress", "sweep", "solve", "reproduce", "view", "poster"})
    if (verb == name) return true;
  return false;
}

void check_options(const std::vector<std::string>& words) {
  const std::string help = run_program({"help", words[1]}).out;
  CHECK(help.starts_with("usage: unfurl " + words[1]));
  for (const auto& word : words)
    if (word.starts_with("--")) CHECK(help.find(word.substr(0, word.find('='))) != std::string::npos);
}

void run_in(const ScratchDirectory& folder, const std::string& command) {
  const std::string path = fs::path(UNFURL_PROGRAM).parent_path().string();
  const std::string err = folder / "stderr.txt";
  const std::string shell = "cd '" + folder / "" + "' && PATH='" + path + "':\"$PATH\" && { " + command +
                            "\n} >stdout.txt 2>'" + err + "' </dev/null";
  const int code = std::system(shell.c_str());
  INFO(file_text(err));
  CHECK(code == 0);
}

const bool everything = [] {
  const char* said = std::getenv("UNFURL_DOCS");
  return said && std::string(said) == "all";
}();

std::string behind_marker(const fs::path& path, const std::string& marker) {
  const std::string text = file_text(path.string());
  const std::size_t at = text.find(marker);
  return at == std::string::npos ? "" : text.substr(at + marker.size());
}

}  // namespace

TEST_CASE("every command in the documents works") {
  std::size_t commands = 0;
  for (const fs::path& page : pages()) {
    const Document document = read(page);
    const ScratchDirectory folder;
    for (const auto* files : {&document.scenes, &document.files})
      for (const auto& [name, text] : *files) folder.write(name, text);
    for (const auto& command : document.commands) {
      const auto words = words_of(command);
      INFO(page.filename().string() << ": " << command);
      ++commands;
      if (words.size() > 1 && words[1] != "help") check_options(words);
      if (!cannot_run(command) && (everything || !takes_long(words[1]))) run_in(folder, command);
    }
  }
  CHECK(commands >= 50);
}

TEST_CASE("every scene in the documents is sound") {
  std::size_t scenes = 0;
  for (const fs::path& page : pages()) {
    const Document document = read(page);
    const ScratchDirectory folder;
    for (const auto& [name, text] : document.scenes) {
      INFO(page.filename().string() << ": " << name);
      const ProgramResult r = run_program({"check", folder.write(name, text)});
      INFO(r.err);
      CHECK(r.code == 0);
      ++scenes;
    }
  }
  CHECK(scenes >= 5);
}

TEST_CASE("docs/scene.md is what the program prints") {
  const std::string page =
      behind_marker(fs::path(UNFURL_ROOT) / "docs" / "scene.md", "<!-- unfurl list keys --markdown -->\n");
  CHECK(page == run_program({"list", "keys", "--markdown"}).out);
}

TEST_CASE("docs/validation.md has every benchmark that the program prints") {
  const ScratchDirectory folder;
  const ProgramResult r = run_program({"reproduce", "--validation", "-o", folder / "out"});
  INFO(r.err);
  CHECK(r.code == 0);
  const std::string page = file_text(UNFURL_ROOT "/docs/validation.md");
  std::istringstream rows(r.out);
  std::size_t benchmarks = 0;
  for (std::string row; std::getline(rows, row);) {
    if (!row.starts_with("| ")) continue;
    // Problem, quantity, published: what does not depend on the solver.
    std::size_t end = 0;
    for (int cell = 0; cell < 3 && end != std::string::npos; ++cell) end = row.find('|', end + 1);
    INFO(row);
    CHECK(page.find(row.substr(0, end)) != std::string::npos);
    ++benchmarks;
  }
  CHECK(benchmarks > 15);
}

TEST_CASE("links in the documents lead somewhere") {
  std::vector<fs::path> all = pages();
  all.push_back(fs::path(UNFURL_ROOT) / "core" / "README.md");
  std::size_t links = 0;
  for (const fs::path& page : all) {
    const std::string text = file_text(page.string());
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
      if (target.starts_with("http")) continue;
      INFO(page.string() << " -> " << target);
      CHECK(fs::exists(page.parent_path() / target));
      ++links;
    }
  }
  CHECK(links > 50);
}

}  // namespace documents_test
