// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/build.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "core/forces/damping.hpp"
#include "core/forces/pin_loads.hpp"
#include "core/math/determined_rows.hpp"
#include "core/scene/element_members.hpp"
#include "core/scene/made_lengths.hpp"
#include "core/scene/size_limits.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/family.hpp"
#include "core/structures/rod_material.hpp"
#include "core/structures/segments.hpp"
#include "core/system/assemble_elastic.hpp"
#include "core/system/consistency.hpp"
#include "core/system/fit_lengths.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

// Where a key was given; failing that, where its table was.
SourceLocation location_of(const Scene& scene, const std::string& key) {
  for (std::string name = key; !name.empty();) {
    if (const auto it = scene.locations.find(name); it != scene.locations.end()) return it->second;
    const std::size_t dot = name.find_last_of(".[");
    if (dot == std::string::npos) break;
    name.resize(dot);
  }
  const auto structure = scene.locations.find("structure");
  return {structure == scene.locations.end() ? scene.name : structure->second.file, 0, 0};
}

[[noreturn]] void refuse(const Scene& scene, const StructureError& error) {
  const std::string key = error.key.empty() ? "structure" : "structure." + error.key;
  throw SceneError({{location_of(scene, key), key, error.message}});
}

Structure bare_structure(const Scene& scene) {
  try {
    require_buildable(scene);
    if (const Family* family = find_family(scene.kind)) return family->build(scene.structure);
    return build_custom(scene.custom);
  } catch (const StructureError& error) {
    refuse(scene, error);
  }
}

bool is_sector(const Structure& structure) {
  return structure.node_copies.size() > structure.nodes.size();
}

// A sector stands for the whole only when gravity looks the same from every copy.
void add_gravity(const Scene& scene, Structure& structure) {
  structure.gravity = scene.gravity;
  if (!is_sector(structure)) return;
  constexpr double round_off = 1e-12;  // of a rotation matrix and a product of three terms, with a margin
  for (const auto& copy : structure.node_copies) {
    if ((copy.map * scene.gravity - scene.gravity).norm() <= round_off * scene.gravity.norm()) continue;
    const std::string key = "gravity.acceleration";
    throw SceneError(
        {{location_of(scene, key), key,
          "must act along the axis of symmetry in a sector model; set structure.model to \"full\""}});
  }
}

// An element stands for itself in the whole structure: a sector would repeat it.
void refuse_elements(const Scene& scene) {
  for (const auto* list : {&scene.forces, &scene.constraints})
    for (const SceneElement& element : *list)
      if (element.enabled)
        throw SceneError({{element.where, element.key,
                           "cannot be used with a sector model; set structure.model to \"full\""}});
}

// Of the elements those that say where the nodes are at t = 0: what is held or driven, and what warms rods.
std::vector<SceneElement> placing(const std::vector<SceneElement>& elements,
                                  const std::vector<ElementKind>& kinds, bool forces) {
  std::vector<SceneElement> found;
  for (const SceneElement& e : elements) {
    const ElementKind& kind = *find_kind(kinds, e.kind);
    if (forces ? kind.members == Members::rods : !kind.bounds) found.push_back(e);
  }
  return found;
}

bool ends_deployed(const Scene& scene) {
  return !scene.deployment.terms.empty() && scene.solver.at_deployed == "stop";
}

// Moves the nodes to where they are at t = 0, which given lengths of rods say; what follows that is "as at
// t = 0" (rest lengths, limits, stowed values, ...) is taken there. Notes of what was moved.
std::vector<std::string> place_nodes(const Scene& scene, Structure& structure) {
  if (lengths_fit(structure)) return {};
  Structure placed = structure;
  placed.notes.clear();
  add_elements(placing(scene.forces, scene_forces(), true), scene_forces(), scene.solver.end_time,
               ends_deployed(scene), placed);
  add_elements(placing(scene.constraints, scene_constraints(), false), scene_constraints(),
               scene.solver.end_time, ends_deployed(scene), placed);
  warm_braces(placed);
  bend_to_ends(placed, false, false);
  placed.notes.clear();
  try {
    fit_lengths(placed, scene.solver.eliminate_linear);
    assemble_elastic(placed, scene.solver.eliminate_linear);
  } catch (const StructureError& error) {
    refuse(scene, of_made_lengths(scene, error));
  }
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    structure.nodes[i].position = placed.nodes[i].position;
  const VectorXd q = node_positions(structure);
  for (Stop& stop : structure.stops)  // cables that families have
    if (stop.reeled)
      stop.reel.offset = MeasureFunction(stop.measure, structure.deployment).value(q.data(), 0);
  if (Deployment& d = structure.deployment; d.folds()) {
    const auto left = [&d] { return d.initial_fold_angle - d.deployed_fold_angle; };
    const bool was_folded = left() > 0;
    d.initial_fold_angle = d.fold_angle(q);
    if (was_folded && !(left() > 0))
      refuse(scene, {"fold_angle",
                     "fold_angle is too near to the deployed pose: with the lengths that rods are "
                     "made with the structure starts beyond it"});
  }
  return placed.notes;
}

// Latches that give need something to latch.
void check_latches(const Scene& scene, Structure& structure) {
  for (const SceneElement& force : scene.forces) {
    if (force.kind != "latch" || !force.enabled) continue;
    if (structure.deployment.empty())
      throw SceneError({{force.where, force.key, "the structure has no deployed pose to latch in"}});
    if (scene.solver.at_deployed != "latch")
      structure.notes.push_back(
          problem_text({{}, force.key, "does nothing without solver.at_deployed = \"latch\""}));
  }
  if (!structure.deployment.measured || !structure.deployment.latches.empty()) return;
  for (Force& force : structure.forces)  // its angles count turns from the start
    if (force.kind == "latch") force.measure = structure.deployment.measure, force.slack = true;
}

// What happens in the deployed pose needs one.
void note_idle_at_deployed(const Scene& scene, Structure& structure) {
  const std::string key = "solver.at_deployed";
  if (!structure.deployment.empty() || scene.solver.at_deployed == SolverOptions().at_deployed) return;
  const auto place = scene.locations.find(key);
  structure.notes.push_back(problem_text({place == scene.locations.end() ? SourceLocation() : place->second,
                                          key, "does nothing: the structure has no deployed pose"}));
}

// The measure of a structure that has no fold angle, as [deployment] says.
void add_deployment(const Scene& scene, Structure& structure) {
  if (scene.deployment.terms.empty()) return;
  if (!structure.deployment.empty())
    throw SceneError(
        {{scene.deployment.where, scene.deployment.key,
          "is for structures that do not say themselves when they are deployed; " + scene.kind + " does"}});
  if (is_sector(structure)) refuse_elements(scene);
  give_deployment(scene, structure);
}

// A load on a solved node is a load on each of its copies.
void add_load(Structure& structure, int node, const Vec3& force) {
  structure.loads.push_back({node, force, true});
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const auto& copy = structure.node_copies[i];
    if (copy.source == node) structure.load_copies.push_back({static_cast<int>(i), copy.map * force});
  }
}

void add_loads(const Scene& scene, Structure& structure) {
  NameIndex names;
  for (const auto& node : structure.nodes) names.add(node.name);
  const std::vector<bool> within = nodes_within_rods(structure);
  std::vector<SceneProblem> problems;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const auto& load = scene.loads[i];
    if (!load.enabled) continue;
    const std::string key = "loads[" + std::to_string(i) + "].nodes";
    const auto problem = [&](const std::string& text) { problems.push_back({load.where, key, text}); };
    std::set<int> loaded;
    for (const auto& pattern : load.nodes) {
      std::vector<int> found = names.matching(pattern);
      const bool known = !found.empty();
      leave_nodes_within_rods(pattern, within, found);
      for (const int node : found) {
        if (loaded.insert(node).second)
          add_load(structure, node, load.force);
        else
          problem("names " + in_quotes(structure.nodes[static_cast<std::size_t>(node)].name) +
                  " more than once");
      }
      if (found.empty() && known) problem(only_within_rods(pattern));
      if (!known) problem("no node matches " + in_quotes(pattern) + did_you_mean(pattern, names.names()));
    }
  }
  if (!problems.empty()) throw SceneError(std::move(problems));
}

void fill_mass(const Scene& scene, System& system) {
  constexpr Index most = 3000;  // unknowns of a dense factorisation: 72 MB
  const Index unknowns = system.solved_coordinates() + system.constraints();
  if (unknowns > most)
    throw SceneError({{location_of(scene, "solver.sparse"), "solver.sparse",
                       "must be true for this structure: it has " + std::to_string(unknowns) +
                           " unknowns, and dense matrices are for " + std::to_string(most) + " at most"}});
  system.fill_mass();
}

bool is_fixed(const Structure& structure, int node) {
  return std::any_of(structure.constraints.begin(), structure.constraints.end(),
                     [&](const Constraint& c) { return c.kind == "fixed" && c.nodes == std::vector{node}; });
}

// Of two and three stages the forces of rods at points within a step are not those of the motion, of which
// the friction would then be wrong.
std::string too_few_stages(const Structure& structure, const VectorXd& mass, const Rod& rod,
                           const SolverOptions& solver) {
  if (solver.method != "dvm" || solver.stages >= 4 || solver.tolerance > 0) return "";
  double square = 0;  // of the frequency of the rod alone
  for (const int node : {rod.a, rod.b})
    if (!is_fixed(structure, node)) square += 1 / (rod.compliance() * mass[3 * static_cast<Index>(node)]);
  const double period = 2 * pi / std::sqrt(square);
  if (!(solver.step > period)) return "";
  std::ostringstream text;
  text.precision(3);
  text << "takes the force of rod " << rod.name << ", whose waves of " << period
       << " s the steps of solver.step do not follow: solver.stages must be at least 4 then";
  return text.str();
}

// Friction by the force of a pin, where rigid rods leave that open or it is no pin: one clear error.
std::string pin_problem(const Structure& structure, const System& system, const SolverOptions& solver,
                        const Force& force) {
  const int r = PinLoads::rod_of(structure, force);
  if (r < 0) return "needs the pin of a hinge: nodes = [A, HINGE, B] with a rod from A to HINGE";
  const Rod& rod = structure.rods[static_cast<std::size_t>(r)];
  const VectorXd mass = system.node_mass().diagonal();
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    if (!is_fixed(structure, static_cast<int>(i)) && !(mass[3 * static_cast<Index>(i)] > 0))
      return "needs nodes with mass, and " + in_quotes(structure.nodes[i].name) + " has none";
  if (rod.gives)
    if (const std::string problem = too_few_stages(structure, mass, rod, solver); !problem.empty())
      return problem;
  const VectorXd q = node_positions(structure);
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  system.jacobian(q, G, scratch);
  const std::vector<char> told = determined_rows(G);
  const RodCouples::Line line(structure, r, force.measure.nodes[0]);
  const std::vector<int> sources = system.sources();
  for (std::size_t i = 0; i < told.size(); ++i)
    if (const int c = sources[i]; !told[i] && c >= 0)
      if (const Constraint& holds = structure.constraints[static_cast<std::size_t>(c)];
          holds.kind == "measure" && line.tells(holds.measure))
        return "needs the force of the pin, and so the torque of " + in_quotes(holds.name) +
               ", which others leave open here: give a constant torque by kinetic, or remove one of them";
  const int row = system.rod_rows()[static_cast<std::size_t>(r)];
  if (row < 0 || told[static_cast<std::size_t>(row)]) return "";
  return "needs the force of the pin, which rigid rods leave open here (" + in_quotes(rod.name) +
         " is one of more rods than hold the structure): give a constant torque by kinetic, or rods that "
         "give "
         "(rod_model = \"elastic\")";
}

// What acts on nodes of plates, or of all of the structure, counts on nodes in a pin's force.
void note_plates(Structure& structure, const Force& force) {
  const RodCouples::Line line(structure, PinLoads::rod_of(structure, force), force.measure.nodes[0]);
  const auto note = [&](const std::string& name, const Measure& measure) {
    if (line.beside(measure, structure.deployment))
      structure.notes.push_back(
          "friction " + in_quotes(force.name) + ": " + in_quotes(name) +
          " acts on nodes (a dihedral, the fold angle); its torque does not count in the "
          "pin's force");
  };
  for (const Force& f : structure.forces) note(f.name, f.measure);
  for (const Constraint& c : structure.constraints)
    if (c.kind == "measure") note(c.name, c.measure);
  for (const Stop& stop : structure.stops) note(stop.name, stop.measure);
}

void check_pins(const Scene& scene, Structure& structure, const System& system) {
  const auto refuse_friction = [&](const std::string& name, const std::string& problem) {
    if (problem.empty()) return;
    for (const SceneElement& e : scene.forces)
      if (e.enabled && e.name == name) throw SceneError({{e.where, e.key + ".pin_friction", problem}});
  };
  for (const Force& force : structure.forces)
    if (PinLoads::arm(force) > 0) {
      refuse_friction(force.name, pin_problem(structure, system, scene.solver, force));
      note_plates(structure, force);
    }
  const auto locked =
      PinLoads::self_locking(structure, system.node_mass(), 0.0, node_positions(structure).data());
  refuse_friction(locked.friction, locked.problem);
}

// Does nothing push the structure out of the plane through `at`, in which all ends of its rods lie?
class FlatBy {
 public:
  FlatBy(const Structure& structure, const Vec3& normal, const Vec3& at)
      : structure_(structure), normal_(normal), at_(at), q_(node_positions(structure)) {}

  bool holds(bool latches) const {
    const Structure& s = structure_;
    const Deployment& d = s.deployment;
    return !across(s.gravity) &&
           std::ranges::all_of(s.rods,
                               [&](const Rod& rod) {
                                 return inside({rod.a, rod.b});
                               }) &&
           std::ranges::none_of(s.loads, [&](const Load& load) { return across(load.force); }) &&
           std::ranges::all_of(s.forces, [&](const Force& f) { return stays(f); }) &&
           std::ranges::all_of(s.stops, [&](const Stop& stop) { return along(stop.measure); }) &&
           std::ranges::all_of(s.constraints, [&](const Constraint& c) { return stays(c); }) &&
           !(latches && d.measured && !along(d.measure));
  }

 private:
  bool across(const Vec3& x) const { return std::abs(normal_.dot(x)) > 1e-12 * x.norm(); }
  bool inside(const std::vector<int>& nodes) const {
    return std::ranges::none_of(nodes, [&](int i) {
      const Node& node = structure_.nodes[static_cast<std::size_t>(i)];
      return !node.ghost && across(node.position - at_);
    });
  }
  bool stays(const Force& f) const {
    if (f.kind == "load_over_time" || f.kind == "follower" || f.kind == "offload") return false;
    return along(f.measure);
  }
  // One of a single node acts on that alone; one of several hands on what lies off the plane.
  bool stays(const Constraint& c) const {
    return (c.nodes.size() < 2 || inside(c.nodes)) && (c.kind != "measure" || along(c.measure));
  }
  // Does what acts on the measure act within the plane?
  bool along(const Measure& measure) const {
    if (measure.kind == MeasureKind::combination)
      return std::ranges::all_of(measure.terms, [&](const MeasureTerm& term) { return along(term.measure); });
    if (measure.kind == MeasureKind::fold) return true;  // a family's own, which is flat by itself
    if (measure.nodes.empty()) return true;
    // In a pose like this one it may turn within the plane; in others an axis that is not across it does not.
    if (measure.kind == MeasureKind::dihedral) return false;
    if (measure.kind == MeasureKind::angle && !measure.axis.cross(normal_).isZero(1e-12) &&
        !measure.axis.isZero(0.0))
      return false;
    const MeasureFunction function(measure, structure_.deployment);
    std::vector<double> gradient(function.stencil().size());
    function.value_and_gradient(q_.data(), gradient.data());
    for (std::size_t i = 0; i < measure.nodes.size(); ++i)
      if (!structure_.nodes[static_cast<std::size_t>(measure.nodes[i])].ghost &&
          across(Eigen::Map<const Vec3>(gradient.data() + 3 * i)))
        return false;
    return inside(measure.nodes);
  }

  const Structure& structure_;
  Vec3 normal_, at_;
  VectorXd q_;
};

// Planes that only say that a structure is flat are no supports.
void find_flat(Structure& structure, bool latches) {
  std::set<int> ends;
  for (const Rod& rod : structure.rods) ends.insert({rod.a, rod.b});
  for (const Constraint& c : structure.constraints)
    if (c.kind == "fixed") ends.erase(c.nodes.front());
  const auto plane_of = [](const Constraint& c, const Vec3& normal) {
    return c.kind == "plane" && c.vectors.front().cross(normal).isZero(1e-12);
  };
  if (ends.empty()) return;
  const int end = *ends.begin();
  for (const Constraint& of_one : structure.constraints) {  // the plane that all ends are in
    if (of_one.kind != "plane" || of_one.nodes.front() != end) continue;
    const Vec3 normal = of_one.vectors.front();
    std::set<int> others = ends;
    for (const Constraint& c : structure.constraints)
      if (plane_of(c, normal)) others.erase(c.nodes.front());
    const Vec3& at = structure.nodes[static_cast<std::size_t>(end)].position;
    if (!others.empty() || !FlatBy(structure, normal, at).holds(latches)) continue;
    for (Constraint& c : structure.constraints) c.symmetry = c.symmetry || plane_of(c, normal);
    return;
  }
}

void refuse_endless_runs(const Scene& scene, const Model& model) {
  const std::string problem = too_many_states(scene, model, machine_memory());
  if (!problem.empty()) throw SceneError({{location_of(scene, "solver.step"), "solver.step", problem}});
}

// Points of a load's table that no step tells apart are a jump: steps end on either side of it. Three of them
// may be a blow, of which nothing would be left.
void find_jumps(const Scene& scene, Structure& structure) {
  const double end = scene.solver.end_time,
               near = 1e-7 * (end > 0 ? std::min(scene.solver.step, end) : scene.solver.step);
  MemberFinder find(structure);
  for (const SceneElement& e : scene.forces) {
    if (!e.enabled || !may_jump(e.kind)) continue;
    TimeFunction f;
    f.kind = TimeFunction::Kind::linear;
    f.times = e.values.vector("times"), f.values = e.values.vector("values");
    if (!make_jumps(f, near))
      find.problem(e, e.table.empty() ? "times" : "table",
                   "has points within 1e-7 of solver.step of each other and another one beside them: no step "
                   "follows so short a blow; draw it out");
  }
  find.throw_problems();
  for (Force& f : structure.forces) make_jumps(f.size, near);
  // Ramps of drives as short are none.
  for (Constraint& c : structure.constraints) make_jumps(c.target, near);
  for (Stop& stop : structure.stops) make_jumps(stop.reel, near);
}

// A group that no rod is of, most likely misspelt.
void note_idle_materials(const Scene& scene, Structure& structure) {
  std::set<std::string_view> groups;
  for (const Rod& rod : structure.rods) groups.insert(rod.group);
  for (std::size_t i = 0; i < scene.render.materials.size(); ++i) {
    const std::string& group = scene.render.materials[i].group;
    if (std::ranges::any_of(groups, [&](std::string_view known) { return glob_match(group, known); }))
      continue;
    const std::string key = "render.materials[" + std::to_string(i) + "].group";
    structure.notes.push_back(problem_text({location_of(scene, key), key,
                                            "no rods are of the group " + in_quotes(group) +
                                                did_you_mean(group, {groups.begin(), groups.end()})}));
  }
}

}  // namespace

Structure build_structure(const Scene& scene) {
  Structure structure = bare_structure(scene);
  const std::vector<std::string> moves = place_nodes(scene, structure);
  add_gravity(scene, structure);
  add_loads(scene, structure);
  if (is_sector(structure)) refuse_elements(scene);
  add_elements(scene.forces, scene_forces(), scene.solver.end_time, ends_deployed(scene), structure);
  add_elements(scene.constraints, scene_constraints(), scene.solver.end_time, ends_deployed(scene),
               structure);
  warm_braces(structure);
  find_jumps(scene, structure);
  add_deployment(scene, structure);
  check_latches(scene, structure);
  note_idle_at_deployed(scene, structure);
  find_flat(structure, scene.solver.at_deployed == "latch");
  show_cables(structure);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    if (scene.surfaces[i].enabled)
      surface_nodes(scene.surfaces[i], "surfaces[" + std::to_string(i) + "].nodes", structure);
  note_idle_joints(structure);
  note_idle_materials(scene, structure);
  try {
    note_pins_between(structure);
    bend_to_ends(structure, PinLoads::any(structure), scene.solver.at_deployed == "latch");
  } catch (const StructureError& error) {
    refuse(scene, error);
  }
  for (const SceneProblem& warning : scene.warnings) structure.notes.push_back(problem_text(warning));
  for (const SceneProblem& warning : scene.warnings_on_path)
    structure.notes_on_path.push_back(problem_text(warning));
  structure.notes.insert(structure.notes.end(), moves.begin(), moves.end());
  return structure;
}

std::shared_ptr<const Model> build_model(const Scene& scene) {
  try {
    Structure structure = build_structure(scene);
    System system(structure, scene.solver.eliminate_linear);
    try {
      check_consistency(structure, system);
    } catch (const StructureError&) {
      refuse_warm_start(scene, structure);
      throw;
    }
    check_pins(scene, structure, system);
    if (!scene.solver.sparse) fill_mass(scene, system);
    auto model = std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
    refuse_endless_runs(scene, *model);
    return model;
  } catch (const StructureError& error) {
    refuse(scene, error);
  }
}

}  // namespace unfurl
