// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/ida_reference.hpp"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <time.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

#include "core/integrators/index1.hpp"

namespace unfurl::testing {
namespace {

using Map = Eigen::Map<VectorXd>;
using Columns = Eigen::SparseMatrix<double, Eigen::ColMajor, sunindextype>;

// The equations with y = (z, w, lambda, mu), the last two for the picked rows.
class Equations {
 public:
  Equations(const System& system, const State& start)
      : system_(system),
        n_(system.solved_coordinates()),
        G_(system.jacobian_pattern()),
        Gw_(G_),
        G0_(G_),
        q_(system.coordinates()),
        v_(system.coordinates()),
        f_(system.coordinates()),
        phi_(system.constraints()),
        lambda_(system.constraints()),
        mu_(system.constraints()) {
    system.expand(start.z, q_);
    system.jacobian(q_, G_, scratch_);
    system.jacobian(VectorXd::Zero(q_.size()), G0_, scratch_);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(MatrixXd(G_).transpose());
    qr.setThreshold(1e-9);
    for (Index i = 0; i < qr.rank(); ++i) rows_.push_back(qr.colsPermutation().indices()[i]);
    std::sort(rows_.begin(), rows_.end());
    for (const Index row : rows_) list_curvature(row);
    system.expand_rate(start.w, v_);
    rate_.resize(system.constraints());
    lambda_.setOnes();
    mu_.setOnes();
    assemble(1.0, true);
  }
  Index size() const { return 2 * n_ + 2 * picked(); }
  Index picked() const { return static_cast<Index>(rows_.size()); }
  Index n() const { return n_; }
  const std::vector<Index>& rows() const { return rows_; }
  Index nonzeros() const { return matrix_.nonZeros(); }

  void residual(double t, const double* y, const double* dy, double* r) {
    read(y);
    const Eigen::Map<const VectorXd> w(y + n_, n_), dz(dy, n_), dw(dy + n_, n_);
    Map r1(r, n_), r2(r + n_, n_);
    f_.setZero();
    system_.add_applied_force(t, q_, v_, -1.0, f_);
    system_.add_constraint_force(q_, lambda_, 1.0, f_);
    system_.reduce_force(f_, r2);
    r2 += system_.mass() * dw;
    f_.setZero();
    system_.add_constraint_force(q_, mu_, 1.0, f_);
    system_.reduce_force(f_, r1);
    r1 += system_.mass() * (dz - w);
    system_.constraint(t, q_, phi_);
    system_.jacobian(q_, G_, scratch_);
    rate_.noalias() = G_ * w;
    for (Index i = 0; i < picked(); ++i) {
      r[2 * n_ + i] = phi_[rows_[static_cast<std::size_t>(i)]];
      r[2 * n_ + picked() + i] = rate_[rows_[static_cast<std::size_t>(i)]];
    }
  }

  // d residual / dy + cj d residual / dy', in the matrix of IDA.
  void jacobian(double cj, const double* y, SUNMatrix J) {
    read(y);
    system_.jacobian(q_, G_, scratch_);
    assemble(cj, false);
    std::copy_n(matrix_.outerIndexPtr(), matrix_.outerSize() + 1, SM_INDEXPTRS_S(J));
    std::copy_n(matrix_.innerIndexPtr(), matrix_.nonZeros(), SM_INDEXVALS_S(J));
    std::copy_n(matrix_.valuePtr(), matrix_.nonZeros(), SM_DATA_S(J));
  }

 private:
  void read(const double* y) {
    system_.expand(Eigen::Map<const VectorXd>(y, n_), q_);
    system_.expand_rate(Eigen::Map<const VectorXd>(y + n_, n_), v_);
    lambda_.setZero();
    mu_.setZero();
    for (Index i = 0; i < picked(); ++i) {
      lambda_[rows_[static_cast<std::size_t>(i)]] = y[2 * n_ + i];
      mu_[rows_[static_cast<std::size_t>(i)]] = y[2 * n_ + picked() + i];
    }
  }

  // Phi is quadratic: its curvature is the same at every pose.
  void list_curvature(Index row) {
    lambda_.setZero();
    lambda_[row] = 1.0;
    const SparseRows H = system_.curvature(q_, lambda_);
    for (int i = 0; i < H.outerSize(); ++i)
      for (SparseRows::InnerIterator it(H, i); it; ++it)
        if (it.value() != 0.0) curves_.push_back({row, i, it.col(), it.value()});
  }

  // Visits the entries in the same order every time; the first time they make the pattern.
  void assemble(double cj, bool first) {
    entries_.clear();
    const Index z = 0, w = n_, l = 2 * n_, m = 2 * n_ + picked();
    add(system_.mass(), cj, z, z);
    add(system_.mass(), -1.0, z, w);
    add(system_.mass(), cj, w, w);
    for (const Curve& c : curves_) {
      entries_.emplace_back(z + c.i, z + c.j, mu_[c.row] * c.value);
      entries_.emplace_back(w + c.i, z + c.j, lambda_[c.row] * c.value);
    }
    // Phi is quadratic, G affine: d(G w)/dz = G(v) - G(0).
    system_.jacobian(v_, Gw_, scratch_);
    for (Index i = 0; i < picked(); ++i) {
      const Index row = rows_[static_cast<std::size_t>(i)];
      SparseRows::InnerIterator g(G_, row), gw(Gw_, row), g0(G0_, row);
      for (; g; ++g, ++gw, ++g0) {
        entries_.emplace_back(z + g.col(), m + i, g.value());
        entries_.emplace_back(w + g.col(), l + i, g.value());
        entries_.emplace_back(l + i, z + g.col(), g.value());
        entries_.emplace_back(m + i, w + g.col(), g.value());
        entries_.emplace_back(m + i, z + g.col(), gw.value() - g0.value());
      }
    }
    if (first) make_pattern();
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    for (std::size_t e = 0; e < entries_.size(); ++e) matrix_.valuePtr()[place_[e]] += entries_[e].value();
  }

  void add(const SparseRows& A, double scale, Index row, Index column) {
    for (int r = 0; r < A.outerSize(); ++r)
      for (SparseRows::InnerIterator it(A, r); it; ++it)
        entries_.emplace_back(row + r, column + it.col(), scale * it.value());
  }

  void make_pattern() {
    matrix_.resize(size(), size());
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    matrix_.makeCompressed();
    for (const auto& e : entries_) {
      const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[e.col()];
      const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[e.col() + 1];
      place_.push_back(std::lower_bound(begin, end, e.row()) - matrix_.innerIndexPtr());
    }
  }

  const System& system_;
  Index n_;
  SparseRows G_, Gw_, G0_;
  std::vector<double> scratch_;
  VectorXd q_, v_, f_, phi_, rate_, lambda_, mu_;
  std::vector<Index> rows_;
  struct Curve {
    Index row, i, j;
    double value;  // entry (i, j) of Hess Phi_row
  };
  std::vector<Curve> curves_;
  std::vector<Eigen::Triplet<double, sunindextype>> entries_;
  std::vector<std::ptrdiff_t> place_;
  Columns matrix_;
};

int residual(realtype t, N_Vector y, N_Vector dy, N_Vector r, void* data) {
  static_cast<Equations*>(data)->residual(t, NV_DATA_S(y), NV_DATA_S(dy), NV_DATA_S(r));
  return Map(NV_DATA_S(r), NV_LENGTH_S(r)).allFinite() ? 0 : 1;
}

int jacobian(realtype, realtype cj, N_Vector y, N_Vector, N_Vector, SUNMatrix J, void* data, N_Vector,
             N_Vector, N_Vector) {
  static_cast<Equations*>(data)->jacobian(cj, NV_DATA_S(y), J);
  return 0;
}

void silent(int, const char*, const char*, char*, void*) {}  // reasons are in IdaRun::message

void require(int flag, const char* what) {
  if (flag != 0) throw std::runtime_error(std::string("IDA: ") + what);
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// IDA's own objects, released in reverse order.
class Ida {
 public:
  Ida(Equations& equations, const System& system, const State& start, const IdaOptions& options)
      : equations_(equations) {
    require(SUNContext_Create(nullptr, &context_), "context");
    const auto size = static_cast<sunindextype>(equations.size());
    y_ = N_VNew_Serial(size, context_);
    dy_ = N_VClone(y_);
    id_ = N_VClone(y_);
    tolerance_ = N_VClone(y_);
    set_start(system, start);
    memory_ = IDACreate(context_);
    require(IDAInit(memory_, residual, start.t, y_, dy_), "init");
    set_tolerances(options);
    require(IDASVtolerances(memory_, options.relative_tolerance, tolerance_), "tolerances");
    require(IDASetUserData(memory_, &equations), "data");
    require(IDASetErrHandlerFn(memory_, silent, nullptr), "messages");
    require(IDASetMaxNumSteps(memory_, options.max_steps), "steps");
    require(IDASetId(memory_, id_), "id");
    require(IDASetSuppressAlg(memory_, SUNTRUE), "error test");
    matrix_ = SUNSparseMatrix(size, size, static_cast<sunindextype>(equations.nonzeros()), CSC_MAT, context_);
    solver_ = SUNLinSol_KLU(y_, matrix_, context_);
    require(IDASetLinearSolver(memory_, solver_, matrix_), "linear solver");
    require(IDASetJacFn(memory_, jacobian), "jacobian");
  }
  ~Ida() {
    IDAFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    for (N_Vector v : {tolerance_, id_, dy_, y_}) N_VDestroy(v);
    SUNContext_Free(&context_);
  }
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;

  bool advance(double t, State& state) {
    double reached = 0;
    flag_ = IDASolve(memory_, t, &reached, y_, dy_, IDA_NORMAL);
    if (flag_ < 0) return false;
    const Index n = equations_.n();
    const double* y = NV_DATA_S(y_);
    state.t = reached;
    state.z = Eigen::Map<const VectorXd>(y, n);
    state.w = Eigen::Map<const VectorXd>(y + n, n);
    state.lambda.setZero();
    for (Index i = 0; i < equations_.picked(); ++i)
      state.lambda[equations_.rows()[static_cast<std::size_t>(i)]] = y[2 * n + i];
    return true;
  }

  void report(IdaRun& run) {
    IDAGetNumSteps(memory_, &run.steps);
    IDAGetNumResEvals(memory_, &run.residuals);
    IDAGetNumJacEvals(memory_, &run.jacobians);
    run.ok = flag_ >= 0;
    if (run.ok) return;
    char* name = IDAGetReturnFlagName(flag_);
    run.message = name;
    std::free(name);
  }

 private:
  // Multipliers follow from the coordinates and are the less determined the smaller the step: they take part
  // in neither the error test nor that of Newton's convergence.
  void set_tolerances(const IdaOptions& options) {
    N_VConst(1e10, tolerance_);
    Map(NV_DATA_S(tolerance_), equations_.size())
        .head(2 * equations_.n())
        .setConstant(options.absolute_tolerance);
  }

  void set_start(const System& system, const State& start) {
    const Index n = equations_.n();
    N_VConst(0.0, y_);
    N_VConst(0.0, dy_);
    N_VConst(0.0, id_);
    Map y(NV_DATA_S(y_), equations_.size()), dy(NV_DATA_S(dy_), equations_.size());
    Map(NV_DATA_S(id_), equations_.size()).head(2 * n).setOnes();
    VectorXd acceleration(n), lambda(system.constraints());
    Index1(system).evaluate(start.t, start.z, start.w, acceleration, lambda);
    y.head(n) = start.z;
    y.segment(n, n) = start.w;
    dy.head(n) = start.w;
    dy.segment(n, n) = acceleration;
    // Multipliers of the picked rows alone: the same constraint force.
    SparseRows G = system.jacobian_pattern();
    std::vector<double> scratch;
    VectorXd q(system.coordinates());
    system.expand(start.z, q);
    system.jacobian(q, G, scratch);
    MatrixXd picked(n, equations_.picked());
    for (Index i = 0; i < equations_.picked(); ++i)
      picked.col(i) = G.row(equations_.rows()[static_cast<std::size_t>(i)]).transpose();
    y.segment(2 * n, equations_.picked()) =
        picked.colPivHouseholderQr().solve(VectorXd(G.transpose() * lambda));
  }

  Equations& equations_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, dy_ = nullptr, id_ = nullptr, tolerance_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
  int flag_ = 0;
};

}  // namespace

IdaRun solve_with_ida(const System& system, const State& start, const std::vector<double>& times,
                      const IdaOptions& options) {
  Equations equations(system, start);
  Ida ida(equations, system, start, options);
  IdaRun run;
  State state = start;
  const double begin = cpu_seconds();
  for (const double t : times) {
    if (!ida.advance(t, state)) break;
    run.states.push_back(state);
  }
  run.cpu_s = cpu_seconds() - begin;
  ida.report(run);
  return run;
}

}  // namespace unfurl::testing
