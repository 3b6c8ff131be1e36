// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/family.hpp"

#include <algorithm>
#include <array>

#include "core/structures/bricard.hpp"
#include "core/structures/cable_ring.hpp"
#include "core/structures/chain.hpp"
#include "core/structures/four_bar_ladder.hpp"
#include "core/structures/hoberman.hpp"
#include "core/structures/hoop.hpp"
#include "core/structures/mesh_reflector.hpp"
#include "core/structures/pendulum.hpp"
#include "core/structures/reentrant_sheet.hpp"
#include "core/structures/rod_material.hpp"
#include "core/structures/scissor_mast.hpp"
#include "core/structures/scissor_ring.hpp"

namespace unfurl {

namespace {

// Of a family whose rods have one section_area: its parameters and those of the rods' material.
template <const std::vector<ParamSpec>& (*own)()>
const std::vector<ParamSpec>& with_material() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> all = own();
    all.insert(all.end(), rod_material_params().begin(), rod_material_params().end());
    return all;
  }();
  return params;
}

template <Structure (*own)(const ParamSet&)>
Structure of_material(const ParamSet& params) {
  Structure structure = own(params);
  give_material(structure, params.real("section_area"), rod_material(params));
  return structure;
}

}  // namespace

std::span<const Family> families() {
  static const std::array rows{
      Family{"hoop", "ring antenna of n re-entrant units that share their posts", with_material<hoop_params>,
             of_material<build_hoop>, true},
      Family{"scissor_mast", "mast of crossed rods pinned at their middles, planar or with 3 and more sides",
             with_material<scissor_mast_params>, of_material<build_scissor_mast>, true},
      Family{"scissor_ring", "closed ring of crossed rods pinned at their middles, which opens from a bundle",
             with_material<scissor_ring_params>, of_material<build_scissor_ring>, true},
      Family{"cable_ring", "ring of parallelograms that one cable through telescoping diagonals deploys",
             with_material<cable_ring_params>, of_material<build_cable_ring>, true},
      Family{"mesh_reflector", "hoop with a front and a rear net, drawn to a paraboloid by tension ties",
             with_material<mesh_reflector_params>, of_material<build_mesh_reflector>, true},
      Family{"hoberman", "Hoberman's ring of angulated elements, which grows in its plane",
             with_material<hoberman_params>, of_material<build_hoberman>, true},
      Family{"reentrant_sheet", "sheet of re-entrant units: a negative Poisson's ratio",
             with_material<reentrant_sheet_params>, of_material<build_reentrant_sheet>, true},
      Family{"bricard",
             "overconstrained loop of six bars and six hinges, which opens from a bundle to a triangle",
             with_material<bricard_params>, of_material<build_bricard>, true},
      Family{"chain", "rigid links in a row, hanging, falling or free", with_material<chain_params>,
             of_material<build_chain>, false},
      Family{"pendulum", "a rod with a bob, swinging from a fixed point", pendulum_params, build_pendulum,
             false},
      Family{"four_bar_ladder", "row of four-bar windows that passes poses with all rods collinear",
             four_bar_ladder_params, build_four_bar_ladder, false},
  };
  return rows;
}

const Family* find_family(std::string_view kind) {
  const auto rows = families();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const Family& f) { return f.kind == kind; });
  return it == rows.end() ? nullptr : &*it;
}

}  // namespace unfurl
