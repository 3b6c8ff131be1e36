// SPDX-License-Identifier: BSD-3-Clause
// An export: the program itself, run beside the panel with the command line that a person would type.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

// The words of "unfurl VERB SCENE -o OUTPUT --set ..." for a document; a scene without a file is written to
// one beside the output. Throws FileError.
std::vector<std::string> export_words(const SceneDocument& document, const std::string& verb,
                                      const std::string& output);

// Writes the document's scene, comments kept, to a file, and returns the document of that file. Throws
// SceneError, FileError. `anew`: the text had to be written anew.
SceneDocument save_document(const SceneDocument& document, const std::string& path, bool& anew);

class ExportProcess {
 public:
  explicit ExportProcess(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~ExportProcess();  // ends a run that is under way
  ExportProcess(const ExportProcess&) = delete;
  ExportProcess& operator=(const ExportProcess&) = delete;

  // `program`: of unfurl.
  void start(const std::string& program, const std::vector<std::string>& words);
  bool running() const { return running_; }
  // What came of the last one, once; "" where there is nothing new.
  std::string take_report();

 private:
  void wait(const std::string& log, const std::string& output);

  std::function<void()> wake_;
  std::atomic<bool> running_{false};
  std::mutex mutex_;
  std::string report_;
  ChildProcess child_;
  std::thread thread_;
};

// The file of this program.
std::string own_program();

}  // namespace unfurl
