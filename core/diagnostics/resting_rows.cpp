// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/resting_rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/forces/pin_loads.hpp"

namespace unfurl {

RestingRows::RestingRows(const Model& model)
    : model_(model), led_(!model.system.drives().empty()), stops_(model.structure) {
  for (const Force& force : model.structure.forces)
    if (force.kind == "friction" && (force.holding > 0 || PinLoads::arm(force) > 0))
      frictions_.push_back(
          {force.measure, MeasureFunction(force.measure, model.structure.deployment), force.slip != 0});
  for (std::size_t i = 0; i < stops_.size(); ++i) held_.push_back(stops_.is_held(i, model.structure));
}

std::vector<char> RestingRows::at(const State& state, const State* next, double step) const {
  constexpr double still = 1e2, drifted = 1e5;  // of what counts as touching; what methods leave of it
  std::vector<char> rests(frictions_.size() + stops_.size(), 0);
  VectorXd q(model_.system.coordinates()), v(q.size()), gradient;
  model_.system.expand(state.z, q);
  model_.system.expand_rate(state.w, v);
  const auto stays = [&](const MeasureFunction& s) {
    gradient.resize(std::ssize(s.stencil()));
    s.value_and_gradient(q.data(), gradient.data());
    return std::abs(s.rate(gradient.data(), v.data())) * step <= still * stops_.touching(s);
  };
  for (std::size_t i = 0; i < frictions_.size(); ++i)
    rests[i] = !frictions_[i].slips || (led_ && stays(frictions_[i].function));
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    double rate = 0;
    const double gap = stops_.gap(i, state, q, v, rate), zero = drifted * stops_.touching(stops_[i].function);
    rests[frictions_.size() + i] = !held_[i] && gap <= zero && std::abs(rate) * step <= zero;
  }
  if (!next || std::find(rests.begin(), rests.end(), 1) == rests.end()) return rests;
  // What a drive only sets out from, against friction, holds nothing.
  model_.system.expand(next->z, q);
  model_.system.expand_rate(next->w, v);
  for (std::size_t i = 0; i < frictions_.size(); ++i)
    if (rests[i] && frictions_[i].slips) rests[i] = stays(frictions_[i].function);
  return rests;
}

SparseRows RestingRows::behind(const SparseRows& G, const ConstVec& q, const std::vector<char>& rests) const {
  if (std::ranges::count(rests, 0) == std::ssize(rests)) return G;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index r = 0; r < G.rows(); ++r)
    for (SparseRows::InnerIterator it(G, r); it; ++it)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
  auto row = static_cast<int>(G.rows());
  VectorXd gradient, n(q.size()), reduced(G.cols());
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (!rests[i]) continue;
    const MeasureFunction& s = function(i);
    gradient.resize(std::ssize(s.stencil()));
    s.value_and_gradient(q.data(), gradient.data());
    n.setZero();
    for (std::size_t k = 0; k < s.stencil().size(); ++k) n[s.stencil()[k]] += gradient[static_cast<Index>(k)];
    if (G.cols() == q.size())
      reduced = n;
    else
      model_.system.reduce_force(n, reduced);
    for (Index c = 0; c < reduced.size(); ++c)
      if (reduced[c] != 0 && std::isfinite(reduced[c]))
        entries.emplace_back(row, static_cast<int>(c), reduced[c]);
    ++row;
  }
  SparseRows out(row, G.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

VectorXd RestingRows::behind(const VectorXd& compliance, Index rows) {
  if (compliance.size() == 0) return compliance;
  VectorXd all = VectorXd::Zero(rows);
  all.head(compliance.size()) = compliance;
  return all;
}

std::vector<int> RestingRows::cables(const std::vector<char>& rests) const {
  std::vector<int> out;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (!rests[i]) continue;
    const bool cable = i >= frictions_.size() && stops_[i - frictions_.size()].reeled;
    out.push_back(cable ? static_cast<int>(i - frictions_.size()) : -1);
  }
  return out;
}

std::vector<Measure> RestingRows::measures(const std::vector<char>& rests) const {
  std::vector<Measure> out;
  for (std::size_t i = 0; i < rests.size(); ++i)
    if (rests[i])
      out.push_back(i < frictions_.size() ? frictions_[i].measure : stops_[i - frictions_.size()].measure);
  return out;
}

}  // namespace unfurl
