// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/mp4_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/export/atomic_file.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {
namespace {

// A comment of any length, as ffmpeg reads it: one argument takes 128 kB at most.
std::string metadata_text(const std::string& comment) {
  std::string text = ";FFMETADATA1\ncomment=";
  for (const char c : comment) {
    if (std::string_view("=;#\\\n").find(c) != std::string_view::npos) text += '\\';
    text += c;
  }
  return text + "\n";
}

// A file without a name that a child can read; -1: see errno.
int nameless_file(const std::string& text) {
  const int file = ::memfd_create("unfurl", 0);
  std::size_t done = 0;
  while (file >= 0 && done < text.size()) {
    const ssize_t written = ::write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      ::close(file);
      errno = error;
      return -1;
    }
    done += static_cast<std::size_t>(written);
  }
  return file;
}

// What makes of pictures of any size a film that every player shows.
std::vector<std::string> ffmpeg_arguments(const std::string& file, int width, int height, double fps,
                                          int metadata) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::ostringstream rate;
  rate << fps;
  return {"ffmpeg", "-y", "-loglevel", "quiet", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", size,
          "-framerate", rate.str(), "-i", "pipe:0", "-f", "ffmetadata", "-i",
          "file:/proc/self/fd/" + std::to_string(metadata), "-map_metadata", "1", "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
          // What the numbers mean, or players guess: the colours of high-definition television.
          "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
          "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p", "-threads",
          "2",  // x264's result depends on how many it uses
          "-movflags", "+faststart", "-f", "mp4",
          "file:" + file};  // a colon in a name is no protocol, a dash no option
}

// A program that takes no frame, or does not write on after the last one, for so long hangs [s].
constexpr int longest_silence = 60;

// ffmpeg does not say why it could not write; a page of a file system or more is left where something can be.
bool is_full(const std::filesystem::path& folder) {
  std::error_code error;
  const auto left = std::filesystem::space(folder.empty() ? "." : folder, error);
  return !error && left.available < 4096;
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
  ChildProcess ffmpeg;
  std::string problem;

  void start(int width, int height, double fps);
  void send_frame(const Image& frame);
  int wait_for_end();
  ~Process() {
    if (input >= 0) ::close(input);
  }
};

void Mp4Pipe::Process::start(int width, int height, double fps) {
  std::array<int, 2> ends{-1, -1};
  int error = ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0 ? 0 : errno;
  if (error == 0) {
    input = ends[0];
    ::fcntl(input, F_SETFL, O_NONBLOCK);
    FileFinisher* finisher = file_finisher();
    const std::string comment = finisher ? finisher->note(target) : "";
    const int metadata = nameless_file(metadata_text(comment));
    error = metadata < 0 ? errno
                         : ffmpeg.start(ffmpeg_arguments(file->name().string(), width, height, fps, metadata),
                                        {.input = ends[1]});
    if (metadata >= 0) ::close(metadata);
    ::close(ends[1]);
  }
  if (error != 0) problem = "cannot start ffmpeg: " + std::generic_category().message(error);
}

void Mp4Pipe::Process::send_frame(const Image& frame) {
  const std::uint8_t* data = frame.rgba.data();
  std::size_t left = frame.rgba.size();
  while (left > 0 && problem.empty()) {
    const ssize_t sent = ::send(input, data, left, MSG_NOSIGNAL);
    if (sent > 0) {
      data += sent;
      left -= static_cast<std::size_t>(sent);
      continue;
    }
    if (errno == EINTR) continue;
    pollfd ready{input, POLLOUT, 0};
    if (errno != EAGAIN)
      problem = "ffmpeg stopped early";
    else if (::poll(&ready, 1, 1000 * longest_silence) == 0)
      problem = "ffmpeg took no frame for " + std::to_string(longest_silence) + " s";
  }
}

// ffmpeg's exit code; it is ended where it hangs: a film's last work is to write its file once more.
int Mp4Pipe::Process::wait_for_end() {
  if (input >= 0) ::close(std::exchange(input, -1));
  struct stat before {};
  for (int silence = 0; silence < longest_silence; ++silence) {
    if (const auto code = ffmpeg.wait(1)) return *code;
    struct stat now {};
    if (::stat(file->name().c_str(), &now) == 0 &&
        (now.st_size != before.st_size || now.st_mtim.tv_sec != before.st_mtim.tv_sec))
      silence = 0;
    before = now;
  }
  ffmpeg.send(SIGKILL);
  if (problem.empty()) problem = "ffmpeg did not end";
  return ffmpeg.wait().value_or(-1);
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
  if (!p.problem.empty()) p.ffmpeg.send(SIGKILL);
  const int code = p.file ? p.wait_for_end() : -1;
  if (p.problem.empty() && code != 0) p.problem = "ffmpeg failed";
  if (!p.problem.empty() && p.file && is_full(p.file->name().parent_path()))
    p.problem += ": no space left on device";
  try {
    if (p.problem.empty()) p.file->commit();
  } catch (const FileError& error) {
    return std::string("no MP4 was written: ") + error.what();
  }
  return p.problem.empty() ? "" : "no MP4 was written: " + p.problem;
}

}  // namespace unfurl
