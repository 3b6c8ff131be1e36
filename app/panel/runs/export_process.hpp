// SPDX-License-Identifier: BSD-3-Clause
// An export: the program itself, run beside the panel with the command line that a person would type.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/worker.hpp"
#include "core/scene/write_back.hpp"

namespace unfurl {

// What can be exported: a verb and what it is to write beside.
struct ExportKind {
  std::string_view name, help, verb, formats;
};
std::span<const ExportKind> export_kinds();

// The file that is exported. `in_file`: the document's own, which holds its text; else one to be written,
// beside that (where the files lie that a scene names) or beside the output.
std::string exported_scene(const SceneDocument& document, const std::string& output, bool in_file);

// The words of "unfurl VERB SCENE -o OUTPUT --set ..." for a document; where no file holds its text it is
// written to exported_scene(). `replace`: what is there. Throws FileError.
std::vector<std::string> export_words(const SceneDocument& document, const ExportKind& kind,
                                      const std::string& output, bool replace = false);
// The same as a person would type it; writes nothing.
std::string export_command(const SceneDocument& document, const ExportKind& kind, const std::string& output,
                           bool in_file);
// What lies in `output` that this export goes on with where nothing is replaced: "an unfinished run", "a
// film"; empty: nothing. Throws SceneError.
std::string export_goes_on_with(const SceneDocument& document, const ExportKind& kind,
                                const std::string& output);
// Whether replacing what is there loses an unfinished run.
bool export_loses_run(const ExportKind& kind, const std::string& output);

// The document with its changes in the text, comments kept, as a file of that path would hold it. Throws
// SceneError. `written`: that text, and what it has lost.
SceneDocument saved_document(const SceneDocument& document, const std::string& path, WrittenBack& written);
// Writes that file. Throws FileError.
SceneDocument save_document(const SceneDocument& document, const std::string& path, WrittenBack& written);

struct ExportRequest {
  std::string program;             // of unfurl
  std::vector<std::string> words;  // export_words()
};

// The result is what came of it, in a line. A run that is cancelled is ended.
class ExportProcess : public Worker<ExportRequest, std::string> {
 public:
  explicit ExportProcess(std::function<void()> wake = {});
};

// The file of this program.
std::string own_program();

}  // namespace unfurl
