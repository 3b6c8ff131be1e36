// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace unfurl {

// Runs tasks on threads of its own, in any order. The first exception of a task comes out of add() or
// finish(); tasks that have not begun by then are dropped.
class TaskQueue {
 public:
  explicit TaskQueue(int threads);  // at most; with none a task runs inside add()
  ~TaskQueue();                     // waits for the tasks that have begun
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  // Waits while two tasks a thread are waiting already, so that what they hold stays bounded.
  void add(std::function<void()> task);
  bool any_waiting();
  void finish();  // wait for all

  // Where tasks look at what lives in a scope, one at the end of its variables: no task goes on beyond it.
  class Scope {
   public:
    explicit Scope(TaskQueue& queue) : queue_(queue) {}
    ~Scope() { queue_.give_up(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    TaskQueue& queue_;
  };

 private:
  void work();
  void rethrow();
  void give_up();  // what has not begun; waits for the rest

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t running_ = 0;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace unfurl
