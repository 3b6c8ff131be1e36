// SPDX-License-Identifier: BSD-3-Clause
// The six-unit ring to t = 4.9 s, measured against the exact solution.
#include "tests/bench/cases.hpp"
#include "tests/bench/contender.hpp"
#include "tests/bench/rk4_klu.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

using testing::dvm_options, testing::hoop_structure, testing::make_model;

constexpr double end = 4.9;  // [s]
constexpr int repeats = 7;

Track track(const char* kind, bool eliminate_linear = true) {
  const double theta = testing::exact_hoop().angle(end);
  const Structure there = hoop_structure({{"fold_angle", theta * 180 / pi}, {"model", std::string(kind)}});
  VectorXd q(static_cast<Index>(3 * there.nodes.size()));
  for (std::size_t i = 0; i < there.nodes.size(); ++i)
    q.segment<3>(3 * static_cast<Index>(i)) = there.nodes[i].position;
  const auto model = make_model(hoop_structure({{"model", std::string(kind)}}), eliminate_linear);
  return {model, end, {end}, {q}};
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

// Steps chosen so that every error lies below `accuracy`, those of Runge-Kutta just below it. IDA's tolerance
// is the largest power of ten that does so; below 1e-9 m it does not come: tighter than 1e-12 its corrector
// fails.
void cost_of(Report& report, double accuracy, Contender ours, double rk4_step, double ida_tolerance,
             const char* target) {
  const Track eliminated = track("full"), cartesian = track("full", false);
  Contender own = rk4(rk4_step), klu = rk4_klu(rk4_step), reduced = klu;
  Contender bdf = ida(ida_tolerance, 0.01 * ida_tolerance), bdf_reduced = bdf;
  reduced.name += ", in our eliminated coordinates";
  bdf_reduced.name += ", in our eliminated coordinates";
  for (int r = 0; r < repeats; ++r) {
    race({&ours, &own, &reduced, &bdf_reduced}, eliminated, 1);
    race({&klu, &bdf}, cartesian, 1);
  }
  for (const Contender* c : {&ours, &own, &reduced, &klu, &bdf_reduced, &bdf}) add(report, "ring", *c);
  char text[64];
  std::snprintf(text, sizeof text, "at %.0e m: dvm / ", accuracy);
  const std::string against = text, best = bdf.error > accuracy ? " at its best" : "";
  ratio(report, "ring", against + "rk4 with KLU", ours, klu, target);
  ratio(report, "ring", against + "IDA" + best, ours, bdf, target);
  ratio(report, "ring", against + "our rk4", ours, own, "");
  ratio(report, "ring", against + "rk4 with KLU, eliminated", ours, reduced, "");
  ratio(report, "ring", against + "IDA, eliminated" + best, ours, bdf_reduced, "");
}

}  // namespace

void ring_cases(Report& report) {
  report.begin("Six-unit ring, full model, to t = 4.9 s: CPU time of the stepping loop");
  cost_of(report, 1e-8, dvm(4, 0.025), 0.0036, 1e-11, "<= 0.125");
  cost_of(report, 1e-10, dvm(5, 0.02), 0.0011, 1e-12, "<= 0.04");

  const Track full = track("full"), sector = track("sector");
  Contender lobatto = dvm(2, 0.01), paper = lobatto, own = rk4(0.01);
  paper.name = "dvm, 2 stages, constraints at ends (the paper's)";
  SolverOptions printed = dvm_options(2, 0.01, end);
  printed.nodes = "equidistant";
  printed.constraints_at = "ends";
  paper.make = [printed](const Model& m) { return find_method("dvm")->make(m.system, printed); };
  race({&lobatto, &paper, &own}, full, repeats);
  report.begin("Equal steps (the paper: discrete variational 2.33 times Runge-Kutta)");
  for (const Contender* c : {&lobatto, &paper, &own}) add(report, "ring", *c);
  ratio(report, "ring", "h = 0.01: dvm 2 stages / rk4", lobatto, own, "<= 1");
  ratio(report, "ring", "h = 0.01: paper's scheme / rk4", paper, own, "<= 1");

  report.begin("One sector instead of the whole ring");
  Contender whole = dvm(5, 0.01), part = whole;
  part.name += ", sector";
  for (int r = 0; r < repeats; ++r) {
    run(whole, full);
    run(part, sector);
  }
  add(report, "ring", whole);
  add(report, "ring", part);
  ratio(report, "ring", "sector / full", part, whole, "<= 0.05");
}

}  // namespace unfurl::bench
