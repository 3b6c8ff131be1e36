// SPDX-License-Identifier: BSD-3-Clause
// The part of a session that a hand on the structure drives: pulling, wiggling, building.
#include <algorithm>
#include <cmath>

#include "app/panel/document/build_edits.hpp"
#include "app/panel/live_session.hpp"

namespace unfurl {

void LiveSession::show_hand() {
  state_.pose = hand_.pose();
  state_.wiggled = hand_.wiggled();
  state_.motions = hand_.motions();
}

void LiveSession::take_tool(Tool tool) {
  let_go();
  state_.tool = state_.tool == tool ? Tool::read : tool;
  if (state_.tool != Tool::build || !state_.shown) return;
  begin_build(places_of(state_.shown->simulation.trajectory.structure()));
}

// At the start, which is what is built; a plane mechanism is built on in its plane.
void LiveSession::begin_build(const std::vector<Vec3>& places) {
  state_.playback.playing = false;
  if (state_.shown) state_.playback.t = state_.shown->simulation.trajectory.start_time();
  for (const int axis : {2, 0, 1})  // of a line's planes the upright one that is seen from the front
    if (in_plane_across(axis, places)) state_.grid.plane = axis;
}

void LiveSession::build_from_nothing() {
  open(blank_document());
  let_go();
  state_.tool = Tool::build;
  std::vector<Vec3> places;
  for (const CustomNode& node : read_document(state_.history.now()).custom.nodes)
    places.push_back(node.position);
  begin_build(places);
}

void LiveSession::pull(const std::string& node, const Vec3& target) {
  if (!state_.shown) return;
  state_.playback.playing = false;
  hand_.pull(state_.shown, state_.playback.t, node, target);
  show_hand();
}

void LiveSession::wiggle() {
  if (!state_.shown) return;
  state_.playback.playing = false;
  const bool wiggled = state_.wiggled >= 0;
  hand_.wiggle(state_.shown, state_.playback.t);
  show_hand();
  if (state_.wiggled >= 0)
    state_.message =
        "free motion " + std::to_string(state_.wiggled + 1) + " of " + std::to_string(state_.motions);
  else
    state_.message =
        wiggled ? "after the last free motion: the run" : "nothing moves freely here but the whole";
}

void LiveSession::let_go() {
  hand_.let_go();
  show_hand();
}

void LiveSession::advance(double seconds) {
  if (hand_.moves()) {
    hand_.advance(seconds);
    show_hand();
  }
  if (!state_.shown) return;
  const Trajectory& trajectory = state_.shown->simulation.trajectory;
  if (state_.playback.playing && seconds > 0) {
    const double rate = 1 / seconds, before = state_.frames_per_second;
    state_.frames_per_second = before > 0 ? before + 0.1 * (rate - before) : rate;
  }
  const double t = state_.playback.t;
  state_.playback = advanced(state_.playback, seconds, trajectory.start_time(), trajectory.end_time());
  if (state_.pose && t != state_.playback.t) let_go();
  // A place that is pointed at in a later pose is none of the start, which is what is built.
  if (state_.tool != Tool::build ||
      (!state_.playback.playing && state_.playback.t == trajectory.start_time()))
    return;
  state_.tool = Tool::read;
  state_.message = "Build is put away: it is of the start (B takes it again, there)";
}

// What cannot be simulated is no step of building: it is refused in words.
void LiveSession::build(const std::string& gesture, SceneDocument document) {
  read_document(document);
  if (gesture.empty())
    state_.history.replace(std::move(document));
  else
    state_.history.change(gesture, std::move(document));
}

void LiveSession::add_node(const Vec3& place) {
  const Vec3 at = snapped(place, state_.grid);
  std::string name, other;
  SceneDocument document = with_node(state_.history.now(), at, name);
  const Vec3 image = mirrored(at, state_.grid.mirror);
  if ((image - at).norm() > 1e-9) document = with_node(document, image, other);
  build("", std::move(document));
  state_.selected = {Selection::Kind::node, name};
  state_.message = "node " + name + (other.empty() ? "" : " and its image " + other);
}

void LiveSession::move_node(const std::string& node, const Vec3& place) {
  const Scene scene = read_document(state_.history.now());
  const Vec3 at = snapped(place, state_.grid);
  std::vector<NodePlace> places{{node, at}};
  if (!state_.grid.follow && state_.shown) {  // lengths stay: the rest goes along
    hand_.pull(state_.shown, state_.shown->simulation.trajectory.start_time(), node, at);
    places.clear();
    const auto& nodes = state_.shown->simulation.trajectory.structure().nodes;
    const VectorXd& q = hand_.solved();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 now = q.segment<3>(3 * static_cast<Index>(i));
      if ((now - nodes[i].position).norm() > 1e-12) places.push_back({nodes[i].name, now});
    }
    show_hand();
  } else if (state_.grid.mirror >= 0) {
    for (const CustomNode& each : scene.custom.nodes)
      if (each.name == node) {
        const std::string image = node_at(scene, mirrored(each.position, state_.grid.mirror));
        if (!image.empty() && image != node) places.push_back({image, mirrored(at, state_.grid.mirror)});
      }
  }
  if (places.empty()) return;
  build("move " + node, with_positions(state_.history.now(), places, state_.grid.follow));
}

void LiveSession::connect(const std::string& a, const std::string& b) {
  if (a == b) return;
  SceneDocument document = with_rod(state_.history.now(), a, b);
  if (state_.grid.mirror >= 0) {
    const Scene scene = read_document(document);
    const auto image = [&](const std::string& name) -> std::string {
      for (const CustomNode& node : scene.custom.nodes)
        if (node.name == name) return node_at(scene, mirrored(node.position, state_.grid.mirror));
      return "";
    };
    const std::string c = image(a), d = image(b);
    if (!c.empty() && !d.empty() && c != d) document = with_rod(document, c, d);
  }
  build("", std::move(document));
  state_.message = "rod " + a + "-" + b;
}

void LiveSession::remove_selected() {
  if (state_.selected.kind == Selection::Kind::none) return;
  const std::string name = state_.selected.name;
  SceneDocument without = without_part(state_.history.now(), state_.selected);
  state_.selected = {};
  if (without == state_.history.now()) {
    state_.message = "the scene has no " + name;
    return;
  }
  build("", std::move(without));
  state_.message = name + " is taken away";
}

}  // namespace unfurl
