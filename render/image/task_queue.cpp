// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/task_queue.hpp"

#include <system_error>
#include <utility>

namespace unfurl {

TaskQueue::TaskQueue(int threads) {
  try {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // No more threads may be started: those that there are do it, or add().
  }
}

TaskQueue::~TaskQueue() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void TaskQueue::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const std::function<void()> task = std::move(waiting_.front());
    waiting_.pop_front();
    ++running_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      task();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --running_;
    if (failure && !failure_) failure_ = failure;
    if (failure) waiting_.clear();
    changed_.notify_all();
  }
}

void TaskQueue::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void TaskQueue::add(std::function<void()> task) {
  if (threads_.empty()) return task();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failure_ || waiting_.size() < 2 * threads_.size(); });
  rethrow();
  waiting_.push_back(std::move(task));
  changed_.notify_all();
}

bool TaskQueue::any_waiting() {
  const std::lock_guard lock(mutex_);
  return !waiting_.empty();
}

void TaskQueue::give_up() {
  std::unique_lock lock(mutex_);
  waiting_.clear();
  changed_.wait(lock, [this] { return running_ == 0; });
  failure_ = nullptr;
}

void TaskQueue::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && running_ == 0; });
  rethrow();
}

}  // namespace unfurl
