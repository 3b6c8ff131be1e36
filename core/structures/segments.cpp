// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/segments.hpp"

#include <algorithm>
#include <set>

#include "core/structure/structure_error.hpp"

namespace unfurl {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw StructureError("segments", message);
}

class Cutter {
 public:
  explicit Cutter(Structure& structure) : s_(structure), rods_(std::move(structure.rods)) {
    s_.rods.clear();
    first_.reserve(rods_.size());
    for (const Node& node : s_.nodes) node_names_.insert(node.name);
    for (const Rod& rod : rods_) rod_names_.insert(rod.name);
  }

  void cut(const std::vector<long>& segments) {
    for (std::size_t r = 0; r < rods_.size(); ++r) {
      first_.push_back(static_cast<int>(s_.rods.size()));
      if (segments[r] <= 1)
        s_.rods.push_back(rods_[r]);
      else
        cut(rods_[r], segments[r]);
    }
    copy(segments);
  }

 private:
  static std::string name_of_part(const Rod& rod, long k, const char* what, std::set<std::string>& taken) {
    std::string name = rod.name + "." + std::to_string(k);
    if (!taken.insert(name).second)
      refuse("rod " + rod.name + " is cut into parts " + rod.name + ".1, " + rod.name + ".2, ..., but " +
             name + " is the name of a " + what + " already");
    return name;
  }

  void cut(const Rod& rod, long count) {
    if (!rod.elastic() || !(rod.second_moment > 0))
      refuse("rod " + rod.name + " needs area and youngs_modulus to bend");
    std::vector<int> nodes{rod.a};
    const Node a = s_.nodes[static_cast<std::size_t>(rod.a)], b = s_.nodes[static_cast<std::size_t>(rod.b)];
    for (long k = 1; k < count; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(count);
      const std::string name = name_of_part(rod, k, "node", node_names_);
      nodes.push_back(static_cast<int>(s_.nodes.size()));
      s_.nodes.push_back({name, (1 - share) * a.position + share * b.position,
                          (1 - share) * a.velocity + share * b.velocity, 0.0});
    }
    nodes.push_back(rod.b);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      Rod part = rod;
      part.name = name_of_part(rod, static_cast<long>(k) + 1, "rod", rod_names_);
      part.whole = rod.name, part.parts = static_cast<int>(count);
      part.a = nodes[k], part.b = nodes[k + 1];
      part.mass /= static_cast<double>(count);
      part.length /= static_cast<double>(count);
      part.free_length /= static_cast<double>(count);
      s_.rods.push_back(std::move(part));
      if (k == 0) continue;
      Force bend;
      bend.kind = "bending";
      bend.name = "bending of " + s_.nodes[static_cast<std::size_t>(nodes[k])].name;
      bend.nodes = {nodes[k - 1], nodes[k], nodes[k + 1]};
      bend.stiffness = rod.youngs_modulus * rod.second_moment * rod.multiplicity;
      bend.damping = rod.gives ? rod.damping_time * bend.stiffness : 0;
      s_.forces.push_back(std::move(bend));
    }
  }

  // What is shown: the nodes as they are, every part of a shown rod.
  void copy(const std::vector<long>& segments) {
    for (std::size_t i = s_.node_copies.size(); i < s_.nodes.size(); ++i)
      s_.node_copies.push_back({s_.nodes[i].name, static_cast<int>(i), Mat3::Identity(), Vec3::Zero()});
    std::vector<RodCopy> shown;
    for (const RodCopy& whole : s_.rod_copies) {
      const auto source = static_cast<std::size_t>(whole.source);
      const long parts = std::max(segments[source], 1L);
      for (long k = 0; k < parts; ++k) {
        const int r = first_[source] + static_cast<int>(k);
        const Rod& rod = s_.rods[static_cast<std::size_t>(r)];
        shown.push_back({parts > 1 ? rod.name : whole.name, rod.a, rod.b, r});
      }
    }
    s_.rod_copies = std::move(shown);
  }

  Structure& s_;
  std::vector<Rod> rods_;   // as they were
  std::vector<int> first_;  // part of each, among the new ones
  std::set<std::string> node_names_, rod_names_;
};

template <class Visit>
void visit_measures(Structure& structure, bool locks_deployed, const Visit& visit) {
  const auto look = [&](Measure& measure, bool acts = true) {
    visit(measure, acts);
    for (MeasureTerm& term : measure.terms) visit(term.measure, acts);
  };
  look(structure.deployment.measure, locks_deployed);
  for (Force& force : structure.forces) look(force.measure);
  for (Constraint& c : structure.constraints) look(c.measure);
  for (Stop& stop : structure.stops) look(stop.measure);
}

}  // namespace

void bend_to_ends(Structure& structure, bool by_pin, bool locks_deployed) {
  std::set<std::vector<int>> ends;  // end, first and second node within
  visit_measures(structure, locks_deployed, [&](Measure& measure, bool acts) {
    auto& n = measure.nodes;
    if (n.size() < 6) return;
    for (const std::size_t line : {0U, 1U})
      if (acts && n[4 + line] != n[2 * line + 1]) ends.insert({n[2 * line], n[2 * line + 1], n[4 + line]});
    if (by_pin) n.resize(4);
  });
  if (ends.empty()) return;
  if (by_pin)
    structure.notes.push_back(
        "pin_friction takes rods that were cut to bend (segments) as stiff from an end to the middle of its "
        "first part: what torques and held angles bend them is of first order in 1/segments");
  for (Force& force : structure.forces) {
    if (force.kind != "bending" || by_pin) continue;
    const std::vector<int> back(force.nodes.rbegin(), force.nodes.rend());
    const double more = 1 + 0.5 * static_cast<double>(ends.count(force.nodes) + ends.count(back));
    force.stiffness *= more, force.damping *= more;
  }
}

void cut_rods(Structure& structure, const std::vector<long>& segments) {
  if (std::all_of(segments.begin(), segments.end(), [](long k) { return k <= 1; })) return;
  if (structure.sectors > 1 || structure.node_copies.size() != structure.nodes.size())
    refuse("a sector model cannot cut its rods; set structure.model to \"full\"");
  Cutter(structure).cut(segments);
}

}  // namespace unfurl
