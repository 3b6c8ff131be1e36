// SPDX-License-Identifier: BSD-3-Clause
// An export: the program itself, run beside the panel with the command line that a person would type.
#pragma once

#include <string>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/worker.hpp"

namespace unfurl {

// The words of "unfurl VERB SCENE -o OUTPUT --set ..." for a document; a scene without a file is written to
// one beside the output. Throws FileError.
std::vector<std::string> export_words(const SceneDocument& document, const std::string& verb,
                                      const std::string& output);

// Writes the document's scene, comments kept, to a file, and returns the document of that file. Throws
// SceneError, FileError. `anew`: the text had to be written anew.
SceneDocument save_document(const SceneDocument& document, const std::string& path, bool& anew);

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
