// The six-unit ring to t = 4.9 s, measured against the exact solution.
#include <algorithm>
#include <functional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/rk4_klu.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

using testing::dvm_options, testing::hoop_structure, testing::make_model;

constexpr double end = 4.9;  // [s]
constexpr int repeats = 7;

struct Contender {
  std::string name;
  std::function<std::unique_ptr<Integrator>(const Model&)> make;
  double h;
  double best = 1e300;  // CPU time of the stepping loop, the smallest of all repeats [s]
  double error = 0;     // [m]
};

VectorXd exact_positions(const std::string& kind) {
  const double theta = testing::exact_hoop().angle(end);
  const Structure there = hoop_structure({{"fold_angle", theta * 180 / pi}, {"model", kind}});
  VectorXd q(static_cast<Index>(3 * there.nodes.size()));
  for (std::size_t i = 0; i < there.nodes.size(); ++i)
    q.segment<3>(3 * static_cast<Index>(i)) = there.nodes[i].position;
  return q;
}

void run(Contender& c, const Model& model, const VectorXd& exact) {
  const auto integrator = c.make(model);
  State state = initial_state(model.structure, model.system).state;
  const auto steps = static_cast<long>(std::ceil(end / c.h - 1e-9));
  const double h = end / static_cast<double>(steps);
  const double begin = cpu_seconds();
  for (long i = 0; i < steps; ++i)
    if (!integrator->step(state, h).ok()) return;
  c.best = std::min(c.best, cpu_seconds() - begin);
  VectorXd q(exact.size());
  model.system.expand(state.z, q);
  c.error = 0;
  for (Index i = 0; i < q.size(); i += 3) c.error = std::max(c.error, (q - exact).segment<3>(i).norm());
}

// Repeats are interleaved: a slow spell of the machine meets every contender.
void race(std::vector<Contender*> contenders, const Model& model, const VectorXd& exact) {
  for (int r = 0; r < repeats; ++r)
    for (Contender* c : contenders) run(*c, model, exact);
}

Contender dvm(int stages, double h) {
  const SolverOptions options = dvm_options(stages, h, end);
  return {"dvm, " + std::to_string(stages) + " stages",
          [options](const Model& m) { return find_method(options.method)->make(m.system, options); }, h};
}

Contender rk4(double h) {
  return {"rk4", [](const Model& m) { return find_method("rk4")->make(m.system, {}); }, h};
}

Contender rk4_klu(double h) {
  return {"rk4 with KLU, independent rows",
          [](const Model& m) {
            const Structure half = hoop_structure({{"fold_angle", 45.0}});
            VectorXd q(static_cast<Index>(3 * half.nodes.size()));
            for (std::size_t i = 0; i < half.nodes.size(); ++i)
              q.segment<3>(3 * static_cast<Index>(i)) = half.nodes[i].position;
            return make_rk4_klu(m.system, q);
          },
          h};
}

void add(Report& report, const Contender& c) {
  char h[32];
  std::snprintf(h, sizeof h, ", h = %.4g s", c.h);
  report.add({"ring", c.name + h, c.best, "s", "", c.error});
}

void ratio(Report& report, const std::string& what, const Contender& a, const Contender& b,
           const char* target) {
  report.add({"ring", what, a.best / b.best, "ratio", target});
}

// Steps chosen so that every error lies below `accuracy`, those of Runge-Kutta just below it.
void cost_of(Report& report, double accuracy, Contender ours, double rk4_step, const char* target) {
  const auto model = make_model(hoop_structure());
  const auto cartesian = make_model(hoop_structure(), false);
  const VectorXd exact = exact_positions("full");
  Contender own = rk4(rk4_step), klu = rk4_klu(rk4_step), reduced = klu;
  reduced.name += ", in our eliminated coordinates";
  for (int r = 0; r < repeats; ++r) {
    for (Contender* c : {&ours, &own, &reduced}) run(*c, *model, exact);
    run(klu, *cartesian, exact);
  }
  for (const Contender* c : {&ours, &own, &reduced, &klu}) add(report, *c);
  char text[64];
  std::snprintf(text, sizeof text, "at %.0e m: dvm / rk4 with KLU", accuracy);
  ratio(report, text, ours, klu, target);
  std::snprintf(text, sizeof text, "at %.0e m: dvm / our rk4", accuracy);
  ratio(report, text, ours, own, "");
  std::snprintf(text, sizeof text, "at %.0e m: dvm / rk4 with KLU, eliminated", accuracy);
  ratio(report, text, ours, reduced, "");
}

}  // namespace

void ring_cases(Report& report) {
  report.begin("Six-unit ring, full model, to t = 4.9 s: CPU time of the stepping loop");
  cost_of(report, 1e-8, dvm(4, 0.025), 0.0036, "<= 0.125");
  cost_of(report, 1e-10, dvm(5, 0.02), 0.0011, "<= 0.04");

  const auto full = make_model(hoop_structure());
  const auto sector = make_model(hoop_structure({{"model", std::string("sector")}}));
  Contender lobatto = dvm(2, 0.01), paper = lobatto, own = rk4(0.01);
  paper.name = "dvm, 2 stages, constraints at ends (the paper's)";
  SolverOptions printed = dvm_options(2, 0.01, end);
  printed.nodes = "equidistant";
  printed.constraints_at = "ends";
  paper.make = [printed](const Model& m) { return find_method("dvm")->make(m.system, printed); };
  race({&lobatto, &paper, &own}, *full, exact_positions("full"));
  report.begin("Equal steps (the paper: discrete variational 2.33 times Runge-Kutta)");
  for (const Contender* c : {&lobatto, &paper, &own}) add(report, *c);
  ratio(report, "h = 0.01: dvm 2 stages / rk4", lobatto, own, "<= 1");
  ratio(report, "h = 0.01: paper's scheme / rk4", paper, own, "<= 1");

  report.begin("One sector instead of the whole ring");
  Contender whole = dvm(5, 0.01), part = whole;
  part.name += ", sector";
  for (int r = 0; r < repeats; ++r) {
    run(whole, *full, exact_positions("full"));
    run(part, *sector, exact_positions("sector"));
  }
  add(report, whole);
  add(report, part);
  ratio(report, "sector / full", part, whole, "<= 0.05");
}

}  // namespace unfurl::bench
