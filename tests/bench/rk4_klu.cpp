// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/rk4_klu.hpp"

#include "tests/bench/klu_accelerations.hpp"

namespace unfurl::bench {
namespace {

class Rk4Klu final : public Integrator {
 public:
  Rk4Klu(const System& system, const ConstVec& q) : equations_(system, q) {
    const Index n = system.solved_coordinates();
    for (auto* k : {&dz_[0], &dz_[1], &dz_[2], &dz_[3], &dw_[0], &dw_[1], &dw_[2], &dw_[3]}) k->setZero(n);
  }

  StepReport step(State& state, double h) override {
    static constexpr double at[4] = {0.0, 0.5, 0.5, 1.0};
    for (int i = 0; i < 4; ++i) {
      z_ = state.z;
      w_ = state.w;
      if (i > 0) {
        z_ += at[i] * h * dz_[i - 1];
        w_ += at[i] * h * dw_[i - 1];
      }
      dz_[i] = w_;
      equations_.accelerate(state.t + at[i] * h, z_, w_, dw_[i]);
    }
    state.z += h / 6.0 * (dz_[0] + 2.0 * dz_[1] + 2.0 * dz_[2] + dz_[3]);
    state.w += h / 6.0 * (dw_[0] + 2.0 * dw_[1] + 2.0 * dw_[2] + dw_[3]);
    state.t += h;
    return {};
  }
  void restart() override {}

 private:
  KluAccelerations equations_;
  VectorXd z_, w_, dz_[4], dw_[4];
};

}  // namespace

std::unique_ptr<Integrator> make_rk4_klu(const System& system, const ConstVec& q) {
  return std::make_unique<Rk4Klu>(system, q);
}

}  // namespace unfurl::bench
