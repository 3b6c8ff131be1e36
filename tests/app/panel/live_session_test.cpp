// SPDX-License-Identifier: BSD-3-Clause
// The panel's heart without a picture: no graphics, no ImGui.
#include "app/panel/live_session.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>

using namespace unfurl;

namespace live_session_test {

namespace {

template <class Condition>
bool comes_true(const Condition& condition) {  // within a minute; no more is asked once it is
  for (int i = 0; i < 60000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// Frames without pictures, until nothing is under way.
void settle(LiveSession& session) {
  comes_true([&] {
    session.take_results();
    session.act();
    session.follow_document();
    return !session.busy();
  });
}

SceneDocument quick() {
  return open_document("hoop6", {"solver.step=0.05"});
}

}  // namespace

TEST_CASE("a session follows its document: runs, errors, pictures that need no run, and mistakes") {
  LiveSession session(quick(), {});
  settle(session);
  PanelState& state = session.state();
  REQUIRE(state.shown);
  CHECK(state.trade.back().accuracy == Accuracy::known);
  state.history.edit("structure.post_length", 1.5);
  settle(session);
  CHECK(state.shown->scene.structure.real("post_length") == 1.5);
  CHECK(session.simulator().started() == 2);
  state.history.edit("render.look", std::string("blueprint"));
  settle(session);
  CHECK(state.picture.look == "blueprint");
  CHECK(session.simulator().started() == 2);
  state.history.edit("structure.units", 2L);
  settle(session);
  REQUIRE(state.problems.size() == 1);
  CHECK(state.problems[0].key == "structure.units");
  CHECK(state.shown->scene.structure.real("post_length") == 1.5);  // the older run stays
}

TEST_CASE("what is said of a document stays when its run comes, and goes with the run of another") {
  LiveSession session(quick(), {.at = 0, .measure_errors = false, .wake = {}, .picture = {}});
  session.state().message = "saved";
  settle(session);
  REQUIRE(session.state().shown);
  CHECK(session.state().message == "saved");
  session.state().history.edit("structure.post_length", 1.3);
  settle(session);
  CHECK(session.state().message.empty());
}

TEST_CASE("an intent that fails says why, and those behind it are done all the same") {
  LiveSession session(quick(), {.at = 0, .measure_errors = false, .wake = {}, .picture = {}});
  session.state().intents.emplace_back([](LiveSession&) { throw std::runtime_error("no such thing"); });
  session.state().intents.emplace_back([](LiveSession& s) { s.state().dark = true; });
  CHECK(session.act());
  CHECK(session.state().message == "no such thing");
  CHECK(session.state().dark);
  CHECK(session.state().intents.empty());
}

TEST_CASE("a request does not wait for a stale one that does not listen") {
  std::promise<void> gate;
  const std::shared_future<void> open = gate.get_future().share();
  Worker<int, int> worker([open](int request, const auto& task) {
    if (request == 1) open.wait();  // deaf
    CHECK((request == 1 || !task.stopped()));
    return 10 * request;
  });
  worker.submit(1);
  REQUIRE(comes_true([&] { return worker.started() == 1; }));
  worker.submit(7);
  std::optional<int> result;
  CHECK(comes_true([&] { return (result = worker.take()).has_value(); }));
  CHECK(result == 70);
  CHECK_FALSE(worker.busy());
  gate.set_value();  // and its result is nobody's
  worker.submit(8);
  CHECK(comes_true([&] { return (result = worker.take()).has_value(); }));
  CHECK(result == 80);
}

TEST_CASE("work that is told to stop hands over what it has, work that is cancelled nothing") {
  Worker<int, int> worker([](int request, const auto& task) {
    while (!task.stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return request;
  });
  worker.submit(3);
  worker.stop();
  std::optional<int> result;
  CHECK(comes_true([&] { return (result = worker.take()).has_value(); }));
  CHECK(result == 3);
  worker.submit(4);
  worker.cancel();
  CHECK_FALSE(worker.busy());
  worker.hold(true);
  worker.submit(5);
  worker.stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK_FALSE(worker.take());  // it rests
  worker.hold(false);
  CHECK(comes_true([&] { return (result = worker.take()).has_value(); }));
  CHECK(result == 5);
}

}  // namespace live_session_test
