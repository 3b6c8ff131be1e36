// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/stretched.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "core/integrators/index1.hpp"
#include "core/math/determined_rows.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/elastic_sharing.hpp"

namespace unfurl {
namespace {

// Of one model, along its states.
class Stretch {
 public:
  Stretch(const Model& model, const VectorXd& q)
      : system_(model.system),
        G_(system_.jacobian_pattern()),
        compliance_(row_compliance(model)),
        index1_(system_, true),
        saddle_(system_.mass(), G_) {
    system_.jacobian(q, G_, scratch_);
    const std::vector<char> rigidly = determined_rows(G_);
    sharing_.emplace(model, std::find(rigidly.begin(), rigidly.end(), 0) == rigidly.end());
  }

  // False where the state's pose has no displacement of its own.
  bool at(const State& state, bool singular, VectorXd& u) {
    if (singular || compliance_.size() == 0) return false;
    VectorXd q(system_.coordinates()), acceleration(state.w.size()), lambda = state.lambda;
    system_.follow(state);
    system_.expand(state.z, q);
    if (!index1_.evaluate(state, acceleration, lambda)) return false;
    sharing_->share(state.t, q, false, lambda);
    system_.jacobian(q, G_, scratch_);
    if (!saddle_.factorise(G_)) return false;
    VectorXd x(state.z.size()), y(lambda.size());
    saddle_.solve(VectorXd::Zero(x.size()), compliance_.cwiseProduct(lambda), x, y);
    if (!x.allFinite()) return false;
    system_.expand_rate(x, q);
    u = q;
    return true;
  }

 private:
  System system_;  // follows the states
  SparseRows G_;
  std::vector<double> scratch_;
  VectorXd compliance_;
  Index1 index1_;
  SaddleSolver saddle_;
  std::optional<ElasticSharing> sharing_;
};

}  // namespace

void add_stretch(Trajectory& trajectory) {
  const Model* model = nullptr;
  std::unique_ptr<Stretch> stretch;
  VectorXd u = VectorXd::Zero(trajectory.model().system.coordinates());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (model != &trajectory.model(i)) {
      model = &trajectory.model(i);
      stretch = std::make_unique<Stretch>(*model, trajectory.node_positions(i));
    }
    stretch->at(trajectory.state(i), trajectory.report(i).singular_event, u);
    trajectory.add_stretch(i, u);
  }
}

}  // namespace unfurl
