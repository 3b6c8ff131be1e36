// SPDX-License-Identifier: BSD-3-Clause
// One self-contained page: the structure turning in a browser (WebGL 2, core/export/viewer.html), its curves,
// its scene. Positions and forces are single precision at uniform times, curves double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/math/largest.hpp"
#include "core/text/base64.hpp"
#include "core/text/version.hpp"
#include "core/text/xml_text.hpp"

namespace unfurl {

extern const char* const viewer_page;  // written by the build from viewer.html

namespace {

using Page = nlohmann::ordered_json;

constexpr std::size_t most_frames = 1500, most_numbers = 12'000'000;  // 48 MB, of one array

std::string packed(const auto& values) {
  return base64(std::as_bytes(std::span(values)));
}

std::string short_text(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

// Uniform in time, as many as the film's frames, within what a browser bears.
std::size_t frame_count(const ExportJob& job) {
  const Trajectory& trajectory = job.run.trajectory;
  const double span = trajectory.end_time() - trajectory.start_time();
  const std::size_t numbers = 3 * trajectory.structure().node_copies.size();
  const std::size_t bearable =
      std::clamp<std::size_t>(most_numbers / std::max<std::size_t>(numbers, 1), 2, most_frames);
  const double asked = std::ceil(span / job.frame_interval) + 1;
  return span > 0 ? static_cast<std::size_t>(std::clamp(asked, 2.0, static_cast<double>(bearable))) : 1;
}

void add_motion(const ExportJob& job, Page& page) {
  const Trajectory& trajectory = job.run.trajectory;
  const Structure& structure = trajectory.structure();
  const double start = trajectory.start_time(), span = trajectory.end_time() - start;
  const std::size_t frames = frame_count(job);
  std::vector<float> positions, forces;
  for (std::size_t k = 0; k < frames; ++k) {
    const double share = frames > 1 ? static_cast<double>(k) / static_cast<double>(frames - 1) : 0.0;
    const double t = std::min(start + share * span, trajectory.end_time());
    for (const double x : trajectory.positions_at(t)) positions.push_back(static_cast<float>(x));
    // Between two states a force goes along a straight line.
    const std::size_t i = trajectory.state_before(t), next = std::min(i + 1, trajectory.size() - 1);
    const double gap = trajectory.time(next) - trajectory.time(i),
                 u = gap > 0 ? (t - trajectory.time(i)) / gap : 0;
    for (const RodCopy& rod : structure.rod_copies) {
      const auto force = [&](std::size_t at) {
        return job.diagnostics.axial_force(static_cast<Index>(at), rod.source);
      };
      forces.push_back(static_cast<float>((1 - u) * force(i) + (u > 0 ? u * force(next) : 0.0)));
    }
  }
  page["start"] = start;
  page["end"] = trajectory.end_time();
  page["speed"] = job.speed;
  page["frames"] = frames;
  page["positions"] = packed(positions);
  page["forces"] = packed(forces);
}

void add_members(const ExportJob& job, Page& page) {
  const Structure& structure = job.run.trajectory.structure();
  page["nodes"] = page["rods"] = page["groups"] = page["unique"] = Page::array();
  for (const NodeCopy& node : structure.node_copies) page["nodes"].push_back(node.name);
  std::map<std::string, std::size_t> groups;
  for (const RodCopy& copy : structure.rod_copies) {
    const auto source = static_cast<std::size_t>(copy.source);
    const Rod& rod = structure.rods[source];
    const auto [group, added] = groups.try_emplace(rod.group, groups.size());
    if (added) page["groups"].push_back(rod.group.empty() ? "rods" : rod.group);
    page["rods"].push_back(
        {copy.a, copy.b, group->second, rod.radius > 0 ? rod.radius : rod.length / 60, copy.name});
    page["unique"].push_back(
        source < job.diagnostics.rod_unique.size() && job.diagnostics.rod_unique[source] ? 1 : 0);
  }
}

void add_curves(const ExportJob& job, Page& page) {
  const Diagnostics& d = job.diagnostics;
  std::vector<std::size_t> chosen;
  const std::size_t stride = (d.t.size() + most_frames - 1) / most_frames;
  for (std::size_t i = 0; i < d.t.size(); i += std::max<std::size_t>(stride, 1)) chosen.push_back(i);
  if (!chosen.empty() && chosen.back() + 1 < d.t.size()) chosen.push_back(d.t.size() - 1);
  const auto thinned = [&](const std::vector<double>& values) {
    std::vector<double> out;  // single precision would show its steps on a curve that hardly changes
    for (const std::size_t i : chosen) out.push_back(values[i]);
    return packed(out);
  };
  page["times"] = thinned(d.t);
  page["columns"] = Page::array();
  for (const Series& column : d.columns)
    page["columns"].push_back({{"name", column.name},
                               {"label", column.label},
                               {"unit", column.unit},
                               {"values", thinned(column.values)}});
  page["second"] = d.find("fold_angle_rad") ? "fold_angle_rad" : "constraint_max_m";
}

// Why a peak is not unique: the model leaves it open, or the run does not follow it.
const char* doubt_about(const PeakForce& peak, const Diagnostics& d) {
  if (peak.unique) return "";
  return d.rod_unique[static_cast<std::size_t>(peak.rod)]
             ? " (not certain: a singular pose, or waves of elastic rods that the step does not resolve)"
             : " (one choice of many)";
}

void add_words(const ExportJob& job, Page& page) {
  const Simulation& run = job.run;
  const SolverOptions& solver = run.options;
  const Structure& structure = run.trajectory.structure();
  const auto facts = [&](const std::string& name, const std::string& value) {
    page["facts"].push_back({name, value});
  };
  page["title"] = job.title.empty() ? job.name : job.title;
  page["subtitle"] = std::string(to_string(run.status)) + " at " + short_text(run.trajectory.end_time()) +
                     " s" + (run.message.empty() ? "" : ": " + run.message);
  facts("ended",
        std::string(to_string(run.status)) + " at " + std::to_string(run.trajectory.end_time()) + " s");
  facts("structure", std::to_string(structure.node_copies.size()) + " nodes, " +
                         std::to_string(structure.rod_copies.size()) + " rods");
  facts("method", solver.method + ", " + std::to_string(run.steps) + " steps");
  const auto largest = [&](const char* column) {
    const Series* series = job.diagnostics.find(column);
    return series ? short_text(largest_magnitude(series->values)) : "not looked at";
  };
  facts("constraint error", largest("constraint_max_m") + " m");
  facts("energy balance", "off by " + largest("energy_balance_J") + " J at most");
  if (const PeakForce peak = peak_rod_force(job.diagnostics); peak.rod >= 0)
    facts("peak rod force", short_text(peak.force_N) + " N" + doubt_about(peak, job.diagnostics));
  if (!job.command.empty()) facts("command", std::string(job.command));
  facts("made by", "Unfurl " + version());
  page["events"] = page["warnings"] = Page::array();
  for (const Event& event : run.events) page["events"].push_back({{"name", event.name}, {"t", event.t}});
  for (const auto& some : {run.warnings, accuracy_warnings(run, job.diagnostics)})
    for (const auto& warning : some) page["warnings"].push_back(warning);
  page["scene"] = std::string(job.scene);
}

// What stands between two script tags must not look like one.
std::string inside_script(std::string json) {
  std::string out;
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

std::string filled(std::string_view page, std::string_view mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  return std::string(page.substr(0, at)) + text + std::string(page.substr(at + mark.size()));
}

}  // namespace

void export_html(const ExportJob& job) {
  Page page;
  add_words(job, page);
  add_motion(job, page);
  add_members(job, page);
  add_curves(job, page);
  const std::string json = page.dump(-1, ' ', true, Page::error_handler_t::replace);
  const std::string titled = filled(viewer_page, "@TITLE@", xml_text(page["title"].get<std::string>()));
  write_file_atomically(job.directory / "viewer.html", filled(titled, "@DATA@", inside_script(json)));
}

}  // namespace unfurl
