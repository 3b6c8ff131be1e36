// SPDX-License-Identifier: BSD-3-Clause
// The tables beside the paper's, made of numbers that are known.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/reproduce.hpp"
#include "core/study/reproduce_report.hpp"

using namespace unfurl;

namespace reproduce_tables_test {

namespace {

// Each number is one of its scheme, its step and its kind: 1 + s, 2^-i.
Reproduction known() {
  Reproduction r;
  r.reference = "a reference";
  r.reference_uncertainty = 3e-13;
  for (int s = 0; s < 4; ++s) {
    ReproducedScheme scheme;
    scheme.name = "scheme " + std::to_string(s);
    scheme.what = "what " + std::to_string(s);
    scheme.order.order = 2.5 + s;
    scheme.deployment_time = s == 2 ? std::nan("") : 4.91234567 + s;
    for (int i = 0; i < 4; ++i) {
      ReproducedRun run;
      MeasuredRun& m = run.measured;
      const double of = (1 + s) * std::pow(2.0, -i);
      m.outcome = s == 3 && i == 0 ? "solver failed" : "ok";
      m.step = reproduced_steps[static_cast<std::size_t>(i)];
      m.steps = 245L << i;
      m.position_error = 0.0032 * of;
      m.constraint_max = 5e-8 * of;
      m.constraint_relative_max = 7e-9 * of;
      m.energy_error = 0.011 * of;
      m.newton_iterations = 1000 * (s + 1) + i;
      m.linear_solves = 2000 * (s + 1) + i;
      m.cpu_median = 0.013 * (1 + s) * (1 + i);
      m.cpu_min = 0.5 * m.cpu_median;
      m.cpu_max = 3 * m.cpu_median;
      m.repeats = 5 + i;
      scheme.runs.push_back(std::move(run));
    }
    r.schemes.push_back(std::move(scheme));
  }
  return r;
}

using Rows = std::vector<std::vector<std::string>>;

}  // namespace

TEST_CASE("beside the paper's two rows of a table stand all four of ours, at its step") {
  // Kong, Ma, Xue, Ding 2023, tables 1 and 2; 52.3906 / 22.5313 = 2.325..., 108.25 / 43.5781 = 2.484...
  CHECK(reproduced_table(known(), 0).rows ==
        Rows{{"scheme 0", "52.3906", "2.33", "2.2737e-13", "0.026", "0.5", "2.5e-8", "0.0016"},
             {"scheme 1", "22.5313", "1", "2.698e-7", "0.052", "1", "5e-8", "0.0032"},
             {"scheme 2", "", "", "", "0.078", "1.5", "7.5e-8", "0.0048"},
             {"scheme 3", "", "", "", "0.104", "2", "1e-7", "0.0064"}});
  CHECK(reproduced_table(known(), 1).rows ==
        Rows{{"scheme 0", "108.25", "2.48", "4.7368e-11", "0.039", "0.5", "1.25e-8", "0.0008"},
             {"scheme 1", "43.5781", "1", "1.6918e-8", "0.078", "1", "2.5e-8", "0.0016"},
             {"scheme 2", "", "", "", "0.117", "1.5", "3.75e-8", "0.0024"},
             {"scheme 3", "", "", "", "0.156", "2", "5e-8", "0.0032"}});
}

TEST_CASE("errors of the motion are told for each step, then the order and the time") {
  const Table table = trajectory_table(known());
  CHECK(table.columns == std::vector<std::string>{"method", "what", "h = 0.02 s", "h = 0.01 s", "h = 0.005 s",
                                                  "h = 0.0025 s", "observed order", "deployed at (s)"});
  CHECK(table.rows ==
        Rows{{"scheme 0", "what 0", "0.0032", "0.0016", "0.0008", "0.0004", "2.5", "4.9123457"},
             {"scheme 1", "what 1", "0.0064", "0.0032", "0.0016", "0.0008", "3.5", "5.9123457"},
             {"scheme 2", "what 2", "0.0096", "0.0048", "0.0024", "0.0012", "4.5", "nan"},
             {"scheme 3", "what 3", "0.0128", "0.0064", "0.0032", "0.0016", "5.5", "7.9123457"}});
}

TEST_CASE("of every run that reproduces the paper all is kept") {
  const Reproduction r = known();
  const Table table = runs_table(r);
  REQUIRE(table.rows.size() == 16);
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t i = 0; i < 4; ++i) {
      const MeasuredRun& m = r.schemes[s].runs[i].measured;
      const auto cell = [&](const char* name) { return table.rows[4 * s + i][table.column(name)]; };
      CHECK(cell("method") == "scheme " + std::to_string(s));
      CHECK(cell("outcome") == m.outcome);
      for (const auto& [name, value] : {std::pair{"step_s", m.step},
                                        {"steps", static_cast<double>(m.steps)},
                                        {"constraint_max_m", m.constraint_max},
                                        {"constraint_relative_max", m.constraint_relative_max},
                                        {"position_error_m", m.position_error},
                                        {"energy_error_max_J", m.energy_error},
                                        {"newton_iterations", static_cast<double>(m.newton_iterations)},
                                        {"linear_solves", static_cast<double>(m.linear_solves)},
                                        {"cpu_median_s", m.cpu_median},
                                        {"cpu_min_s", m.cpu_min},
                                        {"cpu_max_s", m.cpu_max},
                                        {"repeats", static_cast<double>(m.repeats)}}) {
        INFO(name);
        CHECK(number_of(cell(name)) == value);
      }
    }
}

TEST_CASE("the report sets four nodes against the scheme as printed, and says which checks hold") {
  Reproduction r = known();
  r.checks = {{"one", "1", true}, {"two", "2", false}};
  CHECK_FALSE(r.verified());
  const std::string text =
      report_markdown(reproduction_report(r, {"poses.png", "constraints.png", "errors.png"}));
  // The last of four schemes beside the first, at the second of the steps: 26 and 104 ms, 1.6 and 6.4 mm.
  CHECK(text.find("the scheme as printed costs 26 ms and is 0.0016 m off") != std::string::npos);
  CHECK(text.find("4 nodes cost 104 ms and are 0.0064 m off: 0.25 times closer for 4 times the cost") !=
        std::string::npos);
  CHECK(text.find("| one | 1 | yes |\n| two | 2 | NO |") != std::string::npos);
  CHECK(text.find("a reference, whose last two solutions agree to 3e-13 m") != std::string::npos);
  CHECK(text.find("medians of five runs from 0 to 4.9 s") != std::string::npos);
  const std::size_t poses = text.find("(poses.png)"), lengths = text.find("(constraints.png)"),
                    errors = text.find("(errors.png)");
  CHECK(poses < lengths);
  CHECK(lengths < errors);
  CHECK(errors != std::string::npos);
  const std::size_t first = text.find("52.3906"), second = text.find("108.25");
  CHECK(first < text.find("Step h = 0.005 s."));
  CHECK(second > text.find("Step h = 0.005 s."));
  r.checks[1].holds = true;
  CHECK(r.verified());
}

}  // namespace reproduce_tables_test
