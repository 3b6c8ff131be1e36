// SPDX-License-Identifier: BSD-3-Clause
// One self-contained page: the structure turning in a browser (WebGL 2, core/export/viewer.html), its curves,
// its scene. Positions and forces are single precision, at times between which straight lines are the motion;
// times and curves are double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "core/diagnostics/force_round_off.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/export/motion_keys.hpp"
#include "core/export/upright.hpp"
#include "core/math/drawing_origin.hpp"
#include "core/math/largest.hpp"
#include "core/math/magnitudes.hpp"
#include "core/structure/seams.hpp"
#include "core/structure/shown_lines.hpp"
#include "core/text/base64.hpp"
#include "core/text/typeset_number.hpp"
#include "core/text/version.hpp"
#include "core/text/xml_text.hpp"

namespace unfurl {

extern const char* const viewer_page;  // written by the build from viewer.html

namespace {

using Page = nlohmann::ordered_json;

constexpr std::size_t most_poses = 20'000, most_numbers = 12'000'000;  // 48 MB in single precision
constexpr std::size_t most_of_forces = 1500;                           // poses that are there for them alone
constexpr double force_share = 0.02;  // what they may be off by, of those that have full colours
constexpr std::size_t most_points = 1500, parts_of_curves = 300;  // of curves

std::string packed(const auto& values) {
  return base64(std::as_bytes(std::span(values)));
}

// Within what a browser bears.
std::size_t bearable_poses(const Structure& structure) {
  const std::size_t numbers = 3 * structure.node_copies.size() + structure.rod_copies.size();
  return std::clamp<std::size_t>(most_numbers / std::max<std::size_t>(numbers, 1), 2, most_poses);
}

// Of rods that are shown; what is rounding alone is none.
MatrixXd shown_forces(const ExportJob& job) {
  MatrixXd forces = without_round_off(job.run, job.diagnostics, job.diagnostics.axial_force);
  for (Index r = 0; r < forces.cols(); ++r)
    if (!job.diagnostics.shows(r)) forces.col(r).setConstant(std::numeric_limits<double>::quiet_NaN());
  return forces;
}

void add_motion(const ExportJob& job, Page& page) {
  const Trajectory& trajectory = job.run.trajectory;
  const Structure& structure = trajectory.structure();
  const std::size_t most = bearable_poses(structure);
  MotionKeys keys = motion_keys(trajectory, job.frame_interval, most, job.between);
  const MatrixXd known = shown_forces(job);
  const Magnitudes size = magnitudes(known);
  const double bearable = force_share * size.usual;
  const double off =
      add_value_keys(trajectory, known, bearable, std::min(most, keys.times.size() + most_of_forces), keys);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const VectorXd& pose : keys.poses)
    for (Index n = 0; n < pose.size() / 3; ++n) {
      low = low.cwiseMin(pose.segment<3>(3 * n));
      high = high.cwiseMax(pose.segment<3>(3 * n));
    }
  const Vec3 origin = drawing_origin(0.5 * (low + high), 0.5 * (high - low).norm());
  const Mat3 upright = upright_rotation(structure.gravity);
  std::vector<float> positions, forces;
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    job.next();
    for (Index n = 0; n < keys.poses[k].size() / 3; ++n)
      for (const double x : Vec3(upright * (keys.poses[k].segment<3>(3 * n) - origin)))
        positions.push_back(static_cast<float>(x));
    const VectorXd force = values_at(trajectory, known, keys.times[k]);
    for (const RodCopy& rod : structure.rod_copies) forces.push_back(static_cast<float>(force[rod.source]));
  }
  page["start"] = trajectory.start_time();
  page["end"] = trajectory.end_time();
  page["speed"] = job.speed;
  page["frames"] = keys.times.size();
  page["moments"] = packed(keys.times);
  page["origin"] = {origin.x(), origin.y(), origin.z()};
  for (const double x : upright.reshaped()) page["upright"].push_back(x);  // by columns
  page["positions"] = packed(positions);
  page["forces"] = packed(forces);
  page["largest_force"] = size.most;
  page["full_force"] = size.usual;
  std::vector<std::string> warnings{too_few_keys(keys, "viewer.html")};
  if (off > bearable)
    warnings.push_back("viewer.html has " + std::to_string(keys.times.size()) +
                       " poses, too few for the rod forces: between two of them it shows some up to " +
                       format_number(off, 3) + " N off, which rod_forces.csv has");
  for (const std::string& warning : warnings) {
    if (warning.empty()) continue;
    page["warnings"].push_back(warning);
    if (job.said) job.said->push_back(warning);
  }
}

void add_members(const ExportJob& job, Page& page) {
  const Structure& structure = job.run.trajectory.structure();
  page["nodes"] = page["rods"] = page["groups"] = page["unique"] = page["seams"] = Page::array();
  for (const NodeCopy& node : structure.node_copies) page["nodes"].push_back(node.name);
  const std::vector<bool> between = seams(structure);
  for (std::size_t n = 0; n < between.size(); ++n)
    if (between[n]) page["seams"].push_back(n);
  std::map<std::string, std::size_t> groups;
  for (const RodCopy& copy : structure.rod_copies) {
    const auto source = static_cast<std::size_t>(copy.source);
    const Rod& rod = structure.rods[source];
    const auto [group, added] = groups.try_emplace(rod.group, groups.size());
    if (added) page["groups"].push_back(rod.group);
    page["rods"].push_back(
        {copy.a, copy.b, group->second, rod.radius > 0 ? rod.radius : rod.pinned_length() / 60, copy.name});
    page["unique"].push_back(
        source < job.diagnostics.rod_unique.size() && job.diagnostics.rod_unique[source] ? 1 : 0);
  }
}

// What is no rod and is drawn thinner than any.
void add_lines(const ExportJob& job, Page& page) {
  const Structure& structure = job.run.trajectory.structure();
  page["lines"] = Page::array();
  for (const ShownLine& line : lines_between_nodes(structure))
    page["lines"].push_back({line.a, line.b, line.group});
  const VectorXd pose = job.run.trajectory.positions(0);
  const Eigen::Map<const Eigen::Matrix3Xd> at(pose.data(), 3, pose.size() / 3);
  const double size = at.cols() > 0 ? (at.rowwise().maxCoeff() - at.rowwise().minCoeff()).norm() : 0.0;
  page["line_radius"] = shown_line_radius(structure, size);
}

// All states, or the first, the last, the least and the most of each curve in some hundred parts of the run:
// a peak of a single state stays where it is.
std::vector<std::size_t> states_of_curves(const Diagnostics& d) {
  std::vector<std::size_t> chosen;
  if (d.t.size() <= most_points) {
    for (std::size_t i = 0; i < d.t.size(); ++i) chosen.push_back(i);
    return chosen;
  }
  for (std::size_t part = 0; part < parts_of_curves; ++part) {
    const std::size_t from = d.t.size() * part / parts_of_curves,
                      to = d.t.size() * (part + 1) / parts_of_curves;
    chosen.insert(chosen.end(), {from, to - 1});
    for (const Series& column : d.columns) {
      std::size_t least = to, most = to;
      for (std::size_t i = from; i < to; ++i) {
        const double y = column.values[i];
        if (!std::isfinite(y)) continue;
        if (least == to || y < column.values[least]) least = i;
        if (most == to || y > column.values[most]) most = i;
      }
      if (least < to) chosen.insert(chosen.end(), {least, most});
    }
  }
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

void add_curves(const ExportJob& job, Page& page) {
  const Diagnostics& d = job.diagnostics;
  const std::vector<std::size_t> chosen = states_of_curves(d);
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
  page["subtitle"] = std::string(to_string(run.status)) + " at " +
                     format_number(run.trajectory.end_time(), 3) + " s" +
                     (run.message.empty() ? "" : ": " + run.message);
  facts("ended",
        std::string(to_string(run.status)) + " at " + format_number(run.trajectory.end_time(), 9) + " s");
  facts("structure", std::to_string(structure.node_copies.size()) + " nodes, " +
                         std::to_string(structure.rod_copies.size()) + " rods");
  facts("method", (solved_as(run).name == "path" ? "along its path" : solver.method) + ", " +
                      std::to_string(run.steps) + " steps");
  const auto largest = [&](const char* column) {
    const Series* series = job.diagnostics.find(column);
    return series ? format_number(largest_magnitude(series->values), 3) : "not looked at";
  };
  facts("constraint error", largest("constraint_max_m") + " m");
  facts("energy balance", "off by " + largest("energy_balance_J") + " J at most");
  const RememberedExtremes once;
  if (const PeakForce peak = peak_rod_force(run, job.diagnostics); peak.rod >= 0)
    facts("peak rod force",
          format_number(
              std::copysign(find_measure("peak_rod_force").value(run, job.diagnostics), peak.force_N), 3) +
              " N" + doubt_about(peak, job.diagnostics));
  if (!job.command.empty()) facts("command, of the scene below", std::string(job.command));
  facts("made by", "Unfurl " + version());
  page["events"] = page["warnings"] = Page::array();
  for (const Event& event : run.events) page["events"].push_back({{"name", event.name}, {"t", event.t}});
  for (const std::string& warning : lasting_warnings(run, job.diagnostics, job.about_text))
    page["warnings"].push_back(warning);
  page["scene"] = std::string(job.scene);
}

// What stands between two script tags must not look like one.
std::string inside_script(std::string json) {
  std::string out;
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

// Both marks of the page are found before either is filled: what they are filled with may look like one.
std::string filled(std::string_view page, const std::string& title, const std::string& data) {
  constexpr std::string_view title_mark = "@TITLE@", data_mark = "@DATA@";
  const std::size_t first = page.find(title_mark), second = page.find(data_mark);
  const std::size_t between = first + title_mark.size();
  return std::string(page.substr(0, first)) + title + std::string(page.substr(between, second - between)) +
         data + std::string(page.substr(second + data_mark.size()));
}

}  // namespace

void export_html(const ExportJob& job) {
  Page page;
  add_words(job, page);
  add_motion(job, page);
  add_members(job, page);
  add_lines(job, page);
  add_curves(job, page);
  job.next();
  const std::string json = page.dump(-1, ' ', true, Page::error_handler_t::replace);
  write_file_atomically(job.directory / "viewer.html",
                        filled(viewer_page, xml_text(page["title"].get<std::string>()), inside_script(json)));
}

}  // namespace unfurl
