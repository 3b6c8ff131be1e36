// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/line_forces.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "core/diagnostics/drives.hpp"
#include "core/diagnostics/force_round_off.hpp"
#include "core/forces/pulleys.hpp"
#include "core/forces/spring.hpp"
#include "core/simulate/stops.hpp"
#include "core/structure/shown_lines.hpp"

namespace unfurl {

namespace {

constexpr double not_told = std::numeric_limits<double>::quiet_NaN();

bool is_axial_spring(const Force& force) {
  return force.kind == "spring" && force.measure.kind == MeasureKind::length;
}

// A spring or cable: N times how its measure changes with each of its lengths, from span to span.
class LinePull {
 public:
  LinePull(const Force& force, const Deployment& deployment) : measure_(force.measure, deployment) {
    if (Pulleys::rubs(force)) pulleys_.emplace(force, deployment);
    gradient_.resize(measure_.stencil().size());
    std::size_t first = 0;
    if (force.measure.terms.empty()) first_.push_back(0);
    for (const MeasureTerm& term : force.measure.terms) {
      first_.push_back(first);
      first += MeasureFunction(term.measure, deployment).stencil().size();
    }
  }

  // `force`: as it is in the model of the state, where it may have been let go.
  void go_to(const Force& force, double t, const VectorXd& q, const VectorXd& v) {
    const SpringLaw law = spring_law(force, t, q.data());
    const double s = measure_.value_and_gradient(q.data(), gradient_.data());
    pull_ = spring_pull(force, law, s, measure_.rate(gradient_.data(), v.data()) - law.rest_rate).tension;
    if (pulleys_) pulleys_->weigh(v.data(), gradient_.data());
  }

  // A length's gradient is of size one at either end.
  double of_span(std::size_t term) const {
    return pull_ * Eigen::Map<const Vec3>(gradient_.data() + first_[term] + 3).norm();
  }

 private:
  MeasureFunction measure_;
  std::optional<Pulleys> pulleys_;
  std::vector<double> gradient_;
  std::vector<std::size_t> first_;  // of each term, in the gradient
  double pull_ = 0;
};

// The columns of what reeled cables give, per stop; null: it is none.
std::vector<const Series*> reel_columns(const Model& model, const Diagnostics& diagnostics) {
  std::vector<const Series*> out(model.structure.stops.size(), nullptr);
  const Stops stops(model.structure);
  for (const DriveChannel& drive : drive_channels(model))
    if (drive.cable() >= 0)
      out[static_cast<std::size_t>(stops[static_cast<std::size_t>(drive.cable())].stop)] =
          diagnostics.find(drive.name() + ".force_N");
  return out;
}

}  // namespace

LineForces line_forces(const Simulation& run, const Diagnostics& diagnostics) {
  const Trajectory& trajectory = run.trajectory;
  const Structure& s = trajectory.structure();
  const std::vector<CableSpan> spans = cable_spans(s);
  const auto states = static_cast<Index>(diagnostics.t.size());
  LineForces out{MatrixXd::Constant(states, std::ssize(spans), not_told),
                 MatrixXd::Constant(states, std::ssize(s.forces), not_told)};
  std::vector<std::optional<LinePull>> pulls(s.forces.size());
  for (std::size_t k = 0; k < s.forces.size(); ++k)
    if (s.forces[k].kind == "cable" || is_axial_spring(s.forces[k]))
      pulls[k].emplace(s.forces[k], s.deployment);
  const std::vector<const Series*> reels = reel_columns(trajectory.model(), diagnostics);
  const double rounding = force_round_off(run);
  const auto known = [&](double force) { return std::abs(force) <= rounding ? 0.0 : force; };
  for (Index i = 0; i < states; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const VectorXd q = trajectory.node_positions(at), v = trajectory.node_velocities(at);
    const std::vector<Force>& forces = trajectory.model(at).structure.forces;
    for (std::size_t k = 0; k < pulls.size(); ++k) {
      if (!pulls[k]) continue;
      pulls[k]->go_to(forces[k], trajectory.time(at), q, v);
      if (is_axial_spring(forces[k])) out.springs(i, static_cast<Index>(k)) = known(pulls[k]->of_span(0));
    }
    for (Index l = 0; l < out.lines.cols(); ++l) {
      const CableSpan& span = spans[static_cast<std::size_t>(l)];
      if (span.force >= 0) {
        out.lines(i, l) = known(pulls[static_cast<std::size_t>(span.force)]->of_span(span.term));
      } else if (const Series* reel = reels[static_cast<std::size_t>(span.stop)]) {
        const std::vector<MeasureTerm>& terms = s.stops[static_cast<std::size_t>(span.stop)].measure.terms;
        const double share = terms.empty() ? 1 : std::abs(terms[span.term].coefficient);
        out.lines(i, l) = known(-reel->values[at] * share);
      }
    }
  }
  return out;
}

}  // namespace unfurl
