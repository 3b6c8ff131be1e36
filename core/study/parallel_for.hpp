// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace unfurl {

// job(0) .. job(count - 1), each once, on so many threads at most, as many as the system gives,
// this one among them. The first exception
// of a job keeps those from starting that have not, and is thrown here when all threads have ended.
template <class Job>
void parallel_for(std::size_t count, int threads, const Job& job) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < count;) try {
        job(i);
      } catch (...) {
        next = count;
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> team;
    try {
      for (int i = 1; i < threads && static_cast<std::size_t>(i) < count; ++i) team.emplace_back(work);
    } catch (const std::system_error&) {
      // No more threads may be started: those that there are do it.
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace unfurl
