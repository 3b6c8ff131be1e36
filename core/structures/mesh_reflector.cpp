// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/mesh_reflector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/cable_ring.hpp"
#include "core/structures/force_density.hpp"
#include "core/structures/hoop.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {
namespace {

// The nets' numbers; nodes of the front net are 0 ..., those of the rear net follow, as many.
struct Nets {
  int n = 0, rings = 0;
  double radius = 0, height = 0, focal = 0;     // of the deployed corners: radius, half height [m]
  double density = 0, stiffness = 0, mass = 0;  // q [N/m], E A [N], [kg/m]
  double smoothing = 0;                         // w [m]
  std::vector<NetMember> members;               // of the front net
  std::vector<Vec3> form;                       // of its nodes when deployed
  std::vector<double> tie;                      // force of each node's tie [N]; 0: it is a corner

  int first(int ring) const { return ring == 0 ? 0 : 1 + n * ring * (ring - 1) / 2; }
  int node(int ring, int i) const { return ring == 0 ? 0 : first(ring) + i % (n * ring); }
  int count() const { return first(rings + 1); }
  int corner(int k) const { return node(rings, k * rings); }
  // Of a member that is to pull with F over that length: with E A e / L_0, or in the smoothed part of the
  // law, e < w, with E A (e + w)^2 / (4 w L_0), e = length - L_0 (`smoothing` in docs/scene.md).
  double unstressed(double length, double F) const {
    const double plain = length / (1 + F / stiffness);
    if (length - plain >= smoothing) return plain;
    const double a = length + smoothing, b = 2 * smoothing * F / stiffness;
    return a + b - std::sqrt(b * (2 * a + b));
  }
};

void add_triangles(Nets& net, double edge_ratio) {
  for (int r = 1; r <= net.rings; ++r) {
    const double q = net.density * (r == net.rings ? edge_ratio : 1.0);
    for (int i = 0; i < net.n * r; ++i) net.members.push_back({net.node(r, i), net.node(r, i + 1), q});
    // Node k of a sector in ring r - 1 is between k and k + 1 of ring r.
    for (int s = 0; s < net.n; ++s)
      for (int k = 0; k < std::max(r - 1, 1); ++k)
        for (const int beside : {0, 1}) {
          if (r == 1 && beside == 1) continue;
          net.members.push_back(
              {net.node(r - 1, s * (r - 1) + k), net.node(r, s * r + k + beside), net.density});
        }
    for (int s = 0; r > 1 && s < net.n; ++s)  // the corner of a sector has a third one outwards, behind it
      net.members.push_back({net.node(r - 1, s * (r - 1)), net.node(r, s * r + net.n * r - 1), net.density});
  }
}

void find_net_form(Nets& net) {
  const auto count = static_cast<std::size_t>(net.count());
  std::vector<bool> fixed(count, false);
  net.form.assign(count, Vec3::Zero());
  for (int k = 0; k < net.n; ++k) {
    const auto corner = static_cast<std::size_t>(net.corner(k));
    fixed[corner] = true;
    net.form[corner] = net.radius * radial(2 * pi * k / net.n);
  }
  find_form(net.members, fixed, std::vector<Vec3>(count, Vec3::Zero()), net.form);
  const double vertex = net.height - net.radius * net.radius / (4 * net.focal);
  for (Vec3& x : net.form) x[2] = vertex + x.squaredNorm() / (4 * net.focal);
  if (!(vertex > 0)) {
    std::ostringstream text;
    text << "is too short: the front and the rear net would meet in the middle; it must be > "
         << net.radius * net.radius / (4 * net.height) << " m, or post_length > "
         << net.radius * net.radius / (2 * net.focal) << " m";
    throw StructureError("focal_length", text.str());
  }
  // The edge has no ties: it hangs between the corners and the rings inside.
  for (int i = 0; i < net.first(net.rings); ++i) fixed[static_cast<std::size_t>(i)] = true;
  find_form(net.members, fixed, std::vector<Vec3>(count, Vec3::Zero()), net.form);
  net.tie.assign(count, 0.0);
  for (const NetMember& m : net.members) {
    const double pull =
        m.density * (net.form[static_cast<std::size_t>(m.b)] - net.form[static_cast<std::size_t>(m.a)])[2];
    if (m.a < net.first(net.rings)) net.tie[static_cast<std::size_t>(m.a)] += pull;
    if (m.b < net.first(net.rings)) net.tie[static_cast<std::size_t>(m.b)] -= pull;
  }
}

Structure build_rim(const ParamSet& params) {
  const bool cable = params.text("hoop") == "cable_ring";
  ParamSet rim(cable ? cable_ring_params() : hoop_params());
  for (const char* key : {"units", "post_length", "density", "section_area", "fold_angle", "mass"})
    rim.set(key, params.value(key));
  if (cable) {
    for (const char* key :
         {"longeron_length", "cable_rate", "cable_ramp", "joint_damping", "gears", "diagonal_mass"})
      rim.set(key, params.value(key));
    return build_cable_ring(rim);
  }
  rim.set("chord_rod_length", 0.5 * params.real("longeron_length"));
  rim.set("hinge_force", params.real("hinge_force"));
  return build_hoop(rim);
}

// The corners of the rim's posts, bottom and top.
int rim_corner(const ParamSet& params, int k, bool top) {
  return (params.text("hoop") == "cable_ring" ? 2 : 4) * k + (top ? 1 : 0);
}

// The nets cannot be slack in the pose that is asked for.
struct NoRoom {
  std::string said;
};

class NetBuilder {
 public:
  NetBuilder(const ParamSet& params, const Nets& net, Structure& out)
      : params_(params), net_(net), out_(out), smoothing_(net.smoothing) {}

  void build() {
    first_member_ = out_.forces.size();
    for (const bool front : {true, false}) add_nodes(front);
    for (const bool front : {true, false})
      for (const NetMember& m : net_.members) {
        if (along_longeron(m)) continue;
        const double length =
            (net_.form[static_cast<std::size_t>(m.b)] - net_.form[static_cast<std::size_t>(m.a)]).norm();
        add_member(node(front, m.a), node(front, m.b), net_.unstressed(length, m.density * length));
      }
    for (int i = 0; i < net_.count(); ++i) {
      const auto u = static_cast<std::size_t>(i);
      const double gap = 2 * net_.form[u][2];
      if (net_.tie[u] > 0) add_member(node(true, i), node(false, i), net_.unstressed(gap, net_.tie[u]));
    }
    slacken();
    ReportedSurface surface{"surface_rms_m", "surface error", {}, net_.focal};
    for (int i = 0; i < net_.first(net_.rings); ++i) surface.nodes.push_back(node(true, i));
    out_.surfaces.push_back(std::move(surface));
  }

 private:
  // The edge of a net of one ring joins corners that a rim of rigid longerons keeps apart in every pose: it
  // could neither be slack nor pull on anything but a longeron.
  bool along_longeron(const NetMember& m) const {
    return net_.rings == 1 && m.a >= net_.first(1) && m.b >= net_.first(1) &&
           params_.text("hoop") == "cable_ring";
  }

  int node(bool front, int i) const { return nodes_[front ? 0 : 1][static_cast<std::size_t>(i)]; }

  // On the facets between the centre and the rim's corners as the rim is now.
  void add_nodes(bool front) {
    const int m = net_.rings;
    const double side = front ? 1.0 : -1.0;
    const auto corner = [&](int k) {
      return out_.nodes[static_cast<std::size_t>(rim_corner(params_, k % net_.n, front))].position;
    };
    const Vec3 centre = side * net_.form[0];
    std::vector<int>& own = nodes_[front ? 0 : 1];
    for (int r = 0; r <= m; ++r)
      for (int i = 0; i < (r == 0 ? 1 : net_.n * r); ++i) {
        const int sector = r == 0 ? 0 : i / r, k = r == 0 ? 0 : i % r;
        if (r == m && k == 0) {
          own.push_back(rim_corner(params_, sector, front));
          continue;
        }
        const double out = static_cast<double>(r - k) / m, next = static_cast<double>(k) / m;
        own.push_back(static_cast<int>(out_.nodes.size()));
        Node added{(front ? "F" : "R") + std::to_string(r) + "." + std::to_string(i),
                   (1 - out - next) * centre + out * corner(sector) + next * corner(sector + 1)};
        out_.nodes.push_back(std::move(added));
      }
  }

  void add_member(int a, int b, double unstressed) {
    Force f;
    f.kind = "cable";
    f.name = "net";
    f.measure.nodes = {a, b};
    f.axial_stiffness = net_.stiffness;
    f.damping = params_.real("net_damping");
    f.smoothing = smoothing_;
    f.one_sided = true;
    f.rest = f.unstressed.offset = unstressed;
    for (const int end : {a, b})
      out_.nodes[static_cast<std::size_t>(end)].mass += 0.5 * net_.mass * unstressed;
    out_.forces.push_back(std::move(f));
  }

  // No member longer than unstressed, less what the smoothed law begins with: all that are longer are pulled
  // together, their ends by halves, every node by the mean of what pulls it, until none is. All at once, so
  // that the nets keep the symmetry of the rim: else they would turn it as they go taut.
  void slacken() {
    constexpr int most_rounds = 20000;
    std::vector<Vec3> pulls(out_.nodes.size());
    std::vector<int> pulled(out_.nodes.size());
    std::vector<bool> movable(out_.nodes.size(), false);
    for (const auto& own : nodes_)
      for (int i = 0; i < net_.count(); ++i)
        movable[static_cast<std::size_t>(own[static_cast<std::size_t>(i)])] = true;
    for (int k = 0; k < net_.n; ++k)
      for (const bool front : {true, false})
        movable[static_cast<std::size_t>(rim_corner(params_, k, front))] = false;
    double worst = 0;
    for (int round = 0; round < most_rounds; ++round) {
      worst = 0;
      std::fill(pulls.begin(), pulls.end(), Vec3::Zero());
      std::fill(pulled.begin(), pulled.end(), 0);
      for (std::size_t i = first_member_; i < out_.forces.size(); ++i) {
        const Force& f = out_.forces[i];
        const auto a = static_cast<std::size_t>(f.measure.nodes[0]),
                   b = static_cast<std::size_t>(f.measure.nodes[1]);
        const Vec3 d = out_.nodes[b].position - out_.nodes[a].position;
        const double over = d.norm() - (f.rest - 1.01 * smoothing_);
        if (!(over > 0)) continue;
        worst = std::max(worst, over);
        const double parts = (movable[a] ? 1.0 : 0.0) + (movable[b] ? 1.0 : 0.0);
        if (parts == 0.0) continue;
        const Vec3 pull = over / (parts * d.norm()) * d;
        pulls[a] += pull;
        pulls[b] -= pull;
        ++pulled[a];
        ++pulled[b];
      }
      for (std::size_t i = 0; i < pulls.size(); ++i)
        if (movable[i] && pulled[i] > 0) out_.nodes[i].position += pulls[i] / pulled[i];
      if (worst <= 0.01 * smoothing_) return;
    }
    std::ostringstream text;
    text << "folded so, some members are " << worst << " m too long to be slack; ";
    throw NoRoom{text.str()};
  }

  const ParamSet& params_;
  const Nets& net_;
  Structure& out_;
  double smoothing_;
  std::size_t first_member_ = 0;  // of the forces
  std::vector<int> nodes_[2];     // front, rear
};

constexpr double no_end = std::numeric_limits<double>::infinity();

ParamSpec of_nets(ParamSpec spec) {
  return only_with("nets", {"true"}, std::move(spec));
}

}  // namespace

const std::vector<ParamSpec>& mesh_reflector_params() {
  static const std::vector<ParamSpec> params{
      choice_param("hoop", "cable_ring", {"cable_ring", "hoop"},
                   "the rim: bays deployed by a running cable, or re-entrant units driven at their hinges"),
      integer_param("units", 6, 4, 10000, "number of bays around the rim"),
      positive_param("longeron_length", "m", 1.6, "chord of a bay of the deployed rim"),
      positive_param("post_length", "m", 1.4, "height of the rim"),
      positive_param("density", "kg/m^3", 1600.0, "density of the rods"),
      positive_param("section_area", "m^2", 2e-4, "cross section of the rods"),
      inside(real_param("fold_angle", "deg", 80.0, 0.0, 90.0, "of the rim at t = 0; 0 is fully deployed")),
      only_with("hoop", {"cable_ring"},
                real_param("cable_rate", "m/s", 0.5, 0.0, no_end, "at which the rim's cable is drawn in")),
      only_given("cable_rate",
                 real_param("cable_ramp", "s", 2.0, 0.0, no_end, "how long the cable takes to reach that")),
      only_with("hoop", {"cable_ring"},
                real_param("joint_damping", "N m s/rad", 1.0, 0.0, no_end,
                           "of every longeron at either of its battens")),
      only_with("hoop", {"cable_ring"},
                real_param("diagonal_mass", "kg", 0.1, 0.0, no_end,
                           "of a telescoping diagonal of the rim, shared by the corners of its bay")),
      only_with("hoop", {"cable_ring"}, boolean_param("gears", true, "synchronising gears at the battens")),
      only_with("hoop", {"hoop"},
                real_param("hinge_force", "N", 20.0, -1e12, 1e12,
                           "-f along z on each bottom hinge, +f on each top hinge")),
      of_nets(positive_param("focal_length", "m", 6.0, "of the paraboloid that the front net is to take")),
      boolean_param("nets", true, "front and rear net with their ties"),
      of_nets(
          integer_param("net_rings", 2, 1, 200, "rings of triangles from the centre of a net to its edge")),
      of_nets(positive_param("force_density", "N/m", 0.5,
                             "force of the nets' members per length, when deployed")),
      of_nets(positive_param("edge_density", "", 10.0, "times as much in the members of the edge")),
      of_nets(positive_param("net_stiffness", "N", 2e3, "E A of a member of a net or a tie")),
      of_nets(positive_param("net_mass", "kg/m", 1e-2, "mass of members and ties per length")),
      of_nets(
          real_param("net_damping", "N s/m", 2.0, 0.0, no_end, "force of a member per m/s of stretching")),
      of_nets(positive_param("smoothing", "m", 1e-3,
                             "a member begins to pull over this much on both sides of its length")),
      choice_param("mass", "consistent", {"consistent", "lumped"}, "mass matrix of a rod"),
  };
  return params;
}

namespace {

Nets nets_of(const ParamSet& params) {
  Nets net;
  net.n = static_cast<int>(params.integer("units"));
  net.rings = static_cast<int>(params.integer("net_rings"));
  net.radius = params.real("longeron_length") / (2 * std::sin(pi / net.n));
  net.height = 0.5 * params.real("post_length");
  net.focal = params.real("focal_length");
  net.density = params.real("force_density");
  net.stiffness = params.real("net_stiffness");
  net.mass = params.real("net_mass");
  net.smoothing = params.real("smoothing");
  add_triangles(net, params.real("edge_density"));
  find_net_form(net);
  return net;
}

// Whether the nets would be slack in a rim folded so.
bool have_room(const ParamSet& params, const Nets& net, double fold_degrees) {
  ParamSet folded = params;
  folded.set("fold_angle", fold_degrees);
  Structure out = build_rim(folded);
  try {
    NetBuilder(folded, net, out).build();
  } catch (const NoRoom&) {
    return false;
  }
  return true;
}

// A rim that is hardly folded is still as wide as the nets, one that is folded far may be as high as they
// are wide: what helps is tried.
[[noreturn]] void refuse_room(const ParamSet& params, const Nets& net, const std::string& said) {
  const double fold = params.real("fold_angle");
  const char* way = have_room(params, net, 0.5 * (fold + 90)) ? "fold it more, or "
                    : have_room(params, net, 0.5 * fold)      ? "fold it less, or "
                                                              : "";
  throw StructureError("fold_angle", "leaves no room for the nets: " + said + way +
                                         "take a larger focal_length or a smaller smoothing");
}

}  // namespace

Structure build_mesh_reflector(const ParamSet& params) {
  Structure out = build_rim(params);
  out.kind = "mesh_reflector";
  if (params.boolean("nets")) {
    const Nets net = nets_of(params);
    try {
      NetBuilder(params, net, out).build();
    } catch (const NoRoom& none) {
      refuse_room(params, net, none.said);
    }
  }
  show_as_solved(out);
  return out;
}

}  // namespace unfurl
