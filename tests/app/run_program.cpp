// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/run_program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace unfurl {

namespace {

// In the child: become the program, its two streams in files.
[[noreturn]] void become(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment, const std::string& out,
                         const std::string& err) {
  for (const auto& setting : environment) ::putenv(const_cast<char*>(setting.c_str()));
  const int flags = O_WRONLY | O_CREAT;
  ::dup2(::open(out.c_str(), flags, 0600), STDOUT_FILENO);
  ::dup2(::open(err.c_str(), flags, 0600), STDERR_FILENO);
  const char* const other = std::getenv("UNFURL_TEST_PROGRAM");  // one with seeded errors
  std::vector<char*> argv = {const_cast<char*>(other ? other : UNFURL_PROGRAM)};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  const ScratchDirectory scratch;
  const std::string out = options.out_file.empty() ? scratch / "out" : options.out_file,
                    err = scratch / "err";
  const pid_t child = ::fork();
  if (child == 0) {
    if (options.largest_file >= 0) {
      const rlimit limit{static_cast<rlim_t>(options.largest_file),
                         static_cast<rlim_t>(options.largest_file)};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      ::signal(SIGXFSZ, SIG_IGN);  // a write says it
    }
    become(arguments, options.environment, out, err);
  }
  for (int i = 0; i < 6000 && !options.first_wait_for.empty(); ++i) {
    siginfo_t ended{};
    ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid == child || std::filesystem::exists(options.first_wait_for)) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (options.interrupt_after_s >= 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(options.interrupt_after_s));
    ::kill(child, options.signal);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ProgramResult result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (options.out_file.empty()) result.out = file_text(out);
  result.err = file_text(err);
  return result;
}

ScratchDirectory::ScratchDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "unfurl_test_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string ScratchDirectory::write(const std::string& name, const std::string& text) const {
  const auto path = path_ / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace unfurl
