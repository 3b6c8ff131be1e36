// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/simulator.hpp"

#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/tolerance.hpp"

namespace unfurl {

Simulator::Simulator(std::function<void()> wake) : wake_(std::move(wake)), thread_([this] { work(); }) {}

Simulator::~Simulator() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    waiting_.reset();
    ++newest_;
  }
  changed_.notify_all();
  thread_.join();
}

long Simulator::submit(SceneDocument document) {
  long id = 0;
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(document);
    finished_.reset();
    id = ++newest_;
  }
  changed_.notify_all();
  return id;
}

void Simulator::cancel() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  ++newest_;
}

std::optional<SimulationOutcome> Simulator::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, std::nullopt);
}

bool Simulator::busy() const {
  const std::lock_guard lock(mutex_);
  return running_ || waiting_ || finished_;
}

void Simulator::notify(double fraction) {
  progress_ = fraction;
  if (wake_) wake_();
}

SimulationOutcome Simulator::run(long id, const SceneDocument& document) {
  SimulationOutcome outcome{id, nullptr, {}, ""};
  try {
    Scene scene = read_document(document);
    SimulationHooks hooks;
    hooks.progress = [this](double fraction) { notify(fraction); };
    hooks.cancelled = [this, id] { return stale(id); };
    Simulation simulation = simulate_as_asked(build_model(scene), scene.solver, hooks);
    record_singular_poses(simulation);
    if (stale(id)) return outcome;
    Diagnostics diagnostics = judge(simulation);
    std::vector<std::string> warnings = simulation.warnings;
    for (auto& warning : accuracy_warnings(simulation, diagnostics)) warnings.push_back(std::move(warning));
    MotionKey motion = motion_of(scene);
    outcome.run = std::make_shared<const LiveRun>(LiveRun{id, document, std::move(scene), std::move(motion),
                                                          std::move(simulation), std::move(diagnostics),
                                                          std::move(warnings)});
  } catch (const SceneError& error) {
    outcome.problems = error.problems();
  } catch (const std::bad_alloc&) {
    outcome.message = "out of memory";
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  return outcome;
}

void Simulator::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || waiting_; });
    if (ending_) return;
    const SceneDocument document = std::move(*waiting_);
    waiting_.reset();
    const long id = newest_;
    running_ = true;
    progress_ = 0;
    ++started_;
    lock.unlock();
    SimulationOutcome outcome = run(id, document);
    lock.lock();
    running_ = false;
    if (!stale(id)) finished_ = std::move(outcome);
    lock.unlock();  // who is woken may ask this object at once
    if (wake_) wake_();
    lock.lock();
  }
}

}  // namespace unfurl
