// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/entry_members.hpp"

#include <algorithm>
#include <numeric>

#include "core/scene/write.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_first_nodes = 12;

class MemberChoices {
 public:
  MemberChoices(const Structure& structure, const Selection& selected, const FreeReach& reach)
      : structure_(structure), reach_(reach), order_(structure.nodes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_partition(order_.begin(), order_.end(), [&](int node) { return reach_.moves(node); });
    for (std::size_t i = 0; i < structure.rods.size(); ++i) rods_.push_back(i);
    std::stable_partition(rods_.begin(), rods_.end(),
                          [&](std::size_t r) { return rod_moves(structure.rods[r]); });
    firsts_ = order_;
    if (selected.kind == Selection::Kind::node)
      for (const int node : order_)
        if (name(node) == selected.name) firsts_ = {node}, chosen_ = true;
    if (selected.kind == Selection::Kind::rod)
      for (const std::size_t r : std::vector(rods_))
        if (const Rod& rod = structure.rods[r]; rod.name == selected.name) {
          rods_ = {r};
          rod_chosen_ = true;
          firsts_ = {rod.a, rod.b};
          if (!reach_.moves(rod.a)) std::swap(firsts_[0], firsts_[1]);
        }
    if (firsts_.size() > most_first_nodes) firsts_.resize(most_first_nodes);
    if (rods_.size() > most_first_nodes) rods_.resize(most_first_nodes);
  }

  bool by_rod() const { return rod_chosen_; }
  bool by_fold_angle() const { return !chosen_ && structure_.deployment.folds(); }

  using Names = std::vector<std::string>;
  std::vector<Names> groups(std::size_t count) const {
    std::vector<Names> all;
    for (const int first : firsts_) {
      std::vector<int> found{first};
      for (const bool apart : {true, false})  // the second one where no rod joins them already
        for (int i = 0; found.size() < count && i < count_of_nodes(); ++i)
          if (std::ranges::find(found, i) == found.end() && !(apart && found.size() == 1 && joined(first, i)))
            found.push_back(i);
      all.push_back(names(found));
    }
    return all;
  }
  // Pairs of which one moves; those that no rod joins come first. `near`: the nearest first.
  std::vector<Names> pairs(bool near) const {
    struct Pair {
      int a, b;
      bool joined;
      double apart;
    };
    std::vector<Pair> found;
    for (const int a : firsts_)
      for (int b = 0; b < count_of_nodes(); ++b)
        if (a != b && (chosen_ || reach_.moves(a) || reach_.moves(b)))
          found.push_back({a, b, joined(a, b), (place(a) - place(b)).norm()});
    std::ranges::stable_sort(found, [&](const Pair& p, const Pair& q) {
      return p.joined != q.joined ? q.joined : near && p.apart < q.apart;
    });
    std::vector<Names> all;
    for (const Pair& p : found) all.push_back(names({p.a, p.b}));
    return all;
  }
  // Two rods that meet: the hinge in the middle.
  std::vector<Names> hinges() const {
    std::vector<int> middles = firsts_;
    for (const int node : order_)
      if (std::ranges::find(middles, node) == middles.end()) middles.push_back(node);
    std::vector<Names> all;
    for (const int middle : middles) {
      std::vector<int> ends;
      for (const Rod& rod : structure_.rods)
        if (rod.a == middle || rod.b == middle) ends.push_back(rod.a == middle ? rod.b : rod.a);
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size() && j < i + 3; ++j)
          all.push_back(names({ends[i], middle, ends[j]}));
    }
    return all;
  }
  Names rods() const {
    Names all;
    for (const std::size_t r : rods_) all.push_back(structure_.rods[r].name);
    return all;
  }

 private:
  int count_of_nodes() const { return static_cast<int>(structure_.nodes.size()); }
  const std::string& name(int node) const { return structure_.nodes[static_cast<std::size_t>(node)].name; }
  const Vec3& place(int node) const { return structure_.nodes[static_cast<std::size_t>(node)].position; }
  bool rod_moves(const Rod& rod) const { return reach_.moves(rod.a) || reach_.moves(rod.b); }
  bool joined(int a, int b) const {
    return std::ranges::any_of(structure_.rods, [&](const Rod& rod) {
      return (rod.a == a && rod.b == b) || (rod.a == b && rod.b == a);
    });
  }
  Names names(const std::vector<int>& nodes) const {
    Names all;
    for (const int node : nodes) all.push_back(name(node));
    return all;
  }

  const Structure& structure_;
  const FreeReach& reach_;
  std::vector<int> order_, firsts_;  // what moves comes first
  std::vector<std::size_t> rods_;
  bool chosen_ = false, rod_chosen_ = false;  // a node, a rod was selected
};

std::size_t least_nodes(std::string_view kind) {
  if (kind == "coplanar") return 4;
  if (kind == "collinear") return 3;
  if (kind == "gear") return 6;
  if (kind == "rack") return 4;
  return kind == "equal" || kind == "cable" || kind == "telescope" || kind == "winch" ? 2 : 1;
}

std::vector<std::string> texts(std::string_view key, const std::vector<MemberChoices::Names>& lists) {
  std::vector<std::string> all(lists.size());
  for (std::size_t i = 0; i < lists.size(); ++i) add_member(all[i], key, lists[i]);
  return all;
}

std::vector<std::string> members_of(const ElementKind& kind, const MemberChoices& choices) {
  std::vector<std::string> all;
  switch (kind.members) {
    case Members::none:
      return {""};
    case Members::rods:  // one alone seldom may change its length where rods hold each other
      if (!choices.by_rod()) add_member(all.emplace_back(), "rods", std::string("*"));
      [[fallthrough]];
    case Members::rod:
      for (const std::string& rod : choices.rods())
        add_member(all.emplace_back(), kind.members == Members::rod ? "rod" : "rods", rod);
      return all;
    case Members::terms:
      for (const auto& pair : choices.pairs(false))
        add_member(all.emplace_back(), "terms",
                   std::vector<std::string>{"1 length " + pair[0] + " " + pair[1]});
      return all;
    case Members::angle:
    case Members::measure:
      if (choices.by_fold_angle()) return {"fold_angle = true"};
      all = texts("nodes", choices.hinges());
      return all.empty() && kind.members == Members::measure ? texts("nodes", choices.pairs(false)) : all;
    case Members::three_nodes:
      return texts("nodes", choices.hinges());
    case Members::two_nodes:
      return texts("nodes", choices.pairs(kind.kind == "clearance"));
    case Members::each_node:
    case Members::node_list:
    case Members::path:
      break;
  }
  if (kind.kind == "joint_damping" && choices.hinges().empty()) return {};
  const std::size_t least = least_nodes(kind.kind);
  return texts("nodes", least == 2 ? choices.pairs(false) : choices.groups(least));
}

// Constraints try all three axes; a load acts along z.
std::vector<std::string> along_axes(const std::vector<std::string>& members, const ElementKind& kind) {
  if (!find_kind(scene_constraints(), kind.kind)) return members;
  for (const ParamSpec& spec : kind.params()) {
    if (!spec.required || (spec.name != "direction" && spec.name != "normal")) continue;
    std::vector<std::string> all;
    for (const std::string& text : members)
      for (const std::size_t axis : {2U, 0U, 1U}) {
        std::vector<double> along(3, 0.0);
        along[axis] = 1;
        add_member(all.emplace_back(text), spec.name, along);
      }
    return all;
  }
  return members;
}

}  // namespace

void add_member(std::string& text, std::string_view key, const ParamValue& value) {
  text.append(text.empty() ? "" : ", ").append(key).append(" = ").append(toml_value(value));
}

std::vector<std::string> entry_members(const ElementKind* kind, const Structure& structure,
                                       const Selection& selected, const FreeReach& reach) {
  const MemberChoices choices(structure, selected, reach);
  return kind ? along_axes(members_of(*kind, choices), *kind) : texts("nodes", choices.groups(1));
}

}  // namespace unfurl
