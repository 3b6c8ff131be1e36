// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/atomic_file.hpp"

#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/export/checksum.hpp"
#include "core/export/pending_files.hpp"
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

// What is whole and has its name stays; so does what is given up before, whose name is free again.
TEST_CASE("a program that ends at once removes the files that are being written") {
  const ScratchFolder scratch;
  PendingFile whole(scratch.path / "whole.txt");
  whole.commit();
  fs::path given_up;
  { given_up = PendingFile(scratch.path / "given_up.txt").name(); }
  std::ofstream(given_up) << "another one's";
  const PendingFile first(scratch.path / "a.csv"), second(scratch.path / "b.csv");
  REQUIRE(entries(scratch.path) == 4);
  remove_pending_files();
  CHECK_FALSE(fs::exists(first.name()));
  CHECK_FALSE(fs::exists(second.name()));
  CHECK(fs::exists(scratch.path / "whole.txt"));
  CHECK(fs::exists(given_up));
}

TEST_CASE("temporary names are new ones: random, never behind a link, and short enough for every target") {
  const ScratchFolder scratch;
  const PendingFile one(scratch.path / "a.txt"), other(scratch.path / "a.txt");
  CHECK(one.name() != other.name());
  CHECK(is_unfinished_name(one.name().filename().string()));
  CHECK_FALSE(is_unfinished_name(".unfurl-notes.part"));
  CHECK_FALSE(is_unfinished_name(".a.txt.1-0.part"));
  // The longest name that Linux knows; a name with the target's in front would be longer.
  const fs::path longest = scratch.path / std::string(255, 'n');
  write_file_atomically(longest, "x");
  CHECK(content(longest) == "x");
}

TEST_CASE("files that are written together get their names when all are whole, or none does") {
  const ScratchFolder scratch;
  const fs::path a = scratch.path / "a.txt", b = scratch.path / "b.txt";
  {
    PendingFile one(a), other(b);
    one.write("first");
    other.write("second");
    other.complete();
    CHECK(fs::directory_iterator(scratch.path)->path().extension() == ".part");
    CHECK_FALSE(fs::exists(b));
    commit_together(std::array{&one, &other});
  }
  CHECK(content(a) == "first");
  CHECK(content(b) == "second");
  struct Refusing final : FileWatcher {
    void before_file(const fs::path& target, const std::string&) override { throw FileError(target, "no"); }
  } refusing;
  FileWatcher* const before = watch_files(&refusing);
  {
    PendingFile one(a), other(b);
    one.write("third");
    other.write("fourth");
    CHECK_THROWS_AS(commit_together(std::array{&one, &other}), FileError);
  }
  watch_files(before);
  CHECK(content(a) == "first");
  CHECK(content(b) == "second");
  CHECK(std::distance(fs::directory_iterator(scratch.path), {}) == 2);
}

// What is slow, the checksums of what is replaced and the list of what is written, comes before the first.
TEST_CASE("files that are written together are all old until all are known to who watches") {
  const ScratchFolder scratch;
  const std::array paths{scratch.path / "a.txt", scratch.path / "b.txt", scratch.path / "c.txt"};
  for (const fs::path& path : paths) write_file_atomically(path, "old");
  struct Watcher final : FileWatcher {
    std::array<fs::path, 3> paths;
    int told = 0, old = 0;
    void before_file(const fs::path&, const std::string&) override {
      ++told;
      for (const fs::path& path : paths) old += content(path) == "old" ? 1 : 0;
    }
  } watcher;
  watcher.paths = paths;
  FileWatcher* const before = watch_files(&watcher);
  {
    PendingFile a(paths[0]), b(paths[1]), c(paths[2]);
    for (PendingFile* file : {&a, &b, &c}) file->write("new");
    commit_together(std::array{&a, &b, &c});
  }
  watch_files(before);
  CHECK(watcher.told == 3);
  CHECK(watcher.old == 9);
  for (const fs::path& path : paths) CHECK(content(path) == "new");
  CHECK(std::distance(fs::directory_iterator(scratch.path), {}) == 3);
}

TEST_CASE("a pipe is not replaced by a file") {
  const ScratchFolder scratch;
  const fs::path pipe = scratch.path / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(failure(pipe, "x").find("which no file replaces") != std::string::npos);
  CHECK(fs::is_fifo(pipe));
  CHECK(entries(scratch.path) == 1);
}

TEST_CASE("a link in the place of a file is replaced, what it leads to stays") {
  const ScratchFolder scratch;
  write_file_atomically(scratch.path / "precious", "mine");
  fs::create_symlink("precious", scratch.path / "out.svg");
  write_file_atomically(scratch.path / "out.svg", "ours");
  CHECK(content(scratch.path / "precious") == "mine");
  CHECK_FALSE(fs::is_symlink(scratch.path / "out.svg"));
}

TEST_CASE("behind the links of a name lies the file that is meant") {
  const ScratchFolder scratch;
  const fs::path& in = scratch.path;
  fs::create_directory(in / "store");
  write_file_atomically(in / "store" / "real.toml", "mine");
  fs::create_symlink("store/real.toml", in / "one.toml");
  fs::create_symlink(in / "one.toml", in / "two.toml");
  fs::create_symlink("store/new.toml", in / "ahead.toml");  // is not there yet
  fs::create_directory_symlink("store", in / "folder");
  fs::create_symlink("store/real.toml", in / "picture.png");
  fs::create_symlink("round.toml", in / "round.toml");
  CHECK(behind_links(in / "two.toml") == in / "store/real.toml");
  CHECK(behind_links(in / "ahead.toml") == in / "store/new.toml");
  for (const char* itself : {"store/real.toml", "nothing.toml", "folder", "picture.png", "round.toml"})
    CHECK(behind_links(in / itself) == in / itself);
  CHECK(behind_links("").empty());
}

TEST_CASE("a file that is replaced keeps its permissions") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "a.toml";
  write_file_atomically(file, "open");
  const auto anew = fs::status(file).permissions();
  const auto own = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(file, own);
  write_file_atomically(file, "private");
  CHECK(fs::status(file).permissions() == own);
  fs::create_symlink("a.toml", scratch.path / "b.toml");
  write_file_atomically(scratch.path / "b.toml", "another");
  CHECK(fs::status(scratch.path / "b.toml").permissions() == anew);
}

TEST_CASE("an unfinished file is abandoned only when nobody writes it any more") {
  const ScratchFolder scratch;
  const PendingFile writing(scratch.path / "a.txt");
  remove_abandoned(writing.name());
  CHECK(fs::exists(writing.name()));
  const fs::path left = scratch.path / ".unfurl-0123456789abcdef.part";
  std::ofstream(left) << "half";
  remove_abandoned(left);
  CHECK_FALSE(fs::exists(left));
}

TEST_CASE("the watcher is told the name and the checksum of every file before it appears") {
  struct Watcher final : FileWatcher {
    std::string seen;
    void before_file(const fs::path& target, const std::string& checksum) override {
      seen += target.filename().string() + (fs::exists(target) ? "! " : " ") + checksum + "\n";
    }
  } watcher;
  const ScratchFolder scratch;
  FileWatcher* const before = watch_files(&watcher);
  write_file_atomically(scratch.path / "empty", "");
  write_file_atomically(scratch.path / "a", "a");
  CHECK(watch_files(before) == &watcher);
  // Published values of FNV-1a with 64 bits: of no byte, and of "a".
  CHECK(watcher.seen == "empty cbf29ce484222325\na af63dc4c8601ec8c\n");
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

TEST_CASE("whatever is written, read back or refused leaves no file open") {
  const ScratchFolder scratch;
  const auto open_files = [] { return entries("/proc/self/fd"); };
  const std::size_t before = open_files();
  for (int i = 0; i < 3; ++i) {
    write_file_atomically(scratch.path / "a.txt", "text");
    CHECK(!checksum_of_file(scratch.path / "a.txt").empty());
    CHECK(checksum_of_file(scratch.path / "none.txt").empty());
    CHECK(checksum_of_file(scratch.path).empty());
    failure(scratch.path / "nowhere" / "a.txt", "x");
    failure(scratch.path, "x");
    const PendingFile abandoned(scratch.path / "b.txt");
  }
  CHECK(open_files() == before);
}

// A pipe takes 64 kB; a signal ends the wait for room with what was written so far.
TEST_CASE("what is written in parts arrives whole") {
  const ScratchFolder scratch;
  const fs::path pipe = scratch.path / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  struct sigaction interrupting = {}, before = {};
  interrupting.sa_handler = [](int) {};
  REQUIRE(::sigaction(SIGUSR1, &interrupting, &before) == 0);
  std::string sent(1000003, ' ');
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<char>('a' + i * i % 23);
  std::string failed;
  std::atomic<bool> done = false;
  std::thread writer([&] {
    try {
      replace_bytes(pipe, sent);
    } catch (const FileError& error) {
      failed = error.what();
    }
    done = true;
  });
  std::ifstream in(pipe, std::ios::binary);
  std::string received;
  std::array<char, 4096> part{};
  while (in.read(part.data(), part.size()) || in.gcount() > 0) {
    received.append(part.data(), static_cast<std::size_t>(in.gcount()));
    if (done || received.size() % (20 * part.size()) != 0) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // until the pipe is full and the writer waits
    ::pthread_kill(writer.native_handle(), SIGUSR1);
  }
  writer.join();
  ::sigaction(SIGUSR1, &before, nullptr);
  CHECK(failed.empty());
  CHECK(received == sent);
}

}  // namespace atomic_file_test
