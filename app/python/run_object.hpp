// SPDX-License-Identifier: BSD-3-Clause
// What Python calls a run.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/python/run_files.hpp"
#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/table.hpp"

namespace unfurl {

// A view that keeps its owner alive, and that nobody writes into.
template <class T>
pybind11::array view_of(const std::vector<T>& values, std::vector<pybind11::ssize_t> shape,
                        const pybind11::object& owner) {
  pybind11::array_t<T> array(std::move(shape), values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

// A run with what a person looks at, as plain arrays. Made without the interpreter's lock.
class Run {
 public:
  Run(Scene scene, Simulation run, std::shared_ptr<std::mutex> use,
      const std::function<bool()>& cancelled = {}, const std::string& made_by = "run()")
      : run_{std::move(scene), std::move(run), {}, made_by}, use_(std::move(use)) {
    const std::lock_guard lock(*use_);
    record_singular_poses(run_.simulation, cancelled);
    run_.diagnostics = judge(run_.simulation, cancelled);
    const Trajectory& trajectory = simulation().trajectory;
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      t_.push_back(trajectory.time(i));
      const VectorXd x = trajectory.positions(i), v = trajectory.velocities(i);
      x_.insert(x_.end(), x.begin(), x.end());
      v_.insert(v_.end(), v.begin(), v.end());
      for (const RodCopy& rod : structure().rod_copies) {
        force_.push_back(diagnostics().axial_force(static_cast<Index>(i), rod.source));
        unique_.push_back(diagnostics().force_unique(static_cast<Index>(i), rod.source));
      }
    }
  }

  const Scene& scene() const { return run_.scene; }
  const Simulation& simulation() const { return run_.simulation; }
  const Diagnostics& diagnostics() const { return run_.diagnostics; }
  const Structure& structure() const { return simulation().trajectory.structure(); }
  // Work on the run that takes long: without the interpreter's lock, one after the other (states between
  // steps are computed as they are asked for), under one more lock where there is one.
  template <class Work>
  auto alone(const Work& work, std::mutex* more = nullptr) const {
    const pybind11::gil_scoped_release release;
    const std::lock_guard lock(*use_);
    const auto held = more ? std::unique_lock(*more) : std::unique_lock<std::mutex>();
    return work(run_);
  }
  pybind11::ssize_t steps() const { return static_cast<pybind11::ssize_t>(t_.size()); }
  pybind11::ssize_t nodes() const { return static_cast<pybind11::ssize_t>(structure().node_copies.size()); }
  pybind11::ssize_t rods() const { return static_cast<pybind11::ssize_t>(structure().rod_copies.size()); }

  static pybind11::array t(const pybind11::object& self) {
    return view_of(of(self).t_, {of(self).steps()}, self);
  }
  static pybind11::array x(const pybind11::object& self) {
    return view_of(of(self).x_, {of(self).steps(), of(self).nodes(), 3}, self);
  }
  static pybind11::array v(const pybind11::object& self) {
    return view_of(of(self).v_, {of(self).steps(), of(self).nodes(), 3}, self);
  }
  static pybind11::array force(const pybind11::object& self) {
    return view_of(of(self).force_, {of(self).steps(), of(self).rods()}, self);
  }
  static pybind11::array unique(const pybind11::object& self) {
    const pybind11::array bytes = view_of(of(self).unique_, {of(self).steps(), of(self).rods()}, self);
    return bytes.attr("view")("bool");
  }
  static pybind11::dict series(const pybind11::object& self) {
    pybind11::dict columns;
    for (const Series& column : of(self).diagnostics().columns)
      columns[pybind11::str(column.name)] = view_of(column.values, {of(self).steps()}, self);
    return columns;
  }

  void require_time(double time) const {
    const Trajectory& trajectory = simulation().trajectory;
    if (!(time >= trajectory.start_time() && time <= trajectory.end_time()))
      throw pybind11::index_error("t = " + exact_number(time) + " s is not within the run, which goes from " +
                                  exact_number(trajectory.start_time()) + " to " +
                                  exact_number(trajectory.end_time()) + " s");
  }
  pybind11::array at(double time) const {
    require_time(time);
    const VectorXd x =
        alone([time](const JudgedRun& run) { return run.simulation.trajectory.positions_at(time); });
    return pybind11::array_t<double>({nodes(), pybind11::ssize_t{3}}, x.data());
  }
  double measure(const std::string& name) const {
    std::vector<std::string> columns;
    for (const Series& column : diagnostics().columns) columns.push_back(column.name);
    const RunMeasure measure = find_measure(name, columns);
    return alone([&](const JudgedRun& run) { return measure.value(run.simulation, run.diagnostics); });
  }

 private:
  static const Run& of(const pybind11::object& self) { return self.cast<const Run&>(); }

  JudgedRun run_;
  std::shared_ptr<std::mutex> use_;  // of those that share a trajectory
  std::vector<double> t_, x_, v_, force_;
  std::vector<std::uint8_t> unique_;
};

}  // namespace unfurl
