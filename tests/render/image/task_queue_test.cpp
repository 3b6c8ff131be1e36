// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/task_queue.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>

using namespace unfurl;

TEST_CASE("every task runs once, on any number of threads") {
  const int threads = GENERATE(0, 1, 3);
  std::atomic<int> sum = 0;
  TaskQueue queue(threads);
  for (int k = 1; k <= 100; ++k) queue.add([&sum, k] { sum += k; });
  queue.finish();
  CHECK(sum == 5050);
}

TEST_CASE("a task's exception reaches the one who waits, who may go on") {
  TaskQueue queue(2);
  queue.add([] { throw std::runtime_error("disk full"); });
  CHECK_THROWS_WITH(queue.finish(), "disk full");
  bool ran = false;
  queue.add([&ran] { ran = true; });
  queue.finish();
  CHECK(ran);
}
