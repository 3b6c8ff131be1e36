// SPDX-License-Identifier: BSD-3-Clause
// What exports take over from pictures: materials of groups, surfaces between nodes.
#pragma once

#include "core/export/formats.hpp"
#include "core/scene/scene.hpp"

namespace unfurl {

// `run` must outlive what is returned. Throws SceneError where a surface's nodes are not there.
ExportedLooks exported_looks(const Scene& scene, const Trajectory& run);

}  // namespace unfurl
