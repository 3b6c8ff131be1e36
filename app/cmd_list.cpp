// unfurl list structures|methods|figures|scenes|constraints|forces|looks|measures: what there is to choose
// from.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "core/forces/force.hpp"
#include "core/integrators/integrator.hpp"
#include "core/model/nearest_name.hpp"
#include "core/scene/elements.hpp"
#include "core/scene/library.hpp"
#include "core/structures/family.hpp"
#include "core/study/measures.hpp"
#include "render/plot/figures.hpp"
#include "render/scene/look.hpp"

namespace unfurl {

namespace {

struct Item {
  std::string name, help;
  const std::vector<ParamSpec>* params = nullptr;
};

std::vector<Item> structure_items() {
  std::vector<Item> items;
  for (const auto& family : families())
    items.push_back({std::string(family.kind), std::string(family.help), &family.params()});
  items.push_back(
      {"custom", "nodes, rods and constraints listed in the scene or in CSV files beside it", nullptr});
  return items;
}

std::vector<Item> method_items() {
  std::vector<Item> items;
  for (const auto& method : methods())
    items.push_back({std::string(method.name), std::string(method.help), nullptr});
  return items;
}

std::vector<Item> figure_items() {
  std::vector<Item> items;
  for (const auto& kind : figure_kinds())
    items.push_back({std::string(kind.name), std::string(kind.help), nullptr});
  return items;
}

std::vector<Item> scene_items() {
  std::vector<Item> items;
  for (const auto& scene : library_scenes()) items.push_back({scene.name, scene.title, nullptr});
  return items;
}

std::vector<Item> measure_items() {
  std::vector<Item> items;
  for (const auto& measure : named_measures())
    items.push_back({std::string(measure.name), std::string(measure.help), nullptr});
  items.push_back({"max:COLUMN", "largest value of a column of series.csv; also min: and final:", nullptr});
  return items;
}

std::string element_help(std::string_view help, Members members) {
  const std::string_view names = members_text(members);
  return std::string(help) + (names.empty() ? "" : "; " + std::string(names));
}

std::vector<Item> constraint_items() {
  std::vector<Item> items;
  for (const auto& kind : scene_constraints())
    items.push_back({std::string(kind.kind), element_help(kind.help, kind.members), &kind.params()});
  return items;
}

std::vector<Item> force_items() {
  std::vector<Item> items;
  for (const auto& kind : force_kinds())
    items.push_back({std::string(kind.kind), element_help(kind.help, kind.members),
                     kind.params ? &kind.params() : nullptr});
  return items;
}

std::vector<Item> look_items() {
  std::vector<Item> items;
  for (const auto& look : looks()) items.push_back({std::string(look.name), std::string(look.help), nullptr});
  return items;
}

constexpr std::string_view entry_note =
    "Every entry may also have a name, for messages and columns, and enabled = false, as if it were not "
    "there.";

struct List {
  std::string_view name;
  std::vector<Item> (*items)();
  std::string_view note = {};  // below the list for people
};

constexpr List lists[] = {{"structures", structure_items},
                          {"methods", method_items},
                          {"figures", figure_items},
                          {"scenes", scene_items},
                          {"constraints", constraint_items, entry_note},
                          {"forces", force_items, entry_note},
                          {"looks", look_items},
                          {"measures", measure_items}};

std::string default_text(const ParamSpec& spec) {
  if (const auto* b = std::get_if<bool>(&spec.fallback)) return *b ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&spec.fallback)) return text->empty() ? "none" : *text;
  if (const auto* i = std::get_if<long>(&spec.fallback)) return std::to_string(*i);
  std::ostringstream out;
  if (const auto* x = std::get_if<double>(&spec.fallback)) {
    if (std::isnan(*x)) return "as built";
    out << std::setprecision(16) << *x;
  }
  if (const auto* v = std::get_if<std::vector<double>>(&spec.fallback); v && v->empty()) return "none";
  if (const auto* v = std::get_if<std::vector<double>>(&spec.fallback))
    for (std::size_t k = 0; k < v->size(); ++k)
      out << (k ? ", " : "[") << (*v)[k] << (k + 1 < v->size() ? "" : "]");
  return out.str();
}

void print_text(const std::vector<Item>& items) {
  std::size_t width = 0;
  for (const auto& item : items) width = std::max(width, item.name.size());
  for (const auto& item : items) {
    std::cout << std::left << std::setw(static_cast<int>(width) + 2) << item.name << item.help << "\n";
    if (!item.params) continue;
    for (const auto& spec : *item.params)
      std::cout << "    " << std::setw(18) << spec.name << " " << spec.help << "; " << range_text(spec)
                << (spec.required ? "; required" : "; default " + default_text(spec)) << "\n";
  }
}

void print_json(const std::vector<Item>& items) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& item : items) {
    nlohmann::ordered_json entry = {{"name", item.name}, {"help", item.help}};
    if (item.params)
      for (const auto& spec : *item.params)
        entry["parameters"].push_back({{"name", spec.name},
                                       {"unit", spec.unit},
                                       {"default", default_text(spec)},
                                       {"range", range_text(spec)},
                                       {"help", spec.help}});
    json.push_back(std::move(entry));
  }
  std::cout << json.dump(2) << "\n";
}

}  // namespace

int cmd_list(const Arguments& arguments) {
  const std::string& name = arguments.names.front();
  std::vector<std::string_view> names;
  for (const auto& list : lists) {
    names.push_back(list.name);
    if (list.name != name) continue;
    if (arguments.json) {
      print_json(list.items());
      return exit_ok;
    }
    print_text(list.items());
    if (!list.note.empty()) std::cout << "\n" << list.note << "\n";
    return exit_ok;
  }
  throw UsageError("no list " + in_quotes(name) + did_you_mean(name, names));
}

}  // namespace unfurl
