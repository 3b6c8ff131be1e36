// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/dop853_klu.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/bench/klu_accelerations.hpp"

namespace unfurl::bench {
namespace {

// Prince and Dormand 1981; coefficients and control of the step of Hairer, Norsett and Wanner, Solving
// Ordinary Differential Equations I, second edition, II.5 and II.10.
constexpr int stages = 12;
constexpr std::array<double, stages> nodes{0.0,
                                           0.05260015195876773,
                                           0.0789002279381516,
                                           0.1183503419072274,
                                           0.2816496580927726,
                                           0.3333333333333333,
                                           0.25,
                                           0.3076923076923077,
                                           0.6512820512820513,
                                           0.6,
                                           0.8571428571428571,
                                           1.0};
constexpr double weights[stages + 1][stages] = {
    {},
    {0.05260015195876773},
    {0.0197250569845379, 0.0591751709536137},
    {0.02958758547680685, 0.0, 0.08876275643042054},
    {0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792},
    {0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242},
    {0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125},
    {0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023},
    {0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
     20.154067550477894, -43.48988418106996},
    {0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
     15.279233632882423, -33.28821096898486, -0.020331201708508627},
    {-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
     -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196},
    {2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
     27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636},
    {0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
     0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259},
};
constexpr std::array<double, stages> fifth{0.01312004499419488,
                                           0.0,
                                           0.0,
                                           0.0,
                                           0.0,
                                           -1.2251564463762044,
                                           -0.4957589496572502,
                                           1.6643771824549864,
                                           -0.35032884874997366,
                                           0.3341791187130175,
                                           0.08192320648511571,
                                           -0.022355307863886294};
constexpr double third_first = 0.24409448818897638, third_ninth = 0.7338466882816118,
                 third_last = 0.022058823529411766;

class Dop853Klu final : public Integrator {
 public:
  Dop853Klu(const System& system, const ConstVec& q, double tolerance, bool pivoting)
      : equations_(system, q, pivoting), n_(system.solved_coordinates()), tolerance_(tolerance) {
    for (VectorXd& k : k_) k.setZero(2 * n_);
    for (VectorXd* v : {&y_, &stage_, &next_, &e5_, &e3_}) v->setZero(2 * n_);
  }

  StepReport step(State& state, double h) override {
    const double end = state.t + h;
    y_ << state.z, state.w;
    double t = state.t;
    if (!begun_) slope(t, y_, k_[0]);
    if (!begun_) h_ = first_step(h);
    begun_ = true;
    for (long count = 0; t < end * (1 - 1e-15); ++count) {
      const double now = std::min(h_, end - t);
      if (count > 1000000 || now < 1e-14 * end) return {.status = StepStatus::diverged};
      const double error = attempt(t, now);
      const double factor = std::clamp(0.9 * std::pow(error, -1.0 / 8), 1.0 / 3, 6.0);
      if (!(error <= 1)) {
        h_ = now * (std::isfinite(error) ? factor : 0.2);
        continue;
      }
      t += now;
      y_.swap(next_);
      k_[0].swap(k_[stages]);
      if (now >= 0.5 * h_ || factor < 1) h_ = now * factor;
    }
    state.z = y_.head(n_);
    state.w = y_.tail(n_);
    state.t = end;
    return {};
  }
  void restart() override { begun_ = false; }

 private:
  void slope(double t, const VectorXd& y, VectorXd& k) {
    k.head(n_) = y.tail(n_);
    z_ = y.head(n_);
    w_ = y.tail(n_);
    equations_.accelerate(t, z_, w_, a_);
    k.tail(n_) = a_;
  }

  // A share of the time in which the state changes by its own size; what follows corrects it.
  double first_step(double longest) const {
    const double rate = k_[0].tail(n_).norm();
    return std::min(longest, rate > 0 ? 0.1 * std::pow(tolerance_, 1.0 / 8) / std::sqrt(rate) : longest);
  }

  // The error as a share of the tolerance; next_ and the slope there.
  double attempt(double t, double h) {
    for (int i = 1; i <= stages; ++i) {
      VectorXd& y = i < stages ? stage_ : next_;
      y = y_;
      for (int j = 0; j < i; ++j)
        if (weights[i][j] != 0) y += h * weights[i][j] * k_[static_cast<std::size_t>(j)];
      slope(i < stages ? t + nodes[static_cast<std::size_t>(i)] * h : t + h, y,
            k_[static_cast<std::size_t>(i)]);
    }
    e5_.setZero();
    e3_.setZero();
    for (std::size_t j = 0; j < stages; ++j) {
      if (fifth[j] != 0) e5_ += fifth[j] * k_[j];
      if (weights[stages][j] != 0) e3_ += weights[stages][j] * k_[j];
    }
    e3_ -= third_first * k_[0] + third_ninth * k_[8] + third_last * k_[11];
    const auto scale = (tolerance_ * (1 + y_.array().abs().max(next_.array().abs()))).eval();
    const double five = (e5_.array() / scale).square().sum(), three = (e3_.array() / scale).square().sum();
    const double all = five + 0.01 * three;
    return all > 0 ? h * five / std::sqrt(all * static_cast<double>(2 * n_)) : 1e-10;
  }

  KluAccelerations equations_;
  Index n_;
  double tolerance_, h_ = 0;
  bool begun_ = false;
  std::array<VectorXd, stages + 1> k_;
  VectorXd y_, stage_, next_, e5_, e3_, z_, w_, a_;
};

}  // namespace

std::unique_ptr<Integrator> make_dop853_klu(const System& system, const ConstVec& q, double tolerance,
                                            bool pivoting) {
  return std::make_unique<Dop853Klu>(system, q, tolerance, pivoting);
}

}  // namespace unfurl::bench
