// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/validation.hpp"

#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/validation_elements.hpp"

namespace unfurl {

namespace {

// The method of all of them: order 10, far below the digits printed at this step.
constexpr const char* solver = "[solver]\nstages = 6\nstep = 0.01\n";

// m = L = 1, g = 9.81, let go from (-1, 0).
constexpr const char* a01 = R"([structure]
kind = "pendulum"
rod_mass = 0
bob_mass = 1
angle = -90
[gravity]
acceleration = [0, 0, -9.81]
)";

// Two windows of uniform rods, 1 m and 1 kg each, started at 1 m/s.
constexpr const char* a02 = R"([structure]
kind = "four_bar_ladder"
windows = 2
speed = 1
[gravity]
acceleration = [0, -9.81, 0]
)";

// m = L = g = 1, (x, y, vx, vy) = (1, 0, 0, 1); the multiplier is the tension of the rod.
constexpr const char* index3 = R"([structure]
kind = "pendulum"
rod_mass = 0
bob_mass = 1
angle = 90
angle_rate = "=1/deg"
[gravity]
acceleration = [0, 0, -1]
)";

// A uniform rod of 1 m, let go from the horizontal.
constexpr const char* uniform_rod = R"([structure]
kind = "pendulum"
rod_mass = 1
angle = 90
[gravity]
acceleration = [0, 0, -9.81]
)";

// 1 kg at 1 m/s on a cable of 100 N/m, 0.3 m from drawing taut: half a swing of pi/10 s, and back.
constexpr const char* slack_cable = R"([structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "A"
position = [0.7, 0, 0]
velocity = [1, 0, 0]
mass = 1
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 1
tension_only = true
)";

// A square of bars with two diagonals, one of which is a slack cable; 1 kN along x at the corner 3.
constexpr const char* square = R"([structure]
kind = "custom"
youngs_modulus = 2e11
[[structure.nodes]]
name = "1"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "2"
position = [0, 1, 0]
mass = 1
[[structure.nodes]]
name = "3"
position = [1, 1, 0]
mass = 1
[[structure.nodes]]
name = "4"
position = [1, 0, 0]
mass = 1
[[structure.rods]]
nodes = ["1", "2"]
mass = 0
area = 1e-4
[[structure.rods]]
nodes = ["2", "3"]
mass = 0
area = 1e-4
[[structure.rods]]
nodes = ["3", "4"]
mass = 0
area = 1e-4
[[structure.rods]]
nodes = ["4", "1"]
mass = 0
area = 1e-4
[[structure.rods]]
nodes = ["1", "3"]
mass = 0
area = 1e-4
[[forces]]
kind = "spring"
nodes = ["2", "4"]
stiffness = 1e7
tension_only = true
[[structure.constraints]]
kind = "plane"
nodes = ["2", "3", "4"]
normal = [0, 0, 1]
[[structure.constraints]]
kind = "plane"
nodes = ["4"]
normal = [0, 1, 0]
[[loads]]
nodes = ["3"]
force = [1000, 0, 0]
)";

// The axis of a car on a bumpy road: springs of 1 N/m stand on a base from O to B, the left one square to it,
// and carry a bar of 1 m with eps^2 M / 2 = 5e-4 kg at each end; B goes up and down as 0.1 sin(10 t), on a
// circle about O. What B weighs moves nothing.
constexpr const char* car_axis = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0], velocity = [0, 1, 0], mass = 1},
         {name = "L", position = [0, 0.5, 0], velocity = [-0.5, 0, 0], mass = 5e-4},
         {name = "R", position = [1, 0.5, 0], velocity = [-0.5, 0, 0], mass = 5e-4}]
rods = [{nodes = ["O", "B"], mass = 0}, {nodes = ["L", "R"], mass = 0}]
constraints = [{kind = "plane", nodes = ["B", "L", "R"], normal = [0, 0, 1]}]
[gravity]
acceleration = [0, -1, 0]
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [0, 1, 0]
motion = "sine"
amplitude = 0.1
frequency = "=5/pi"
[[constraints]]
kind = "angle"
nodes = ["B", "O", "L"]
axis = [0, 0, 1]
[[forces]]
kind = "spring"
nodes = ["O", "L"]
stiffness = 1
free_length = 0.5
[[forces]]
kind = "spring"
nodes = ["B", "R"]
stiffness = 1
free_length = 0.5
)";

constexpr const char* ring = "[structure]\nkind = \"hoop\"\n";

Simulation run_to(const char* scene, double end, double step = 0.01) {
  const std::string text = std::string(scene) + solver;
  const Scene read = read_scene_text(
      text, "validation.toml", {"solver.end_time=" + exact_number(end), "solver.step=" + exact_number(step)});
  return simulate(build_model(read), read.solver);
}

// A coordinate or velocity of a node where the run ends; NaN where it ended early.
double position(const Simulation& run, double end, std::size_t node, int axis) {
  const Trajectory& path = run.trajectory;
  if (std::abs(path.end_time() - end) > 1e-12) return std::nan("");
  return path.positions(path.size() - 1)[static_cast<Index>(3 * node) + axis];
}
double velocity(const Simulation& run, double end, std::size_t node, int axis) {
  const Trajectory& path = run.trajectory;
  if (std::abs(path.end_time() - end) > 1e-12) return std::nan("");
  return path.velocities(path.size() - 1)[static_cast<Index>(3 * node) + axis];
}

// The period of a pendulum let go from the horizontal: four times the way down, whose end is found by
// bisection in the dense output of a run with small steps (its error is then below 1e-12 s).
double period(const char* scene) {
  const Simulation run = run_to(scene, 0.8, 0.001);
  const auto x = [&](double t) { return run.trajectory.positions_at(t)[3]; };
  double before = 0.0, behind = run.trajectory.end_time();
  if (x(before) * x(behind) > 0) return std::nan("");
  for (int i = 0; i < 60; ++i) {
    const double middle = (before + behind) / 2;
    (x(before) * x(middle) > 0 ? before : behind) = middle;
  }
  return 2 * (before + behind);
}

double opening_time(const Simulation& run) {
  for (const Event& event : run.events)
    if (event.name == "deployed") return event.t;
  return std::nan("");
}

// What round-off may leave where the method's own error is below it: a step errs by some 1e-15 of the
// velocity; if all N = 1000 steps of a run did so in one direction, the position would be off by N^2 / 2 h
// times that, 5e-12 m for each m/s, and speeds are up to 5 m/s.
constexpr double round_off = 5e-11;

void add_pendulums(std::vector<ValidationRow>& rows) {
  constexpr std::string_view let_go = "pendulum from the horizontal", iftomm = "IFToMM benchmark A01";
  const Simulation a = run_to(a01, 10);
  rows.push_back({let_go, iftomm, "x at 10 s (m)", "-0.27508746257611686", position(a, 10, 1, 0), round_off});
  rows.push_back({let_go, iftomm, "y at 10 s (m)", "-0.96141920509912507", position(a, 10, 1, 2), round_off});
  rows.push_back({let_go, iftomm, "period (s)", "2.3678419475762374", period(a01), round_off});
  constexpr std::string_view index = "pendulum, index 3", mebdf = "MEBDF test set";
  const Simulation b = run_to(index3, 1);
  rows.push_back({index, mebdf, "x at 1 s (m)", "0.86734864060043932", position(b, 1, 1, 0), round_off});
  rows.push_back({index, mebdf, "y at 1 s (m)", "0.49770105047967293", position(b, 1, 1, 2), round_off});
  rows.push_back({index, mebdf, "vx at 1 s (m/s)", "-0.033748018060954520", velocity(b, 1, 1, 0), round_off});
  rows.push_back({index, mebdf, "vy at 1 s (m/s)", "0.058813011465250008", velocity(b, 1, 1, 2), round_off});
  const double tension = diagnose(b).axial_force.bottomRows<1>()(0, 0);
  rows.push_back({index, mebdf, "multiplier at 1 s (N)", "-0.49310315143901879", tension, round_off});
  rows.push_back({"uniform rod, a pendulum from the horizontal",
                  "elliptic integral; Code_Aster SDNL100 has all mass at mid-length: 1.6744 s", "period (s)",
                  "1.93333485437324578", period(uniform_rod), round_off});
}

void add_car_axis(std::vector<ValidationRow>& rows) {
  constexpr double end = 3;
  const Simulation run = run_to(car_axis, end);
  const auto add = [&](std::string_view quantity, std::string_view published, double ours) {
    rows.push_back({"car axis", "IVP test set, release 2.4", quantity, published, ours, round_off});
  };
  add("x on the left at 3 s (m)", "0.0493455784275402809122", position(run, end, 2, 0));
  add("y on the left at 3 s (m)", "0.496989460230171153861", position(run, end, 2, 1));
  add("x on the right at 3 s (m)", "1.04174252488542151681", position(run, end, 3, 0));
  add("y on the right at 3 s (m)", "0.373911027265361256927", position(run, end, 3, 1));
  add("vx on the left at 3 s (m/s)", "-0.0770583684040972357970", velocity(run, end, 2, 0));
  add("vy on the left at 3 s (m/s)", "0.00744686658723778553466", velocity(run, end, 2, 1));
  add("vx on the right at 3 s (m/s)", "0.0175568157537232222276", velocity(run, end, 3, 0));
  add("vy on the right at 3 s (m/s)", "0.770341043779251976443", velocity(run, end, 3, 1));
}

void add_ladder(std::vector<ValidationRow>& rows) {
  struct Moment {
    double t;
    std::string_view x_name, x, y_name, y;
  };
  constexpr Moment moments[] = {
      {1, "x of B0 at 1 s (m)", "-0.19502030194943509", "y of B0 at 1 s (m)", "-0.98079920566217383"},
      {2, "x of B0 at 2 s (m)", "0.057815795768011432", "y of B0 at 2 s (m)", "0.99832726786345548"},
      {5, "x of B0 at 5 s (m)", "-0.81131046100510741", "y of B0 at 5 s (m)", "-0.58461554534897555"}};
  // Each pass through a collinear pose costs digits of the velocities there; some ten passes.
  constexpr double passes = 1e-9;
  for (const Moment& m : moments) {
    const Simulation run = run_to(a02, m.t);
    constexpr std::string_view problem = "ladder of two four-bar windows", source = "IFToMM benchmark A02";
    rows.push_back({problem, source, m.x_name, m.x, position(run, m.t, 1, 0), passes});
    rows.push_back({problem, source, m.y_name, m.y, position(run, m.t, 1, 1), passes});
  }
}

void add_cables(std::vector<ValidationRow>& rows) {
  rows.push_back({"mass on a cable that is slack at first", "closed form, 0.3 + pi/10", "x at 1 s (m)",
                  "0.61415926535897932", position(run_to(slack_cable, 1), 1, 1, 0), round_off});
  // Of 1 kN, as much as what weighs the rows by stiffness may leave of nine digits.
  constexpr double force = 1e-6;
  const MatrixXd at_rest = diagnose(run_to(square, 0.02)).axial_force;
  constexpr std::string_view problem = "square with two cables", source = "Code_Aster SSNL105";
  rows.push_back({problem, source, "force of the bar 3-4 (N)", "-1000", at_rest(0, 2), force});
  rows.push_back(
      {problem, source, "force of the diagonal 1-3 (N)", "1414.2135623730951", at_rest(0, 4), force});
}

}  // namespace

double ValidationRow::difference() const {
  return ours - number_of(published);
}

bool ValidationRow::holds() const {
  return std::abs(difference()) <= allowed;
}

std::vector<ValidationRow> validate(const StudyHooks& hooks) {
  std::vector<ValidationRow> rows;
  const auto stage = [&](double fraction) {
    hooks.tell(fraction);
    if (hooks.stopped()) throw Cancelled();
  };
  stage(0);
  add_pendulums(rows);
  add_car_axis(rows);
  stage(0.4);
  add_ladder(rows);
  stage(0.7);
  add_cables(rows);
  stage(0.75);
  add_element_benchmarks(rows);
  stage(0.95);
  rows.push_back({"ring antenna of six units", "Kong, Ma, Xue, Ding 2023", "deployment time (s)", "4.92",
                  opening_time(run_to(ring, 6)), 0.005});
  stage(1);
  return rows;
}

Table validation_table(const std::vector<ValidationRow>& rows) {
  Table table{{"problem", "quantity", "published", "ours", "difference", "allowed", "source"}, {}};
  for (const ValidationRow& row : rows)
    table.rows.push_back({std::string(row.problem), std::string(row.quantity), std::string(row.published),
                          exact_number(row.ours), short_number(row.difference(), 2),
                          short_number(row.allowed, 2), std::string(row.source)});
  return table;
}

Table not_expressible_table() {
  return {{"problem", "what is missing"},
          {{"rectangular Bricard loop, IFToMM A04", "bars with a square section: rods have no thickness"}}};
}

}  // namespace unfurl
