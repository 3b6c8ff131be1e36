// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "core/integrators/integrator.hpp"
#include "core/scene/custom_reader.hpp"
#include "core/scene/key_tables.hpp"
#include "core/scene/table_reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/title.hpp"
#include "core/scene/variables.hpp"
#include "core/structures/family.hpp"
#include "core/structures/rod_material.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr double max_steps = 1e9;
constexpr double time_to_deploy = 60.0;  // end_time where a scene gives none and its structure can deploy [s]

// Where a table is, or would be.
const SourceLocation& place(const TomlTree* table, const TomlTree& root) {
  return table ? table->where : root.where;
}

ParamSpec kind_param() {
  std::vector<std::string_view> kinds;
  for (const auto& family : families()) kinds.push_back(family.kind);
  kinds.push_back("custom");
  return required(choice_param("kind", "", std::move(kinds), ""));
}

void read_structure(TableReader& root, const TomlTree& tree, const std::string& folder, Scene& scene,
                    SceneNotes& notes) {
  const TomlTree* found = root.table("structure");
  if (!found) {
    if (!root.has("structure")) root.problem("structure", "is missing; a scene needs a [structure] table");
    return;
  }
  TableReader table(found, "structure", place(found, tree), notes);
  scene.kind = table.read({kind_param()}).text("kind");
  if (scene.kind.empty()) return;  // its other keys mean nothing without it
  if (const Family* family = find_family(scene.kind)) {
    scene.structure = table.read(family->params());
    table.warn_idle(family->params(), scene.structure);
  } else {
    scene.custom = read_custom(table, folder, notes, scene.constraints);
    ParamSet material = rod_material_values(scene.custom.material);
    // What says how elastic rods give is of use to one that is so by itself.
    if (std::ranges::any_of(scene.custom.rods,
                            [](const CustomRod& rod) { return rod.elastic.value_or(false); }))
      material.set("rod_model", "elastic");
    table.warn_idle(rod_material_params(), material);
  }
  table.finish();
}

void read_gravity(TableReader& root, const TomlTree& tree, Scene& scene, SceneNotes& notes) {
  const TomlTree* found = root.table("gravity");
  TableReader table(found, "gravity", place(found, tree), notes);
  const auto values = table.read(gravity_params());
  const auto& a = values.vector("acceleration");
  scene.gravity = {a[0], a[1], a[2]};
  table.finish();
}

void read_loads(TableReader& root, Scene& scene, SceneNotes& notes) {
  for (const TomlTree* tree : root.tables("loads")) {
    const std::string key = "loads[" + std::to_string(scene.loads.size()) + "]";
    TableReader entry(tree, key, tree->where, notes);
    SceneLoad load;
    load.nodes = entry.names("nodes");
    const auto values = entry.read(load_params());
    const auto& f = values.vector("force");
    load.force = {f[0], f[1], f[2]};
    load.enabled = values.boolean("enabled");
    load.where = tree->find("nodes") ? tree->find("nodes")->where : tree->where;
    entry.finish();
    scene.loads.push_back(std::move(load));
  }
}

void read_surfaces(TableReader& root, Scene& scene, SceneNotes& notes) {
  for (const TomlTree* tree : root.tables("surfaces")) {
    TableReader entry(tree, "surfaces[" + std::to_string(scene.surfaces.size()) + "]", tree->where, notes);
    std::vector<std::string> nodes = entry.names("nodes");
    const ParamSet values = entry.read(surface_params());
    entry.warn_idle(surface_params(), values);
    SceneSurface surface = scene_surface(values);
    surface.nodes = std::move(nodes);
    surface.where = tree->find("nodes") ? tree->find("nodes")->where : tree->where;
    entry.finish();
    scene.surfaces.push_back(std::move(surface));
  }
}

void read_elements(TableReader& root, std::string_view table, const std::vector<ElementKind>& kinds,
                   const std::string& folder, std::vector<SceneElement>& elements, SceneNotes& notes) {
  std::size_t count = 0;
  for (const TomlTree* tree : root.tables(table)) {
    const std::string key = std::string(table) + "[" + std::to_string(count++) + "]";
    TableReader entry(tree, key, tree->where, notes);
    elements.push_back(read_element(entry, key, kinds, folder, notes));
  }
}

void read_deployment(TableReader& root, const TomlTree& tree, Scene& scene, SceneNotes& notes) {
  const TomlTree* found = root.table("deployment");
  if (!found) return;
  TableReader table(found, "deployment", place(found, tree), notes);
  SceneElement& element = scene.deployment;
  element.kind = element.key = "deployment";
  element.where = table.where();
  element.terms = table.names("measure", terms_wanted);
  element.values = table.read(deployment_params());
  table.finish();
  element.places = table.places();
}

// What a person sets of the solver on a command line that another key leaves without meaning. In a scene it
// may be there for other runs of it.
void warn_of_idle_steps(TableReader& table, const SolverOptions& solver, SceneNotes& notes) {
  const std::vector<std::string_view> of_methods{"method",    "stages",  "nodes", "constraints_at",
                                                 "baumgarte", "rho_inf", "turn",  "adaptive"};
  const std::string on_path = "whose motion is at round-off whatever the method";
  if (solver.model == "path") {
    table.warn_overridden(of_methods, "with model = 'path', " + on_path);
  } else if (solver.tolerance > 0 && find_method(solver.method)) {
    constexpr const char* picks = "with tolerance > 0, which picks stages and step";
    table.warn_overridden({"step"}, picks);
    if (order_depends_on_stages(solver)) table.warn_overridden({"stages"}, picks);
  }
  notes.on_path = table.overridden_among(of_methods, "where the path is solved, as here, " + on_path);
}

void read_solver(TableReader& root, const TomlTree& tree, Scene& scene, SceneNotes& notes) {
  const TomlTree* found = root.table("solver");
  TableReader table(found, "solver", place(found, tree), notes);
  const ParamSet values = table.read(solver_params());
  table.warn_idle(solver_params(), values, Idle::from_command_line);
  scene.solver = solver_options(values);
  if (scene.solver.adaptive && scene.solver.tolerance > 0)
    notes.warnings.push_back({found->find("adaptive")->where, table.key("adaptive"),
                              "does nothing with tolerance > 0, which picks steps that are all equal"});
  warn_of_idle_steps(table, scene.solver, notes);
  const Family* family = find_family(scene.kind);
  if (!table.has("end_time") && ((family && family->deploys) || !scene.deployment.terms.empty()))
    scene.solver.end_time = time_to_deploy;
  table.finish();
  const double steps = scene.solver.end_time / scene.solver.step;
  if (steps > max_steps)
    table.problem("step",
                  "end_time / step would be more than 1e9 steps; take a larger step or an earlier end_time");
}

void read_camera_keys(const std::vector<const TomlTree*>& trees, RenderOptions& render, SceneNotes& notes) {
  for (const TomlTree* tree : trees) {
    const std::string name = "render.camera_keys[" + std::to_string(render.camera_keys.size()) + "]";
    TableReader entry(tree, name, tree->where, notes);
    const ParamSet values = entry.read(camera_key_params());
    entry.finish();
    const CameraKey key = camera_key(values);
    if (!render.camera_keys.empty() && key.time <= render.camera_keys.back().time)
      entry.problem("time", "must be later than the key before it");
    render.camera_keys.push_back(key);
  }
}

void read_materials(const std::vector<const TomlTree*>& trees, RenderOptions& render, SceneNotes& notes) {
  for (const TomlTree* tree : trees) {
    TableReader entry(tree, "render.materials[" + std::to_string(render.materials.size()) + "]", tree->where,
                      notes);
    const ParamSet values = entry.read(material_params());
    entry.finish();
    render.materials.push_back({values.text("group"), values.text("material")});
  }
}

// What other tables of [render] leave without meaning.
void warn_of_idle_looks(TableReader& table, const RenderOptions& render) {
  const RenderOptions usual;
  if (render.colour_by != usual.colour_by) {
    const std::string why = "in pictures with colour_by = " + in_quotes(render.colour_by) +
                            ", whose colours the rods have; exported models have it";
    table.warn_idle("material", why, render.material == usual.material);
    table.warn_idle("materials", why, false);
  }
  if (!render.camera_keys.empty() && !render.fit)
    table.warn_idle("camera", "beside camera_keys, which say from where", render.camera == usual.camera);
}

void read_render(TableReader& root, const TomlTree& tree, Scene& scene, SceneNotes& notes) {
  const TomlTree* found = root.table("render");
  TableReader table(found, "render", place(found, tree), notes);
  const ParamSet values = table.read(render_params());
  const auto keys = table.tables("camera_keys"), materials = table.tables("materials");
  table.finish();
  const auto& size = values.vector("size");
  if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1]))
    table.problem("size", "must be whole numbers of pixels");
  scene.render = render_options(values);
  const auto& range = scene.render.colour_range;
  if (range[0] != 0 || range[1] != 0) {
    if (!(range[0] < range[1]))
      table.problem("colour_range", "must be two numbers of which the second is larger, or [0, 0]");
    else if (scene.render.colour_by == "constraint_error" && !(range[0] > 0))
      table.problem("colour_range", "must begin above 0: colours of constraint_error are logarithmic");
  }
  read_camera_keys(keys, scene.render, notes);
  read_materials(materials, scene.render, notes);
  table.warn_idle(render_params(), values);
  warn_of_idle_looks(table, scene.render);
}

void read_title(TableReader& root, const TomlTree& tree, const TomlTree& own, Scene& scene) {
  const std::string given = root.read(scene_params()).text("title");
  std::string unknown;
  scene.title = scene_title(tree, own, scene.name, &unknown);
  if (is_title_pattern(given)) scene.title_pattern = given;
  if (!unknown.empty())
    root.problem("title", "{" + unknown +
                              "} names no number or text of [structure], whose keys a title "
                              "takes, no variables; a brace is {{");
}

// "structure.nodes[3].mass" -> "structure.nodes[].mass"
std::string without_indices(std::string_view key) {
  std::string text;
  bool inside = false;
  for (const char c : key) {
    if (c == ']') inside = false;
    if (!inside) text += c;
    if (c == '[') inside = true;
  }
  return text;
}

// The same mistake of an entry that stands many times (variables.hpp) is told once.
void drop_repetitions(std::vector<SceneProblem>& problems) {
  std::set<std::tuple<std::string, int, int, std::string, std::string>> told;
  std::erase_if(problems, [&](const SceneProblem& p) {
    return p.where.line > 0 &&
           !told.emplace(p.where.file, p.where.line, p.where.column, without_indices(p.key), p.message)
                .second;
  });
}

// Overrides first, then each file from its top to its end.
void sort_problems(std::vector<SceneProblem>& problems) {
  std::map<std::string, int> rank{{override_source, 0}};
  for (const auto& problem : problems) rank.try_emplace(problem.where.file, static_cast<int>(rank.size()));
  std::stable_sort(problems.begin(), problems.end(), [&](const SceneProblem& a, const SceneProblem& b) {
    const auto order = [&](const SourceLocation& where) {
      return std::tuple(rank.at(where.file), where.line, where.column);
    };
    return order(a.where) < order(b.where);
  });
}

[[noreturn]] void refuse(std::vector<SceneProblem>& problems) {
  drop_repetitions(problems);
  sort_problems(problems);
  throw SceneError(std::move(problems));
}

}  // namespace

Scene read_scene_text(std::string_view text, const std::string& name,
                      const std::vector<std::string>& overrides, const std::string& folder) {
  TomlTree own = parse_toml(text, name);
  TomlTree tree = own;
  SceneNotes notes;
  Scene scene;
  WorkedOut worked_out;
  if (!apply_overrides_and_expand(tree, overrides, notes.problems, &worked_out)) refuse(notes.problems);
  scene.variables = std::move(worked_out.variables);
  scene.worked_out = std::move(worked_out.keys);
  std::vector<SceneProblem> told_already;
  WorkedOut as_written;
  apply_overrides_and_expand(own, {}, told_already, &as_written);
  for (const auto& [variable, where] : worked_out.idle) {
    const std::string key = "variables." + variable;
    // What is idle since another one was replaced by a number is as it was meant.
    if (as_written.idle.contains(variable) ||
        std::ranges::any_of(overrides, [&](const auto& given) { return given.starts_with(key + "="); }))
      notes.warnings.push_back({where, key, "does nothing: nothing in the scene is worked out of it"});
  }
  scene.name = std::filesystem::path(name).stem().string();
  TableReader root(&tree, "", tree.where, notes);
  read_title(root, tree, own, scene);
  read_structure(root, tree, folder, scene, notes);
  read_gravity(root, tree, scene, notes);
  read_loads(root, scene, notes);
  read_elements(root, "forces", scene_forces(), folder, scene.forces, notes);
  read_elements(root, "constraints", scene_constraints(), folder, scene.constraints, notes);
  settle_names(scene.forces, notes);
  settle_names(scene.constraints, notes);
  read_deployment(root, tree, scene, notes);
  read_surfaces(root, scene, notes);
  read_solver(root, tree, scene, notes);
  read_render(root, tree, scene, notes);
  root.table("variables");  // is out of the tree by now; one that is misspelt is not
  root.finish();
  for (SceneProblem& problem : notes.problems)
    if (scene.variables.contains(problem.key) && problem.message.starts_with("unknown key"))
      problem.message = "unknown key; did you mean 'variables." + problem.key + "'?";
  if (!notes.problems.empty()) refuse(notes.problems);
  scene.warnings = std::move(notes.warnings);
  scene.warnings_on_path = std::move(notes.on_path);
  scene.locations = std::move(notes.locations);
  scene.units = std::move(notes.units);
  scene.files = std::move(notes.files);
  return scene;
}

Scene read_scene_file(const std::string& path, const std::vector<std::string>& overrides) {
  const TextFile file = read_text_file(path, TextSource::pipe_too);
  if (!file.error.empty()) throw UnreadableScene("cannot read scene " + path + ": " + file.error);
  std::string folder = std::filesystem::path(path).parent_path().string();
  return read_scene_text(file.text, path, overrides, folder.empty() ? "." : folder);
}

}  // namespace unfurl
