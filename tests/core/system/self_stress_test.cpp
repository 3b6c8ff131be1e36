// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/self_stress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <map>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/family_structure.hpp"

using namespace unfurl;

namespace self_stress_test {

namespace {

struct Judged {
  std::shared_ptr<const Model> model;
  VectorXd q;
  Mobility mobility;
  ForceBalance balance;
};

Judged judged(const Scene& scene) {
  Judged j{build_model(scene), {}, {}, {}};
  j.q = node_positions(j.model->structure);
  j.mobility = analyse_mobility(j.model->system, j.q);
  j.balance = force_balance(j.model->system, j.q, j.mobility);
  return j;
}

Judged of_library(const char* scene) {
  return judged(read_scene_file(find_scene(scene)));
}

// How many constraints of each sort, by the first word of their names, are determined and are not.
std::map<std::string, std::pair<int, int>> counted(const Judged& j) {
  std::map<std::string, std::pair<int, int>> count;
  const auto names = j.model->system.all_names();
  for (std::size_t r = 0; r < names.size(); ++r) {
    auto& [open, determined] = count[names[r].substr(0, names[r].find(' '))];
    ++(j.balance.determined[r] ? determined : open);
  }
  return count;
}

// Three rods side by side from a point on a line to points that stand still, as text.
const char* parallel =
    "[structure]\nkind = 'custom'\n"
    "[[structure.nodes]]\nname = 'A'\nposition = [0.3, 0, 0]\nfixed = true\n"
    "[[structure.nodes]]\nname = 'B'\nposition = [1.7, 0, 0]\nmass = 2\n"
    "[[structure.nodes]]\nname = 'C'\nposition = [1.7, 0.9, 0]\nmass = 2\n"
    "[[structure.rods]]\nname = 'one'\nnodes = ['A', 'B']\nmass = 1\n"
    "[[structure.rods]]\nname = 'two'\nnodes = ['A', 'B']\nmass = 1\n"
    "[[structure.rods]]\nname = 'out'\nnodes = ['B', 'C']\nmass = 1\n";

}  // namespace

TEST_CASE("the ring of six determines its posts and face rows, and none of its chord forces") {
  const Judged j = of_library("hoop6");
  const auto names = j.model->system.all_names();
  int posts = 0, chords = 0, rods = 0;
  for (std::size_t r = 0; r < names.size(); ++r) {
    if (names[r].rfind("rod ", 0) != 0) continue;
    const Rod& rod = j.model->structure.rods[r - (names.size() - j.model->structure.rods.size())];
    REQUIRE(names[r] == "rod " + rod.name);
    ++rods;
    if (j.balance.determined[r]) CHECK(rod.group == "post");
    posts += rod.group == "post" && j.balance.determined[r];
    chords += rod.group == "chord" && !j.balance.determined[r];
  }
  CHECK(rods == 30);
  CHECK(posts == 6);
  CHECK(chords == 24);
  int determined = 0;
  for (const char d : j.balance.determined) determined += d;
  CHECK(determined == 6 + 12);  // extensions of the rigid model: 6 posts and 12 face rows, no other row
}

TEST_CASE("how many states of self-stress the structures of the library have") {
  const std::map<std::string, std::size_t> published{{"hoop6", 7},
                                                     {"hoop12", 13},
                                                     {"hoop_arc", 5},
                                                     {"scissor_ring", 16},
                                                     {"hoberman", 13},
                                                     {"reentrant_sheet", 32},
                                                     {"scissor_mast_square", 40},
                                                     {"bricard", 1},
                                                     {"hoop6_sector", 0},
                                                     {"pendulum", 0}};
  for (const auto& [scene, states] : published) {
    INFO(scene);
    const Judged j = of_library(scene.c_str());
    CHECK(j.balance.states.size() == states);
    CHECK(j.mobility.redundant_rows.size() == states);
  }
}

TEST_CASE("a state of self-stress is in balance, and its members are what is not determined") {
  for (const char* scene : {"hoop6", "hoop_arc", "bricard", "scissor_mast_square", "hoberman"}) {
    INFO(scene);
    const Judged j = of_library(scene);
    const SparseRows G = j.model->system.all_jacobian(j.q);
    std::vector<char> member(j.balance.determined.size(), 0);
    for (const SelfStress& state : j.balance.states) {
      VectorXd y = VectorXd::Zero(G.rows());
      for (const auto& m : state.members) {
        y[m.row] = m.force;
        member[static_cast<std::size_t>(m.row)] = 1;
      }
      CHECK(y.lpNorm<Eigen::Infinity>() == Approx(1.0));
      CHECK(std::ranges::is_sorted(state.members, std::less_equal(), &SelfStress::Member::row));
      // Round-off of 1e-16 over the smallest singular value, 2e-3 in the folded ring.
      CHECK((G.transpose() * y).norm() < 1e-11);
    }
    for (std::size_t r = 0; r < member.size(); ++r) CHECK(int(member[r]) == 1 - int(j.balance.determined[r]));
  }
}

TEST_CASE("rows that keep a node on a line are no state of self-stress") {
  // A rod A-B of 2 m, with C in its middle on two rods of 1 m: one state, the three rods against each other.
  // The line stands askew, so that each of its three rows depends on the two others.
  const Judged j = judged(read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
      "{name = 'B', position = [1.2, 1.6, 0], mass = 2}, {name = 'C', position = [0.6, 0.8, 0], mass = 1}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['A', 'C'], mass = 1}, {nodes = ['C', 'B'], mass = "
      "1}]\n"
      "[[constraints]]\nkind = 'collinear'\nnodes = ['A', 'B', 'C']\n",
      "x"));
  REQUIRE(j.balance.states.size() == 1);
  REQUIRE(j.balance.states[0].members.size() == 3);
  const auto names = j.model->system.all_names();
  for (const auto& member : j.balance.states[0].members)
    CHECK(names[static_cast<std::size_t>(member.row)].starts_with("rod "));
  for (std::size_t r = 0; r < names.size(); ++r) {
    INFO(names[r]);
    CHECK(bool(j.balance.determined[r]) == !names[r].starts_with("rod "));
  }
}

TEST_CASE("parallel rods share what none of them is known to carry") {
  const Judged j = judged(read_scene_text(parallel, "parallel.toml"));
  REQUIRE(j.balance.states.size() == 1);
  const auto names = j.model->system.all_names();
  REQUIRE(j.balance.states[0].members.size() == 2);
  const auto& [one, two] = std::pair{j.balance.states[0].members[0], j.balance.states[0].members[1]};
  CHECK(names[static_cast<std::size_t>(one.row)] == "rod one");
  CHECK(names[static_cast<std::size_t>(two.row)] == "rod two");
  CHECK(one.force == Approx(-two.force));
  for (std::size_t r = 0; r < names.size(); ++r)
    CHECK((j.balance.determined[r] == 0) == (names[r] == "rod one" || names[r] == "rod two"));
}

// One modulus is enough to say how the two rods side by side share: what stretches takes what is left.
TEST_CASE("parallel rods of which one has a modulus are determined") {
  for (const std::string stretches : {"one", "two", "out"}) {
    INFO(stretches);
    std::string text = parallel;
    const std::string mark = "name = '" + stretches + "'\n";
    text.insert(text.find(mark) + mark.size(), "area = 3e-4\nyoungs_modulus = 7e10\n");
    const Judged j = judged(read_scene_text(text, "parallel.toml"));
    const ForceBalance balance = force_balance(j.model->system, j.q, j.mobility, j.model->structure.rods);
    CHECK(balance.states.size() == 1);
    const auto names = j.model->system.all_names();
    for (std::size_t r = 0; r < names.size(); ++r) {
      INFO(names[r]);
      const bool shared = names[r] == "rod one" || names[r] == "rod two";
      CHECK((balance.determined[r] == 0) == (shared && stretches == "out"));
    }
  }
}

TEST_CASE("a large ring's forces are judged though its states are not listed") {
  const Judged j = judged(read_scene_file(find_scene("hoop6"), {"structure.units=150"}));
  CHECK_FALSE(j.balance.listed);
  CHECK(j.balance.states.empty());
  CHECK(j.mobility.redundant_rows.size() == 151);
  const auto count = counted(j);
  CHECK(count.at("rod").second == 150);  // the posts
  CHECK(count.at("rod").first == 600);
}

}  // namespace self_stress_test
