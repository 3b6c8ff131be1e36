// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/rk4_klu.hpp"

#include <klu.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <vector>

namespace unfurl::bench {
namespace {

class Rk4Klu final : public Integrator {
 public:
  Rk4Klu(const System& system, const ConstVec& q)
      : system_(system), G_(system.jacobian_pattern()), q_(q), v_(q.size()), f_(q.size()) {
    const Index n = system.solved_coordinates(), m = system.constraints();
    pick_rows(q);
    const Index size = n + static_cast<Index>(rows_.size());
    matrix_.resize(size, size);
    fill();
    klu_defaults(&common_);
    symbolic_ =
        klu_analyze(static_cast<int>(size), matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), &common_);
    numeric_ =
        klu_factor(matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), matrix_.valuePtr(), symbolic_, &common_);
    if (!numeric_) throw std::runtime_error("KLU cannot factorise the index-1 matrix");
    b_.resize(size);
    bias_.resize(m);
    force_.resize(n);
    for (auto* k : {&dz_[0], &dz_[1], &dz_[2], &dz_[3], &dw_[0], &dw_[1], &dw_[2], &dw_[3]}) k->setZero(n);
  }
  ~Rk4Klu() override {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  Rk4Klu(const Rk4Klu&) = delete;
  Rk4Klu& operator=(const Rk4Klu&) = delete;

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
      accelerate(state.t + at[i] * h, dw_[i]);
    }
    state.z += h / 6.0 * (dz_[0] + 2.0 * dz_[1] + 2.0 * dz_[2] + dz_[3]);
    state.w += h / 6.0 * (dw_[0] + 2.0 * dw_[1] + 2.0 * dw_[2] + dw_[3]);
    state.t += h;
    return {};
  }
  void restart() override {}

 private:
  void pick_rows(const ConstVec& q) {
    system_.jacobian(q, G_, scratch_);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(MatrixXd(G_).transpose());
    qr.setThreshold(1e-9);
    for (Index i = 0; i < qr.rank(); ++i) rows_.push_back(qr.colsPermutation().indices()[i]);
    std::sort(rows_.begin(), rows_.end());
  }

  // [M G^T; G 0], the same pattern every time; places_ remembers where the entries of G go.
  void fill() {
    const Index n = system_.solved_coordinates();
    std::vector<Eigen::Triplet<double>> entries;
    const SparseRows& M = system_.mass();
    for (int r = 0; r < M.outerSize(); ++r)
      for (SparseRows::InnerIterator it(M, r); it; ++it) entries.emplace_back(r, it.col(), it.value());
    for (std::size_t k = 0; k < rows_.size(); ++k)
      for (SparseRows::InnerIterator it(G_, rows_[k]); it; ++it) {
        entries.emplace_back(n + static_cast<Index>(k), it.col(), it.value());
        entries.emplace_back(it.col(), n + static_cast<Index>(k), it.value());
      }
    matrix_.setFromTriplets(entries.begin(), entries.end());
    matrix_.makeCompressed();
    for (std::size_t k = 0; k < rows_.size(); ++k)
      for (SparseRows::InnerIterator it(G_, rows_[k]); it; ++it) {
        const Index row = n + static_cast<Index>(k);
        places_.push_back({&it.value() - G_.valuePtr(), &matrix_.coeffRef(row, it.col()) - matrix_.valuePtr(),
                           &matrix_.coeffRef(it.col(), row) - matrix_.valuePtr()});
      }
  }

  void accelerate(double t, VectorXd& acceleration) {
    const Index n = system_.solved_coordinates();
    system_.expand(z_, q_);
    system_.expand_rate(w_, v_);
    system_.jacobian(q_, G_, scratch_);
    for (const auto& [from, below, above] : places_)
      matrix_.valuePtr()[below] = matrix_.valuePtr()[above] = G_.valuePtr()[from];
    f_.setZero();
    system_.add_applied_force(t, q_, v_, 1.0, f_);
    system_.reduce_force(f_, force_);
    system_.constraint_bias(t, q_, v_, bias_);
    b_.head(n) = force_;
    for (std::size_t k = 0; k < rows_.size(); ++k) b_[n + static_cast<Index>(k)] = -bias_[rows_[k]];
    klu_refactor(matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), matrix_.valuePtr(), symbolic_, numeric_,
                 &common_);
    klu_solve(symbolic_, numeric_, static_cast<int>(b_.size()), 1, b_.data(), &common_);
    acceleration = b_.head(n);
  }

  struct Place {
    Index from, below, above;
  };
  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  std::vector<int> rows_;
  std::vector<Place> places_;
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> matrix_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  VectorXd q_, v_, f_, z_, w_, b_, bias_, force_;
  VectorXd dz_[4], dw_[4];
};

}  // namespace

std::unique_ptr<Integrator> make_rk4_klu(const System& system, const ConstVec& q) {
  return std::make_unique<Rk4Klu>(system, q);
}

}  // namespace unfurl::bench
