// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/path_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "core/constraints/linear_rows.hpp"
#include "core/math/chebyshev.hpp"
#include "core/path/path_forces.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/path_time.hpp"
#include "core/scene/build.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/simulate/latch.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structures/family.hpp"

namespace unfurl {
namespace {

constexpr long most_path_pieces = 48;  // either way from where a path is traced
constexpr double same_length = 1e-13;  // of rods that are equal but for the rounding of their nodes
constexpr double least_sine = 1e-3;    // nearer to the deployed pose a point goes the usual way
constexpr double least_force = 1e-9;   // along the path, as a share of all forces: below it hangs

bool same(const LinearForm& a, const LinearForm& b) {
  if (a.nodes != b.nodes || a.offset != b.offset) return false;
  for (std::size_t i = 0; i < a.coefficients.size(); ++i)
    if (a.coefficients[i] != b.coefficients[i]) return false;
  return true;
}

bool near(double a, double b, double size) {
  return std::abs(a - b) <= same_length * size;
}

bool same_constraints(const Structure& a, const Structure& b, double size) {
  return std::equal(a.constraints.begin(), a.constraints.end(), b.constraints.begin(), b.constraints.end(),
                    [&](const Constraint& x, const Constraint& y) {
                      return x.kind == y.kind && x.nodes == y.nodes && x.vectors == y.vectors &&
                             near(x.value, y.value, size) && x.kind != "measure";
                    });
}

// Two poses of one mechanism.
bool same_mechanism(const Structure& a, const Structure& b, double size) {
  const auto rods = [&](const Rod& x, const Rod& y) {
    return x.a == y.a && x.b == y.b && x.mass == y.mass && x.multiplicity == y.multiplicity &&
           near(x.length, y.length, size);
  };
  return a.nodes.size() == b.nodes.size() && a.sectors == b.sectors && a.lumped_mass == b.lumped_mass &&
         std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(),
                    [](const Node& x, const Node& y) { return x.mass == y.mass; }) &&
         std::equal(a.rods.begin(), a.rods.end(), b.rods.begin(), b.rods.end(), rods) &&
         same_constraints(a, b, size) && same(remaining_form(a.deployment), remaining_form(b.deployment));
}

bool plain(const Structure& structure) {
  return structure.forces.empty() && structure.stops.empty() && structure.deployment.folds() &&
         !structure.deployment.measured && unknown_to_path(structure).empty() &&
         std::all_of(structure.nodes.begin(), structure.nodes.end(),
                     [](const Node& node) { return node.velocity.isZero(0.0); });
}

VectorXd forces_on_nodes(const Structure& structure, const System& system) {
  VectorXd f = VectorXd::Zero(system.coordinates());
  for (const Load& load : structure.loads) f.segment<3>(3 * static_cast<Index>(load.node)) += load.force;
  if (structure.gravity.isZero(0.0)) return f;
  return f + system.node_mass() * structure.gravity.replicate(f.size() / 3, 1);
}

}  // namespace

// A path with the deployed poses nearest to where it was traced from.
struct PathSweep::Traced {
  std::shared_ptr<const Model> model;
  std::shared_ptr<const Path> path;
  double size = 0;
  LinearForm form;  // whose zero is the deployed pose
  std::optional<double> ahead, behind;
};

struct PathSweep::Data {
  const SweepPlan& plan;
  Scene base;  // scenes differ from it in numbers of the structure only
  const Family& family;
  std::vector<std::string> names;  // of those, one for each axis
  std::vector<char> keeps_path;    // axes along which the mechanism stays the same
  mutable std::mutex mutex;
  mutable std::vector<std::unique_ptr<Scene>> idle;
  mutable std::map<std::vector<std::size_t>, std::shared_ptr<const Traced>> traced;

  std::vector<std::size_t> places(std::size_t point) const {
    std::vector<std::size_t> at(plan.axes.size());
    for (std::size_t a = plan.axes.size(); a-- > 0;) {
      at[a] = point % plan.axes[a].values.size();
      point /= plan.axes[a].values.size();
    }
    return at;
  }

  std::unique_ptr<Scene> borrow() const {
    const std::lock_guard lock(mutex);
    if (idle.empty()) return std::make_unique<Scene>(base);
    auto scene = std::move(idle.back());
    idle.pop_back();
    return scene;
  }
  void give_back(std::unique_ptr<Scene> scene) const {
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(scene));
  }

  // False where a value is out of its range.
  bool place(Scene& scene, const std::vector<std::size_t>& at) const {
    for (std::size_t a = 0; a < names.size(); ++a) {
      const double value = plan.axes[a].numbers[at[a]];
      for (const ParamSpec& spec : family.params())
        if (spec.name == names[a] && !range_error(spec, value).empty()) return false;
      scene.structure.set(names[a], value);
    }
    return true;
  }

  Structure structure(const std::vector<std::size_t>& at) const {
    auto scene = borrow();
    if (!place(*scene, at)) throw PathRefused("out of range");
    Structure out = build_structure(*scene);
    give_back(std::move(scene));
    return out;
  }

  // nullptr: there is none.
  std::shared_ptr<const Traced> path_of(std::vector<std::size_t> at) const {
    for (std::size_t a = 0; a < at.size(); ++a)
      if (keeps_path[a]) at[a] = 0;
    const std::lock_guard lock(mutex);
    if (const auto found = traced.find(at); found != traced.end()) return found->second;
    std::shared_ptr<const Traced> made;
    try {
      Scene scene = base;
      if (place(scene, at)) made = trace(scene);
    } catch (const Error&) {
    }
    return traced[at] = made;
  }

  static std::shared_ptr<const Traced> trace(const Scene& scene) {
    Traced out;
    out.model = build_model(scene);
    if (!plain(out.model->structure)) return nullptr;
    out.path = trace_path(out.model);
    out.size = out.model->system.constraint_lengths().maxCoeff();
    out.form = remaining_form(out.model->structure.deployment);
    out.ahead = deployed_pose(*out.path, out.model->structure.deployment, true, most_path_pieces);
    out.behind = deployed_pose(*out.path, out.model->structure.deployment, false, most_path_pieces);
    return std::make_shared<const Traced>(std::move(out));
  }

  // From rest in the structure's pose to the deployed one [s]; NaN where that is not to be had so.
  double time(const Structure& structure, const Traced& on) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const System& system = on.model->system;
    const VectorXd q = node_positions(structure), force = forces_on_nodes(structure, system);
    if (!(on.form(q) > least_sine)) return nan;
    const auto s = on.path->locate(on.path->system().reduce(q), most_path_pieces);
    if (!s) return nan;
    const PathPiece& piece = *on.path->piece(*on.path->piece_of(*s));
    const VectorXd Q = (force.transpose() * piece.dq * chebyshev_transform(Path::degree)).transpose();
    const double push = chebyshev_value(Q.data(), Q.size(), piece.x_of(*s));
    const double all = force.cwiseAbs().dot(piece.dq.cwiseAbs().rowwise().maxCoeff());
    if (!(std::abs(push) > least_force * all)) return nan;
    const auto& to = push > 0 ? on.ahead : on.behind;
    return to ? time_from_rest(*on.path, force, *s, *to) : nan;
  }
};

namespace {

// Numbers of the structure that a family reads as they are, one for each axis; empty where an axis is none.
std::vector<std::string> plain_numbers(const SweepPlan& plan, const Family& family) {
  constexpr std::string_view table = "structure.";
  std::vector<std::string> names;
  for (const SweepAxis& axis : plan.axes) {
    if (!axis.key.starts_with(table) || axis.numbers.empty()) return {};
    const std::string name = axis.key.substr(table.size());
    const auto spec = std::find_if(family.params().begin(), family.params().end(),
                                   [&](const ParamSpec& s) { return s.name == name; });
    if (spec == family.params().end() || spec->kind != ParamKind::real) return {};
    names.push_back(name);
  }
  return names;
}

// Scenes with a number put into them are those that are read with it. Of a value that is no TOML (".5", an
// error) it is said of its point.
bool read_alike(const SweepPlan& plan, const Scene& base, const std::vector<std::string>& names) {
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (const std::string& value : plan.axes[a].values) parse_toml("value = " + value + "\n", "");
    for (const std::size_t i : {std::size_t{0}, plan.axes[a].values.size() - 1}) {
      Scene put = base;
      put.structure.set(names[a], plan.axes[a].numbers[i]);
      const Scene read = plan.source.read({plan.axes[a].key + "=" + plan.axes[a].values[i]});
      const Structure x = build_structure(put), y = build_structure(read);
      if (node_positions(x) != node_positions(y) || x.loads.size() != y.loads.size() ||
          !same_mechanism(x, y, 0.0))
        return false;
      for (std::size_t l = 0; l < x.loads.size(); ++l)
        if (x.loads[l].force != y.loads[l].force) return false;
    }
  }
  return true;
}

}  // namespace

PathSweep::PathSweep(const SweepPlan& plan) {
  const bool events = std::all_of(plan.measures.begin(), plan.measures.end(), [](const RunMeasure& measure) {
    return measure.needs == MeasureNeeds::events;
  });
  if (!events) return;
  try {
    Scene base = plan.source.read();
    const Family* family = find_family(base.kind);
    std::vector<std::string> varied;
    for (const SweepAxis& axis : plan.axes) varied.push_back(axis.key);
    if (!family || study_solver(base, varied, plan.measures).model == "full") return;
    const auto names = plain_numbers(plan, *family);
    if (names.empty() || !read_alike(plan, base, names)) return;
    data_.reset(new Data{plan, std::move(base), *family, names, {}, {}, {}, {}});
    const std::vector<std::size_t> first(names.size(), 0);
    const Structure here = data_->structure(first);
    const double size = reference_length(here);
    for (std::size_t a = 0; a < names.size(); ++a) {
      std::vector<std::size_t> other = first;
      other[a] = plan.axes[a].values.size() - 1;
      data_->keeps_path.push_back(same_mechanism(here, data_->structure(other), size) ? 1 : 0);
    }
  } catch (const Error&) {
    data_.reset();  // what is wrong is said of the points
  }
}

PathSweep::~PathSweep() = default;

bool PathSweep::measure(std::size_t point, std::vector<std::string>& row) const {
  if (!data_) return false;
  double time = 0;
  try {
    const auto at = data_->places(point);
    const auto on = data_->path_of(at);
    if (!on) return false;
    const Structure structure = data_->structure(at);
    if (!plain(structure) || !same_mechanism(structure, on->model->structure, on->size)) return false;
    time = data_->time(structure, *on);
  } catch (const Error&) {
    return false;
  }
  if (std::isnan(time)) return false;
  const SolverOptions& solver = data_->base.solver;
  const bool in_time = time <= solver.end_time, stops = in_time && solver.at_deployed == "stop";
  row.emplace_back(to_string(stops ? RunStatus::deployed : RunStatus::completed));
  for (const RunMeasure& measure : data_->plan.measures)
    row.push_back(exact_number(measure.name == "end_time" ? (stops ? time : solver.end_time)
                               : in_time                  ? time
                                                          : std::numeric_limits<double>::infinity()));
  return true;
}

}  // namespace unfurl
