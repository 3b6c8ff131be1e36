// SPDX-License-Identifier: BSD-3-Clause
// The pictures of a run: a PNG per frame, and films made of the finished frames.
#pragma once

#include <filesystem>
#include <map>
#include <memory>

#include "app/command.hpp"
#include "app/output/film_folder.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/team.hpp"
#include "render/gl/context.hpp"
#include "render/image/image.hpp"

namespace unfurl {

// Frames that were drawn and need not be read back, as many as memory has room for.
class FrameMemory {
 public:
  void keep(std::size_t frame, std::shared_ptr<const Image> image);
  std::shared_ptr<const Image> find(std::size_t frame) const;  // nullptr: to be read from its file

 private:
  std::map<std::size_t, std::shared_ptr<const Image>> frames_;
  double bytes_ = 0;
};

// How many frames a run to the scene's end time would have at most; throws SceneError where that is beyond
// reason.
void check_film(const Scene& scene);

// Draws the frames that the folder lacks, or those of them that --frames asks for. Stops at Ctrl-C. Returns
// whether it did not. Of a team's worker: those that no other worker is at. Throws FileError, GraphicsError,
// UsageError.
bool draw_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run,
                 const Diagnostics& diagnostics, GlContext& context, const Arguments& arguments,
                 FrameMemory& memory, Team* team = nullptr);
// Are all frames of the film there?
bool all_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run);

// Throws FileError with the commands that draw what is missing.
void require_all_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run,
                        const Arguments& arguments);

// Makes animation.webp, animation.gif and, where ffmpeg is, animation.mp4 in the directory, once all frames
// of the film are there; a note on stderr where they are not. Stops at Ctrl-C; returns whether it did not.
bool encode_films(const std::filesystem::path& directory, const FilmFolder& folder, const Scene& scene,
                  const Simulation& run, const Arguments& arguments, const FrameMemory& memory = {});

}  // namespace unfurl
