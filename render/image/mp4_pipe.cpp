#include "render/image/mp4_pipe.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "core/export/atomic_file.hpp"

extern char** environ;

namespace unfurl {
namespace {

std::vector<std::string> ffmpeg_arguments(const std::string& file, int width, int height, double fps) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::ostringstream rate;
  rate << fps;
  return {"ffmpeg",    "-y",         "-loglevel",  "quiet",
          "-f",        "rawvideo",   "-pix_fmt",   "rgba",
          "-s",        size,         "-framerate", rate.str(),
          "-i",        "pipe:0",     "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
          "-c:v",      "libx264",    "-preset",    "veryfast",
          "-crf",      "18",         "-pix_fmt",   "yuv420p",
          "-threads",  "2",  // x264's result depends on how many it uses
          "-movflags", "+faststart", "-f",         "mp4",
          file};
}

// Start it with `input` as its standard input, in a process group of its own so that Ctrl-C at the terminal
// reaches us and not it. 0 or an errno.
int spawn(const std::vector<std::string>& arguments, int input, pid_t& pid) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error = posix_spawnp(&pid, argv[0], &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

}  // namespace

bool ffmpeg_available() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return true;
  }
  return false;
}

struct Mp4Pipe::Process {
  std::filesystem::path target;
  std::unique_ptr<PendingFile> file;
  int input = -1;  // our end: a socket, so that a dead ffmpeg is an error of send() and not a signal
  pid_t pid = -1;
  std::string problem;

  void start(int width, int height, double fps);
  void send_frame(const Image& frame);
  int wait_for_end();
  ~Process() {
    if (pid > 0) ::kill(pid, SIGKILL);
    wait_for_end();
  }
};

void Mp4Pipe::Process::start(int width, int height, double fps) {
  std::array<int, 2> ends{-1, -1};
  int error = ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0 ? 0 : errno;
  if (error == 0) {
    input = ends[0];
    error = spawn(ffmpeg_arguments(file->name().string(), width, height, fps), ends[1], pid);
    ::close(ends[1]);
  }
  if (error != 0) {
    pid = -1;
    problem = "cannot start ffmpeg: " + std::generic_category().message(error);
  }
}

void Mp4Pipe::Process::send_frame(const Image& frame) {
  const std::uint8_t* data = frame.rgba.data();
  std::size_t left = frame.rgba.size();
  while (left > 0 && problem.empty()) {
    const ssize_t sent = ::send(input, data, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      problem = "ffmpeg stopped early";
      return;
    }
    data += sent;
    left -= static_cast<std::size_t>(sent);
  }
}

// ffmpeg's exit code, or -1 where it was not running or was killed.
int Mp4Pipe::Process::wait_for_end() {
  if (input >= 0) ::close(std::exchange(input, -1));
  if (pid <= 0) return -1;
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  pid = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Mp4Pipe::Mp4Pipe(std::filesystem::path target, int width, int height, double fps)
    : process_(std::make_unique<Process>()) {
  process_->target = target;
  try {
    process_->file = std::make_unique<PendingFile>(std::move(target));
    process_->start(width, height, fps);
  } catch (const FileError& error) {
    process_->problem = error.what();
  }
}
Mp4Pipe::~Mp4Pipe() = default;
Mp4Pipe::Mp4Pipe(Mp4Pipe&&) noexcept = default;
Mp4Pipe& Mp4Pipe::operator=(Mp4Pipe&&) noexcept = default;

void Mp4Pipe::add(const Image& frame) {
  process_->send_frame(frame);
}

std::string Mp4Pipe::finish() {
  Process& p = *process_;
  const int code = p.wait_for_end();
  if (p.problem.empty() && code != 0) p.problem = "ffmpeg failed";
  try {
    if (p.problem.empty()) p.file->commit();
  } catch (const FileError& error) {
    return error.what();
  }
  return p.problem.empty() ? "" : p.target.string() + ": no MP4 was written: " + p.problem;
}

}  // namespace unfurl
