// SPDX-License-Identifier: BSD-3-Clause
// Work beside the window: the newest request, in a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace unfurl {

// A request replaces one that waits and makes stale one that runs. What is stale is asked to end, and not
// waited for: the newest request begins beside it. Results of stale requests are dropped. What is done within
// a moment is nobody's to watch: its progress wakes no one, and late() says when that moment is over.
template <class Request, class Result>
class Worker {
 public:
  // What the work may ask and say while it runs.
  class Task {
   public:
    Task(Worker& worker, long id) : worker_(worker), id_(id) {}
    long id() const { return id_; }
    bool stale() const { return worker_.newest_ != id_; }  // nobody wants the result any more
    // It is to end, stale or with what it has. Rests while the worker is held.
    bool stopped() const { return worker_.stopped(id_); }
    // Something to take while the work goes on: better than nothing, worse than its result.
    void publish(Result result) const { worker_.publish(id_, std::move(result)); }
    // `doing`: a literal, "simulating".
    void progress(double fraction, const char* doing = "") const { worker_.note(id_, fraction, doing); }

   private:
    Worker& worker_;
    long id_;
  };
  using Work = std::function<Result(const Request&, const Task&)>;

  static constexpr double moment = 0.2;  // [s]: who waits so long begins to wonder

  // `work` may run in two threads at once, one of them stale. `wake` is called from them, outside of any
  // lock, whenever there is something new to look at.
  explicit Worker(Work work, std::function<void()> wake = {})
      : work_(std::move(work)), wake_(std::move(wake)) {}
  ~Worker() {  // cancels what runs
    cancel();
    for (Thread& each : threads_) each.thread.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Returns the request's number.
  long submit(Request request) {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(request);
    finished_.reset();
    running_ = true;
    stop_ = false;
    progress_ = 0;
    doing_ = "preparing";
    begun_ = woken_ = now();
    ++newest_;
    changed_.notify_all();
    for (auto each = threads_.begin(); each != threads_.end();) {
      if (each->alive) {
        ++each;
        continue;
      }
      each->thread.join();
      each = threads_.erase(each);
    }
    if (threads_.size() < most_threads) {
      Thread& made = threads_.emplace_back();
      made.thread = std::thread([this, &made] { run(made); });
    }
    return newest_;
  }
  // Nothing comes of what runs or waits.
  void cancel() {
    const std::lock_guard lock(mutex_);
    waiting_.reset();
    finished_.reset();
    running_ = false;
    ++newest_;
    changed_.notify_all();
  }
  // What runs is to end with what it has, and hand that over.
  void stop() { stop_ = true; }
  // Rest while something more urgent runs, and go on.
  void hold(bool on) {
    if (held_.exchange(on) == on) return;
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }
  // What finished since the last call; only ever of the newest request.
  std::optional<Result> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, std::nullopt);
  }
  bool running() const {  // of the newest request
    const std::lock_guard lock(mutex_);
    return running_;
  }
  bool busy() const {  // something is or will be there to take
    const std::lock_guard lock(mutex_);
    return running_ || finished_;
  }
  bool ready() const {  // something is there to take
    const std::lock_guard lock(mutex_);
    return finished_.has_value();
  }
  // The newest request runs for longer than `moment` [s].
  bool late(double longest = moment) const { return running() && now() - begun_ > longest; }
  double progress() const { return progress_; }        // 0..1 of what runs
  std::string doing() const { return doing_.load(); }  // at present
  long started() const { return started_; }            // how many requests began to run

 private:
  struct Thread {
    std::thread thread;
    bool alive = true;  // it will look for another request
  };
  static constexpr std::size_t most_threads = 3;

  void run(Thread& self) {
    std::unique_lock lock(mutex_);
    while (waiting_) {
      const Request request = std::move(*waiting_);
      waiting_.reset();
      const Task task(*this, newest_);
      ++started_;
      lock.unlock();
      Result result = work_(request, task);
      lock.lock();
      if (task.stale()) continue;
      finished_ = std::move(result);
      running_ = false;
      lock.unlock();  // who is woken may ask this object at once
      if (wake_) wake_();
      lock.lock();
    }
    self.alive = false;
  }
  bool stopped(long id) {
    if (held_ && newest_ == id) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !held_ || newest_ != id; });
    }
    return newest_ != id || stop_;
  }
  void publish(long id, Result result) {
    {
      const std::lock_guard lock(mutex_);
      if (newest_ != id) return;
      finished_ = std::move(result);
    }
    if (wake_) wake_();
  }
  void note(long id, double fraction, const char* doing) {
    if (newest_ != id) return;
    progress_ = fraction;
    doing_ = doing;
    constexpr double pause = 0.05;  // [s]: nobody reads faster
    const double t = now();
    if (!wake_ || t - begun_ < moment || t - woken_ < pause) return;
    woken_ = t;
    wake_();
  }
  static double now() {  // [s]
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  Work work_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> waiting_;
  std::optional<Result> finished_;
  std::atomic<long> newest_{0}, started_{0};
  std::atomic<double> progress_{0}, begun_{0}, woken_{0};  // when, in seconds of now()
  std::atomic<const char*> doing_{""};
  std::atomic<bool> held_{false}, stop_{false};
  bool running_ = false;
  std::list<Thread> threads_;
};

}  // namespace unfurl
