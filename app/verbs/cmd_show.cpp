// SPDX-License-Identifier: BSD-3-Clause
// unfurl show SCENE: the text of a scene, with --set written into it.
#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"

namespace unfurl {

namespace {

std::string changed_text(const std::string& path, const std::vector<std::string>& overrides) {
  const TextFile file = read_text_file(path, TextSource::pipe_too);
  if (!file.error.empty()) throw UnreadableScene("cannot read scene " + path + ": " + file.error);
  if (overrides.empty()) return file.text;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const WrittenBack written = write_back(file.text, path, overrides, folder.empty() ? "." : folder);
  if (const std::string said = said_of(written); !said.empty()) std::cerr << "unfurl: " << said << "\n";
  return written.text;
}

}  // namespace

int cmd_show(const Arguments& arguments) {
  if (arguments.all)
    std::cout << scene_text(scene_of(arguments));
  else
    std::cout << changed_text(find_scene(arguments.names.front()), arguments.overrides);
  return exit_ok;
}

}  // namespace unfurl
