// SPDX-License-Identifier: BSD-3-Clause
// Workers that share one study through a folder: processes on one machine or on many that see it.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace unfurl {

// Pieces of work are held by leases, files in the folder:
//
//   NAME.0.lease    who created it first holds the piece; its time of change is renewed while the worker
//   lives NAME.1.lease    of a piece whose lease .0 was not renewed for `lease` seconds: who created this one
//   holds it
//   NAME.1.done     that one has finished it, where others wait for the end
//
// Exclusive creation is all that it asks of a file system (no locks), and ages are differences of times that
// the file system itself gave, so that clocks may differ. A worker that is stopped past its lease and goes on
// finds that it holds the piece no more. Two may, for a moment, work on the same piece; what is kept is the
// same.
class Team {
 public:
  // Makes the folder. Throws FileError.
  Team(std::filesystem::path folder, double lease);
  ~Team();  // gives back what it holds, at once
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  // This worker's piece of work, from now on or already; false: another's. Of what another left, which may be
  // finished, `taken_over` is called first. Throws FileError.
  bool takes(const std::string& piece, const std::function<void()>& taken_over = {});
  // Whether a piece that it took is still its own.
  bool holds(const std::string& piece);

  // For those who wait for a piece that is taken up once, such as the results: its holder says that it is
  // finished, and whether the last one who held it did. Throws FileError.
  void finish(const std::string& piece);
  bool finished(const std::string& piece) const;

  // All work is done: what is held is neither renewed nor given back, since others who do not know yet would
  // begin it again.
  void done();

  // What this worker has finished, "HOST-PID-RANDOM.csv" in the folder; nobody else writes there.
  std::filesystem::path journal() const { return folder_ / (name_ + ".csv"); }
  std::vector<std::filesystem::path> journals_of_others() const;

 private:
  std::filesystem::path lease_file(const std::string& piece, int generation) const;
  std::filesystem::path mark(const std::string& piece, int generation) const;  // of what is finished
  bool create(const std::filesystem::path& file) const;
  double age(const std::filesystem::path& file) const;  // [s]; negative: there is none
  void renew(const std::stop_token& stop);

  std::filesystem::path folder_;
  double lease_;
  std::string name_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::map<std::string, int> held_;  // the generation of each piece
  std::jthread keeper_;              // renews the leases
};

}  // namespace unfurl
