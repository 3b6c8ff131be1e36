// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

namespace unfurl {

struct ProgramResult {
  int code = -1;  // exit code; 128 + signal where one ended it
  std::string out, err;
};

struct ProgramOptions {
  std::vector<std::string> environment = {};  // "NAME=value", added to this process's
  double interrupt_after_s = -1.0;            // send the signal then; negative: never
  int signal = SIGINT;
  std::string first_wait_for = "";  // until this file is there, at most a minute, before those seconds
  long largest_file = -1;           // [bytes] that it may write: as on a full disk; negative: any
  std::string out_file = "";        // standard output goes there instead
};

// Runs the program with these arguments and waits for it.
ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

// A directory of its own, removed with the object.
class ScratchDirectory {
 public:
  ScratchDirectory();
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const;  // returns the path

 private:
  std::filesystem::path path_;
};

std::string file_text(const std::string& path);

}  // namespace unfurl
