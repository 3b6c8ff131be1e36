#include "core/model/consistency.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/model/structure_error.hpp"

namespace unfurl {
namespace {

constexpr Index max_coordinates = 900;
// Share of a row's length: positions typed with nine digits pass, a missing digit does not.
constexpr double violated = 1e-7;
// Of unit rows: round-off of a dense factorisation, far below the distance of real poses from singular ones.
constexpr double dependent = 1e-10;

std::string listed(const std::vector<std::string>& names, std::size_t most = 6) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) text += (i ? ", " : "") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

class Checker {
 public:
  Checker(const Structure& structure, const System& system)
      : system_(system),
        names_(system.all_names()),
        sources_(system.all_sources()),
        q_(system.coordinates()) {
    for (std::size_t i = 0; i < structure.nodes.size(); ++i)
      q_.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].position;
  }

  void run() {
    check_positions();
    if (system_.coordinates() > max_coordinates) return;
    const bool driven = !system_.drives().empty();
    if (!driven && system_.all_constraints() < system_.coordinates()) return;
    G_ = MatrixXd(system_.all_jacobian(q_));
    for (Index r = 0; r < G_.rows(); ++r)
      if (const double norm = G_.row(r).norm(); norm > 0) G_.row(r) /= norm;
    if (driven)
      for (const Drive& drive : system_.drives()) check_drive(drive);
    else
      check_freedom();
  }

 private:
  const std::string& name(Index row) const { return names_[static_cast<std::size_t>(row)]; }

  void check_positions() const {
    VectorXd phi(system_.all_constraints());
    system_.all_constraint_values(0.0, q_, phi);
    const VectorXd lengths = system_.all_lengths();
    const double reach = q_.size() ? q_.lpNorm<Eigen::Infinity>() : 0.0;
    std::vector<std::string> wrong;
    double worst = 0;
    for (Index r = 0; r < phi.size(); ++r) {
      if (std::abs(phi[r]) <= violated * std::max(lengths[r], reach)) continue;
      wrong.push_back(name(r));
      worst = std::max(worst, std::abs(phi[r]));
    }
    if (wrong.empty()) return;
    std::ostringstream text;
    text << "the structure cannot be assembled as given: " << listed(wrong)
         << (wrong.size() == 1 ? " is" : " are") << " violated at t = 0, by up to " << worst << " m";
    throw StructureError("", text.str());
  }

  // The other rows whose combination is row r; empty where there is none.
  std::vector<Index> combination(Index r) const {
    std::vector<Index> others;
    for (Index k = 0; k < G_.rows(); ++k)
      if (k != r) others.push_back(k);
    if (others.empty()) return {};
    const MatrixXd A = G_(others, Eigen::all).transpose();
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(A);
    const VectorXd row = G_.row(r).transpose(), y = solver.solve(row);
    if ((A * y - row).norm() > dependent * std::max(1.0, y.norm())) return {};
    std::vector<Index> found;
    for (std::size_t k = 0; k < others.size(); ++k)
      if (std::abs(y[static_cast<Index>(k)]) > 1e-6) found.push_back(others[k]);
    return found;
  }

  // A drive whose row follows from rows that stand still asks them to move.
  void check_drive(const Drive& drive) const {
    const auto row = std::find(sources_.begin(), sources_.end(), drive.constraint) - sources_.begin();
    std::vector<std::string> held;
    for (const Index k : combination(row)) {
      const auto is_it = [&](const Drive& d) {
        return d.constraint == sources_[static_cast<std::size_t>(k)];
      };
      if (std::any_of(system_.drives().begin(), system_.drives().end(), is_it))
        return;  // two drives may agree
      held.push_back(name(k));
    }
    if (held.empty()) return;
    throw StructureError("", "the drive " + drive.name + " moves what other constraints hold: " +
                                 listed(held) + "; remove the drive, or one of these");
  }

  void check_freedom() const {
    Eigen::ColPivHouseholderQR<MatrixXd> qr(G_);
    qr.setThreshold(1e-9);
    if (qr.rank() < G_.cols()) return;
    std::vector<std::string> members;
    for (auto n = names_.rbegin(); n != names_.rend(); ++n)  // what is held or driven by name comes first
      if (n->rfind("rod ", 0) != 0) members.push_back(*n);
    for (const auto& n : names_)
      if (n.rfind("rod ", 0) == 0) members.push_back(n);
    throw StructureError("", "nothing can move: " + std::to_string(names_.size()) + " constraints hold all " +
                                 std::to_string(G_.cols()) + " coordinates; free one of " + listed(members));
  }

  const System& system_;
  std::vector<std::string> names_;
  std::vector<int> sources_;
  VectorXd q_;
  MatrixXd G_;  // unit rows
};

}  // namespace

void check_consistency(const Structure& structure, const System& system) {
  Checker(structure, system).run();
}

}  // namespace unfurl
