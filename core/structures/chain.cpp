// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/chain.hpp"

#include <cmath>
#include <cstdio>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"

namespace unfurl {

namespace {

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g m", length);
  return text;
}

// sum_i cos(theta_i) for the slope step u = m g / H; falls from `links` at u = 0.
double spanned_links(long links, double u) {
  double sum = 0;
  for (long i = 0; i < links; ++i) {
    const double slope = (static_cast<double>(i) - 0.5 * static_cast<double>(links - 1)) * u;
    sum += 1.0 / std::hypot(1.0, slope);
  }
  return sum;
}

// The slope step at which the links span `wanted` link lengths: bisection of log(u), to round-off.
double slope_step(long links, double wanted) {
  double lo = -80, hi = 80;
  for (int it = 0; it < 200 && hi - lo > 1e-16 * std::abs(lo); ++it) {
    const double middle = 0.5 * (lo + hi);
    (spanned_links(links, std::exp(middle)) > wanted ? lo : hi) = middle;
  }
  return std::exp(0.5 * (lo + hi));
}

void check_span(long links, double l, double span) {
  const double reach = static_cast<double>(links) * l, least = links % 2 == 0 ? 0.0 : l;
  const std::string chain = std::to_string(links) + " links of " + metres(l);
  if (!(span < reach))
    throw StructureError("span", "a span of " + metres(span) +
                                     " is out of reach for links and link_length: " + chain +
                                     " hang between ends less than " + metres(reach) + " apart");
  if (!(span > least))
    throw StructureError("span", "a span of " + metres(span) +
                                     " is too small: an odd number of links hangs with its middle link "
                                     "level, so the span must be more than link_length, " +
                                     metres(l));
}

// Unit vectors along the links.
std::vector<Vec3> directions(const ParamSet& params) {
  const long links = params.integer("links");
  std::vector<Vec3> out;
  if (params.text("shape") == "straight") {
    const double angle = params.real("angle") * radians_per_degree;
    out.assign(static_cast<std::size_t>(links), Vec3(std::sin(angle), 0, -std::cos(angle)));
    return out;
  }
  const double l = params.real("link_length"), span = params.real("span");
  check_span(links, l, span);
  const double u = slope_step(links, span / l);
  for (long i = 0; i < links; ++i) {
    const double slope = (static_cast<double>(i) - 0.5 * static_cast<double>(links - 1)) * u;
    out.push_back(Vec3(1.0, 0, slope) / std::hypot(1.0, slope));
  }
  return out;
}

}  // namespace

const std::vector<ParamSpec>& chain_params() {
  static const std::vector<ParamSpec> params{
      integer_param("links", 20, 1, 100000, "number of links"),
      positive_param("link_length", "m", 0.1, "length of a link"),
      density_param(),
      section_area_param(1e-4),
      choice_param("shape", "catenary", {"straight", "catenary"}, "shape at t = 0"),
      only_with("shape", {"straight"},
                real_param("angle", "deg", 0.0, -180.0, 180.0, "straight: angle from the downward vertical")),
      only_with("shape", {"catenary"},
                positive_param("span", "m", 1.0, "catenary: distance of the chain's ends")),
      choice_param("held", "start", {"none", "start", "both"}, "which ends are held in place"),
  };
  return params;
}

Structure build_chain(const ParamSet& params) {
  if (params.integer("links") == 1 && params.text("held") == "both")
    throw StructureError("held",
                         "a single link held at both ends cannot move: set links > 1 or held = \"start\"");
  const double l = params.real("link_length");
  const RodSection section = rod_section(params);
  Assembly a;
  Vec3 at = Vec3::Zero();
  int last = a.node("J0", at);
  for (const Vec3& direction : directions(params)) {
    at += l * direction;
    const int next = a.node("J" + std::to_string(last + 1), at);
    a.rod(last, next, l, section.mass_per_length * l, "link", section.radius);
    last = next;
  }
  const std::string& held = params.text("held");
  if (held != "none") a.fix(0);
  if (held == "both") a.fix(last);
  a.structure.kind = "chain";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
