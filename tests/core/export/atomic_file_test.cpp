#include "core/export/atomic_file.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/not_tested.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace atomic_file_test {

namespace {

struct ScratchFolder {
  fs::path path = fs::temp_directory_path() / ("unfurl_atomic_" + std::to_string(::getpid()));
  ScratchFolder() { fs::create_directories(path); }
  ~ScratchFolder() { fs::remove_all(path); }
};

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::string failure(const fs::path& path, std::string_view text) {
  try {
    write_file_atomically(path, text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a file is written whole, replaces the old one and leaves no temporary name behind") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "a.txt";
  write_file_atomically(file, "first, and longer than the second");
  write_file_atomically(file, std::string_view("second\0with a zero", 18));
  CHECK(content(file) == std::string("second\0with a zero", 18));
  CHECK(entries(scratch.path) == 1);
}

TEST_CASE("a directory that does not exist is named with the cause") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "nowhere" / "a.txt";
  CHECK(failure(file, "x") == file.string() + ": no such file or directory");
}

TEST_CASE("a target that is a directory is refused and stays") {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path / "taken";
  fs::create_directories(folder / "inside");
  CHECK(failure(folder, "x") == folder.string() + ": is a directory");
  CHECK(failure(folder / "", "x") == (folder / "").string() + ": is a directory");
  CHECK(fs::exists(folder / "inside"));
  CHECK(entries(scratch.path) == 1);
}

TEST_CASE("a pending file that is not committed is removed") {
  const ScratchFolder scratch;
  fs::path temporary;
  {
    const PendingFile pending(scratch.path / "film.mp4");
    temporary = pending.name();
    std::ofstream(temporary) << "half a film";
    REQUIRE(fs::exists(temporary));
  }
  CHECK_FALSE(fs::exists(temporary));
  CHECK(entries(scratch.path) == 0);
}

TEST_CASE("a full disk is reported by its cause and the old file stays") {
  const ScratchFolder scratch;
  const std::string folder = scratch.path.string();
  const bool mounted =
      std::system(("mount -t tmpfs -o size=64k tmpfs " + folder + " 2>/dev/null").c_str()) == 0;
  if (testing::lacks(mounted, "a full disk: only root may mount a small one")) return;
  const fs::path file = scratch.path / "a.csv";
  write_file_atomically(file, "old");
  const std::string error = failure(file, std::string(1 << 20, 'x'));
  const std::string kept = content(file);
  const std::size_t count = entries(scratch.path);
  REQUIRE(std::system(("umount " + folder).c_str()) == 0);
  CHECK(error == file.string() + ": no space left on device");
  CHECK(kept == "old");
  CHECK(count == 1);
}

}  // namespace atomic_file_test
