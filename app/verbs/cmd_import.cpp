// SPDX-License-Identifier: BSD-3-Clause
// unfurl import FILE -o SCENE.toml: a custom scene of a FOLD, an OBJ or two CSV files.
#include <filesystem>
#include <iostream>
#include <utility>

#include "app/command.hpp"
#include "app/output/output_directory.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/import_scene.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write_back.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::vector<TextFile> files_to_import(const std::vector<std::string>& names) {
  const std::string format = import_format(names.front());
  if (format.empty())
    throw UsageError("import reads files that end in .fold, .obj or .csv; got " + in_quotes(names.front()));
  if (format != "csv" && names.size() > 1) throw UsageError("unexpected argument " + in_quotes(names[1]));
  if (format == "csv" && (names.size() < 2 || import_format(names[1]) != "csv"))
    throw UsageError("two CSV files make a scene: unfurl import NODES.csv RODS.csv");
  std::vector<TextFile> files;
  for (const std::string& name : names) {
    files.push_back(read_text_file(name, TextSource::pipe_too));
    if (!files.back().error.empty()) throw UnreadableScene("cannot read " + name + ": " + files.back().error);
  }
  return files;
}

}  // namespace

int cmd_import(const Arguments& arguments) {
  const std::filesystem::path output(arguments.output);
  if (!output.empty()) {
    require_writable(output);
    std::error_code error;
    if (std::filesystem::exists(output, error) && !arguments.force)
      throw FileError(output, "is there already; --force writes over it");
  }
  ImportedScene scene = import_scene(files_to_import(arguments.names));
  if (!arguments.overrides.empty()) {
    WrittenBack written = write_back(scene.text, arguments.names.front(), arguments.overrides, "");
    scene.text = std::move(written.text);
    if (const std::string said = said_of(written); !said.empty()) std::cerr << "unfurl: " << said << "\n";
  }
  if (output.empty())
    std::cout << scene.text;
  else
    write_file_atomically(output, scene.text);
  if (!arguments.quiet)
    for (const std::string& note : scene.notes) std::cerr << "unfurl: note: " << note << "\n";
  return exit_ok;
}

}  // namespace unfurl
