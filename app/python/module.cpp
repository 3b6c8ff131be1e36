// SPDX-License-Identifier: BSD-3-Clause
// Unfurl's solver, studies and figures as a Python module: unfurl._unfurl, which
// app/python/unfurl/__init__.py makes pleasant. Long work runs without the interpreter's lock and hears
// Ctrl-C.
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "app/python/asker.hpp"
#include "app/python/run_object.hpp"
#include "app/python/studies.hpp"
#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/simulate/stepper.hpp"
#include "core/simulate/stretched.hpp"
#include "core/structure/structure_error.hpp"
#include "core/study/reference.hpp"
#include "core/study/scene_variation.hpp"
#include "core/study/solve_for.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/version.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/plot/lacking_letters.hpp"

namespace py = pybind11;
using namespace unfurl;

namespace {

// One picture at a time: what draws text has one state for all.
std::mutex drawing;

// Pictures and exports: one at a time, Ctrl-C ends them. What they cannot show is warned of.
template <class Work>
void write(const Run& run, const Work& work) {
  std::vector<std::string> said;
  heard([&](const Between& between) {
    run.alone(
        [&](const JudgedRun& judged) {
          plot::take_lacking_letters();  // of work that ended early
          work(judged, between, said);
          if (std::string letters = plot::take_lacking_letters(); !letters.empty())
            said.push_back(std::move(letters));
        },
        &drawing);
  });
  warn(said);
}

void write_frame(const Run& run, double t, const std::string& file) {
  run.require_time(t);  // of a time that the run has not a frame is no picture of it
  write(run, [&](const JudgedRun& judged, const Between& between, auto&) {
    write_still(judged, t, file, between);
  });
}

// Where a scene comes from: a name, a file, or a text.
SceneSource source_of(const std::string& scene, const std::vector<std::string>& overrides, bool is_text) {
  if (!is_text) return {find_scene(scene), overrides};
  return {"scene", overrides, std::make_shared<const std::string>(scene)};
}

std::shared_ptr<Run> run_scene(const SceneSource& source, const std::vector<std::string>& changes) {
  Scene scene = source.read(changes);
  Asker asker;
  SimulationHooks hooks;
  hooks.cancelled = [&asker] { return asker(); };
  std::shared_ptr<Run> made;
  {
    const py::gil_scoped_release release;
    Simulation run = simulate_as_asked(build_model(scene), scene.solver, hooks);
    if (run.status != RunStatus::stopped)
      made = std::make_shared<Run>(std::move(scene), std::move(run), std::make_shared<std::mutex>(),
                                   hooks.cancelled);
  }
  asker.raise();
  return made;
}

// What a scene says that a stepper does not do.
std::vector<std::string> idle_when_stepped(const SolverOptions& solver, bool stretches) {
  std::vector<std::string> said;
  if (solver.model == "path" || solver.model == "sector")
    said.push_back("solver.model = \"" + solver.model +
                   "\" does nothing here: a stepper steps the whole model");
  if (solver.tolerance > 0)
    said.emplace_back(
        "solver.tolerance does nothing here: a stepper takes the stages and the step as they are");
  if (stretches)
    said.emplace_back(
        "structure.rod_model = \"quasi-static\": a stepper's x is that of rigid rods, until finish() "
        "stretches them");
  return said;
}

class SteppedScene {
 public:
  explicit SteppedScene(Scene scene)
      : scene_(std::move(scene)), model_(build_model(scene_)), stepper_(model_, scene_.solver) {}
  std::vector<std::string> idle() const {
    return idle_when_stepped(scene_.solver, model_->structure.quasi_static);
  }
  bool step() {
    const py::gil_scoped_release release;
    const std::lock_guard lock(*use_);
    return goes_on_ = stepper_.step();
  }
  bool advance_to(double t) {
    if (std::isnan(t)) throw StudyError("a stepper advances to a time [s], not to NaN");
    Asker asker;
    {
      const py::gil_scoped_release release;
      while (advance_for_a_while(t) && !asker()) {
      }
    }
    asker.raise();
    return goes_on_;
  }
  // Another thread may be stepping.
  template <class Part>
  auto alone(const Part& part) const {
    const py::gil_scoped_release release;
    const std::lock_guard lock(*use_);
    return part();
  }
  double time() const {
    return alone([this] { return stepper_.time(); });
  }
  py::array positions() const {
    return array(alone([this] { return trajectory().positions(trajectory().size() - 1); }));
  }
  py::array velocities() const {
    return array(alone([this] { return trajectory().velocities(trajectory().size() - 1); }));
  }
  std::string status() const {
    return alone([this] { return running() ? "running" : std::string(to_string(stepper_.run().status)); });
  }
  std::vector<std::pair<std::string, double>> events() const {
    return alone([this] {
      std::vector<std::pair<std::string, double>> found;
      for (const Event& event : stepper_.run().events) found.emplace_back(event.name, event.t);
      return found;
    });
  }
  std::vector<std::string> warnings() const {
    return alone([this] { return all_warnings(); });
  }
  // A solved node by its name or its index.
  int node(const py::object& key) const {
    const auto& nodes = alone([this] { return &trajectory().structure(); })->nodes;
    if (py::isinstance<py::str>(key)) {
      const auto name = key.cast<std::string>();
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].name == name && !nodes[i].ghost) return static_cast<int>(i);
      throw py::key_error("no solved node is called " + name);
    }
    if (PyIndex_Check(key.ptr()) == 0)
      throw py::type_error("a node goes by its name or its index, not by " + std::string(py::repr(key)));
    const py::ssize_t index = PyNumber_AsSsize_t(key.ptr(), PyExc_IndexError);
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
    if (index < 0 || index >= static_cast<py::ssize_t>(nodes.size()))
      throw py::index_error("no solved node has the index " + std::to_string(index));
    return static_cast<int>(index);
  }
  std::vector<std::string> node_names() const {
    std::vector<std::string> names;
    for (const Node& of : alone([this] { return &trajectory().structure(); })->nodes)
      if (!of.ghost) names.push_back(of.name);
    return names;
  }
  void set_force(const py::object& key, const Vec3& force) {
    if (!force.allFinite()) throw StudyError("a force is three finite numbers [N]");
    const int of = node(key);
    const py::gil_scoped_release release;
    const std::lock_guard lock(*use_);
    stepper_.set_force(of, force);
    forces_[of] = force;
  }
  Vec3 force(const py::object& key) const {
    return alone([this, of = node(key)] {
      const auto found = forces_.find(of);
      return found == forces_.end() ? Vec3(Vec3::Zero()) : found->second;
    });
  }
  std::shared_ptr<Run> finish() const {
    const bool forced = alone([this] { return !forces_.empty(); });
    const char* made_by =
        !forced ? "stepper().finish()" : "stepper(), with forces set between steps, finish()";
    Asker asker;
    const std::function<bool()> cancelled = [&asker] { return asker(); };
    std::shared_ptr<Run> made;
    {
      const py::gil_scoped_release release;
      made = std::make_shared<Run>(scene_, so_far(), std::make_shared<std::mutex>(), cancelled, made_by);
    }
    asker.raise();
    return made;
  }

 private:
  // So that a signal's handler, which may look at the stepper, finds it free. False: it is there, or has
  // ended.
  bool advance_for_a_while(double t) {
    const auto begin = std::chrono::steady_clock::now();
    const std::lock_guard lock(*use_);
    goes_on_ = stepper_.advance_to(
        t, [begin] { return std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(100); });
    return running() && stepper_.time() < t;
  }
  const Trajectory& trajectory() const { return stepper_.run().trajectory; }
  bool running() const {
    const Simulation& run = stepper_.run();
    return goes_on_ && run.status != RunStatus::failed && stepper_.time() < run.options.end_time;
  }
  std::vector<std::string> all_warnings() const {
    std::vector<std::string> said = idle();
    const auto of_start = start_warnings(*model_, scene_.solver, stepper_.swing());
    said.insert(said.end(), of_start.begin(), of_start.end());
    said.insert(said.end(), stepper_.run().warnings.begin(), stepper_.run().warnings.end());
    return said;
  }
  Simulation so_far() const {
    const std::lock_guard lock(*use_);
    Simulation run = stepper_.run();
    if (running()) run.status = RunStatus::stopped;
    run.warnings = all_warnings();
    if (model_->structure.quasi_static) add_stretch(run.trajectory);
    if (scene_.solver.model != "full" && solved_as(run).name == "full")
      run.solved_as.why = "a stepper steps the whole model";
    return run;
  }
  static py::array array(const VectorXd& x) {
    return py::array_t<double>({static_cast<py::ssize_t>(x.size() / 3), py::ssize_t{3}}, x.data());
  }
  Scene scene_;
  std::shared_ptr<const Model> model_;
  Stepper stepper_;
  std::map<int, Vec3> forces_;
  bool goes_on_ = true;
  std::shared_ptr<std::mutex> use_ = std::make_shared<std::mutex>();
};

// stepper.force["B0"] = [fx, fy, fz]
struct NodeForces {
  SteppedScene& of;
};

bool is_node(const NodeForces& forces, const py::object& node) {
  try {
    forces.of.node(node);
    return true;
  } catch (const py::builtin_exception&) {
    return false;
  } catch (const py::error_already_set&) {  // an index that is none
    return false;
  }
}

template <class Kind>
void add_error(py::module_& module, const char* name, const py::object& base) {
  py::register_exception<Kind>(module, name, base);
}

void add_run(py::module_& module) {
  py::class_<Run, std::shared_ptr<Run>>(module, "Run")
      .def_property_readonly("t", &Run::t)
      .def_property_readonly("x", &Run::x)
      .def_property_readonly("v", &Run::v)
      .def_property_readonly("force", &Run::force)
      .def_property_readonly("unique", &Run::unique)
      .def_property_readonly("series", &Run::series)
      .def_property_readonly("nodes",
                             [](const Run& run) {
                               std::vector<std::string> names;
                               for (const NodeCopy& node : run.structure().node_copies)
                                 names.push_back(node.name);
                               return names;
                             })
      .def_property_readonly("rods",
                             [](const Run& run) {
                               std::vector<std::string> names;
                               for (const RodCopy& rod : run.structure().rod_copies)
                                 names.push_back(rod.name);
                               return names;
                             })
      .def_property_readonly("rod_nodes",
                             [](const Run& run) {
                               std::vector<std::pair<int, int>> ends;
                               for (const RodCopy& rod : run.structure().rod_copies)
                                 ends.emplace_back(rod.a, rod.b);
                               return ends;
                             })
      .def_property_readonly("events",
                             [](const Run& run) {
                               std::vector<std::pair<std::string, double>> events;
                               for (const Event& event : run.simulation().events)
                                 events.emplace_back(event.name, event.t);
                               return events;
                             })
      .def_property_readonly("status",
                             [](const Run& run) { return std::string(to_string(run.simulation().status)); })
      .def_property_readonly("message", [](const Run& run) { return run.simulation().message; })
      .def_property_readonly("warnings",
                             [](const Run& run) { return warnings_of(run.simulation(), run.diagnostics()); })
      .def_property_readonly("title", [](const Run& run) { return run.scene().title; })
      .def("at", &Run::at, py::arg("t"))
      .def("measure", &Run::measure)
      .def("summary_json", [](const Run& run) { return run.alone(summary_of); })
      .def(
          "export",
          [](const Run& run, const std::string& format, const std::string& directory) {
            write(run, [&](const JudgedRun& judged, const Between& between, auto& said) {
              said = write_export(judged, format, directory, between);
            });
          },
          py::arg("format"), py::arg("directory"))
      .def(
          "plot",
          [](const Run& run, const std::string& name, const std::string& file, const std::string& style) {
            write(run, [&](const JudgedRun& judged, const Between& between, auto&) {
              write_plot(judged, name, file, style, between);
            });
          },
          py::arg("name"), py::arg("file"), py::arg("style") = "screen")
      .def("frame", &write_frame, py::arg("t"), py::arg("file"))
      .def(
          "film",
          [](const Run& run, const std::string& file) {
            write(run, [&](const JudgedRun& judged, const Between& between, auto&) {
              write_film(judged, file, between);
            });
          },
          py::arg("file"));
}

void add_scene(py::module_& module) {
  py::class_<NodeForces>(module, "NodeForces")
      .def("__setitem__", [](NodeForces& forces, const py::object& node,
                             const Vec3& force) { forces.of.set_force(node, force); })
      .def("__getitem__",
           [](const NodeForces& forces, const py::object& node) {
             return py::module_::import("unfurl").attr("_force")(forces.of.force(node));
           })
      .def("__contains__", &is_node)
      .def("__iter__", [](const NodeForces& forces) { return py::iter(py::cast(forces.of.node_names())); });
  py::class_<SteppedScene>(module, "Stepper")
      .def(py::init([](const SceneSource& source) { return std::make_unique<SteppedScene>(source.read()); }),
           py::arg("source"))
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](SteppedScene&, const py::args&) {})
      .def_property_readonly("force", py::cpp_function([](SteppedScene& self) { return NodeForces{self}; },
                                                       py::keep_alive<0, 1>()))
      .def("step", &SteppedScene::step)
      .def("advance_to", &SteppedScene::advance_to, py::arg("t"))
      .def("finish", &SteppedScene::finish)
      .def_property_readonly("t", &SteppedScene::time)
      .def_property_readonly("x", &SteppedScene::positions)
      .def_property_readonly("v", &SteppedScene::velocities)
      .def_property_readonly("status", &SteppedScene::status)
      .def_property_readonly("warnings", &SteppedScene::warnings)
      .def_property_readonly("idle", &SteppedScene::idle)
      .def_property_readonly("events", &SteppedScene::events);

  py::class_<SceneSource>(module, "SceneSource")
      .def(py::init(&source_of), py::arg("scene"), py::arg("overrides"), py::arg("is_text"))
      .def("run", &run_scene, py::arg("changes"))
      .def("sweep", &sweep_scene, py::arg("vary"), py::arg("measures"), py::arg("threads"), py::arg("folder"))
      .def("study", &study_scene, py::arg("steps"), py::arg("methods"), py::arg("repeats"))
      .def("solve", &solve_scene)
      .def_property_readonly("text", [](const SceneSource& source) { return scene_text(source.read()); })
      .def_property_readonly("title", [](const SceneSource& source) { return source.read().title; });
}

}  // namespace

PYBIND11_MODULE(_unfurl, module) {
  module.doc() = "Unfurl: how deployable structures unfold.";
  module.attr("__version__") = version();
  const py::object error = py::register_exception<Error>(module, "Error", PyExc_ValueError);
  add_error<StructureError>(module, "StructureError", error);
  add_error<SceneError>(module, "SceneError", error);
  add_error<UnreadableScene>(module, "UnreadableScene", error);
  add_error<FileError>(module, "FileError", error);
  add_error<StudyError>(module, "StudyError", error);
  add_error<NotFound>(module, "NotFound", error);
  add_error<GraphicsError>(module, "GraphicsError", error);

  add_run(module);
  add_scene(module);
  module.def("scenes", [] {
    std::vector<std::string> names;
    for (const LibraryScene& scene : library_scenes()) names.push_back(scene.name);
    return names;
  });
  module.def("measures", [] {
    std::vector<std::string> names;
    for (const NamedMeasure& measure : named_measures()) names.emplace_back(measure.name);
    return names;
  });
}
