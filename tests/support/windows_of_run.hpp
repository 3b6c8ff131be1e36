// SPDX-License-Identifier: BSD-3-Clause
// A run as long ones go: window by window, and from checkpoint to checkpoint.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/diagnostics/run_digest.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/parts.hpp"

namespace unfurl::testing {

struct Windows {
  std::vector<Stepper::Window> parts;
  Simulation rest;
  std::size_t first = 0;
};

inline Windows windows_of(const Scene& scene, std::size_t states) {
  const auto model = build_model(scene);
  Windows out{{}, Simulation{.trajectory = Trajectory(model)}};
  Parts parts{.states = states, .around = 9};
  parts.take = [&](Stepper::Window window, Stepper&) { out.parts.push_back(std::move(window)); };
  out.rest = simulate_in_parts(model, scene.solver, {}, parts, out.first);
  return out;
}

// As a run finds it that goes on from its checkpoint.
inline RunDigest behind_checkpoint(RunDigest& digest, const Scene& scene) {
  Archive out;
  digest.archive(out);
  Archive in(out.bytes());
  RunDigest again(build_model(scene), scene.solver);
  again.archive(in);
  return again;
}

// What is said in the end by digests that were archived behind every part.
inline Digest from_checkpoint_to_checkpoint(Windows& w, const std::shared_ptr<const Model>& model,
                                            const Scene& scene) {
  RunDigest digest(model, scene.solver);
  for (Stepper::Window& part : w.parts) {
    digest.add(part.run, part.first, part.last);
    digest.settle();
    digest = behind_checkpoint(digest, scene);
  }
  digest.add(w.rest, w.first, w.rest.trajectory.size());
  return digest.whole(w.rest);
}

}  // namespace unfurl::testing
